// What the catalogue of records offers for a scenario.
#include "identification/motion_effects/record_effect.hpp"
#include "identification/records/record_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace snare::identification {
namespace {

using testing::Contains;
using testing::Not;

const std::filesystem::path records = std::filesystem::path(SNARE_SOURCE_DIR) / "data/records";

std::vector<std::string> labels(const std::vector<RecordEffect>& effects) {
  std::vector<std::string> all;
  for (const RecordEffect& e : effects) all.push_back(e.label());
  return all;
}

/// Texts of the keys that an effect sets where its numbers are moved by their scales from null, one number
/// after the other.
std::vector<base::Override> set_by(const RecordModel& model, const RecordEffect& effect) {
  std::vector<base::Override> overrides;
  for (const RecordNumber& n : effect.numbers)
    for (base::Override& one : n.overrides(n.declared + n.scale, {model.declared(), overrides}))
      overrides.push_back(std::move(one));
  return overrides;
}

TEST(MotionCatalogue, AsksTheWiresOfASnareTheVisitorAndTheClock) {
  const RecordSet set = read_records(records / "flight.toml");
  const RecordModel model(set);
  const std::vector<std::string> offered = labels(motion_effects(model));
  for (const char* label :
       {"wire_length (snare)", "wire_bending_stiffness (snare)", "wire_axial_stiffness (snare.rod)",
        "wire_damping (axial)", "wire_damping (bending)", "body_centre_of_mass (htv)",
        "body_start_position (htv)", "record_clock"})
    EXPECT_THAT(offered, Contains(label));
  EXPECT_THAT(offered, Not(Contains("body_start_attitude (htv)")));  // none is declared
}

TEST(MotionCatalogue, AsksTheLinksOfAnArm) {
  const RecordSet set = read_records(records / "flight_attachment.toml");
  const RecordModel model(set);
  const std::vector<RecordEffect> effects = motion_effects(model);
  const auto boom = std::ranges::find_if(
      effects, [](const RecordEffect& e) { return e.label() == "link_flexibility (rms::ssrms_boom_1)"; });
  ASSERT_NE(boom, effects.end());
  EXPECT_TRUE(boom->one_sided);
  const std::vector<base::Override> set_to = set_by(model, *boom);
  ASSERT_EQ(set_to.size(), 1U);
  EXPECT_EQ(set_to[0].key, "arms[rms].link.ssrms_boom_1.bending_compliance_rad_Nm");
}

// Elements of a vector that the file does not declare: it is there before they are set, and once only.
TEST(MotionCatalogue, MovesACentreOfMassThatIsNotDeclared) {
  const RecordSet set = read_records(records / "flight.toml");
  const RecordModel model(set);
  const std::vector<RecordEffect> effects = motion_effects(model);
  const auto centre = std::ranges::find(effects, std::string("body_centre_of_mass"), &RecordEffect::name);
  ASSERT_NE(centre, effects.end());
  const std::vector<base::Override> set_to = set_by(model, *centre);
  ASSERT_EQ(set_to.size(), 4U);
  EXPECT_EQ(set_to[0].key, "bodies[htv].com_mm");
  EXPECT_EQ(set_to[0].value, "[0.0, 0.0, 0.0]");
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_EQ(set_to[k].key, "bodies[htv].com_mm[" + std::to_string(k) + "]");
    EXPECT_EQ(set_to[k].value, "1.0");
  }
}

// A joint's stiffness beside a fitted one of all joints: the effect acts on what that is, and is told as the
// file would have it.
TEST(RecordModel, TellsWhatAKeyIsSetTo) {
  const RecordSet set = read_records(records / "flight_attachment.toml");
  const RecordModel model(set);
  std::vector<RecordSetting> settings = model.free_settings({0});
  ASSERT_EQ(settings.size(), 1U);
  settings[0].value = 1e6;  // declared: 1.08e6
  const std::vector<RecordEffect> effects = motion_effects(model);
  const auto elbow = std::ranges::find_if(
      effects, [](const RecordEffect& e) { return e.label() == "joint_stiffness (rms::elbow_pitch)"; });
  ASSERT_NE(elbow, effects.end());
  settings.push_back({elbow->numbers[0], 0.3 * 1.08e6});
  EXPECT_NEAR(model.as_set(settings, 0, 1e6), 1e6, 1e-3);
  EXPECT_NEAR(model.as_set(settings, 1, 0.3 * 1.08e6), 3e5, 1e-3);
}

// What is asked of the first readings is simulated no further, and told the same but for the integration,
// which starts again at other times.
TEST(RecordModel, PredictsTheFirstReadingsAlone) {
  const RecordSet set = read_records(records / "flight_attachment.toml");
  const RecordModel model(set);
  const std::vector<RecordSetting> none;
  const RecordPrediction whole = model.predict(none, {0})[0], part = model.predict(none, {0}, {10})[0];
  ASSERT_TRUE(whole.usable() && part.usable());
  for (std::size_t c = 0; c < whole.channels.size(); ++c) {
    ASSERT_EQ(part.channels[c].size(), 10);
    const double size = whole.channels[c].cwiseAbs().maxCoeff();
    EXPECT_LT((whole.channels[c].head(10) - part.channels[c]).cwiseAbs().maxCoeff(), 1e-3 * size);
  }
}

}  // namespace
}  // namespace snare::identification
