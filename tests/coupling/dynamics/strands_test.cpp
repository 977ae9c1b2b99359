// Friction between the strands of a wire in motion: derivatives, energy, decay.

#include "base/errors.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/dae_jacobian.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/soft_wire.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace snare::coupling {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

wire::RodInMotion strand_rod(int elements) {
  wire::RodInMotion r = test::soft_wire(elements);
  r.damping = {};
  r.strands.extra_stiffness = 2e-3;
  r.strands.slip_curvature = 0.5;
  return r;
}

// Some vertices slip, some stick. By the positions the second derivatives of the curvature are the symmetric
// part of what differences of gradients in travelling frames give (SpatialRod): exact where all stays in a
// plane, which is where they are tested; out of it Newton's matrix lacks the frames' holonomy, and what it
// solves is the same.
TEST(MotionStrands, JacobianMatchesDifferences) {
  wire::RodInMotion constants = strand_rod(6);
  constants.strands.time = 1e-2;
  for (const bool plane : {true, false}) {
    const double out = plane ? 0.0 : 1.0;
    wire::RodPart rod("wire", constants, {});
    numerics::DaeSystem system({&rod});
    VectorXd y = VectorXd::Zero(system.size());
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Matrix3Xd positions = straight_wire(constants, Vector3d::Zero(), {0.2, 0.0, 0.0});
    Matrix3Xd velocities = Matrix3Xd::Zero(3, 7);
    for (int i = 1; i < 6; ++i) {
      positions.col(i) += 2e-3 * Vector3d(unit(random), unit(random), out * unit(random));
      velocities.col(i) = 0.1 * Vector3d(unit(random), unit(random), out * unit(random));
    }
    rod.place(positions, velocities, y);
    for (int i = 0; i < rod.vertices(); ++i)
      y.segment<2>(rod.strand_of(i)) << 0.4 * unit(random), 0.4 * out * unit(random);
    VectorXd rate(y.size());
    for (double& r : rate) r = 0.1 * unit(random);
    Eigen::MatrixXd directions = Eigen::MatrixXd::Identity(y.size(), y.size());
    for (int i = 0; i < rod.vertices(); ++i) {
      if (plane) rate[rod.angle_of(i)] = 0.0;
      directions.col(rod.position_of(i) + 2).setZero();
      if (!plane) directions.middleCols(rod.position_of(i), 2).setZero();
      directions.col(rod.angle_of(i)).setZero();
    }
    const test::DerivativeError error = test::compare_dae_jacobian(system, y, rate, directions, 1e-4);
    // As for the rod without strands (MotionJacobian).
    EXPECT_LT(error.relative, 1e-7) << error.worst;
  }
}

/// A clamped straight wire that swings in its first mode, EI and EI + extra bracketing its frequency.
struct Swing {
  MotionResult result;
  std::vector<double> peaks;   // of the middle, upwards [m]
  std::vector<double> energy;  // kinetic and strain, at the peaks [J]
};

Swing swing(const wire::RodInMotion& rod, double speed, double duration) {
  Motion motion;
  motion.wires.push_back({"wire", rod, straight_wire(rod, Vector3d::Zero(), {0.2, 0.0, 0.0}), {}});
  const int n = rod.elements;
  Matrix3Xd v = Matrix3Xd::Zero(3, n + 1);
  for (int i = 1; i < n; ++i) v(1, i) = speed * std::pow(std::sin(pi * i / n), 2);
  motion.wires[0].velocities = v;
  MotionOptions options;
  options.duration = duration;
  options.output_interval = 2e-4;
  options.relative_tolerance = 1e-6;
  options.position_tolerance = 1e-9;
  options.velocity_tolerance = 1e-6;
  Swing s;
  double before = 0.0;
  double last = 0.0;
  double heat = 0.0;
  s.result = simulate(motion, options, [&](const MotionSample& sample) {
    const double now = sample.wires[0](1, n / 2);
    if (last > before && last >= now && last > 0.0) {
      s.peaks.push_back(last);
      s.energy.push_back(sample.energy.kinetic + sample.energy.strain);
    }
    before = last;
    last = now;
    EXPECT_GE(sample.energy.dissipated, heat - 1e-12);  // never gives back
    heat = sample.energy.dissipated;
    return false;
  });
  return s;
}

TEST(MotionStrands, DecayIsAccountedForAndEndsInTheStick) {
  wire::RodInMotion rod = strand_rod(16);
  rod.properties.axial_stiffness = 10.0;  // bends, hardly stretches
  rod.damping.axial_time = 1e-4;
  const Swing s = swing(rod, 0.5, 0.25);
  ASSERT_TRUE(s.result.report.usable()) << s.result.report.message;
  // First energy: m/2 v^2 int sin^4 = 3/8.
  const double start = 0.5 * 0.01 * 0.2 * 0.25 * 0.375;
  EXPECT_LT(std::abs(s.result.energy.integrator), 5e-3 * start);
  ASSERT_GT(s.peaks.size(), 6u);
  const std::size_t end = s.peaks.size() - 1;
  // Slip takes much of a large swing and nothing of one that stays below the slip curvature (but the
  // dashpots' little).
  const double first = s.peaks[1] / s.peaks[0];
  const double late = s.peaks[end] / s.peaks[end - 1];
  EXPECT_LT(first, 0.85);
  EXPECT_GT(late, 0.95);
}

TEST(MotionStrands, WrongNumbersAreNamed) {
  Motion motion;
  wire::RodInMotion rod = strand_rod(8);
  rod.strands.slip_curvature = 0.0;
  rod.strands.time = -1.0;
  motion.wires.push_back({"wire", rod, straight_wire(rod, Vector3d::Zero(), {0.2, 0.0, 0.0}), {}});
  EXPECT_THAT(test::refusal([&] { return simulate(motion, {}); }),
              testing::AllOf(testing::HasSubstr("wire.strands.slip_curvature = 0, must be > 0"),
                             testing::HasSubstr("wire.strands.time = -1, must be > 0")));
}

}  // namespace
}  // namespace snare::coupling
