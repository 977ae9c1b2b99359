// Every write, flush, sync, close and rename of a run fails once: the status says so, and no file is half.

#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace snare::app {
namespace {

namespace fs = std::filesystem;

class Faults : public CommandFixture {
 protected:
  using Files = std::map<std::string, std::string>;

  [[nodiscard]] Files files(const std::string& out) const {
    Files all;
    if (!fs::exists(folder_ / out)) return all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / out)) {
      if (entry.is_regular_file())
        all[fs::relative(entry.path(), folder_ / out).string()] = contents(entry.path());
    }
    return all;
  }

  struct Failed {
    int status = 0;
    bool met = false;  ///< there was such a call
  };
  [[nodiscard]] Failed failing(const std::string& call, int at, const std::string& arguments,
                               const std::string& to = "--out failed >out.txt 2>err.txt") const {
    fs::remove(path("note"));
    const int status = shell("export ASAN_OPTIONS=verify_asan_link_order=0 SNARE_FAIL_CALL=" + call +
                             " SNARE_FAIL_AT=" + std::to_string(at) +
                             " SNARE_FAIL_NOTE=note; LD_PRELOAD='" SNARE_FAIL_NTH "' '" SNARE_COMMAND "' " +
                             arguments + " " + to);
    return {status, fs::exists(path("note"))};
  }

  /// That a file which a failed run has left is a whole one.
  static void expect_whole(const std::string& name, const std::string& text, const Files& whole) {
    ASSERT_TRUE(whole.contains(name)) << "is left";
    if (name.ends_with(".json"))  // times of the clock are in it
      EXPECT_TRUE(nlohmann::json::accept(text));
    else if (name.ends_with(".html"))
      EXPECT_TRUE(text.ends_with("</html>\n"));
    else if (name == "scores.csv")  // the last column is one of them
      EXPECT_EQ(text.substr(0, text.rfind(',')), whole.at(name).substr(0, whole.at(name).rfind(',')));
    else
      EXPECT_EQ(text, whole.at(name));
  }

  /// The call that this run makes for the `at`-th time fails; false where it makes none. `spared`: a file
  /// whose failure costs its own use only; `kept`: one that grows, in which everything up to the failure may
  /// stand.
  bool expect_promise(const std::string& call, int at, const std::string& arguments, const Files& whole,
                      const std::string& spared, const std::string& kept) {
    SCOPED_TRACE(call + " " + std::to_string(at));
    fs::remove_all(folder_ / "failed");
    const Failed end = failing(call, at, arguments);
    if (!end.met) {
      EXPECT_EQ(end.status, 0) << contents("err.txt");
      EXPECT_EQ(files("failed").size(), whole.size());
      return false;
    }
    const std::string said = contents("err.txt");
    const Files left = files("failed");
    for (const auto& [name, text] : left) {
      SCOPED_TRACE(name);
      if (name != spared && name != kept && !(name.starts_with("histories/") && name.ends_with(".part")))
        expect_whole(name, text, whole);
    }
    if (end.status != 0) {
      EXPECT_EQ(end.status, 1) << said;
      EXPECT_NE(said.find("No space left on device"), std::string::npos) << said;
    } else {  // what cannot be emptied or synchronised for the disk's sake alone is no part of a result
      EXPECT_EQ(left.size(), whole.size()) << said;
      EXPECT_TRUE(call == "ftruncate" || said.find("No space left on device") != std::string::npos) << said;
      EXPECT_TRUE(call == "ftruncate" || !spared.empty()) << said;
    }
    if (!kept.empty()) {  // the same command continues from what it has
      EXPECT_EQ(run(arguments + " --out failed"), 0) << contents("err.txt");
      for (const auto& [name, text] : files("failed")) {
        SCOPED_TRACE(name + " of the run that went on");
        if (name != kept) expect_whole(name, text, whole);
      }
      EXPECT_EQ(files("failed").size(), whole.size());
    }
    return true;
  }

  /// `every`: one call in so many of each kind; `stride`: of those that write a log line by line.
  void expect_promises(const std::string& arguments, const std::string& spared = "",
                       const std::string& kept = "", int every = 1, int stride = 1) {
    fs::remove_all(folder_ / "whole");
    ASSERT_EQ(run(arguments + " --out whole"), 0) << contents("err.txt");
    const Files whole = files("whole");
    int found = 0;
    for (const char* call : {"fopen", "fwrite", "fflush", "fsync", "fclose", "rename", "mkdir", "write",
                             "pwrite", "ftruncate", "fdatasync"}) {
      constexpr int most = 300;  // more calls than any of these runs makes
      const int step = std::string_view(call) == "fwrite" || std::string_view(call) == "fflush"
                           ? std::max(every, stride)
                           : every;
      int at = 1;
      for (; at < most && !HasFatalFailure(); at += step, ++found) {
        if (!expect_promise(call, at, arguments, whole, spared, kept)) break;
      }
      ASSERT_LT(at, most) << call;
    }
    EXPECT_GE(found, 6) << "the calls of a run were not met";
  }
  /// A result that standard output does not take is a failure, too.
  void expect_full(const std::string& arguments) const {
    EXPECT_EQ(shell("'" SNARE_COMMAND "' " + arguments + " --json >/dev/full 2>err.txt"), 1) << arguments;
    EXPECT_NE(contents("err.txt").find("standard output: cannot be written"), std::string::npos)
        << contents("err.txt");
  }
  /// Those of the range test, which are small.
  [[nodiscard]] static std::string small(const std::string& name) {
    return "'" SNARE_SOURCE_DIR "/tests/ranges/" + name + "' --quiet --threads 1";
  }
  [[nodiscard]] static std::string shipped(const std::string& name) {
    return "'" SNARE_SOURCE_DIR "/data/" + name + "' --quiet --threads 1";
  }
};

TEST_F(Faults, Push) {
  write("x.toml",
        "schema = \"snare-experiment/1\"\ntitle = \"test\"\nsource = \"none\"\n" +
            test::wire_tables("180.0") +
            "[solver]\nelements = 16\n[[series]]\nname = \"s\"\ncontact_position_mm = 60.0\ntravel_mm = "
            "1.0\npoints = 3\n");
  expect_promises("push x.toml --quiet");
}

// A journal of curves that cannot be written costs the way back to them, not the run. Of each kind the call
// that is the journal's first (the wire file is closed before); all calls of all kinds would take minutes.
TEST_F(Faults, DistilGoesOnWithoutAJournal) {
  const std::string distil = "distil '" SNARE_SOURCE_DIR "/tests/ranges/wire.toml' --quiet";
  ASSERT_EQ(run(distil + " --out whole"), 0) << contents("err.txt");
  const Files whole = files("whole");
  const std::map<std::string, int> first{{"fwrite", 1}, {"fflush", 1}, {"fclose", 2}};
  for (const auto& [call, at] : first) {
    fs::remove_all(folder_ / "failed");
    EXPECT_EQ(failing(call, at, distil).status, 0) << call;
    const std::string said = contents("err.txt");
    EXPECT_NE(
        said.find(
            "failed/distil.journal: cannot be written: No space left on device; goes on, but a run that is "
            "interrupted begins anew"),
        std::string::npos)
        << call << ": " << said;
    const Files left = files("failed");
    EXPECT_EQ(left.size(), whole.size()) << call;
    EXPECT_EQ(left.at("table.csv"), whole.at("table.csv")) << call;
    EXPECT_FALSE(left.contains("distil.journal")) << call;
  }
}

TEST_F(Faults, NewLeavesNoPartOfASet) {
  for (const char* call : {"fopen", "fwrite", "fflush", "fsync", "fclose", "rename", "mkdir"}) {
    for (int at = 1;; ++at) {
      SCOPED_TRACE(std::string(call) + " " + std::to_string(at));
      ASSERT_LT(at, 100);
      fs::remove_all(folder_ / "failed");
      const Failed end = failing(call, at, "new capture --quiet");
      if (!end.met) break;
      EXPECT_EQ(end.status, 1);
      EXPECT_NE(contents("err.txt").find("No space left on device"), std::string::npos)
          << contents("err.txt");
      EXPECT_TRUE(files("failed").empty());
      EXPECT_EQ(run("new capture --quiet --out failed"), 0) << contents("err.txt");
    }
  }
}

TEST_F(Faults, ArmShowsWhatStandardOutputTakes) {
  expect_full("arm show '" SNARE_SOURCE_DIR "/data/arms/jemrms_like.toml'");
}

class SlowFaults : public Faults {
 protected:
  // The same files, without a search for effects.
  static constexpr const char* quick = " --set solver.extrapolate=false --set fit.model_tolerance=0.5";
};

TEST_F(SlowFaults, RingDown) {
  expect_promises("ringdown " + shipped("experiments/ringdown.toml"));
  expect_full("ringdown " + shipped("experiments/ringdown.toml") + " --out whole");
}

TEST_F(SlowFaults, Fit) {
  expect_promises("fit " + small("readings.toml"));
  expect_promises("fit " + small("record.toml"));
  expect_full("fit " + small("record.toml") + " --out whole");
}

TEST_F(SlowFaults, Trace) {
  expect_promises("trace " + small("readings.toml") + quick);
}

TEST_F(SlowFaults, TraceOfRecords) {
  expect_promises("trace " + small("record.toml"));
}

TEST_F(SlowFaults, Reproduce) {
  expect_promises("reproduce " + small("readings.toml") + quick);
}

TEST_F(SlowFaults, Compare) {
  expect_promises("compare " + small("wire.toml"));
  expect_promises("compare " + shipped("scenarios/snare_on_pin.toml") +
                  " --set duration_s=0.002 --set snares[snare].wire.elements=8 --set phases[close].at_s=0");
}

TEST_F(SlowFaults, Distil) {
  expect_promises("distil " + small("wire.toml"), "distil.journal", "", 2, 41);
}

TEST_F(SlowFaults, SimulateAnArm) {
  const std::string arm = "simulate " + shipped("scenarios/jemrms_step.toml") + " --set duration_s=0.2";
  expect_promises(arm);
  expect_full(arm + " --out whole");
}

TEST_F(SlowFaults, SweepGoesOnFromItsJournal) {
  expect_promises("sweep " + small("sweep.toml"), "", "cases.journal");
}

TEST_F(SlowFaults, HistoriesOfASweep) {
  expect_promises("sweep " + small("sweep.toml") + " --set 'histories.columns=\"all\"'", "", "cases.journal");
}

TEST_F(SlowFaults, Benchmark) {
  write("push.toml", "schema = \"snare-experiment/1\"\ntitle = \"test\"\nsource = \"none\"\n" +
                         test::wire_tables("180.0") +
                         "[solver]\nelements = 32\n[[series]]\nname = \"s\"\ncontact_position_mm = "
                         "60.0\ntravel_mm = 3.0\npoints = 11\n");
  const std::string text = R"(schema = "snare-benchmark/1"
title = "pushes"
[[cases]]
name = "push"
file = "push.toml"
x = "displacement_mm"
[cases.quantities]
force_N = "force_N"
[[cases.refinements]]
set = { "solver.elements" = 16 }
[[cases.refinements]]
[[cases.models]]
name = "coarse"
set = { "solver.elements" = 16 }
)";
  write("benchmark.toml", text);
  ASSERT_EQ(run("benchmark benchmark.toml --archive"), 0) << contents("err.txt");
  expect_promises("benchmark benchmark.toml --quiet --threads 1");
  // An archive that could not be made anew is the one before, a new one, or refused: never of both.
  const Files before = files("references");
  std::string other = text;
  other.replace(other.find("= 16 }"), 6, "= 24 }");
  write("other.toml", other);
  ASSERT_EQ(run("benchmark other.toml --archive"), 0);
  const Files after = files("references");
  for (const char* call : {"fopen", "fwrite", "fflush", "fsync", "fclose", "rename"}) {
    for (int at = 1;; ++at) {
      SCOPED_TRACE(std::string(call) + " " + std::to_string(at));
      ASSERT_LT(at, 100);
      for (const auto& [name, bytes] : before) write("references/" + name, bytes);
      const Failed end = failing(call, at, "benchmark other.toml --archive", ">out.txt 2>err.txt");
      if (!end.met) break;
      EXPECT_EQ(end.status, 1);
      EXPECT_NE(contents("err.txt").find("No space left on device"), std::string::npos)
          << contents("err.txt");
      const Files now = files("references");
      EXPECT_EQ(now.size(), before.size());
      const bool same =
          now.at("push.csv") == before.at("push.csv") && now.at("push.json") == before.at("push.json");
      EXPECT_EQ(run("benchmark benchmark.toml --out scored"), same ? 0 : 2) << contents("err.txt");
    }
  }
}

// Its rows take minutes; what it has when it is told to end is written like all of them.
TEST_F(SlowFaults, ValidateWritesItsPartOrSaysWhyNot) {
  for (const char* call : {"fopen", "fwrite", "fflush", "fsync", "fclose", "rename"}) {
    for (int at = 1; at <= 2; ++at) {
      SCOPED_TRACE(std::string(call) + " " + std::to_string(at));
      fs::remove_all(folder_ / "failed");
      const Failed end = failing(call, at, "validate --quiet",
                                 "--out failed >out.txt 2>err.txt & sleep 3; kill -INT $!; wait $!");
      ASSERT_TRUE(end.met);
      EXPECT_TRUE(end.status == 1 || end.status == 3) << end.status;
      EXPECT_NE(contents("err.txt").find("No space left on device"), std::string::npos)
          << contents("err.txt");
      for (const auto& [name, text] : files("failed"))
        EXPECT_TRUE(name.ends_with(".html") ? text.ends_with("</html>\n") : nlohmann::json::accept(text))
            << name;
    }
  }
}

// A checkpoint that cannot be written costs the way back to it.
TEST_F(SlowFaults, SimulateGoesOnWithoutACheckpoint) {
  expect_promises("simulate '" SNARE_SOURCE_DIR
                  "/data/scenarios/air_table.toml' --quiet --set duration_s=0.004 "
                  "--set wires[wire].elements=8 --set output.checkpoint_interval_s=0.002 "
                  "--set output.checkpoint_wall_time_s=0",
                  "checkpoint.bin");
}

}  // namespace
}  // namespace snare::app
