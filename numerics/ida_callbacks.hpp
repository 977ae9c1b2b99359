#pragma once

#include "numerics/dae.hpp"
#include "numerics/dae_solver.hpp"
#include "numerics/ida_statistics.hpp"
#include "numerics/sundials.hpp"

#include <sundials/sundials_nonlinearsolver.h>

#include <Eigen/Core>

#include <exception>
#include <functional>
#include <memory>

namespace snare::numerics {

/// The numbers of a SUNDIALS vector, of any unit, where they are.
[[nodiscard]] inline Eigen::Map<Eigen::VectorXd> map(N_Vector v) {
  return {N_VGetArrayPointer(v), N_VGetLength(v)};
}

/// What a Newton iteration has to go by.
struct NewtonState {
  double share = 0.0;      ///< of the tolerance that it may leave [-]
  int most = 0;            ///< iterations
  bool renewable = false;  ///< whether slow convergence brings a matrix of the present iterate
  /// Corrections smaller than this share of the first may be larger than the one before [-].
  double may_grow = 0.0;
};

/// What IDA's callbacks in C reach through their user pointer; an exception waits here until IDA has
/// returned.
struct IdaCallbacks {
  DaeSystem& system;
  IdaStatistics statistics;
  std::exception_ptr failure;
  std::unique_ptr<DaeSolver> solver;
  int analysed_pattern = 0;
  std::function<void(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rates)> integrands;  // of the integrals
  Eigen::VectorXd integrated{};  // their rates, as IDA has evaluated them last
  Eigen::VectorXd accepted{};    // unknowns of the last accepted state
  // Of the Newton iteration: the first and the last correction of this step over the tolerances, and what a
  // rate of convergence leaves after one.
  double first_correction = 0.0;         ///< [-]
  double last_correction = 0.0;          ///< [-]
  double rate = 0.0;                     ///< the last correction over the one before [-]
  double remainder = unknown_remainder;  ///< factor on the last correction [-]
  int limiting_unknown = -1;             // the unknown with the largest correction where it did not converge

  static constexpr double unknown_remainder = 20.0;

  /// Where an iteration begins on the way from the accepted unknowns to those of any unit that are told. 0,
  /// positive where the step is out of reach, negative where an exception waits.
  [[nodiscard]] int begin_iteration(const Eigen::Ref<const Eigen::VectorXd>& predicted, double& share);

  /// SUN_NLS_SUCCESS when every unknown is within its share of its tolerance after a step of the iteration,
  /// the first of which has the number 0; SUN_NLS_CONTINUE, or SUN_NLS_CONV_RECVR when it does not converge.
  ///                                                                                         theory.md (M.12)
  [[nodiscard]] int converged(int iteration, const NewtonState& at,
                              const Eigen::Ref<const Eigen::VectorXd>& step,
                              const Eigen::Ref<const Eigen::VectorXd>& weight);

  Eigen::VectorXd relative{};   // tolerance, zero where none acts
  Eigen::VectorXd tolerance{};  // absolute
  Eigen::VectorXd scale{};  // of both tolerances: makes IDA's mean over unknowns one over blocks (see Ida)
};

// What IDA calls; the last argument is the IdaCallbacks. 0: done, positive: try a smaller step, negative: an
// exception waits.
extern "C" {
int snare_ida_residual(realtype t, N_Vector y, N_Vector rate, N_Vector rows, void* data);
/// Of the error test: one over the tolerances.
int snare_ida_weights(N_Vector y, N_Vector weights, void* data);
int snare_ida_jacobian(realtype t, realtype c, N_Vector y, N_Vector rate, N_Vector rows, SUNMatrix matrix,
                       void* data, N_Vector work1, N_Vector work2, N_Vector work3);
int snare_ida_events(realtype t, N_Vector y, N_Vector rate, realtype* values, void* data);
int snare_ida_integrands(realtype t, N_Vector y, N_Vector rate, N_Vector values, void* data);
}

/// A DaeSolver on the system's matrix. The callbacks stay the caller's and outlive it.
[[nodiscard]] SunLinearSolver make_linear_solver(IdaCallbacks& callbacks, SUNContext context);

}  // namespace snare::numerics
