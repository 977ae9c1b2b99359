// Inputs are read once and never overwritten; standard streams that take nothing lose no result.

#include "tests/app/small_sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/inotify.h>

#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <map>
#include <string>

namespace snare::app {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class KeptInputs : public SmallSweep {
 protected:
  KeptInputs() : SmallSweep("179.0", "0.01", "") {
    fs::create_directories(path("in"));
    write("in/one.toml", push);
    write("in/sweep.toml", sweep);
    std::string rows = "time_s,displacement_mm\n";
    for (int i = 0; i < 200; ++i) {
      const double t = 2e-3 * i;
      rows += std::to_string(t) + "," + std::to_string(std::exp(-3.0 * t) * std::cos(200.0 * t)) + "\n";
    }
    write("in/ringdown.csv", rows);
    write("in/ringdown.toml", R"(schema = "snare-ringdown/1"
title = "t"
[[series]]
name = "a"
file = "ringdown.csv"
)");
    std::string curve = "displacement_mm,force_N\n";
    for (int i = 0; i < 12; ++i) curve += std::to_string(0.1 * i) + "," + std::to_string(0.3 * i) + "\n";
    write("in/curves.csv", curve);
    write("in/measured.toml", push.substr(0, push.find("travel_mm")) +
                                  "file = \"curves.csv\"\nforce_sigma_N = 0.1\n" +
                                  "[solver]\nelements = 16\n[fit]\nfree = [\"wire.length_mm\"]\n");
    write("in/wire.csv", "time_s,x_mm\n0,0\n0.01,1\n");
    write("in/fall.toml", R"(schema = "snare-scenario/2"
title = "t"
source = "t"
duration_s = 0.01
[[bodies]]
name = "ball"
mass_kg = 1.0
inertia_kg_m2 = [0.1, 0.1, 0.1]
)");
    write("in/drop.toml", contents("in/fall.toml") + R"(position_mm = [-10.0, 0.0, 50.0]
velocity_m_s = [1.0, 0.0, 0.0]
[[shapes]]
name = "round"
body = "ball"
kind = "sphere"
radius_mm = 3.0
[[wires]]
name = "a"
construction = "solid"
diameter_mm = 1.5
length_mm = 100.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
from_mm = [0.0, 0.0, 0.0]
to_mm = [0.0, 0.0, 99.0]
bulge = [1.0, 0.0, 0.0]
mount = "pinned"
elements = 12
)");
  }

  /// How often each file of the folder "in" is opened while a line of the shell runs.
  [[nodiscard]] std::map<std::string, int> opens_of(const std::string& arguments) const {
    const int watch = ::inotify_init1(IN_NONBLOCK);
    ::inotify_add_watch(watch, path("in").c_str(), IN_OPEN);
    EXPECT_EQ(run(arguments), 0) << contents("err.txt");
    std::map<std::string, int> opens;
    alignas(inotify_event) std::array<char, 1 << 16> buffer{};
    for (ssize_t size = 0; (size = ::read(watch, buffer.data(), buffer.size())) > 0;) {
      for (const char* at = buffer.data(); at < buffer.data() + size;) {
        const auto* event = reinterpret_cast<const inotify_event*>(at);
        if (event->len > 0) ++opens[event->name];
        at += sizeof(inotify_event) + event->len;
      }
    }
    ::close(watch);
    return opens;
  }
};

TEST_F(KeptInputs, EveryVerbOpensThemOnceAndNamesThem) {
  const std::pair<std::string, std::map<std::string, int>> verbs[] = {
      {"push in/one.toml", {{"one.toml", 1}}},
      {"fit in/measured.toml", {{"measured.toml", 1}, {"curves.csv", 1}}},
      {"trace in/measured.toml", {{"measured.toml", 1}, {"curves.csv", 1}}},
      {"ringdown in/ringdown.toml", {{"ringdown.toml", 1}, {"ringdown.csv", 1}}},
      {"simulate in/fall.toml", {{"fall.toml", 1}}},
      {"compare in/one.toml", {{"one.toml", 1}}},
      {"compare in/drop.toml", {{"drop.toml", 1}}},
      {"sweep in/sweep.toml --threads 2", {{"sweep.toml", 1}, {"one.toml", 1}}},
  };
  for (const auto& [arguments, opens] : verbs) {
    SCOPED_TRACE(arguments);
    EXPECT_EQ(opens_of(arguments + " --json --out out"), opens);
    std::map<std::string, int> named;
    const nlohmann::json document = parsed("out.txt");
    for (const auto& input : document["inputs"]) {
      ++named[fs::path(input["file"].get<std::string>()).filename().string()];
      ASSERT_EQ(shell("sha256sum " + input["file"].get<std::string>() + " >sum.txt"), 0);
      EXPECT_EQ(contents("sum.txt").substr(0, 64), input["sha256"]);
    }
    EXPECT_EQ(named, opens);
    fs::remove_all(path("out"));
  }
}

TEST_F(KeptInputs, AreNotOverwritten) {
  const std::string readings = contents("in/ringdown.csv"), curves = contents("in/curves.csv");
  EXPECT_EQ(run("ringdown in/ringdown.toml --out in"), 2);
  EXPECT_THAT(contents("err.txt"), HasSubstr("ringdown.csv would overwrite this input"));
  EXPECT_EQ(contents("in/ringdown.csv"), readings);
  for (const std::string verb : {"push", "fit", "trace", "reproduce"}) {
    EXPECT_EQ(run(verb + " in/measured.toml --out in"), 2) << verb;
    EXPECT_EQ(contents("in/curves.csv"), curves) << verb;
  }
  // Behind a link, and by another name of the folder.
  fs::create_symlink(path("in"), path("also"));
  EXPECT_EQ(run("ringdown in/ringdown.toml --out also"), 2);
  fs::create_directories(path("real"));
  fs::rename(path("in/ringdown.csv"), path("real/ringdown.csv"));
  fs::create_symlink(path("real/ringdown.csv"), path("in/ringdown.csv"));
  EXPECT_EQ(run("ringdown in/ringdown.toml --out real"), 2);
  EXPECT_EQ(contents("real/ringdown.csv"), readings);
  EXPECT_EQ(run("ringdown in/ringdown.toml --out other"), 0) << contents("err.txt");
}

TEST_F(KeptInputs, OutOnAFileIsWrongInput) {
  write("file", "in the way");
  for (const std::string verb :
       {"push in/one.toml", "ringdown in/ringdown.toml", "sweep in/sweep.toml", "simulate in/fall.toml",
        "compare in/one.toml", "fit in/measured.toml", "new wire", "validate"}) {
    EXPECT_EQ(run(verb + " --out file"), 2) << verb;
    EXPECT_EQ(run(verb + " --out file/below"), 2) << verb;
  }
  EXPECT_EQ(contents("file"), "in the way");
}

// Full, closed and without a reader: errors and progress are lost, results are not; a result that is asked
// for on standard output fails where that takes nothing.
TEST_F(KeptInputs, StandardStreams) {
  const std::string command = "'" SNARE_COMMAND "' ";
  ASSERT_EQ(run("sweep in/sweep.toml --out whole"), 0) << contents("err.txt");
  for (const std::string verb : {"push in/one.toml", "ringdown in/ringdown.toml", "simulate in/fall.toml",
                                 "compare in/one.toml", "sweep in/sweep.toml", "fit in/measured.toml"}) {
    SCOPED_TRACE(verb);
    const std::string line = command + verb + " --out out ";
    for (const std::string streams :
         {"2>/dev/full", "2>&-", ">&-", "<&-", ">&- 2>&- <&-", ">/dev/full 2>/dev/full"}) {
      EXPECT_EQ(shell(line + streams), 0) << streams;
      fs::remove_all(path("out"));
    }
    // A reader that is gone at once, for both streams; the status of the command, not of the reader.
    EXPECT_EQ(shell("( ( " + line + "; echo $? >status.txt ) 2>&1 | true )"), 0);
    EXPECT_EQ(contents("status.txt"), "0\n");
    fs::remove_all(path("out"));
    for (const std::string streams : {">&- 2>err.txt", ">/dev/full 2>err.txt", ">&- 2>&-"})
      EXPECT_EQ(shell(line + "--json " + streams), 1) << streams;
  }
  EXPECT_EQ(contents("out/cases.csv").empty(), true);  // of the last verb, a fit
  ASSERT_EQ(shell(command + "sweep in/sweep.toml --out again >&- 2>&- <&-"), 0);
  EXPECT_EQ(contents("again/cases.csv"), contents("whole/cases.csv"));
}

TEST_F(KeptInputs, HangUpAndTheEndOfProcessorTimeKeepWhatIsFinished) {
  for (const int signal : {SIGHUP, SIGXCPU}) {
    const pid_t child =
        start({"sweep", "in/sweep.toml", "--out", "out", "--threads", "1", "--set", "cases=20000"});
    const Ending end = interrupt(child, 0.5, signal);
    EXPECT_EQ(end.status, 3) << signal;
    EXPECT_THAT(contents("err.txt"), HasSubstr("cases are finished and kept")) << signal;
  }
}

TEST_F(KeptInputs, TemporaryFilesOfKilledRunsAreRemoved) {
  fs::create_directories(path("out"));
  constexpr const char* gone = "out/.curves.csv.99999999-0.tmp";  // a process number that no system gives
  const std::string running = "out/.curves.csv." + std::to_string(::getpid()) + "-0.tmp";
  write(gone, "half");
  write(running, "half");
  write("out/.mine.tmp", "kept");
  ASSERT_EQ(run("push in/one.toml --out out"), 0) << contents("err.txt");
  EXPECT_FALSE(exists(gone));
  EXPECT_TRUE(exists(running));
  EXPECT_TRUE(exists("out/.mine.tmp"));
}

}  // namespace
}  // namespace snare::app
