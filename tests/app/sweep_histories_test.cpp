#include "tests/app/small_sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <set>
#include <string>

namespace snare::app {
namespace {

using testing::HasSubstr;

/// What stands in the file is read by tests/python/histories_test.py.
class SweepHistories : public SmallSweep {
 protected:
  SweepHistories()
      : SmallSweep("179.0", "1.0", R"([histories]
columns = ["displacement_mm", "force_N", "series"]
)") {}
  [[nodiscard]] std::string histories(const std::string& out) const {
    return contents(std::filesystem::path(out) / "histories.h5");
  }
  /// Names in the folder of a sweep.
  [[nodiscard]] std::set<std::string> names(const std::string& out) const {
    std::set<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(path(out)))
      all.insert(entry.path().filename());
    return all;
  }
};

// Cases of which some are refused (a diameter below zero): they have no history, and cost the others nothing.
TEST_F(SweepHistories, SameBytesForAnyNumberOfThreads) {
  ASSERT_EQ(run("sweep sweep.toml --out a --threads 1"), 0) << contents("err.txt");
  ASSERT_EQ(run("sweep sweep.toml --out b --threads 3"), 0);
  EXPECT_GT(parsed("a/summary.json")["statuses"]["refused"], 0);
  EXPECT_EQ(parsed("a/summary.json")["histories"], "histories.h5");
  ASSERT_EQ(histories("a").substr(513, 3), "HDF");
  EXPECT_EQ(histories("a"), histories("b"));
  EXPECT_EQ(names("a"), (std::set<std::string>{"cases.csv", "cases.journal", "histories.h5", "report.html",
                                               "summary.json"}));
  // Once more: nothing is run and nothing written anew.
  const auto written = std::filesystem::last_write_time(path("a/histories.h5"));
  ASSERT_EQ(run("sweep sweep.toml --out a"), 0);
  EXPECT_EQ(std::filesystem::last_write_time(path("a/histories.h5")), written);
}

TEST_F(SweepHistories, WithoutTheTableThereIsNoFile) {
  write("sweep.toml", sweep.substr(0, sweep.find("[histories]")));
  ASSERT_EQ(run("sweep sweep.toml --out a"), 0);
  EXPECT_FALSE(exists("a/histories.h5"));
  EXPECT_FALSE(parsed("a/summary.json").contains("histories"));
}

// Kills at random moments of the cases and of the end, then an end in peace.
TEST_F(SweepHistories, KillsLoseNothing) {
  const std::string many = " --set cases=400 --threads 2";
  ASSERT_EQ(run("sweep sweep.toml --out whole" + many), 0) << contents("err.txt");
  std::mt19937 random(2);
  std::uniform_real_distribution<double> moment(0.05, 0.6);
  int kills = 0;
  for (; kills < 10; ++kills) {
    const pid_t child = start({"sweep", "sweep.toml", "--out", "a", "--set", "cases=400", "--threads", "2"});
    if (interrupt(child, moment(random), SIGKILL).status != -SIGKILL) break;
  }
  ASSERT_EQ(run("sweep sweep.toml --out a" + many), 0) << contents("err.txt");
  EXPECT_EQ(histories("a"), histories("whole"));
  EXPECT_EQ(contents("a/cases.csv"), contents("whole/cases.csv"));
  EXPECT_FALSE(exists("a/histories"));
  RecordProperty("kills", kills);
}

TEST_F(SweepHistories, WhatIsMissingOrDamagedIsRunAgain) {
  ASSERT_EQ(run("sweep sweep.toml --out whole"), 0);
  ASSERT_EQ(run("sweep sweep.toml --out a"), 0);
  std::filesystem::remove(path("a/histories.h5"));
  ASSERT_EQ(run("sweep sweep.toml --out a"), 0) << contents("err.txt");
  EXPECT_EQ(histories("a"), histories("whole"));

  // Whatever byte is another, and where the end is missing.
  for (const std::size_t at : {std::size_t{3}, std::size_t{520}, histories("whole").size() / 2}) {
    std::string other = histories("whole");
    other[at] = static_cast<char>(other[at] ^ 1);
    write("a/histories.h5", other);
    ASSERT_EQ(run("sweep sweep.toml --out a"), 0);
    EXPECT_THAT(contents("err.txt"), HasSubstr("a/histories.h5: is damaged, its cases are run again"));
    EXPECT_EQ(histories("a"), histories("whole"));
  }
  write("a/histories.h5", histories("whole").substr(0, 300));
  ASSERT_EQ(run("sweep sweep.toml --out a"), 0);
  EXPECT_EQ(histories("a"), histories("whole"));

  // Stopped with its parts, of which one is damaged and one is gone.
  const std::string many = " --threads 1 --set cases=600";
  ASSERT_EQ(run("sweep sweep.toml --out whole600 --set cases=600"), 0);
  const pid_t child = start({"sweep", "sweep.toml", "--out", "b", "--threads", "1", "--set", "cases=600"});
  for (int k = 0; k < 2000 && contents("b/cases.journal").size() < 2000; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (interrupt(child, 0.0).status == 0) GTEST_SKIP() << "the sweep was over before the signal";
  EXPECT_FALSE(exists("b/histories.h5"));
  const std::set<std::string> parts = names("b/histories");
  ASSERT_GT(parts.size(), 2U);
  std::string first = contents("b/histories/" + *parts.begin());
  first[first.size() - 12] = static_cast<char>(first[first.size() - 12] ^ 1);
  write("b/histories/" + *parts.begin(), first);
  std::filesystem::remove(path("b/histories/" + *parts.rbegin()));
  EXPECT_EQ(run("sweep sweep.toml --out b" + many), 1);
  EXPECT_THAT(contents("err.txt"), HasSubstr("is missing or damaged; the same command runs this case again"));
  ASSERT_EQ(run("sweep sweep.toml --out b" + many), 0) << contents("err.txt");
  EXPECT_EQ(histories("b"), histories("whole600"));
}

// A limit of the file's size stands for a disk that is full.
TEST_F(SweepHistories, AFullDiskKeepsWhatIsFinished) {
  const std::string many = " --set cases=600 --set histories.columns=\\\"all\\\"";
  ASSERT_EQ(run("sweep sweep.toml --out whole" + many), 0);
  constexpr std::size_t limit = 1200 * 512;  // in the shell's blocks; all other files are smaller
  ASSERT_GT(histories("whole").size(), limit);
  ASSERT_LT(contents("whole/report.html").size(), limit);
  EXPECT_EQ(
      shell("ulimit -f 1200; '" SNARE_COMMAND "' sweep sweep.toml --out a" + many + " >out.txt 2>err.txt"),
      1);
  EXPECT_THAT(contents("err.txt"), HasSubstr("a/histories.h5: cannot be written: File too large"));
  EXPECT_FALSE(exists("a/histories.h5"));
  EXPECT_FALSE(names("a/histories").empty());
  ASSERT_EQ(run("sweep sweep.toml --out a" + many), 0) << contents("err.txt");
  EXPECT_EQ(histories("a"), histories("whole"));
  // A part that cannot be written, here for a file instead of its folder.
  std::filesystem::create_directories(path("b"));
  write("b/histories", "in the way");
  EXPECT_EQ(run("sweep sweep.toml --out b"), 1);
  EXPECT_THAT(contents("err.txt"), HasSubstr("b/histories: cannot create the folder"));
  std::filesystem::remove(path("b/histories"));
  ASSERT_EQ(run("sweep sweep.toml --out b"), 0) << contents("err.txt");
  EXPECT_TRUE(exists("b/histories.h5"));
}

// A subset simulation numbers its cases from level to level.
TEST_F(SweepHistories, OfARareEvent) {
  write("sweep.toml", sweep + "[[limits]]\nof = \"force\"\nabove = 60.0\n");
  const std::string subset = " --set design=subset --set cases=100 --set vary[2].normal.sigma=0.05";
  ASSERT_EQ(run("sweep sweep.toml --out a --threads 1" + subset), 0) << contents("err.txt");
  ASSERT_EQ(run("sweep sweep.toml --out b --threads 2" + subset), 0);
  EXPECT_EQ(histories("a").substr(513, 3), "HDF");  // after the seal of 512 bytes
  EXPECT_EQ(histories("a"), histories("b"));
}

TEST_F(SweepHistories, WrongKeysAreRefusedBeforeAnythingRuns) {
  const auto refused = [&](const std::string& setting) {
    EXPECT_EQ(run("sweep sweep.toml --out a --set '" + setting + "'"), 2) << setting;
    return contents("err.txt");
  };
  EXPECT_THAT(refused("histories.columns=[\"farce_N\"]"),
              HasSubstr("must be a column of curves.csv; did you mean force_N?"));
  EXPECT_THAT(refused("histories.columns=[\"force_N\", \"force_N\"]"), HasSubstr("must not be named twice"));
  EXPECT_THAT(refused("histories.columns=\"some\""), HasSubstr("must be \"all\" or an array of names"));
  EXPECT_THAT(refused("histories.columns=[]"), HasSubstr("must have columns"));
  EXPECT_THAT(refused("histories.every=0"), HasSubstr("must be an integer >= 1 and <= 1000000"));
  EXPECT_THAT(refused("histories.evry=2"), HasSubstr("every"));
  EXPECT_THAT(refused("vary[1].name=\"status\""), HasSubstr("must not be case or status"));
  write("sweep.toml", R"(schema = "snare-sweep/1"
case = ")" SNARE_SOURCE_DIR R"(/data/wires/traced_published.toml"
design = "grid"
[[vary]]
key = "wire.length_mm"
values = [180.0]
[collect]
a = "a"
[histories]
columns = "all"
)");
  EXPECT_EQ(run("sweep sweep.toml --out a"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("must be left out: distil has no history"));
  EXPECT_FALSE(exists("a"));
}

}  // namespace
}  // namespace snare::app
