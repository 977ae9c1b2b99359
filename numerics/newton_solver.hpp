#pragma once

#include "numerics/ida_callbacks.hpp"

#include <sundials/sundials_nonlinearsolver.h>

#include <memory>

namespace snare::numerics {

/// Destroys SUNDIALS' nonlinear solver when its handle goes.
struct NonlinearSolverDeleter {
  void operator()(SUNNonlinearSolver s) const noexcept { SUNNonlinSolFree(s); }
};
using SunNonlinearSolver = std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, NonlinearSolverDeleter>;

/// Newton's method on a step of IDA.                                                        theory.md (M.12)
///
/// As SUNDIALS' own, but every unknown must be within its share of its tolerance, and what would not converge
/// with a matrix of an earlier step is given up as soon as that shows. renewals: see IdaOptions. The
/// callbacks stay the caller's and outlive it; `like`: a vector of its size.
[[nodiscard]] SunNonlinearSolver make_newton_solver(IdaCallbacks& callbacks, N_Vector like, int renewals,
                                                    SUNContext context);

}  // namespace snare::numerics
