// The verbs distil and compare as their users see them: files, exports that compile alone and agree,
// resuming.

#include "coupling/contact/force_table.hpp"
#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace snare::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string wire_text = test::traced_wire_text("short -- with a dash", R"([solver]
elements = 16
[table]
points = [5, 3, 3]
most_points = [5, 3, 3]
[laws]
positions_mm = [40.0, 52.5]
)");

class DistilCommand : public CommandFixture {
 protected:
  void SetUp() override { std::ofstream(folder_ / "w.toml") << wire_text; }
  /// Runs o/run.cpp, run.c and run.py with the exports beside them; what they print goes to o/cpp.txt, c.txt
  /// and py.txt.
  void run_exports() const {
    ASSERT_EQ(
        shell("cd o && g++ -std=c++17 -Wall -Wextra -Werror -O1 run.cpp -o run_cpp && ./run_cpp > cpp.txt"),
        0);
    ASSERT_EQ(
        shell("cd o && gcc -std=c99 -Wall -Wextra -Werror -O1 run.c law.c -lm -o run_c && ./run_c > c.txt"),
        0);
    ASSERT_EQ(shell("cd o && python3 -I -B -c \"import sys; sys.path.insert(0, '.'); "
                    "exec(open('run.py').read())\" > py.txt"),
              0);
  }
  [[nodiscard]] std::vector<double> numbers(const fs::path& file) const {
    std::ifstream in(folder_ / file);
    return {std::istream_iterator<double>(in), {}};
  }
};

/// The table as law.json holds it, by the library.
double library_force(const json& table, double d, double s, double e) {
  std::vector<double> values, slopes;
  const std::vector<double> nodes = table["nodes"];
  const double scale = table["force_scale_N"];
  const double span = table["span_m"];
  for (std::size_t n = 0; n < nodes.size(); n += coupling::ForceTable::numbers_a_node) {
    values.push_back(scale * nodes[n]);
    slopes.push_back(scale / span * nodes[n + 1]);
  }
  const coupling::ForceTable rebuilt({table["travel"], table["position"], table["slack"]}, values, slopes,
                                     span, scale * span * span, table["mirrored"]);
  return rebuilt.force(d, s, e);
}

// The exports compile and run alone, and say what the library says: to 1e-12 of the force, some hundred
// roundings.
TEST_F(DistilCommand, ExportsAgreeWithTheLibrary) {
  ASSERT_EQ(run("distil w.toml --out o --quiet"), 0) << contents("err.txt");
  const json law = parsed("o/law.json");
  const json& table = law["cases"][0]["table"];
  EXPECT_GT(table["error"]["bound_N"].get<double>(), table["error"]["largest_N"].get<double>());
  EXPECT_FALSE(fs::exists(folder_ / "o" / "distil.journal"));

  std::string calls_c, calls_py;
  std::vector<double> expected;
  for (int i = 0; i < 40; ++i) {
    const double d = 2.6e-3 * i / 39.0;
    const double s = 0.036 + 0.1 * ((i * 7) % 40) / 39.0;  // beyond mid-span too
    const double e = 3.7e-4 + 2.4e-4 * ((i * 11) % 40) / 39.0;
    std::ostringstream numbers;
    numbers.precision(17);
    numbers << d << ", " << s << ", " << e;
    calls_c += "  printf(\"%.17g\\n\", N force(" + numbers.str() + "));\n";
    calls_py += "print(repr(law.force(" + numbers.str() + ")))\n";
    expected.push_back(library_force(table, d, s, e));
  }
  for (const char* name : {"quadratic", "quadratic_through_origin", "linear", "power", "stretched_wire",
                           "stretched_wire_linear", "tensioned_wire"}) {
    for (const char* place : {"s40", "s52_5"}) {
      const std::string function = std::string(name) + "_" + place;
      calls_c += "  printf(\"%.17g\\n\", N " + function + "(0.002));\n";
      calls_py += "print(repr(law." + function + "(0.002)))\n";
    }
  }
  std::ofstream(folder_ / "o" / "run.py") << "import law\n" << calls_py;
  std::ofstream(folder_ / "o" / "run.cpp")
      << "#include \"law.hpp\"\n#include <cstdio>\n#define N snare_law::\nint main() {\n"
      << calls_c << "}\n";
  std::ofstream c(folder_ / "o" / "run.c");
  c << "#include <stdio.h>\n#define N\ndouble force(double, double, double);\n";
  for (const char* name : {"quadratic", "quadratic_through_origin", "linear", "power", "stretched_wire",
                           "stretched_wire_linear", "tensioned_wire"}) {
    for (const char* place : {"s40", "s52_5"}) c << "double " << name << "_" << place << "(double);\n";
  }
  c << "int main(void) {\n" << calls_c << "  return 0;\n}\n";
  c.close();
  run_exports();
  for (const char* file : {"cpp.txt", "c.txt", "py.txt"}) {
    const std::vector<double> values = numbers(fs::path("o") / file);
    ASSERT_EQ(values.size(), expected.size() + 14) << file;
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(values[i], expected[i], 1e-12 * (1.0 + std::abs(expected[i]))) << file << i;
    // Simple laws: from their numbers in law.json, the quadratic and the power by hand here.
    const json& laws = law["cases"][0]["positions"][0]["laws"];
    const auto number = [&](std::size_t k, const char* name) {
      return laws[k]["parameters"][name]["value"].get<double>();
    };
    EXPECT_NEAR(values[40], (number(0, "A") * 0.002 + number(0, "B")) * 0.002 + number(0, "C"),
                1e-12 * values[40]);
    EXPECT_NEAR(values[46], number(3, "k") * std::pow(0.002, number(3, "p")), 1e-12 * values[46]);
    EXPECT_GT(values[48], 0.0);  // stretched wire
  }
  EXPECT_NE(contents("o/law_adams.adm").find("SPLINE/3"), std::string::npos);
  EXPECT_EQ(contents("o/law_mujoco.xml").find("-- with"),
            std::string::npos);  // no double hyphen in a comment
  EXPECT_EQ(shell("python3 -c \"import xml.dom.minidom as m; m.parse('o/law_mujoco.xml')\""), 0);
}

// Killed in the middle, the journal torn, resumed with another number of threads: the same bytes.
TEST_F(DistilCommand, ResumesToTheSameBytes) {
  ASSERT_EQ(run("distil w.toml --out whole --quiet --threads 2"), 0) << contents("err.txt");
  // An interrupted run keeps its journal; kill it as soon as there is some of it.
  ASSERT_EQ(
      shell(
          std::string("( '") + SNARE_COMMAND +
          "' distil w.toml --out part --quiet --threads 1 & pid=$!; for i in $(seq 2000); do [ $(stat -c %s "
          "part/distil.journal 2>/dev/null || echo 0) -gt 60000 ] && break; sleep 0.005; done; kill -9 $pid; "
          "wait $pid ) >/dev/null 2>&1; test -s part/distil.journal && ! test -e part/law.json"),
      0);
  fs::resize_file(folder_ / "part" / "distil.journal",
                  fs::file_size(folder_ / "part" / "distil.journal") - 37);
  ASSERT_EQ(run("distil w.toml --out part --quiet --threads 1"), 0) << contents("err.txt");
  for (const char* file :
       {"law.json", "table.csv", "law.hpp", "law.c", "law.h", "law.py", "law.mo", "law_mujoco.xml",
        "law_mujoco_linear.xml", "law_simulink.csv", "law_adams.adm", "report.html"}) {
    EXPECT_EQ(contents(fs::path("whole") / file), contents(fs::path("part") / file)) << file;
  }
}

// Friction: the way back is exported too, and a law with its memory; both are followed here through a turn.
TEST_F(DistilCommand, LoopsAreDistilledFromFriction) {
  ASSERT_EQ(run("distil w.toml --out o --quiet --set pusher.friction=0.3 --set laws.positions_mm=[40.0]"), 0)
      << contents("err.txt");
  const json law = parsed("o/law.json");
  const json& place = law["cases"][0]["positions"][0];
  const json& table = law["cases"][0]["table"];
  EXPECT_GT(place["damping"]["loop_J"].get<double>(), 0.0);
  const double returned = place["load_unload"]["returned"];
  const double turn = 1e-3 * place["load_unload"]["turn_mm"].get<double>();
  EXPECT_LT(returned, 1.0);
  ASSERT_TRUE(table.contains("unloading"));

  const double slack = 175.49e-3 - 175e-3;
  std::vector<double> expected;
  std::string calls_c, calls_py;
  double branch = 1.0;
  double last = 0.0;
  for (const double d : {0.001, 0.002, 0.0019, 0.0012, 0.0013, 0.0022, -0.001, 0.0005}) {
    branch = std::clamp(branch + 2.0 * (d - last) / turn, -1.0, 1.0);
    last = d;
    if (d < 0.0) branch = 1.0;
    const double full = d < 0.0 ? 0.0 : library_force(table, d, 0.04, slack);
    expected.push_back(full * 0.5 * ((1.0 + returned) + branch * (1.0 - returned)));
    const std::string number = std::to_string(d);
    calls_c += "  printf(\"%.17g\\n\", N load_unload_s40(" + number + ", &z, &l));\n";
    calls_py += "print(repr(law.load_unload_s40(" + number + ", memory)))\n";
  }
  json back = table;
  back["nodes"] = table["unloading"]["nodes"];
  expected.push_back(library_force(back, 0.001, 0.04, slack));
  calls_c += "  printf(\"%.17g\\n\", N force_unloading(0.001, 0.04, 175.49e-3 - 175e-3));\n";
  calls_py += "print(repr(law.force_unloading(0.001, 0.04, 175.49e-3 - 175e-3)))\n";

  std::ofstream(folder_ / "o" / "run.py") << "import law\nmemory = [1.0, 0.0]\n" << calls_py;
  std::ofstream(folder_ / "o" / "run.cpp")
      << "#include \"law.hpp\"\n#include <cstdio>\n#define N snare_law::\n"
      << "int main() {\n  double z = 1.0, l = 0.0;\n"
      << calls_c << "}\n";
  std::ofstream(folder_ / "o" / "run.c")
      << "#include <stdio.h>\n#define N\ndouble load_unload_s40(double, double*, double*);\n"
      << "double force_unloading(double, double, double);\nint main(void) {\n  double z = 1.0, l = 0.0;\n"
      << calls_c << "  return 0;\n}\n";
  run_exports();
  for (const char* file : {"cpp.txt", "c.txt", "py.txt"}) {
    const std::vector<double> values = numbers(fs::path("o") / file);
    ASSERT_EQ(values.size(), expected.size()) << file;
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(values[i], expected[i], 1e-12 * (1.0 + std::abs(expected[i]))) << file << i;
  }
}

// A dashpot of impacts on the wire in motion is in law.json; a quarter of it acts along a tendon of the
// MuJoCo model.
TEST_F(DistilCommand, DampingIsDistilledFromImpacts) {
  std::ofstream(folder_ / "w.toml", std::ios::app)
      << "[damping]\nimpact_mass_kg = 8.9\nimpact_speeds_m_s = [0.02]\nelements = 16\n";
  ASSERT_EQ(run("distil w.toml --out o --quiet --set laws.positions_mm=[52.5]"), 0) << contents("err.txt");
  const json law = parsed("o/law.json");
  const json& impact = law["cases"][0]["positions"][0]["impacts"][0];
  EXPECT_GT(impact["restitution"].get<double>(), 0.9);
  EXPECT_LT(impact["restitution"].get<double>(), 1.0);
  EXPECT_GT(impact["damping_Ns_m"].get<double>(), 0.0);
  const std::string model = contents("o/law_mujoco.xml");
  const std::size_t damper = model.find("<spatial name=\"wire_s52_5_damper\"");
  ASSERT_NE(damper, std::string::npos);
  const std::size_t value = model.find("damping=\"", damper);
  ASSERT_NE(value, std::string::npos);
  EXPECT_DOUBLE_EQ(4.0 * std::stod(model.substr(value + 9)), impact["damping_Ns_m"].get<double>());
  EXPECT_EQ(run("distil w.toml --out p --set damping.impact_mass_kg=-1 --set mount.slip_tension_N=5"), 2);
  const std::string log = contents("err.txt");
  EXPECT_NE(log.find("damping.impact_mass_kg = -1"), std::string::npos) << log;
  EXPECT_NE(log.find("does not slip in its mounts"), std::string::npos) << log;
}

TEST_F(DistilCommand, WrongInputWritesNothing) {
  EXPECT_EQ(run("distil w.toml --out o --set ranges.travel_mm=-1 --set table.tolerance=3"), 2);
  const std::string log = contents("err.txt");
  EXPECT_NE(log.find("ranges.travel_mm = -1, must be >= 1e-06 and <= 1000"), std::string::npos) << log;
  EXPECT_NE(log.find("table.tolerance = 3"), std::string::npos) << log;
  EXPECT_FALSE(fs::exists(folder_ / "o"));
  EXPECT_EQ(run("compare missing.toml --out o"), 2);
  std::ofstream(folder_ / "s.toml") << "schema = \"snare-nothing/1\"\n";
  EXPECT_EQ(run("compare s.toml --out o"), 2);
  EXPECT_NE(contents("err.txt").find("s.toml:1: schema = "), std::string::npos);
}

TEST_F(DistilCommand, ComparesModelsOfAWireAndOfAnExperiment) {
  ASSERT_EQ(run("compare w.toml --out o --quiet"), 0) << contents("err.txt");
  const json wire = parsed("o/compare.json");
  ASSERT_EQ(wire["cases"].size(), 2u);
  const json& models = wire["cases"][0]["models"];
  EXPECT_EQ(models[0]["model"], "full_wire");
  EXPECT_EQ(models[0]["error_full_wire"]["largest_N"], 0.0);
  EXPECT_EQ(models[1]["model"], "spline_table");
  EXPECT_EQ(models.back()["model"], "stretched_wire_published");
  for (std::size_t i = 1; i < models.size(); ++i) {
    EXPECT_GT(models[i]["seconds_per_evaluation"].get<double>(), 0.0);
    EXPECT_LT(models[i]["seconds_per_evaluation"].get<double>(),
              models[0]["seconds_per_evaluation"].get<double>());
  }
  std::string experiment = wire_text;
  experiment.replace(experiment.find("snare-wire"), 10, "snare-experiment");
  experiment.resize(experiment.find("[table]"));
  experiment +=
      "[[series]]\nname = \"s40\"\ncontact_position_mm = 40.0\n"
      "law = { A_N_m2 = 719880.0, B_N_m = -13.578, C_N = 0.0533, R2 = 0.9976, to_mm = 4.0 }\n";
  std::ofstream(folder_ / "e.toml") << experiment;
  ASSERT_EQ(run("compare e.toml --out e --quiet"), 0) << contents("err.txt");
  const json compared = parsed("e/compare.json")["cases"][0];
  EXPECT_EQ(compared["models"].back()["model"], "published_quadratic");
  // The published law stands for the readings: no distance between them but rounding.
  EXPECT_LT(compared["models"].back()["error_measured"]["rms_N"].get<double>(), 1e-9);
}

}  // namespace
}  // namespace snare::app
