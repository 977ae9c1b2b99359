// Numbers that records do not determine, readings of another sign or unit, and every number of a scenario as
// a free one.
#include "base/errors.hpp"
#include "identification/motion_tracing/trace_records.hpp"
#include "identification/records/record_file.hpp"
#include "tests/support/folder_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>
#include <set>

namespace snare::identification {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A body on a spring and a damper, 5 kg on 200 N/m and 2 N s/m, which starts with 0.02 m/s from rest:
///   x = v / w exp(-s t) sin(w t),  s = c / 2m = 0.2 1/s,  w^2 = k/m - s^2.
class OpenNumbers : public test::FolderFixture {
 protected:
  std::filesystem::path spring(const std::string& free, double mass,
                               const std::function<double(double)>& reading = {}) const {
    write("scenario.toml", fmt::format(R"(schema = "snare-scenario/2"
title = "block"
duration_s = 2.0
output_interval_s = 0.02
[[bodies]]
name = "block"
mass_kg = {:.17g}
inertia_kg_m2 = [1.0, 1.0, 1.0]
velocity_m_s = [0.02, 0.003, 0.0]
[[bushings]]
name = "fixture"
frame = "world"
other_frame = "block"
translational_stiffness_N_m = 200.0
translational_damping_Ns_m = 2.0
rotational_stiffness_Nm_rad = 100.0
[[sensors]]
name = "place"
kind = "position"
frame = "block"
)",
                                       mass));
    std::mt19937 engine(4);
    std::normal_distribution<double> noise(0.0, 0.01);
    const double s = 0.2, w = std::sqrt(40.0 - s * s);
    std::string text = "time_s,x_mm\n";
    for (int i = 0; i < 100; ++i) {
      const double t = 0.02 * i;
      const double x = 20.0 / w * std::exp(-s * t) * std::sin(w * t) + noise(engine);
      text += fmt::format("{:.4f},{:.9g}\n", t, reading ? reading(x) : x);
    }
    write("a.csv", text);
    return write("record.toml", fmt::format(R"(schema = "snare-record/1"
title = "t"
scenario = "scenario.toml"
[[records]]
name = "a"
file = "a.csv"
columns = {{ x_mm = "place_x_mm" }}
sigma = 0.01
[fit]
free = [{}]
)",
                                            free));
  }
  static RecordTrace fitted(const std::filesystem::path& file) {
    RecordTraceOptions options;
    options.effects = false;
    return trace_records(read_records(file), options);
  }
};

constexpr const char* all_three =
    R"("bodies[block].mass_kg", "bushings[fixture].translational_stiffness_N_m", "bushings[fixture].translational_damping_Ns_m")";

// A speed across the one that is seen changes readings by the errors of the integration alone, which lead
// nowhere.
TEST_F(OpenNumbers, ANumberThatDoesNotActStaysWhereItIs) {
  const std::string across = "bodies[block].velocity_m_s[2]",
                    stiffness = "bushings[fixture].translational_stiffness_N_m";
  const RecordTrace t = fitted(spring(fmt::format(R"("{}", "{}")", across, stiffness), 5.0));
  ASSERT_TRUE(t.report.usable()) << t.report.message;
  for (const auto& n : t.final.numbers) {
    if (n.key == across) EXPECT_NEAR(n.value, 0.003, 0.03);
    if (n.key == stiffness) EXPECT_NEAR(n.value, 200.0, 1.0);
  }
}

// The motion depends on k/m and c/m: from every start the quotients are the same, and no number by itself is
// known.
TEST_F(OpenNumbers, MassStiffnessAndDampingScaleTogether) {
  for (const double start : {5.0, 3.5, 8.0}) {
    const RecordTrace t = fitted(spring(all_three, start));
    ASSERT_TRUE(t.report.usable()) << t.report.message;
    for (const TracedNumber& n : t.final.numbers) EXPECT_FALSE(n.identified || n.lower || n.upper) << n.key;
    ASSERT_EQ(t.final.open.size(), 1u);
    // Equal powers; the column of the damping is a hundredth of the others', and its differences err by some
    // per cent.
    EXPECT_THAT(null_words(t.final.open.front().changes), HasSubstr("scale together"));
    for (const NamedChange& c : t.final.open.front().changes) EXPECT_NEAR(c.change, 1.0, 0.1) << c.key;
    const double mass = t.final.numbers[0].value;
    // k to 0.3 % (w to 0.1 %, four standard errors), c to a tenth.
    EXPECT_NEAR(t.final.numbers[1].value / mass, 40.0, 0.15) << start;
    EXPECT_NEAR(t.final.numbers[2].value / mass, 0.4, 0.04) << start;
    for (const TracedNumber& n : t.final.open.front().known) EXPECT_TRUE(n.lower && n.upper) << n.key;
    EXPECT_THAT(t.warnings, Contains(HasSubstr("scale together")));
    EXPECT_NE(t.kind, VerdictKind::nothing_missing);
  }
}

TEST_F(OpenNumbers, WithOneOfThemHeldTheOthersAreKnown) {
  const RecordTrace t = fitted(spring(
      R"("bushings[fixture].translational_stiffness_N_m", "bushings[fixture].translational_damping_Ns_m")",
      5.0));
  ASSERT_TRUE(t.report.usable()) << t.report.message;
  for (const TracedNumber& n : t.final.numbers) EXPECT_TRUE(n.identified && n.lower && n.upper) << n.key;
  EXPECT_TRUE(t.final.open.empty() && t.findings.empty());
  EXPECT_NEAR(t.final.numbers[0].value, 200.0, 4.0 * t.final.numbers[0].stderr_)
      << t.final.numbers[0].stderr_;
}

TEST_F(OpenNumbers, TheSignAndTheUnitOfASensorAreNamed) {
  const std::string key = R"("bushings[fixture].translational_stiffness_N_m")";
  const RecordTrace turned = fitted(spring(key, 5.0, [](double x) { return -x; }));
  ASSERT_FALSE(turned.findings.empty());
  EXPECT_EQ(turned.findings.front().kind, FindingKind::sign_turned);
  EXPECT_EQ(turned.findings.front().key, "place_x_mm");
  for (const double factor : {1e-3, 25.4, 1.0 / 25.4}) {
    const RecordTrace slip = fitted(spring(key, 5.0, [factor](double x) { return factor * x; }));
    ASSERT_FALSE(slip.findings.empty()) << factor;
    EXPECT_EQ(slip.findings.front().kind, FindingKind::unit_slip) << factor;
    EXPECT_NEAR(slip.findings.front().value, factor,
                0.01 * factor);  // noise of 0.01 mm in 3 mm, over 100 readings
  }
}

TEST_F(OpenNumbers, ANumberOnItsBoundHasNoIntervalBeyondIt) {
  const std::filesystem::path file = spring(R"("bushings[fixture].translational_stiffness_N_m")", 5.0);
  write("record.toml",
        contents("record.toml") +
            "[[fit.numbers]]\nkey = \"bushings[fixture].translational_stiffness_N_m\"\nupper = 190.0\n");
  std::string scenario = contents("scenario.toml");
  scenario.replace(scenario.find("200.0"), 5, "180.0");
  write("scenario.toml", scenario);
  const RecordTrace t = fitted(file);
  ASSERT_TRUE(t.report.usable()) << t.report.message;
  EXPECT_EQ(t.final.numbers[0].bound, AtBound::upper);
  EXPECT_FALSE(t.final.numbers[0].upper);
  EXPECT_TRUE(t.final.numbers[0].lower);
  EXPECT_THAT(t.warnings, Contains(HasSubstr("upper bound")));
}

/// Names of the numbers in the properties of a schema's definition.
void collect(const nlohmann::json& schema, const nlohmann::json& object, const std::string& prefix,
             std::set<std::string>& keys, int depth) {
  if (depth > 6) return;
  if (object.contains("$ref")) {
    const std::string ref = object["$ref"];
    return collect(schema, schema["$defs"][ref.substr(ref.rfind('/') + 1)], prefix, keys, depth + 1);
  }
  const nlohmann::json type = object.value("type", nlohmann::json());
  if ((type == "number" || type == "integer") && !prefix.empty()) keys.insert(prefix);
  if (object.contains("items")) {
    const std::string name = prefix == "bodies" ? "[block]" : prefix == "bushings" ? "[fixture]" : "[1]";
    collect(schema, object["items"], prefix + (prefix == "sensors" ? "[place]" : name), keys, depth + 1);
  }
  for (const char* part : {"oneOf", "anyOf", "allOf"})
    if (object.contains(part))
      for (const nlohmann::json& one : object[part]) collect(schema, one, prefix, keys, depth + 1);
  if (!object.contains("properties")) return;
  for (const auto& [name, inner] : object["properties"].items())
    collect(schema, inner, prefix.empty() ? name : prefix + "." + name, keys, depth + 1);
}

// Every number of the two formats as the free one: an answer, or a refusal that names the key.
TEST_F(OpenNumbers, EveryKeyHasAnAnswerOrAReason) {
  std::set<std::string> keys;
  for (const char* name : {"scenario", "record"}) {
    std::ifstream file(fmt::format(SNARE_SOURCE_DIR "/data/schemas/{}.schema.json", name));
    const nlohmann::json schema = nlohmann::json::parse(file);
    collect(schema, schema, "", keys, 0);
  }
  ASSERT_GT(keys.size(), 100u);
  int answers = 0, refusals = 0;
  for (const std::string& key : keys) {
    try {
      const RecordTrace t = fitted(spring("\"" + key + "\"", 5.0));
      ASSERT_TRUE(t.report.usable() || !t.report.message.empty()) << key;
      for (const TracedNumber& n : t.final.numbers) EXPECT_TRUE(std::isfinite(n.value)) << key;
      ++answers;
    } catch (const base::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(key)) << key;
      ++refusals;
    }
  }
  EXPECT_GT(answers, 5);
  EXPECT_GT(refusals, 50);
}

}  // namespace
}  // namespace snare::identification
