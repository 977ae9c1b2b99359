#pragma once

#include "coupling/dynamics/phase.hpp"
#include "coupling/dynamics/result.hpp"
#include "numerics/dae.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace snare::coupling {

/// When the phases of a motion begin. Signals are looked at where the integrator has stepped, and taken as straight between: the
/// unknowns between two steps err by more than a stiff contact forgives.                              theory.md (M.23)
class PhaseWatch {
 public:
  /// A signal's present value, in the SI unit of its kind.
  using Signals = std::function<double(const MotionSignal&)>;

  /// The phases stay the caller's and outlive it.
  explicit PhaseWatch(const std::vector<MotionPhase>& phases) : phases_(phases) {}

  /// The next phase, or none.
  [[nodiscard]] const MotionPhase* pending() const { return next_ < phases_.size() ? &phases_[next_] : nullptr; }
  /// Time up to which the next phase cannot begin but by what its signals do [s].
  [[nodiscard]] double limit(double time) const;
  /// Tells it the signals at the time [s] at which it starts, and behind every begun phase.
  void start(double time, const Signals& signals);
  /// The time within the step from the last one at which the next phase begins, if it does [s].
  [[nodiscard]] std::optional<double> look(double time, const Signals& signals);
  /// The pending phase begins, at this time [s].
  void begin(double time, const Signals& signals);

  /// See DaePart; times [s].
  void save_state(std::vector<double>& memory) const;
  void restore_state(std::span<const double>& memory);

 private:
  [[nodiscard]] double earliest() const;
  /// By how much every bound is kept, the least: >= 0 when all are; infinite without bounds.
  [[nodiscard]] double margin(const Signals& signals) const;

  const std::vector<MotionPhase>& phases_;
  std::size_t next_ = 0;
  double begun_ = 0.0;  // of the last phase
  double last_time_ = 0.0;
  double last_margin_ = 0.0;
  std::optional<double> kept_since_;  // all bounds hold from then on
};

}  // namespace snare::coupling
