// The verbs fit and trace as their users see them: files, fields that others rely on, exit status.

#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

namespace snare::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class TraceCommand : public CommandFixture {
 protected:
  /// A short experiment whose readings are the computed curve of the declared wire, plus what `change` makes
  /// of it.
  void make_experiment(double (*change)(double displacement_mm, double force)) const {
    std::string text = R"(schema = "snare-experiment/1"
title = "short"
source = "made for this test"
)" + test::wire_tables("176.0") +
                       R"([solver]
elements = 32
)";
    std::string plain = text;
    for (const char* at : {"65", "90"}) {
      plain += std::string("[[series]]\nname = \"s") + at + "\"\ncontact_position_mm = " + at +
               ".0\ntravel_mm = 1.5\npoints = 16\n";
      text += std::string("[[series]]\nname = \"s") + at + "\"\ncontact_position_mm = " + at +
              ".0\nforce_sigma_N = 0.2\nfile = \"s" + at + ".csv\"\n";
    }
    std::ofstream(folder_ / "plain.toml") << plain;
    std::ofstream(folder_ / "x.toml") << text;
    ASSERT_EQ(run("push plain.toml --out push --quiet"), 0);
    std::ifstream curves(folder_ / "push" / "curves.csv");
    std::string line;
    std::getline(curves, line);
    std::ofstream files[2] = {std::ofstream(folder_ / "s65.csv"), std::ofstream(folder_ / "s90.csv")};
    for (std::ofstream& f : files) f << "displacement_mm,force_N\n";
    std::mt19937 random(12);
    std::normal_distribution<double> noise(0.0, 0.2);
    while (std::getline(curves, line)) {
      std::istringstream cells(line);
      std::string name, d, f;
      std::getline(cells, name, ',');
      std::getline(cells, d, ',');
      std::getline(cells, f, ',');
      files[name == "s65" ? 0 : 1] << d << ',' << change(std::stod(d), std::stod(f)) + noise(random) << '\n';
    }
  }
};

TEST_F(TraceCommand, WritesTheFieldsThatOthersRelyOn) {
  make_experiment([](double, double f) { return f + 3.0; });
  ASSERT_EQ(run("trace x.toml --out t --quiet"), 0) << contents("err.txt");
  const json t = parsed("t/trace.json");
  EXPECT_EQ(t["schema"], "snare-trace/1");
  EXPECT_EQ(t["noise"]["source"], "declared");
  EXPECT_NEAR(t["noise"]["sigma_N"].get<double>(), 0.2, 1e-12);
  for (const char* model : {"base", "final"}) {
    for (const char* key : {"rmse_N", "nrmse", "chi2_dof"})
      EXPECT_TRUE(t[model][key].is_number()) << model << " " << key;
    EXPECT_TRUE(t[model]["parameters"].is_object());
  }
  const json& number = t["base"]["parameters"]["wire.axial_stiffness_N"];
  EXPECT_TRUE(number["value"].is_number());
  EXPECT_TRUE(number["stderr"].is_number());
  for (const char* key : {"runs_p", "ljung_box_p", "lack_of_fit_p"})
    EXPECT_TRUE(t["residual"]["tests"][key].is_number());
  EXPECT_TRUE(t["residual"]["significant"].get<bool>());
  ASSERT_GE(t["candidates"].size(), 15u);
  for (const json& c : t["candidates"]) {
    for (const char* key :
         {"effect", "channel", "score_p", "rmse_N", "delta_bic", "value", "plausible", "class"}) {
      EXPECT_TRUE(c.contains(key)) << key;
    }
    EXPECT_LT(c["class"].get<std::size_t>(), t["classes"].size());
  }
  // What was put in is in the class of what was selected.
  ASSERT_EQ(t["selected"].size(), 1u) << t["verdict"];
  EXPECT_NE(t["selected_classes"][0].dump().find("force_offset"), std::string::npos) << t["selected_classes"];
  EXPECT_TRUE(t["explained"].get<bool>());
  EXPECT_TRUE(t["heldout"].contains("rmse_base_N"));
  EXPECT_TRUE(t["next_experiment"].contains("what"));
  EXPECT_TRUE(t["next_experiment"]["separates"].is_array());
  const std::string curves = contents("t/curves.csv");
  EXPECT_TRUE(curves.substr(0, curves.find('\n')).ends_with(",measured_N,base_N,final_N,residual_N"));
  EXPECT_EQ(curves.find("nan"), std::string::npos);
  EXPECT_EQ(contents("t/trace.json").find("nan,"), std::string::npos);
  const std::string page = contents("t/report.html");
  EXPECT_NE(page.find("<h1>short</h1>"), std::string::npos);
  EXPECT_NE(page.find("<p class=\"callout good\">Explained"), std::string::npos) << t["verdict"];
  for (const char* series : {"s65", "s90"}) {
    EXPECT_NE(page.find(std::string("<span>") + series + ", pushed at "), std::string::npos) << series;
  }
  const std::size_t rounds = t["rounds"].size();
  EXPECT_NE(page.find("<h3>Round " + std::to_string(rounds) + "</h3>"), std::string::npos);
  EXPECT_EQ(page.find("<h3>Round " + std::to_string(rounds + 1) + "</h3>"), std::string::npos);
}

TEST_F(TraceCommand, FitWritesItsNumbers) {
  make_experiment([](double, double f) { return f; });
  ASSERT_EQ(run("fit x.toml --out f --json"), 0) << contents("err.txt");
  const json f = parsed("f/fit.json");
  EXPECT_EQ(json::parse(contents("out.txt")), f);
  EXPECT_EQ(f["schema"], "snare-fit/1");
  EXPECT_TRUE(f["fit"]["parameters"].contains("wire.bending_stiffness_Nm2"));
  EXPECT_TRUE(f["residual"]["acceptable"].get<bool>());
  EXPECT_TRUE(fs::exists(folder_ / "f" / "curves.csv"));
}

TEST_F(TraceCommand, RecordsThatSayNothingAreRefusedAndNothingIsWritten) {
  make_experiment([](double, double) { return 1.0; });
  std::ofstream(folder_ / "s65.csv") << "displacement_mm,force_N\n0,1\n0.5,1\n1,1\n1.5,1\n";
  for (const char* verb : {"fit", "trace"}) {
    EXPECT_EQ(run(std::string(verb) + " x.toml --out t"), 2);
    EXPECT_NE(contents("err.txt").find("series[s65], force_N is 1 in every reading"), std::string::npos)
        << contents("err.txt");
    EXPECT_FALSE(fs::exists(folder_ / "t"));
  }
  EXPECT_EQ(run("trace plain.toml --out t"), 2);  // nothing but predictions
}

}  // namespace
}  // namespace snare::app
