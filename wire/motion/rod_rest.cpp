#include "wire/motion/rod_rest.hpp"

#include "numerics/klu.hpp"
#include "wire/statics/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace snare::wire {

using Eigen::VectorXd;

namespace {

/// Lets the twist between the mounts be the same everywhere.
void spread_twist(const RodPart& part, VectorXd& y) {
  const RodModel& model = part.model();
  VectorXd q = VectorXd::Zero(model.bands());
  for (int i = 0; i < part.vertices(); ++i)
    q.segment<3>(RodModel::block * i) = y.segment<3>(part.position_of(i));
  const SpatialState state = part.rod().make_state(q, model.controls());
  const double left = model.properties().left.twist_angle;
  const double right = model.properties().right.twist_angle + state.reference_twist.back();
  for (int e = 0; e < model.edges(); ++e) {
    const double share = 0.5 * (part.coordinate(e) + part.coordinate(e + 1)) / model.constants().length;
    y[part.angle_of(e)] = (1.0 - share) * left + share * right;
  }
}

}  // namespace

// The Jacobian at c is that of the balances with m c^2 added to the stiffness. c falls from a frequency at
// which only twist and curvatures follow to one below all others: a swing about the chord, which nothing
// holds between pins, then does not make it singular, and Newton's method still converges by 1e-6 a step.
RodRest find_rest(const RodInMotion& constants, const Eigen::Matrix3Xd& start) {
  RodInMotion rod = constants;
  rod.damping = {};
  rod.strands = {};
  RodPart part("wire", rod, {});
  numerics::DaeSystem system({&part});
  VectorXd y = VectorXd::Zero(system.size());
  const VectorXd rate = y;
  part.place(start, {}, y);
  for (const int normal : {2, 1, 0}) {
    const std::optional<RodPlane> plane = part.plane_across(normal);
    if (!plane) continue;
    system.hold(part.restrict_to_plane(*plane));
    break;
  }
  const SpatialRodProperties& p = rod.properties;
  if (p.left.orients() && p.right.orients()) spread_twist(part, y);
  const double stiffness = rod.properties.bending_stiffness;
  const double slow = 1e-3 * std::sqrt(stiffness / rod.mass_per_length) / (rod.length * rod.length);
  double c = 1e3 * rod.elements * rod.elements * slow;
  double shortest = rod.length;
  for (int e = 0; e + 1 < part.vertices(); ++e) shortest = std::min(shortest, part.model().rest_length(e));

  RodRest result;
  VectorXd rows(system.size());
  numerics::Klu factor(system.jacobian({0.0, y, rate}, c));
  constexpr int most = 100;
  double previous = std::numeric_limits<double>::max();
  for (result.report.iterations = 0; result.report.iterations < most; ++result.report.iterations) {
    const numerics::DaePoint at{0.0, y, rate};
    system.residual(at, rows);
    double residual = 0.0;
    double largest = 0.0;  // force of a mount
    for (int i = 0; i < part.vertices(); ++i) {
      for (int k = 0; k < 3; ++k) residual = std::max(residual, std::abs(rows[part.velocity_of(i) + k]));
    }
    for (const Eigen::Vector3d& force : part.energies(at).mount_forces)
      largest = std::max(largest, force.norm());
    result.report.residual_norm = residual;
    const double allowed =
        force_tolerance(1e-10, stiffness, rod.properties.axial_stiffness, rod.length, shortest, largest);
    if (residual <= allowed || (residual <= 16.0 * allowed && residual >= 0.5 * previous)) {
      result.report.termination = numerics::Termination::converged;
      break;
    }
    previous = residual;
    result.report.termination = numerics::Termination::iteration_limit;
    result.report.message = "the equilibrium of the wire was not reached in the allowed iterations";
    if (!std::isfinite(residual) || !factor.factorize(system.jacobian(at, c))) {
      result.report.termination = numerics::Termination::singular_matrix;
      result.report.message = "the tangent stiffness of the wire is singular";
      break;
    }
    factor.solve(rows);
    // No vertex moves more than a tenth of the length at once, no edge turns more than 0.2 rad about itself.
    double far = 1.0;
    for (int i = 0; i < part.vertices(); ++i) {
      far = std::max({far, rows.segment<3>(part.position_of(i)).norm() / (0.1 * rod.length),
                      std::abs(rows[part.angle_of(i)]) / 0.2});
    }
    y -= rows / far;
    for (int i = 0; i < part.vertices(); ++i) y.segment<3>(part.velocity_of(i)).setZero();
    system.accept({0.0, y, rate});
    c = std::max(slow, 0.1 * c);
  }
  result.energies = part.energies({0.0, y, rate});
  result.positions.resize(3, part.vertices());
  for (int i = 0; i < part.vertices(); ++i) result.positions.col(i) = y.segment<3>(part.position_of(i));
  return result;
}

}  // namespace snare::wire
