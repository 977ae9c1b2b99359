#include "numerics/newton_solver.hpp"

#include "numerics/correction_guess.hpp"
#include "numerics/quasi_newton.hpp"

#include <idas/idas.h>

#include <optional>
#include <utility>

namespace snare::numerics {

namespace {

constexpr int most_with_own = 8;    // iterations with a matrix of the step, but for those after a renewal
constexpr int most_with_old = 4;    // with that of an earlier step: a new one costs about as much
constexpr int most_corrected = 12;  // with such a one that is corrected
// From where a touch begins, and the share of the first correction that later ones stay below while its load
// finds its depth.
constexpr int most_at_touch = 20, renewals_at_touch = 10;
constexpr double may_grow_at_touch = 0.1;
constexpr double slow = 0.25;       // rate of convergence beyond which a new matrix pays
constexpr double on_its_way = 0.5;  // rate below which what an old matrix has corrected is kept
// Of the share, with a matrix of another leading coefficient. Forces within are in balance whatever the
// matrix; with the inertia of another step momentum is not.
constexpr double with_other_inertia = 0.4;

struct Newton {
  IdaCallbacks& callbacks;
  N_Vector step;  // workspace
  int most_renewals;
  std::optional<QuasiNewton> corrected;  // where a step may have renewals
  CorrectionGuess guess{};
  double coefficient = 0.0;      // leading one, of the matrix
  bool jacobian_aged = false;    // the matrix of an earlier step took as many iterations as a new one costs
  bool jacobian_failed = false;  // and at the last step it did not do at all
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

// A start of IDA.
int snare_newton_initialize(SUNNonlinearSolver solver) {
  content(solver).guess.restart();
  content(solver).jacobian_aged = content(solver).jacobian_failed = false;
  return SUN_NLS_SUCCESS;
}

// The state that is corrected and the order and length of the step, as IDA tries it.
void guess_correction(CorrectionGuess& guess, void* ida, N_Vector correction) {
  long accepted = 0;
  int order = 0;
  double time = 0.0, step = 0.0;
  static_cast<void>(IDAGetNumSteps(ida, &accepted));
  static_cast<void>(IDAGetCurrentOrder(ida, &order));
  static_cast<void>(IDAGetCurrentTime(ida, &time));
  static_cast<void>(IDAGetCurrentStep(ida, &step));
  guess.begin(accepted, time - step, time, order, map(correction));
}

// Evaluates the first guess, or moves it back to where a touch begins.
int evaluate_guess(Newton& self, void* ida, N_Vector correction, bool& touches) {
  touches = false;
  if (const int code = self.system(correction, self.step, ida); code != SUN_NLS_SUCCESS) return code;
  double time = 0.0, coefficient = 0.0, share = 1.0;
  N_Vector predicted{}, predicted_rate{}, guess{}, guess_rate{}, rows{};
  void* user = nullptr;
  static_cast<void>(IDAGetNonlinearSystemData(ida, &time, &predicted, &predicted_rate, &guess, &guess_rate,
                                              &rows, &coefficient, &user));
  const int code = self.callbacks.begin_iteration(map(guess), share);
  if (code != 0) return code > 0 ? SUN_NLS_CONV_RECVR : code;
  touches = share < 1.0;
  if (!touches) return SUN_NLS_SUCCESS;
  map(correction) -= (1.0 - share) * (map(guess) - self.callbacks.accepted);
  return self.system(correction, self.step, ida);
}

int snare_newton_solve(SUNNonlinearSolver solver, N_Vector, N_Vector correction, N_Vector weight,
                       realtype share, booleantype call_setup, void* memory) {
  Newton& self = content(solver);
  IdaCallbacks& callbacks = self.callbacks;
  self.iterations = self.failures = 0;  // IDA adds them up
  booleantype current = SUNFALSE;       // whether the matrix is of this step
  bool bad = false;
  double coefficient = 0.0;  // of the step
  static_cast<void>(IDAGetCurrentCj(memory, &coefficient));
  guess_correction(self.guess, memory, correction);
  if (self.jacobian_aged || (self.jacobian_failed && coefficient != self.coefficient)) call_setup = SUNTRUE;
  self.jacobian_aged = self.jacobian_failed = false;
  bool touches = false;
  int code = evaluate_guess(self, memory, correction, touches);
  if (touches) call_setup = SUNTRUE;
  const int most_renewals = touches ? renewals_at_touch : self.most_renewals;
  while (true) {
    if (code == SUN_NLS_SUCCESS && call_setup != SUNFALSE) {
      code = self.setup(bad ? SUNTRUE : SUNFALSE, &current, memory);
      self.coefficient = coefficient;
    }
    if (code != SUN_NLS_SUCCESS) {  // no matter of the matrix
      ++self.failures;
      return code;
    }
    const NewtonState limits{self.coefficient == coefficient ? share : with_other_inertia * share,
                             touches               ? most_at_touch
                             : current != SUNFALSE ? most_with_own + self.most_renewals
                             : self.corrected      ? most_corrected
                                                   : most_with_old,
                             current != SUNFALSE && most_renewals > 0, touches ? may_grow_at_touch : 0.0};
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
      code = callbacks.converged(k, limits, step, map(weight));
      if (code == SUN_NLS_SUCCESS) {
        self.jacobian_aged = current == SUNFALSE && k + 1 >= most_with_old;
        if (touches)
          self.guess.restart();  // the next step corrects something else
        else
          self.guess.end(map(correction), map(weight));
        return SUN_NLS_SUCCESS;
      }
      if (code != SUN_NLS_CONTINUE) break;
      if (k + 1 >= limits.most) {
        code = SUN_NLS_CONV_RECVR;
        break;
      }
      code = self.system(correction, self.step, memory);
      // A touch stiffens with its depth: what the matrix of the first guess corrects slowly, that of the
      // present one does.
      if (code == SUN_NLS_SUCCESS && current != SUNFALSE && k > 0 && callbacks.rate > slow &&
          renewals < most_renewals) {
        code = self.setup(SUNTRUE, &current, memory);
        if (self.corrected) self.corrected->restart();
        ++renewals;
      }
    }
    ++self.failures;
    if (code <= 0 || current != SUNFALSE) return code;
    // With a matrix of this step once more, from where the old one was on its way to.
    call_setup = SUNTRUE;
    self.jacobian_failed = true;
    bad = true;
    if (!(code == SUN_NLS_CONV_RECVR && callbacks.rate < on_its_way && map(correction).allFinite()))
      map(correction).setZero();
    code = self.system(correction, self.step, memory);
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

SunNonlinearSolver make_newton_solver(IdaCallbacks& callbacks, N_Vector like, int renewals,
                                      SUNContext context) {
  SunNonlinearSolver solver(made(SUNNonlinSolNewEmpty(context), "SUNNonlinSolNewEmpty"));
  solver->ops->gettype = snare_newton_type;
  solver->ops->solve = snare_newton_solve;
  solver->ops->free = snare_newton_free;
  solver->ops->initialize = snare_newton_initialize;
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
