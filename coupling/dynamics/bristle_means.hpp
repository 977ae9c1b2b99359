#pragma once

#include "coupling/contact/friction.hpp"

#include <Eigen/Core>

namespace snare::coupling {

/// dz/dt of the bristles at a wire's vertices, a mean over what presses on each:                    theory.md (M.9)
///   dz_i/dt = (sum H_i p dz/dt(w, z_i) - W z_i/t_0)/(sum H_i p + W)
/// W is a load that matters nowhere but makes bristles forget in t_0 what they held when nothing presses any more. As a mean it
/// does not meet Newton's method with a row that nothing has weighed until the first touch.
struct BristleMeans {
  Eigen::Matrix2Xd rates;  ///< [m/s]
  Eigen::VectorXd loads;   ///< sum H_i p + W [N]

  /// Begins the sums at the deflections z [m], two a vertex.
  template <class Deflections>
  void begin(const Deflections& z) {
    rates = -idle_load / idle_time * z.reshaped(2, z.size() / 2);
    loads = Eigen::VectorXd::Constant(z.size() / 2, idle_load);
  }
  /// load [N]: H_i p of a place that is pressed, with the rate [m/s] that the vertex's bristle would have there.
  void add(int vertex, double load, const Eigen::Vector2d& rate) {
    rates.col(vertex) += load * rate;
    loads[vertex] += load;
  }
  void finish() { rates.array().rowwise() /= loads.array().transpose(); }
  /// -d(dz_i/dt)/dz_i of what forgets [1/s].
  [[nodiscard]] double forgetting(int vertex) const { return idle_load / idle_time / loads[vertex]; }
  /// -d(dz_i/dt) [m/s] by what changes at a place with the weight H_i [-]: -(d(p r) - mean dp)/load, r the rate there. load_change: dp [N].
  [[nodiscard]] Eigen::Vector2d change(int vertex, double weight, double load_change, const Eigen::Vector2d& rate,
                                       const Eigen::Vector2d& load_times_rate_change) const {
    return weight / loads[vertex] * (load_change * (rates.col(vertex) - rate) - load_times_rate_change);
  }

 private:
  static constexpr double idle_load = 1e-6;  // W [N]
  static constexpr double idle_time = 1e-2;  // t_0 [s]
};

}  // namespace snare::coupling
