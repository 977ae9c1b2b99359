// The verb simulate as its users see it: files, balance, exit statuses.

#include "tests/app/command_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace snare::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class SimulateCommand : public CommandFixture {
 protected:
  /// Exit status of `snare simulate SCENARIO --out out ARGUMENTS`; what it says goes to log.txt.
  [[nodiscard]] int run(const std::string& scenario, const std::string& arguments) const {
    return shell("'" SNARE_COMMAND "' simulate '" SNARE_SOURCE_DIR "/data/scenarios/" + scenario +
                 "' --out out " + arguments + " >log.txt 2>&1");
  }
  [[nodiscard]] json summary() const { return parsed("out/summary.json"); }
};

// The paper's statement of its air table (Abiko et al., section 4.3): the target starts to turn, the law
// misses the peak force and keeps the impulse; then the velocity is constant.
TEST_F(SimulateCommand, AirTable) {
  const std::string shorter = "--set duration_s=0.25 --set wires[wire].elements=32 ";
  ASSERT_EQ(run("air_table.toml", shorter + "--set output.paraview=true"), 0) << contents("log.txt");
  const json s = summary();
  const json& wire = s["contacts"][0];
  const json& body = s["bodies"][0];
  EXPECT_LT(body["velocity_after_m_s"][1].get<double>(), 0.0);
  EXPECT_LT(body["spin_after_rad_s"][2].get<double>(), 0.0);
  // Momentum: what the target lost the wire and its mounts got.
  EXPECT_NEAR(8.9 * (0.1 - body["velocity_after_m_s"][1].get<double>()), wire["impulse_Ns"][1].get<double>(),
              1e-6);
  EXPECT_LT(std::abs(s["momentum_error_Ns"][1].get<double>()), 1e-6);
  EXPECT_LT(std::abs(s["angular_momentum_error_Nms"][2].get<double>()), 1e-6);
  // The energy of the impact is 0.0445 J; the integrator's own error is within a thousandth of it at default
  // tolerances.
  EXPECT_LT(std::abs(s["energy_J"]["integrator"].get<double>()), 1e-3 * 0.0445);
  EXPECT_LT(s["largest_penetration_m"].get<double>(), 1e-6);
  EXPECT_NE(contents("out/history.csv").find("probe on wire normal_N"), std::string::npos);
  EXPECT_NE(contents("out/report.html").find("class=\"scene\""), std::string::npos);
  EXPECT_NE(contents("out/motion.pvd").find("motion_00000.vtp"), std::string::npos);
  EXPECT_EQ(contents("out/history.csv").find("nan"), std::string::npos);
  ASSERT_EQ(run("air_table.toml", shorter + "--set 'wires[wire].model=\"quadratic\"'"), 0)
      << contents("log.txt");
  const json by_law = summary();
  const json& law = by_law["contacts"][0];
  EXPECT_GT(wire["peak_force_N"].get<double>(), 2.0 * law["peak_force_N"].get<double>());
  EXPECT_NEAR(wire["impulse_Ns"][1].get<double>() / law["impulse_Ns"][1].get<double>(), 1.0, 0.1);
  EXPECT_NE(contents("out/history.csv").find("wire tension_N"), std::string::npos);
}

// The wire is a law without mass, and the shape is fixed to the world.
TEST_F(SimulateCommand, RejectsAScenarioInWhichNothingCanMove) {
  write("still.toml", R"(schema = "snare-scenario/2"
title = "still"
source = "a test"
duration_s = 0.01
[[shapes]]
name = "post"
frame = "world"
kind = "capsule"
position_mm = [20.0, 0.0, 50.0]
rotation_deg = [90.0, 0.0, 0.0]
length_mm = 40.0
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
model = "stretched"
)");
  EXPECT_EQ(CommandFixture::run("simulate still.toml --out out"), 2);
  EXPECT_NE(contents("err.txt").find("nothing can move: no wire with mass, no body, no arm"),
            std::string::npos)
      << contents("err.txt");
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

// What sensors read stands in telemetry.csv; the summary has its least, largest and last, and what the joints
// bore.
TEST_F(SimulateCommand, TellsWhatSensorsReadAndJointsBore) {
  ASSERT_EQ(run("ssrms_rigidize.toml", "--set duration_s=0.5"), 0) << contents("log.txt");
  const json s = summary();
  std::istringstream telemetry(contents("out/telemetry.csv"));
  std::string line;
  std::getline(telemetry, line);
  std::vector<std::string> columns;
  std::istringstream names(line);
  while (std::getline(names, line, ',')) columns.push_back(line);
  const auto column =
      static_cast<std::size_t>(std::find(columns.begin(), columns.end(), "pull_force_N") - columns.begin());
  ASSERT_LT(column, columns.size());
  double least = 1e300, largest = -1e300, last = 0.0;
  while (std::getline(telemetry, line)) {
    std::istringstream cells(line);
    for (std::size_t k = 0; k <= column; ++k) std::getline(cells, line, ',');
    last = std::stod(line);
    least = std::min(least, last);
    largest = std::max(largest, last);
  }
  const json& read = s["sensors"]["pull_force_N"];
  EXPECT_DOUBLE_EQ(read["least"].get<double>(), least);
  EXPECT_DOUBLE_EQ(read["largest"].get<double>(), largest);
  EXPECT_DOUBLE_EQ(read["last"].get<double>(), last);
  EXPECT_NEAR(s["outcome"]["peak_torque_Nm"]["snare::carriage"].get<double>(), std::max(largest, -least),
              1e-9 * largest);
  EXPECT_GT(s["outcome"]["peak_torque_Nm"]["rms::shoulder_pitch"].get<double>(), 0.0);
}

// The arm with its carriage locked at first: what swings are its joints.
TEST_F(SimulateCommand, TellsWhatItSwingsByAtTheEnd) {
  ASSERT_EQ(run("ssrms_rigidize.toml", "--set duration_s=0.2 --set output.modes=true"), 0)
      << contents("log.txt");
  const json s = summary();
  ASSERT_GT(s["modes"].size(), 5U);
  double before = 0.0;
  for (const json& mode : s["modes"]) {
    EXPECT_GE(mode["frequency_Hz"].get<double>(), before);
    before = mode["frequency_Hz"].get<double>();
    for (const auto& [name, share] : mode["shares"].items()) {
      EXPECT_LE(share.get<double>(), 1.0 + 1e-9);
      EXPECT_TRUE(s["frequencies_Hz"].contains(name)) << name;
    }
  }
}

TEST_F(SimulateCommand, PayloadMeetsTheWireInAnEndEffector) {
  for (const char* name : {"jemrms_capture.toml", "jemrms_payload_on_wire.toml"}) {
    ASSERT_EQ(
        run(name,
            "--set duration_s=0.04 --set wires[wire].elements=24 --set 'bodies[payload].position_mm=[-10.0, "
            "-487.96, 0.0]'"),
        0)
        << contents("log.txt");
    const json s = summary();
    EXPECT_TRUE(s["finished"].get<bool>());
    EXPECT_GT(s["outcome"]["peak_force_N"]["probe on wire"].get<double>(), 0.1);
    EXPECT_EQ(s["outcome"]["peak_torque_Nm"].size(), 6u);
    // The payload brings 0.025 J.
    EXPECT_LT(std::abs(s["energy_J"]["integrator"].get<double>()), 2e-3 * 0.025);
    EXPECT_NE(contents("out/history.csv").find("rms::joint_6 deflection_deg"), std::string::npos);
    EXPECT_EQ(contents("out/history.csv").find("nan"), std::string::npos);
  }
}

// The buckled wire's bending alone, E d/2 times some 12/m, is more than 100 N on its section: the run ends at
// its first step.
TEST_F(SimulateCommand, AWireThatReachesItsStrengthEndsTheRunAndKeepsWhatItReached) {
  const std::string strength =
      "--set duration_s=0.01 --set wires[wire].elements=32 --set wires[wire].strength_N=100";
  ASSERT_EQ(run("air_table.toml", strength + " --set 'wires[wire].at_strength=\"stop\"'"), 3)
      << contents("log.txt");
  const json stopped = summary();
  EXPECT_FALSE(stopped["finished"].get<bool>());
  EXPECT_NE(stopped["message"].get<std::string>().find("wire reaches its strength of 100 N"),
            std::string::npos);
  ASSERT_EQ(stopped["strength"].size(), 1u);
  EXPECT_GT(stopped["strength"][0]["largest_share"].get<double>(), 1.0);
  EXPECT_NE(contents("out/history.csv").find("\n0,"), std::string::npos);
  ASSERT_EQ(run("air_table.toml", strength), 0) << contents("log.txt");
  EXPECT_GT(summary()["strength"][0]["bending_N"].get<double>(), 100.0);
  EXPECT_NE(contents("out/report.html").find("would break"), std::string::npos);
}

// A shaft among three wires strikes the lower one; names stand in the files.
TEST_F(SimulateCommand, GrappleShaftBetweenWires) {
  ASSERT_EQ(run("grapple_shaft.toml",
                "--set duration_s=0.16 --set wires[lower].elements=24 --set wires[left].elements=16 --set "
                "wires[right].elements=16"),
            0)
      << contents("log.txt");
  const json s = summary();
  ASSERT_EQ(s["contacts"].size(), 6u);
  EXPECT_EQ(s["contacts"][0]["contact"], "shaft on lower");
  EXPECT_EQ(s["contacts"][0]["wire"], "lower");
  EXPECT_EQ(s["bodies"][0]["body"], "target");
  EXPECT_GE(s["contacts"][0]["touches"].get<int>(), 1);
  EXPECT_EQ(s["contacts"][1]["touches"].get<int>(), 0);
  ASSERT_FALSE(s["events"].empty());
  EXPECT_EQ(s["events"][0]["contact"], "shaft on lower");
  // The bulge of 18.88 mm, half a cosine high, at the 6 mm that the shaft has drifted aside, less shaft and
  // wire radius, at 0.1 m/s; slope and extension of the wire move that by less than 0.1 mm.
  const double bulge = 18.88e-3 * 0.5 * (1.0 + std::cos(2.0 * std::acos(-1.0) * 6.0 / 175.0));
  EXPECT_NEAR(s["events"][0]["time_s"].get<double>(), (bulge - 6.75e-3) / 0.1, 1e-3);
  EXPECT_LT(s["largest_penetration_m"].get<double>(), 1e-6);
  EXPECT_NE(contents("out/history.csv").find("target vy_m_s"), std::string::npos);
  EXPECT_NE(contents("out/history.csv").find("shaft on lower normal_N"), std::string::npos);
  EXPECT_EQ(contents("out/history.csv").find("nan"), std::string::npos);
  EXPECT_NE(contents("out/report.html").find("class=\"scene\""), std::string::npos);
}

// Wires that cross stand among the contacts.
TEST_F(SimulateCommand, ABallPressesWiresOnEachOther) {
  ASSERT_EQ(run("ball_into_net.toml", "--set duration_s=0.008 --set wires[upper].elements=24"), 0)
      << contents("log.txt");
  const json s = summary();
  ASSERT_EQ(s["contacts"].size(), 6u);
  const json& pair = s["contacts"][3];
  EXPECT_EQ(pair["contact"], "upper on middle");
  EXPECT_EQ(pair["wire"], "upper");
  EXPECT_EQ(pair["other_wire"], "middle");
  EXPECT_FALSE(pair.contains("body"));
  EXPECT_GE(pair["touches"].get<int>(), 1);
  EXPECT_GT(pair["peak_force_N"].get<double>(), 1.0);
  EXPECT_GT(pair["impulse_Ns"][2].get<double>(), 0.0);  // the upper wire is held up
  EXPECT_LT(s["momentum_error_Ns"][2].get<double>(), 1e-6 * std::abs(pair["impulse_Ns"][2].get<double>()));
  EXPECT_NE(contents("out/history.csv").find("upper on middle normal_N"), std::string::npos);
  EXPECT_EQ(contents("out/history.csv").find("nan"), std::string::npos);
  EXPECT_NE(contents("out/report.html").find("middle on lower"), std::string::npos);
}

// Two wires without any body.
TEST_F(SimulateCommand, WiresAloneMeetEachOther) {
  std::ofstream(folder_ / "wires.toml") << R"(schema = "snare-scenario/2"
title = "one wire falls on another"
duration_s = 0.03
[gravity]
vector_m_s2 = [0.0, 0.0, -200.0]
[[wires]]
name = "upper"
construction = "solid"
diameter_mm = 1.0
length_mm = 101.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
from_mm = [-50.0, 0.0, 1.2]
to_mm = [50.0, 0.0, 1.2]
bulge = [0.0, 1.0, 0.0]
elements = 20
[[wires]]
name = "lower"
construction = "solid"
diameter_mm = 1.0
length_mm = 100.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
from_mm = [0.0, -50.0, 0.0]
to_mm = [0.0, 50.0, 0.0]
bulge = [1.0, 0.0, 0.0]
elements = 20
[[contacts]]
name = "crossing"
wire = "upper"
other_wire = "lower"
)";
  ASSERT_EQ(shell("'" SNARE_COMMAND "' simulate wires.toml --out out >log.txt 2>&1"), 0)
      << contents("log.txt");
  const json s = summary();
  EXPECT_TRUE(s["finished"].get<bool>());
  EXPECT_TRUE(s["bodies"].empty());
  ASSERT_EQ(s["contacts"].size(), 1u);
  EXPECT_EQ(s["contacts"][0]["contact"], "crossing");
  EXPECT_GE(s["contacts"][0]["touches"].get<int>(), 1);
}

TEST_F(SimulateCommand, JointStepSwingsSlowerAsItDies) {
  ASSERT_EQ(run("jemrms_step.toml", ""), 0) << contents("log.txt");
  const json s = summary();
  ASSERT_GE(s["swings"].size(), 2u);
  // The joint is soft within 0.04 deg (Abiko et al., Table 2): small swings are slower.
  EXPECT_GT(s["swings"].front()["frequency_Hz"].get<double>(),
            s["swings"].back()["frequency_Hz"].get<double>());
  // The spring began with the work of half a degree, some 0.95 J.
  EXPECT_LT(std::abs(s["energy_J"]["integrator"].get<double>()), 1e-3 * 0.95);
  EXPECT_NE(contents("out/report.html").find("Swings of the joint"), std::string::npos);
}

// Joint 3 stands at 80 deg of the pose plus the step of 0.5 deg: the table shows what the files say, not
// 80.49999999999999.
TEST_F(SimulateCommand, AnglesOfTheFilesHaveNoTailInTheHistory) {
  ASSERT_EQ(run("jemrms_step.toml", "--set duration_s=1"), 0) << contents("log.txt");
  std::istringstream history(contents("out/history.csv"));
  const auto cells_of = [&history] {
    std::string line, cell;
    std::getline(history, line);
    std::vector<std::string> cells;
    for (std::istringstream row(line); std::getline(row, cell, ',');) cells.push_back(cell);
    return cells;
  };
  const std::vector<std::string> names = cells_of();
  const auto column = static_cast<std::size_t>(
      std::find(names.begin(), names.end(), "rms::joint_3 motor_deg") - names.begin());
  ASSERT_LT(column, names.size());
  for (int k = 0; k < 3; ++k) EXPECT_EQ(cells_of().at(column), "80.5");
}

TEST_F(SimulateCommand, LimpArmIsPushed) {
  ASSERT_EQ(run("ssrms_push.toml", "--set duration_s=5"), 0) << contents("log.txt");
  const json energy = summary()["energy_J"];
  EXPECT_GT(energy["work"].get<double>(), 0.0);
  EXPECT_LT(std::abs(energy["integrator"].get<double>()), 1e-3 * energy["work"].get<double>());
}

TEST_F(SimulateCommand, WrongInputWritesNothing) {
  EXPECT_EQ(run("air_table.toml", "--set bodies[target].mass_kg=-1"), 2);
  EXPECT_NE(contents("log.txt").find("bodies[target].mass_kg = -1, must be > 0"), std::string::npos)
      << contents("log.txt");
  EXPECT_EQ(run("air_table.toml", "--set schema=\\\"snare-scenario/1\\\""), 2);
  EXPECT_NE(contents("log.txt").find("is read no more"), std::string::npos) << contents("log.txt");
  EXPECT_EQ(run("jemrms_step.toml", "--set output.swings=\\\"elbow\\\""), 2);
  EXPECT_NE(contents("log.txt").find("must be a joint with a motor"), std::string::npos)
      << contents("log.txt");
  EXPECT_EQ(run("none.toml", ""), 2);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace snare::app
