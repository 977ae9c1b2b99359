// Every verb answers SIGINT and SIGTERM within a second, at every stage, with status 3, and what it leaves is
// marked as a part.

#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <functional>
#include <ostream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace snare::app {
namespace {

namespace fs = std::filesystem;

// A second of the machine, and what sanitizers and a loaded machine add to ending a process.
constexpr double in_time = 2.0;

std::string experiment(int elements, int points, int series = 1) {
  std::string text = "schema = \"snare-experiment/1\"\ntitle = \"test\"\nsource = \"none\"\n" +
                     test::wire_tables("180.0") + "[solver]\nelements = " + std::to_string(elements) + "\n";
  for (int k = 0; k < series; ++k) {
    text += "[[series]]\nname = \"s" + std::to_string(k) +
            "\"\ncontact_position_mm = 60.0\ntravel_mm = 3.0\npoints = " + std::to_string(points) + "\n";
  }
  return text;
}

/// A chain of joints, each a metre from the one before.
std::string chain(int joints) {
  std::string text = "<robot name='chain'>";
  const std::string inertial =
      "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>";
  for (int k = 0; k <= joints; ++k) text += "<link name='l" + std::to_string(k) + "'>" + inertial + "</link>";
  for (int k = 0; k < joints; ++k) {
    text += "<joint name='j" + std::to_string(k) + "' type='continuous'><parent link='l" + std::to_string(k) +
            "'/><child link='l" + std::to_string(k + 1) +
            "'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/></joint>";
  }
  return text + "</robot>";
}

class Interruption : public CommandFixture {
 protected:
  /// chain.toml: an arm of so many joints.
  void write_chain(int joints) const {
    write("chain.urdf", chain(joints));
    write("chain.toml",
          "schema = \"snare-arm/1\"\ntitle = \"chain\"\nsource = \"none\"\nurdf = \"chain.urdf\"\ntip = \"l" +
              std::to_string(joints) +
              "\"\n[every_joint]\nlaw = \"linear\"\ndamping_Nms_rad = 0.0\nmotor_inertia_kg_m2 = "
              "1.0\nstiffness_Nm_rad = 100.0\ndrive = \"locked\"\n");
  }
  /// after: seconds of a command with the sanitizers; optimised it is there sooner.
  void expect_answer(const std::vector<std::string>& arguments, double after, int signal = SIGINT) const {
#ifdef NDEBUG
    constexpr double pace = 0.15;
#else
    constexpr double pace = 1.0;
#endif
    const Ending end = interrupt(start(arguments), pace * after, signal);
    EXPECT_EQ(end.status, 3) << contents("err.txt");
    EXPECT_LT(end.seconds, in_time);
    EXPECT_NE(contents("err.txt").find("interrupted"), std::string::npos) << contents("err.txt");
    EXPECT_FALSE(fs::exists(folder_ / "here/.snare.lock"));
    if (!fs::exists(folder_ / "here")) return;
    for (const auto& entry : fs::directory_iterator(folder_ / "here"))
      EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
  }
};

TEST_F(Interruption, OneSolutionOfManyElements) {
  write("x.toml", experiment(20000, 20000));
  expect_answer({"push", "x.toml", "--out", "here", "--json"}, 1.0);
  expect_answer({"push", "x.toml", "--out", "here", "--json"}, 3.0, SIGTERM);
  EXPECT_TRUE(nlohmann::json::parse(contents("out.txt"))["interrupted"].get<bool>());
}

TEST_F(Interruption, ManySeries) {
  write("x.toml", experiment(128, 40, 1000));
  expect_answer({"push", "x.toml", "--out", "here", "--json"}, 2.0);
  EXPECT_TRUE(nlohmann::json::parse(contents("out.txt"))["interrupted"].get<bool>());
}

TEST_F(Interruption, FitOfManyReadings) {
  write("x.toml",
        experiment(64, 2) + "[[series]]\nname = \"long\"\ncontact_position_mm = 60.0\nfile = \"long.csv\"\n");
  std::string csv = "displacement_mm,force_N\n";
  for (int i = 0; i < 300000; ++i) csv += std::to_string(1e-5 * i) + "," + std::to_string(1e-4 * i) + "\n";
  write("long.csv", csv);
  std::string text = contents("x.toml");
  const std::size_t begin = text.find("[[series]]");
  write("x.toml", text.substr(0, begin) + text.substr(text.find("[[series]]", begin + 1)));
  expect_answer({"fit", "x.toml", "--out", "here"}, 0.7);
  expect_answer({"fit", "x.toml", "--out", "here"}, 4.0, SIGTERM);
  expect_answer({"trace", "x.toml", "--out", "here"}, 6.0);
}

TEST_F(Interruption, FrequenciesOfManyJoints) {
  write_chain(600);
  expect_answer({"arm", "show", "chain.toml"}, 1.5);
}

TEST_F(Interruption, ValidateSaysThatItIsAPart) {
  expect_answer({"validate", "--out", "here"}, 4.0);
  EXPECT_NE(contents("err.txt").find("a part, "), std::string::npos) << contents("err.txt");
  const nlohmann::json result = parsed("here/validation.json");
  EXPECT_TRUE(result["interrupted"].get<bool>());
  EXPECT_LT(result["checks"]["done"].get<int>(), result["checks"]["asked"].get<int>());
  EXPECT_NE(contents("here/report.html").find("was interrupted"), std::string::npos);
  // The page explains the kinds of references; finished rows have their kind, absolute limits their reason.
  EXPECT_NE(contents("here/report.html").find("Kinds of references"), std::string::npos);
  for (const nlohmann::json& row : result["rows"]) {
    EXPECT_FALSE(row["kind"].get<std::string>().empty()) << row;
    EXPECT_EQ(row["error_kind"] == "absolute", !row["limit_reason"].get<std::string>().empty()) << row;
  }
}

TEST_F(Interruption, ReproduceSaysThatItIsAPart) {
  // The declared model is there after some seconds; the tracing takes minutes.
  const std::vector<std::string> arguments{"reproduce",
                                           "--out",
                                           "here",
                                           "--set",
                                           "solver.elements=16",
                                           "--set",
                                           "series[s40].points=12",
                                           "--set",
                                           "series[s65].points=12",
                                           "--set",
                                           "series[s90].points=12"};
  expect_answer(arguments, 0.7);
  expect_answer(arguments, 5.0);
  const nlohmann::json result = parsed("here/reproduce.json");
  EXPECT_TRUE(result["interrupted"].get<bool>());
  EXPECT_EQ(result["models"][0]["name"], "declared");
  EXPECT_NE(contents("here/report.html").find("was interrupted"), std::string::npos);
}

TEST_F(Interruption, DistilAndCompareAndSimulate) {
  const std::string data = SNARE_SOURCE_DIR "/data";
  expect_answer({"distil", data + "/wires/traced_published.toml", "--out", "here"}, 2.0);
  expect_answer({"compare", data + "/wires/traced_published.toml", "--out", "here"}, 0.4, SIGTERM);
  expect_answer({"simulate", data + "/scenarios/grapple_shaft.toml", "--out", "here"}, 2.0);
  EXPECT_TRUE(parsed("here/summary.json")["interrupted"].get<bool>());
  // One step of such a wire takes longer than an answer may.
  expect_answer({"simulate", data + "/scenarios/grapple_shaft.toml", "--out", "fine", "--set",
                 "wires[lower].elements=2000"},
                3.0);
}

/// What a verb is asked that takes longer than a test waits, in a folder with the files of `AtAnyMoment`.
struct LongWork {
  const char* name;
  std::vector<std::string> arguments;
  bool json = true;  ///< it has a result for standard output
};

void PrintTo(const LongWork& work, std::ostream* out) {
  *out << work.name;
}

const std::string data = SNARE_SOURCE_DIR "/data";

const LongWork long_work[] = {
    {"push", {"push", "fine.toml"}},
    {"fit", {"fit", "readings.toml"}},
    {"fit_records", {"fit", "record.toml"}},
    {"trace", {"trace", "readings.toml"}},
    {"trace_records", {"trace", "record.toml"}},
    {"reproduce", {"reproduce"}},
    {"reproduce_paper", {"reproduce", "honda"}},
    {"distil", {"distil", data + "/wires/traced_published.toml"}},
    {"compare_pushes", {"compare", "readings.toml"}},
    {"compare_motions", {"compare", data + "/scenarios/ssrms_htv_capture.toml"}},
    {"simulate_lists", {"simulate", data + "/scenarios/ssrms_htv_capture.toml"}},
    {"simulate_wire", {"simulate", data + "/scenarios/air_table.toml", "--set", "duration_s=1000"}},
    {"simulate_arm", {"simulate", "step.toml"}},
    {"ringdown", {"ringdown", "ringdown.toml"}},
    {"sweep", {"sweep", "sweep.toml"}},
    {"sweep_case", {"sweep", "sweep.toml", "--case", "7", "--set", "case=\"fine.toml\""}},
    {"benchmark", {"benchmark"}},
    {"benchmark_archive", {"benchmark", "benchmark.toml", "--archive"}, false},
    {"validate", {"validate"}},
    {"arm", {"arm", "show", "chain.toml"}},
};

class AtAnyMoment : public Interruption, public testing::WithParamInterface<LongWork> {
 protected:
  AtAnyMoment() {
    write("fine.toml", experiment(20000, 20000));
    std::string csv = "displacement_mm,force_N\n";
    for (int i = 0; i < 100000; ++i) csv += std::to_string(3e-5 * i) + "," + std::to_string(1e-4 * i) + "\n";
    write("long.csv", csv);
    const std::string text = experiment(128, 2);
    write("readings.toml",
          text.substr(0, text.find("[[series]]")) +
              "[[series]]\nname = \"long\"\ncontact_position_mm = 60.0\nfile = \"long.csv\"\n"
              "[fit]\nfree = [\"wire.bending_stiffness_Nm2\"]\n");
    std::string swings = "time_s,displacement_mm\n";
    for (int i = 0; i < 100000; ++i)
      swings +=
          std::to_string(1e-4 * i) + "," + std::to_string(std::exp(-1e-4 * i) * std::sin(0.05 * i)) + "\n";
    write("swings.csv", swings);
    std::string ringdown = "schema = \"snare-ringdown/1\"\ntitle = \"test\"\nsource = \"none\"\n";
    for (int k = 0; k < 20; ++k)
      ringdown += "[[series]]\nname = \"s" + std::to_string(k) + "\"\nfile = \"swings.csv\"\nmodes = 4\n";
    write("ringdown.toml", ringdown);
    std::string swing = "time_s,angle_deg\n";
    for (int i = 0; i < 100000; ++i)
      swing += std::to_string(1e-3 * i) + "," + std::to_string(40.0 * std::cos(3e-3 * i)) + "\n";
    write("swing.csv", swing);
    write("record.toml", "schema = \"snare-record/1\"\ntitle = \"test\"\nscenario = \"" SNARE_SOURCE_DIR
                         "/tests/ranges/swing.toml\"\n[[records]]\nname = \"first\"\nfile = \"swing.csv\"\n"
                         "columns = { angle_deg = \"encoder\" }\n[fit]\nfree = "
                         "[\"arms[pendulum].joint.bearing.viscous_Nms_rad\"]\n");
    write("one.toml", experiment(64, 20));
    write("sweep.toml",
          "schema = \"snare-sweep/1\"\ntitle = \"test\"\ncase = \"one.toml\"\ndesign = \"latin_hypercube\"\n"
          "cases = 100000\n[set]\n\"solver.extrapolate\" = false\n[[vary]]\nkey = \"wire.length_mm\"\n"
          "uniform = [179.0, 181.0]\n[collect]\nforce = \"series[s0].largest_force_N\"\n");
    write(
        "benchmark.toml",
        "schema = \"snare-benchmark/1\"\ntitle = \"test\"\n[[cases]]\nname = \"push\"\nfile = \"fine.toml\"\n"
        "x = \"displacement_mm\"\n[cases.quantities]\nforce_N = \"force_N\"\n"
        "[[cases.refinements]]\nset = { \"solver.elements\" = 10000 }\n[[cases.refinements]]\n"
        "[[cases.models]]\nname = \"coarse\"\n");
    write_chain(600);
    std::string angles = "0";
    for (int i = 1; i < 600; ++i) angles += ", 0";
    std::string deflections = "0, 0, -1.0";
    for (int i = 3; i < 600; ++i) deflections += ", 0";
    write("step.toml",
          "schema = \"snare-scenario/2\"\ntitle = \"test\"\nduration_s = 1000.0\noutput_interval_s = 0.01\n"
          "[[arms]]\nname = \"chain\"\nfile = \"chain.toml\"\nhold = \"locked\"\nangles_deg = [" +
              angles + "]\ndeflections_deg = [" + deflections + "]\n");
  }
};

// The moments are drawn once for all: reading, the first work, later work.
TEST_P(AtAnyMoment, IsAnsweredAndSaidToBeAPart) {
  std::mt19937 random(static_cast<unsigned>(std::hash<std::string>()(GetParam().name)));
  for (const double latest : {0.8, 1.6, 3.0}) {
    const double after = std::uniform_real_distribution(0.5, latest)(random);
    std::vector<std::string> arguments = GetParam().arguments;
    if (arguments.front() != "arm") arguments.insert(arguments.end(), {"--out", "here"});
    if (GetParam().json) arguments.emplace_back("--json");
    expect_answer(arguments, after, latest < 1.0 ? SIGTERM : SIGINT);
    if (GetParam().json) {
      EXPECT_TRUE(nlohmann::json::parse(contents("out.txt"))["interrupted"].get<bool>()) << after;
    }
    if (!fs::exists(folder_ / "here")) continue;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "here")) {
      if (entry.path().extension() == ".json") {
        EXPECT_TRUE(parsed(entry.path())["interrupted"].get<bool>()) << entry.path();
      } else if (entry.path().extension() == ".html") {
        EXPECT_NE(contents(entry.path()).find("was interrupted"), std::string::npos) << entry.path();
      }
    }
    fs::remove_all(folder_ / "here");
  }
}

INSTANTIATE_TEST_SUITE_P(Slow, AtAnyMoment, testing::ValuesIn(long_work),
                         [](const auto& work) { return std::string(work.param.name); });

// A verb that is new must be in the list; `new` writes a few files and is done.
TEST_F(Interruption, EveryVerbIsAsked) {
  ASSERT_EQ(run("--help"), 0);
  const std::string help = contents("out.txt");
  std::istringstream lines(help.substr(help.find("Subcommands:")));
  std::string line;
  std::getline(lines, line);
  int verbs = 0;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string verb;
    if (!(words >> verb)) continue;
    ++verbs;
    EXPECT_TRUE(
        verb == "new" || verb == "export" ||  // they compute nothing that takes time
        std::ranges::any_of(long_work, [&](const LongWork& w) { return w.arguments.front() == verb; }))
        << verb;
  }
  EXPECT_GE(verbs, 13);
}

TEST_F(Interruption, ASecondSignalEndsAtOnce) {
  write("x.toml", experiment(20000, 20000));
  const pid_t child = start({"push", "x.toml", "--out", "here"});
  std::this_thread::sleep_for(std::chrono::seconds(1));
  ::kill(child, SIGINT);
  const Ending end = interrupt(child, 0.1);
  EXPECT_TRUE(end.status == -SIGINT || end.status == 3)
      << end.status;  // the first one may have been answered already
  EXPECT_LT(end.seconds, 0.5);
}

}  // namespace
}  // namespace snare::app
