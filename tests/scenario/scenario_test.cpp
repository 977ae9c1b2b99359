#include "scenario/scenario.hpp"

#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace snare::scenario {
namespace {

using ::testing::EndsWith;

std::string problem_of(const std::string& name, const std::vector<base::Override>& overrides) {
  return test::refusal(
      [&] { return read_scenario(std::filesystem::path(SNARE_SOURCE_DIR) / "data/scenarios" / name, overrides); });
}

TEST(Scenario, SaysFirstWhatItIs) {
  EXPECT_THAT(problem_of("air_table.toml", {{"schema", "x"}, {"duration_s", "-1"}}),
              EndsWith("air_table.toml: schema = x, must be \"snare-scenario/2\" or \"snare-scenario/1\""));
  EXPECT_THAT(problem_of("air_table.toml", {{"kind", "fall"}}),
              EndsWith("kind = \"fall\", must be one of \"contact\", \"arm_contact\", \"joint_step\", \"tip_impulse\", "
                       "\"joint_motion\""));
}

// Only a scenario that names a contact scenario has overrides for it.
TEST(Scenario, OverridesOfAnotherFileNeedOne) {
  EXPECT_THAT(problem_of("jemrms_step.toml", {{"contact.solver.elements", "24"}}),
              testing::StartsWith("--set: contact, unknown key"));
  EXPECT_EQ(problem_of("jemrms_capture.toml", {{"contact.solver.elements", "24"}}), "accepted");
  EXPECT_EQ(problem_of("jemrms_capture.toml", {{"contact.solver.elements", "2"}}),
            "--set: solver.elements = 2, must be an integer >= 8 and <= 20000");
  EXPECT_THAT(problem_of("jemrms_capture.toml", {{"arm", "\"\""}}), EndsWith("arm = \"\", must name a file"));
}

}  // namespace
}  // namespace snare::scenario
