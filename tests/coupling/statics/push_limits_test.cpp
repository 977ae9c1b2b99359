// Wires at the ends of what a file may say: a reason, never a crash and never a number that is none.

#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
    for (const double value : {p.force, p.tension_left, p.tension_right, p.energy, p.bending_moment, p.imbalance})
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

}  // namespace
}  // namespace snare::coupling
