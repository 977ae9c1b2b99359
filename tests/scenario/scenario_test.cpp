#include "scenario/scenario.hpp"

#include "scenario/motion_reader.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace snare::scenario {
namespace {

using ::testing::EndsWith;

std::string problem_of(const std::string& name, const std::vector<base::Override>& overrides) {
  return test::refusal([&] {
    return read_scenario(std::filesystem::path(SNARE_SOURCE_DIR) / "data/scenarios" / name, overrides);
  });
}

TEST(Scenario, SaysFirstWhatItIs) {
  EXPECT_THAT(problem_of("air_table.toml", {{"schema", "x"}, {"duration_s", "-1"}}),
              EndsWith("schema = x, must be \"snare-scenario/2\""));
  EXPECT_THAT(
      problem_of("air_table.toml", {{"kind", "fall"}}),
      EndsWith("belongs to older files: take the line out, a file of snare-scenario/2 lists what there is"));
}

class OlderScenarios : public test::FolderFixture {
 protected:
  /// What a file of the older schema with these lines is told, and wrong besides.
  [[nodiscard]] std::string told(const std::string& lines) const {
    write("older.toml", "# of old\nschema = \"snare-scenario/1\"\n" + lines + "duration_s = -1\nnone = 1\n");
    const std::string said = test::refusal([&] { return read_scenario(path("older.toml")); });
    return said.substr(said.find("older.toml"));
  }
};

// One message a file, whatever else is wrong in it: what to change.
TEST_F(OlderScenarios, AreToldWhatToChange) {
  const std::string begin = "older.toml:2: schema = \"snare-scenario/1\", is read no more: ";
  const std::string page = ": docs/scenario_file.md, \"From snare-scenario/1\"";
  const auto lists = [&page, &begin](const std::string& what, const std::string& kind) {
    return begin + what + " of \"snare-scenario/2\" say what kind = \"" + kind + "\" said" + page;
  };
  EXPECT_EQ(told("kind = \"contact\"\n[[wires]]\nname = \"a\"\n"),
            begin + "change the line to schema = \"snare-scenario/2\" and take kind out");
  EXPECT_EQ(told("kind = \"contact\"\n[body]\nmass_kg = 1.0\n"),
            lists("[[wires]], [[bodies]] and [[shapes]]", "contact"));
  EXPECT_EQ(told("kind = \"arm_contact\"\n"),
            lists("[[arms]], [[wires]], [[bodies]] and [[shapes]]", "arm_contact"));
  EXPECT_EQ(told("kind = \"joint_step\"\n"), lists("[[arms]] with deflections_deg", "joint_step"));
  EXPECT_EQ(told("kind = \"tip_impulse\"\n"), lists("[[arms]] and [[loads]]", "tip_impulse"));
  EXPECT_EQ(told("kind = \"joint_motion\"\n"), lists("[[arms]] and [[drives]]", "joint_motion"));
  EXPECT_EQ(told("kind = \"fall\"\n"), begin + "must be \"snare-scenario/2\"" + page);
}

TEST(Scenario, ArmsMustGetOn) {
  const auto least = [](const std::vector<base::Override>& overrides) {
    const std::filesystem::path file =
        std::filesystem::path(SNARE_SOURCE_DIR) / "data/scenarios" / "jemrms_step.toml";
    return read_scenario(file, overrides).motions.runs.front().options.least_advance;
  };
  EXPECT_EQ(least({}), least_advance);
  EXPECT_EQ(least({{"solver.least_advance_s", "0.5"}}), 0.5);
  EXPECT_THAT(problem_of("jemrms_step.toml", {{"solver.least_advance_s", "-1"}}),
              testing::StartsWith("--set: solver.least_advance_s = -1, must be >= 0"));
}

TEST(Scenario, SwingsAreOfAJointWithAMotor) {
  EXPECT_THAT(problem_of("jemrms_step.toml", {{"output.swings", "rms::elbow"}}),
              testing::StartsWith(
                  "--set: output.swings = rms::elbow, must be a joint with a motor: \"rms::joint_1\""));
}

}  // namespace
}  // namespace snare::scenario
