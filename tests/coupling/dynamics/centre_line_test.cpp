#include "coupling/dynamics/model/centre_line.hpp"

#include "base/units.hpp"
#include "wire/motion/rod_part.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snare::coupling {
namespace {

using base::mm;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double radius = 0.1, pitch = 0.02;  // of a helix [m], [m/rad]

Vector3d helix(double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle), pitch * angle};
}

Matrix3Xd helix_points(int count, double turn) {
  Matrix3Xd points(3, count);
  for (int i = 0; i < count; ++i) points.col(i) = helix(turn * i / (count - 1));
  return points;
}

CentreLine line_through(const Matrix3Xd& points) {
  return CentreLine(measured_points({points, Matrix3Xd::Zero(3, points.cols()), {}}));
}

TEST(CentreLine, HasTheLengthOfAHelixToFourthOrder) {
  const double turn = 2.0 * pi, exact = turn * std::hypot(radius, pitch);
  const auto error = [&](int count) {
    return std::abs(line_through(helix_points(count, turn)).length() / exact - 1.0);
  };
  EXPECT_LT(error(41), 1e-5);
  // Each halving of the spacing leaves a sixteenth; the ends, by three points each, leave room for an eighth.
  EXPECT_LT(error(81), error(41) / 8.0);
}

TEST(CentreLine, HasTheCurvatureAndTheDirectionsOfAHelix) {
  const CentreLine line = line_through(helix_points(161, 2.0 * pi));
  const double exact = radius / (radius * radius + pitch * pitch);
  for (const double share : {0.2, 0.5, 0.77}) {
    const double s = share * line.length();
    EXPECT_NEAR(line.curvature(s), exact,
                2e-3 * exact);  // second derivative of a spline: second order, 39 mrad a point
    EXPECT_LT((line.place(s) - helix(2.0 * pi * share)).norm(), 1e-7);
    EXPECT_LT(std::abs(line.stretch(s)), 1e-6);
  }
}

MotionWire wire_on(const CentreLine& line, wire::Formulation formulation) {
  MotionWire w;
  w.rod.properties.bending_stiffness = w.rod.properties.second_bending_stiffness = 0.05;
  w.rod.properties.torsional_stiffness = 0.04;
  w.rod.properties.axial_stiffness = 3e5;
  w.rod.mass_per_length = 0.014;
  w.rod.length = line.length();
  w.rod.elements = 40;
  w.rod.formulation = formulation;
  begin_on(line, w);
  return w;
}

// A curve of constant curvature bends a round wire by EI kappa and does not twist it, whatever its torsion.
TEST(CentreLine, BendsAWireWithoutTwist) {
  const CentreLine line = line_through(helix_points(161, 1.5 * pi));
  for (const auto formulation : {wire::Formulation::vertices, wire::Formulation::higher_order}) {
    const double moment = 0.05 * radius / (radius * radius + pitch * pitch);
    const MotionWire w = wire_on(line, formulation);
    wire::RodPart part("wire", w.rod, {});
    numerics::DaeSystem system({&part});
    Eigen::VectorXd y = Eigen::VectorXd::Zero(system.size());
    const Eigen::VectorXd rate = y;
    part.place(w.positions, w.velocities, y);
    Eigen::VectorXd rows(system.size());
    system.residual({0.0, y, rate}, rows);
    // Chords bend without regard to twist, but for round-off; curvatures as unknowns turn a little against
    // the chords beside a clamp.
    const double allowed = formulation == wire::Formulation::vertices ? 1e-12 : 1e-3 * moment;  // N m
    for (int e = 0; e + 1 < part.vertices(); ++e) EXPECT_LT(std::abs(rows[part.angle_of(e)]), allowed);
    const wire::RodPart::SectionLoads loads = part.section_loads({0.0, y, rate});
    EXPECT_NEAR(loads.bending_moments[20], moment,
                5e-3 * moment);  // of 40 elements that turn by 0.12 rad each
    EXPECT_LT(part.mount_error(y), 1e-15);
  }
}

// Four points a circle: the spline is far from the circle, and yet the wire is evenly stretched along it.
TEST(CentreLine, IsEvenlyStretchedHoweverFewItsPoints) {
  const CentreLine line = line_through(helix_points(5, 2.0 * pi));
  // The curvature jumps at the points, where pieces of 90 degrees in 64 parts turn by 0.025 a part: some 1/20
  // of the square.
  for (int i = 0; i <= 100; ++i) EXPECT_LT(std::abs(line.stretch(0.01 * i * line.length())), 3e-5);
}

TEST(CentreLine, OfAStraightWireIsStraightToRoundOff) {
  Matrix3Xd points(3, 2);
  points << 0.1, 0.3, 0.2, 0.2, 0.0, -0.4;
  const CentreLine line = line_through(points);
  EXPECT_NEAR(line.length(), std::hypot(0.2, 0.4), 1e-15);
  const MotionWire w = wire_on(line, wire::Formulation::higher_order);
  for (int i = 0; i <= 40; ++i)
    EXPECT_LT((w.positions.col(i) - (points.col(0) + i / 40.0 * (points.col(1) - points.col(0)))).norm(),
              1e-15);
  EXPECT_EQ(w.velocities.cols(), 0);
  EXPECT_LT((w.rod.properties.left.director - Vector3d::UnitY()).norm(),
            1e-13);  // across its plane, to round-off
}

}  // namespace
}  // namespace snare::coupling
