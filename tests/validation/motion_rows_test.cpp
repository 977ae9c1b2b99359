// Those rows of the motion that take seconds, not minutes, under the sanitizers; the test SlowRows runs
// `snare validate`, which has all.

#include "validation/motion_accuracy_checks.hpp"
#include "validation/motion_checks.hpp"

#include "tests/validation/row_checks.hpp"

#include <gtest/gtest.h>

namespace snare::validation {
namespace {

TEST(SlowMotionRows, AxialWavesRunAtTheirSpeed) {
  expect_within(axial_wave_rows());
}
TEST(SlowMotionRows, ASlowPushEndsInTheStaticCurve) {
  expect_within(slow_push_rows());
}
TEST(SlowMotionRows, ForceAndImpulseConvergeWithTheTolerance) {
  expect_within(tolerance_rows());
}
TEST(SlowMotionRows, ASlowPushWithFrictionFollowsTheStaticLoop) {
  expect_within(friction_reversal_rows());
}
TEST(SlowMotionRows, ASlowPushSnapsFromBranchToBranch) {
  expect_within(snap_through_rows());
}

}  // namespace
}  // namespace snare::validation
