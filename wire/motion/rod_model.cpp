#include "wire/motion/rod_model.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace snare::wire {

using numerics::DaeKind;

namespace {

MaterialMesh checked_mesh(const RodInMotion& rod) {
  assert(rod.elements >= 4 && rod.length > 0.0 && rod.mass_per_length > 0.0);
  return rod.mesh();
}

/// Kelvin-Voigt time of bending of a quasi-static wire, at least [s]: 2/omega of the tenth mode, between
/// pins, of the inertia that it keeps.
/// Its waves stand for nothing; where nothing damps them the integrator follows them.        theory.md (M.18)
double damping_of_waves(const RodInMotion& rod, double share) {
  constexpr double mode = 10.0;
  const double number = mode * std::numbers::pi / rod.length;  // of the wave [1/m]
  return 2.0 / (number * number) * std::sqrt(share * rod.mass_per_length / rod.properties.bending_stiffness);
}

}  // namespace

RodModel::RodModel(const RodInMotion& constants)
    : constants_(constants),
      rod_(checked_mesh(constants), constants.properties,
           constants.formulation == Formulation::higher_order ? Strains::twist : Strains::all),
      controls_(constants.controls()) {
  if (constants.quasi_static)
    constants_.damping.bending_time =
        std::max(constants.damping.bending_time, damping_of_waves(constants, inertial_share()));
  // m_i = rho A (h_{i-1} + h_i)/2 (M.3).
  mass_.assign(base::at(vertices()), 0.0);
  for (int e = 0; e < edges(); ++e) {
    const double half = 0.5 * constants.mass_per_length * rest_length(e);
    mass_[base::at(e)] += half;
    mass_[base::at(e + 1)] += half;
  }
  held_.assign(base::at(3 * vertices()), false);
  for (const End which : ends) {
    const SpatialEnd& end = properties().end(which);
    if (end.kind == SpatialEnd::Kind::free) continue;
    for (int k = 0; k < 3; ++k) {
      held_[base::at(3 * vertex_at(which) + k)] = k > 0 || std::isinf(end.translational_stiffness);
    }
  }
  if (!properties().left.orients() && !properties().right.orients()) {
    // The drag on the spin of a straight wire is that of a wire bent by some 3e-5 rad in all: it exerts no
    // moment of note.
    constexpr double share = 1e-9;
    holds_first_angle_ = damping().bending_time == 0.0;
    spin_drag_ = share * damping().bending_time * properties().bending_stiffness / constants.length;
  }
}

void RodModel::release(End end) {
  for (int k = 0; k < 3; ++k) held_[base::at(3 * vertex_at(end) + k)] = false;
}

void RodModel::declare(numerics::DaeLayout& layout, const std::string& name,
                       const RodTolerances& tolerances) {
  const int n = vertices();
  const std::vector<std::string> axes{"x", "y", "z"};
  x_ = layout.add({name + " position", axes, 3 * n, DaeKind::differential, tolerances.position, 0, false});
  theta_ = layout.add({name + " twist angle", {}, n, DaeKind::algebraic, tolerances.angle, 0, false});
  v_ = layout.add({name + " velocity", axes, 3 * n,
                   constants_.quasi_static ? DaeKind::algebraic : DaeKind::differential, tolerances.velocity,
                   0});
  if (is_curved()) {
    curvature_ = layout.add({name + " curvature",
                             {"1", "2"},
                             2 * n,
                             DaeKind::algebraic,
                             tolerances.angle * edges() / constants_.length,
                             0});
  }
  if (strands().act()) {
    // A thousandth of the curvature at which they slip.
    strand_ = layout.add(
        {name + " strands", {"1", "2"}, 2 * n, DaeKind::differential, 1e-3 * strands().slip_curvature, 0});
  }
}

void RodInstant::take_edges() {
  directors.resize(state.frames.size());
  inverse_lengths.resize(state.frames.size());
  for (std::size_t e = 0; e < directors.size(); ++e) {
    const auto i = static_cast<int>(e);
    inverse_lengths[e] = 1.0 / std::sqrt((vertex(state, i + 1) - vertex(state, i)).squaredNorm());
    const Frame& frame = state.frames[e];
    const Eigen::Vector3d first =
        turned_director(frame, state.q[SpatialState::block * i + SpatialState::angle]);
    directors[e] = {first, frame.tangent.cross(first)};
  }
}

}  // namespace snare::wire
