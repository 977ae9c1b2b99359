// The rows of the captures by snares that take seconds under the sanitizers; `snare validate` has all.

#include "validation/capture_checks.hpp"
#include "validation/frequency_checks.hpp"
#include "validation/snare_checks.hpp"

#include "tests/validation/row_checks.hpp"

#include <gtest/gtest.h>

#include <string>

namespace snare::validation {
namespace {

const std::string data = std::string(SNARE_SOURCE_DIR) + "/data";

TEST(CaptureRows, RingIsTightAsTheClosedForm) {
  expect_within(tight_ring_rows(data));
}
TEST(CaptureRows, RigidizingMeetsTheFaceInTime) {
  expect_within(rigidizing_rows(data));
}
TEST(CaptureRows, RingTurnsTheSameTwoWays) {
  expect_within(ring_two_ways_rows(data, "stretched"));
}
TEST(CaptureRows, FrequenciesAreThoseOfASmallDisturbance) {
  expect_within(held_frequency_rows(data));
  expect_within(capture_frequency_rows(data));
}
TEST(CaptureRows, RollOnABushing) {
  expect_within(bushing_frequency_rows(data));
}
TEST(CaptureRows, HardwareInTheLoopBouncesOffFaster) {
  expect_within(bench_rows(data));
}

}  // namespace
}  // namespace snare::validation
