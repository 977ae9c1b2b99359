// The command as its users see it: exit status, messages, files.

#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace snare::app {
namespace {

namespace fs = std::filesystem;

const std::string experiment_text = R"(schema = "snare-experiment/1"
title = "test"
source = "none"
)" + test::wire_tables("180.0") + R"([solver]
elements = 32
[[series]]
name = "s40"
contact_position_mm = 40.0
travel_mm = 2.0
points = 5
[[series]]
name = "s90"
contact_position_mm = 90.0
travel_mm = 2.0
points = 5
)";

struct Result {
  int status;
  std::string out;
  std::string err;
};

class Command : public CommandFixture {
 protected:
  void SetUp() override { write("x.toml", experiment_text); }

  [[nodiscard]] Result run(const std::string& arguments) const {
    return {CommandFixture::run(arguments), contents("out.txt"), contents("err.txt")};
  }
};

// A starter set runs unchanged, and never overwrites a file.
TEST_F(Command, NewWritesAStarterSet) {
  const Result made = run("new capture --out my");
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.err.find("next: snare simulate my/capture.toml"), std::string::npos) << made.err;
  const Result simulated =
      run("simulate my/capture.toml --out ran --quiet --set duration_s=0.005 --set "
          "snares[snare].wire.model=\"stretched\"");
  EXPECT_EQ(simulated.status, 0) << simulated.err;
  const Result again = run("new capture --out my");
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.err.find("must be a folder without that file"), std::string::npos) << again.err;
  const Result unknown = run("new ship --out other");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.err.find("must be \"capture\", \"experiment\" or \"wire\""), std::string::npos)
      << unknown.err;
  EXPECT_FALSE(fs::exists(folder_ / "other"));
  EXPECT_EQ(run("new wire --out w").status, 0);
}

// The starter experiment has readings, and its trace finds the displaced zero that they were computed with.
TEST_F(Command, NewExperimentIsTraced) {
  ASSERT_EQ(run("new experiment --out e").status, 0);
  const Result traced = run("trace e/experiment.toml --out t --quiet");
  ASSERT_EQ(traced.status, 0) << traced.err;
  const auto trace = parsed("t/trace.json");
  EXPECT_EQ(trace["verdict_kind"], "explained");
  EXPECT_EQ(trace["selected"], nlohmann::json::array({"displacement_offset"}));
  EXPECT_FALSE(trace["noise"]["drawn_about_published_laws"]);
}

TEST_F(Command, HelpOfEveryVerbHasAnExample) {
  EXPECT_EQ(run("--help").status, 0);
  for (const std::string verb : {"push", "fit", "trace", "reproduce", "validate"}) {
    const Result result = run(verb + " --help");
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.out.find("Example: snare " + verb), std::string::npos) << result.out;
    for (const char* option : {"--out", "--threads", "--set", "--quiet", "--json"}) {
      EXPECT_NE(result.out.find(option), std::string::npos) << verb << " " << option;
    }
  }
}

TEST_F(Command, WrongUseIsStatusTwo) {
  EXPECT_EQ(run("").status, 2);
  EXPECT_EQ(run("jump").status, 2);
  EXPECT_EQ(run("push").status, 2);
  EXPECT_EQ(run("push x.toml --colour red").status, 2);
  EXPECT_EQ(run("push x.toml --threads -1").status, 2);
}

TEST_F(Command, UnknownVerbsAndOptionsAreNamedWithTheNearest) {
  EXPECT_NE(run("pus x.toml").err.find("snare = pus, unknown verb; did you mean push?"), std::string::npos);
  EXPECT_NE(run("jump").err.find("there are: reproduce, push, fit"), std::string::npos);
  const Result option = run("push --thread 2 x.toml");
  EXPECT_EQ(option.status, 2);
  EXPECT_NE(option.err.find("snare push = --thread, unknown option; did you mean --threads?"),
            std::string::npos)
      << option.err;
  EXPECT_NE(run("arm sho x.toml").err.find("did you mean show?"), std::string::npos);
  EXPECT_EQ(run("push x.toml --set=wire.diameter_mm=1.4 --out=here").status, 0)
      << "values may stand behind a sign";
}

TEST_F(Command, PushAndFitTellTheDistanceFromTheReadings) {
  const std::string file = SNARE_SOURCE_DIR "/examples/push.toml";
  const Result pushed = run("push " + file + " --out p");
  EXPECT_NE(pushed.err.find("rms distance from the readings"), std::string::npos) << pushed.err;
  EXPECT_EQ(run("push " + file + " --out p --json").status, 0);
  const double rmse = parsed("out.txt")["series"][1]["misfit"]["rmse_N"];
  ASSERT_EQ(run("trace " + file + " --out t").status, 0);
  // By another way: that of the declared model of a trace.
  EXPECT_NEAR(rmse, parsed("t/trace.json")["declared"]["series_rmse_N"]["middle"].get<double>(), 1e-9);
  ASSERT_EQ(run("fit " + file + " --out f").status, 0);
  for (const char* page : {"p/report.html", "f/report.html"}) {
    EXPECT_NE(contents(page).find("What is left: middle"), std::string::npos) << page;
  }
}

TEST_F(Command, DecimalLengthsComeBackAsTheyWereWritten) {
  ASSERT_EQ(run("push " SNARE_SOURCE_DIR "/examples/push.toml --out p").status, 0);
  // The readings are at 0.25, 0.4, ... 3.1 mm.
  EXPECT_NE(contents("p/curves.csv").find("middle,3.1,"), std::string::npos);
  EXPECT_EQ(contents("p/curves.csv").find("middle,3.09"), std::string::npos);
}

TEST_F(Command, ArmShowDescribesARobotDescription) {
  const Result shown = run("arm show " SNARE_SOURCE_DIR "/data/arms/jemrms_like.urdf");
  EXPECT_EQ(shown.status, 0) << shown.err;
  EXPECT_NE(shown.out.find("revolute"), std::string::npos) << shown.out;
  EXPECT_EQ(run("arm show " SNARE_SOURCE_DIR "/data/arms/jemrms_like.urdf --pose bent").status, 2);
}

TEST_F(Command, WrongInputNamesFileLineKeyAndWritesNothing) {
  std::string text = experiment_text;
  text.replace(text.find("diameter_mm = 1.5"), 17, "diameter_mm = -15");
  write("bad.toml", text);
  const Result result = run("push bad.toml --out here");
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.err.rfind("bad.toml:6: wire.diameter_mm = -15, must be > 0", 0), 0u) << result.err;
  EXPECT_FALSE(fs::exists(folder_ / "here"));
  EXPECT_EQ(run("push missing.toml").status, 2);
  EXPECT_EQ(run("push . ").status, 2);
  EXPECT_EQ(run("push x.toml --set nonsense").status, 2);
  EXPECT_EQ(run("push x.toml --set wire.length_mm=100").status, 2);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(Command, PushWritesTheCurves) {
  const Result result = run("push x.toml --out here --quiet");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, "");
  const std::string csv = contents("here/curves.csv");
  EXPECT_EQ(
      csv.rfind(
          "series,displacement_mm,force_N,tension_left_N,tension_right_N,contact_arc_mm,iterations,converged",
          0),
      0u);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 11);
  EXPECT_EQ(csv.find("nan"), std::string::npos);
  EXPECT_EQ(csv.find("inf"), std::string::npos);
}

TEST_F(Command, JsonAloneOnStandardOutputAndOverridesApply) {
  const Result plain = run("push x.toml --json");
  const Result heavier =
      run("push x.toml --json --set wire.youngs_modulus_GPa=386 --set series[s40].points=3");
  ASSERT_EQ(plain.status, 0) << plain.err;
  ASSERT_EQ(heavier.status, 0) << heavier.err;
  const nlohmann::json a = nlohmann::json::parse(plain.out);
  const nlohmann::json b = nlohmann::json::parse(heavier.out);
  EXPECT_EQ(b["series"][0]["points"], 3);
  // Twice the modulus, the same shape: twice the force, to the solver's residual in forces of some 100 N.
  EXPECT_NEAR(b["series"][1]["largest_force_N"].get<double>(),
              2.0 * a["series"][1]["largest_force_N"].get<double>(), 1e-4);
}

TEST_F(Command, SameFilesForAnyNumberOfThreads) {
  ASSERT_EQ(run("push x.toml --out one --threads 1").status, 0);
  ASSERT_EQ(run("push x.toml --out two --threads 2").status, 0);
  EXPECT_EQ(contents("one/curves.csv"), contents("two/curves.csv"));
}

TEST_F(Command, WireThatCannotBeSolvedKeepsWhatItReached) {
  // A tilted pin is computed for contact at a point: the soft wire begins to wrap it on the way.
  const Result result =
      run("push x.toml --out here --set pusher.tilt_deg=2 --set wire.bending_stiffness_Nm2=0.0005 "
          "--set wire.axial_stiffness_N=114000 --set series[s90].travel_mm=6 --set series[s90].points=25");
  EXPECT_EQ(result.status, 3) << result.err;
  EXPECT_NE(result.err.find("series s90: the wire begins to wrap"), std::string::npos) << result.err;
  const std::string csv = contents("here/curves.csv");
  EXPECT_NE(csv.find("\ns90,1,"), std::string::npos) << "the points before must be there";
  EXPECT_EQ(csv.find("\ns90,6,"), std::string::npos);
}

TEST_F(Command, AFileInTheWayOfTheFolderIsWrongInput) {
  write("file", "in the way");
  const Result result = run("push x.toml --out file/below");
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("file"), std::string::npos) << result.err;
}

class SlowCommand : public Command {};

// By the optimised command: three minutes under the sanitizers, of tracing, which SlowTrace runs under them.
TEST_F(SlowCommand, ReproduceWritesCurvesJsonAndPage) {
  const int status =
      shell("'" SNARE_SOURCE_DIR
            "/build/release/snare' reproduce --out here --quiet --set solver.elements=16 --set "
            "series[s40].points=12 --set series[s65].points=12 --set series[s90].points=12 2>err.txt");
  ASSERT_EQ(status, 0) << contents("err.txt");
  const nlohmann::json json = parsed("here/reproduce.json");
  EXPECT_EQ(json["schema"], "snare-reproduce/1");
  EXPECT_EQ(json["series"].size(), 3u);
  ASSERT_GE(json["models"].size(), 2u);
  EXPECT_EQ(json["leading"]["recomputed"]["values"].size(), json["leading"]["values"].size() + 3);
  EXPECT_GT(json["leading"]["recomputed"]["p"].get<double>(), 0.01);
  EXPECT_FALSE(json["trace"]["verdict"].get<std::string>().empty());
  // The declared model is far off, the fitted one is not: both are said.
  EXPECT_GT(json["models"][0]["rmse_N"].get<double>(), 100.0);
  EXPECT_LT(json["models"][1]["rmse_N"].get<double>(), 1.0);
  const std::string csv = contents("here/curves.csv");
  EXPECT_NE(csv.substr(0, csv.find('\n')).find("measured_N,base_N,final_N"), std::string::npos);
  // The traced wire is the last model's, and distil reads it.
  const std::string wire = contents("here/traced.toml");
  EXPECT_NE(wire.find("schema = \"snare-wire/1\""), std::string::npos) << wire;
  const std::string kind = json["trace"]["verdict_kind"];
  EXPECT_EQ(wire.find("do not rely") != std::string::npos, kind == "not_explained" || kind == "cannot_tell")
      << wire;
  EXPECT_EQ(run("distil here/traced.toml --out law --quiet --set table.points=[4,2,2] --set "
                "table.most_points=[4,2,2] --set "
                "solver.elements=16")
                .status,
            0)
      << contents("err.txt");
  const std::string page = contents("here/report.html");
  for (const nlohmann::json& model : json["models"]) {
    EXPECT_NE(page.find("Error of the " + model["label"].get<std::string>()), std::string::npos)
        << model["label"];
  }
  for (const char* position : {"40", "65", "90"}) {
    EXPECT_NE(page.find(std::string("\">s\u00a0=\u00a0") + position + "\u00a0mm</h2>"), std::string::npos)
        << position;
  }
}

}  // namespace
}  // namespace snare::app
