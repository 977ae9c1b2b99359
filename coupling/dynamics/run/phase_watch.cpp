#include "coupling/dynamics/run/phase_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace snare::coupling {

namespace {

constexpr double forever = std::numeric_limits<double>::infinity();

}  // namespace

double PhaseWatch::earliest() const {
  const MotionPhase& phase = phases_[next_];
  return std::max(phase.not_before, (next_ > 0 ? begun_ : 0.0) + phase.after_previous);
}

double PhaseWatch::limit(double time) const {
  if (pending() == nullptr) return forever;
  const double first = earliest();
  if (first > time) return first;
  if (!kept_since_) return forever;
  const double end = *kept_since_ + phases_[next_].hold;
  return end > time ? end : forever;
}

double PhaseWatch::margin(const Signals& signals) const {
  double least = forever;
  for (const SignalBound& b : phases_[next_].bounds) {
    const double by = signals(b.signal) - b.bound;
    least = std::min(least, b.above ? by : -by);
  }
  return least;
}

bool PhaseWatch::keeps_readings(const Kept& kept) const {
  return std::ranges::all_of(phases_[next_].sensed, kept);
}

bool PhaseWatch::asks_for_readings() const {
  return std::any_of(phases_.begin() + static_cast<std::ptrdiff_t>(next_), phases_.end(),
                     [](const MotionPhase& p) { return !p.sensed.empty(); });
}

void PhaseWatch::start(double time, const Signals& signals, const Kept& kept) {
  last_time_ = time;
  if (pending() == nullptr) return;
  last_margin_ = margin(signals);
  if (last_margin_ < 0.0 || !keeps_readings(kept))
    kept_since_.reset();
  else if (!kept_since_)
    kept_since_ = time;
}

// Straight between the steps; a phase does not begin before its time, whatever its signals did until then. A
// reading holds until the next one comes, and steps end where one does.
std::optional<double> PhaseWatch::look(double time, const Signals& signals, const Kept& kept) {
  if (pending() == nullptr) return std::nullopt;
  const double now = margin(signals);
  if (now >= 0.0 && keeps_readings(kept)) {
    if (!kept_since_) {
      const double share =
          std::isfinite(now) && now > last_margin_ ? -last_margin_ / (now - last_margin_) : 0.0;
      kept_since_ = last_time_ + std::clamp(share, 0.0, 1.0) * (time - last_time_);
    }
  } else {
    kept_since_.reset();
  }
  const double before = last_time_;
  last_time_ = time;
  last_margin_ = now;
  if (!kept_since_) return std::nullopt;
  const double begins = std::max(earliest(), *kept_since_ + phases_[next_].hold);
  if (begins > time) return std::nullopt;
  return std::max(begins, before);
}

bool PhaseWatch::read(double time, const Kept& kept) {
  if (pending() == nullptr || phases_[next_].sensed.empty()) return false;
  if (!keeps_readings(kept)) {
    kept_since_.reset();
    return false;
  }
  if (!kept_since_ && last_margin_ >= 0.0) kept_since_ = time;
  return kept_since_ && std::max(earliest(), *kept_since_ + phases_[next_].hold) <= time;
}

void PhaseWatch::begin(double time, const Signals& signals, const Kept& kept) {
  begun_ = time;
  ++next_;
  kept_since_.reset();
  start(time, signals, kept);
}

void PhaseWatch::save_state(std::vector<double>& memory) const {
  memory.insert(memory.end(), {static_cast<double>(next_), begun_, last_time_, last_margin_,
                               kept_since_ ? 1.0 : 0.0, kept_since_.value_or(0.0)});
}

void PhaseWatch::restore_state(std::span<const double>& memory) {
  next_ = std::min(static_cast<std::size_t>(numerics::take(memory)), phases_.size());
  begun_ = numerics::take(memory);
  last_time_ = numerics::take(memory);
  last_margin_ = numerics::take(memory);
  const bool kept = numerics::take(memory) != 0.0;
  const double since = numerics::take(memory);
  kept_since_ = kept ? std::optional(since) : std::nullopt;
}

}  // namespace snare::coupling
