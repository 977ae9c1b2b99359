#include "study/rank_work.hpp"

#include "base/archive.hpp"
#include "base/errors.hpp"
#include "base/index.hpp"
#include "base/inputs.hpp"
#include "study/clock.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

namespace snare::study {

namespace {

enum class Word : char { ready, alive, work, end };

constexpr double alive_every = 1.0;                      // [s]
constexpr std::chrono::microseconds pause_between(200);  // looks for messages

struct Task {
  std::uint64_t index = 0;   // of the dispatcher
  std::uint64_t number = 0;  // in the study
  std::vector<double> values;
};
template <class Archive>
void fields(Archive& archive, Task& task) {
  archive(task.index)(task.number)(task.values);
}

struct Done {
  std::uint64_t index = 0;
  double seconds = 0.0;
  std::string result;
};
template <class Archive>
void fields(Archive& archive, Done& done) {
  archive(done.index)(done.seconds)(done.result);
}

template <class... Parts>
std::string message(Word word, Parts&... parts) {
  base::ByteWriter writer;
  writer(word);
  (writer(parts), ...);
  return writer.bytes();
}

int worker_of(int rank) {
  constexpr int after_threads = 100000;  // the leader's threads are 0, 1, ...
  return after_threads + rank;
}

}  // namespace

RankLeader::RankLeader(Ranks& ranks, Settings settings)
    : ranks_(ranks), settings_(std::move(settings)), others_(static_cast<std::size_t>(ranks.size())) {
  for (Other& other : others_) other.heard = now();
}

RankLeader::~RankLeader() {
  for (int r = 1; r < ranks_.size(); ++r)
    if (!others_[base::at(r)].gone) ranks_.send(r, message(Word::end));
}

void RankLeader::hear(Dispatcher& dispatcher) {
  while (const std::optional<Ranks::Message> m = ranks_.receive()) {
    Other& other = others_[base::at(m->from)];
    if (other.gone) continue;  // what it has comes from somebody else by now
    other.heard = now();
    base::ByteReader reader(m->bytes);
    Word word{};
    reader(word);
    if (word != Word::ready) continue;
    std::string identity;
    std::vector<Done> results;
    reader(identity)(results);
    if (identity != settings_.identity) {
      throw base::InputError({"", 0, "rank", std::to_string(m->from),
                              "must read the same files as rank 0, and be the same version"});
    }
    for (const Done& done : results)
      dispatcher.report(worker_of(m->from), done.index, done.result, done.seconds);
    other.idle = true;
  }
}

void RankLeader::run(Dispatcher& dispatcher, const RunWithValues& run,
                     const std::function<std::vector<double>(std::uint64_t)>& values,
                     const std::function<std::string(std::uint64_t)>& given_up, std::uint64_t first) {
  // The leader's own cases on a thread of their own: this one talks.
  std::thread own([&, inputs = base::current_inputs()] {
    const base::InputScope scope(inputs);
    run_cases(
        dispatcher, settings_.threads, [&](std::uint64_t index) { return run(first + index, values(index)); },
        Idle::wait);
  });
  try {
    for (Other& other : others_) other.heard = now();  // nobody listened in the meantime
    while (!dispatcher.over()) {
      hear(dispatcher);
      for (int r = 1; r < ranks_.size(); ++r) {
        Other& other = others_[base::at(r)];
        if (other.gone) continue;
        if (now() - other.heard > settings_.silence_s) {
          other.gone = true;
          ++lost_;
          dispatcher.lost(worker_of(r), given_up);
          continue;
        }
        if (!other.idle) continue;
        std::vector<Task> tasks;
        for (const std::uint64_t index : dispatcher.take(worker_of(r)))
          tasks.push_back({index, first + index, values(index)});
        if (tasks.empty()) continue;
        other.idle = false;
        ranks_.send(r, message(Word::work, tasks));
      }
      std::this_thread::sleep_for(pause_between);
    }
  } catch (...) {
    dispatcher.fail();
  }
  own.join();
  dispatcher.rethrow();
}

void follow(Ranks& ranks, const std::string& identity, int threads, const RunWithValues& run,
            const std::function<bool()>& stop) {
  std::atomic<bool> over{false};
  double said = now();
  const auto ready = [&](std::vector<Done> results) {
    std::string name = identity;
    ranks.send(0, message(Word::ready, name, results));
    said = now();
  };
  ready({});
  while (!over && !stop()) {
    const std::optional<Ranks::Message> m = ranks.receive();
    if (!m) {
      if (now() - said > alive_every) {
        ranks.send(0, message(Word::alive));
        said = now();
      }
      std::this_thread::sleep_for(pause_between);
      continue;
    }
    base::ByteReader reader(m->bytes);
    Word word{};
    reader(word);
    if (word == Word::end) return;
    if (word != Word::work) continue;
    std::vector<Task> tasks;
    reader(tasks);
    std::vector<TimedResult> results;
    std::atomic<bool> finished{false};
    std::thread work([&, inputs = base::current_inputs()] {
      const base::InputScope scope(inputs);
      results = run_list(
          tasks.size(), threads, [&](std::size_t k) { return run(tasks[k].number, tasks[k].values); },
          [&] { return over.load() || stop(); });
      finished = true;
    });
    while (!finished) {
      if (now() - said > alive_every) {
        ranks.send(0, message(Word::alive));
        said = now();
      }
      if (const std::optional<Ranks::Message> other = ranks.receive()) {
        base::ByteReader next(other->bytes);
        next(word);
        over = over || word == Word::end;  // the leader gives no second work before the first is back
      }
      std::this_thread::sleep_for(pause_between);
    }
    work.join();
    if (over || stop()) return;
    std::vector<Done> done;
    for (std::size_t k = 0; k < results.size(); ++k)
      if (!results[k].result.empty()) done.push_back({tasks[k].index, results[k].seconds, results[k].result});
    ready(std::move(done));
  }
}

}  // namespace snare::study
