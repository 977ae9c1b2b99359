// Convergence, balance and smoothness of the frictionless push.

#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace snare::coupling {
namespace {

using test::declared_wire;
using test::mesh;
using test::mm;

double last_force(const PushCurve& curve) {
  return curve.points.empty() ? std::nan("") : curve.points.back().force;
}

TEST(PushAccuracy, ForceConvergesAtSecondOrder) {
  for (const double radius : {0.0, 6.0 * mm}) {
    // A quarter and a half of the span: the meshes of 64, 128 and 256 edges are nested.
    for (const double position : {87.5 * mm, 43.75 * mm}) {
      PushProblem test = declared_wire(position, radius);
      test.travel = {0.5 * mm, 1.0 * mm};
      const double reference = validation::push(test::elastica_of(test), 1.0 * mm).force;
      std::vector<double> errors;
      for (const int n : {64, 128, 256}) {
        errors.push_back(std::abs(last_force(solve_push(test, mesh(n, 0.0))) - reference));
      }
      // Halving the edges divides the error by 4; the asymptotic range is reached within 3 %.
      EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2.0, 0.06) << "radius " << radius << " at " << position;
      EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.15) << "radius " << radius << " at " << position;
    }
  }
}

// Clamps that turn by 0.3 rad: their springs are linear in the angle, in the plane and in space.
TEST(PushAccuracy, ClampsThatTurnFarMeetTheContinuousWire) {
  PushProblem test = declared_wire(40.0 * mm, 0.0);
  test.mount.translational_stiffness = 55e3;
  test.mount.rotational_stiffness = 0.6;
  test.travel = {2.0 * mm, 8.0 * mm};
  validation::ElasticaPush elastica = test::elastica_of(test);
  elastica.mount_axial_compliance = 1.0 / 55e3;
  elastica.mount_rotational_compliance = 1.0 / 0.6;
  const std::vector<validation::ElasticaState> reference = validation::push_path(elastica, test.travel);
  for (const double tilt : {0.0, 1e-6}) {
    test.pusher.tilt = tilt;
    const ExtrapolatedCurve result = solve_push_extrapolated(test, PushOptions{});
    ASSERT_EQ(result.curve.points.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_TRUE(reference[i].report.usable());
      EXPECT_GT(std::abs(reference[0].shape.front().angle), 0.29);
      EXPECT_NEAR(result.curve.points[i].force / reference[i].force, 1.0, 1e-6) << "tilt " << tilt;
    }
  }
}

TEST(PushAccuracy, ExtrapolatedForceMeetsTheContinuousWire) {
  for (const double radius : {0.0, 6.0 * mm}) {
    for (const double position : {40.0 * mm, 65.0 * mm, 90.0 * mm}) {
      PushProblem test = declared_wire(position, radius);
      test.travel = {1.0 * mm, 3.0 * mm};
      const ExtrapolatedCurve result = solve_push_extrapolated(test, PushOptions{});
      const std::vector<validation::ElasticaState> reference =
          validation::push_path(test::elastica_of(test), test.travel);
      for (std::size_t i = 0; i < test.travel.size(); ++i) {
        ASSERT_TRUE(reference[i].report.usable());
        // Ten times what was measured (1e-6) at the default mesh.
        EXPECT_NEAR(result.curve.points[i].force / reference[i].force, 1.0, 1e-5);
        EXPECT_NEAR(result.curve.points[i].tension_left, reference[i].tension_left,
                    1e-5 * std::abs(reference[i].tension_left) + 1e-4);
        EXPECT_NEAR(result.curve.points[i].contact_coordinate, reference[i].contact_begin, 1e-7);
        // It is an estimate, not a bound: right within a factor of two here, where both are below 1e-6 of the
        // force.
        EXPECT_LE(std::abs(result.curve.points[i].force - reference[i].force),
                  2.0 * result.discretisation_error[i] + 1e-6);
      }
    }
  }
}

TEST(PushAccuracy, SoftWireThatWrapsConverges) {
  PushProblem test = test::soft_wire(87.5 * mm, 6.0 * mm);
  test.travel = test::travel_to(6.0 * mm, 12);
  validation::ElasticaPush elastica = test::elastica_of(test);
  elastica.pieces_per_side = 40;
  const double reference = validation::push_path(elastica, {2.0 * mm, 4.0 * mm, 6.0 * mm}).back().force;
  const double coarse = std::abs(last_force(solve_push(test, mesh(64, 2.0))) - reference);
  const double fine = std::abs(last_force(solve_push(test, mesh(128, 2.0))) - reference);
  const double finest = std::abs(last_force(solve_push(test, mesh(256, 2.0))) - reference);
  // The wrapped length is known to one edge only, so that single steps scatter; two steps together do not.
  EXPECT_GE(std::log2(coarse / finest) / 2.0, 1.8);
  EXPECT_LT(fine, coarse);
  EXPECT_NEAR(solve_push_extrapolated(test, PushOptions{}).curve.points.back().force / reference, 1.0, 2e-4);
}

TEST(PushAccuracy, WrappedForceDoesNotDependOnTheSteps) {
  std::vector<double> forces;
  for (const int steps : {3, 6, 24}) {
    PushProblem test = test::soft_wire(87.5 * mm, 6.0 * mm);
    test.travel = test::travel_to(6.0 * mm, steps);
    forces.push_back(last_force(solve_push(test, mesh(128))));
  }
  EXPECT_NEAR(forces[0], forces[2], 1e-7 * forces[2]);  // Newton's tolerance on forces of kN
  EXPECT_NEAR(forces[1], forces[2], 1e-7 * forces[2]);
}

TEST(PushAccuracy, MountsAndPusherBalance) {
  for (const double radius : {0.0, 6.0 * mm}) {
    PushProblem test = declared_wire(40.0 * mm, radius);
    test.travel = test::travel_to(4.0 * mm, 20);
    for (const PushPoint& p : solve_push(test, mesh(128)).points) {
      const double largest = std::max({std::abs(p.tension_left), std::abs(p.tension_right), p.force});
      EXPECT_LE(p.imbalance, 1e-9 * largest) << "at " << p.travel;
    }
  }
}

TEST(PushAccuracy, CurveOverACylinderIsSmooth) {
  struct Case {
    PushProblem test;
    double to;
  };
  for (const Case& c : {Case{declared_wire(40.0 * mm, 6.0 * mm), 4.0 * mm},
                        Case{declared_wire(65.0 * mm, 6.0 * mm), 4.0 * mm},
                        Case{declared_wire(90.0 * mm, 6.0 * mm), 4.0 * mm},
                        Case{test::soft_wire(65.0 * mm, 6.0 * mm), 6.0 * mm}}) {
    PushProblem test = c.test;
    constexpr int n = 400;
    test.travel = test::travel_to(c.to, n);
    const PushCurve curve = solve_push(test, PushOptions{});
    ASSERT_EQ(curve.points.size(), static_cast<std::size_t>(n + 1)) << curve.report.message;
    std::vector<double> second;
    for (int i = 1; i < n; ++i) {
      second.push_back(curve.points[i + 1].force - 2.0 * curve.points[i].force + curve.points[i - 1].force);
    }
    // Chatter: what a second difference departs from the mean of its neighbours.
    const double range = curve.points.back().force;
    for (std::size_t i = 1; i + 1 < second.size(); ++i) {
      EXPECT_LE(std::abs(second[i] - 0.5 * (second[i - 1] + second[i + 1])), 1e-4 * range)
          << "at " << curve.points[i + 1].travel;
    }
  }
}

TEST(PushAccuracy, PinnedWireMeetsTheContinuousOne) {
  PushProblem test = declared_wire(65.0 * mm, 0.0);
  test.mount.kind = wire::MountKind::pinned;
  test.travel = {1.0 * mm, 2.0 * mm};
  const double reference = validation::push_path(test::elastica_of(test), test.travel).back().force;
  EXPECT_NEAR(solve_push_extrapolated(test, PushOptions{}).curve.points.back().force / reference, 1.0, 1e-5);
}

TEST(PushAccuracy, NaturalCurvatureDoesNothingBetweenRigidClamps) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.travel = {1.0 * mm, 2.0 * mm};
  const double straight = last_force(solve_push(test, mesh(64)));
  test.wire.natural_curvature = 3.0;
  // The turning angles between rigid clamps sum to zero, and so does the work of a uniform moment, but for
  // the third order of 2 tan(phi/2) in phi.
  EXPECT_NEAR(last_force(solve_push(test, mesh(64))), straight, 1e-3 * straight);
  EXPECT_NEAR(last_force(solve_push(test, mesh(256))),
              last_force(solve_push(
                  [&] {
                    PushProblem t = test;
                    t.wire.natural_curvature = 0.0;
                    return t;
                  }(),
                  mesh(256))),
              6e-5 * straight);
}

// A thick pusher with hardly any friction on a soft wire: the path on the coarser meshes stops at once, and
// the finest mesh is not extrapolated.
TEST(PushAccuracy, NoErrorIsNoErrorOfZero) {
  PushProblem test = declared_wire(128.6 * mm, 5.0 * mm);
  test.wire.length = 200.0 * mm;
  test.wire.bending_stiffness_override = 6.434e-5;
  test.wire.axial_stiffness_override = 899.0;
  test.mount.kind = wire::MountKind::supports;
  test.mount.support_radius = 0.0;
  test.travel = {0.5 * mm, 1.0 * mm, 2.0 * mm, 3.2 * mm};
  const ExtrapolatedCurve fine = solve_push_extrapolated(test, mesh(512));
  test.pusher.friction = 1e-9;
  const ExtrapolatedCurve coarse = solve_push_extrapolated(test, mesh(64));
  ASSERT_EQ(coarse.curve.points.size(), fine.curve.points.size());
  for (std::size_t i = 0; i < coarse.curve.points.size(); ++i) {
    const double error = coarse.discretisation_error[i];
    if (std::isnan(error)) continue;
    EXPECT_LE(std::abs(coarse.curve.points[i].force - fine.curve.points[i].force),
              3.0 * error + 1e-6 * fine.curve.points[i].force);
  }
}

// Work of the pusher: what the wire gains, by forces and energies that are both extrapolated.
TEST(PushAccuracy, EnergyIsTheWorkOfTheForce) {
  PushProblem test = declared_wire(60.0 * mm, 0.0);
  test.travel = test::travel_to(1.0 * mm, 32);
  const PushCurve curve = solve_push_extrapolated(test, mesh(128)).curve;
  ASSERT_EQ(curve.points.size(), 33U);
  double work = 0.0;
  for (std::size_t i = 2; i < 33; i += 2)
    work += (curve.points[i - 2].force + 4.0 * curve.points[i - 1].force + curve.points[i].force) * 1.0 * mm /
            96.0;
  EXPECT_NEAR((curve.points.back().energy - curve.points.front().energy) / work, 1.0, 1e-4);
}

// Nothing but friction holds a wire on supports along itself: a point at which something else does is none.
TEST(PushAccuracy, NoPointIsOutOfBalance) {
  PushProblem test = declared_wire(136.1 * mm, 1.5 * mm);
  test.wire.length = 200.0 * mm;
  test.wire.diameter = 1.0 * mm;
  test.wire.bending_stiffness_override = 1.0;
  test.wire.axial_stiffness_override = 1.6e7;
  test.mount.kind = wire::MountKind::supports;
  test.mount.support_radius = 0.0;
  test.pusher.friction = 1.0;
  test.travel = test::travel_to(1.0 * mm, 4);
  const PushCurve curve = solve_push(test, mesh(256));
  for (const PushPoint& p : curve.points)
    EXPECT_LE(p.imbalance, 1e-3 * std::max(std::abs(p.reaction_across_left), std::abs(p.force)) + 1e-6);
}

// With hardly any friction the way back is the way there; the supports let the wire slide before the pusher
// is said to leave it.
TEST(PushAccuracy, SupportsSlideOnTheWayBack) {
  PushProblem test = declared_wire(39.0 * mm, 0.0);
  test.wire.length = 80.0 * mm;
  test.wire.diameter = 0.2 * mm;
  test.wire.bending_stiffness_override = 1.0;
  test.wire.axial_stiffness_override = 1.6e7;
  test.mount.kind = wire::MountKind::supports;
  test.mount.span = 79.0 * mm;
  test.mount.support_radius = 0.0;
  test.pusher.friction = 1e-9;
  test.travel = test::there_and_back(1.0 * mm, 4);
  const PushCurve curve = solve_push(test, mesh(64));
  ASSERT_TRUE(curve.report.usable()) << curve.report.message;
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(curve.points[8 - i].force, curve.points[i].force, 1e-6 * curve.points[4].force)
        << "after " << i << " steps";
}

// The travel counts from the wire that sags: to first order the weight adds nothing to the force, 48 EI
// d/L^3, and half of itself to each support.
TEST(PushAccuracy, WeightOnSupportsAddsNoForce) {
  PushProblem test = declared_wire(125.0 * mm, 0.0);
  test.wire.length = 300.0 * mm;
  test.wire.diameter = 2.0 * mm;
  test.mount.kind = wire::MountKind::supports;
  test.mount.span = 250.0 * mm;
  test.mount.support_radius = 0.0;
  test.travel = test::travel_to(0.5 * mm, 4);
  const double stiffness = 48.0 * test.wire.bending_stiffness() / std::pow(test.mount.span, 3);
  const double weight = test.wire.mass_per_length() * 9.81 * test.mount.span;
  for (const double friction : {0.0, 0.2}) {
    test.pusher.friction = friction;
    for (const double gravity : {0.0, 9.81}) {
      test.gravity = {0.0, gravity, 0.0};  // onto the supports, which hold against the push
      const PushCurve curve = solve_push(test, mesh(64));
      ASSERT_TRUE(curve.report.usable()) << curve.report.message;
      for (const PushPoint& p : curve.points) {
        EXPECT_NEAR(p.force, stiffness * p.travel, 2e-3 * stiffness * test.travel.back())
            << friction << ' ' << gravity;
        EXPECT_NEAR(-p.reaction_across_left, 0.5 * p.force + (gravity > 0.0 ? 0.5 * weight : 0.0),
                    2e-3 * weight);
      }
    }
  }
}

}  // namespace
}  // namespace snare::coupling
