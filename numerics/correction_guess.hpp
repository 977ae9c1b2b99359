#pragma once

#include <Eigen/Core>

#include <array>

namespace snare::numerics {

/// A first guess of a step's correction, from that of the step before.                      theory.md (M.12)
///
/// What a step of order k at t_n corrects of the polynomial through the k + 1 states before it is a divided
/// difference of order k + 1,
///   E_n = (t_n - t_{n-1}) ... (t_n - t_{n-k-1}) y[t_n, ..., t_{n-k-1}],
/// which changes little from step to step: E_n is about E_{n-1} times the ratio of the products. Times of any
/// unit.
class CorrectionGuess {
 public:
  /// What was is forgotten: at a start.
  void restart() { states_ = 0; }
  /// A step of this order is tried, from the state before to `time`; accepted: how many steps there are since
  /// the start. Sets the guess, of any unit, zero where there is none: after a change of the order, or where
  /// the last one was no better than none.
  void begin(long accepted, double before, double time, int order, Eigen::Ref<Eigen::VectorXd> correction);
  /// What the step needed, of any unit; weight: one over the tolerance of every unknown, in its unit.
  void end(const Eigen::Ref<const Eigen::VectorXd>& correction,
           const Eigen::Ref<const Eigen::VectorXd>& weight);

 private:
  static constexpr int most = 6;  // states that a step of order five sees

  struct Difference {
    int order = -1;  // of the step; -1: none
    Eigen::VectorXd value;
  };

  std::array<double, most> times_{};  // of the last states, the latest first
  int states_ = 0;                    // how many of them there are
  long accepted_ = 0;
  double tried_ = 0.0;      // time of the step that is tried
  int order_ = -1;          // of it; -1: too few states
  double product_ = 1.0;    // of it
  Difference last_, next_;  // of the last step that was accepted, and of the one that is tried
  Eigen::VectorXd guess_;
  bool has_guess_ = false;
  bool trusted_ = true;  // the last guess was nearer than none
};

}  // namespace snare::numerics
