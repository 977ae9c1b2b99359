// The tilted pusher, against the planar push, energy, symmetry.

#include "base/units.hpp"
#include "coupling/statics/push_solver.hpp"
#include "validation/declared_wire.hpp"
#include "wire/statics/loose_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snare::coupling {
namespace {

using base::degree;
using base::mm;

using validation::declared_wire;

std::vector<double> even_travel(double to, int points) {
  std::vector<double> travel;
  for (int i = 0; i <= points; ++i) travel.push_back(to * i / points);
  return travel;
}

PushOptions mesh(int elements) {
  PushOptions options;
  options.elements = elements;
  return options;
}

TEST(SpatialPush, VanishingTiltIsThePlanarPush) {
  for (const double friction : {0.0, 0.2}) {
    PushProblem test = declared_wire(40.0 * mm, 6.0 * mm);
    test.pusher.friction = friction;
    test.travel = even_travel(2.0 * mm, 8);
    const PushCurve planar = solve_push(test, mesh(64));
    test.pusher.tilt = 1e-5;
    const PushCurve tilted = solve_push(test, mesh(64));
    ASSERT_TRUE(tilted.report.usable()) << tilted.report.message;
    ASSERT_EQ(tilted.points.size(), planar.points.size());
    for (std::size_t i = 1; i < planar.points.size(); ++i) {
      // The tilt acts in second order, 1e-10; first touch is found to about 1e-8 of the first step.
      EXPECT_NEAR(tilted.points[i].force, planar.points[i].force, 1e-6 * planar.points.back().force);
      EXPECT_NEAR(tilted.points[i].tension_left, planar.points[i].tension_left, 1e-5);
      EXPECT_LE(tilted.points[i].imbalance, 1e-8);  // forces of tens of N, balanced to 1e-9
    }
  }
}

TEST(SpatialPush, WorkOfThePusherIsTheWiresEnergy) {
  PushProblem test = declared_wire(40.0 * mm, 5.0 * mm);
  test.pusher.tilt = 10.0 * degree;
  test.travel = even_travel(2.0 * mm, 40);
  const PushCurve curve = solve_push(test, mesh(128));
  ASSERT_TRUE(curve.report.usable()) << curve.report.message;
  const std::size_t n = curve.points.size() - 1;
  double work = 0.0;  // Simpson
  for (std::size_t i = 0; i <= n; ++i) {
    work += (i == 0 || i == n ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0)) * curve.points[i].force * 2.0 * mm / 40 / 3.0;
  }
  const double stored = curve.points.back().energy - curve.points.front().energy;
  // The contact is tangent by the C1 curve, not by the discrete energy: second order in the mesh, 1.5e-4 at
  // 128 edges.
  EXPECT_NEAR(work, stored, 3e-4 * stored);
}

TEST(SpatialPush, TiltToEitherSideIsTheSame) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.travel = even_travel(1.5 * mm, 3);
  test.pusher.tilt = 5.0 * degree;
  const PushCurve right = solve_push(test, mesh(64));
  test.pusher.tilt = -5.0 * degree;
  const PushCurve left = solve_push(test, mesh(64));
  ASSERT_TRUE(right.report.usable() && left.report.usable());
  for (std::size_t i = 1; i < right.points.size(); ++i) {
    EXPECT_NEAR(right.points[i].force, left.points[i].force,
                1e-7 * right.points[i].force);  // Newton's tolerance
    EXPECT_NEAR(right.points[i].axial_force, -left.points[i].axial_force, 1e-6 * right.points[i].force);
  }
}

TEST(SpatialPush, TiltAtMidSpanDoesNotTurnTheForce) {
  PushProblem test = declared_wire(87.5 * mm, 0.0);
  test.travel = {1.0 * mm};
  const PushCurve planar = solve_push(test, mesh(64));
  test.pusher.tilt = 8.0 * degree;
  const PushCurve tilted = solve_push(test, mesh(64));
  ASSERT_TRUE(tilted.report.usable()) << tilted.report.message;
  // At the crown the wire runs along the chord: the common normal stays the push direction whatever the tilt.
  EXPECT_NEAR(tilted.points.back().force, planar.points.back().force, 1e-6 * planar.points.back().force);
  EXPECT_NEAR(tilted.points.back().axial_force, 0.0, 1e-6 * planar.points.back().force);
}

TEST(SpatialPush, FrictionLoopDissipatesItsArea) {
  PushProblem test = declared_wire(40.0 * mm, 6.0 * mm);
  test.pusher.tilt = 4.0 * degree;
  test.pusher.friction = 0.2;
  test.travel = even_travel(1.0 * mm, 100);
  for (int i = 99; i >= 0; --i) test.travel.push_back(1.0 * mm * i / 100);
  const PushCurve loop = solve_push(test, mesh(64));
  ASSERT_TRUE(loop.report.usable()) << loop.report.message;
  double area = 0.0;
  for (std::size_t i = 1; i < loop.points.size(); ++i) {
    area += 0.5 * (loop.points[i].force + loop.points[i - 1].force) *
            (loop.points[i].travel - loop.points[i - 1].travel);
    EXPECT_GE(loop.points[i].dissipated, loop.points[i - 1].dissipated);
  }
  // One step of 100 lies across the reversal: 1/100 of the jump's share, and the mesh's own 1e-3.
  EXPECT_NEAR(loop.points.back().dissipated, area, 0.02 * area);
}

TEST(SpatialPush, WhatIsNotComputedIsSaid) {
  PushProblem test = declared_wire(20.0 * mm, 6.0 * mm);
  test.pusher.tilt = 0.1;
  test.mount.kind = wire::MountKind::supports;
  test.mount.span = 40.0 * mm;
  test.wire.length = 60.0 * mm;
  test.travel = {1.0 * mm};
  const PushCurve curve = solve_push(test, mesh(64));
  EXPECT_FALSE(curve.report.usable());
  EXPECT_EQ(curve.report.message,
            "a tilted pusher is computed for wires between clamps or pins that do not slip");
  EXPECT_TRUE(curve.points.empty());
}

TEST(SpatialPush, InwardPushIsUnstableOutOfThePlane) {
  // A loose wire pushed against its bulge escapes sideways: it swings about its chord.
  PushProblem test = declared_wire(87.5 * mm, 0.0);
  test.travel = {0.2 * mm};
  PushOptions options = mesh(64);
  options.examine_out_of_plane = true;
  EXPECT_EQ(solve_push(test, options).points.back().out_of_plane_modes, 0);
  test.pusher.direction = PushDirection::inward;
  EXPECT_GE(solve_push(test, options).points.back().out_of_plane_modes, 1);
}

TEST(LooseSpatialWire, BucklesIntoTheAskedPlane) {
  const PushProblem test = declared_wire(87.5 * mm, 0.0);
  wire::PlanarRodProperties flat;
  flat.bending_stiffness = test.wire.bending_stiffness();
  flat.axial_stiffness = test.wire.axial_stiffness();
  flat.right.position = {test.mount.span, 0.0};
  const wire::PlanarRod planar(wire::make_mesh(64, 0.5, 0.0), flat);
  wire::SpatialRodProperties full;
  full.bending_stiffness = full.second_bending_stiffness = flat.bending_stiffness;
  full.axial_stiffness = flat.axial_stiffness;
  full.torsional_stiffness = test.wire.torsional_stiffness();
  full.right.position = {test.mount.span, 0.0, 0.0};
  const wire::SpatialRod rod(planar.mesh(), full);
  const wire::Controls controls{0.0, 0.09, 0.18};
  const double height = wire::vertex(wire::find_loose_wire(planar, controls, 1).state, 32).y();
  for (const double plane : {0.0, 0.7, std::numbers::pi, -2.0}) {
    const wire::LooseSpatialWire wire = wire::find_loose_wire(rod, planar, controls, 1, plane);
    ASSERT_TRUE(wire.report.usable()) << wire.report.message;
    const Eigen::Vector3d top = wire::vertex(wire.state, 32);
    EXPECT_NEAR(top.y(), height * std::cos(plane), 1e-9);  // 1e-7 of the height: Newton's tolerance
    EXPECT_NEAR(top.z(), height * std::sin(plane), 1e-9);
  }
}

}  // namespace
}  // namespace snare::coupling
