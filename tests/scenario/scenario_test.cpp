#include "scenario/scenario.hpp"

#include "scenario/motion_reader.hpp"
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

// Arms alone are given up by the same measure as all motions.
TEST(Scenario, ArmsMustGetOn) {
  const auto least = [](const std::vector<base::Override>& overrides) {
    const std::filesystem::path file = std::filesystem::path(SNARE_SOURCE_DIR) / "data/scenarios" / "jemrms_step.toml";
    return std::get<ArmMotion>(read_scenario(file, overrides).content).scenario.least_advance;
  };
  EXPECT_EQ(least({}), least_advance);
  EXPECT_EQ(least({{"solver.least_advance_s", "0.5"}}), 0.5);
  EXPECT_THAT(problem_of("jemrms_step.toml", {{"solver.least_advance_s", "-1"}}),
              testing::StartsWith("--set: solver.least_advance_s = -1, must be >= 0"));
}

}  // namespace
}  // namespace snare::scenario
