#pragma once

#include <array>

namespace snare::coupling {

/// Integral of a power that is never negative and has kinks, over accepted steps, by Simpson's rule: its
/// weights are positive, so that the sum never falls, and a kink costs it no more than the step in which it
/// lies.                                                                                     theory.md (M.11)
class LossSum {
 public:
  /// sum: up to the start [J].
  explicit LossSum(double sum = 0.0) : sum_(sum), sum_before_(sum) {}

  /// At a start and after what changes the power [W] at once; time in s.
  void begin(double time, double power) {
    begin_ = end_ = time;
    powers_[2] = power;
    sum_before_ = sum_;
  }
  /// A step to a time [s], with the power there; middle(time): the power in between [W].
  template <class Middle>
  void add(double time, double power, const Middle& middle) {
    begin_ = end_;
    end_ = time;
    powers_[0] = powers_[2];
    powers_[2] = power;
    // What begins and ends within a step is an event, where the step ends.
    powers_[1] = powers_[0] > 0.0 || power > 0.0 ? middle(0.5 * (begin_ + end_)) : 0.0;
    sum_before_ = sum_;
    sum_ += (end_ - begin_) / 6.0 * (powers_[0] + 4.0 * powers_[1] + powers_[2]);
  }
  /// Up to the last step [J].
  [[nodiscard]] double sum() const { return sum_; }
  /// Up to a time [s] within the last step: the integral of the parabola through the three powers [J].
  [[nodiscard]] double at(double time) const {
    if (time >= end_) return sum_;
    const double x = (time - begin_) / (end_ - begin_), square = x * x, cube = square * x;
    return sum_before_ + (end_ - begin_) * (powers_[0] * (x - 1.5 * square + 2.0 / 3.0 * cube) +
                                            powers_[1] * (2.0 * square - 4.0 / 3.0 * cube) +
                                            powers_[2] * (2.0 / 3.0 * cube - 0.5 * square));
  }

 private:
  double begin_ = 0.0, end_ = 0.0;
  std::array<double, 3> powers_{};  // at the begin, the middle and the end of the step
  double sum_, sum_before_;
};

}  // namespace snare::coupling
