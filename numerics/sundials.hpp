#pragma once

#include "base/errors.hpp"
#include "numerics/sparse_matrix.hpp"

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>
#include <sundials/sundials_context.hpp>

#include <Eigen/Core>

#include <memory>
#include <string>

namespace snare::numerics {

/// Destroys a vector of SUNDIALS when its handle goes.
struct VectorDeleter {
  void operator()(N_Vector v) const noexcept { N_VDestroy(v); }
};
/// Destroys a matrix of SUNDIALS when its handle goes.
struct MatrixDeleter {
  void operator()(SUNMatrix m) const noexcept { SUNMatDestroy(m); }
};
/// Destroys a linear solver of SUNDIALS when its handle goes.
struct LinearSolverDeleter {
  void operator()(SUNLinearSolver s) const noexcept { SUNLinSolFree(s); }
};
using SunVector = std::unique_ptr<std::remove_pointer_t<N_Vector>, VectorDeleter>;
using SunMatrix = std::unique_ptr<std::remove_pointer_t<SUNMatrix>, MatrixDeleter>;
using SunLinearSolver = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, LinearSolverDeleter>;

/// Throws LibraryError{function, code, meaning} for a negative return code of a set-up function.
void check(int code, const std::string& function);
/// Throws LibraryError when a SUNDIALS object was not made.
template <class Pointer>
Pointer made(Pointer object, const std::string& function) {
  if (object == nullptr) throw base::LibraryError(function, 0, "the object could not be made");
  return object;
}

/// A serial vector that looks at the storage of `v`. Of any unit.
[[nodiscard]] SunVector view(Eigen::VectorXd& v, SUNContext context);
/// A sparse matrix in compressed columns with room for the pattern.
[[nodiscard]] SunMatrix make_matrix(const SparseMatrix& pattern, SUNContext context);
/// Copies pattern and values.
void copy(const SparseMatrix& from, SUNMatrix to);

}  // namespace snare::numerics
