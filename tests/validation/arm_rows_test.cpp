// The rows of the arms that take seconds under the sanitizers; `snare validate` has all.

#include "validation/arm_checks.hpp"
#include "validation/linked_motion_checks.hpp"

#include "tests/validation/row_checks.hpp"

#include <gtest/gtest.h>

#include <string>

namespace snare::validation {
namespace {

const std::string arms = std::string(SNARE_SOURCE_DIR) + "/data/arms";

TEST(ArmRows, WorkIsTheChangeOfTheEnergy) {
  expect_within(arm_work_rows());
}
TEST(ArmRows, FrequenciesAreThoseOfTwoMasses) {
  expect_within(arm_frequency_rows());
}
TEST(ArmRows, StiffGearsGiveTheRigidArm) {
  expect_within(rigid_limit_rows());
}
TEST(ArmRows, PeriodFollowsTheAmplitude) {
  expect_within(amplitude_rows());
}
TEST(ArmRows, FloatingBaseAnswersItsLink) {
  expect_within(floating_base_rows());
}
TEST(LinkedMotionRows, WeldedBodiesAreASymmetricTop) {
  expect_within(welded_top_rows());
}
TEST(SlowArmRows, EnergyAndMomentumStay) {
  expect_within(arm_conservation_rows());
}
TEST(SlowArmRows, JumpsAreOneEventEach) {
  expect_within(jump_rows());
}
TEST(SlowArmRows, JointStepVibratesAsTable2Says) {
  expect_within(joint_step_rows(arms));
}
TEST(SlowArmRows, PushAtTheTip) {
  expect_within(tip_push_rows(arms));
}

}  // namespace
}  // namespace snare::validation
