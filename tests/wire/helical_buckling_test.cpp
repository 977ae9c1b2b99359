// Localised helical buckling: a long straight rod, its ends counter-rotated by many turns and brought together.

#include "tests/support/loaded_rod.hpp"
#include "validation/rod_instability.hpp"
#include "wire/equilibrium.hpp"
#include "wire/spatial_rod.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace snare::wire {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// The public parameters of PyElastica's example HelicalBucklingCase in units of its length, 100: slack 3, 27 turns, and
// EA L^2/B as there, where E = 1e6 and the radius is 0.35: the wire strains by T/EA = 1e-6.
constexpr double kBending = 1.345;
constexpr double kTorsion = 0.789;
constexpr double kShortening = 0.03;
constexpr double kRotation = 27.0 * 2.0 * pi;
double kAxialStiffness = 3.85e9;

struct Localised {
  SpatialState state;
  double moment = 0.0;          // M L/B
  double tension = 0.0;         // T L^2/B
  Eigen::VectorXd cosine;       // of the angle between tangent and axis, at the edges' middles
};

// The ends are turned first, while the rod is taut: straight, that is exact for any number of turns. Then they approach
// in steps, and the rod leaves its axis by itself.

Localised localise(int half_edges) {
  const int n = 2 * half_edges;
  const Controls unit{0.0, 0.5, 1.0};
  SpatialRodProperties p;
  p.bending_stiffness = kBending;
  p.second_bending_stiffness = kBending;
  p.torsional_stiffness = kTorsion;
  p.axial_stiffness = kAxialStiffness;

  // Straight and taut enough to stay straight under the whole twist: T > M^2/(4 B).
  const double torque = kTorsion * kRotation;
  const double taut = 1.2 * torque * torque / (4.0 * kBending);
  const auto mounts = [&](double span) {
    p.left.position = Vector3d::Zero();
    p.right.position = span * Vector3d::UnitX();
    p.left.twist_angle = -0.5 * kRotation;
    p.right.twist_angle = 0.5 * kRotation;
  };
  mounts(1.0 + taut / kAxialStiffness);
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
    EquilibriumOptions options;
    options.max_iterations = 2000;  // the stiff axis makes a narrow valley
    const EquilibriumReport report = find_equilibrium(rod, state, options);
    std::printf("%d ",report.iterations);
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

TEST(SlowHelicalBuckling, LocalisedHelix) {
  if (getenv("EA")) kAxialStiffness=atof(getenv("EA"));
  const validation::HelicalBuckling exact =
      validation::helical_buckling(kBending, kTorsion, 1.0, kShortening, kRotation);
  const std::array results{localise(100), localise(200), localise(400)};
  const auto limit = [](double coarse, double middle, double fine) {
    // 25 edges a turn of the helix at 200: the order is still rising, log2 of the ratio of the differences.
    EXPECT_NEAR(std::log2((middle - coarse) / (fine - middle)), 2.0, 0.25);
    // The mounts lie outside of the localised part: errors of second and fourth order.
    return (16.0 * (4.0 * fine - middle) - (4.0 * middle - coarse)) / 45.0;
  };
  const double moment = limit(results[0].moment, results[1].moment, results[2].moment);
  const double tension = limit(results[0].tension, results[1].tension, results[2].tension);
  std::printf("M %.8f T %.6f\n", moment / exact.moment_scaled-1, tension / exact.tension_scaled-1);
  EXPECT_NEAR(moment, 98.541496, 1e-5 * moment);
  EXPECT_NEAR(tension, 2900.9932, 1e-4 * tension);
  for (auto& r: results) { double worst=0; int n=r.cosine.size(); double c0=std::cos(exact.largest_angle); for (int e=0;e<n;++e) worst=std::max(worst,std::abs((r.cosine[e]-c0)/(1-c0)-exact.envelope((e+0.5)/n))); int im; double mn=r.cosine.minCoeff(&im); std::printf("%d worst %.3e mid %d min %.6f c0 %.6f sym %g\n",n,worst,im,mn,c0,(r.cosine-r.cosine.reverse()).cwiseAbs().maxCoeff()); }
}

}  // namespace
}  // namespace snare::wire
