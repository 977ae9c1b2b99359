// A push takes steps of its own: its forces do not depend on the points that are asked for, and err by what
// is stated.

#include "coupling/statics/push_solver.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace snare::coupling {
namespace {

using test::declared_wire;
using test::mesh;
using test::mm;

struct Remembering {
  const char* name;
  PushProblem test;
  double to;  // [m]
  bool back = true;
  Instability instability = Instability::follow_path;
};

PushProblem slipping(wire::MountSlip kind, wire::SlipPlace place, double friction) {
  PushProblem test = declared_wire(60.0 * mm, 6.0 * mm);
  test.mount.slip_tension = 80.0;
  test.mount.slip = kind;
  test.mount.slip_at = place;
  test.pusher.friction = friction;
  return test;
}

PushProblem rubbing(double position, double friction) {
  PushProblem test = declared_wire(position, 6.0 * mm);
  test.pusher.friction = friction;
  return test;
}

/// A wire whose mount does not hold it: 50 N against its own thrust of some 60 N.
PushProblem not_held() {
  PushProblem test = declared_wire(40.0 * mm, 6.0 * mm);
  test.mount.slip_tension = 50.0;
  return test;
}

PushProblem strands(double breadth, double friction) {
  PushProblem test = rubbing(65.0 * mm, friction);
  test.wire.strand_friction = wire::StrandFriction{0.02, 0.8, breadth};
  return test;
}

PushProblem yielding(double stress) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.wire.yielding = wire::Yielding{stress, 0.02};
  return test;
}

/// A soft wire that wraps the pusher.
PushProblem wrapping(double friction) {
  PushProblem test = test::soft_wire(65.0 * mm, 6.0 * mm);
  test.pusher.friction = friction;
  return test;
}

PushProblem inward(double position, double friction) {
  PushProblem test = declared_wire(position, 0.0);
  test.pusher.friction = friction;
  test.pusher.direction = PushDirection::inward;
  return test;
}

PushProblem tilted(double tilt, double friction) {
  PushProblem test = rubbing(65.0 * mm, friction);
  test.pusher.tilt = tilt;
  return test;
}

/// A soft, light arch across whose plane the weight pulls: it hangs before it is pushed.
PushProblem hanging(double friction) {
  PushProblem test;
  test.wire.diameter = 1.1 * mm;
  test.wire.length = 59.2 * mm;
  test.wire.youngs_modulus = 3.3e9;
  test.wire.density = 2000.0;
  test.mount.span = 59.1 * mm;
  test.pusher.radius = 1.8 * mm;
  test.pusher.friction = friction;
  test.gravity = {0.0, 0.0, 9.65};
  test.contact_position = 25.0 * mm;
  return test;
}

std::vector<Remembering> remembering() {
  using wire::MountSlip;
  using wire::SlipPlace;
  return {{"FeedsLeft", slipping(MountSlip::feeds, SlipPlace::left, 0.0), 5.0 * mm},
          {"FeedsBothRubbing", slipping(MountSlip::feeds, SlipPlace::both, 0.2), 5.0 * mm},
          {"SlidesLeftRubbing", slipping(MountSlip::slides, SlipPlace::left, 0.2), 5.0 * mm},
          {"SlidesBoth", slipping(MountSlip::slides, SlipPlace::both, 0.0), 5.0 * mm},
          {"NotHeld", not_held(), 20.0 * mm, false},
          {"Strands", strands(0.0, 0.0), 3.0 * mm},
          {"StrandsOfABreadth", strands(1.5, 0.2), 3.0 * mm},
          {"Yielding", yielding(600e6), 3.0 * mm},
          {"Friction", rubbing(40.0 * mm, 0.4), 3.0 * mm},
          {"WrappingRubbing", wrapping(0.2), 3.0 * mm},
          {"Snap", inward(87.5 * mm, 0.0), 40.0 * mm},
          {"SnapRubbing", inward(87.5 * mm, 0.2), 40.0 * mm},
          {"Switch", inward(65.0 * mm, 0.0), 15.0 * mm, true, Instability::switch_branch},
          {"SwitchAtMidspan", inward(87.5 * mm, 0.0), 40.0 * mm, true, Instability::switch_branch},
          {"Tilt", tilted(0.1, 0.0), 2.0 * mm},
          {"TiltRubbing", tilted(0.1, 0.2), 2.0 * mm},
          {"Hanging", hanging(0.0), 0.3 * mm, false},
          {"HangingRubbing", hanging(0.2), 0.3 * mm, false}};
}

std::vector<double> there_and_back(const Remembering& one, int steps) {
  return one.back ? test::there_and_back(one.to, steps) : test::travel_to(one.to, steps);
}

/// The same turning points, with other points between them.
std::vector<double> at_random(const Remembering& one, const std::vector<double>& common) {
  std::mt19937 random(68);
  std::uniform_real_distribution<double> inside(0.0, one.to);
  std::vector<double> up = common;
  const auto top = std::max_element(up.begin(), up.end()) + 1;
  std::vector<double> down(top, up.end());
  up.erase(top, up.end());
  for (int i = 0; i < 9; ++i) up.push_back(inside(random));
  std::sort(up.begin(), up.end());
  const double last = down.empty() ? one.to : down.back();
  for (int i = 0; i < 9 && one.back; ++i) down.push_back(std::max(last, inside(random)));
  std::sort(down.rbegin(), down.rend());
  up.insert(up.end(), down.begin(), down.end());
  return up;
}

/// Each event where the other curve has it.
void expect_same_events(const PushCurve& a, const PushCurve& b) {
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t k = 0; k < a.events.size(); ++k) {
    EXPECT_EQ(a.events[k].kind, b.events[k].kind);
    EXPECT_NEAR(a.events[k].travel, b.events[k].travel, 1e-12);  // round-off
  }
}

class PointsAskedFor : public ::testing::TestWithParam<Remembering> {};

TEST_P(PointsAskedFor, DoNotChangeTheForces) {
  const Remembering& one = GetParam();
  PushProblem test = one.test;
  PushOptions options = mesh(32);
  options.instability = one.instability;
  const std::vector<double> common = there_and_back(one, 4);
  test.travel = common;
  const ExtrapolatedCurve few = solve_push_extrapolated(test, options);
  ASSERT_TRUE(few.curve.report.usable()) << few.curve.report.message;
  double peak = 0.0;
  for (const PushPoint& p : few.curve.points) peak = std::max(peak, std::abs(p.force));
  // Two solutions by Newton's method agree to 1e-8 of the forces in the wire, some 1e-7 of the peak of soft
  // curves. That is far below the error that the curve states.
  const double tolerance = 1e-7 * peak;
  EXPECT_LT(tolerance, *std::max_element(few.discretisation_error.begin(), few.discretisation_error.end()));
  for (const std::vector<double>& travel :
       {there_and_back(one, 8), there_and_back(one, 28), at_random(one, common)}) {
    test.travel = travel;
    const ExtrapolatedCurve many = solve_push_extrapolated(test, options);
    ASSERT_TRUE(many.curve.report.usable()) << many.curve.report.message;
    std::size_t i = 0;
    std::size_t at = 0;
    for (const double wanted : common) {
      const auto next = [&](const PushCurve& curve, std::size_t from) {
        while (from < curve.points.size() && std::abs(curve.points[from].travel - wanted) > 1e-12) ++from;
        return from;
      };
      i = next(few.curve, i);
      at = next(many.curve, at);
      ASSERT_LT(i, few.curve.points.size());
      ASSERT_LT(at, many.curve.points.size());
      EXPECT_NEAR(few.curve.points[i].force, many.curve.points[at].force, tolerance)
          << "of " << travel.size() << " points, at " << wanted / mm << " mm";
      ++i;
      ++at;
    }
    EXPECT_EQ(few.curve.steps, many.curve.steps);
    if (!few.curve.steps.empty()) expect_same_events(few.curve, many.curve);
  }
}

TEST_P(PointsAskedFor, HaveTheSameForcesInGivenSteps) {
  PushProblem test = GetParam().test;
  test.travel = there_and_back(GetParam(), 4);
  PushOptions options = mesh(32);
  options.instability = GetParam().instability;
  const PushCurve own = solve_push(test, options);
  options.steps = own.steps;
  const PushCurve given = solve_push(test, options);
  ASSERT_TRUE(given.report.usable()) << given.report.message;
  ASSERT_EQ(own.points.size(), given.points.size());
  double peak = 0.0;
  for (const PushPoint& p : own.points) peak = std::max(peak, std::abs(p.force));
  for (std::size_t i = 0; i < own.points.size(); ++i) {
    // Newton's method, and events that are located from another beginning: to 1e-9 of the span, 1e-6 of these
    // forces.
    EXPECT_NEAR(own.points[i].force, given.points[i].force, 2e-6 * peak)
        << own.points[i].travel / mm << " mm";
  }
  EXPECT_LE(given.newton_iterations, own.newton_iterations);  // without the estimates
}

INSTANTIATE_TEST_SUITE_P(All, PointsAskedFor, ::testing::ValuesIn(remembering()),
                         [](const auto& one) { return std::string(one.param.name); });

// Compared with the path in steps of a tenth: the error is of first order.
TEST(PathError, IsAtLeastTheDistanceToThePathOfShortSteps) {
  for (const Remembering& one : remembering()) {
    if (!one.back || one.to > 5.0 * mm) continue;
    PushProblem test = one.test;
    test.travel = there_and_back(one, 6);
    const ExtrapolatedCurve curve = solve_push_with_path_error(test, mesh(64));
    PushOptions fine = mesh(64);
    fine.path_tolerance *= 0.01;
    const PushCurve better = solve_push(test, fine);
    ASSERT_TRUE(curve.curve.report.usable() && better.report.usable()) << one.name;
    ASSERT_EQ(curve.curve.points.size(), better.points.size());
    double peak = 0.0;
    double worst = 0.0;
    double stated = 0.0;
    for (std::size_t i = 0; i < better.points.size(); ++i) {
      peak = std::max(peak, std::abs(better.points[i].force));
      worst = std::max(worst, std::abs(better.points[i].force - curve.curve.points[i].force));
      stated = std::max(stated, curve.discretisation_error[i]);
    }
    EXPECT_LT(worst, 1e-3 * peak) << one.name;
    // An estimate from a mesh of a quarter of the edges, of a curve with kinks, at the points asked for:
    // within a factor of four. Events are located to 1e-9 of the span, which is 1e-6 of these forces.
    EXPECT_LT(worst, 4.0 * stated + 2e-6 * peak) << one.name;
  }
}

TEST(PathError, IsNoneWithoutAMemory) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.travel = test::there_and_back(2.0 * mm, 4);
  for (const double error : solve_push_with_path_error(test, mesh(32)).discretisation_error)
    EXPECT_EQ(error, 0.0);
}

// Swung to the height y at the pusher, an arch of the height a (a_p at the pusher) that its weight W pulls
// across has sin(angle) = y / a_p; with the moments about the chord
//   F = W/2 (a / a_p) tan(angle),   y = a/2 (1 - cos 2 pi x/l).
TEST(WeightAcross, PushBeginsWhereTheWireHangs) {
  PushProblem test = hanging(0.0);
  test.travel = {0.0, 0.1 * mm, 0.2 * mm, 0.3 * mm};
  const ExtrapolatedCurve curve = solve_push_extrapolated(test, mesh(64));
  ASSERT_TRUE(curve.curve.report.usable()) << curve.curve.report.message;
  EXPECT_EQ(curve.curve.points[0].force, 0.0);
  const double span = test.mount.span;
  const double weight = test.wire.mass_per_length() * test.wire.length * test.gravity[2];
  // The thrust of the buckled arch shortens it; the rest of the slack is a^2 pi^2 / 4 l.
  const double thrust = 4.0 * std::pow(std::numbers::pi / span, 2) * test.wire.bending_stiffness();
  const double slack = test.wire.length * (1.0 - thrust / test.wire.axial_stiffness()) - span;
  const double height = std::sqrt(4.0 * slack * span) / std::numbers::pi;
  const double share = 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * test.contact_position / span));
  for (std::size_t i = 1; i < test.travel.size(); ++i) {
    const double expected = 0.5 * weight / share * std::tan(std::asin(test.travel[i] / (share * height)));
    // Shallow arch, inextensible while it swings: the weight bends it by some percent.
    EXPECT_NEAR(curve.curve.points[i].force, expected, 0.05 * expected) << i;
  }
}

// A mount that does not hold the loose wire lets it out at first touch: the pusher is pressed from there on,
// and the force that drives the mount is its limit.
TEST(MountThatDoesNotHold, SlipsAtFirstTouch) {
  PushProblem test = not_held();
  test.travel = {0.0, 1.0 * mm};
  const PushCurve curve = solve_push(test, mesh(64));
  ASSERT_TRUE(curve.report.usable()) << curve.report.message;
  EXPECT_GT(curve.points[0].force, 1.0);
  EXPECT_TRUE(std::any_of(curve.events.begin(), curve.events.end(), [](const PushEvent& e) {
    return e.kind == PushEvent::Kind::mount_slips && e.travel == 0.0;
  }));
  EXPECT_GT(curve.points[0].dissipated, 0.0);
}

}  // namespace
}  // namespace snare::coupling
