// Wires at the ends of what a file may say: a reason, never a crash and never a value that is not a number.

#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace snare::coupling {
namespace {

using test::mesh;
using test::mm;

/// A thread of plastic, slack, pushed far.
PushProblem thread(double bending_stiffness, double position, double to) {
  PushProblem test;
  test.wire.diameter = 0.8e-3;
  test.wire.length = 0.3;
  test.wire.youngs_modulus = 3e9;
  test.wire.poisson_ratio = 0.4;
  test.wire.density = 1140.0;
  test.wire.bending_stiffness_override = bending_stiffness;
  test.mount.span = 0.295;
  test.pusher.radius = 2.5e-3;
  test.contact_position = position;
  test.travel = test::travel_to(to, 59);
  return test;
}

void expect_reasons(const PushProblem& test) {
  const ExtrapolatedCurve result = solve_push_extrapolated(test, mesh(64));
  EXPECT_NE(result.curve.report.usable(), !result.curve.report.message.empty());
  for (const PushPoint& p : result.curve.points) {
    for (const double value :
         {p.force, p.tension_left, p.tension_right, p.energy, p.bending_moment, p.imbalance})
      EXPECT_TRUE(std::isfinite(value)) << "at " << p.travel;
  }
}

// Next to no bending stiffness: the first tangent of an arc is singular.
TEST(PushLimits, NoBendingStiffness) {
  for (const double stiffness : {1e-15, 1e-13, 1e-11}) {
    expect_reasons(thread(stiffness, 147.5 * mm, 12.0 * mm));
    expect_reasons(thread(stiffness, 60.0 * mm, 7.0 * mm));
  }
}

TEST(PushLimits, StopsBetweenPoints) {
  PushOptions options = mesh(64);
  int asked = 0;
  options.stop = [&asked] { return ++asked > 3; };
  const PushCurve curve = solve_push(thread(1e-4, 147.5 * mm, 12.0 * mm), options);
  EXPECT_EQ(curve.report.termination, numerics::Termination::interrupted);
  EXPECT_EQ(asked, 4);
}

/// Forces of a push [N]; none after a failure, which is reported.
std::vector<double> forces_of(const PushProblem& test, int elements = 128) {
  const PushCurve curve = solve_push(test, mesh(elements));
  EXPECT_TRUE(curve.report.usable()) << curve.report.message;
  std::vector<double> forces;
  for (const PushPoint& p : curve.points) forces.push_back(p.force);
  return forces;
}

// The difference to rigid mounts falls as the compliance, and from 1e11 N/m on the last places of the right
// mount's coordinate carry more than a millinewton.
TEST(PushLimits, StiffMountsGiveTheRigidAnswer) {
  for (const wire::MountKind kind : {wire::MountKind::clamped, wire::MountKind::pinned}) {
    for (const double tilt : {0.0, 0.1}) {
      PushProblem test = test::declared_wire(65.0 * mm, 6.0 * mm);
      test.mount.kind = kind;
      test.pusher.tilt = tilt;
      test.travel = test::travel_to(3.0 * mm, 3);
      const std::vector<double> rigid = forces_of(test);
      ASSERT_EQ(rigid.size(), 4u);
      double before = 0.0;
      for (const double stiffness : {1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e18}) {
        test.mount.translational_stiffness = stiffness;
        const std::vector<double> forces = forces_of(test);
        ASSERT_EQ(forces.size(), 4u) << stiffness;
        const double difference = (rigid[3] - forces[3]) / rigid[3];
        // Newton's tolerance and the coordinates' round-off: 1e-8 of forces that are differences of larger
        // ones.
        if (stiffness > 1e8 && stiffness < 1e16)
          EXPECT_NEAR(difference, 0.1 * before, 0.05 * 0.1 * before + 1e-8) << stiffness;
        if (stiffness > 1e16) EXPECT_NEAR(difference, 0.0, 1e-8);
        before = difference;
      }
      test.mount.translational_stiffness.reset();
      if (kind == wire::MountKind::pinned) continue;
      for (const double stiffness : {1e9, 1e12, 1e15, 1e18}) {
        test.mount.rotational_stiffness = stiffness;
        EXPECT_NEAR(forces_of(test)[3], rigid[3], 1e-8 * rigid[3]) << stiffness;
      }
    }
  }
}

// Metal that does not yield in the push is elastic metal, however its section is made up of fibres.
TEST(PushLimits, HighYieldStressGivesTheElasticAnswer) {
  struct Case {
    wire::MountKind kind;
    double diameter, length, span, position, friction, to;
    int elements;
  };
  using enum wire::MountKind;
  for (const Case& c : {Case{clamped, 1.5, 180.0, 175.0, 65.0, 0.0, 2.0, 128},
                        Case{pinned, 0.5, 105.0, 100.0, 48.2, 0.0, 4.0, 128},
                        Case{pinned, 1.5, 180.0, 175.0, 78.8, 0.0, 0.5, 512},
                        Case{clamped, 0.5, 251.0, 250.0, 90.6, 0.2, 2.0, 128},
                        Case{pinned, 0.3, 178.0, 175.0, 138.6, 0.0, 4.0, 128}}) {
    PushProblem test = test::declared_wire(c.position * mm, 0.0);
    test.mount.kind = c.kind;
    test.mount.span = c.span * mm;
    test.wire.bending_stiffness_override.reset();
    test.wire.axial_stiffness_override.reset();
    test.wire.diameter = c.diameter * mm;
    test.wire.length = c.length * mm;
    test.pusher.friction = c.friction;
    test.travel = test::travel_to(c.to * mm, 4);
    const std::vector<double> elastic = forces_of(test, c.elements);
    for (const double stress : {1e11, 1e13, 1e15}) {
      test.wire.yielding = wire::Yielding{stress, 0.02};
      const std::vector<double> forces = forces_of(test, c.elements);
      ASSERT_EQ(forces.size(), elastic.size()) << c.diameter << " " << stress;
      // Newton's tolerance and round-off: forces are differences of tensions that are larger.
      for (std::size_t i = 0; i < forces.size(); ++i)
        EXPECT_NEAR(forces[i], elastic[i], 1e-6 * elastic.back()) << c.diameter << " " << stress;
    }
  }
}

}  // namespace
}  // namespace snare::coupling
