#include "coupling/dynamics/frame_forces.hpp"

namespace snare::coupling {

using Eigen::Index;
using Eigen::MatrixXd;
using multibody::Wrench;
using numerics::DaePoint;

void FrameForces::sparsity(std::vector<std::pair<int, int>>& entries) const {
  for (const MovingFrame& carrier : frames_) {
    if (!carrier.moves_freely()) continue;
    for (const int row : carrier.velocities()) {
      for (const MovingFrame& other : frames_) {
        for (const int column : other.coordinates()) entries.emplace_back(row, column);
        for (const int column : other.velocities()) entries.emplace_back(row, column);
      }
    }
  }
}

void FrameForces::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  const std::vector<Wrench> w = wrenches(at.y);
  for (std::size_t k = 0; k < w.size(); ++k) {
    if (frames_[k].moves_freely()) frames_[k].push(frames_[k].jacobian(at.y), w[k], rows);
  }
}

void FrameForces::jacobian(const DaePoint& at, double /*c*/, std::vector<double>& values) {
  const std::vector<Wrench> w = wrenches(at.y);
  if (w.empty()) return;
  const numerics::PatternValues into(*pattern_, values);
  const MatrixXd D = derivatives(at.y);
  std::vector<MovingFrame::Derivatives> d;
  std::vector<std::vector<int>> q, v;
  for (const MovingFrame& frame : frames_) {
    d.push_back(frame.differentiate(at.y));
    q.push_back(frame.coordinates());
    v.push_back(frame.velocities());
  }
  // The rows of a carrier follow each other.
  const auto add = [&into](const std::vector<int>& rows, const std::vector<int>& columns, const MatrixXd& block) {
    for (Index j = 0; j < block.cols(); ++j)
      into.add(rows.front(), columns[static_cast<std::size_t>(j)], -block.col(j));
  };
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (!frames_[i].moves_freely()) continue;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      const auto by = D.block(wrench_rows * static_cast<Index>(i), motion_columns * static_cast<Index>(k), wrench_rows,
                              motion_columns);
      if (!q[k].empty())
        add(v[i], q[k], d[i].jacobian.transpose() * (by.leftCols<6>() * d[k].place + by.rightCols<6>() * d[k].motion));
      if (d[k].jacobian.cols() > 0) add(v[i], v[k], d[i].jacobian.transpose() * (by.rightCols<6>() * d[k].jacobian));
    }
    // The Jacobian of the carrier turns with it.
    add(v[i], q[i], d[i].force(w[i]));
  }
}

}  // namespace snare::coupling
