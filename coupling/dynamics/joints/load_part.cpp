#include "coupling/dynamics/joints/load_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace snare::coupling {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using multibody::Wrench;
using numerics::DaePoint;

// The stretch of the times in which the integration is: that after the last time at which it started again,
// so that a step up to a jump sees the near side of it.
Wrench LoadPart::wrench(const DaePoint& at) const {
  const std::vector<double>& t = load_.times;
  const auto behind = std::upper_bound(t.begin(), t.end(), entered_);
  if (behind == t.begin() || behind == t.end()) return {};
  const auto k = static_cast<Index>(behind - t.begin());
  const double from = *(behind - 1), share = (at.time - from) / (*behind - from);
  const auto between = [&](const Eigen::Matrix3Xd& values) -> Vector3d {
    if (load_.half_sines) return std::sin(std::numbers::pi * share) * values.col(k - 1);
    return values.col(k - 1) + share * (values.col(k) - values.col(k - 1));
  };
  Wrench w{between(load_.moments), between(load_.forces)};
  if (!load_.in_frame) return w;
  const Eigen::Matrix3d R = frame_.state(at.y).X_WF.R;
  return {R * w.moment, R * w.force};
}

bool LoadPart::begin_interval(double time) {
  const bool passes = next_break(entered_) <= time;
  entered_ = time;
  return passes;
}

double LoadPart::next_break(double time) const {
  const auto next = std::upper_bound(load_.times.begin(), load_.times.end(), time);
  return next == load_.times.end() ? std::numeric_limits<double>::infinity() : *next;
}

void LoadPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  if (!frame_.moves_freely()) return;
  for (const int row : frame_.velocities()) {
    for (const int column : frame_.coordinates()) entries.emplace_back(row, column);
  }
}

void LoadPart::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  frame_.push(at.y, wrench(at), rows);
}

// d(J^T W) = (dJ)^T W + J^T [turn] W where the wrench turns with its frame.
void LoadPart::jacobian(const DaePoint& at, double /*c*/, std::vector<double>& values) {
  const Wrench w = wrench(at);
  if (!frame_.moves_freely() || (w.force.isZero(0.0) && w.moment.isZero(0.0))) return;
  const numerics::PatternValues into(slots_, values);
  const MovingFrame::Derivatives d = frame_.differentiate(at.y);
  MatrixXd by = d.force(w);
  if (load_.in_frame) {
    for (Index j = 0; j < by.cols(); ++j) {
      const Vector3d turn = d.place.col(j).head<3>();
      by.col(j) += d.jacobian.transpose() * Wrench{turn.cross(w.moment), turn.cross(w.force)}.vector();
    }
  }
  const std::vector<int> rows = frame_.velocities(), columns = frame_.coordinates();
  for (Index i = 0; i < by.rows(); ++i) {
    for (Index j = 0; j < by.cols(); ++j)
      into.add(rows[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)], -by(i, j));
  }
}

}  // namespace snare::coupling
