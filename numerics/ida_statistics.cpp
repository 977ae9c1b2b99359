#include "numerics/ida_statistics.hpp"

#include <algorithm>

namespace snare::numerics {

IdaStatistics& IdaStatistics::operator+=(const IdaStatistics& other) {
  steps += other.steps;
  residuals += other.residuals;
  jacobians += other.jacobians;
  factorizations += other.factorizations;
  analyses += other.analyses;
  newton_iterations += other.newton_iterations;
  newton_failures += other.newton_failures;
  error_test_failures += other.error_test_failures;
  restarts += other.restarts;
  smallest_step = std::min(smallest_step, other.smallest_step);
  largest_step = std::max(largest_step, other.largest_step);
  integrands += other.integrands;
  residual_seconds += other.residual_seconds;
  jacobian_seconds += other.jacobian_seconds;
  factor_seconds += other.factor_seconds;
  solve_seconds += other.solve_seconds;
  integrand_seconds += other.integrand_seconds;
  return *this;
}

}  // namespace snare::numerics
