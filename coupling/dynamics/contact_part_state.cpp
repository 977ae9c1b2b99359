// How a point of contact closes and opens, where it stands on the wire, and what it remembers.

#include "coupling/dynamics/contact_part.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

using Eigen::Vector3d;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

// Below this curvature of the gap along the wire [1/m] its minimum is none: a radius of relative curvature of a metre,
// beyond any shape that wires meet.
constexpr double least_curvature = 1.0;

// Of a wire that lies flat the gap differs by less than this between a point and the next vertex [m].
constexpr double level_gap = 1e-12;

// n.X' below this is round-off.
constexpr double level_slope = 1e-9;

}  // namespace

// A minimum that flattens out is followed no further: beyond it zeta would be a maximum, or jump. The wire still rests
// there, and where it then dips beside it is found as another touch.                        theory.md (G.9)
bool ContactPart::accept(const DaePoint& at) {
  if (!closed_) return false;
  if (at.y[force_unknown()] > 0.0) least_force_ = 0.0;
  const Geometry g = geometry(at.y);
  const double slope = g.normal.dot(g.slope);
  if (!fixed_) {
    fixed_ = is_at_an_end(at.y[coordinate_unknown()]) || gap_curvature(g) < least_curvature;
    kept_coordinate_ = std::clamp(at.y[coordinate_unknown()], 0.0, rod_.coordinate(rod_.vertices() - 1));
  } else if (slope * fixed_slope_ < 0.0 && gap_curvature(g) > 2.0 * least_curvature) {
    fixed_ = false;
  }
  // Along a flat face the slope is round-off of either sign, which says nothing.
  fixed_slope_ = std::abs(slope) > level_slope ? slope : 0.0;
  return follow(at.y);
}

void ContactPart::begin_force(double force, Eigen::VectorXd& y) {
  y[force_unknown()] = force;
  least_force_ = force > 0.0 ? 0.0 : force - options_.force_tolerance;
}

void ContactPart::rest_on_wire() {
  fixed_ = true;
  fixed_slope_ = 0.0;
}

double ContactPart::gap_curvature(const Geometry& g) const {
  ContactDirection along;
  along.zeta = 1.0;
  return contact_change(contact_.friction, g, along).tangency;
}

bool ContactPart::is_at_an_end(double coordinate) const {
  return coordinate <= 0.0 || coordinate >= rod_.coordinate(rod_.vertices() - 1);
}

bool ContactPart::follow(const VectorView& y) {
  const int first = curve_weights(rod_, y[coordinate_unknown()]).first;
  if (first >= window_ && first + 4 <= window_ + window_size) return false;
  window_ = std::clamp(first - (window_size - 4) / 2, 0, std::max(0, rod_.vertices() - window_size));
  return true;
}

std::optional<double> ContactPart::level_vertex(double coordinate, Eigen::VectorXd y) const {
  y[coordinate_unknown()] = coordinate;
  const Geometry here = geometry(y);
  if (is_at_an_end(coordinate) || gap_curvature(here) >= least_curvature) return std::nullopt;
  double nearest = rod_.coordinate(1);
  for (int i = 2; i + 1 < rod_.vertices(); ++i) {
    if (std::abs(rod_.coordinate(i) - coordinate) < std::abs(nearest - coordinate)) nearest = rod_.coordinate(i);
  }
  y[coordinate_unknown()] = nearest;
  return std::abs(geometry(y).gap - here.gap) < level_gap ? std::optional(nearest) : std::nullopt;
}

bool ContactPart::close(double coordinate, Eigen::VectorXd& y) {
  closed_ = true;
  mode_ = FrictionMode::stick;
  y[coordinate_unknown()] = kept_coordinate_ = coordinate;
  y[stabiliser_unknown()] = 0.0;
  // The wire is moved out by what a touch is noticed late, so that the constraint holds from the start: the shortest
  // change of its vertices with n.sum N dx = -g, dx = -N n g/sum (N n)^2 over the components that nothing holds.
  for (int iteration = 0; iteration < 2 && !has_law(); ++iteration) {
    const Geometry g = geometry(y);
    double square = 0.0;
    for (int k = 0; k < 4; ++k) {
      for (int a = 0; a < 3; ++a) {
        if (!rod_.is_held(g.weights.first + k, a)) square += std::pow(g.weights.value[k] * g.normal[a], 2);
      }
    }
    for (int k = 0; k < 4 && square > 0.0; ++k) {
      const int i = g.weights.first + k;
      for (int a = 0; a < 3; ++a) {
        if (!rod_.is_held(i, a)) y[rod_.position_of(i) + a] -= g.weights.value[k] * g.normal[a] * g.gap / square;
      }
    }
  }
  const Geometry g = geometry(y);
  fixed_ = is_at_an_end(coordinate) || gap_curvature(g) < least_curvature;
  fixed_slope_ = 0.0;
  const bool added = !coupled_;
  coupled_ = true;
  return follow(y) || added;
}

double ContactPart::open(Eigen::VectorXd& y) {
  const double held = closed_ ? bristle_energy(y) : 0.0;
  closed_ = false;
  kept_coordinate_ = y[coordinate_unknown()];
  y[force_unknown()] = 0.0;
  y[stabiliser_unknown()] = 0.0;
  if (has_bristle()) y.segment<2>(bristle_unknown()).setZero();
  return held;
}

void ContactPart::save_state(std::vector<double>& memory) const {
  memory.insert(memory.end(),
                {closed_ ? 1.0 : 0.0, kept_coordinate_, static_cast<double>(window_), coupled_ ? 1.0 : 0.0,
                 fixed_ ? 1.0 : 0.0, fixed_slope_, least_force_, mode_ == FrictionMode::stick ? 1.0 : 0.0});
}

void ContactPart::restore_state(const VectorView& /*y*/, std::span<const double>& memory) {
  closed_ = numerics::take(memory) != 0.0;
  kept_coordinate_ = numerics::take(memory);
  window_ = static_cast<int>(numerics::take(memory));
  coupled_ = numerics::take(memory) != 0.0;
  fixed_ = numerics::take(memory) != 0.0;
  fixed_slope_ = numerics::take(memory);
  least_force_ = numerics::take(memory);
  mode_ = numerics::take(memory) != 0.0 ? FrictionMode::stick : FrictionMode::slip;
}

}  // namespace snare::coupling
