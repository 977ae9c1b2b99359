#include "benchmarks/peers/kinsol.hpp"

#include "numerics/sundials.hpp"

#include <kinsol/kinsol.h>
#include <sunlinsol/sunlinsol_klu.h>

#include <cstdlib>
#include <exception>

namespace snare::benchmarks {

using numerics::check;
using numerics::made;
using numerics::SolveReport;
using numerics::SparseMatrix;
using numerics::Termination;

namespace {

struct KinsolDeleter {
  void operator()(void* memory) const noexcept { KINFree(&memory); }
};

/// What the C callbacks reach through their user pointer; an exception waits here until KINSOL has returned.
struct Call {
  const NonlinearSystem& system;
  SparseMatrix jacobian;
  std::exception_ptr failure;
};

Eigen::Map<Eigen::VectorXd> map(N_Vector v) {
  return {N_VGetArrayPointer(v), N_VGetLength(v)};
}

template <class Work>
int guarded(Call& call, const Work& work) {
  try {
    return work() ? 0 : 1;
  } catch (...) {
    call.failure = std::current_exception();
    return -1;
  }
}

/// How the iteration ended. Throws LibraryError for what is wrong with the call rather than with the problem.
Termination meaning(int code) {
  switch (code) {
    case KIN_SUCCESS:
    case KIN_INITIAL_GUESS_OK:
    case KIN_STEP_LT_STPTOL:
      return Termination::converged;
    case KIN_MAXITER_REACHED:
      return Termination::iteration_limit;
    case KIN_LSETUP_FAIL:
    case KIN_LSOLVE_FAIL:
    case KIN_LINSOLV_NO_RECOVERY:
      return Termination::singular_matrix;
    case KIN_FIRST_SYSFUNC_ERR:
    case KIN_REPTD_SYSFUNC_ERR:
    case KIN_SYSFUNC_FAIL:
      return Termination::not_finite;
    case KIN_LINESEARCH_NONCONV:
    case KIN_LINESEARCH_BCFAIL:
    case KIN_MXNEWT_5X_EXCEEDED:
      return Termination::step_too_small;
    default:
      check(code, "KINSol");
      return Termination::step_too_small;
  }
}

extern "C" int kinsol_residual(N_Vector u, N_Vector f, void* data) {
  Call& call = *static_cast<Call*>(data);
  return guarded(call, [&] {
    Eigen::VectorXd residual;
    call.system.residual(map(u), residual);
    map(f) = residual;
    return residual.allFinite();
  });
}

extern "C" int kinsol_jacobian(N_Vector u, N_Vector, SUNMatrix matrix, void* data, N_Vector, N_Vector) {
  Call& call = *static_cast<Call*>(data);
  return guarded(call, [&] {
    call.system.jacobian(map(u), call.jacobian);
    numerics::copy(call.jacobian, matrix);
    return true;
  });
}

}  // namespace

SolveReport solve_kinsol(const NonlinearSystem& system, Eigen::VectorXd& u, const KinsolOptions& options) {
  const sundials::Context context;
  Call call{system, system.pattern, nullptr};
  Eigen::VectorXd ones = Eigen::VectorXd::Ones(u.size());
  const numerics::SunVector unknowns = numerics::view(u, context);
  const numerics::SunVector scale = numerics::view(ones, context);
  const numerics::SunMatrix matrix = numerics::make_matrix(system.pattern, context);
  const numerics::SunLinearSolver linear(
      made(SUNLinSol_KLU(unknowns.get(), matrix.get(), context), "SUNLinSol_KLU"));
  const std::unique_ptr<void, KinsolDeleter> memory(made(KINCreate(context), "KINCreate"));
  void* kin = memory.get();
  check(KINSetErrHandlerFn(
            kin, [](int, const char*, const char*, char*, void*) {}, nullptr),
        "KINSetErrHandlerFn");
  check(KINInit(kin, kinsol_residual, unknowns.get()), "KINInit");
  check(KINSetUserData(kin, &call), "KINSetUserData");
  check(KINSetFuncNormTol(kin, options.residual_tolerance), "KINSetFuncNormTol");
  check(KINSetScaledStepTol(kin, 1e-15), "KINSetScaledStepTol");
  check(KINSetNumMaxIters(kin, options.max_iterations), "KINSetNumMaxIters");
  check(KINSetMaxSetupCalls(kin, 1), "KINSetMaxSetupCalls");
  check(KINSetLinearSolver(kin, linear.get(), matrix.get()), "KINSetLinearSolver");
  check(KINSetJacFn(kin, kinsol_jacobian), "KINSetJacFn");
  const int code = KINSol(kin, unknowns.get(), KIN_LINESEARCH, scale.get(), scale.get());
  if (call.failure) std::rethrow_exception(call.failure);

  const Termination termination = meaning(code);  // throws where it is no failure of the iteration

  SolveReport report;
  long iterations = 0;
  check(KINGetNumNonlinSolvIters(kin, &iterations), "KINGetNumNonlinSolvIters");
  report.iterations = static_cast<int>(iterations);
  Eigen::VectorXd residual;
  system.residual(u, residual);
  report.residual_norm = residual.lpNorm<Eigen::Infinity>() / options.residual_tolerance;
  report.termination = termination;
  // The shortest step ends KINSOL too, wherever that is.
  if (code == KIN_STEP_LT_STPTOL && !(report.residual_norm <= 1.0))
    report.termination = Termination::step_too_small;
  if (!report.usable()) {
    const std::unique_ptr<char, decltype(&std::free)> name(KINGetReturnFlagName(code), &std::free);
    report.message = std::string("KINSOL stopped with ") + name.get();
  }
  return report;
}

}  // namespace snare::benchmarks
