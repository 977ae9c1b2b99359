#include "numerics/sparse_eigen.hpp"

#include <Spectra/GenEigsSolver.h>

#include <algorithm>

namespace snare::numerics {

namespace {

/// What Spectra asks of a matrix.
class Applied {
 public:
  using Scalar = double;
  Applied(const LinearMap& map, int order) : map_(map), order_(order) {}
  [[nodiscard]] Eigen::Index rows() const { return order_; }
  [[nodiscard]] Eigen::Index cols() const { return order_; }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd> result(y, order_);
    map_(Eigen::Map<const Eigen::VectorXd>(x, order_), result);
  }

 private:
  const LinearMap& map_;
  int order_;
};

}  // namespace

GeneralEigen largest_eigenvalues(const LinearMap& map, int order, int count) {
  constexpr int most_restarts = 300;
  constexpr double tolerance = 1e-10;  // of an eigenvalue, relative
  Applied applied(map, order);
  Spectra::GenEigsSolver<Applied> solver(applied, count, std::min(order, 2 * count + 20));
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, most_restarts, tolerance);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace snare::numerics
