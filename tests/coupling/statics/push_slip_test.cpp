// Mounts that slip: at either end and at both, the wire feeding through or the mount sliding with it; and
// strands that slide one share after the other. The oracle is the continuous wire by collocation, which
// shares no code with the rod.

#include "coupling/statics/push_solver.hpp"
#include "tests/support/declared_wire.hpp"
#include "validation/blind_push.hpp"
#include "wire/section_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace snare::coupling {
namespace {

using test::mesh;
using test::mm;
using wire::MountSlip;
using wire::SlipPlace;

constexpr double limit = 80.0;

PushProblem slipping(MountSlip kind, SlipPlace place) {
  PushProblem test = test::declared_wire(60.0 * mm, 6.0 * mm);
  test.mount.slip_tension = limit;
  test.mount.slip = kind;
  test.mount.slip_at = place;
  test.travel = test::there_and_back(5.0 * mm, 30);
  return test;
}

double loop_area(const PushCurve& curve) {
  double work = 0.0;
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    const PushPoint& a = curve.points[i - 1];
    const PushPoint& b = curve.points[i];
    work += 0.5 * (a.force + b.force) * (b.travel - a.travel);
  }
  return work;
}

validation::BlindWire continuous(const PushProblem& test) {
  validation::BlindWire w;
  w.length = test.wire.length;
  w.span = test.mount.span;
  w.bending_stiffness = test.wire.bending_stiffness();
  w.axial_stiffness = test.wire.axial_stiffness();
  w.diameter = test.wire.diameter;
  w.position = test.contact_position;
  w.radius = test.pusher.radius + 0.5 * test.wire.diameter;
  if (test.mount.slip_tension) w.mount_slip_tension = *test.mount.slip_tension;
  w.mount_slides = test.mount.slip == MountSlip::slides;
  w.mount_slips_right = test.mount.slip_at == SlipPlace::right;
  return w;
}

struct Slip {
  const char* name;
  MountSlip kind;
  SlipPlace place;
};

class SlipOfAMount : public ::testing::TestWithParam<Slip> {};

TEST_P(SlipOfAMount, CapsTheForceAndBalancesTheEnergy) {
  PushProblem test = slipping(GetParam().kind, GetParam().place);
  test.travel = test::there_and_back(5.0 * mm, 120);
  const PushCurve curve = solve_push(test, mesh(128));
  ASSERT_TRUE(curve.report.usable()) << curve.report.message;
  double highest = 0.0;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const PushPoint& p = curve.points[i];
    highest = std::max(highest, p.tension_left);
    if (i > 0) {
      EXPECT_GE(p.dissipated, curve.points[i - 1].dissipated);
    }
    if (p.in_contact) {
      EXPECT_LT(p.imbalance, 1e-6) << "at a travel of " << p.travel / mm << " mm";
    }
  }
  // Without friction at the pusher one mount that slips holds the tension of the whole wire, but for the
  // bending at the clamp and the pusher's lean.
  EXPECT_LT(highest, 1.2 * limit);
  const double dissipated = curve.points.back().dissipated;
  EXPECT_GT(dissipated, 1e-3);
  const double stored = curve.points.back().energy - curve.points.front().energy;
  EXPECT_NEAR(loop_area(curve), stored + dissipated, 0.01 * dissipated);  // trapezoids
}

INSTANTIATE_TEST_SUITE_P(All, SlipOfAMount,
                         ::testing::Values(Slip{"FeedsLeft", MountSlip::feeds, SlipPlace::left},
                                           Slip{"FeedsRight", MountSlip::feeds, SlipPlace::right},
                                           Slip{"FeedsBoth", MountSlip::feeds, SlipPlace::both},
                                           Slip{"SlidesLeft", MountSlip::slides, SlipPlace::left},
                                           Slip{"SlidesRight", MountSlip::slides, SlipPlace::right},
                                           Slip{"SlidesBoth", MountSlip::slides, SlipPlace::both}),
                         [](const auto& one) { return std::string(one.param.name); });

// The rod beside the continuous wire: loading, slip, and back.
TEST(SlipOfAMount, IsThatOfTheContinuousWire) {
  for (const MountSlip kind : {MountSlip::feeds, MountSlip::slides}) {
    for (const SlipPlace place : {SlipPlace::left, SlipPlace::right}) {
      const PushProblem test = slipping(kind, place);
      PushOptions options = mesh(256);
      const ExtrapolatedCurve curve = solve_push_extrapolated(test, options);
      ASSERT_TRUE(curve.curve.report.usable()) << curve.curve.report.message;
      const auto expected = validation::blind_push(continuous(test), test.travel);
      ASSERT_EQ(curve.curve.points.size(), expected.size());
      double peak = 0.0;
      for (const auto& r : expected) peak = std::max(peak, r.force);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        // Steps of 0.1 mm: slip begins within one of them; else the extrapolated mesh, 1e-4 of the peak.
        EXPECT_NEAR(curve.curve.points[i].force, expected[i].force, 1e-3 * peak)
            << "kind " << static_cast<int>(kind) << " place " << static_cast<int>(place) << " reading " << i;
      }
    }
  }
}

// The driving force of feeding, tension and M^2/2EI, is the same all along a wire that slides freely over the
// pusher: the forces do not tell through which mount the wire comes in.
TEST(SlipOfAMount, OfAFreeWireIsTheSameThroughEitherMount) {
  const PushCurve left = solve_push(slipping(MountSlip::feeds, SlipPlace::left), mesh(128));
  for (const SlipPlace place : {SlipPlace::right, SlipPlace::both}) {
    const PushCurve other = solve_push(slipping(MountSlip::feeds, place), mesh(128));
    ASSERT_TRUE(left.report.usable() && other.report.usable()) << other.report.message;
    for (std::size_t i = 0; i < left.points.size(); ++i) {
      // The mesh carries the force along the wire to second order.
      EXPECT_NEAR(left.points[i].force, other.points[i].force, 2e-3 * left.points[29].force) << i;
    }
  }
}

// Of log-uniform thresholds between a and b: M = EI k + EI_x k up to a, (k/2B) [k - a + k ln(b/k)] between,
// (b - a)/2B beyond, with 2B = ln(b/a).
TEST(Strands, SpreadThresholdsAreTheirDistribution) {
  const wire::StrandFriction strands{0.03, 1.2, 2.0};
  const std::vector<wire::SliderElement> sliders = wire::strand_sliders(strands);
  const double a = 1.2 * std::exp(-2.0);
  const double b = 1.2 * std::exp(2.0);
  for (int i = 0; i < 27; ++i) {
    const double k = 0.02 * std::pow(1.3, i);
    const double at = std::min(k, b);
    const double held = k <= a ? k : (at - a + (k < b ? k * std::log(b / k) : 0.0)) / 4.0;
    const double moment = wire::respond(0.04, sliders, k, nullptr).resultant;
    EXPECT_NEAR(moment, 0.04 * k + 0.03 * held, 0.004 * moment) << k;  // ten sliders
  }
}

TEST(Strands, SpreadThresholdsAreThoseOfTheContinuousWire) {
  PushProblem test = test::declared_wire(65.0 * mm, 6.0 * mm);
  test.wire.strand_friction = wire::StrandFriction{0.02, 0.8, 1.5};
  test.travel = test::there_and_back(2.0 * mm, 20);
  const ExtrapolatedCurve curve = solve_push_extrapolated(test, mesh(256));
  ASSERT_TRUE(curve.curve.report.usable()) << curve.curve.report.message;
  validation::BlindWire w = continuous(test);
  w.strand_extra_stiffness = 0.02;
  w.strand_slip_curvature = 0.8;
  w.strand_slip_breadth = 1.5;
  const auto expected = validation::blind_push(w, test.travel);
  double loop = 0.0;
  double last = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    // Forty layers beside ten sliders: 4e-3 of the moment.
    EXPECT_NEAR(curve.curve.points[i].force, expected[i].force, 4e-3 * expected[19].force) << i;
    loop += curve.curve.points[i].force * (test.travel[i] - last);
    last = test.travel[i];
  }
  EXPECT_GT(loop, 0.0);
}

}  // namespace
}  // namespace snare::coupling
