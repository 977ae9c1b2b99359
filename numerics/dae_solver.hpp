#pragma once

#include "numerics/condensation.hpp"
#include "numerics/klu.hpp"
#include "numerics/sparse_matrix.hpp"
#include "numerics/static_lu.hpp"

#include <Eigen/Core>

#include <optional>
#include <utility>
#include <vector>

namespace snare::numerics {

/// Solves with the Jacobian of a DAE: without rates of places, (N.6), by a factorisation without pivoting,
/// (N.7), refined where the first solution after a factorisation shows that digits are lost, and by KLU where
/// that does not help. Of any unit.
class DaeSolver {
 public:
  /// pairs: see Condensation.
  DaeSolver(const SparseMatrix& pattern, const std::vector<std::pair<int, int>>& pairs);

  /// The pairs that are condensed: see Condensation.
  [[nodiscard]] const std::vector<std::pair<int, int>>& pairs() const noexcept {
    return condensation_.pairs();
  }
  /// False when the matrix is singular. Throws LibraryError when memory runs out.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);
  /// Solves A x = b in place; `matrix` is that of the last factorisation. False when it is singular after
  /// all.
  [[nodiscard]] bool solve(const SparseMatrix& matrix, Eigen::Ref<Eigen::VectorXd> b);
  /// How many factorisations needed pivoting.
  [[nodiscard]] long pivoted() const noexcept { return pivoted_; }

 private:
  [[nodiscard]] bool pivot();
  /// False where digits are lost even so.
  [[nodiscard]] bool solve_without_pivots();
  template <bool with_size>
  void find_rest();
  [[nodiscard]] double backward_error();

  Condensation condensation_;
  bool no_rates_;
  std::optional<StaticLu> lu_;  // made with the first values
  std::optional<Klu> klu_;
  bool by_klu_ = false;
  bool tried_ = false;    // a solution of the last factorisation has been looked at
  bool refined_ = false;  // its solutions need what is left of the equations solved for
  long pivoted_ = 0;
  Eigen::VectorXd right_, solution_;
  Eigen::VectorXd rest_;  // b - A x
  Eigen::VectorXd size_;  // |A| |x| + |b|
};

}  // namespace snare::numerics
