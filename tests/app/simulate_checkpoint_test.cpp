// Killed, interrupted and failing runs of `snare simulate` .

#include "tests/app/command_fixture.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace snare::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class SimulateCheckpoint : public CommandFixture {
 protected:
  /// Arguments of a scenario that writes its checkpoints at every chance.
  [[nodiscard]] static std::vector<std::string> arguments_of(const std::string& scenario, const fs::path& out,
                                                             const std::vector<std::string>& settings) {
    std::vector<std::string> list{SNARE_COMMAND, "simulate",
                                  std::string(SNARE_SOURCE_DIR) + "/data/scenarios/" + scenario, "--out",
                                  out.string()};
    for (const std::string& setting : settings) list.insert(list.end(), {"--set", setting});
    return list;
  }
  /// Of a small air table.
  [[nodiscard]] static std::vector<std::string> arguments(const fs::path& out, const std::string& more = "") {
    std::vector<std::string> list =
        arguments_of("air_table.toml", out,
                     {"duration_s=0.5", "wires[wire].elements=12", "output.checkpoint_interval_s=0.005",
                      "output.checkpoint_wall_time_s=0"});
    if (!more.empty()) list.insert(list.end(), {"--set", more});
    return list;
  }
  /// Starts the command; what it says is added to log.txt.
  [[nodiscard]] pid_t start(const std::vector<std::string>& list) const {
    std::vector<char*> argv;
    argv.reserve(list.size() + 1);
    for (const std::string& a : list) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    const std::string log = (folder_ / "log.txt").string();
    const pid_t child = ::fork();
    if (child == 0) {
      const int to = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
      ::dup2(to, 1);
      ::dup2(to, 2);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    return child;
  }
  /// Exit status, or minus the signal that ended it.
  [[nodiscard]] static int finish(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  [[nodiscard]] int run(const std::vector<std::string>& list) const { return finish(start(list)); }
  /// summary.json without what depends on the clock.
  [[nodiscard]] json timeless(const fs::path& out) const {
    json summary = parsed(out / "summary.json");
    summary.erase("wall_s");
    summary.erase("real_time_factor");
    return summary;
  }
};

struct Killed {
  const char* name;
  const char* scenario;
  std::vector<std::string> settings;
};

/// For the messages.
void PrintTo(const Killed& killed, std::ostream* out) {
  *out << killed.name;
}

class KilledRun : public SimulateCheckpoint, public testing::WithParamInterface<Killed> {
 protected:
  [[nodiscard]] static std::vector<std::string> arguments(const fs::path& out) {
    return arguments_of(GetParam().scenario, out, GetParam().settings);
  }
};

TEST_P(KilledRun, GoesOnToTheSameBits) {
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run(arguments(folder_ / "whole")), 0) << contents("log.txt");
  const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_FALSE(fs::exists(folder_ / "whole/checkpoint.bin"));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> moment(0.2, 0.7);
  int kills = 0;
  bool resumed = false;
  int status = -SIGKILL;
  for (int attempt = 0; attempt < 40 && status == -SIGKILL; ++attempt) {
    const pid_t child = start(arguments(folder_ / "killed"));
    std::this_thread::sleep_for(std::chrono::duration<double>(whole * moment(random)));
    ::kill(child, SIGKILL);
    status = finish(child);
    if (status == -SIGKILL) {
      ++kills;
      resumed = resumed || fs::exists(folder_ / "killed/checkpoint.bin");
    }
  }
  if (status == -SIGKILL) status = run(arguments(folder_ / "killed"));
  ASSERT_EQ(status, 0) << contents("log.txt");
  EXPECT_GE(kills, 1);
  EXPECT_TRUE(resumed);
  EXPECT_NE(contents("log.txt").find("goes on from"), std::string::npos);
  EXPECT_EQ(contents("killed/history.csv"), contents("whole/history.csv"));
  EXPECT_EQ(timeless("killed"), timeless("whole"));
  EXPECT_FALSE(fs::exists(folder_ / "killed/checkpoint.bin"));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, KilledRun,
    testing::Values(Killed{"Contact",
                           "air_table.toml",
                           {"duration_s=0.5", "wires[wire].elements=12", "output.checkpoint_interval_s=0.005",
                            "output.checkpoint_wall_time_s=0"}},
                    Killed{"Bodies",
                           "grapple_shaft.toml",
                           {"duration_s=0.13", "wires[lower].elements=12", "wires[right].elements=12",
                            "wires[left].elements=12", "output.checkpoint_interval_s=0.01",
                            "output.checkpoint_wall_time_s=0"}},
                    // Beyond the first touch.
                    Killed{"Arm",
                           "jemrms_capture.toml",
                           {"duration_s=0.3", "wires[wire].elements=12", "output.checkpoint_interval_s=0.03",
                            "output.checkpoint_wall_time_s=0"}}),
    [](const auto& param) { return std::string(param.param.name); });

TEST_F(SimulateCheckpoint, AnInterruptedRunKeepsWhatItHasAndGoesOn) {
  ASSERT_EQ(run(arguments(folder_ / "whole")), 0) << contents("log.txt");
  const pid_t child = start(arguments(folder_ / "out"));
  while (!fs::exists(folder_ / "out/checkpoint.bin") && ::kill(child, 0) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ::kill(child, SIGINT);
  ASSERT_EQ(finish(child), 3) << contents("log.txt");
  EXPECT_NE(contents("log.txt").find("what was reached is kept; the same command goes on"), std::string::npos)
      << contents("log.txt");
  const json summary = timeless("out");
  EXPECT_FALSE(summary["finished"].get<bool>());
  EXPECT_TRUE(fs::exists(folder_ / "out/history.csv"));
  ASSERT_TRUE(fs::exists(folder_ / "out/checkpoint.bin"));

  // Of other input it is not used.
  fs::create_directories(folder_ / "other");
  fs::copy(folder_ / "out/checkpoint.bin", folder_ / "other/checkpoint.bin");
  ASSERT_EQ(run(arguments(folder_ / "other", "bodies[target].mass_kg=8.8")), 0) << contents("log.txt");
  EXPECT_NE(contents("log.txt").find("the checkpoint is of other input"), std::string::npos);
  // Nor when it is damaged.
  fs::create_directories(folder_ / "damaged");
  std::string bytes = contents("out/checkpoint.bin");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  std::ofstream(folder_ / "damaged/checkpoint.bin", std::ios::binary) << bytes.substr(0, bytes.size());
  ASSERT_EQ(run(arguments(folder_ / "damaged")), 0) << contents("log.txt");
  EXPECT_NE(contents("log.txt").find("the checkpoint is damaged"), std::string::npos);
  EXPECT_EQ(contents("damaged/history.csv"), contents("whole/history.csv"));

  ASSERT_EQ(run(arguments(folder_ / "out")), 0) << contents("log.txt");
  EXPECT_EQ(contents("out/history.csv"), contents("whole/history.csv"));
  EXPECT_EQ(timeless("out"), timeless("whole"));
}

TEST_F(SimulateCheckpoint, AFailureNamesTimeStepAndUnknownAndKeepsTheRest) {
  // Tolerances below round-off cannot be met.
  std::vector<std::string> list = arguments(folder_ / "out");
  for (const char* set : {"solver.relative_tolerance=1e-10", "solver.position_tolerance_m=1e-30",
                          "solver.velocity_tolerance_m_s=1e-30", "solver.body_position_tolerance_m=1e-30",
                          "solver.body_velocity_tolerance_m_s=1e-30"}) {
    list.insert(list.end(), {"--set", set});
  }
  ASSERT_EQ(run(list), 3) << contents("log.txt");
  const std::string log = contents("log.txt");
  EXPECT_NE(log.find("meets a loose wire: IDASolve stopped with IDA_"), std::string::npos) << log;
  EXPECT_NE(log.find(" s, step "), std::string::npos) << log;
  EXPECT_NE(log.find("worst: "), std::string::npos) << log;
  EXPECT_NE(log.find("what was reached is kept"), std::string::npos) << log;
  const json summary = timeless("out");
  EXPECT_FALSE(summary["finished"].get<bool>());
  EXPECT_FALSE(contents("out/history.csv").empty());
  EXPECT_EQ(contents("out/history.csv").find("nan"), std::string::npos);
}

}  // namespace
}  // namespace snare::app
