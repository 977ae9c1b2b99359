#pragma once

#include "numerics/dae.hpp"

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace snare::coupling {

/// The unknowns on which a part depends, as they were when it was evaluated last: what is asked for at the
/// same place again and again is computed once.
class InputMemo {
 public:
  /// The part depends on `count` unknowns from `first` on.
  void depend_on(int first, int count) {
    stretches_.emplace_back(first, count);
    values_.resize(values_.size() + count);
  }
  [[nodiscard]] bool depends() const { return !stretches_.empty(); }  ///< on any
  /// Whether those of y (SI units) are the ones that were taken.
  [[nodiscard]] bool holds(const numerics::VectorView& y) const {
    Eigen::Index at = 0;
    bool same = taken_;
    for (const auto& [first, count] : stretches_) {
      same = same && values_.segment(at, count) == y.segment(first, count);
      at += count;
    }
    return same;
  }
  /// Takes those of y (SI units).
  void take(const numerics::VectorView& y) {
    Eigen::Index at = 0;
    for (const auto& [first, count] : stretches_) {
      values_.segment(at, count) = y.segment(first, count);
      at += count;
    }
    taken_ = depends();
  }
  void forget() { taken_ = false; }

 private:
  std::vector<std::pair<int, int>> stretches_;  // first and count
  Eigen::VectorXd values_;
  bool taken_ = false;
};

}  // namespace snare::coupling
