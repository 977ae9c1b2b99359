#include "wire/statics/loose_wire.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace snare::wire {

namespace {

using std::numbers::pi;

// First and second root of tan(x/2) = x/2 beyond zero: the antisymmetric clamped modes.
constexpr std::array<double, 2> antisymmetric_roots{8.986818915818128, 15.450503673875414};

double wave_number(PlanarEnd::Kind kind, int mode) {
  if (kind == PlanarEnd::Kind::pin) return mode * pi;
  if (mode % 2 == 1) return (mode + 1) * pi;
  return antisymmetric_roots[static_cast<std::size_t>(mode / 2 - 1)];
}

/// Direction angle of the linear buckling mode at u = S/L in [0, 1], largest value about 1.
double mode_angle(PlanarEnd::Kind kind, int mode, double u) {
  const double k = wave_number(kind, mode);
  if (kind == PlanarEnd::Kind::pin) return std::cos(k * u);
  if (mode % 2 == 1) return std::sin(k * u);
  // w = 1 - cos(k u) - (2/k)(k u - sin(k u)), scaled.
  return (std::sin(k * u) - 2.0 / k * (1.0 - std::cos(k * u))) / 1.3;
}

}  // namespace

double buckling_load(const PlanarRod& rod, double length, int mode) {
  const double k = wave_number(rod.properties().left.kind, mode);
  return k * k * rod.properties().bending_stiffness / (length * length);
}

LooseWire find_loose_wire(const PlanarRod& rod, const Controls& controls, int mode) {
  assert(mode >= 1 && mode <= 4);
  const PlanarRodProperties& p = rod.properties();
  const MaterialMesh& mesh = rod.mesh();
  const int n = mesh.edges();
  const double length = controls.length();
  const Eigen::Vector2d chord = p.right.position - p.left.position;
  const double span = chord.norm();
  LooseWire result;
  result.state.controls = controls;
  result.state.q.resize(rod.unknowns());

  // Net length after the compression of the buckled state; at or below the span the wire stays straight.
  const double critical = buckling_load(rod, length, mode);
  const double buckled_length = length * (1.0 - critical / p.axial_stiffness);
  const auto shape = [&](double amplitude) {
    Eigen::Vector2d x = p.left.position;
    result.state.q.segment<2>(0) = x;
    for (int e = 0; e < n; ++e) {
      const double middle =
          0.5 * (mesh.coordinate(e, controls) + mesh.coordinate(e + 1, controls)) - controls.left;
      const double angle = amplitude * mode_angle(p.left.kind, mode, middle / length);
      x += mesh.rest_length(e, controls) * buckled_length / length *
           Eigen::Vector2d(std::cos(angle), std::sin(angle));
      result.state.q.segment<2>(2 * (e + 1)) = x;
    }
    return x.x() - p.left.position.x();
  };
  if (buckled_length > span) {
    // The chord of the shape falls with the amplitude, about as 1 - a^2/4: false position in a^2 (Illinois).
    double low = 0.0;
    double high = 2.2 * 2.2;
    double above = buckled_length - span;
    double below = shape(2.2) - span;
    for (int k = 0; k < 60 && high - low > 1e-12 * high; ++k) {
      const double middle = low + (high - low) * above / (above - below);
      const double excess = shape(std::sqrt(middle)) - span;
      if (std::abs(excess) < 1e-12 * span) break;
      if (excess > 0.0) {
        low = middle;
        above = excess;
        below *= 0.5;
      } else {
        high = middle;
        below = excess;
        above *= 0.5;
      }
    }
  } else {
    for (int i = 0; i <= n; ++i) {
      result.state.q.segment<2>(2 * i) =
          p.left.position + chord * ((mesh.coordinate(i, controls) - controls.left) / length);
    }
  }
  // What is left of the gap to the right mount is shared out along the wire.
  const Eigen::Vector2d gap = p.right.position - vertex(result.state, n);
  for (int i = 1; i < n; ++i) {
    result.state.q.segment<2>(2 * i) += (mesh.coordinate(i, controls) - controls.left) / length * gap;
  }
  result.state.q.segment<2>(2 * n) = p.right.position;

  EquilibriumOptions options;
  options.branch = mode == 1 ? Branch::stable : Branch::nearest;
  result.report = find_equilibrium(rod, result.state, options);
  return result;
}

SpatialState in_space(const SpatialRod& rod, const PlanarState& planar, double plane) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(rod.unknowns());
  for (int i = 0; i < rod.mesh().vertices(); ++i) {
    const Eigen::Vector2d x = vertex(planar, i);
    q.segment<3>(SpatialRod::block * i) =
        Eigen::Vector3d(x.x(), x.y() * std::cos(plane), x.y() * std::sin(plane));
  }
  return rod.make_state(q, planar.controls);
}

LooseSpatialWire find_loose_wire(const SpatialRod& rod, const PlanarRod& planar, const Controls& controls,
                                 int mode, double plane) {
  const LooseWire flat = find_loose_wire(planar, controls, mode);
  LooseSpatialWire result{in_space(rod, flat.state, plane), flat.report};
  if (!flat.report.usable()) return result;
  EquilibriumOptions options;
  options.branch = mode == 1 ? Branch::stable : Branch::nearest;
  result.report = find_equilibrium(rod, result.state, options);
  return result;
}

}  // namespace snare::wire
