#pragma once

#include "numerics/band_matrix.hpp"
#include "numerics/bordered_system.hpp"
#include "numerics/klu.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace snare::numerics {

/// Block factorisation of a BorderedSystem; keeps K^-1 C for further right-hand sides. Where K with its
/// anchors is singular although the whole is not, KLU factorises the whole: when the blocks cannot be
/// factorised, or when a pivot of K is mostly round-off and a trial solution has a componentwise backward
/// error above 1e-8. Unknowns and residuals of any unit.
class BorderedSolver {
 public:
  /// False when the whole system is singular.
  [[nodiscard]] bool factorize(const BorderedSystem& system);
  /// Whether the block factorisation holds; inertia and solved columns are known only then.
  [[nodiscard]] bool blockwise() const noexcept { return !whole_; }

  /// Solves with right-hand sides (b_q, b_b), each given negated residuals or any other load; in place.
  void solve(const BorderedSystem& system, Eigen::VectorXd& band, Eigen::VectorXd& border) const;

  /// Negative eigenvalues of K held at its anchors.
  [[nodiscard]] int negative_pivots() const noexcept { return factor_.negative_pivots(); }
  /// Smallest over largest |pivot| of K [-]: see BandLdlt.
  [[nodiscard]] double pivot_ratio() const noexcept { return factor_.pivot_ratio(); }
  /// Sign of the determinant of the whole system: +1, -1, or 0. It changes at folds and simple bifurcations.
  [[nodiscard]] int determinant_sign() const noexcept { return determinant_sign_; }
  /// K^-1 of the k-th dense column of the system that was factorised.
  [[nodiscard]] Eigen::VectorXd solved_column(std::size_t k) const;

 private:
  [[nodiscard]] bool factorize_blocks(const BorderedSystem& system);
  [[nodiscard]] bool blocks_are_accurate(const BorderedSystem& system) const;

  BandLdlt factor_;
  std::optional<Klu> whole_;
  double stiffness_ = 0.0;      // added at the anchors
  Eigen::MatrixXd solved_;      // K^-1 [anchor columns, dense columns]
  std::vector<int> column_of_;  // border unknown of each column of solved_
  std::size_t anchor_count_ = 0;
  std::vector<BorderedSystem::Entry> rows_;  // D with the anchors' stiffness taken back
  Eigen::MatrixXd inverse_;                  // of the Schur complement
  int determinant_sign_ = 0;
};

}  // namespace snare::numerics
