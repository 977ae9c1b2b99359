// What a map of hypotheses says in words, and to which published fits it belongs.

#include "results/published_map.hpp"

#include "identification/effects/catalogue.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace snare::results {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json entry(const char* model, const char* family, double log_even, double even, const json& p, double more) {
  return {
      {"model", model},  {"meaning", model}, {"family", family}, {"probability", {log_even, even}}, {"p", p},
      {"range_mm", 9.3}, {"readings", 13},   {"numbers", 1},     {"more_compliance_um_N", more}};
}

PublishedVerdict verdict_of(const std::vector<json>& entries) {
  return published_verdict(
      {{"map", entries},
       {"along_the_wire",
        {{"more_compliance_um_N", {{"median", 27.2}, {"lower95", 24.2}, {"upper95", 29.6}}}}},
       {"decimal_point", {{"series", "s40"}, {"probability", {0.1, 0.2}}}},
       {"region", {{"range_mm", {5.21, 16.4}}, {"readings", {6, 45}}}}});
}

TEST(PublishedVerdict, HasDegrees) {
  const char* along = identification::along_the_wire;
  const auto shared =
      verdict_of({entry("wire", along, 0.3, 0.4, 0.2, 24.2), entry("mounts", along, 0.66, 0.57, 0.31, 29.6),
                  entry("slip", "slip", 0.04, 0.03, nullptr, 0.0)});
  EXPECT_EQ(shared.answer, PublishedAnswer::explained);
  EXPECT_EQ(shared.leading, "mounts");
  EXPECT_THAT(shared.headline, HasSubstr("if something gives along the wire, by 27 micrometres a newton more "
                                         "than declared (24 to 30 with 95 %)"));
  EXPECT_THAT(shared.headline, HasSubstr(": probability 96 % among 3 explanations"));
  EXPECT_THAT(shared.headline,
              HasSubstr("They cannot tell which of these it is: mounts (57 %), wire (30 %); "));
  EXPECT_THAT(shared.headline,
              HasSubstr("one raw reading would tell more (5.2 to 16 mm and 6 to 45 readings fit)."));
  EXPECT_THAT(verdict_of({entry("slip", "slip", 1.0, 1.0, 0.2, 0.0)}).headline,
              HasSubstr(" They fit over 5.2 to 16 mm and 6 to 45 readings; the range of the test"));
  // Not under both priors; P not known or too small; nothing agrees; nobody leads.
  EXPECT_EQ(
      verdict_of({entry("a", "a", 0.99, 0.9, 0.5, 0.0), entry("b", "b", 0.01, 0.1, nullptr, 0.0)}).answer,
      PublishedAnswer::most_likely);
  EXPECT_EQ(verdict_of({entry("a", "a", 0.99, 0.99, nullptr, 0.0)}).answer, PublishedAnswer::most_likely);
  EXPECT_EQ(verdict_of({entry("a", "a", 0.99, 0.99, 0.03, 0.0)}).answer, PublishedAnswer::most_likely);
  EXPECT_EQ(verdict_of({entry("a", "a", 0.99, 0.99, 0.005, 0.0)}).answer, PublishedAnswer::none_of_these);
  EXPECT_EQ(verdict_of({entry("a", "a", 0.6, 0.4, 0.5, 0.0), entry("b", "b", 0.4, 0.6, 0.5, 0.0)}).answer,
            PublishedAnswer::cannot_tell);
}

TEST(PublishedMap, BelongsToItsInputs) {
  const auto read = [](const std::vector<base::Override>& changes) {
    return published_inputs(identification::read_experiment(
        SNARE_SOURCE_DIR "/data/experiments/published_static.toml", identification::parameters(), changes));
  };
  const std::string declared = read({});
  EXPECT_EQ(read({{"solver.elements", "32"}}), declared);
  EXPECT_EQ(read({{"series[s40].law.to_mm", "9.0"}}), declared);  // unknown to the map
  EXPECT_NE(read({{"wire.length_mm", "180.1"}}), declared);
  EXPECT_NE(read({{"mount.span_mm", "175.1"}}), declared);
  EXPECT_NE(read({{"series[s40].law.C_N", "0.06"}}), declared);
}

}  // namespace
}  // namespace snare::results
