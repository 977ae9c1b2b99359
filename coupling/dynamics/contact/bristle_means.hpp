#pragma once

#include "coupling/contact/friction.hpp"

#include <Eigen/Core>

#include <array>

namespace snare::coupling {

/// The bristles of an element's two vertices, seen from a place between them: deflections z [m] and hats
/// there [-].
struct BristlesBeside {
  std::array<Eigen::Vector2d, 2> bristles{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  std::array<double, 2> shape_functions{};
};

/// dz/dt of the bristles at a wire's vertices, a mean over what presses on each:              theory.md (M.9)
///   dz_i/dt = (sum H_i p_e dz/dt(w, z_i) - W z_i/t_0)/(sum H_i p_e + W)
/// with p_e dz/dt by bristle_flow. W is a negligible load by which a bristle that nothing presses on relaxes
/// within t_0. The mean, unlike the sum, gives Newton's method a row of the same size before and after the
/// first touch. The bristle of a vertex stores
///   E_i = mu_s/(2 z_m) (sum H_i p_e + W) z_i^2.
struct BristleMeans {
  Eigen::Matrix2Xd rates;  ///< [m/s]
  Eigen::VectorXd loads;   ///< sum H_i p_e + W [N]

  /// Begins the sums at the deflections z [m], two a vertex.
  template <class Deflections>
  void begin(const Deflections& z) {
    rates = -idle_load / idle_time * z.reshaped(2, z.size() / 2);
    loads = Eigen::VectorXd::Constant(z.size() / 2, idle_load);
  }
  /// load [N]: H_i p_e of a place that is pressed; flow [N m/s]: H_i p_e dz/dt there.
  void add(int vertex, double load, const Eigen::Vector2d& flow) {
    rates.col(vertex) += flow;
    loads[vertex] += load;
  }
  void finish() { rates.array().rowwise() /= loads.array().transpose(); }
  /// -d(dz_i/dt)/dz_i of what forgets [1/s].
  [[nodiscard]] double forgetting(int vertex) const { return idle_load / idle_time / loads[vertex]; }
  /// -d(dz_i/dt) [m/s] by what changes at a place: load_change [N] of H_i p_e, flow_change [N m/s] of H_i p_e
  /// dz/dt.
  [[nodiscard]] Eigen::Vector2d change(int vertex, double load_change,
                                       const Eigen::Vector2d& flow_change) const {
    return (load_change * rates.col(vertex) - flow_change) / loads[vertex];
  }
  /// What the bristles hold at the deflections z [m], and the heat of those that forget; with this friction
  /// [J], [W].
  struct Held {
    double energy = 0.0;
    double heat = 0.0;
  };
  template <class Deflections>
  [[nodiscard]] Held held(const MotionFriction& friction, const Deflections& z) const {
    const double stiffness = friction.static_coefficient / friction.bristle_displacement;
    const Eigen::RowVectorXd squares = z.reshaped(2, z.size() / 2).colwise().squaredNorm();
    return {0.5 * stiffness * squares.dot(loads), stiffness * idle_load / idle_time * squares.sum()};
  }

  static constexpr double idle_load = 1e-6;  ///< W [N]
  static constexpr double idle_time = 1e-2;  ///< t_0 [s]
};

}  // namespace snare::coupling
