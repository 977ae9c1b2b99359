#include "numerics/bordered.hpp"

#include "numerics/sparse_matrix.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace snare::numerics {

bool BorderedSolver::factorize(const BorderedSystem& system) {
  whole_.reset();
  // A pivot that keeps less than 1e-12 of its diagonal entry has lost 12 digits: round-off if K is singular,
  // harmless if K is a fine mesh's and definite. A trial solution tells which.
  constexpr double suspicious_share = 1e-12;
  if (factorize_blocks(system) && (factor_.pivot_share() > suspicious_share || blocks_are_accurate(system))) {
    return true;
  }
  const SparseMatrix matrix = to_sparse(system);
  Klu whole(matrix);
  // Written so that a NaN counts as singular.
  if (!whole.factorize(matrix) || !(whole.reciprocal_condition() >= 1e-15)) return false;
  determinant_sign_ = whole.determinant_sign();
  whole_ = std::move(whole);
  return true;
}

// Componentwise backward error (Oettli and Prager 1964) of a trial solution, max |b - A x| / (|A| |x| + |b|),
// below half the digits: Newton's method then still converges as fast.
bool BorderedSolver::blocks_are_accurate(const BorderedSystem& system) const {
  const SymmetricBandMatrix& k = system.matrix;
  const int n = k.order();
  const auto m = system.corner.rows();
  // Loads of the size of each row and of changing sign, so that every direction is in the solution.
  Eigen::VectorXd load(n);
  for (int i = 0; i < n; ++i) load[i] = std::sin(1.0 + 1.7 * i) * std::abs(k.lower(i, i));
  Eigen::VectorXd band = load;
  Eigen::VectorXd border = Eigen::VectorXd::Ones(m);
  solve(system, band, border);
  if (!band.allFinite() || !border.allFinite()) return false;

  Eigen::VectorXd band_residual = load - k * band;
  Eigen::VectorXd band_size = load.cwiseAbs();
  for (int j = 0; j < n; ++j) {
    for (int i = j; i <= std::min(n - 1, j + k.half_bandwidth()); ++i) {
      const double size = std::abs(k.lower(i, j));
      band_size[i] += size * std::abs(band[j]);
      if (i != j) band_size[j] += size * std::abs(band[i]);
    }
  }
  for (const BorderedSystem::Anchor& a : system.anchors) {
    band_residual[a.band] += border[a.border];
    band_size[a.band] += std::abs(border[a.border]);
  }
  for (const auto& [unknown, values] : system.columns) {
    band_residual -= border[unknown] * *values;
    band_size += std::abs(border[unknown]) * values->cwiseAbs();
  }
  Eigen::VectorXd border_residual = Eigen::VectorXd::Ones(m) - system.corner * border;
  Eigen::VectorXd border_size = Eigen::VectorXd::Ones(m) + system.corner.cwiseAbs() * border.cwiseAbs();
  for (const BorderedSystem::Entry& e : system.rows) {
    border_residual[e.row] -= e.value * band[e.column];
    border_size[e.row] += std::abs(e.value * band[e.column]);
  }
  constexpr double allowed = 1e-8;
  return (band_residual.array().abs() <= allowed * band_size.array()).all() &&
         (border_residual.array().abs() <= allowed * border_size.array()).all();
}

bool BorderedSolver::factorize_blocks(const BorderedSystem& system) {
  const int n = system.matrix.order();
  const auto m = system.corner.rows();
  anchor_count_ = system.anchors.size();
  rows_ = system.rows;

  // K dq - df = -r with df = dg - s dq at the anchors: (K + s) dq - dg = -r, and every border row that holds
  // df gets -s times its coefficient on dq.
  SymmetricBandMatrix stiffened;
  const SymmetricBandMatrix* matrix = &system.matrix;
  if (anchor_count_ > 0) {
    stiffened = system.matrix;
    stiffness_ = 0.0;
    for (const BorderedSystem::Anchor& a : system.anchors) {
      stiffness_ = std::max(stiffness_, std::abs(system.matrix.lower(a.band, a.band)));
    }
    for (const BorderedSystem::Anchor& a : system.anchors) {
      stiffened.lower(a.band, a.band) += stiffness_;
      for (Eigen::Index row = 0; row < m; ++row) {
        const double coefficient = system.corner(row, a.border);
        if (coefficient != 0.0) rows_.push_back({static_cast<int>(row), a.band, -stiffness_ * coefficient});
      }
    }
    matrix = &stiffened;
  }
  if (!factor_.factorize(*matrix)) return false;

  column_of_.clear();
  solved_.setZero(n, static_cast<Eigen::Index>(anchor_count_ + system.columns.size()));
  Eigen::Index k = 0;
  for (const BorderedSystem::Anchor& a : system.anchors) {
    solved_(a.band, k++) = -1.0;
    column_of_.push_back(a.border);
  }
  for (const auto& [border, values] : system.columns) {
    solved_.col(k++) = *values;
    column_of_.push_back(border);
  }
  factor_.solve(solved_);

  Eigen::MatrixXd schur = system.corner;
  for (const BorderedSystem::Entry& entry : rows_) {
    for (Eigen::Index c = 0; c < solved_.cols(); ++c) {
      schur(entry.row, column_of_[static_cast<std::size_t>(c)]) -= entry.value * solved_(entry.column, c);
    }
  }
  if (m == 0) {
    determinant_sign_ = factor_.negative_pivots() % 2 == 0 ? 1 : -1;
    return true;
  }
  // Equations of different units: scale the rows before pivoting. What is not a number has no pivot, which
  // Eigen does not check.
  Eigen::VectorXd scale = schur.rowwise().lpNorm<Eigen::Infinity>();
  if (!schur.allFinite() || scale.minCoeff() == 0.0) return false;
  scale = scale.cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * schur;
  if (!scaled.allFinite()) return false;
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(scaled);
  int sign = factor_.negative_pivots() % 2 == 0 ? 1 : -1;
  sign *= static_cast<int>(lu.permutationP().determinant());
  for (Eigen::Index i = 0; i < m; ++i) {
    const double pivot = lu.matrixLU()(i, i);
    if (pivot == 0.0) return false;
    if (pivot < 0.0) sign = -sign;
  }
  determinant_sign_ = sign;
  inverse_ = lu.inverse() * scale.asDiagonal();
  return inverse_.allFinite();
}

void BorderedSolver::solve(const BorderedSystem& system, Eigen::VectorXd& band,
                           Eigen::VectorXd& border) const {
  if (whole_) {
    Eigen::VectorXd all(band.size() + border.size());
    all << band, border;
    whole_->solve(all);
    band = all.head(band.size());
    border = all.tail(border.size());
    return;
  }
  factor_.solve(band);
  if (border.size() == 0) return;
  for (const BorderedSystem::Entry& entry : rows_) border[entry.row] -= entry.value * band[entry.column];
  border = inverse_ * border;
  for (Eigen::Index c = 0; c < solved_.cols(); ++c) {
    band -= solved_.col(c) * border[column_of_[static_cast<std::size_t>(c)]];
  }
  for (const BorderedSystem::Anchor& a : system.anchors) border[a.border] -= stiffness_ * band[a.band];
}

Eigen::VectorXd BorderedSolver::solved_column(std::size_t k) const {
  return solved_.col(static_cast<Eigen::Index>(anchor_count_ + k));
}

}  // namespace snare::numerics
