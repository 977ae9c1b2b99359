#pragma once

#include <limits>

namespace snare::numerics {

/// What was done since the integrator was made.
struct IdaStatistics {
  long steps = 0;
  long residuals = 0;
  long jacobians = 0;
  long factorizations = 0;
  long analyses = 0;  ///< of the sparse pattern
  long newton_iterations = 0;
  long newton_failures = 0;
  long error_test_failures = 0;
  long restarts = 0;  ///< starts at first order, the first one included
  double smallest_step = std::numeric_limits<double>::infinity();  ///< [s]
  double largest_step = 0.0;                                       ///< [s]
  long integrands = 0;             ///< evaluations of the rates of IdaIntegrals
  double residual_seconds = 0.0;   ///< wall time in residuals [s]
  double jacobian_seconds = 0.0;   ///< in Jacobians
  double factor_seconds = 0.0;     ///< in KLU's analysis and factorisation
  double solve_seconds = 0.0;      ///< in KLU's solution
  double integrand_seconds = 0.0;  ///< in the rates of IdaIntegrals

  /// Adds what another integration of the same motion did.
  IdaStatistics& operator+=(const IdaStatistics& other);
};

}  // namespace snare::numerics
