#include "study/scheduler.hpp"
#include "study/case_loop.hpp"
#include "study/rank_work.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <queue>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace snare::study {
namespace {

const auto none = [](std::uint64_t) { return false; };

TEST(Scheduler, HandsOutEveryCaseOnceAndNoFinishedOne) {
  Scheduler s({.count = 100, .workers = 3}, [](std::uint64_t k) { return k % 2 == 0; });
  std::set<std::uint64_t> seen;
  for (int worker = 0;; worker = (worker + 1) % 3) {
    const auto mine = s.take(worker);
    if (mine.empty()) break;
    for (const std::uint64_t k : mine) {
      EXPECT_EQ(k % 2, 1U);
      EXPECT_TRUE(seen.insert(k).second);
      s.finished(worker, k, 1e-3);
    }
  }
  EXPECT_EQ(seen.size(), 50U);
  EXPECT_TRUE(s.done());
}

TEST(Scheduler, CasesOfALostWorkerComeAgainAndThoseLostTwiceAreGivenUp) {
  Scheduler s({.count = 2, .workers = 2, .chunk_s = 0.0}, none);
  EXPECT_EQ(s.take(1), std::vector<std::uint64_t>{0});
  EXPECT_EQ(s.take(2), std::vector<std::uint64_t>{1});
  EXPECT_TRUE(s.take(3).empty());
  EXPECT_FALSE(s.done());
  EXPECT_TRUE(s.lost(1).empty());
  EXPECT_EQ(s.take(3), std::vector<std::uint64_t>{0});
  EXPECT_EQ(s.lost(3), std::vector<std::uint64_t>{0});
  s.finished(2, 1, 1.0);
  EXPECT_TRUE(s.done());
}

/// Time that a study takes whose workers ask one leader, in which a request costs `answer_s`. Virtual time,
/// the scheduler's own code.
double simulated_time(std::uint64_t cases, int workers, double case_s, double answer_s, double travel_s) {
  Scheduler scheduler({.count = cases, .workers = workers}, none);
  std::mt19937_64 random(1);
  std::exponential_distribution<double> scatter(1.0);
  struct Request {
    double time;
    int worker;
    bool operator>(const Request& other) const { return time > other.time; }
  };
  std::priority_queue<Request, std::vector<Request>, std::greater<>> requests;
  for (int w = 0; w < workers; ++w) requests.push({travel_s, w});
  std::vector<std::vector<std::uint64_t>> has(static_cast<std::size_t>(workers));
  std::vector<double> each(static_cast<std::size_t>(workers));
  double leader = 0.0, end = 0.0;
  while (!requests.empty()) {
    const Request r = requests.top();
    requests.pop();
    const auto w = static_cast<std::size_t>(r.worker);
    leader = std::max(leader, r.time) + answer_s +
             1e-6 * static_cast<double>(has[w].size());  // a result is taken in 1 us
    for (const std::uint64_t k : has[w]) scheduler.finished(r.worker, k, each[w]);
    has[w] = scheduler.take(r.worker);
    if (has[w].empty()) continue;
    double work = 0.0;
    for (std::size_t k = 0; k < has[w].size(); ++k) work += case_s * (0.5 + 0.5 * scatter(random));
    each[w] = work / static_cast<double>(has[w].size());
    const double back = leader + travel_s + work + travel_s;
    end = std::max(end, back);
    requests.push({back, r.worker});
  }
  EXPECT_TRUE(scheduler.done());
  return end;
}

// 1e6 cases of 10 ms on 1024 workers, 20 us to answer a request and 50 us on the way, which is more than Open
// MPI takes.
TEST(Scheduler, AMillionCasesOnAThousandRanksLoseLessThanTwoHundredths) {
  constexpr std::uint64_t cases = 1000000;
  constexpr int workers = 1024;
  constexpr double case_s = 0.01;
  const double ideal = static_cast<double>(cases) * case_s / workers;
  const double time = simulated_time(cases, workers, case_s, 20e-6, 50e-6);
  RecordProperty("overhead_percent", std::to_string(100.0 * (time / ideal - 1.0)));
  EXPECT_LT(time / ideal - 1.0, 0.02);
}

TEST(CaseLoop, RunsEveryCaseOnAnyNumberOfThreads) {
  for (const int threads : {1, 2, 4}) {
    std::vector<int> times(500);
    Dispatcher dispatcher(Scheduler({.count = times.size(), .workers = threads}, none),
                          [&](std::uint64_t k, const std::string& result) {
                            EXPECT_EQ(result, std::to_string(k));
                            ++times[k];
                          },
                          {});
    run_cases(dispatcher, threads, [](std::uint64_t k) { return std::to_string(k); });
    EXPECT_EQ(times, std::vector<int>(500, 1));
    EXPECT_TRUE(dispatcher.over());
  }
}

TEST(CaseLoop, WhatKeepingThrowsEndsAll) {
  int kept = 0;
  Dispatcher dispatcher(Scheduler({.count = 1000, .workers = 2}, none),
                        [&](std::uint64_t, const std::string&) {
                          if (++kept == 10) throw std::runtime_error("no space left");
                        },
                        {});
  run_cases(dispatcher, 2, [](std::uint64_t) { return std::string("r"); });
  EXPECT_THROW(dispatcher.rethrow(), std::runtime_error);
  EXPECT_EQ(kept, 10);
}

/// Ranks that are threads of the test.
struct Mail {
  std::mutex mutex;
  std::vector<std::deque<Ranks::Message>> boxes;
};
class ThreadRanks : public Ranks {
 public:
  ThreadRanks(Mail& mail, int rank) : mail_(mail), rank_(rank) {}
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return static_cast<int>(mail_.boxes.size()); }
  void send(int to, const std::string& bytes) override {
    const std::scoped_lock lock(mail_.mutex);
    mail_.boxes[static_cast<std::size_t>(to)].push_back({rank_, bytes});
  }
  [[nodiscard]] std::optional<Message> receive() override {
    const std::scoped_lock lock(mail_.mutex);
    auto& box = mail_.boxes[static_cast<std::size_t>(rank_)];
    if (box.empty()) return std::nullopt;
    Message m = box.front();
    box.pop_front();
    return m;
  }
  void leave() override {}

 private:
  Mail& mail_;
  int rank_;
};

std::string squared(std::uint64_t index, const std::vector<double>& values) {
  std::this_thread::sleep_for(std::chrono::microseconds(300));
  return std::to_string(index * index) +
         (values.empty() ? "" : "+" + std::to_string(static_cast<int>(values[0])));
}

TEST(RankWork, EveryCaseOnceWhateverTheRanks) {
  for (const int size : {2, 4}) {
    Mail mail;
    mail.boxes.resize(static_cast<std::size_t>(size));
    std::vector<std::thread> others;
    for (int r = 1; r < size; ++r) {
      others.emplace_back([&mail, r] {
        ThreadRanks ranks(mail, r);
        follow(ranks, "study", 1, squared, [] { return false; });
      });
    }
    std::vector<std::string> results(300);
    {
      ThreadRanks ranks(mail, 0);
      RankLeader leader(ranks, {.identity = "study"});
      Dispatcher dispatcher(Scheduler({.count = results.size(), .workers = size, .chunk_s = 0.01}, none),
                            [&](std::uint64_t k, const std::string& result) {
                              EXPECT_TRUE(results[k].empty());
                              results[k] = result;
                            },
                            {});
      leader.run(
          dispatcher, squared, [](std::uint64_t k) { return std::vector<double>{static_cast<double>(k)}; },
          [](std::uint64_t) { return "given up"; });
      EXPECT_EQ(leader.lost(), 0);
    }
    for (std::thread& other : others) other.join();
    for (std::uint64_t k = 0; k < results.size(); ++k)
      EXPECT_EQ(results[k], std::to_string(k * k) + "+" + std::to_string(k));
  }
}

// A rank that takes cases and is never heard of again: the others run them.
TEST(RankWork, ASilentRankLosesNothing) {
  Mail mail;
  mail.boxes.resize(3);
  std::thread dies([&] {
    ThreadRanks ranks(mail, 1);
    follow(ranks, "study", 1, squared, [n = 0]() mutable { return ++n > 40; });
  });
  std::thread lives([&] {
    ThreadRanks ranks(mail, 2);
    follow(ranks, "study", 1, squared, [] { return false; });
  });
  std::vector<int> times(2000);
  {
    ThreadRanks ranks(mail, 0);
    RankLeader leader(ranks, {.identity = "study", .silence_s = 2.5});
    Dispatcher dispatcher(Scheduler({.count = times.size(), .workers = 3, .chunk_s = 0.01}, none),
                          [&](std::uint64_t k, const std::string&) { ++times[k]; }, {});
    leader.run(
        dispatcher, squared, [](std::uint64_t) { return std::vector<double>(); },
        [](std::uint64_t) { return "given up"; });
    EXPECT_EQ(leader.lost(), 1);
  }
  dies.join();
  lives.join();
  EXPECT_EQ(times, std::vector<int>(2000, 1));
}

}  // namespace
}  // namespace snare::study
