#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

namespace snare::app {
namespace {

using testing::HasSubstr;

constexpr const char* benchmark = R"(schema = "snare-benchmark/1"
title = "pushes"
[[cases]]
name = "push"
file = "push.toml"
x = "displacement_mm"
[cases.quantities]
force_N = "force_N"
[cases.touch_above]
force_N = 0.2
[cases.outcome]
touching = "series[middle].in_contact_at_end"
[[cases.refinements]]
set = { "solver.elements" = 32 }
[[cases.refinements]]
set = { "solver.elements" = 64 }
[[cases.models]]
name = "coarse"
set = { "solver.elements" = 16 }
[[cases.models]]
name = "heavy"
set = { "wire.axial_stiffness_N" = 200000.0, "solver.elements" = 32 }
)";

class BenchmarkCommand : public CommandFixture {
 protected:
  BenchmarkCommand() {
    write("push.toml", "schema = \"snare-experiment/1\"\ntitle = \"push\"\nsource = \"a test\"\n" +
                           test::wire_tables("176.0") + R"([[series]]
name = "middle"
contact_position_mm = 87.5
travel_mm = 3.0
points = 31
)");
    write("benchmark.toml", benchmark);
  }
  [[nodiscard]] nlohmann::json model(const std::string& out, std::size_t k) const {
    return parsed(out + "/benchmark.json")["cases"][0]["models"][k];
  }
};

TEST_F(BenchmarkCommand, ScoresModelsAndTheirHistoryOnAnArchivedOne) {
  ASSERT_EQ(run("benchmark benchmark.toml --archive"), 0) << contents("err.txt");
  const std::string archived = contents("references/push.csv");
  EXPECT_THAT(archived, HasSubstr("\ndisplacement_mm,force_N\n"));
  // Somebody's history: the archive's with a tenth more force, on every other row.
  std::string theirs = "force_N,other,displacement_mm\n";
  std::istringstream rows(archived);
  std::string row;
  for (int k = 0; std::getline(rows, row); ++k) {
    if (k < 2 || k % 2 == 1) continue;
    const std::size_t comma = row.find(',');
    theirs += std::to_string(1.1 * std::stod(row.substr(comma + 1))) + ",7," + row.substr(0, comma) + "\n";
  }
  write("theirs.csv", theirs);
  ASSERT_EQ(run("benchmark benchmark.toml --case push --against theirs.csv --out a"), 0)
      << contents("err.txt");
  const nlohmann::json their = model("a", 0), coarse = model("a", 1), heavy = model("a", 2);
  EXPECT_EQ(their["model"], "theirs.csv");
  EXPECT_NEAR(their["scores"]["force_N"]["peak"].get<double>(), 0.1, 1e-4);
  EXPECT_NEAR(their["scores"]["force_N"]["rms"].get<double>(), 0.1, 0.01);
  EXPECT_LT(std::abs(coarse["scores"]["force_N"]["peak"].get<double>()), 0.1);
  EXPECT_GT(std::abs(coarse["scores"]["force_N"]["peak"].get<double>()), 1e-6);
  EXPECT_LT(heavy["scores"]["force_N"]["peak"].get<double>(),
            -0.05);  // a softer wire than steel of this diameter
  EXPECT_EQ(coarse["outcome"]["touching"]["same"], true);
  const nlohmann::json answer = parsed("a/benchmark.json");
  EXPECT_EQ(answer["interrupted"], false);
  EXPECT_EQ(answer["cases"][0]["stale"], false);
  EXPECT_LT(std::abs(answer["cases"][0]["bars"]["force_N"]["peak"].get<double>()),
            std::abs(coarse["scores"]["force_N"]["peak"].get<double>()));
  EXPECT_THAT(contents("a/scores.csv"), HasSubstr("\npush,theirs.csv,done,force_N,0."));
  EXPECT_THAT(contents("a/report.html"), HasSubstr("theirs.csv"));
}

// A file that the archive was not made with is said to be another one; a damaged archive is not used.
TEST_F(BenchmarkCommand, KnowsItsArchive) {
  EXPECT_EQ(run("benchmark benchmark.toml --out a"), 2);
  EXPECT_THAT(contents("err.txt"),
              HasSubstr("references/push.csv: is missing: snare benchmark --archive makes it"));
  ASSERT_EQ(run("benchmark benchmark.toml --archive"), 0);
  const std::string made = contents("references/push.json");
  ASSERT_EQ(run("benchmark benchmark.toml --archive"), 0);
  write("push.toml", contents("push.toml") + "[solver]\nextrapolate = false\n");
  ASSERT_EQ(run("benchmark benchmark.toml --out a"), 0) << contents("err.txt");
  EXPECT_THAT(contents("err.txt"),
              HasSubstr("warning: push: the archived history was made from other input"));
  EXPECT_EQ(parsed("a/benchmark.json")["cases"][0]["stale"], true);
  write("references/push.json", made.substr(0, made.size() / 2));
  EXPECT_EQ(run("benchmark benchmark.toml --out a"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("references/push.json"));
  EXPECT_THAT(contents("err.txt"), HasSubstr("is damaged or of another case"));
}

TEST_F(BenchmarkCommand, WrongFilesAreToldBeforeAnythingRuns) {
  const auto complaint = [&](const std::string& was, const std::string& is) {
    std::string text = benchmark;
    text.replace(text.find(was), was.size(), is);
    write("wrong.toml", text);
    EXPECT_EQ(run("benchmark wrong.toml --archive"), 2) << is;
    return contents("err.txt");
  };
  EXPECT_THAT(complaint("force_N = \"force_N\"", "force_N = \"force_n\""),
              HasSubstr("did you mean force_N?"));
  EXPECT_THAT(complaint("\"solver.elements\" = 16", "\"solver.elemets\" = 16"),
              HasSubstr("wrong.toml, push, coarse: solver.elemets"));
  EXPECT_THAT(complaint("file = \"push.toml\"", "file = \"none.toml\""), HasSubstr("none.toml"));
  EXPECT_THAT(complaint("name = \"heavy\"", "name = \"coarse\""),
              HasSubstr("must not be that of another one"));
  EXPECT_THAT(complaint("name = \"push\"", "name = \"../push\""),
              HasSubstr("must be of letters, digits and _"));
  EXPECT_THAT(complaint("[[cases.refinements]]\nset = { \"solver.elements\" = 32 }\n", ""),
              HasSubstr("must be two or more, coarse to fine"));
  EXPECT_THAT(complaint("series[middle].in", "series[middle..in"),
              HasSubstr("must be a field of the result"));
  EXPECT_THAT(complaint("force_N = 0.2", "force_m = 0.2"), HasSubstr("unknown key"));
  EXPECT_FALSE(std::filesystem::exists(path("references")));
  EXPECT_EQ(run("benchmark benchmark.toml --case pusch --out a"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("did you mean push?"));
  EXPECT_EQ(run("benchmark benchmark.toml --against theirs.csv --out a"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("needs --case"));
  ASSERT_EQ(run("benchmark benchmark.toml --archive"), 0);
  write("theirs.csv", "displacement_mm\n0\n1\n");
  EXPECT_EQ(run("benchmark benchmark.toml --case push --against theirs.csv --out a"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("force_N"));
}

TEST_F(BenchmarkCommand, AnInterruptionKeepsWhatIsScored) {
  ASSERT_EQ(run("benchmark benchmark.toml --archive"), 0);
  std::string text = benchmark;
  for (int k = 0; k < 4; ++k)
    text += "[[cases.models]]\nname = \"fine_" + std::to_string(k) +
            "\"\nset = { \"solver.elements\" = 20000 }\n";
  write("benchmark.toml", text);
  const Ending ending = interrupt(start({"benchmark", "benchmark.toml", "--out", "a"}), 0.8);
  EXPECT_EQ(ending.status, 3);
  EXPECT_LT(ending.seconds, 2.0);
  EXPECT_THAT(contents("err.txt"), HasSubstr("of 6 models"));
  const nlohmann::json answer = parsed("a/benchmark.json");
  EXPECT_EQ(answer["interrupted"], true);
  EXPECT_EQ(answer["rows"]["asked"], 6);
}

}  // namespace
}  // namespace snare::app
