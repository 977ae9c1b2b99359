#include "coupling/dynamics/joints/frame_forces.hpp"

#include <algorithm>

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

void FrameForces::attach_pattern(const numerics::SparseMatrix& pattern) {
  slots_.attach(pattern);
  carriers_.clear();
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const std::vector<int> coordinates = frames_[k].coordinates();
    const auto same =
        std::ranges::find_if(carriers_, [&](const Carrier& c) { return c.coordinates == coordinates; });
    if (same != carriers_.end())
      same->frames.push_back(k);
    else
      carriers_.push_back({{k}, coordinates, frames_[k].velocities(), frames_[k].moves_freely()});
  }
}

void FrameForces::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  const std::vector<Wrench> w = wrenches(at.y);
  for (std::size_t k = 0; k < w.size(); ++k) frames_[k].push(at.y, w[k], rows);
}

void FrameForces::jacobian(const DaePoint& at, double /*c*/, std::vector<double>& values) {
  const std::vector<Wrench> w = wrenches(at.y);
  if (w.empty()) return;
  const numerics::PatternValues into(slots_, values);
  const MatrixXd D = derivatives(at.y);
  const std::vector<int> inner_unknowns = inner(at.y);
  const auto first_inner_row = wrench_rows * static_cast<Index>(frames_.size());
  const auto first_inner_column = motion_columns * static_cast<Index>(frames_.size());
  std::vector<MovingFrame::Derivatives> d;
  d.reserve(frames_.size());
  for (const MovingFrame& frame : frames_) d.push_back(frame.differentiate(at.y));
  for (const Carrier& by : carriers_) {
    if (by.coordinates.empty()) continue;
    // Of all wrenches by what this carrier does.
    const auto nq = static_cast<Index>(by.coordinates.size()), nv = static_cast<Index>(by.velocities.size());
    MatrixXd dW = MatrixXd::Zero(D.rows(), nq + nv);
    for (const std::size_t k : by.frames) {
      const auto D_k = D.middleCols<motion_columns>(motion_columns * static_cast<Index>(k));
      dW.leftCols(nq).noalias() += D_k.leftCols<6>().lazyProduct(d[k].place);
      dW.leftCols(nq).noalias() += D_k.rightCols<6>().lazyProduct(d[k].motion);
      if (d[k].jacobian.cols() > 0)
        dW.rightCols(nv).noalias() += D_k.rightCols<6>().lazyProduct(d[k].jacobian);
    }
    for (const Carrier& on : carriers_) {
      if (!on.moves_freely) continue;
      MatrixXd block = MatrixXd::Zero(static_cast<Index>(on.velocities.size()), nq + nv);
      for (const std::size_t i : on.frames) {
        block.noalias() -= d[i].jacobian.transpose().lazyProduct(
            dW.middleRows<wrench_rows>(wrench_rows * static_cast<Index>(i)));
        // The Jacobian of the carrier turns with it.
        if (&on == &by) block.leftCols(nq) -= d[i].force(w[i]);
      }
      // The rows of a carrier follow each other.
      for (Index j = 0; j < nq + nv; ++j) {
        const int column = j < nq ? by.coordinates[static_cast<std::size_t>(j)]
                                  : by.velocities[static_cast<std::size_t>(j - nq)];
        into.add(on.velocities.front(), column, block.col(j));
      }
    }
    for (std::size_t z = 0; z < inner_unknowns.size(); ++z) {
      const auto row = -dW.row(first_inner_row + static_cast<Index>(z));
      for (std::size_t j = 0; j < by.coordinates.size(); ++j)
        into.add(inner_unknowns[z], by.coordinates[j], row[static_cast<Index>(j)]);
      for (std::size_t j = 0; j < by.velocities.size(); ++j)
        into.add(inner_unknowns[z], by.velocities[j], row[nq + static_cast<Index>(j)]);
    }
  }
  for (std::size_t z = 0; z < inner_unknowns.size(); ++z) {
    const auto by_inner = D.col(first_inner_column + static_cast<Index>(z));
    for (const Carrier& on : carriers_) {
      if (!on.moves_freely) continue;
      Eigen::VectorXd block = Eigen::VectorXd::Zero(static_cast<Index>(on.velocities.size()));
      for (const std::size_t i : on.frames)
        block -=
            d[i].jacobian.transpose() * by_inner.segment<wrench_rows>(wrench_rows * static_cast<Index>(i));
      into.add(on.velocities.front(), inner_unknowns[z], block);
    }
    for (std::size_t k = 0; k < inner_unknowns.size(); ++k) {
      const double value = by_inner[first_inner_row + static_cast<Index>(k)];
      if (value != 0.0) into.add(inner_unknowns[k], inner_unknowns[z], -value);
    }
  }
}

}  // namespace snare::coupling
