// Axial forces at the ends of a wire and the reactions of its mounts, against closed forms and solvers that
// share no code with the rod.

#include "tests/support/declared_wire.hpp"

#include "coupling/statics/largest_stress.hpp"
#include "validation/blind_push.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace snare::coupling {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::declared_wire;
using test::mesh;
using test::mm;

/// A string of 100 mm between pins, not loose.
PushProblem string(double position) {
  PushProblem test = declared_wire(position, 0.0);
  test.wire.construction = wire::Construction::strand;
  test.wire.diameter = 1.0 * mm;
  test.wire.length = test.mount.span = 100.0 * mm;
  test.wire.bending_stiffness_override = 1e-8;
  test.wire.axial_stiffness_override = 1000.0;
  test.mount.kind = wire::MountKind::pinned;
  return test;
}

TEST(PushEndForces, TautStringHasTheTensionOfItsStretch) {
  PushProblem test = string(50.0 * mm);
  test.travel = {5.0 * mm, 10.0 * mm, 15.0 * mm, 20.0 * mm};
  const ExtrapolatedCurve push = solve_push_extrapolated(test, PushOptions{});
  ASSERT_TRUE(push.curve.report.usable()) << push.curve.report.message;
  for (const PushPoint& p : push.curve.points) {
    const double half = std::hypot(50.0 * mm, p.travel);
    const double tension = 1000.0 * (2.0 * half / test.wire.length - 1.0);
    // The string is bent at the pusher over sqrt(EI/T), 1e-5 to 5e-5 m: as a share of the stretch below 1e-3.
    EXPECT_NEAR(p.tension_left, tension, 1e-3 * tension);
    EXPECT_NEAR(p.tension_right, tension, 1e-3 * tension);
    EXPECT_NEAR(p.largest_tension, tension, 2e-3 * tension);
    EXPECT_NEAR(-p.reaction_along_left, tension * 50.0 * mm / half, 1e-3 * tension);
    EXPECT_NEAR(p.reaction_across_right, -tension * p.travel / half, 1e-3 * tension);
  }
}

/// End forces n(0), n(L) of the elastic catenary under the weight w per unstretched length (Irvine 1981, ch.
/// 1), from the origin to (span, 0): r(L) = integral of n/|n| + n/EA with n(s) = n(0) - w s, found by
/// Newton's method.
std::array<Vector2d, 2> catenary(const Vector2d& weight, double length, double span, double ea) {
  const double w = weight.norm();
  const Vector2d u = weight / w;
  const Vector2d v(-u.y(), u.x());
  const auto reach = [&](const Vector2d& n) -> Vector2d {
    const double a = n.dot(u);
    const double b = n.dot(v);
    const double at_end = a - w * length;
    return (std::hypot(a, b) - std::hypot(at_end, b)) / w * u +
           b / w * (std::asinh(a / std::abs(b)) - std::asinh(at_end / std::abs(b))) * v +
           (length * n - 0.5 * length * length * weight) / ea;
  };
  Vector2d n = 0.5 * length * weight + 0.3 * w * length * Vector2d::UnitX();
  const double step = 1e-7 * w * length;
  for (int k = 0; k < 50; ++k) {
    const Vector2d miss = reach(n) - Vector2d(span, 0.0);
    Eigen::Matrix2d slope;
    for (int a = 0; a < 2; ++a)
      slope.col(a) =
          (reach(n + step * Vector2d::Unit(a)) - reach(n - step * Vector2d::Unit(a))) / (2.0 * step);
    n -= slope.inverse() * miss;
  }
  EXPECT_LT((reach(n) - Vector2d(span, 0.0)).norm(), 1e-12 * span);
  return {n, n - length * weight};
}

TEST(PushEndForces, HangingRopeIsTheElasticCatenary) {
  struct Case {
    double ea, tilt;
  };
  // A rope of steel and a soft one, the second 5 % longer by its weight; level, and with the right hook
  // higher.
  for (const Case& c : {Case{1e6, 0.0}, Case{5.0, 0.0}, Case{5.0, 0.3}, Case{1e4, -0.2}}) {
    PushProblem test = declared_wire(500.0 * mm, 1.0 * mm);
    test.wire.construction = wire::Construction::strand;
    test.wire.diameter = 2.0 * mm;
    test.wire.density = 7800.0;
    test.wire.length = 1200.0 * mm;
    test.mount.span = 1000.0 * mm;
    test.mount.kind = wire::MountKind::pinned;
    test.wire.bending_stiffness_override = 1e-6;
    test.wire.axial_stiffness_override = c.ea;
    test.gravity = {9.81 * std::sin(c.tilt), 9.81 * std::cos(c.tilt), 0.0};
    test.pusher.direction = PushDirection::inward;
    test.travel = {0.0};
    const ExtrapolatedCurve push = solve_push_extrapolated(test, mesh(200));
    ASSERT_TRUE(push.curve.report.usable()) << push.curve.report.message;
    const PushPoint& p = push.curve.points.front();
    const Vector2d weight = test.wire.mass_per_length() * Vector2d(test.gravity[0], test.gravity[1]);
    const auto [left, right] = catenary(weight, test.wire.length, test.mount.span, c.ea);
    // The bending stiffness carries EI kappa^2, about 1e-5 N, of 0.2 N.
    EXPECT_NEAR(p.tension_left, left.norm(), 2e-4 * left.norm());
    EXPECT_NEAR(p.tension_right, right.norm(), 2e-4 * left.norm());
    EXPECT_NEAR(p.largest_tension, std::max(left.norm(), right.norm()), 2e-3 * left.norm());
    EXPECT_NEAR(p.reaction_along_left, -left.x(), 2e-4 * left.norm());
    EXPECT_NEAR(p.reaction_across_left, -left.y(), 2e-4 * left.norm());
    EXPECT_NEAR(p.reaction_along_right, right.x(), 2e-4 * left.norm());
    EXPECT_NEAR(p.reaction_across_right, right.y(), 2e-4 * left.norm());
  }
}

TEST(PushEndForces, PinnedElasticaAgreesWithMultipleShooting) {
  for (const double radius : {0.0, 6.0 * mm}) {
    PushProblem test = declared_wire(65.0 * mm, radius);
    test.mount.kind = wire::MountKind::pinned;
    test.travel = {1.0 * mm, 3.0 * mm, 6.0 * mm};
    const ExtrapolatedCurve push = solve_push_extrapolated(test, PushOptions{});
    const std::vector<validation::ElasticaState> reference =
        validation::push_path(test::elastica_of(test), test.travel);
    for (std::size_t i = 0; i < reference.size(); ++i) {
      ASSERT_TRUE(reference[i].report.usable());
      const PushPoint& p = push.curve.points[i];
      // Ten times the difference of the extrapolated force (1e-6).
      EXPECT_NEAR(p.tension_left, reference[i].tension_left, 1e-5 * (p.force + std::abs(p.tension_left)));
      EXPECT_NEAR(p.tension_right, reference[i].tension_right, 1e-5 * (p.force + std::abs(p.tension_right)));
    }
  }
}

// Clamps that turn and give, weight in both directions, natural curvature, friction: collocation of the
// continuous wire.
TEST(PushEndForces, MountsThatGiveAgreeWithCollocation) {
  for (const double radius : {0.0, 6.0 * mm}) {
    PushProblem test = declared_wire(65.0 * mm, radius);
    test.mount.rotational_stiffness = 25.0;
    test.mount.translational_stiffness = 1e6;
    test.gravity = {3.0, 9.0, 0.0};
    test.wire.density *= 20.0;
    test.wire.natural_curvature = 1.0;
    test.pusher.friction = radius > 0.0 ? 0.2 : 0.0;
    test.travel = {1.0 * mm, 2.0 * mm, 3.0 * mm};
    validation::BlindWire blind;
    blind.length = test.wire.length;
    blind.span = test.mount.span;
    blind.bending_stiffness = test.wire.bending_stiffness();
    blind.axial_stiffness = test.wire.axial_stiffness();
    blind.diameter = test.wire.diameter;
    blind.position = test.contact_position;
    blind.radius = radius > 0.0 ? radius + 0.5 * test.wire.diameter : 0.0;
    blind.weight = test.wire.mass_per_length() * Vector2d(test.gravity[0], test.gravity[1]);
    blind.natural_curvature = 1.0;
    blind.friction = test.pusher.friction;
    blind.mount_rotational_compliance = 1.0 / 25.0;
    blind.mount_axial_compliance = 1e-6;
    const std::vector<validation::BlindReading> reference = validation::blind_push(blind, test.travel);
    const ExtrapolatedCurve push = solve_push_extrapolated(test, PushOptions{});
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const PushPoint& p = push.curve.points[i];
      // The mounts turn by some 0.05: their law errs by the third power of it, 1e-4 of the moment. (Along the
      // clamps' direction the tension would be 5 % of the transverse force wrong.)
      const double allowed = 1e-3 * (reference[i].force + std::abs(reference[i].tension_left));
      EXPECT_NEAR(p.force, reference[i].force, allowed);
      EXPECT_NEAR(p.tension_left, reference[i].tension_left, allowed);
      EXPECT_NEAR(p.tension_right, reference[i].tension_right, allowed);
    }
  }
}

// The sums of docs/curves_csv.md, for every kind of mount, pusher and weight.
TEST(PushEndForces, ReactionsBalancePusherAndWeight) {
  std::vector<PushProblem> tests;
  for (const double radius : {0.0, 6.0 * mm}) {
    for (const wire::MountKind kind :
         {wire::MountKind::clamped, wire::MountKind::pinned, wire::MountKind::supports}) {
      for (const PushDirection direction : {PushDirection::outward, PushDirection::inward}) {
        PushProblem test = declared_wire(65.0 * mm, radius);
        test.mount.kind = kind;
        test.pusher.direction = direction;
        test.pusher.misalignment = kind == wire::MountKind::supports ? 0.0 : 0.1;
        test.pusher.friction = 0.15;
        if (kind != wire::MountKind::supports)
          test.gravity = {2.0, -9.0, 0.0};  // else it may leave the supports
        tests.push_back(test);
      }
    }
  }
  PushProblem gives = declared_wire(40.0 * mm, 6.0 * mm);
  gives.mount.translational_stiffness = 1e5;
  gives.mount.rotational_stiffness = 5.0;
  gives.gravity = {2.0, 9.0, 0.0};
  tests.push_back(gives);
  PushProblem feeds = declared_wire(40.0 * mm, 6.0 * mm);
  feeds.mount.slip_tension = 20.0;  // without weight, which would be that of more wire than declared
  tests.push_back(feeds);
  feeds.mount.slip = wire::MountSlip::slides;
  feeds.mount.slip_tension = 80.0;  // above the buckling load of 58 N
  tests.push_back(feeds);
  PushProblem tilted = declared_wire(40.0 * mm, 6.0 * mm);
  tilted.pusher.tilt = 0.15;
  tilted.pusher.friction = 0.1;
  tilted.pusher.misalignment = 0.05;
  tilted.gravity = {2.0, 9.0, -4.0};
  tests.push_back(tilted);
  for (std::size_t k = 0; k < tests.size(); ++k) {
    PushProblem& test = tests[k];
    SCOPED_TRACE("push " + std::to_string(k));
    test.wire.density *= 50.0;
    test.travel = {0.5 * mm, 1.0 * mm};
    const ExtrapolatedCurve push = solve_push_extrapolated(test, mesh(64));
    ASSERT_TRUE(push.curve.report.usable()) << push.curve.report.message;
    const double side = test.pusher.direction == PushDirection::outward ? 1.0 : -1.0;
    const Vector2d m =
        side * Vector2d(std::sin(test.pusher.misalignment), std::cos(test.pusher.misalignment));
    const double mass = test.wire.mass_per_length() *
                        (test.mount.kind == wire::MountKind::supports ? test.mount.span : test.wire.length);
    for (const PushPoint& p : push.curve.points) {
      Vector3d sum(
          p.reaction_along_left + p.reaction_along_right + p.force * m.x() + p.transverse_force * m.y(),
          p.reaction_across_left + p.reaction_across_right + p.force * m.y() - p.transverse_force * m.x(),
          p.reaction_z_left + p.reaction_z_right + p.axial_force);
      const Vector3d weight = mass * Vector3d(test.gravity[0], test.gravity[1], test.gravity[2]);
      const double largest =
          std::abs(p.force) + std::abs(p.reaction_along_left) + std::abs(p.reaction_across_left);
      // Newton's tolerance of 1e-10 and rounding, on the forces of every vertex and with the extrapolation's
      // weights.
      EXPECT_LE((sum + weight).norm(), 1e-8 * largest) << p.travel;
    }
  }
}

// A limp wire between clamps is turned by the clamps only within sqrt(EI/T): there the axial force is the
// share of the string's force along the clamp, and the wire beyond bears all of it.
TEST(PushEndForces, StressIsThatOfTheLargestTension) {
  PushProblem test = string(50.0 * mm);
  test.mount.kind = wire::MountKind::clamped;
  test.travel = {20.0 * mm};
  const PushCurve curve = solve_push(test, mesh(256));
  ASSERT_TRUE(curve.report.usable()) << curve.report.message;
  const PushPoint& p = curve.points.back();
  const double share = 50.0 / std::hypot(50.0, 20.0);
  const double tension = 1000.0 * (1.0 / share - 1.0);
  EXPECT_NEAR(p.tension_left, share * tension, 2e-3 * tension);  // bent over 1e-5 m at three places, as above
  EXPECT_NEAR(p.largest_tension, tension, 2e-3 * tension);
  const double area = std::numbers::pi / 4.0 * 1e-6;
  EXPECT_NEAR(largest_stress(test.wire, curve.points), tension / area, 2e-3 * tension / area);
}

// Friction of supports pulls the ends of a wire that is drawn in over them: mu times the normal force of a
// support.
TEST(PushEndForces, FrictionOfSupportsIsTheTensionThere) {
  PushProblem test = declared_wire(87.5 * mm, 6.0 * mm);
  test.mount.kind = wire::MountKind::supports;
  test.mount.support_radius = 5.0 * mm;
  test.pusher.friction = 0.2;
  test.travel = test::travel_to(4.0 * mm, 8);
  const PushCurve curve = solve_push(test, mesh(128));
  ASSERT_TRUE(curve.report.usable()) << curve.report.message;
  const PushPoint& p = curve.points.back();
  // Half of the force each; the supports' normals lean by 3 s/l times the travel, 0.07, so that normal and
  // force differ by 2 %.
  EXPECT_NEAR(std::abs(p.tension_left), 0.2 * 0.5 * p.force, 0.03 * 0.2 * 0.5 * p.force);
  EXPECT_NEAR(p.tension_left, p.tension_right, 1e-6 * p.force);
}

}  // namespace
}  // namespace snare::coupling
