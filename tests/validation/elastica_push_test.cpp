#include "validation/elastica_push.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "validation/closed_forms.hpp"
#include "validation/elastica.hpp"
#include "validation/shallow_elastica.hpp"

namespace snare::validation {
namespace {

using std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// relative, of the force: what elastica_push.hpp claims, set by rounding
constexpr double kForceError = 1e-9;
constexpr double kLengthRounding = 1e-14;  // [m]: some hundred roundings of lengths of 0.1 m

// Solid SUS-304, d 1.5 mm, E 193 GPa, 180 mm between clamps 175 mm apart.
ElasticaPush declared(double position) {
  const double d = 1.5e-3;
  const double modulus = 193e9;
  ElasticaPush problem;
  problem.wire = {0.180, modulus * pi * std::pow(d, 4) / 64.0, modulus * pi * d * d / 4.0, 0.0};
  problem.span = 0.175;
  problem.position = position;
  return problem;
}

// A rope of the same outline: EI a hundredth, EA a third.
ElasticaPush strand(double position) {
  ElasticaPush problem = declared(position);
  problem.wire.bending_stiffness *= 0.01;
  problem.wire.axial_stiffness /= 3.0;
  return problem;
}

// Inextensible, span 1, EI 1, end shortening `slack` of the span.
ElasticaPush shallow(double slack, double position) {
  ElasticaPush problem;
  problem.wire = {1.0 + slack, 1.0, kInfinity, 0.0};
  problem.span = 1.0;
  problem.position = position;
  return problem;
}

// Strain energy 1/2 int M^2/EI + N^2/EA dS of a clamped wire without natural curvature. On either side
//   H = M^2/(2 EI) + N + N^2/(2 EA) is uniform and int N (1 + N/EA) dS = n . (r_end - r_begin), hence
//   U = H (S_end - S_begin) - n . (r_end - r_begin) + int N^2/EA dS,
// exact but for the last, small and smooth, integral (Simpson). The arc is uniform.
double strain_energy(const ElasticaPush& problem, const ElasticaState& state) {
  const ElasticaWire& wire = problem.wire;
  const auto pieces = static_cast<std::size_t>(problem.pieces_per_side);
  double energy = 0.0;
  for (const std::size_t first : {std::size_t{0}, pieces + 1}) {
    const ElasticaPoint& a = state.shape[first];
    const ElasticaPoint& b = state.shape[first + pieces];
    const double nx = first == 0 ? state.tension_left : state.tension_right;
    const double ny = first == 0 ? -state.reaction_left_y : state.reaction_right_y;
    const double uniform = 0.5 * a.moment * a.moment / wire.bending_stiffness + a.tension +
                           0.5 * a.tension * a.tension / wire.axial_stiffness;
    const double length = b.arc_length - a.arc_length;
    double squares = 0.0;
    for (std::size_t i = 0; i <= pieces; ++i) {
      const double weight = i == 0 || i == pieces ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
      squares += weight / 3.0 * std::pow(state.shape[first + i].tension, 2);
    }
    squares *= length / problem.pieces_per_side;
    energy += uniform * length - nx * (b.x - a.x) - ny * (b.y - a.y) + squares / wire.axial_stiffness;
  }
  const ElasticaPoint& at = state.shape[pieces];
  return energy + (state.contact_end - state.contact_begin) * 0.5 *
                      (at.moment * at.moment / wire.bending_stiffness +
                       at.tension * at.tension / wire.axial_stiffness);
}

// Gauss-Legendre, three points a panel.
double work(const ElasticaPush& problem, double from, double to, int panels) {
  std::vector<double> travels;
  const double offset = std::sqrt(0.6);
  const double h = (to - from) / panels;
  for (int i = 0; i < panels; ++i) {
    for (const double node : {-offset, 0.0, offset}) travels.push_back(from + h * (i + 0.5 + 0.5 * node));
  }
  const auto states = push_path(problem, travels);
  double sum = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_TRUE(states[i].report.usable());
    sum += (i % 3 == 1 ? 8.0 : 5.0) / 18.0 * h * states[i].force;
  }
  return sum;
}

TEST(ElasticaPush, DeclaredWireAtItsMiddle) {
  const ElasticaPush problem = declared(0.0875);
  const auto states = push_path(problem, {0.0, 1.5e-3});
  ASSERT_EQ(states.size(), 2U);
  EXPECT_NEAR(states[0].contact_y, 18.8738e-3, 5e-8);  // digits as given, computed apart from this code
  EXPECT_NEAR(states[0].force, 0.0, 1e-9);             // [N]: rounding of tensions of 60 N at first touch
  ASSERT_TRUE(states[1].report.usable());
  EXPECT_NEAR(states[1].force, 232.983, 5e-4);  // last digit given
  // The material mid-point stays where it is: the same as a force at the given material point.
  ElasticaPush material = problem;
  material.contact = ElasticaContact::material_point;
  material.material_coordinate = 0.090;
  EXPECT_NEAR(push(material, 1.5e-3).force / states[1].force, 1.0, kForceError);
}

TEST(ElasticaPush, ForceDoesNotDependOnThePieces) {
  for (const double position : {0.0875, 0.040}) {
    ElasticaPush problem = declared(position);
    problem.pieces_per_side = 8;
    const double coarse = push(problem, 1.5e-3).force;
    problem.pieces_per_side = 24;
    // Rounding amplified by EA L^2/EI = 2e5.
    EXPECT_NEAR(push(problem, 1.5e-3).force / coarse, 1.0, kForceError);
  }
}

TEST(ElasticaPush, InextensibleDeclaredWire) {
  ElasticaPush problem = declared(0.0875);
  problem.wire.axial_stiffness *= 1e6;
  EXPECT_NEAR(push(problem, 1.5e-3).force, 772.0, 0.5);  // given to three digits
  problem.wire.axial_stiffness = kInfinity;
  const auto states = push_path(problem, {0.0, 1.5e-3});
  EXPECT_NEAR(states[1].force, 772.0, 0.5);
  // Unloaded: elliptic integrals. Rounding over the slack, 1e-16/0.03, with some margin.
  const BuckledElastica exact = clamped_elastica(problem.wire.bending_stiffness, 0.180, 0.175);
  EXPECT_NEAR(-states[0].tension_left / exact.compression, 1.0, 1e-12);
  EXPECT_NEAR(states[0].contact_y / exact.height, 1.0, 1e-12);
}

TEST(ElasticaPush, UnloadedWireOfAnySlackMatchesEllipticIntegrals) {
  for (const double span : {0.999, 0.9, 0.6, 0.2}) {
    for (const ElasticaEnds ends : {ElasticaEnds::clamped, ElasticaEnds::pinned}) {
      ElasticaPush problem = shallow(0.0, 0.5 * span);
      problem.span = span;
      problem.ends = ends;
      const ElasticaState state = push(problem, 0.0);
      ASSERT_TRUE(state.report.usable()) << span << state.report.message;
      const BuckledElastica exact =
          ends == ElasticaEnds::clamped ? clamped_elastica(1.0, 1.0, span) : pinned_elastica(1.0, 1.0, span);
      const double pull = state.shape.front().tension / std::cos(state.shape.front().angle);
      // Rounding 1e-16 over the least slack of 1e-3, with margin.
      EXPECT_NEAR(-pull / exact.compression, 1.0, 1e-11) << span;
      EXPECT_NEAR(state.contact_y / exact.height, 1.0, 1e-11) << span;
    }
  }
}

TEST(ElasticaPush, ShallowLimitOutward) {
  // Error of first order in the slack. At 1e-4 it is 0.31 % at P = 20, s = 0.5 (near the unloaded height,
  // where the force changes fastest) and less elsewhere; extrapolated to no slack what is left is of second
  // order, 1e-6.
  for (const double position : {0.5, 0.4}) {
    for (const double compression : {20.0, 0.0, -100.0}) {
      const ShallowState wanted = shallow_state(compression, position);
      double force[2] = {};
      for (const int i : {0, 1}) {
        const double slack = i == 0 ? 1e-4 : 0.5e-4;
        const ElasticaPush problem = shallow(slack, position);
        const double unloaded = push(problem, 0.0).pusher_height;
        const ElasticaState state = push(problem, wanted.deflection * std::sqrt(slack) - unloaded);
        ASSERT_TRUE(state.report.usable());
        force[i] = state.force / std::sqrt(slack);
      }
      EXPECT_NEAR(force[0] / wanted.force, 1.0, 3.2e-3) << position << " " << compression;
      EXPECT_NEAR((2.0 * force[1] - force[0]) / wanted.force, 1.0, 2e-6) << position << " " << compression;
    }
  }
}

TEST(ElasticaPush, ShallowLimitInward) {
  for (const double position : {0.45, 0.4}) {
    const double slack = 1e-6;
    ElasticaPush problem = shallow(slack, position);
    problem.side = ElasticaSide::against_bulge;
    double largest = 0.0;
    for (const ElasticaState& state : push_through_folds(problem, 5e-6, 300)) {
      ASSERT_TRUE(state.report.usable());
      largest = std::max(largest, state.force / std::sqrt(slack));
    }
    // Samples of the path around its maximum: error of second order in the spacing.
    EXPECT_NEAR(largest / -shallow_largest_inward(position).force, 1.0, 2e-4) << position;
  }
}

TEST(ElasticaPush, InwardBifurcationAtMidSpan) {
  const double slack = 1e-6;
  ElasticaPush problem = shallow(slack, 0.5);
  problem.side = ElasticaSide::against_bulge;
  const ElasticaState free = push(problem, 0.0);
  double low = 0.0;
  double high = 0.03 * std::sqrt(slack);
  ASSERT_NE(push(problem, high).determinant_positive, free.determinant_positive);
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (push(problem, middle).determinant_positive == free.determinant_positive ? low : high) = middle;
  }
  const ElasticaState state = push(problem, low);
  const ShallowState wanted = shallow_largest_inward(0.5);
  // Bisection leaves 3e-8 of the height; the slack's own effect is of order 1e-5 (force falls fast here).
  EXPECT_NEAR(state.contact_y / std::sqrt(slack), wanted.deflection, 2e-5);
  EXPECT_NEAR(-state.tension_left, wanted.compression, 2e-2);
  EXPECT_NEAR(state.force / std::sqrt(slack), -wanted.force, 5e-2);
}

TEST(ElasticaPush, ForcesBalance) {
  for (const double radius : {0.0, 5e-3}) {
    for (const double position : {0.040, 0.065, 0.090}) {
      ElasticaPush problem = declared(position);
      problem.radius = radius;
      const ElasticaState state = push(problem, 1e-3);
      ASSERT_TRUE(state.report.usable());
      EXPECT_NEAR(state.force + state.reaction_left_y + state.reaction_right_y, 0.0,
                  kForceError * state.force);
      // Clamped ends lie along the chord: the tensions are the pulls.
      EXPECT_NEAR(state.tension_right - state.tension_left + state.force_along_chord, 0.0,
                  kForceError * state.force);
      // Moments about the left mount, end moments included.
      const double moment = state.contact_x * state.force - state.contact_y * state.force_along_chord +
                            problem.span * state.reaction_right_y - state.shape.front().moment +
                            state.shape.back().moment;
      EXPECT_NEAR(moment, 0.0, kForceError * state.force * problem.span);
    }
  }
}

TEST(ElasticaPush, FrictionlessForceIsNormalAndOnTheCylinder) {
  ElasticaPush problem = declared(0.065);
  problem.radius = 5e-3;
  for (const ElasticaSide side : {ElasticaSide::with_bulge, ElasticaSide::against_bulge}) {
    problem.side = side;
    const double sigma = side == ElasticaSide::with_bulge ? 1.0 : -1.0;
    const ElasticaState state = push(problem, 2e-3);
    ASSERT_TRUE(state.report.usable());
    const ElasticaPoint& at = state.shape[static_cast<std::size_t>(problem.pieces_per_side)];
    const double along =
        state.force_along_chord * std::cos(at.angle) + sigma * state.force * std::sin(at.angle);
    EXPECT_NEAR(along, 0.0, kForceError * state.force);
    EXPECT_NEAR(std::hypot(at.x - problem.position, at.y - state.pusher_height), problem.radius,
                kLengthRounding);
    EXPECT_GT(state.force, 0.0);
    EXPECT_NEAR(state.travel, 2e-3, 1e-15);
  }
}

TEST(ElasticaPush, FirstTouchOfACylinderIsTheNearestPoint) {
  ElasticaPush problem = declared(0.065);
  problem.radius = 8e-3;
  const ElasticaState state = push(problem, 0.0);
  ElasticaPush fine = declared(0.0875);
  fine.pieces_per_side = 50;
  double nearest = 1.0;
  for (const ElasticaPoint& p : push(fine, 0.0).shape) {
    nearest = std::min(nearest, std::hypot(p.x - problem.position, p.y - state.pusher_height));
  }
  // The unloaded wire sampled every 1.8 mm: the nearest sample is at most 0.9^2/(2 x 8) mm too far, never
  // nearer.
  EXPECT_GT(nearest, problem.radius - 1e-12);
  EXPECT_LT(nearest, problem.radius + 5.1e-5);
}

TEST(ElasticaPush, WorkIsStrainEnergy) {
  // Frictionless, so what the pusher does is stored. Covers the point contact off the middle.
  ElasticaPush problem = declared(0.065);
  problem.radius = 3e-3;
  problem.pieces_per_side = 64;  // Simpson's rule in strain_energy: 1e-7 with 32, a sixteenth with 64
  const auto ends = push_path(problem, {0.0, 3e-3});
  const double stored = strain_energy(problem, ends[1]) - strain_energy(problem, ends[0]);
  // The force is smooth along the path: what remains is the rules' own error.
  EXPECT_NEAR(work(problem, 0.0, 3e-3, 10) / stored, 1.0, 1e-8);
}

TEST(ElasticaPush, WrappedContact) {
  ElasticaPush problem = strand(0.065);
  problem.radius = 20e-3;
  const auto states = push_path(problem, {0.0, 2e-3, 5e-3});
  ASSERT_EQ(states.size(), 3U);
  const ElasticaState& state = states[2];
  ASSERT_TRUE(state.report.usable()) << state.report.message;
  EXPECT_FALSE(states[1].wrapped);
  ASSERT_TRUE(state.wrapped);
  const auto m = static_cast<std::size_t>(problem.pieces_per_side);
  const ElasticaPoint& first = state.shape[m];
  const ElasticaPoint& last = state.shape[m + 1];
  const double strain = first.tension / problem.wire.axial_stiffness;
  EXPECT_NEAR(first.tension, last.tension, kForceError * first.tension);
  EXPECT_NEAR(first.moment, -problem.wire.bending_stiffness * (1.0 + strain) / problem.radius, 1e-12);
  EXPECT_NEAR((1.0 + strain) * (state.contact_end - state.contact_begin),
              problem.radius * (first.angle - last.angle), kLengthRounding);
  for (const ElasticaPoint* p : {&first, &last}) {
    EXPECT_NEAR(std::hypot(p->x - problem.position, p->y - state.pusher_height), problem.radius,
                kLengthRounding);
  }
  EXPECT_NEAR(state.force + state.reaction_left_y + state.reaction_right_y, 0.0, kForceError * state.force);
  // Arc: pressure N/R on the cylinder and a point force at either lift-off point, all pushing the wire away:
  // together they are the force, so what the arc's pressure leaves must be positive along y.
  const double pressure = first.tension * (std::sin(first.angle) - std::sin(last.angle));
  EXPECT_GT(state.force, pressure);
}

TEST(ElasticaPush, WorkIsStrainEnergyThroughWrapping) {
  ElasticaPush problem = strand(0.065);
  problem.radius = 20e-3;
  problem.pieces_per_side = 32;
  const auto ends = push_path(problem, {3e-3, 4.5e-3});
  ASSERT_FALSE(ends[0].wrapped);
  ASSERT_TRUE(ends[1].wrapped);
  const double stored = strain_energy(problem, ends[1]) - strain_energy(problem, ends[0]);
  // Where wrapping begins the force's derivative jumps: second order of a panel of 75 um, some 1e-6.
  EXPECT_NEAR(work(problem, 3e-3, 4.5e-3, 20) / stored, 1.0, 1e-5);
}

TEST(ElasticaPush, MirroredPositionsAgree) {
  ElasticaPush left = declared(0.065);
  left.friction_slope = 0.2;
  left.radius = 2e-3;
  ElasticaPush right = left;
  right.position = left.span - left.position;
  right.friction_slope = -0.2;
  const ElasticaState a = push(left, 2e-3);
  const ElasticaState b = push(right, 2e-3);
  ASSERT_TRUE(a.report.usable() && b.report.usable());
  EXPECT_NEAR(a.force / b.force, 1.0, kForceError);
  EXPECT_NEAR(a.tension_left / b.tension_right, 1.0, kForceError);
}

TEST(ElasticaPush, FrictionInclinesTheForce) {
  ElasticaPush problem = declared(0.065);
  for (const double slope : {0.3, -0.3}) {
    problem.friction_slope = slope;
    const ElasticaState state = push(problem, 2e-3);
    ASSERT_TRUE(state.report.usable());
    const auto m = static_cast<std::size_t>(problem.pieces_per_side);
    const double angle = state.shape[m].angle;
    const double tangential = state.force_along_chord * std::cos(angle) + state.force * std::sin(angle);
    const double normal = state.force * std::cos(angle) - state.force_along_chord * std::sin(angle);
    EXPECT_NEAR(tangential / normal, slope, kForceError);
    // Tension drops over the contact by what the pusher drags along.
    EXPECT_NEAR(state.shape[m].tension - state.shape[m + 1].tension, tangential, kForceError * normal);
  }
}

TEST(ElasticaPush, StickingKeepsTheMaterialPoint) {
  ElasticaPush problem = declared(0.065);
  problem.contact = ElasticaContact::sticking;
  const auto states = push_path(problem, {0.0, 2e-3});
  ASSERT_TRUE(states[1].report.usable());
  EXPECT_NEAR(states[1].contact_begin, states[0].contact_begin, 1e-15);
  EXPECT_NEAR(states[1].contact_x, 0.065, 1e-15);
  // Held back, the wire is stiffer than when it may slide: a constraint more.
  EXPECT_GT(states[1].force, push(declared(0.065), 2e-3).force);
}

TEST(ElasticaPush, NaturalCurvatureOnlyMattersBetweenPins) {
  ElasticaPush problem = declared(0.065);
  const double straight = push(problem, 1e-3).force;
  problem.wire.natural_curvature = -2.0;
  EXPECT_NEAR(push(problem, 1e-3).force / straight, 1.0, kForceError);
  problem.ends = ElasticaEnds::pinned;
  const double curved_pinned = push(problem, 1e-3).force;
  problem.wire.natural_curvature = 0.0;
  // Between pins 2/m are a moment of EI 2/m = 0.1 N m at the ends, beside about P height = 1 N m at the
  // crown: percents.
  EXPECT_GT(std::abs(curved_pinned / push(problem, 1e-3).force - 1.0), 1e-2);
}

TEST(ElasticaPush, TautWireHasTheBeamStringsStiffness) {
  for (const double position : {0.040, 0.065, 0.090}) {
    ElasticaPush problem = declared(position);
    const double tension = 50.0;
    problem.wire.length = problem.span / (1.0 + tension / problem.wire.axial_stiffness);
    const ElasticaState state = push(problem, 1e-7);
    ASSERT_TRUE(state.report.usable());
    EXPECT_NEAR(state.tension_left, tension,
                1e-4);  // EA 1e-16/strain of rounding and the travel's 1e-7 N, with margin
    const double wanted =
        tensioned_clamped_stiffness(problem.wire.bending_stiffness, tension, 0.175, position);
    // Strain 1.5e-4 changes length and curvature; travel (1e-7 m) adds EA d^2/l^2 ~ 1e-7 N of tension.
    EXPECT_NEAR(state.force / 1e-7 / wanted, 1.0, 5e-4);
  }
}

TEST(ElasticaPush, StraightWireWithoutBendingStiffness) {
  // Boundary layers shorten either side by sqrt(EI/T): error proportional to sqrt(EI), halved with a quarter.
  ElasticaPush problem = declared(0.065);
  problem.wire.length = problem.span;
  problem.pieces_per_side = 40;
  const double d = 2e-3;
  const double law = unstretched_wire_force(problem.wire.axial_stiffness, 0.175, 0.065, d);
  double excess[2] = {};
  for (const int i : {0, 1}) {
    problem.wire.bending_stiffness = i == 0 ? 1e-4 : 0.25e-4;
    const ElasticaState state = push(problem, d);
    ASSERT_TRUE(state.report.usable()) << state.report.message;
    excess[i] = state.force / law - 1.0;
  }
  EXPECT_LT(excess[0], 0.05);  // 2 sqrt(EI/T) (1/s + 1/(l-s)) = 0.05 at T = 95 N
  // What remains is (d/s)^2 = 1e-3, the law's own truncation.
  EXPECT_NEAR(2.0 * excess[1] - excess[0], 0.0, 2e-3);
}

TEST(ElasticaPush, RefusesWhatIsOutOfRange) {
  const auto refused = [](auto change) {
    ElasticaPush problem = declared(0.065);
    change(problem);
    EXPECT_THROW((void)push(problem, 1e-3), std::invalid_argument);
  };
  refused([](ElasticaPush& p) { p.wire.length = 0.0; });
  refused([](ElasticaPush& p) { p.wire.bending_stiffness = -1.0; });
  refused([](ElasticaPush& p) { p.wire.axial_stiffness = std::nan(""); });
  refused([](ElasticaPush& p) { p.position = 0.2; });
  refused([](ElasticaPush& p) { p.radius = -1e-3; });
  refused([](ElasticaPush& p) { p.pieces_per_side = 1; });
  refused([](ElasticaPush& p) {
    p.wire.axial_stiffness = kInfinity;
    p.span = 0.2;
  });
  refused([](ElasticaPush& p) {
    p.contact = ElasticaContact::sticking;
    p.radius = 1e-3;
  });
}

}  // namespace
}  // namespace snare::validation
