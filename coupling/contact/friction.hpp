#pragma once

#include <Eigen/Core>

namespace snare::coupling {

/// How friction answers.                                                                     theory.md (M.9)
enum class ContactFriction {
  stick_slip,  ///< a bristle in series with a slider: rests under load, slides with Coulomb's force
  smooth       ///< Coulomb's force smoothed over the sliding speed: creeps under load
};

/// Coulomb friction between a wire and what it touches.
///
/// The bristle gives by `bristle_displacement` before it slides, whatever the load: its stiffness grows with
/// the normal force. The default is the order of two steel cylinders of 1.5 mm and 6 mm (Mindlin 1949: k = 8
/// a G*, 0.4 um at 10 N): small beside every travel of interest, large beside the tolerances.
struct MotionFriction {
  double static_coefficient = 0.0;  ///< >= 0: up to static_speed [-]
  /// From dynamic_speed on, >= 0; at most the static one with stick and slip [-].
  double dynamic_coefficient = 0.0;
  double static_speed = 1e-3;  ///< smooth: below it the friction falls to zero [m/s], > 0. stick_slip: >= 0
  /// [m/s], > static_speed; stick_slip: both 0 let the slip have the dynamic one at once.
  double dynamic_speed = 1.0;
  ContactFriction law = ContactFriction::stick_slip;
  double bristle_displacement = 1e-6;  ///< of the bristle when it slides [m], > 0
  double bristle_time = 1e-5;          ///< dashpot over spring of the bristle [s], > 0

  /// Whether there is friction at all.
  [[nodiscard]] bool acts() const { return static_coefficient > 0.0 || dynamic_coefficient > 0.0; }
  /// Whether it acts through a bristle: two more unknowns a place.
  [[nodiscard]] bool has_bristle() const { return acts() && law == ContactFriction::stick_slip; }
};

/// Where a bristle stands: its deflection z [m] and the velocity against the other side w [m/s], in N axes of
/// which they span the tangent plane (2) or in space, tangent (3); and how hard the contact presses: the
/// normal force p, which bounds friction, and the part p_e of it that the contact stores as a spring, with
/// which the bristle stiffens (both [N], or loads [N/m]).
template <int N>
struct BristleStateIn {
  Eigen::Vector<double, N> bristle = Eigen::Vector<double, N>::Zero();
  Eigen::Vector<double, N> sliding = Eigen::Vector<double, N>::Zero();
  double normal = 0.0;
  double elastic = 0.0;  ///< of the smooth law: not used
};

/// Friction in the tangent plane and its derivatives. `force` is what the wire exerts on the other side, in
/// the unit of the normal force (or load).
template <int N>
struct TangentForceIn {
  Eigen::Vector<double, N> force = Eigen::Vector<double, N>::Zero();
  Eigen::Matrix<double, N, N> by_bristle = Eigen::Matrix<double, N, N>::Zero();  ///< [N/m]
  Eigen::Matrix<double, N, N> by_sliding = Eigen::Matrix<double, N, N>::Zero();  ///< [N s/m]
  Eigen::Vector<double, N> by_normal = Eigen::Vector<double, N>::Zero();         ///< [-]
  Eigen::Vector<double, N> by_elastic = Eigen::Vector<double, N>::Zero();        ///< [-]
  double slider_speed = 0.0;  ///< of a bristle: at which its slider moves, 0 where it sticks [m/s]

  /// Adds a share [-] of another force with its derivatives, except those by the bristle.
  void add(double share, const TangentForceIn& other) {
    force += share * other.force;
    by_sliding += share * other.by_sliding;
    by_normal += share * other.by_normal;
    by_elastic += share * other.by_elastic;
  }
};

/// Friction by the law that `friction` names.                                              theory.md (M.9)
///
///   smooth:      f = mu(s)/s p w
///   stick_slip:  e = z + tau w,   f = e min(mu_s p_e/z_m, mu(s) p/|e|)
/// Below the bound a bristle is a spring mu_s p_e/z_m with a dashpot; beyond, f is Coulomb's force along e.
template <int N>
[[nodiscard]] TangentForceIn<N> tangent_force(const MotionFriction& friction, const BristleStateIn<N>& at);

/// p_e dz/dt of a bristle under the friction f at this state, less the share of it that a growing load takes,
/// and its derivatives:
///
///   p_e dz/dt = (z_m/mu_s f - p_e z)/tau - G z/2,   G = max(dp_e/dt, -p_e/tau)
/// Where the bristle sticks this is p_e w: it does not creep. The term with G keeps the energy mu_s p_e
/// z^2/(2 z_m) of a bristle whose spring stiffens, so that a rising load stores nothing that nobody has put
/// in. Units: those of p_e times m/s.
template <int N>
struct BristleFlowIn {
  Eigen::Vector<double, N> flow = Eigen::Vector<double, N>::Zero();
  double growth = 0.0;         ///< G [N/s]
  bool growth_follows = true;  ///< G = dp_e/dt, else -p_e/tau
  /// Heat: f.w - d/dt of the energy, of which p_e dz/dt above is a part; never negative [W].
  double heat = 0.0;
};
/// elastic_rate: dp_e/dt [N/s].
template <int N>
[[nodiscard]] BristleFlowIn<N> bristle_flow(const MotionFriction& friction, const BristleStateIn<N>& at,
                                            const TangentForceIn<N>& f, double elastic_rate);
/// Changes along which a bristle's flow changes: of z, of w, of p, p_e and dp_e/dt.
template <int N>
struct BristleChangeIn {
  Eigen::Vector<double, N> bristle = Eigen::Vector<double, N>::Zero();
  Eigen::Vector<double, N> sliding = Eigen::Vector<double, N>::Zero();
  double normal = 0.0, elastic = 0.0, elastic_rate = 0.0;
};
/// The change of `force`: the first derivative of tangent_force, linear in `by`. [N, or N/m of loads]
template <int N>
[[nodiscard]] Eigen::Vector<double, N> force_change(const TangentForceIn<N>& f,
                                                    const BristleChangeIn<N>& by) {
  return f.by_bristle * by.bristle + f.by_sliding * by.sliding + f.by_normal * by.normal +
         f.by_elastic * by.elastic;
}
/// The change of `flow`: the first derivative of bristle_flow, linear in `by`. [N m/s, or N/s of loads]
template <int N>
[[nodiscard]] Eigen::Vector<double, N> flow_change(const MotionFriction& friction,
                                                   const BristleStateIn<N>& at, const TangentForceIn<N>& f,
                                                   const BristleFlowIn<N>& flow,
                                                   const BristleChangeIn<N>& by);

using BristleState = BristleStateIn<2>;
using TangentForce = TangentForceIn<2>;
using BristleFlow = BristleFlowIn<2>;
using BristleChange = BristleChangeIn<2>;

/// Coefficient of friction at a sliding speed [m/s] >= 0 and its derivative [s/m]: static up to static_speed,
/// dynamic from dynamic_speed on, a cubic step between.
struct SlipCoefficient {
  double value = 0.0;
  double slope = 0.0;
};
[[nodiscard]] SlipCoefficient slip_coefficient(const MotionFriction& friction, double speed);

}  // namespace snare::coupling
