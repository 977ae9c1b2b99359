#include "wire/end_tangents.hpp"

#include "wire/spatial_cell.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace snare::wire {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// EI at an end [N m^2], with that of sliders that stick.
double bending_stiffness(const PlanarRodProperties& p, bool left) {
  const std::vector<double>& profile = p.bending_profile;
  double stiffness =
      p.bending_stiffness * (profile.empty() ? 1.0 : (left ? profile.front() : profile.back()));
  for (const SliderElement& slider : p.bending_sliders) stiffness += slider.stiffness;
  return stiffness;
}

}  // namespace

// From the edge beside the end back to the end by the turn of half an edge, whose curvature is that of a
// section under the end's moment.
std::array<Vector2d, 2> end_tangents(const PlanarRod& rod, const PlanarState& state) {
  const PlanarRodProperties& p = rod.properties();
  const Eigen::VectorXd moments = rod.moments(state);
  const int last = rod.mesh().edges();
  const auto tangent = [&](bool left) -> Vector2d {
    const PlanarEnd& end = left ? p.left : p.right;
    if (end.kind == PlanarEnd::Kind::clamp && std::isinf(end.rotational_stiffness)) return end.direction;
    const int edge = left ? 0 : last - 1;
    const Vector2d along = (vertex(state, edge + 1) - vertex(state, edge)).normalized();
    const double curvature = moments[left ? 0 : last] / bending_stiffness(p, left) + p.natural_curvature;
    const double turn = 0.5 * rod.mesh().rest_length(edge, state.controls) * curvature;
    return Eigen::Rotation2Dd(left ? -turn : turn) * along;
  };
  return {tangent(true), tangent(false)};
}

// With t' = kappa_1 m1 + kappa_2 m2 and the bending moment M = EI_1 kappa_1 m2 - EI_2 kappa_2 m1 of the
// curvatures beyond the natural ones.
std::array<Vector3d, 2> end_tangents(const SpatialRod& rod, const SpatialState& state) {
  const SpatialRodProperties& p = rod.properties();
  const CellTerms terms(p, rod.strains());
  const std::array<Vector3d, 2> moments = rod.end_moments(state);
  const auto tangent = [&](End which) -> Vector3d {
    const SpatialEnd& end = p.end(which);
    if (end.kind == SpatialEnd::Kind::clamp && std::isinf(end.rotational_stiffness)) return end.direction;
    const bool left = which == End::left;
    const SpatialEdge edge = edge_at(left ? 0 : rod.mesh().edges() - 1, rod.mesh(), state, terms);
    const Vector3d& moment = moments[index_of(which)];
    Vector3d bend = moment.cross(edge.tangent) / p.bending_stiffness;  // t'
    if (terms.directed) {
      const Vector3d& m1 = edge.directors.first;
      const Vector3d& m2 = edge.directors.second;
      bend = (moment.dot(m2) / p.bending_stiffness + p.natural_curvature[0]) * m1 +
             (-moment.dot(m1) / p.second_bending_stiffness + p.natural_curvature[1]) * m2;
    }
    const double turn = 0.5 * edge.rest * bend.norm();
    if (turn == 0.0) return edge.tangent;
    return std::cos(turn) * edge.tangent + (left ? -1.0 : 1.0) * std::sin(turn) * bend.normalized();
  };
  return {tangent(End::left), tangent(End::right)};
}

}  // namespace snare::wire
