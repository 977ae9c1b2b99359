#include "coupling/dynamics/model/modes.hpp"

#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/crossed_wires.hpp"
#include "tests/support/motion_bodies.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;
using test::block;
using test::body_of;

constexpr double two_pi = 2.0 * std::numbers::pi;

/// About the state a moment after the start.
std::vector<MotionMode> modes_of(const Motion& motion) {
  MotionOptions options = test::fine(1e-6, 1e-6);
  const MotionResult result = simulate(motion, options);
  EXPECT_TRUE(result.report.usable()) << result.report.message;
  return small_motions_at(motion, options, result.last).modes;
}

// A body on a spring alone, and with a dashpot that lets it only creep: lambda = -(c -+ (c^2 - 4 k m)^1/2)/(2
// m).
TEST(Modes, FastestIsOfWhatOnlyDecaysToo) {
  for (const double damping : {0.0, 1000.0}) {
    Motion motion;
    motion.bodies = {block("visitor", 3.0, {0.3, 0.4, 0.5})};
    MotionBushing bushing;
    bushing.second = body_of(0);
    bushing.translational_stiffness = {0.0, 0.0, 5000.0};
    bushing.translational_damping = {0.0, 0.0, damping};
    motion.bushings = {bushing};
    const MotionOptions options = test::fine(1e-6, 1e-6);
    const SmallMotions small = small_motions_at(motion, options, simulate(motion, options).last);
    const double fastest = damping > 0.0 ? (damping + std::sqrt(damping * damping - 4.0 * 5000.0 * 3.0)) / 6.0
                                         : std::sqrt(5000.0 / 3.0);
    ASSERT_TRUE(small.fastest);
    EXPECT_NEAR(*small.fastest, fastest, 1e-7 * fastest);
    EXPECT_NEAR(*small.largest_explicit_step(), 2.0 / fastest, 1e-7 / fastest);
    EXPECT_EQ(small.modes.size(), damping > 0.0 ? 0U : 1U);
  }
}

// (K/I)^1/2 and c/(2 (K I)^1/2) on a clamped fixture: three shifts and three turns, each by itself.
TEST(Modes, OfABodyOnABushingAreThoseOfTheClosedForm) {
  Motion motion;
  motion.bodies = {block("visitor", 3.0, {0.3, 0.4, 0.5})};
  MotionBushing bushing;
  bushing.first = {};
  bushing.second = body_of(0);
  bushing.translational_stiffness = {2000.0, 3000.0, 5000.0};
  bushing.rotational_stiffness = {40.0, 50.0, 70.0};
  bushing.rotational_damping = {0.2, 0.0, 0.0};
  motion.bushings = {bushing};
  const std::vector<MotionMode> modes = modes_of(motion);
  ASSERT_EQ(modes.size(), 6U);
  const std::array<std::pair<const char*, double>, 6> expected{{{"visitor turn y", 50.0 / 0.4},
                                                                {"visitor turn x", 40.0 / 0.3},
                                                                {"visitor turn z", 70.0 / 0.5},
                                                                {"visitor shift x", 2000.0 / 3.0},
                                                                {"visitor shift y", 1000.0},
                                                                {"visitor shift z", 5000.0 / 3.0}}};
  for (std::size_t k = 0; k < modes.size(); ++k) {
    EXPECT_NEAR(modes[k].frequency * two_pi, std::sqrt(expected[k].second),
                1e-8 * std::sqrt(expected[k].second));
    ASSERT_FALSE(modes[k].shares.empty());
    EXPECT_EQ(modes[k].shares[0].first, expected[k].first);
    EXPECT_NEAR(modes[k].shares[0].second, 1.0, 1e-9);
    EXPECT_NEAR(modes[k].damping, k == 1 ? 0.2 / (2.0 * std::sqrt(40.0 * 0.3)) : 0.0, 1e-8);
  }
}

TEST(Modes, OfTwoFreeBodiesLeaveOutWhatNothingHolds) {
  Motion motion;
  motion.bodies = {block("one", 3.0, {0.3, 0.4, 0.5}), block("other", 5.0, {0.4, 0.4, 0.5})};
  MotionBushing bushing;
  bushing.first = body_of(0);
  bushing.second = body_of(1);
  bushing.translational_stiffness = {2000.0, 3000.0, 5000.0};
  bushing.rotational_stiffness = {40.0, 50.0, 70.0};
  motion.bushings = {bushing};
  const std::vector<MotionMode> modes = modes_of(motion);
  ASSERT_EQ(modes.size(), 6U);
  const double reduced = 1.0 / 3.0 + 1.0 / 5.0;
  EXPECT_NEAR(modes[3].frequency * two_pi, std::sqrt(2000.0 * reduced), 1e-6);
  EXPECT_NEAR(modes[4].frequency * two_pi, std::sqrt(3000.0 * reduced), 1e-6);
  EXPECT_NEAR(modes[5].frequency * two_pi, std::sqrt(5000.0 * reduced), 1e-6);
  // The lighter one has the larger share: m v is the same of both.
  EXPECT_EQ(modes[3].shares[0].first, "one shift x");
  EXPECT_NEAR(modes[3].shares[0].second, 5.0 / 8.0, 1e-6);
}

// Beside the symmetric eigenvalue problem of the arm alone.
TEST(Modes, OfAnArmAreItsNaturalModes) {
  Motion motion;
  MotionArm arm;
  arm.arm = test::one_joint("link", Vector3d(1.0, 2.0, 0.5));
  arm.arm.joints[0].spring = multibody::DeflectionLaw::linear(900.0, 0.0);
  arm.start = multibody::resting(arm.arm, Eigen::VectorXd::Zero(arm.arm.tree.coordinates()));
  arm.drives = {multibody::Drive::holding(0.0, 70.0, 0.0)};
  motion.arms = {arm};
  const std::vector<MotionMode> modes = modes_of(motion);
  const auto expected = multibody::natural_modes(arm.arm, arm.start.q, arm.drives);
  ASSERT_EQ(modes.size(), expected.size());
  for (std::size_t k = 0; k < modes.size(); ++k)
    EXPECT_NEAR(modes[k].frequency, expected[k].frequency, 1e-6 * expected[k].frequency);
}

/// A taut string without friction of its own, which hardly bends.
struct TautString {
  static constexpr double length = 0.2, strain = 0.05;

  [[nodiscard]] static Motion motion(int elements) {
    Motion motion;
    motion.wires.push_back(test::wire_between("string", Vector3d::Zero(), {length, 0.0, 0.0}, elements,
                                              strain, wire::SpatialEnd::Kind::pin));
    wire::RodInMotion& rod = motion.wires[0].rod;
    rod.properties.bending_stiffness = rod.properties.second_bending_stiffness = 1e-7;
    rod.damping.bending_time = rod.damping.axial_time = 0.0;
    return motion;
  }
  /// n/(2 l) (T/rho)^1/2, both ways across [Hz].
  [[nodiscard]] static double frequency(int n) {
    const wire::RodInMotion rod = motion(8).wires[0].rod;
    const double stretched = rod.mass_per_length / (1.0 + strain);  // mass by present length
    return n / (2.0 * length) * std::sqrt(strain * rod.properties.axial_stiffness / stretched);
  }
};

/// Those of a list nearest to a frequency, of which a string has two.
std::vector<MotionMode> two_nearest(std::vector<MotionMode> modes, double frequency) {
  std::ranges::sort(modes, {}, [=](const MotionMode& m) { return std::abs(m.frequency - frequency); });
  modes.resize(2);
  return modes;
}

// What bends and is lumped errs by h^2.
TEST(Modes, OfAStretchedWireAreThoseOfAString) {
  const std::vector<MotionMode> modes = modes_of(TautString::motion(40));
  ASSERT_GT(modes.size(), 6U);
  for (int n = 1; n <= 3; ++n) {
    const double expected = TautString::frequency(n);
    for (const int k : {2 * n - 2, 2 * n - 1})
      EXPECT_NEAR(modes[static_cast<std::size_t>(k)].frequency, expected, 3e-3 * n * expected) << n;
    EXPECT_EQ(modes[static_cast<std::size_t>(2 * n - 1)].shares[0].first, "string");
  }
}

// The mesh of half as many elements gives the error of the finer one, and that of the twentieth partial
// beyond a hundredth.
TEST(Modes, OfAStretchedWireHaveTheErrorOfTheirMesh) {
  const auto small_motions_of = [](int elements) {
    const Motion motion = TautString::motion(elements);
    const MotionOptions options = test::fine(1e-6, 1e-6);
    return small_motions_at(motion, options, simulate(motion, options).last);
  };
  for (const int elements : {40, 41, 64}) {
    SmallMotions small = small_motions_of(elements);
    add_mesh_errors(small, small_motions_of((elements + 1) / 2));
    for (int n = 1; n <= 8; ++n) {
      SCOPED_TRACE(testing::Message() << elements << " elements, partial " << n);
      for (const MotionMode& mode : two_nearest(small.modes, TautString::frequency(n))) {
        ASSERT_TRUE(mode.mesh_error);
        const double error = std::abs(mode.frequency - TautString::frequency(n));
        EXPECT_LT(error, 1.3 * *mode.mesh_error);
        EXPECT_GT(error, 0.5 * *mode.mesh_error);
        EXPECT_EQ(mode.resolved(), *mode.mesh_error <= 0.01 * mode.frequency);
      }
    }
    EXPECT_TRUE(small.modes.front().resolved());
    EXPECT_FALSE(small.modes.back().resolved());
  }
}

// More unknowns than a dense eigenproblem takes: the slowest modes, by a sparse one.
TEST(Modes, OfManyUnknownsAreTheSlowest) {
  const Motion motion = TautString::motion(400);
  const MotionOptions options = test::fine(1e-6, 1e-6);
  const MotionState state = simulate(motion, options).last;
  ASSERT_GT(state.unknowns.size(), most_unknowns_of_all_modes);
  const SmallMotions small = small_motions_at(motion, options, state);
  EXPECT_FALSE(small.fastest);
  ASSERT_GT(small.modes.size(), 40U);
  for (int n = 1; n <= 20; ++n) {
    for (const MotionMode& mode : two_nearest(small.modes, TautString::frequency(n)))
      EXPECT_NEAR(mode.frequency, TautString::frequency(n), 2e-3 * TautString::frequency(n)) << n;
  }
}

}  // namespace
}  // namespace snare::coupling
