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

/// A negligible load W [N] on every bristle, which keeps its equation regular without contact.
inline constexpr double idle_load = 1e-6;

/// The rate 1/t at which a bristle forgets its deflection under a load P that includes the idle one [N]:
///   dz/dt = ... - z/t,   1/t = 10 (W/P)^3/tau
/// A bristle is straight at every new touch, and a loaded one does not creep.                 theory.md (M.9)
/// time: tau [s], > 0. [1/s]
template <class S>
[[nodiscard]] S forgetting_rate(const S& load, double time) {
  const S share = idle_load / load;
  return 10.0 * share * share * share / time;
}

/// dz/dt of the bristles at a wire's vertices, a mean over what presses on each:              theory.md (M.9)
///   dz_i/dt = sum H_i p_e dz/dt(w, z_i)/P_i - z_i/t(P_i),   P_i = sum H_i p_e + W
/// with p_e dz/dt by bristle_flow and 1/t by forgetting_rate. The mean, unlike the sum, gives Newton's method
/// a row of the same size before and after the first touch. The bristle of a vertex stores
///   E_i = mu_s/(2 z_m) P_i z_i^2.
class BristleMeans {
 public:
  Eigen::Matrix2Xd rates;  ///< [m/s]
  Eigen::VectorXd loads;   ///< P_i [N]

  /// Begins the sums.
  void begin(Eigen::Index vertices) {
    rates = Eigen::Matrix2Xd::Zero(2, vertices);
    loads = Eigen::VectorXd::Constant(vertices, idle_load);
  }
  /// load [N]: H_i p_e of a place that is pressed; flow [N m/s]: H_i p_e dz/dt there.
  void add(int vertex, double load, const Eigen::Vector2d& flow) {
    rates.col(vertex) += flow;
    loads[vertex] += load;
  }
  /// Ends the sums at the deflections z [m], two a vertex, of bristles with this time tau [s].
  template <class Deflections>
  void finish(const Deflections& z, double time) {
    forgetting_ = loads.unaryExpr([time](double load) { return forgetting_rate(load, time); });
    forgotten_ = z.reshaped(2, loads.size()) * forgetting_.asDiagonal();
    rates.array().rowwise() /= loads.array().transpose();
    rates -= forgotten_;
  }
  /// -d(dz_i/dt)/dz_i of what forgets [1/s].
  [[nodiscard]] double forgetting(int vertex) const { return forgetting_[vertex]; }
  /// -d(dz_i/dt) [m/s] by what changes at a place: load_change [N] of H_i p_e, flow_change [N m/s] of H_i p_e
  /// dz/dt.
  [[nodiscard]] Eigen::Vector2d change(int vertex, double load_change,
                                       const Eigen::Vector2d& flow_change) const {
    const Eigen::Vector2d by_load = rates.col(vertex) - 2.0 * forgotten_.col(vertex);
    return (load_change * by_load - flow_change) / loads[vertex];
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
    const Eigen::VectorXd stored =
        stiffness * loads.cwiseProduct(z.reshaped(2, loads.size()).colwise().squaredNorm().transpose());
    return {0.5 * stored.sum(), forgetting_.dot(stored)};
  }

 private:
  Eigen::VectorXd forgetting_;  // of every bristle [1/s]
  Eigen::Matrix2Xd forgotten_;  // z of it [m/s]
};

}  // namespace snare::coupling
