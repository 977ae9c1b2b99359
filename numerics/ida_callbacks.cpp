#include "numerics/ida_callbacks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace snare::numerics {

namespace {

/// Adds the wall time of a scope.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_;
};

/// A false result is positive for IDA: it tries a smaller step.
template <class Work>
int guarded(IdaCallbacks& callbacks, const Work& work) {
  try {
    return work() ? 0 : 1;
  } catch (...) {
    callbacks.failure = std::current_exception();
    return -1;
  }
}

}  // namespace

extern "C" int snare_ida_residual(realtype t, N_Vector y, N_Vector rate, N_Vector rows, void* data) {
  auto& self = *static_cast<IdaCallbacks*>(data);
  return guarded(self, [&] {
    const Stopwatch watch(self.statistics.residual_seconds);
    ++self.statistics.residuals;
    auto out = map(rows);
    self.system.residual({t, map(y), map(rate)}, out);
    return out.allFinite();
  });
}

// One over the tolerance of each unknown, w_i = 1/(s_i (r_i |y_i| + a_i)): an error e passes by the mean of
// (w_i e_i)^2.
extern "C" int snare_ida_weights(N_Vector y, N_Vector weights, void* data) {
  const auto& self = *static_cast<const IdaCallbacks*>(data);
  auto out = map(weights);
  out = (self.scale.array() * (self.relative.array() * map(y).array().abs() + self.tolerance.array()))
            .inverse();
  return out.allFinite() ? 0 : -1;
}

// The values stay in the system's own matrix, where the linear solver finds them; IDA's is a place-holder.
extern "C" int snare_ida_jacobian(realtype t, realtype c, N_Vector y, N_Vector rate, N_Vector, SUNMatrix,
                                  void* data, N_Vector, N_Vector, N_Vector) {
  auto& self = *static_cast<IdaCallbacks*>(data);
  return guarded(self, [&] {
    const Stopwatch watch(self.statistics.jacobian_seconds);
    ++self.statistics.jacobians;
    self.system.jacobian({t, map(y), map(rate)}, c);
    return true;
  });
}

extern "C" int snare_ida_events(realtype t, N_Vector y, N_Vector rate, realtype* values, void* data) {
  auto& self = *static_cast<IdaCallbacks*>(data);
  return guarded(self, [&] {
    self.system.events({t, map(y), map(rate)}, {values, static_cast<std::size_t>(self.system.event_count())});
    return true;
  });
}

extern "C" int snare_ida_integrands(realtype t, N_Vector y, N_Vector rate, N_Vector values, void* data) {
  auto& self = *static_cast<IdaCallbacks*>(data);
  return guarded(self, [&] {
    const Stopwatch watch(self.statistics.integrand_seconds);
    ++self.statistics.integrands;
    auto out = map(values);
    out.setZero();
    self.integrands({t, map(y), map(rate)}, out);
    self.integrated = out;
    return out.allFinite();
  });
}

int IdaCallbacks::begin_iteration(const Eigen::Ref<const Eigen::VectorXd>& predicted, double& share) {
  return guarded(*this, [&] {
    const IterationStart start = system.iteration_start(accepted, predicted);
    share = start.share;
    return !start.out_of_reach;
  });
}

// IDA's own test bounds the root mean square over all unknowns and takes the rate of an earlier step for
// granted: one unknown among hundreds, a constraint's or a quaternion's, may then be left far outside its
// tolerance, and what is quadratic in it drifts. Here every unknown must be within its share, and no rate is
// believed to be better than 1 in 10. What would not get there with its matrix within the iterations that are
// left is given up at once: they would be lost.
int IdaCallbacks::converged(int iteration, const NewtonState& at,
                            const Eigen::Ref<const Eigen::VectorXd>& step,
                            const Eigen::Ref<const Eigen::VectorXd>& weight) {
  constexpr double best_rate = 0.1;
  constexpr double worst_rate = 0.9;
  constexpr double converged_at_once = 1e-4;  // of the share
  constexpr double of_round_off = 1e-4;       // of the tolerance
  const double size = step.cwiseProduct(weight).lpNorm<Eigen::Infinity>();
  const auto give_up = [&] {
    step.cwiseProduct(weight).cwiseAbs().maxCoeff(&limiting_unknown);
    return SUN_NLS_CONV_RECVR;
  };
  if (!std::isfinite(size)) return SUN_NLS_CONV_RECVR;
  if (iteration == 0) {
    first_correction = size;
    if (size <= converged_at_once * at.share) return SUN_NLS_SUCCESS;
  } else {
    rate = size / last_correction;
    // What no longer shrinks is round-off, when it is far below the tolerance.
    if (size <= of_round_off && rate > worst_rate) return SUN_NLS_SUCCESS;
    if (rate > worst_rate && !(size < at.may_grow * first_correction)) return give_up();
    remainder = rate < worst_rate ? rate / (1.0 - rate) : unknown_remainder;
    const int left = at.most - 1 - iteration;
    if (!at.renewable && size * std::pow(rate, left) * std::max(remainder, best_rate) > at.share)
      return give_up();
  }
  last_correction = size;
  if (iteration + 1 >= at.most) static_cast<void>(give_up());  // should it not be enough
  return std::max(remainder, best_rate) * size <= at.share ? SUN_NLS_SUCCESS : SUN_NLS_CONTINUE;
}

namespace {

IdaCallbacks& content(SUNLinearSolver solver) {
  return *static_cast<IdaCallbacks*>(solver->content);
}

extern "C" SUNLinearSolver_Type snare_linear_type(SUNLinearSolver) {
  return SUNLINEARSOLVER_DIRECT;
}

extern "C" int snare_linear_setup(SUNLinearSolver solver, SUNMatrix) {
  IdaCallbacks& self = content(solver);
  return guarded(self, [&] {
    const Stopwatch watch(self.statistics.factor_seconds);
    self.remainder = IdaCallbacks::unknown_remainder;
    if (!self.solver || self.analysed_pattern != self.system.pattern_version()) {
      self.solver = std::make_unique<DaeSolver>(self.system.matrix(), self.system.rates());
      self.analysed_pattern = self.system.pattern_version();
      ++self.statistics.analyses;
    }
    ++self.statistics.factorizations;
    return self.solver->factorize(self.system.matrix());
  });
}

extern "C" int snare_linear_solve(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, realtype) {
  IdaCallbacks& self = content(solver);
  return guarded(self, [&] {
    const Stopwatch watch(self.statistics.solve_seconds);
    auto solution = map(x);
    solution = map(b);
    return self.solver->solve(self.system.matrix(), solution) && solution.allFinite();
  });
}

}  // namespace

SunLinearSolver make_linear_solver(IdaCallbacks& callbacks, SUNContext context) {
  SunLinearSolver solver(made(SUNLinSolNewEmpty(context), "SUNLinSolNewEmpty"));
  solver->ops->gettype = snare_linear_type;
  solver->ops->setup = snare_linear_setup;
  solver->ops->solve = snare_linear_solve;
  solver->ops->free = [](SUNLinearSolver s) {
    s->content = nullptr;  // ours
    SUNLinSolFreeEmpty(s);
    return 0;
  };
  solver->content = &callbacks;
  return solver;
}

}  // namespace snare::numerics
