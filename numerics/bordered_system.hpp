#pragma once

#include "numerics/band_matrix.hpp"
#include "numerics/sparse_matrix.hpp"

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace snare::numerics {

/// Linear system of a band matrix with a border of m further unknowns and equations:
///
///   [ K  C ] [dq]     [ r_q ]
///   [ D  E ] [db] = - [ r_b ]          K: n x n symmetric band, C: n x m, D: m x n sparse, E: m x m
///
/// Some columns of C are -e_i: border unknown j is the force that holds band unknown i ("anchor"). The solver
/// adds a stiffness to K at the anchors and takes it back through the border (exactly), so that K stays well
/// conditioned where the unloaded structure is soft or unstable; its inertia is then that of the structure
/// held at its contacts.                                                              theory.md (N.3)
class BorderedSystem {
 public:
  struct Entry {
    int row;     ///< border equation
    int column;  ///< band unknown
    double value;
  };
  struct Anchor {
    int band;    ///< band unknown i that is held
    int border;  ///< border unknown j: the force on it
  };

  SymmetricBandMatrix matrix;       ///< K
  Eigen::VectorXd band_residual;    ///< r_q (n)
  Eigen::VectorXd border_residual;  ///< r_b (m)
  Eigen::MatrixXd corner;           ///< E (m x m)
  std::vector<Entry> rows;          ///< D
  std::vector<Anchor> anchors;      ///< columns of C that are -e_i
  /// Dense columns of C: border unknown, values.
  std::vector<std::pair<int, const Eigen::VectorXd*>> columns;

  /// Clears residuals and structure for m border unknowns; K is left to the caller.
  void reset(int n, int m);
};

/// The whole matrix [K C; D E] of a bordered system, order n + m, for solvers that know no border.
[[nodiscard]] SparseMatrix to_sparse(const BorderedSystem& system);

}  // namespace snare::numerics
