#include "multibody/arm/arm_run.hpp"
#include "tests/multibody/plain_arm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace snare::multibody {
namespace {

/// A wound up chain that nothing damps, for longer than anybody waits.
ArmScenario endless(int joints) {
  ArmScenario scenario;
  scenario.arm = test::chain_arm(joints, test::Base::on_the_world, 1000.0);
  scenario.initial = resting(scenario.arm, Eigen::VectorXd::Zero(joints));
  scenario.initial.motor.setConstant(0.01);
  scenario.drives.assign(static_cast<std::size_t>(joints), Drive::locked());
  scenario.end = 1e6;
  scenario.sample = 1e5;
  return scenario;
}

// Between two samples lie more steps than may be waited for.
TEST(ArmRun, StopsAfterTheStepInWhichItIsAsked) {
  ArmScenario scenario = endless(2);
  int asked = 0;
  scenario.stop = [&asked] { return ++asked == 5; };
  const ArmHistory history = simulate(scenario);
  EXPECT_EQ(asked, 5);
  EXPECT_EQ(history.report.termination, numerics::Termination::interrupted);
  ASSERT_EQ(history.samples.size(), 2U);  // the start, and where it was stopped
  EXPECT_GT(history.samples.back().time, 0.0);
  EXPECT_EQ(history.samples.back().time, history.report.time);
}

// No window of work brings it on by a tenth of what it must.
TEST(SlowArmRun, GivesUpWhatGetsNowhere) {
  ArmScenario scenario = endless(20);
  scenario.least_advance = 1e5;
  const ArmHistory history = simulate(scenario);
  EXPECT_EQ(history.report.termination, numerics::Termination::stalled);
  EXPECT_THAT(history.report.message, testing::StartsWith("stalled at "));
  EXPECT_THAT(history.report.message, testing::HasSubstr("less than the 100000 s that they must"));
  EXPECT_EQ(history.samples.back().time, history.report.time);
  EXPECT_LT(history.report.time, 1e4);
}

}  // namespace
}  // namespace snare::multibody
