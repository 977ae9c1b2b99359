// Every verb answers SIGINT and SIGTERM within a second, at every stage, with status 3, and what it leaves is marked as a part.

#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <csignal>
#include <filesystem>
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
            "'/><child link='l" + std::to_string(k + 1) + "'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/></joint>";
  }
  return text + "</robot>";
}

class Interruption : public CommandFixture {
 protected:
  void expect_answer(const std::vector<std::string>& arguments, double after, int signal = SIGINT) const {
    const Ending end = interrupt(start(arguments), after, signal);
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
  write("x.toml", experiment(64, 2) + "[[series]]\nname = \"long\"\ncontact_position_mm = 60.0\nfile = \"long.csv\"\n");
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
  write("chain.urdf", chain(600));
  write("chain.toml",
        "schema = \"snare-arm/1\"\ntitle = \"chain\"\nsource = \"none\"\nurdf = \"chain.urdf\"\ntip = \"l600\"\n"
        "[every_joint]\nlaw = \"linear\"\ndamping_Nms_rad = 0.0\nmotor_inertia_kg_m2 = 1.0\nstiffness_Nm_rad = "
        "100.0\ndrive = \"locked\"\n");
  expect_answer({"arm", "show", "chain.toml"}, 1.5);
}

TEST_F(Interruption, ValidateSaysThatItIsAPart) {
  expect_answer({"validate", "--out", "here"}, 4.0);
  EXPECT_NE(contents("err.txt").find("a part, "), std::string::npos) << contents("err.txt");
  const nlohmann::json result = parsed("here/validation.json");
  EXPECT_TRUE(result["interrupted"].get<bool>());
  EXPECT_LT(result["checks"]["done"].get<int>(), result["checks"]["asked"].get<int>());
  EXPECT_NE(contents("here/report.html").find("was interrupted"), std::string::npos);
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
  expect_answer(
      {"simulate", data + "/scenarios/grapple_shaft.toml", "--out", "fine", "--set", "wires[lower].elements=2000"},
      3.0);
}

TEST_F(Interruption, ASecondSignalEndsAtOnce) {
  write("x.toml", experiment(20000, 20000));
  const pid_t child = start({"push", "x.toml", "--out", "here"});
  std::this_thread::sleep_for(std::chrono::seconds(1));
  ::kill(child, SIGINT);
  const Ending end = interrupt(child, 0.1);
  EXPECT_TRUE(end.status == -SIGINT || end.status == 3) << end.status;  // the first one may have been answered already
  EXPECT_LT(end.seconds, 0.5);
}

}  // namespace
}  // namespace snare::app
