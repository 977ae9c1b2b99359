// Coulomb friction on the pusher, a slipping mount, mounts that give.

#include "tests/support/declared_wire.hpp"
#include "validation/closed_forms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace snare::coupling {
namespace {

using test::declared_wire;
using test::mesh;
using test::mm;

double loop_area(const PushCurve& curve) {
  double area = 0.0;
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    area += 0.5 * (curve.points[i].force + curve.points[i - 1].force) *
            (curve.points[i].travel - curve.points[i - 1].travel);
  }
  return area;
}

bool has(const PushCurve& curve, PushEvent::Kind kind) {
  return std::any_of(curve.events.begin(), curve.events.end(),
                     [kind](const PushEvent& e) { return e.kind == kind; });
}

TEST(PushFriction, LoopClosesAndDissipatesItsArea) {
  PushProblem test = declared_wire(40.0 * mm, 6.0 * mm);
  test.pusher.friction = 0.2;
  test.travel = test::there_and_back(2.0 * mm, 400);
  const PushCurve loop = solve_push(test, mesh(64));
  ASSERT_TRUE(loop.report.usable()) << loop.report.message;
  const double area = loop_area(loop);
  EXPECT_GT(area, 1e-4);
  EXPECT_NEAR(loop.points.back().dissipated, area, 0.01 * area);
  EXPECT_NEAR(loop.points.back().force, 0.0, 1e-6);  // closed: first touch again without force
  EXPECT_NEAR(loop.points.back().energy, loop.points.front().energy, 1e-9);
  for (std::size_t i = 1; i < loop.points.size(); ++i)
    EXPECT_GE(loop.points[i].dissipated, loop.points[i - 1].dissipated);
  EXPECT_TRUE(has(loop, PushEvent::Kind::slip_begins));
  EXPECT_TRUE(has(loop, PushEvent::Kind::slip_ends));
}

// The pusher leaves on the way back, and slides until it does. Points within a step have a work of their own.
TEST(PushFriction, DissipatesUntilItLeaves) {
  PushProblem test = declared_wire(40.0 * mm, 6.0 * mm);
  test.pusher.friction = 0.3;
  test.travel = test::there_and_back(4.0 * mm, 9);
  test.wire.strand_friction = wire::StrandFriction{0.02, 2.0, 0.0};
  const PushCurve few = solve_push(test, mesh(64));
  test.travel = test::there_and_back(4.0 * mm, 60);
  const PushCurve many = solve_push(test, mesh(64));
  ASSERT_TRUE(few.report.usable() && many.report.usable());
  EXPECT_FALSE(few.points.back().in_contact);
  EXPECT_NEAR(few.points.back().dissipated, many.points.back().dissipated,
              1e-3 * many.points.back().dissipated);
  for (const PushCurve* curve : {&few, &many})
    for (std::size_t i = 1; i < curve->points.size(); ++i)
      EXPECT_GE(curve->points[i].dissipated, (1.0 - 3e-4) * curve->points[i - 1].dissipated);
}

// A round pusher that moves askew drags a wire over its supports and rolls along it.
TEST(PushFriction, WorkOnSupportsIsEnergy) {
  for (const double radius : {0.0, 13.0 * mm}) {
    for (const double askew : {-0.13, 0.13}) {
      PushProblem test = declared_wire(140.0 * mm, radius);
      test.mount.kind = wire::MountKind::supports;
      test.pusher.friction = 0.4;
      test.pusher.misalignment = askew;
      test.travel = test::travel_to(2.0 * mm, 60);
      const PushCurve curve = solve_push(test, mesh(64));
      ASSERT_TRUE(curve.report.usable()) << curve.report.message;
      const PushPoint &first = curve.points.front(), &last = curve.points.back();
      const double gain = last.energy + last.dissipated - first.energy;
      EXPECT_GT(last.dissipated, 0.02 * gain);
      EXPECT_NEAR(loop_area(curve), gain, 2e-3 * gain) << radius << ' ' << askew;
    }
  }
}

TEST(PushFriction, ForceStaysInTheCone) {
  for (const double radius : {0.0, 6.0 * mm}) {
    for (const double mu : {0.05, 0.2, 0.6}) {
      PushProblem test = declared_wire(40.0 * mm, radius);
      test.pusher.friction = mu;
      test.travel = test::there_and_back(2.0 * mm, 25);
      const PushCurve curve = solve_push(test, mesh(64));
      ASSERT_TRUE(curve.report.usable()) << curve.report.message;
      for (const PushPoint& p : curve.points) {
        EXPECT_GE(p.normal_force, -1e-7);
        // 1e-7 N: the force tolerance of the solve.
        EXPECT_LE(std::abs(p.friction_force), mu * p.normal_force + 1e-7) << "at " << p.travel;
        if (p.slipping) {
          EXPECT_NEAR(std::abs(p.friction_force), mu * p.normal_force, 1e-7);
        }
      }
    }
  }
}

TEST(PushFriction, StickAndSlipAreBothSeen) {
  // Symmetric: nothing drives the wire along, it sticks all the way.
  PushProblem test = declared_wire(87.5 * mm, 6.0 * mm);
  test.pusher.friction = 0.2;
  test.travel = test::travel_to(2.0 * mm, 10);
  for (const PushPoint& p : solve_push(test, mesh(64)).points) EXPECT_FALSE(p.slipping);
  // Steep: it slides from the first touch on.
  test = declared_wire(40.0 * mm, 6.0 * mm);
  test.pusher.friction = 0.2;
  test.travel = test::travel_to(2.0 * mm, 10);
  const PushCurve steep = solve_push(test, mesh(64));
  for (std::size_t i = 1; i < steep.points.size(); ++i) EXPECT_TRUE(steep.points[i].slipping);
}

TEST(PushFriction, SlidingForceMeetsTheContinuousWire) {
  PushProblem test = declared_wire(40.0 * mm, 6.0 * mm);
  test.pusher.friction = 0.3;
  test.travel = test::travel_to(2.0 * mm, 4);
  const double force = solve_push_extrapolated(test, PushOptions{}).curve.points.back().force;
  validation::ElasticaPush elastica = test::elastica_of(test);
  double nearest = 1e9;
  for (const double slope : {-0.3, 0.3}) {  // the direction of sliding is for the rod to find
    elastica.friction_slope = slope;
    const validation::ElasticaState state = validation::push(elastica, 2.0 * mm);
    if (state.report.usable()) nearest = std::min(nearest, std::abs(force / state.force - 1.0));
  }
  EXPECT_LE(nearest, 1e-5);
}

TEST(SlowPushFriction, CapstanOnAWrappedPin) {
  // A soft wire pushed far off its middle slides over a thick pin on its whole arc.
  PushProblem test = test::soft_wire(60.0 * mm, 20.0 * mm);
  test.wire.bending_stiffness_override = 5e-6;
  test.pusher.friction = 0.1;
  test.travel = test::travel_to(14.0 * mm, 140);
  PushOptions options = mesh(128, 2.0);
  options.shapes_at = {test.travel.back()};
  const PushCurve curve = solve_push(test, options);
  ASSERT_TRUE(curve.report.usable()) << curve.report.message;
  ASSERT_GT(curve.points.back().wrapped_length, 2.0 * mm);
  ASSERT_TRUE(curve.points.back().slipping) << "the whole arc must slide for the law to hold";
  const PushShape& shape = curve.shapes.back();
  // Angle between the straight runs on both sides; the wire is so soft that they are straight but for 0.1 mm.
  const auto angle = [&](std::size_t i) {
    return std::atan2(shape.y[i + 1] - shape.y[i], shape.x[i + 1] - shape.x[i]);
  };
  const std::size_t last = shape.x.size() - 1;
  const double wrap = std::abs(angle(last - 20) - angle(20));
  const double ratio = shape.tension[20] / shape.tension[last - 20];
  EXPECT_NEAR(std::abs(std::log(ratio)), std::log(validation::capstan_ratio(0.1, wrap)), 0.02 * 0.1 * wrap);
}

TEST(SlippingMount, CapsTheTensionAndBalancesTheEnergy) {
  PushProblem test = declared_wire(60.0 * mm, 0.0);
  test.mount.slip_tension = 80.0;
  test.travel = test::there_and_back(5.0 * mm, 200);
  const PushCurve curve = solve_push(test, mesh(128));
  ASSERT_TRUE(curve.report.usable()) << curve.report.message;
  EXPECT_TRUE(has(curve, PushEvent::Kind::mount_slips));
  for (const PushPoint& p : curve.points) {
    // The driving force dE/dS is the tension and the strain energy of bending at the clamp, M^2/2EI, a few
    // newton.
    EXPECT_LE(std::abs(p.tension_left), 80.0 + 10.0);
  }
  const double work = loop_area(curve);
  const double stored = curve.points.back().energy - curve.points.front().energy;
  const double dissipated = curve.points.back().dissipated;
  EXPECT_GT(dissipated, 1e-3);
  EXPECT_NEAR(work, stored + dissipated,
              0.01 * dissipated);  // trapezoids, contact of second order in the mesh
}

TEST(ElasticMounts, StiffOnesAreRigidAndSoftOnesTurnAsPins) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.travel = {1.0 * mm};
  const auto force = [&](const PushProblem& t) { return solve_push(t, mesh(64)).points.back().force; };
  const double clamped = force(test);
  PushProblem pinned = test;
  pinned.mount.kind = wire::MountKind::pinned;
  PushProblem give = test;
  give.mount.rotational_stiffness = 1e7;
  EXPECT_NEAR(force(give), clamped, 1e-5 * clamped);  // EI/L over 1e7 is 3e-8
  give.mount.rotational_stiffness = 1e-6;
  EXPECT_NEAR(force(give), force(pinned), 1e-4 * clamped);
  give = test;
  give.mount.translational_stiffness = 1e10;
  EXPECT_NEAR(force(give), clamped, 1e-3 * clamped);  // EA/L over 1e10 is 2e-4
  give.mount.translational_stiffness = 1e6;
  EXPECT_LT(force(give), clamped);
}

TEST(Supports, ThreePointBendingOfAStiffWire) {
  PushProblem test = declared_wire(20.0 * mm, 2.0 * mm);
  test.mount.kind = wire::MountKind::supports;
  test.mount.span = 40.0 * mm;
  test.mount.support_radius = 2.0 * mm;
  test.wire.length = 60.0 * mm;
  test.travel = {1e-3 * mm};
  const double expected = validation::three_point_stiffness(test.wire.bending_stiffness(), test.mount.span,
                                                            test.contact_position) *
                          1e-3 * mm;
  // Round supports shift the contact by R slope, 1e-4 of the span here.
  EXPECT_NEAR(solve_push_extrapolated(test, PushOptions{}).curve.points.back().force, expected,
              1e-3 * expected);
  test.travel = test::travel_to(5.0 * mm, 10);
  const PushCurve deep = solve_push(test, mesh(128));
  ASSERT_TRUE(deep.report.usable()) << deep.report.message;
  EXPECT_NEAR(deep.points.back().tension_left, deep.points.back().tension_right, 1e-6);
}

TEST(Gravity, HangsAgainstAndWithThePush) {
  // A wire as heavy as lead pushed up: the weight adds to the force at small travel.
  PushProblem test = declared_wire(87.5 * mm, 0.0);
  test.travel = {0.2 * mm};
  const double none = solve_push(test, mesh(64)).points.back().force;
  test.gravity[1] = -9.81;
  const PushPoint down = solve_push(test, mesh(64)).points.back();
  EXPECT_LE(down.imbalance, 1e-7);
  // Weight 0.025 N, on a bulge that its own compression holds up: a change of the order of the weight.
  EXPECT_NEAR(down.force, none, 0.1);
  EXPECT_NE(down.force, none);
}

}  // namespace
}  // namespace snare::coupling
