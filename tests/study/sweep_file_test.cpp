#include "study/sweep_file.hpp"

#include "study/collect.hpp"
#include "study/trace_numbers.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>

namespace snare::study {
namespace {

using testing::HasSubstr;

class SweepFileTest : public test::FolderFixture {
 protected:
  [[nodiscard]] SweepFile read(const std::string& text) const {
    return read_sweep_file(write("sweep.toml", text));
  }
  [[nodiscard]] std::string problems(const std::string& text) const {
    return test::refusal([&] { return read(text); });
  }
  static constexpr const char* head = "schema = \"snare-sweep/1\"\ncase = \"x.toml\"\n";
  static constexpr const char* tail = "[collect]\nforce = \"series[s].largest_force_N\"\n";
};

TEST_F(SweepFileTest, GridOfValuesAndRanges) {
  const SweepFile sweep = read(std::string(head) + R"(design = "grid"
[set]
"wire.length_mm" = 180
"bodies[b].position_mm" = [0.0, 0, 1.5]
[[vary]]
key = "pusher.friction"
range = [-0.1, 0.2]
points = 4
[[vary]]
keys = ["mount.kind", "b.c[2]"]
name = "kind"
values = ["clamped", "pinned"]
)" + tail);
  EXPECT_EQ(sweep.design.count(), 8U);
  EXPECT_EQ(sweep.case_file, folder_ / "x.toml");
  const auto changes = overrides_of(sweep, sweep.design.values(3));
  ASSERT_EQ(changes.size(), 5U);
  EXPECT_EQ(changes[1].key + "=" + changes[1].value, "wire.length_mm=180");
  EXPECT_EQ(changes[2].key + "=" + changes[2].value, "pusher.friction=0");  // not 2.7e-17
  EXPECT_EQ(changes[3].key + "=" + changes[3].value, "mount.kind=\"pinned\"");
  EXPECT_EQ(changes[4].key, "b.c[2]");
  EXPECT_EQ(changes[0].value, "[0, 0, 1.5]");
}

TEST_F(SweepFileTest, EveryMistakeAtOnceWithItsLine) {
  const std::string words = problems(R"(schema = "snare-sweep/1"
case = "x.toml"
design = "sobl"
casess = 3
[[vary]]
key = "a"
normal = { mean = 1.0, sigma = -1.0 }
[[vary]]
key = "a"
uniform = [2.0, 1.0]
[[vary]]
name = "c"
values = []
range = [0.0, 1.0]
[collect]
a = "x"
f = "largest_force_N[*]"
t = "wall_s"
[[limits]]
of = "g"
above = 1.0
below = 2.0
)");
  for (const char* part :
       {"sweep.toml:3: design", "sweep.toml:4: casess", "sigma = -1", "varied twice", "low < high",
        "either key or keys", "one of values, range", "collect.a", "collect.f", "min, max, sum", "collect.t",
        "differs from run to run", "limits[1].of = \"g\"", "either above or below"})
    EXPECT_THAT(words, HasSubstr(part));
}

TEST_F(SweepFileTest, WhatADesignNeedsAndMayNotHave) {
  const std::string vary = "[[vary]]\nkey = \"a\"\nuniform = [0.0, 1.0]\n";
  EXPECT_THAT(problems(std::string(head) + "design = \"grid\"\n" + vary + tail), HasSubstr("in a grid"));
  EXPECT_THAT(problems(std::string(head) + "design = \"sobol\"\n" + vary + tail), HasSubstr("cases"));
  EXPECT_THAT(problems(std::string(head) + "design = \"subset\"\ncases = 50\n" + vary + tail),
              HasSubstr("at least 100"));
  EXPECT_THAT(problems(std::string(head) + "design = \"subset\"\ncases = 500\n" + vary + tail),
              HasSubstr("[[limits]]"));
  EXPECT_THAT(problems(std::string(head) + "design = \"file\"\n" + "[[vary]]\nkey = \"a\"\n" + tail),
              HasSubstr("table"));
  EXPECT_THAT(problems(std::string(head) + "design = \"sobol\"\ncases = 4\n" + vary), HasSubstr("collect"));
}

TEST_F(SweepFileTest, ARefinedGrid) {
  const std::string vary = R"([[vary]]
key = "a"
range = [0.0, 1.0]
points = 41
[[vary]]
key = "b"
values = [1, 2, 3]
)";
  const std::string refine = "[refine]\nof = \"force\"\nlevels = 3\ndiffers_by = 0.5\n";
  const std::string grid = std::string(head) + "design = \"grid\"\n";
  const SweepFile sweep = read(grid + vary + refine + tail);
  ASSERT_TRUE(sweep.refine);
  EXPECT_EQ(sweep.refine->field, 0U);
  EXPECT_EQ(sweep.refine->grid.levels, 3);
  EXPECT_EQ(sweep.refine->grid.differs_by, 0.5);
  ASSERT_EQ(sweep.refine->grid.axes.size(), 2U);
  EXPECT_TRUE(sweep.refine->grid.axes[0].refined);
  EXPECT_EQ(sweep.refine->grid.axes[1].points, 3U);
  EXPECT_FALSE(sweep.refine->grid.axes[1].refined);
  EXPECT_FALSE(read(grid + vary + tail).refine);

  const auto with = [&](const std::string& key, const std::string& by) {
    std::string text = grid + vary + refine + tail;
    return problems(text.replace(text.find(key), key.size(), by));
  };
  EXPECT_THAT(with("of = \"force\"", "of = \"forse\""), HasSubstr("did you mean force?"));
  EXPECT_THAT(with("levels = 3", "levels = 4"),
              HasSubstr("one more than a multiple of 16, the steps in a first cell "
                        "of [refine]: 49"));
  EXPECT_THAT(with("levels = 3", "levels = 17"), HasSubstr("levels = 17"));
  EXPECT_THAT(with("differs_by = 0.5", "differs_by = -0.5"), HasSubstr("differs_by = -0.5"));
  EXPECT_THAT(with("values = [1, 2, 3]", "range = [0.0, 1.0]\npoints = 80001"),
              HasSubstr("at most 1000000 cases, not 3.28e+06"));
  EXPECT_THAT(with("points = 41", "points = 1"), HasSubstr("1 to 6 [[vary]]"));
  EXPECT_THAT(with("range = [0.0, 1.0]\npoints = 41", "values = [1, 2]"), HasSubstr("1 to 6 [[vary]]"));
  EXPECT_THAT(problems(std::string(head) +
                       "design = \"sobol\"\ncases = 4\n[[vary]]\nkey = \"a\"\nuniform = [0.0, 1.0]\n" +
                       refine + tail),
              HasSubstr("refine, must be left out but with design = \"grid\""));
}

TEST_F(SweepFileTest, ATableOfCases) {
  write("t.csv", "case,b,a\n1,10,0.5\n2,20,0.25\n");
  const std::string text = std::string(head) +
                           "design = \"file\"\ntable = \"t.csv\"\n[[vary]]\nkey = \"k\"\ncolumn = \"a\"\n" +
                           "[[vary]]\nkey = \"b\"\n" + tail;
  const SweepFile sweep = read(text);
  ASSERT_EQ(sweep.design.count(), 2U);
  EXPECT_EQ(sweep.design.values(1), (std::vector<double>{0.25, 20.0}));
  write("t.csv", "case,b,a\n1,10,0.5\n2,20,0.26\n");
  EXPECT_NE(read(text).canonical, sweep.canonical);  // the table belongs to the study
}

constexpr const char* trace = R"({"schema": "snare-trace/1", "final": {"parameters": {
  "wire.length_mm": {"value": 180.2, "stderr": 0.05}, "wire.axial_stiffness_N": {"value": 3e5, "stderr": 1e4},
  "fixed": {"value": 1.0, "stderr": null}},
  "correlation": {"wire.length_mm": {"wire.axial_stiffness_N": 0.8}, "wire.axial_stiffness_N": {"wire.length_mm": 0.8}}}})";

TEST_F(SweepFileTest, NumbersOfATraceWithTheirCorrelation) {
  write("trace.json", trace);
  const SweepFile sweep = read(std::string(head) + R"(design = "latin_hypercube"
cases = 100
[[vary]]
key = "wire.length_mm"
from_trace = "trace.json"
[[vary]]
key = "snares[s].wire.axial_stiffness_N"
parameter = "wire.axial_stiffness_N"
from_trace = "trace.json"
)" + tail);
  const Distribution& length = sweep.design.variables()[0].distribution;
  EXPECT_EQ(length.a, 180.2);
  EXPECT_EQ(length.b, 0.05);
  ASSERT_EQ(sweep.design.settings().correlation.rows(), 2);
  EXPECT_EQ(sweep.design.settings().correlation(0, 1), 0.8);
  EXPECT_THAT(
      problems(std::string(head) +
               "design = \"sobol\"\ncases = 4\n[[vary]]\nkey = \"fixed\"\nfrom_trace = \"trace.json\"\n" +
               tail),
      HasSubstr("there are: wire.axial_stiffness_N, wire.length_mm"));
  EXPECT_THAT(
      problems(std::string(head) +
               "design = \"sobol\"\ncases = 4\n[[vary]]\nkey = \"fixed\"\nfrom_trace = \"no.json\"\n" + tail),
      HasSubstr("no such file"));
}

TEST(Collect, FieldsOfAResult) {
  const nlohmann::json result =
      nlohmann::json::parse(R"({"outcome": {"caught": true, "tension": {"a::w_1": 3, "a::w_2": 5.5},
    "late": null}, "numbers": {"arms[rms].rates[1]": 7}, "series": [{"name": "s", "force": 2}, {"name": "t", "force": null}], "place": [1, 2, 3]})");
  const auto get = [&](const char* text) { return collected(parse_collected("x", text).value(), result); };
  EXPECT_EQ(get("outcome.caught"), true);
  EXPECT_EQ(get("outcome.tension[a::w_2]"), 5.5);
  EXPECT_EQ(get("max outcome.tension[*]"), 5.5);
  EXPECT_EQ(get("min outcome.tension[*]"), 3.0);
  EXPECT_EQ(get("sum outcome.tension[*]"), 8.5);
  EXPECT_EQ(get("mean place[*]"), 2.0);
  EXPECT_EQ(get("place[2]"), 2);
  EXPECT_EQ(get("numbers[arms[rms].rates[1]]"), 7);
  EXPECT_EQ(get("series[s].force"), 2);
  EXPECT_TRUE(get("series[t].force").is_null());
  EXPECT_TRUE(get("outcome.late.more").is_null());
  EXPECT_EQ(get("count series[*].force"), 1.0);
  EXPECT_FALSE(parse_collected("x", "max outcome"));  // one needs no choice
  EXPECT_FALSE(parse_collected("x", "outcome[*]"));   // several need one
  EXPECT_FALSE(parse_collected("x", "outcome..a"));
  EXPECT_FALSE(parse_collected("x", "a[b"));
  EXPECT_FALSE(parse_collected("x", "a[b[c]"));
  try {
    static_cast<void>(get("outcome.cought"));
    FAIL() << "found";
  } catch (const std::out_of_range& error) {
    EXPECT_THAT(error.what(), HasSubstr("there are: caught, late, tension"));
  }
  EXPECT_THROW(static_cast<void>(get("outcome")), std::out_of_range);
}

}  // namespace
}  // namespace snare::study
