#include "study/scheduler.hpp"

#include <algorithm>
#include <utility>

namespace snare::study {

Scheduler::Scheduler(const Settings& settings, std::function<bool(std::uint64_t)> has)
    : settings_(settings), has_(std::move(has)) {
  skip_finished();
}

void Scheduler::skip_finished() {
  while (!at_end() && has_(next_)) ++next_;
}

std::vector<std::uint64_t> Scheduler::take(int worker) {
  std::vector<std::uint64_t> cases;
  if (!again_.empty()) {
    cases.push_back(again_.front());
    again_.pop_front();
  } else {
    // Guided self-scheduling (Polychronopoulos, Kuck 1987), a quarter of an even share at most, so that the
    // last chunks are single cases.
    const std::uint64_t share =
        (settings_.count - next_) / (4 * static_cast<std::uint64_t>(settings_.workers));
    std::uint64_t size = 1;
    if (timed_ > 0 && settings_.chunk_s > 0.0) {
      const double mean = std::max(seconds_ / static_cast<double>(timed_), 1e-9);
      size = static_cast<std::uint64_t>(
          std::min(settings_.chunk_s / mean, static_cast<double>(settings_.largest)));
    }
    size = std::max<std::uint64_t>(1, std::min(size, share));
    while (cases.size() < size && !at_end()) {
      cases.push_back(next_++);
      skip_finished();
    }
  }
  if (!cases.empty()) {
    std::vector<std::uint64_t>& mine = out_[worker];
    mine.insert(mine.end(), cases.begin(), cases.end());
  }
  return cases;
}

void Scheduler::finished(int worker, std::uint64_t index, double seconds) {
  const auto found = out_.find(worker);
  if (found == out_.end() || std::erase(found->second, index) == 0) return;
  if (found->second.empty()) out_.erase(found);
  seconds_ += seconds;
  ++timed_;
}

std::vector<std::uint64_t> Scheduler::lost(int worker) {
  constexpr int patience = 2;
  std::vector<std::uint64_t> given_up;
  const auto found = out_.find(worker);
  if (found == out_.end()) return given_up;
  // The first that was not reported may be what the worker was lost with; the others never began, or will be
  // done again.
  for (std::size_t k = 0; k < found->second.size(); ++k) {
    const std::uint64_t index = found->second[k];
    if (k == 0 && ++lost_with_[index] >= patience) {
      given_up.push_back(index);
    } else {
      again_.push_back(index);
    }
  }
  out_.erase(found);
  return given_up;
}

}  // namespace snare::study
