#include "coupling/statics/push_solver.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace snare::coupling {
namespace {

using test::declared_wire;
using test::mm;

/// Three-point bending of a straight wire by knife edges, in the middle.
PushProblem three_point_bending(double span, double length) {
  PushProblem test = declared_wire(0.5 * span, 0.0);
  test.mount.kind = wire::MountKind::supports;
  test.mount.span = span;
  test.wire.length = length;
  test.pusher.direction = PushDirection::inward;
  return test;
}

double stiffness(const PushCurve& curve, std::size_t from, std::size_t to) {
  return (curve.points[to].force - curve.points[from].force) /
         (curve.points[to].travel - curve.points[from].travel);
}

// Small deflections: F = 48 EI w / l^3 while the strands stick, with EI + extra; the first slip, under the
// pusher, comes at F l / 4 = (EI + extra) slip curvature.
TEST(PushHysteresis, StrandsStickAndSlipInThreePointBending) {
  const double span = 100.0 * mm;
  PushProblem test = three_point_bending(span, 110.0 * mm);
  const double ei = 5e-3;
  const double extra = 2e-2;
  const double slip_curvature = 0.2;
  test.wire.bending_stiffness_override = ei;
  test.wire.strand_friction = wire::StrandFriction{extra, slip_curvature};
  test.travel = test::there_and_back(2.0 * mm, 200);
  PushOptions options;
  options.elements = 128;
  const PushCurve curve = solve_push(test, options);
  ASSERT_TRUE(curve.report.usable()) << curve.report.message;
  const double cube = std::pow(span, 3);
  const double sticking = 48.0 * (ei + extra) / cube;
  EXPECT_NEAR(stiffness(curve, 1, 5), sticking, 1e-3 * sticking);
  // A moment that has slipped nearly everywhere: towards the soft stiffness.
  const double end = stiffness(curve, 190, 200);
  EXPECT_GT(end, 48.0 * ei / cube);
  EXPECT_LT(end, 1.1 * 48.0 * ei / cube);
  EXPECT_NEAR(stiffness(curve, 200, 203), sticking, 2e-2 * sticking);  // sticks again on the way back
  // The loop encloses work.
  double work = 0.0;
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    work += 0.5 * (curve.points[i].force + curve.points[i - 1].force) *
            (curve.points[i].travel - curve.points[i - 1].travel);
  }
  EXPECT_GT(work, 0.0);
  // What has slipped keeps the wire bent: the pusher leaves it on the way back, and nothing moves it along
  // its supports.
  const PushPoint& last = curve.points[360];
  EXPECT_FALSE(last.in_contact);
  EXPECT_NEAR(last.force, 0.0, 1e-12);
  EXPECT_NEAR(last.contact_coordinate, 0.5 * test.wire.length, 1e-9 * mm);
  EXPECT_LT(last.imbalance, 1e-6);
}

// Yielding in tension: beyond the yield strain the tangent of a straight string's force falls to that of the
// hardening.
TEST(PushHysteresis, TautWireYieldsAndStaysLonger) {
  PushProblem test = declared_wire(87.5 * mm, 0.0);
  test.wire.length = test.mount.span;
  test.wire.yielding = wire::Yielding{400e6, 0.02};
  test.travel = test::there_and_back(8.0 * mm, 40);
  const PushCurve yielding = solve_push(test, {});
  ASSERT_TRUE(yielding.report.usable()) << yielding.report.message;
  test.wire.yielding->yield_stress = 1e12;
  const PushCurve elastic = solve_push(test, {});
  ASSERT_TRUE(elastic.report.usable());
  const std::size_t top = 40;
  EXPECT_NEAR(yielding.points[10].force, elastic.points[10].force, 5e-2 * elastic.points[10].force);
  EXPECT_LT(yielding.points[top].force, 0.7 * elastic.points[top].force);
  EXPECT_NEAR(elastic.points[20].force, elastic.points[60].force, 1e-6 * elastic.points[top].force);
  EXPECT_LT(yielding.points[60].force, 0.5 * yielding.points[20].force);  // longer now: slack on the way back
}

// theory.md (C.12): at the travel that is longer by C F the force is that of a stiff machine.
TEST(PushHysteresis, MachineThatGivesIsASpringInSeries) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.travel = {1.0 * mm, 2.0 * mm};
  const PushCurve rigid = solve_push(test, {});
  test.pusher.compliance = 1e-6;
  for (double& d : test.travel) {
    const std::size_t i = d < 1.5 * mm ? 0 : 1;
    d += test.pusher.compliance * rigid.points[i].force;
  }
  const PushCurve giving = solve_push(test, {});
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(giving.points[i].force, rigid.points[i].force, 1e-8 * rigid.points[i].force);
  }
}

}  // namespace
}  // namespace snare::coupling
