#pragma once

#include "coupling/dynamics/model/phase.hpp"
#include "coupling/dynamics/model/result.hpp"
#include "numerics/dae.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace snare::coupling {

/// When the phases of a motion begin. Signals are looked at where the integrator has stepped, and taken as
/// straight between: the unknowns between two steps err by more than a stiff contact forgives.
///                                                                                           theory.md (M.23)
class PhaseWatch {
 public:
  /// A signal's present value, in the SI unit of its kind.
  using Signals = std::function<double(const MotionSignal&)>;
  /// Whether the last reading of a sensed signal keeps a bound.
  using Kept = std::function<bool(const SensedBound&)>;

  /// The phases stay the caller's and outlive it.
  explicit PhaseWatch(const std::vector<MotionPhase>& phases) : phases_(phases) {}

  /// The next phase, or none.
  [[nodiscard]] const MotionPhase* pending() const {
    return next_ < phases_.size() ? &phases_[next_] : nullptr;
  }
  /// Time up to which the next phase cannot begin but by what its signals do [s].
  [[nodiscard]] double limit(double time) const;
  /// Tells it the signals at the time [s] at which it starts, and behind every begun phase.
  void start(double time, const Signals& signals, const Kept& kept);
  /// The time within the step from the last one at which the next phase begins, if it does [s]; by the
  /// readings that came before its end.
  [[nodiscard]] std::optional<double> look(double time, const Signals& signals, const Kept& kept);
  /// Behind `look` at a time [s] at which readings have come: whether the next phase begins by them, now.
  [[nodiscard]] bool read(double time, const Kept& kept);
  /// Whether a phase that has not begun asks for readings.
  [[nodiscard]] bool asks_for_readings() const;
  /// The pending phase begins, at this time [s].
  void begin(double time, const Signals& signals, const Kept& kept);

  /// See DaePart; times [s].
  void save_state(std::vector<double>& memory) const;
  void restore_state(std::span<const double>& memory);

 private:
  [[nodiscard]] double earliest() const;
  /// By how much every bound is kept, the least: >= 0 when all are; infinite without bounds.
  [[nodiscard]] double margin(const Signals& signals) const;
  [[nodiscard]] bool keeps_readings(const Kept& kept) const;

  const std::vector<MotionPhase>& phases_;
  std::size_t next_ = 0;
  double begun_ = 0.0;  // of the last phase
  double last_time_ = 0.0;
  double last_margin_ = 0.0;
  std::optional<double> kept_since_;  // all bounds hold from then on
};

}  // namespace snare::coupling
