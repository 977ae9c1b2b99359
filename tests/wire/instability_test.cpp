// Buckling loads of straight and of loaded rods by the change of sign of a pivot, beside closed forms.

#include "tests/support/loaded_rod.hpp"
#include "validation/closed_forms.hpp"
#include "validation/rod_instability.hpp"
#include "wire/spatial_rod.hpp"
#include "wire/statics/equilibrium.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace snare::wire {
namespace {

using Eigen::Vector3d;

constexpr Controls kUnit{0.0, 0.5, 1.0};

// Orders observed between 40, 80 and 160 edges: the next term of the error is h^2 smaller.
constexpr double kOrderTolerance = 0.05;

// ------------------------------------------------------------------------------------------- compression
// The straight rod under compression P is shortened to lambda = 1 - P/EA; linearised, EI theta'' = -lambda (P
// theta + V), so that the inextensible load is P lambda.
constexpr double kAxialStiffness = 2e4;

double effective_load(double compression) {
  return compression * (1.0 - compression / kAxialStiffness);
}

double planar_critical(PlanarEnd::Kind left, PlanarEnd::Kind right, int half_edges) {
  return test::critical_load(1.0, 100.0, [&](double compression) {
    const double span = 1.0 - compression / kAxialStiffness;
    PlanarRodProperties p;
    p.bending_stiffness = 1.0;
    p.axial_stiffness = kAxialStiffness;
    p.left.kind = left;
    p.right.kind = right;
    p.right.position = {span, 0.0};
    const PlanarRod rod(MaterialMesh(half_edges, half_edges, 0.0), p);
    PlanarState state;
    state.controls = kUnit;
    state.q = Eigen::VectorXd::Zero(rod.unknowns());
    for (int i = 0; i <= 2 * half_edges; ++i) state.q[2 * i] = span * rod.mesh().coordinate(i, kUnit);
    return test::negative_pivots(rod, state) > 0;
  });
}

SpatialRodProperties round_rod() {
  SpatialRodProperties p;
  p.bending_stiffness = 1.0;
  p.second_bending_stiffness = 1.0;
  p.torsional_stiffness = 0.7;
  p.axial_stiffness = kAxialStiffness;
  p.right.position = Vector3d::UnitX();
  return p;
}

double spatial_critical(SpatialEnd::Kind left, SpatialEnd::Kind right, double second_stiffness,
                        int half_edges) {
  return test::critical_load(1.0, 100.0, [&](double compression) {
    SpatialRodProperties p = round_rod();
    p.second_bending_stiffness = second_stiffness;
    p.left.kind = left;
    p.right.kind = right;
    p.right.position.x() = 1.0 - compression / kAxialStiffness;
    const SpatialRod rod(MaterialMesh(half_edges, half_edges, 0.0), p);
    return test::negative_pivots(rod, rod.straight_state(kUnit)) > 0;
  });
}

void expect_load(const std::array<double, 3>& compressions, double expected) {
  const test::Extrapolation result = test::extrapolate(
      {effective_load(compressions[0]), effective_load(compressions[1]), effective_load(compressions[2])});
  EXPECT_NEAR(result.order, 2.0, kOrderTolerance);
  // Fourth-order rest: the relative error at 160 edges is about P h^2/12 = 1e-4, its square times a constant
  // of 10.
  EXPECT_NEAR(result.limit, expected, 1e-6 * expected);
}

TEST(Buckling, PlanarColumn) {
  using Kind = PlanarEnd::Kind;
  using validation::ColumnEnds;
  const auto loads = [](Kind left, Kind right) {
    return std::array{planar_critical(left, right, 20), planar_critical(left, right, 40),
                      planar_critical(left, right, 80)};
  };
  expect_load(loads(Kind::clamp, Kind::clamp),
              validation::buckling_load(ColumnEnds::clamped_clamped, 1.0, 1.0));
  expect_load(loads(Kind::clamp, Kind::pin), validation::buckling_load(ColumnEnds::clamped_pinned, 1.0, 1.0));
  expect_load(loads(Kind::pin, Kind::pin), validation::buckling_load(ColumnEnds::pinned_pinned, 1.0, 1.0));
}

TEST(Buckling, SpatialColumn) {
  using Kind = SpatialEnd::Kind;
  using validation::ColumnEnds;
  const auto loads = [](Kind left, Kind right, double second) {
    return std::array{spatial_critical(left, right, second, 20), spatial_critical(left, right, second, 40),
                      spatial_critical(left, right, second, 80)};
  };
  expect_load(loads(Kind::clamp, Kind::clamp, 1.0),
              validation::buckling_load(ColumnEnds::clamped_clamped, 1.0, 1.0));
  // About its weak axis.
  expect_load(loads(Kind::clamp, Kind::pin, 0.4),
              validation::buckling_load(ColumnEnds::clamped_pinned, 0.4, 1.0));
}

TEST(Buckling, PinsLikeTheirPlanarCounterpart) {
  const double planar = planar_critical(PlanarEnd::Kind::pin, PlanarEnd::Kind::pin, 10);
  // A twisting pin holds the twist and lets the rod turn; the other end is a ball joint.
  const double spatial = spatial_critical(SpatialEnd::Kind::twisting_pin, SpatialEnd::Kind::pin, 1.0, 10);
  EXPECT_NEAR(spatial, planar, 1e-9 * planar);  // bisection to 1e-12, pivots near zero: condition 1e3
}

// ------------------------------------------------------------------------------------------------- twist

// Torque at which the straight rod under tension T buckles.
double critical_torque(double tension, int half_edges) {
  return test::critical_load(1.0, 30.0, [&](double torque) {
    SpatialRodProperties p = round_rod();
    p.right.position.x() = 1.0 + tension / kAxialStiffness;
    p.right.twist_angle = torque / p.torsional_stiffness;
    const SpatialRod rod(MaterialMesh(half_edges, half_edges, 0.0), p);
    SpatialState state = rod.straight_state(kUnit);
    Eigen::VectorXd q = state.q;
    const int n = 2 * half_edges;
    for (int e = 0; e < n; ++e) q[4 * e + 3] = p.right.twist_angle * (e + 0.5) / n;
    accept(state, q);
    EXPECT_NEAR(rod.torques(state)[0], torque, 1e-11 * torque);
    return test::negative_pivots(rod, state) > 0;
  });
}

TEST(TwistInstability, ClampedRodUnderAnyTension) {
  for (const double tension : {-15.0, 0.0, 40.0}) {
    SCOPED_TRACE(tension);
    const test::Extrapolation result = test::extrapolate(
        {critical_torque(tension, 20), critical_torque(tension, 40), critical_torque(tension, 80)});
    const double expected = validation::critical_torque_clamped(1.0, tension, 1.0);
    EXPECT_NEAR(result.order, 2.0, kOrderTolerance);
    // Fourth-order rest 1e-6 as above, and the stretch |T|/EA (no more than 2e-3) with its influence on the
    // torque of at most half of it, since M^2 ~ 4 B T + const; none at T = 0.
    EXPECT_NEAR(result.limit, expected, (1e-6 + 0.5 * std::abs(tension) / kAxialStiffness) * expected);
  }
}

TEST(TwistInstability, BothPlanesBuckleTogether) {
  // A round rod loses stability in a pair of modes.
  SpatialRodProperties p = round_rod();
  p.right.twist_angle = 1.05 * validation::critical_torque_clamped(1.0, 0.0, 1.0) / p.torsional_stiffness;
  const SpatialRod rod(MaterialMesh(20, 20, 0.0), p);
  SpatialState state = rod.straight_state(kUnit);
  Eigen::VectorXd q = state.q;
  for (int e = 0; e < 40; ++e) q[4 * e + 3] = p.right.twist_angle * (e + 0.5) / 40;
  accept(state, q);
  EXPECT_EQ(test::negative_pivots(rod, state), 2);
}

// ----------------------------------------------------------------------------------------------- lateral

double critical_tip_force(double strong_stiffness, int half_edges) {
  SpatialRodProperties p = round_rod();
  p.bending_stiffness = strong_stiffness;
  p.second_bending_stiffness = 1.0;
  p.torsional_stiffness = 0.7;
  p.axial_stiffness = 1e5;
  p.right.kind = SpatialEnd::Kind::free;
  const SpatialRod rod(MaterialMesh(half_edges, half_edges, 0.0), p);
  SpatialState state = rod.straight_state(kUnit);
  return test::critical_load(1.0, 10.0, [&](double force) {
    const test::TipLoadedRod<SpatialRod> loaded(rod, Vector3d(0.0, force, 0.0));
    EquilibriumOptions options;
    options.branch = Branch::nearest;  // the deflection in the plane of the load, stable or not
    const EquilibriumReport report = find_equilibrium(loaded, state, options);
    EXPECT_TRUE(report.usable()) << report.message;
    return report.negative_pivots > 0;
  });
}

TEST(LateralTorsionalBuckling, DeepCantileverUnderATipForce) {
  // The closed form takes the strong axis as rigid; the beam's own deflection before it buckles raises the
  // load by about 0.95 EI_2/EI_1 of it, so two stiffnesses are extrapolated to the rigid one.
  const auto load = [](double strong) {
    const test::Extrapolation result = test::extrapolate(
        {critical_tip_force(strong, 10), critical_tip_force(strong, 20), critical_tip_force(strong, 40)});
    EXPECT_NEAR(result.order, 2.0, 0.1);  // the error of third order is still visible at 20 edges
    return result.limit;
  };
  const double expected = validation::lateral_buckling_load(1.0, 0.7, 1.0);
  // Rest: (EI_2/EI_1)^2, 4e-6, and the fourth order in the edge length, 2e-6.
  EXPECT_NEAR(2.0 * load(1000.0) - load(500.0), expected, 1e-5 * expected);
}

}  // namespace
}  // namespace snare::wire
