// Localised helical buckling: a long straight rod, its ends counter-rotated by many turns and brought
// together.

#include "tests/support/loaded_rod.hpp"
#include "validation/rod_instability.hpp"
#include "wire/spatial_rod.hpp"
#include "wire/statics/equilibrium.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace snare::wire {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// The public parameters of PyElastica's example HelicalBucklingCase in units of its length, 100: slack 3, 27
// turns.
constexpr double kBending = 1.345;
constexpr double kTorsion = 0.789;
constexpr double kShortening = 0.03;
constexpr double kRotation = 27.0 * 2.0 * pi;

struct Localised {
  SpatialState state;
  double moment = 0.0;     // M L/B
  double tension = 0.0;    // T L^2/B
  Eigen::VectorXd cosine;  // of the angle between tangent and axis, at the edges' middles
};

// The ends are turned first, while the rod is taut: straight, that is exact for any number of turns. Then
// they approach in steps, and the rod leaves its axis by itself.

Localised localise(double axial_stiffness, int half_edges) {
  const int n = 2 * half_edges;
  const Controls unit{0.0, 0.5, 1.0};
  SpatialRodProperties p;
  p.bending_stiffness = kBending;
  p.second_bending_stiffness = kBending;
  p.torsional_stiffness = kTorsion;
  p.axial_stiffness = axial_stiffness;

  // Straight and taut enough to stay straight under the whole twist: T > M^2/(4 B).
  const double torque = kTorsion * kRotation;
  const double taut = 1.2 * torque * torque / (4.0 * kBending);
  const auto mounts = [&](double span) {
    p.left.position = Vector3d::Zero();
    p.right.position = span * Vector3d::UnitX();
    p.left.twist_angle = -0.5 * kRotation;
    p.right.twist_angle = 0.5 * kRotation;
  };
  mounts(1.0 + taut / axial_stiffness);
  SpatialRod rod(MaterialMesh(half_edges, half_edges, 0.0), p);
  Localised result;
  SpatialState& state = result.state;
  state = rod.straight_state(unit);
  Eigen::VectorXd q = state.q;
  const double wave = 0.5 * torque / kBending;
  for (int i = 0; i <= n; ++i) {
    if (i < n) q[4 * i + 3] = kRotation * ((i + 0.5) / n - 0.5);
    // A trace of the critical mode, which the taut rod wipes out and from which the slack one starts.
    if (i == 0 || i == n) continue;
    const double s = static_cast<double>(i) / n - 0.5;
    const double size = 1e-3 / std::cosh(20.0 * s);
    q[4 * i + 1] = size * std::cos(wave * s);
    q[4 * i + 2] = size * std::sin(wave * s);
  }
  accept(state, q);

  const int steps = 12;
  for (int k = 1; k <= steps; ++k) {
    mounts(1.0 - kShortening * k / steps);
    rod.set_mounts(p.left, p.right);
    // Carry the inner vertices along, so that no edge is crushed.
    const double factor = p.right.position.x() / state.q[4 * n];
    Eigen::VectorXd moved = state.q;
    for (int i = 0; i <= n; ++i) moved[4 * i] *= factor;
    accept(state, moved);
    rod.adopt_mounts(state);
    const EquilibriumReport report = find_equilibrium(rod, state);
    EXPECT_TRUE(report.usable()) << "step " << k << ": " << report.message;
    EXPECT_EQ(report.negative_pivots, 0) << "step " << k;
  }
  result.moment = rod.moments(state)(0, 0) / kBending;
  RodAssembly assembly;
  rod.assemble(state, {false, false, false}, assembly);
  result.tension = assembly.gradient[4 * n] / kBending;
  result.cosine.resize(n);
  for (int e = 0; e < n; ++e) {
    result.cosine[e] = (vertex(state, e + 1) - vertex(state, e)).normalized().x();
  }
  return result;
}

struct Ends {
  double moment;
  double tension;
};

// Towards edges of length zero. The mounts lie outside of the localised part: errors of second and fourth
// order.
Ends converged(const std::array<Localised, 3>& results) {
  const auto limit = [&results](double Localised::*value) {
    const double coarse = results[0].*value;
    const double middle = results[1].*value;
    const double fine = results[2].*value;
    // A turn of the helix takes 25 of 200 edges: the order is still rising.
    EXPECT_NEAR(std::log2((middle - coarse) / (fine - middle)), 2.0, 0.25);
    return (16.0 * (4.0 * fine - middle) - (4.0 * middle - coarse)) / 45.0;
  };
  return {limit(&Localised::moment), limit(&Localised::tension)};
}

// Largest difference of (cos phi - cos phi_0)/(1 - cos phi_0) from the closed form. Where along the rod the
// helix sits is almost neutral (its tails at the mounts are exp(-11)), so it is compared about its own
// centre.
double envelope_error(const Localised& result, const validation::HelicalBuckling& exact) {
  const Eigen::Index n = result.cosine.size();
  const Eigen::VectorXd place = Eigen::VectorXd::LinSpaced(n, 0.5, static_cast<double>(n) - 0.5) / n;
  const Eigen::VectorXd weight = 1.0 - result.cosine.array();
  const double shift = weight.dot(place) / weight.sum() - 0.5;
  EXPECT_NEAR(shift, 0.0, 0.02);  // but near the middle, where it started
  const double least = std::cos(exact.largest_angle);
  double worst = 0.0;
  for (Eigen::Index e = 0; e < n; ++e) {
    const double envelope = (result.cosine[e] - least) / (1.0 - least);
    worst = std::max(worst, std::abs(envelope - exact.envelope(place[e] - shift)));
  }
  return worst;
}

TEST(SlowHelicalBuckling, LocalisedHelix) {
  const auto solve = [](double axial_stiffness) {
    return std::array{localise(axial_stiffness, 100), localise(axial_stiffness, 200),
                      localise(axial_stiffness, 400)};
  };
  const std::array<Localised, 3> soft = solve(5e7);
  const std::array<Localised, 3> stiff = solve(1e8);
  // The closed form is inextensible; the wire strains by T/EA = 8e-5 and 4e-5, whose influence is linear.
  const Ends a = converged(soft);
  const Ends b = converged(stiff);
  const validation::HelicalBuckling exact =
      validation::helical_buckling(kBending, kTorsion, 1.0, kShortening, kRotation);
  // Rest of the extrapolations: sixth order in the edge, 2e-5 of T; square of the strain's influence,
  // (1e-3)^2.
  EXPECT_NEAR(2.0 * b.moment - a.moment, exact.moment_scaled, 1e-6 * exact.moment_scaled);
  EXPECT_NEAR(2.0 * b.tension - a.tension, exact.tension_scaled, 4e-5 * exact.tension_scaled);

  // Mesh error of the shape, 0.1 at 200 edges and of second order, less what the strain does (1e-3).
  EXPECT_LT(envelope_error(stiff[0], exact), 0.11);
  EXPECT_LT(envelope_error(stiff[1], exact), 0.03);
  EXPECT_LT(envelope_error(stiff[2], exact), 0.0075);
}

}  // namespace
}  // namespace snare::wire
