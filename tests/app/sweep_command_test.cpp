#include "tests/app/small_sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace snare::app {
namespace {

using testing::HasSubstr;

class SweepCommand : public SmallSweep {
 protected:
  SweepCommand()
      : SmallSweep("174.9", "0.01", R"(touching = "series[middle].in_contact_at_end"
[[limits]]
of = "force"
above = 50.0
)") {}
  [[nodiscard]] std::string cases(const std::string& out) const {
    return contents(std::filesystem::path(out) / "cases.csv");
  }
};

TEST_F(SweepCommand, SameBytesForAnyNumberOfThreads) {
  ASSERT_EQ(run("sweep sweep.toml --out a --threads 1"), 0) << contents("err.txt");
  ASSERT_EQ(run("sweep sweep.toml --out b --threads 3"), 0);
  EXPECT_EQ(cases("a"), cases("b"));
  const std::string csv = cases("a");
  EXPECT_THAT(csv, HasSubstr("case,status,reason,wire.length_mm,wire.diameter_mm,force,touching\n"));
  EXPECT_EQ(std::ranges::count(csv, '\n'), 61);
  const nlohmann::json summary = parsed("a/summary.json");
  EXPECT_EQ(summary["finished"], 60);
  EXPECT_EQ(summary["interrupted"], false);
  // A wire that is shorter than its span is a case of its own kind: whatever it comes to, it does so by
  // itself.
  EXPECT_EQ(summary["limits"]["force > 50"]["cases"], summary["statuses"]["done"]);
  EXPECT_TRUE(exists("a/report.html"));
}

// A line of cases.csv against the command that it stands for.
TEST_F(SweepCommand, ACaseRunsAloneWithTheSameResult) {
  ASSERT_EQ(run("sweep sweep.toml --out a"), 0);
  std::istringstream lines(cases("a"));
  std::string line;
  for (int k = 0; k <= 7; ++k) std::getline(lines, line);  // the header and seven cases
  ASSERT_EQ(line.substr(0, 7), "7,done,");
  ASSERT_EQ(run("sweep sweep.toml --out a --case 7 --json"), 0) << contents("err.txt");
  const nlohmann::json alone = parsed("out.txt");
  const std::string force = nlohmann::json(alone["series"][0]["largest_force_N"]).dump();
  EXPECT_THAT(line, HasSubstr("," + force + ",1"));
  EXPECT_TRUE(exists("a/case_7/curves.csv"));
  EXPECT_EQ(run("sweep sweep.toml --out a --case 61"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("must be from 1 to 60"));
}

TEST_F(SweepCommand, FailingCasesLoseOnlyThemselves) {
  ASSERT_EQ(run("sweep sweep.toml --out a --set vary[2].normal.sigma=1.0"), 0) << contents("err.txt");
  const nlohmann::json summary = parsed("a/summary.json");
  const std::string csv = cases("a");
  EXPECT_GT(summary["statuses"]["done"], 10);
  EXPECT_GT(summary["statuses"]["refused"], 0);  // a diameter below zero
  EXPECT_THAT(csv, HasSubstr(",refused,"));
  EXPECT_THAT(csv, HasSubstr("wire.diameter_mm"));
  EXPECT_EQ(csv.find("nan"), std::string::npos);
  EXPECT_THAT(contents("err.txt"), HasSubstr("have no result"));
}

TEST_F(SweepCommand, WrongFilesWriteNothing) {
  EXPECT_EQ(run("sweep sweep.toml --out a --set collect.force=series[middle].largest_farce_N"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("there are: "));
  EXPECT_EQ(run("sweep sweep.toml --out a --set vary[1].key=wire.lenght_mm"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("wire.lenght_mm"));
  EXPECT_EQ(run("sweep sweep.toml --out a --set verb=simulate"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("push, fit, trace"));
  EXPECT_EQ(run("sweep one.toml --out a"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("snare-sweep/1"));
  EXPECT_FALSE(exists("a"));
}

TEST_F(SweepCommand, GoesOnAfterAnInterruption) {
  write("sweep.toml", std::string(sweep).replace(sweep.find("cases = 60"), 10, "cases = 600"));
  ASSERT_EQ(run("sweep sweep.toml --out whole"), 0);
  const pid_t child = start({"sweep", "sweep.toml", "--out", "a", "--threads", "1"});
  const Ending ending = interrupt(child, 0.4);
  if (ending.status == 0) GTEST_SKIP() << "the sweep was over before the signal";
  EXPECT_EQ(ending.status, 3);
  EXPECT_LT(ending.seconds, 1.0);
  EXPECT_THAT(contents("err.txt"), HasSubstr("the same command goes on"));
  ASSERT_EQ(run("sweep sweep.toml --out a"), 0);
  EXPECT_THAT(contents("err.txt"), HasSubstr("goes on from a/cases.journal"));
  EXPECT_EQ(cases("a"), cases("whole"));
}

// A case that ends the process costs itself, once: what is finished is kept, and the same command continues
// with the others.
TEST_F(SweepCommand, ACaseThatEndsTheProcessIsNotRunAgain) {
  const std::string many = " --threads 1 --set cases=600";
  ASSERT_EQ(run("sweep sweep.toml --out whole" + many), 0);
  // A signal from outside may come between two cases, and is then no case's fault: the next try continues
  // from there.
  std::string said;
  for (int tries = 0; tries < 10 && said.find(" ended the process by SIGSEGV") == std::string::npos;
       ++tries) {
    const std::size_t enough = contents("a/cases.journal").size() + 2000;
    const pid_t child = start({"sweep", "sweep.toml", "--out", "a", "--threads", "1", "--set", "cases=600"});
    for (int k = 0; k < 400 && contents("a/cases.journal").size() < enough; ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const Ending ending = interrupt(child, 0.0, SIGSEGV);
    if (ending.status == 0) GTEST_SKIP() << "the sweep was over before the signal";
    EXPECT_EQ(ending.status, -SIGSEGV);
    said = contents("err.txt");
  }
  ASSERT_THAT(said, HasSubstr(" ended the process by SIGSEGV"));
  const std::size_t at = said.rfind("\ncase ") + 6;
  const std::string number = said.substr(at, said.find(' ', at) - at);
  ASSERT_EQ(run("sweep sweep.toml --out a" + many), 0) << contents("err.txt");
  EXPECT_THAT(contents("err.txt"), HasSubstr("goes on from"));
  EXPECT_THAT(contents("err.txt"), HasSubstr("1 of 600 cases have no result"));
  EXPECT_EQ(parsed("a/summary.json")["statuses"]["crashed"], 1);
  std::istringstream left(cases("a")), right(cases("whole"));
  std::string one, other;
  while (std::getline(left, one) && std::getline(right, other)) {
    if (one == other) continue;
    EXPECT_THAT(one, testing::StartsWith(number + ",crashed,the process ended in this case by SIGSEGV,"));
  }
  EXPECT_EQ(run("sweep sweep.toml --out a --case " + number + " --set cases=600"), 0);
}

TEST_F(SweepCommand, AChangedInputIsRefusedAndNothingIsLost) {
  ASSERT_EQ(run("sweep sweep.toml --out a"), 0);
  const std::string before = cases("a"), journal = contents("a/cases.journal");
  EXPECT_EQ(run("sweep sweep.toml --out a --set seed=2"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("belongs to another study"));
  write("one.toml", push + "instability = \"follow_path\"\n");
  EXPECT_EQ(run("sweep sweep.toml --out a"), 2);
  write("one.toml", "# a comment\n" + push);
  EXPECT_EQ(run("sweep sweep.toml --out a"), 0) << contents("err.txt");
  EXPECT_EQ(cases("a"), before);
  EXPECT_EQ(contents("a/cases.journal"), journal);
}

TEST_F(SweepCommand, TwoSweepsDoNotShareAFolder) {
  const pid_t child = start({"sweep", "sweep.toml", "--out", "a", "--set", "cases=3000"});
  for (int k = 0; k < 200 && !exists("a/cases.journal"); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(shell("'" SNARE_COMMAND "' sweep sweep.toml --out a --set cases=3000 >o2 2>e2"), 2);
  EXPECT_THAT(contents("e2"), HasSubstr("is writing into this one"));
  static_cast<void>(interrupt(child, 0.0, SIGKILL));
}

// A limit of the file's size stands for a disk that is full: the journal ends with a whole line, and the
// sweep continues with room.
TEST_F(SweepCommand, AFullDiskKeepsWhatIsFinished) {
  ASSERT_EQ(run("sweep sweep.toml --out whole --set cases=300"), 0);
  EXPECT_EQ(
      shell("ulimit -f 8; '" SNARE_COMMAND "' sweep sweep.toml --out a --set cases=300 >out.txt 2>err.txt"),
      1);
  EXPECT_THAT(contents("err.txt"), HasSubstr("a/cases.journal: cannot be written"));
  EXPECT_EQ(contents("a/cases.journal").back(), '\n');
  ASSERT_EQ(run("sweep sweep.toml --out a --set cases=300"), 0);
  EXPECT_THAT(contents("err.txt"), HasSubstr("goes on from"));
  EXPECT_EQ(contents("err.txt").find("damaged"), std::string::npos);
  EXPECT_EQ(cases("a"), cases("whole"));
}

// A fit of records is a case, too: the one that begins where the record did has its damping, the others are
// off and say so.
TEST_F(SweepCommand, RecordsAreCases) {
  write("records.toml", R"(schema = "snare-sweep/1"
title = "where the swing began"
case = ")" SNARE_SOURCE_DIR R"(/tests/ranges/record.toml"
verb = "trace"
design = "grid"
[[vary]]
key = "scenario.arms[pendulum].angles_deg[1]"
name = "angle_deg"
values = [88.0, 90.0]
[collect]
damping = "base.parameters[arms[pendulum].joint.bearing.viscous_Nms_rad].value"
explained = "explained"
[histories]
columns = "all"
)");
  ASSERT_EQ(run("sweep records.toml --out a"), 0) << contents("err.txt");
  std::istringstream lines(cases("a"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "case,status,reason,angle_deg,damping,explained");
  std::getline(lines, line);
  EXPECT_EQ(line.substr(0, 10), "1,done,,88");
  EXPECT_EQ(line.back(), '0');
  std::getline(lines, line);
  EXPECT_EQ(line.substr(0, 10), "2,done,,90");
  EXPECT_EQ(line.back(), '1');
  EXPECT_TRUE(exists("a/histories.h5"));
  ASSERT_EQ(run("sweep records.toml --out a --case 2 --json"), 0) << contents("err.txt");
  const nlohmann::json alone = parsed("out.txt");
  const double damping = alone["base"]["parameters"]["arms[pendulum].joint.bearing.viscous_Nms_rad"]["value"];
  EXPECT_EQ(line, "2,done,,90," + nlohmann::json(damping).dump() + ",1");
  EXPECT_EQ(run("sweep records.toml --out b --set verb=push"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("must be one of fit, trace for a file of snare-record/1"));
}

/// Lines of a table by the number of their case, cells without quotes around them.
std::map<int, std::vector<std::string>> rows_of(const std::string& csv) {
  std::map<int, std::vector<std::string>> rows;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"')
        quoted = !quoted;
      else if (c == ',' && !quoted)
        cells.emplace_back();
      else
        cells.back() += c;
    }
    rows[std::stoi(cells.front())] = cells;
  }
  return rows;
}

// A refined grid against the same grid without refinement: what was run is equal, what is inferred is as near
// as was asked for.
TEST_F(SweepCommand, ARefinedGrid) {
  const auto grid = [](const std::string& more) {
    return R"(schema = "snare-sweep/1"
case = "one.toml"
design = "grid"
[[vary]]
key = "wire.length_mm"
range = [175.5, 181.0]
points = 17
[[vary]]
key = "wire.diameter_mm"
range = [-0.5, 1.5]
points = 9
[collect]
force = "series[middle].largest_force_N"
touching = "series[middle].in_contact_at_end"
)" + more;
  };
  const std::string refine = "[refine]\nof = \"force\"\nlevels = 2\ndiffers_by = 8.0\n";
  write("plain.toml", grid(""));
  write("refined.toml", grid(refine));
  ASSERT_EQ(run("sweep plain.toml --out plain"), 0) << contents("err.txt");
  ASSERT_EQ(run("sweep refined.toml --out a --threads 1"), 0) << contents("err.txt");
  const auto plain = rows_of(cases("plain")), refined = rows_of(cases("a"));
  ASSERT_EQ(plain.size(), 153U);
  ASSERT_EQ(refined.size(), 153U);
  int inferred = 0, words = 0;
  for (const auto& [number, row] : refined) {
    const std::vector<std::string>& whole = plain.at(number);
    if (row[1] != "inferred") {
      EXPECT_EQ(row, whole);
      continue;
    }
    ++inferred;
    EXPECT_EQ(row[3], whole[3]);
    EXPECT_EQ(row[4], whole[4]);
    EXPECT_EQ(row[6], "");  // nothing is said of other fields
    if (row[2].empty()) {
      EXPECT_EQ(whole[1], "done");
      EXPECT_NEAR(std::stod(row[5]), std::stod(whole[5]), 8.0);
    } else {
      ++words;
      EXPECT_EQ(row[2], "around it: " + whole[1]);  // a diameter below zero is refused
    }
  }
  EXPECT_GT(words, 10);
  EXPECT_GT(inferred - words, 10);
  const nlohmann::json summary = parsed("a/summary.json");
  EXPECT_EQ(summary["cases"], 153);
  EXPECT_EQ(summary["finished"], 153 - inferred);
  EXPECT_EQ(summary["statuses"]["inferred"], inferred);
  EXPECT_EQ(summary["interrupted"], false);
  EXPECT_EQ(std::ranges::count(contents("a/cases.journal"), '\n'), 154 - inferred);
  EXPECT_THAT(contents("a/report.html"), HasSubstr("The grid is refined where force changes"));

  // Threads, and kills at any moment.
  ASSERT_EQ(run("sweep refined.toml --out b --threads 3"), 0);
  EXPECT_EQ(cases("b"), cases("a"));
  for (int kills = 0; kills < 5; ++kills)
    static_cast<void>(
        interrupt(start({"sweep", "refined.toml", "--out", "c", "--threads", "2"}), 0.06, SIGKILL));
  ASSERT_EQ(run("sweep refined.toml --out c"), 0) << contents("err.txt");
  EXPECT_EQ(cases("c"), cases("a"));

  // A case that was not run can be, alone.
  const auto one = std::ranges::find_if(refined, [](const auto& row) { return row.second[1] == "inferred"; });
  const int status = run("sweep refined.toml --out a --case " + std::to_string(one->first));
  EXPECT_EQ(status, one->second[2].empty() ? 0 : 2);
}

TEST_F(SweepCommand, ARareEventByLevels) {
  ASSERT_EQ(
      run("sweep sweep.toml --out a --set design=subset --set cases=100 --set vary[1].uniform=[179,181] "
          "--set limits[1].above=40"),
      0)
      << contents("err.txt");
  const nlohmann::json failure = parsed("a/summary.json")["failure"];
  EXPECT_GT(failure["levels"].size(), 0U);
  EXPECT_GT(failure["probability"], 0.0);
  const std::string before = cases("a");
  ASSERT_EQ(run("sweep sweep.toml --out b --threads 1 --set design=subset --set cases=100 --set "
                "vary[1].uniform=[179,181] "
                "--set limits[1].above=40"),
            0);
  EXPECT_EQ(cases("b"), before);
  EXPECT_EQ(run("sweep sweep.toml --out a --case 3 --set design=subset --set cases=100 --set "
                "vary[1].uniform=[179,181] "
                "--set limits[1].above=40"),
            0);
}

// A hundred kills at random moments, then an end in peace: same bytes, no case twice or lost.
class SlowSweep : public SweepCommand {};

TEST_F(SlowSweep, AHundredKillsLoseNothing) {
  const std::string many = "cases=20000";
  ASSERT_EQ(run("sweep sweep.toml --out whole --set " + many), 0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> moment(0.02, 0.5);
  int kills = 0;
  for (; kills < 100; ++kills) {
    const pid_t child = start({"sweep", "sweep.toml", "--out", "a", "--set", many});
    if (interrupt(child, moment(random), SIGKILL).status != -SIGKILL) break;
  }
  ASSERT_EQ(run("sweep sweep.toml --out a --set " + many), 0) << contents("err.txt");
  EXPECT_EQ(cases("a"), cases("whole"));
  RecordProperty("kills", kills);
  std::istringstream journal(contents("a/cases.journal"));
  std::set<std::string> numbers;
  std::string line;
  std::getline(journal, line);
  while (std::getline(journal, line))
    EXPECT_TRUE(numbers.insert(line.substr(0, line.find(' '))).second) << line;
  EXPECT_EQ(numbers.size(), 20000U);
}

}  // namespace
}  // namespace snare::app
