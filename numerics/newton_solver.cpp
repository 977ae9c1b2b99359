#include "numerics/newton_solver.hpp"

#include "numerics/quasi_newton.hpp"

#include <optional>
#include <utility>

namespace snare::numerics {

namespace {

constexpr int most = 4;             // iterations, but for those after a renewal
constexpr int most_corrected = 12;  // with a matrix of an earlier step that is corrected: a new one costs ten
constexpr double slow = 0.25;       // rate of convergence beyond which a new matrix pays

struct Newton {
  IdaCallbacks& callbacks;
  N_Vector step;  // workspace
  int most_renewals;
  std::optional<QuasiNewton> corrected;  // where a step may have renewals
  SUNNonlinSolSysFn system = nullptr;
  SUNNonlinSolLSetupFn setup = nullptr;
  SUNNonlinSolLSolveFn solve = nullptr;
  long iterations = 0;
  long failures = 0;
};

Newton& content(SUNNonlinearSolver solver) {
  return *static_cast<Newton*>(solver->content);
}

extern "C" {

SUNNonlinearSolver_Type snare_newton_type(SUNNonlinearSolver) {
  return SUNNONLINEARSOLVER_ROOTFIND;
}

int snare_newton_solve(SUNNonlinearSolver solver, N_Vector, N_Vector correction, N_Vector weight, realtype share,
                       booleantype call_setup, void* memory) {
  Newton& self = content(solver);
  IdaCallbacks& callbacks = self.callbacks;
  self.iterations = self.failures = 0;  // IDA adds them up
  booleantype current = SUNFALSE;       // whether the matrix is of this step
  bool bad = false;
  while (true) {
    int code = self.system(correction, self.step, memory);
    if (code == SUN_NLS_SUCCESS && call_setup != SUNFALSE)
      code = self.setup(bad ? SUNTRUE : SUNFALSE, &current, memory);
    if (code != SUN_NLS_SUCCESS) {  // no matter of the matrix
      ++self.failures;
      return code;
    }
    int renewals = 0;
    if (self.corrected) self.corrected->restart();
    for (int k = 0; code == SUN_NLS_SUCCESS; ++k) {
      ++self.iterations;
      auto step = map(self.step);
      step = -step;
      code = self.solve(self.step, memory);
      if (code != SUN_NLS_SUCCESS) break;
      if (self.corrected) self.corrected->update(step, map(weight));
      map(correction) += step;
      const int last = current != SUNFALSE ? most + self.most_renewals : self.corrected ? most_corrected : most;
      code = callbacks.converged(k, {share, last, current != SUNFALSE}, step, map(weight));
      if (code == SUN_NLS_SUCCESS) return SUN_NLS_SUCCESS;
      if (code != SUN_NLS_CONTINUE) break;
      if (k + 1 >= last) {
        code = SUN_NLS_CONV_RECVR;
        break;
      }
      code = self.system(correction, self.step, memory);
      // A touch stiffens with its depth: what the matrix of the first guess corrects slowly, that of the present one does.
      if (code == SUN_NLS_SUCCESS && current != SUNFALSE && k > 0 && callbacks.rate > slow &&
          renewals < self.most_renewals) {
        code = self.setup(SUNTRUE, &current, memory);
        self.corrected->restart();
        ++renewals;
      }
    }
    ++self.failures;
    if (code <= 0 || current != SUNFALSE) return code;
    // With a matrix of this step once more.
    call_setup = SUNTRUE;
    bad = true;
    map(correction).setZero();
  }
}

int snare_newton_free(SUNNonlinearSolver solver) {
  if (solver == nullptr) return SUN_NLS_SUCCESS;
  N_VDestroy(content(solver).step);
  delete static_cast<Newton*>(solver->content);
  solver->content = nullptr;
  SUNNonlinSolFreeEmpty(solver);
  return SUN_NLS_SUCCESS;
}

int snare_newton_set_system(SUNNonlinearSolver solver, SUNNonlinSolSysFn system) {
  content(solver).system = system;
  return SUN_NLS_SUCCESS;
}

int snare_newton_set_setup(SUNNonlinearSolver solver, SUNNonlinSolLSetupFn setup) {
  content(solver).setup = setup;
  return SUN_NLS_SUCCESS;
}

int snare_newton_set_solve(SUNNonlinearSolver solver, SUNNonlinSolLSolveFn solve) {
  content(solver).solve = solve;
  return SUN_NLS_SUCCESS;
}

int snare_newton_iterations(SUNNonlinearSolver solver, long* count) {
  *count = content(solver).iterations;
  return SUN_NLS_SUCCESS;
}

int snare_newton_failures(SUNNonlinearSolver solver, long* count) {
  *count = content(solver).failures;
  return SUN_NLS_SUCCESS;
}
}

}  // namespace

SunNonlinearSolver make_newton_solver(IdaCallbacks& callbacks, N_Vector like, int renewals, SUNContext context) {
  SunNonlinearSolver solver(made(SUNNonlinSolNewEmpty(context), "SUNNonlinSolNewEmpty"));
  solver->ops->gettype = snare_newton_type;
  solver->ops->solve = snare_newton_solve;
  solver->ops->free = snare_newton_free;
  solver->ops->setsysfn = snare_newton_set_system;
  solver->ops->setlsetupfn = snare_newton_set_setup;
  solver->ops->setlsolvefn = snare_newton_set_solve;
  solver->ops->getnumiters = snare_newton_iterations;
  solver->ops->getnumconvfails = snare_newton_failures;
  std::optional<QuasiNewton> corrected;
  if (renewals > 0) corrected.emplace(N_VGetLength(like), most_corrected);
  solver->content = new Newton{callbacks, made(N_VClone(like), "N_VClone"), renewals, std::move(corrected)};
  return solver;
}

}  // namespace snare::numerics
