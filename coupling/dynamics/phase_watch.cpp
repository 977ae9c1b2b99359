#include "coupling/dynamics/phase_watch.hpp"

#include <algorithm>
#include <cmath>

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

void PhaseWatch::start(double time, const Signals& signals) {
  last_time_ = time;
  if (pending() == nullptr) return;
  last_margin_ = margin(signals);
  if (last_margin_ < 0.0)
    kept_since_.reset();
  else if (!kept_since_)
    kept_since_ = time;
}

// Straight between the steps; a phase does not begin before its time, whatever its signals did until then.
std::optional<double> PhaseWatch::look(double time, const Signals& signals) {
  if (pending() == nullptr) return std::nullopt;
  const double now = margin(signals);
  if (now >= 0.0) {
    if (!kept_since_) {
      const double share = std::isfinite(now) && now > last_margin_ ? -last_margin_ / (now - last_margin_) : 0.0;
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

void PhaseWatch::begin(double time, const Signals& signals) {
  begun_ = time;
  ++next_;
  kept_since_.reset();
  start(time, signals);
}

void PhaseWatch::save_state(std::vector<double>& memory) const {
  memory.insert(memory.end(), {static_cast<double>(next_), begun_, last_time_, last_margin_, kept_since_ ? 1.0 : 0.0,
                               kept_since_.value_or(0.0)});
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
