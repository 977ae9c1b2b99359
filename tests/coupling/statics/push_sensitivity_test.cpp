#include "coupling/statics/push_solver.hpp"
#include "tests/support/declared_wire.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace snare::coupling {
namespace {

using test::declared_wire;
using test::mm;

struct Number {
  std::string name;
  PushVariation variation;
  double difference;  // amount for the differences of whole curves
};

std::vector<Number> numbers(const PushProblem& test) {
  const double ei = test.wire.bending_stiffness();
  const double ea = test.wire.axial_stiffness();
  std::vector<Number> all{
      {"EI",
       {[ei](PushProblem& t, double a) { t.wire.bending_stiffness_override = ei + a; }, 1e-3 * ei, 0.0},
       1e-3 * ei},
      {"EA",
       {[ea](PushProblem& t, double a) { t.wire.axial_stiffness_override = ea + a; }, 1e-3 * ea, 0.0},
       1e-3 * ea},
      {"length", {[](PushProblem& t, double a) { t.wire.length += a; }, 1e-7, 0.0}, 1e-6},
      {"span", {[](PushProblem& t, double a) { t.mount.span += a; }, 1e-7, 0.0}, 1e-6},
      {"position", {[](PushProblem& t, double a) { t.contact_position += a; }, 1e-7, 0.0}, 1e-5},
      {"radius", {[](PushProblem& t, double a) { t.pusher.radius += a; }, 1e-7, 0.0}, 1e-5},
      {"misalignment", {[](PushProblem& t, double a) { t.pusher.misalignment += a; }, 1e-6, 0.0}, 1e-3},
      {"gravity", {[](PushProblem& t, double a) { t.gravity[1] += a; }, 1e-2, 0.0}, 1.0},
      {"zero of travel",
       {[](PushProblem& t, double a) {
          for (double& d : t.travel) d -= a;
        },
        1e-7, -1.0},
       1e-6}};
  return all;
}

std::vector<PushVariation> variations(const std::vector<Number>& numbers) {
  std::vector<PushVariation> result;
  for (const Number& n : numbers) result.push_back(n.variation);
  return result;
}

// Differences of whole curves have a truncation error h^2 and, with friction, jumps of the solver's own
// tolerance where events fall: `tolerance` of the largest derivative along the curve.
void expect_derivatives(const PushProblem& test, const std::vector<Number>& all, double tolerance) {
  PushOptions options;
  options.elements = 64;
  options.grading = 1.0;  // else the mesh depends on the numbers as well
  options.variations = variations(all);
  const PushCurve curve = solve_push(test, options);
  ASSERT_TRUE(curve.report.usable()) << curve.report.message;
  options.variations.clear();
  for (std::size_t k = 0; k < all.size(); ++k) {
    SCOPED_TRACE(all[k].name);
    std::array<PushCurve, 2> sides;
    for (const int side : {0, 1}) {
      PushProblem changed = test;
      const double amount = side == 0 ? -all[k].difference : all[k].difference;
      all[k].variation.apply(changed, amount);
      // The derivatives are of the path in these steps; others err by another amount.
      options.steps = curve.steps;
      for (std::vector<double>& leg : options.steps) {
        for (double& end : leg) end += all[k].variation.travel * amount;
      }
      sides[static_cast<std::size_t>(side)] = solve_push(changed, options);
    }
    double largest = 0.0;
    double worst = 0.0;
    double worst_travel = 0.0;
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const double difference =
          (sides[1].points.at(i).force - sides[0].points.at(i).force) / (2.0 * all[k].difference);
      largest = std::max(largest, std::abs(difference));
      const double error = std::abs(curve.points[i].force_by.at(k) - difference);
      if (error > worst) {
        worst = error;
        worst_travel = curve.points[i].travel;
      }
    }
    // Curves are solved to 1e-10 of their forces (a few hundred newtons).
    EXPECT_LT(worst, tolerance * largest + 1e-7 / all[k].difference)
        << "at a travel of " << worst_travel / mm << " mm";
  }
}

std::vector<double> forth_and_back(double from, double to, int steps) {
  std::vector<double> travel;
  for (int i = 0; i <= steps; ++i) travel.push_back(from + (to - from) * i / steps);
  for (int i = steps - 1; i >= 0; --i) travel.push_back(from + (to - from) * i / steps);
  return travel;
}

TEST(PushSensitivity, OfAnElasticWireMatchDifferences) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.travel = forth_and_back(0.2 * mm, 2.0 * mm, 9);
  expect_derivatives(test, numbers(test), 1e-5);
}

TEST(PushSensitivity, OfMountsThatGive) {
  PushProblem test = declared_wire(40.0 * mm, 0.0);
  test.mount.translational_stiffness = 1e6;
  test.mount.rotational_stiffness = 50.0;
  test.pusher.compliance = 1e-6;
  test.travel = forth_and_back(0.2 * mm, 2.0 * mm, 6);
  std::vector<Number> all = numbers(test);
  std::erase_if(all, [](const Number& n) { return n.name == "radius"; });  // a knife edge has none
  all.push_back(
      {"mount", {[](PushProblem& t, double a) { *t.mount.translational_stiffness += a; }, 1e3, 0.0}, 1e3});
  all.push_back(
      {"clamp", {[](PushProblem& t, double a) { *t.mount.rotational_stiffness += a; }, 0.05, 0.0}, 0.05});
  all.push_back({"machine", {[](PushProblem& t, double a) { t.pusher.compliance += a; }, 1e-8, 0.0}, 1e-8});
  expect_derivatives(test, all, 1e-5);
}

TEST(PushSensitivity, GoAlongWithFriction) {
  PushProblem test = declared_wire(40.0 * mm, 6.0 * mm);
  test.pusher.friction = 0.2;
  test.travel = forth_and_back(0.2 * mm, 2.0 * mm, 9);
  std::vector<Number> all = numbers(test);
  all.push_back({"friction", {[](PushProblem& t, double a) { t.pusher.friction += a; }, 1e-4, 0.0}, 1e-3});
  expect_derivatives(test, all, 1e-3);
}

TEST(PushSensitivity, GoAlongWithASlippingMount) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.mount.slip_tension = 31.0;  // below the compression of the loose wire: it slips at first touch
  test.travel = forth_and_back(0.2 * mm, 2.0 * mm, 9);
  std::vector<Number> all = numbers(test);
  // Smaller than elsewhere: the mount slips 0.003 mm before the reading at 1 mm, 0.05 mm earlier for a newton
  // less.
  all.push_back({"slip", {[](PushProblem& t, double a) { *t.mount.slip_tension += a; }, 1e-2, 0.0}, 0.01});
  expect_derivatives(test, all, 1e-3);
}

TEST(PushSensitivity, GoAlongWithAnyMountThatSlips) {
  for (const wire::MountSlip kind : {wire::MountSlip::feeds, wire::MountSlip::slides}) {
    for (const wire::SlipPlace place :
         {wire::SlipPlace::left, wire::SlipPlace::right, wire::SlipPlace::both}) {
      SCOPED_TRACE(fmt::format("kind {} place {}", static_cast<int>(kind), static_cast<int>(place)));
      PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
      test.mount.slip_tension = 36.0;  // below the compression of the loose wire
      test.mount.slip = kind;
      test.mount.slip_at = place;
      test.travel = forth_and_back(0.2 * mm, 2.0 * mm, 9);
      std::vector<Number> all = numbers(test);
      all.push_back({"slip", {[](PushProblem& t, double a) { *t.mount.slip_tension += a; }, 1e-2, 0.0}, 0.1});
      expect_derivatives(test, all, 1e-3);
    }
  }
}

TEST(PushSensitivity, GoAlongWithStrandsThatSlideOneAfterTheOther) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.wire.length = 175.5 * mm;
  test.wire.strand_friction = wire::StrandFriction{0.02, 0.8, 1.5};
  test.travel = forth_and_back(0.2 * mm, 2.0 * mm, 9);
  std::vector<Number> all = numbers(test);
  all.push_back({"extra",
                 {[](PushProblem& t, double a) { t.wire.strand_friction->extra_stiffness += a; }, 1e-6, 0.0},
                 1e-5});
  all.push_back({"slip",
                 {[](PushProblem& t, double a) { t.wire.strand_friction->slip_curvature += a; }, 1e-5, 0.0},
                 1e-4});
  all.push_back(
      {"breadth", {[](PushProblem& t, double a) { t.wire.strand_friction->breadth += a; }, 1e-5, 0.0}, 1e-4});
  // Vertex by vertex the sliders switch between two curves of the differences.
  for (Number& n : all) n.difference *= 0.1;
  expect_derivatives(test, all, 1e-3);
}

TEST(PushSensitivity, GoAlongWithSlidersOfTheSections) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.wire.length = 175.5 * mm;
  test.wire.strand_friction = wire::StrandFriction{0.02, 1.5};
  test.wire.yielding = wire::Yielding{300e6, 0.02};
  test.travel = forth_and_back(0.2 * mm, 2.0 * mm, 9);
  std::vector<Number> all = numbers(test);
  all.push_back(
      {"yield", {[](PushProblem& t, double a) { t.wire.yielding->yield_stress += a; }, 1e3, 0.0}, 1e4});
  all.push_back({"extra",
                 {[](PushProblem& t, double a) { t.wire.strand_friction->extra_stiffness += a; }, 1e-6, 0.0},
                 1e-5});
  all.push_back({"slip",
                 {[](PushProblem& t, double a) { t.wire.strand_friction->slip_curvature += a; }, 1e-5, 0.0},
                 1e-4});
  // Vertex by vertex the sliders switch between two curves of the differences.
  for (Number& n : all) n.difference *= 0.1;
  expect_derivatives(test, all, 1e-3);
}

TEST(PushSensitivity, OfRigidMountsByTheirCompliance) {
  PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.travel = forth_and_back(0.2 * mm, 2.0 * mm, 4);
  PushOptions options;
  options.elements = 64;
  options.grading = 1.0;
  options.variations = {{nullptr, 1e-12, 0.0, {1.0, 1.0}}};
  const PushCurve rigid = solve_push(test, options);
  options.variations.clear();
  test.mount.translational_stiffness = 1e9;
  const PushCurve giving = solve_push(test, options);
  ASSERT_TRUE(giving.report.usable());
  for (std::size_t i = 0; i < rigid.points.size(); ++i) {
    const double change = (giving.points[i].force - rigid.points[i].force) / 1e-9;
    // Second order in a compliance that lets go of 1e-3 of the wire's own stretch.
    EXPECT_NEAR(rigid.points[i].force_by[0], change, 1e-2 * std::abs(change) + 1e4);
  }
}

TEST(PushSensitivity, OfAWireThatWrapsThePusher) {
  PushProblem test = test::soft_wire(65.0 * mm, 6.0 * mm);
  test.travel = forth_and_back(0.5 * mm, 2.0 * mm, 6);
  std::vector<Number> all = numbers(test);
  all.resize(5);
  // The arc begins and ends at vertices: kinks of the size of an edge's share in the differences.
  expect_derivatives(test, all, 5e-2);
}

TEST(PushSensitivity, OfAWireOnSupports) {
  PushProblem test = declared_wire(20.0 * mm, 2.0 * mm);
  test.mount.kind = wire::MountKind::supports;
  test.mount.span = 40.0 * mm;
  test.mount.support_radius = 2.0 * mm;
  test.wire.length = 60.0 * mm;
  test.pusher.direction = PushDirection::inward;
  test.travel = forth_and_back(0.2 * mm, 2.0 * mm, 6);
  std::vector<Number> all = numbers(test);
  std::erase_if(all, [](const Number& n) { return n.name == "gravity"; });
  expect_derivatives(test, all, 1e-5);
}

// First order in a relaxation time the viscous force is the rate times this form; for a straight stretched
// wire whose bending is negligible it is EA times the square of d strain / d travel, in closed form.
TEST(PushSensitivity, RateFormOfAStretchedString) {
  PushProblem test = declared_wire(87.5 * mm, 0.0);
  test.wire.length = test.mount.span;
  test.wire.bending_stiffness_override = 1e-7;
  test.travel = {1.0 * mm, 2.0 * mm};
  PushOptions options;
  options.elements = 256;
  options.examine_rates = true;
  const PushCurve curve = solve_push(test, options);
  ASSERT_TRUE(curve.report.usable());
  for (const PushPoint& p : curve.points) {
    const double half = 0.5 * test.mount.span;
    const double rate =
        p.travel / std::sqrt(half * half + p.travel * p.travel) / half;  // d strain / d travel
    // The wire's two boundary layers of sqrt(EI/T) = 30 um carry what is left.
    EXPECT_NEAR(p.viscous_stiffness, test.wire.axial_stiffness() * rate * rate * test.mount.span,
                2e-3 * p.viscous_stiffness);
  }
}

}  // namespace
}  // namespace snare::coupling
