#include "numerics/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace snare::numerics {

namespace {

/// What is said of the steps that something limited.
const char* words(StepLimit limit) {
  switch (limit) {
    case StepLimit::newton:
      return "cut by Newton's method";
    case StepLimit::error_test:
      return "cut by the error test";
    case StepLimit::accuracy:
      return "chosen for accuracy";
    case StepLimit::start:
      return "first ones after a change";
    case StepLimit::longest:
      return "as long as allowed";
  }
  return "";
}

}  // namespace

long Progress::window(long unknowns) {
  constexpr long least = 40000;
  constexpr long rows = 50000000;
  return std::max(least, rows / std::max(unknowns, 1L));
}

std::optional<std::string> Progress::add(const Ida& ida, long evaluations, double end, Effort& effort) {
  effort.evaluations += evaluations;
  if (++steps_ % sampled == 0) {
    const LimitOfStep limit = ida.what_limited();
    ++limited_[static_cast<std::size_t>(limit.kind)][limit.block];
  }
  if (effort.evaluations < window(ida.y().size())) return std::nullopt;
  const double advance = ida.time() - effort.since;
  if (advance < least_ && end - ida.time() > advance) return why(ida, end, effort);
  effort = {0, ida.time()};
  return std::nullopt;
}

std::string Progress::why(const Ida& ida, double end, const Effort& effort) const {
  const double advance = ida.time() - effort.since;
  std::string text = fmt::format(
      "stalled at {:.9g} s: {} evaluations of {} equations brought it on by {:.3g} s, less than the {:g} s "
      "that they "
      "must, and the rest would take {:.2g} times as many; the last step was {:.3g} s",
      ida.time(), effort.evaluations, ida.y().size(), advance, least_, (end - ida.time()) / advance,
      ida.last_step());
  struct Share {
    StepLimit kind;
    long count;
    int block;
  };
  std::vector<Share> shares;
  long all = 0;
  for (std::size_t k = 0; k < limited_.size(); ++k) {
    Share share{static_cast<StepLimit>(k), 0, -1};
    long most = 0;
    for (const auto& [block, count] : limited_[k]) {
      share.count += count;
      if (count > most) share.block = block;
      most = std::max(most, count);
    }
    all += share.count;
    if (share.count > 0) shares.push_back(share);
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const Share& a, const Share& b) { return a.count > b.count; });
  const char* between = "; of its steps ";
  for (const Share& s : shares) {
    const double percent = 100.0 * static_cast<double>(s.count) / static_cast<double>(all);
    if (percent < 5.0) continue;
    text += fmt::format("{}{:.0f} % were {}", between, percent, words(s.kind));
    if (s.block >= 0) text += fmt::format(" (most by {})", ida.name_of_block(s.block));
    between = ", ";
  }
  return text;
}

}  // namespace snare::numerics
