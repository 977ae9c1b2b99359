#include "validation/blind_push.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "validation/elastica_push.hpp"

namespace snare::validation {
namespace {

BlindWire declared(double position, double radius) {
  BlindWire wire;
  wire.length = 0.180;
  wire.span = 0.175;
  wire.bending_stiffness = 0.04796;
  wire.axial_stiffness = 341060.0;
  wire.diameter = 1.5e-3;
  wire.position = position;
  wire.radius = radius;
  return wire;
}

ElasticaPush reference(const BlindWire& wire, double friction_slope) {
  ElasticaPush push;
  push.wire = {wire.length, wire.bending_stiffness, wire.axial_stiffness, 0.0};
  push.span = wire.span;
  push.position = wire.position;
  push.radius = wire.radius;
  push.friction_slope = friction_slope;
  return push;
}

std::vector<double> up(double top, int count) {
  std::vector<double> travel;
  for (int i = 1; i <= count; ++i) travel.push_back(top * i / count);
  return travel;
}

// The same readings downwards, the last at first touch.
std::vector<double> up_and_down(double top, int count) {
  std::vector<double> travel = up(top, count);
  for (int i = count - 1; i >= 0; --i) travel.push_back(top * i / count);
  return travel;
}

// Trapezoidal work of the pusher from first touch [J].
double work(const std::vector<double>& travel, const std::vector<BlindReading>& readings) {
  double sum = 0.0;
  double force = 0.0;
  double at = 0.0;
  for (std::size_t i = 0; i < travel.size(); ++i) {
    sum += 0.5 * (force + readings[i].force) * (travel[i] - at);
    force = readings[i].force;
    at = travel[i];
  }
  return sum;
}

void expect_same(const std::vector<BlindReading>& a, const std::vector<BlindReading>& b, double relative) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].force, b[i].force, relative * std::abs(b[i].force)) << "reading " << i;
  }
}

// Load and unload in the same states: equal but for Newton's tolerance.
void expect_no_loop(const BlindWire& wire) {
  constexpr int kCount = 15;
  const auto readings = blind_push(wire, up_and_down(3e-3, kCount));
  for (std::size_t i = 0; i + 1 < kCount; ++i) {
    EXPECT_NEAR(readings[i].force, readings[2 * kCount - 2 - i].force, 1e-8 * readings[kCount - 1].force);
  }
}

double loop_work(const BlindWire& wire, const std::vector<double>& time = {}) {
  const auto travel = up_and_down(3e-3, 30);
  return work(travel, blind_push(wire, travel, time));
}

// Multiple shooting, another discretisation of the same equations: its error is below 1e-9, the default
// mesh's below 1e-6.
TEST(BlindWire, AgreesWithMultipleShooting) {
  const auto travel = up(3e-3, 15);
  for (const double position : {0.040, 0.065, 0.090}) {
    for (const double radius : {0.0, 0.00675}) {
      const BlindWire wire = declared(position, radius);
      const auto expected = push_path(reference(wire, 0.0), travel);
      const auto readings = blind_push(wire, travel);
      ASSERT_EQ(expected.size(), readings.size());
      for (std::size_t i = 0; i < travel.size(); ++i) {
        ASSERT_TRUE(expected[i].report.usable() && !expected[i].wrapped);
        EXPECT_NEAR(readings[i].force, expected[i].force, 1e-6 * expected[i].force);
        // The tension passes through zero: against the force of buckling.
        EXPECT_NEAR(readings[i].tension_left, expected[i].tension_left,
                    1e-6 * std::max(60.0, std::abs(expected[i].tension_left)));
        EXPECT_NEAR(readings[i].contact_coordinate, expected[i].contact_begin, 1e-8);
      }
    }
  }
}

// Fourth order: doubling the intervals divides the error by 16, here by more than 12.
TEST(BlindWire, ConvergesWithFourthOrder) {
  BlindWire wire = declared(0.065, 0.00675);
  const double exact = push_path(reference(wire, 0.0), {2e-3}).back().force;
  wire.intervals = 50;
  const double coarse = std::abs(blind_push(wire, {2e-3}).back().force - exact);
  wire.intervals = 100;
  const double fine = std::abs(blind_push(wire, {2e-3}).back().force - exact);
  EXPECT_GT(coarse, 12.0 * fine);
}

// The section touched moves towards the middle of the bulge, so friction drags the wire to larger S: the
// reference's force is inclined to that side.
TEST(BlindWire, SlidesAsTheReferenceWithInclinedForce) {
  BlindWire wire = declared(0.065, 0.00675);
  wire.friction = 0.1;
  const auto travel = up(2e-3, 10);
  const auto readings = blind_push(wire, travel);
  EXPECT_GT(readings.back().contact_coordinate, readings.front().contact_coordinate);
  const auto expected = push_path(reference(wire, 0.1), travel);
  for (std::size_t i = 0; i < travel.size(); ++i) {
    ASSERT_TRUE(expected[i].report.usable());
    EXPECT_NEAR(readings[i].force, expected[i].force, 2e-6 * expected[i].force) << i;
  }
}

// A knife edge that does not let go of the section first touched.
TEST(BlindWire, SticksAsTheReference) {
  BlindWire wire = declared(0.065, 0.0);
  wire.friction = 1e3;
  const auto travel = up(1e-3, 5);
  ElasticaPush push = reference(wire, 0.0);
  push.contact = ElasticaContact::sticking;
  const auto expected = push_path(push, travel);
  const auto readings = blind_push(wire, travel);
  for (std::size_t i = 0; i < travel.size(); ++i) {
    ASSERT_TRUE(expected[i].report.usable());
    EXPECT_NEAR(readings[i].force, expected[i].force, 2e-6 * expected[i].force) << i;
    EXPECT_NEAR(readings[i].contact_coordinate, readings[0].contact_coordinate, 1e-12);
  }
}

// Between rigid clamps a uniform natural curvature shifts M by a constant; in clamps that give it does not
// cancel.
TEST(BlindWire, NaturalCurvatureActsOnlyThroughGivingClamps) {
  const auto travel = up(3e-3, 6);
  BlindWire wire = declared(0.065, 0.00675);
  BlindWire curved = wire;
  curved.natural_curvature = 3.0;
  expect_same(blind_push(curved, travel), blind_push(wire, travel), 1e-8);  // Newton's tolerance
  wire.mount_rotational_compliance = curved.mount_rotational_compliance = 0.5;
  EXPECT_GT(blind_push(curved, travel).back().force, 1.05 * blind_push(wire, travel).back().force);
}

// Symmetric push of a straight wire: the tension is uniform but for the small slope, and gives 2 c T at the
// mounts as L T/EA would in the wire: EA' = EA/(1 + 2 c EA/L). The difference is of the slope's square, 1e-3.
TEST(BlindWire, GivingMountsActAsALongerSoftWire) {
  BlindWire wire = declared(0.0875, 0.0);
  wire.length = wire.span = 0.175;
  BlindWire soft = wire;
  wire.mount_axial_compliance = 1e-6;
  soft.axial_stiffness /= 1.0 + 2.0 * 1e-6 * wire.axial_stiffness / wire.length;
  const auto travel = up(3e-3, 6);
  const auto giving = blind_push(wire, travel);
  expect_same(giving, blind_push(soft, travel), 2e-3);
  EXPECT_LT(giving.back().force, 0.5 * blind_push(declared(0.0875, 0.0), travel).back().force);
}

// The pusher's own spring in series: F(travel) = F_0(travel - c F).
TEST(BlindWire, PusherComplianceShiftsTheTravel) {
  BlindWire wire = declared(0.065, 0.00675);
  wire.pusher_compliance = 1e-5;
  const auto travel = up(3e-3, 10);
  const auto giving = blind_push(wire, travel);
  std::vector<double> shifted;
  for (std::size_t i = 0; i < travel.size(); ++i) shifted.push_back(travel[i] - 1e-5 * giving[i].force);
  wire.pusher_compliance = 0.0;
  expect_same(giving, blind_push(wire, shifted), 1e-8);  // Newton's tolerance
}

TEST(BlindWire, ElasticEffectsLeaveNoLoop) {
  const BlindWire plain = declared(0.065, 0.00675);
  expect_no_loop(plain);
  BlindWire wire = plain;
  wire.damage_from = 0.10;
  wire.damage_to = 0.12;
  wire.damage_factor = 0.6;
  expect_no_loop(wire);
  wire = plain;
  wire.mount_axial_compliance = 1e-6;
  wire.mount_rotational_compliance = 0.3;
  wire.natural_curvature = 2.0;
  expect_no_loop(wire);
  wire = plain;
  wire.misalignment = 0.05;
  wire.weight = {0.0, -0.14};
  wire.pusher_compliance = 1e-5;
  expect_no_loop(wire);
}

TEST(BlindWire, FrictionDissipates) {
  BlindWire wire = declared(0.065, 0.00675);
  wire.friction = 0.02;
  const double little = loop_work(wire);
  EXPECT_GT(little, 0.0);
  wire.friction = 0.2;
  const double much = loop_work(wire);
  // Proportional to the coefficient while it is small; within a tenth at 0.2.
  EXPECT_NEAR(much, 10.0 * little, 0.1 * much);
}

// Off the middle a stuck section would be pulled off the pusher: it slides from first touch on. What is read
// does not depend on how many readings lie in between, so the changes between stick and slip are located.
TEST(BlindWire, FrictionIsIndependentOfTheReadings) {
  for (const double position : {0.045, 0.065, 0.0875}) {
    for (const double radius : {0.0, 0.005}) {
      BlindWire wire = declared(position, radius);
      wire.friction = 0.3;
      std::vector<double> travel = up_and_down(2e-3, 5);
      const auto again = up(2e-3, 5);
      travel.insert(travel.end(), again.begin(), again.end());
      std::vector<double> dense;
      double last = 0.0;
      for (const double next : travel) {
        for (int i = 1; i <= 8; ++i) dense.push_back(i == 8 ? next : last + (next - last) * i / 8);
        last = next;
      }
      const auto few = blind_push(wire, travel);
      const auto many = blind_push(wire, dense);
      for (std::size_t i = 0; i < travel.size(); ++i) {
        EXPECT_NEAR(few[i].force, many[8 * i + 7].force, 1e-6 * few[4].force)
            << "reading " << i << ", position " << position << ", radius " << radius;
      }
      EXPECT_GT(work(travel, few), 0.0);
    }
  }
}

// The mount slips at a driving force of 80 N: the tension is limited, wire comes in, the loop is open.
TEST(BlindWire, SlippingMountLimitsTheTension) {
  BlindWire wire = declared(0.065, 0.00675);
  wire.mount_slip_tension = 80.0;
  const auto travel = up_and_down(3e-3, 30);
  const auto readings = blind_push(wire, travel);
  for (const BlindReading& reading : readings) EXPECT_LT(reading.tension_left, 80.0);
  EXPECT_GT(work(travel, readings), 0.0);
  expect_same({readings[19]}, {blind_push(declared(0.065, 0.00675), {travel[19]}).front()}, 1e-8);
}

TEST(BlindWire, StrandsDissipateAndStiffen) {
  const BlindWire plain = declared(0.065, 0.00675);
  BlindWire wire = plain;
  wire.strand_extra_stiffness = 0.03;
  wire.strand_slip_curvature = 2.0;
  EXPECT_GT(loop_work(wire), 0.0);
  EXPECT_GT(blind_push(wire, {1e-3}).front().force, blind_push(plain, {1e-3}).front().force);
}

// Strands that never slip are a stiffer wire; with a slip at no curvature they do nothing.
TEST(BlindWire, StrandsThatHoldAreStiffness) {
  BlindWire held = declared(0.065, 0.00675);
  held.strand_extra_stiffness = 0.02;
  held.strand_slip_curvature = 1e4;
  BlindWire stiff = declared(0.065, 0.00675);
  stiff.bending_stiffness += 0.02;
  const auto travel = up(2e-3, 5);
  expect_same(blind_push(held, travel), blind_push(stiff, travel),
              1e-7);  // kappa_p = 0: exact but for Newton
}

TEST(BlindWire, YieldDissipatesAndSoftens) {
  const BlindWire plain = declared(0.065, 0.00675);
  BlindWire wire = plain;
  wire.yield_stress = 1.2e9;
  EXPECT_GT(loop_work(wire), 0.0);
  const auto unloading = blind_push(wire, up_and_down(3e-3, 60));
  for (std::size_t i = 60; i < unloading.size(); ++i) EXPECT_LE(unloading[i].force, unloading[i - 1].force);
  EXPECT_LT(blind_push(wire, {2e-3}).front().force, blind_push(plain, {2e-3}).front().force);
  wire.yield_stress = 1e12;
  const auto travel = up(2e-3, 5);
  expect_same(blind_push(wire, travel), blind_push(plain, travel), 1e-7);  // never yields
}

// The reported force of a memory moves by less than 1e-3 of the peak when everything is refined.
TEST(BlindWire, MemoryIsResolved) {
  const auto travel = up_and_down(3e-3, 30);
  for (const bool plastic : {true, false}) {
    BlindWire wire = declared(0.065, 0.00675);
    if (plastic) {
      wire.yield_stress = 1.2e9;
    } else {
      wire.strand_extra_stiffness = 0.03;
      wire.strand_slip_curvature = 2.0;
    }
    const auto readings = blind_push(wire, travel);
    wire.intervals *= 2;
    wire.history_points *= 3;
    wire.history_step *= 0.25;
    const auto fine = blind_push(wire, travel);
    for (std::size_t i = 0; i < travel.size(); ++i) {
      EXPECT_NEAR(readings[i].force, fine[i].force, 1e-3 * fine[29].force) << "reading " << i;
    }
  }
}

// Fast against tau the wire is stiffer; slow, or after a rest, it is the elastic one.
TEST(BlindWire, ViscousWireRelaxesToTheElasticOne) {
  const BlindWire plain = declared(0.065, 0.00675);
  BlindWire wire = plain;
  wire.relaxation_time = 0.1;
  const std::vector<double> travel{1e-3, 2e-3, 2e-3};
  const auto elastic = blind_push(plain, travel);
  const auto readings = blind_push(wire, travel, {1.0, 2.0, 50.0});
  EXPECT_GT(readings[1].force, 1.01 * elastic[1].force);
  // The rest is 480 tau in four implicit steps of 120 tau: 121^-4 of the excess is left.
  EXPECT_NEAR(readings[2].force, elastic[2].force, 2e-6 * elastic[2].force);
  std::vector<double> time;
  for (int i = 1; i <= 60; ++i) time.push_back(0.5 * i);
  EXPECT_GT(loop_work(wire, time), 0.0);
}

TEST(BlindWire, WeightActsAsASmallCorrection) {
  BlindWire wire = declared(0.065, 0.00675);
  const double weightless = blind_push(wire, {1e-3}).front().force;
  wire.weight = {0.0, -0.14};
  const double heavy = blind_push(wire, {1e-3}).front().force;
  wire.weight = {0.0, -0.28};
  const double twice = blind_push(wire, {1e-3}).front().force;
  // Linear in w: the second difference is of w's square.
  EXPECT_NEAR(twice - heavy, heavy - weightless, 0.02 * std::abs(heavy - weightless));
  EXPECT_NE(heavy, weightless);
}

TEST(BlindWire, ReadsNothingWithoutContact) {
  const BlindWire wire = declared(0.065, 0.00675);
  const auto readings = blind_push(wire, {0.0, 1e-3, -1e-4, 0.0, 1e-3});
  EXPECT_NEAR(readings[0].force, 0.0, 1e-9);
  EXPECT_EQ(readings[2].force, 0.0);
  EXPECT_NEAR(readings[3].force, 0.0, 1e-9);
  EXPECT_NEAR(readings[4].force, readings[1].force, 1e-8 * readings[1].force);  // Newton's tolerance
}

TEST(BlindWire, RefusesWhatItCannotSolve) {
  BlindWire wire = declared(0.065, 0.00675);
  wire.relaxation_time = 0.1;
  EXPECT_THROW((void)blind_push(wire, {1e-3}), std::invalid_argument);
  wire = declared(0.2, 0.0);
  EXPECT_THROW((void)blind_push(wire, {1e-3}), std::invalid_argument);
  wire = declared(0.065, 0.06);
  try {
    (void)blind_push(wire, up(6e-3, 30));
    FAIL() << "a wire bent sharper than the pusher was not refused";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("travel of"), std::string::npos);
  }
}

}  // namespace
}  // namespace snare::validation
