// What no wire can be or bear is said, wherever the result is read.

#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <string>

namespace snare::app {
namespace {

class Warnings : public CommandFixture {
 protected:
  [[nodiscard]] std::string experiment(const std::string& more_of_wire, const std::string& more = "") const {
    return "schema = \"snare-experiment/1\"\ntitle = \"test\"\nsource = \"none\"\n" +
           test::wire_tables("176.0", more_of_wire) +
           "[solver]\nelements = 32\n[[series]]\nname = \"s\"\ncontact_position_mm = 60.0\ntravel_mm = "
           "1.0\npoints = "
           "5\n" +
           more;
  }
  /// Said on the console and in the JSON.
  void expect_said(const std::string& arguments, const std::string& words) const {
    ASSERT_EQ(run("push x.toml --out here --json " + arguments), 0) << contents("err.txt");
    EXPECT_NE(contents("err.txt").find("warning: " + words), std::string::npos) << contents("err.txt");
    bool found = false;
    const nlohmann::json result = nlohmann::json::parse(contents("out.txt"));
    for (const nlohmann::json& warning : result["warnings"])
      found = found || warning.get<std::string>().find(words) == 0;
    EXPECT_TRUE(found) << contents("out.txt");
  }
};

TEST_F(Warnings, APushOfWhatCannotBe) {
  write("x.toml", experiment(""));
  ASSERT_EQ(run("push x.toml --out here --quiet --json"), 0) << contents("err.txt");
  EXPECT_TRUE(nlohmann::json::parse(contents("out.txt"))["warnings"].empty()) << contents("out.txt");
  expect_said("--set wire.axial_stiffness_N=1600000",
              "the axial stiffness is 4.69 times that of a solid wire of 1.5 mm");
  expect_said("--set wire.youngs_modulus_GPa=500", "the modulus of 500 GPa is above that of every metal");
  expect_said("--set series[s].travel_mm=20", "series s: the stress in the wire reaches ");
  expect_said("--set bulge.mode=2 --set wire.length_mm=180",
              "series s: the wire leaves the pusher after a travel of 0 mm");
  expect_said(
      "--set pusher.direction='\"inward\"' --set series[s].contact_position_mm=87.5 --set "
      "series[s].travel_mm=6",
      "series s: the curve runs along an unstable branch from a travel of ");
}

TEST_F(Warnings, SupportsThatPull) {
  write("x.toml", experiment(""));
  const std::string supports =
      "--set mount.kind='\"supports\"' --set mount.support_radius_mm=0 --set wire.length_mm=200 ";
  expect_said(supports + "--set gravity.vector_m_s2=[0,-9.81,0]",
              "series s: the supports would have to pull by ");
  ASSERT_EQ(run("push x.toml --out here " + supports + "--set gravity.vector_m_s2=[0,9.81,0]"), 0);
  EXPECT_EQ(contents("err.txt").find("supports"), std::string::npos) << contents("err.txt");
}

// One sentence for all series, of the one with the largest stress.
TEST_F(Warnings, AStressInSeveralSeries) {
  write(
      "x.toml",
      experiment("", "[[series]]\nname = \"t\"\ncontact_position_mm = 40.0\ntravel_mm = 20.0\npoints = 5\n"));
  ASSERT_EQ(run("push x.toml --out here --json --set series[s].travel_mm=20"), 0) << contents("err.txt");
  const std::string said = contents("err.txt");
  const std::size_t at = said.find("the stress in the wire reaches ");
  ASSERT_NE(at, std::string::npos) << said;
  EXPECT_NE(said.find(". It is too large in ", at), std::string::npos) << said;
  EXPECT_EQ(said.find("the stress in the wire reaches ", at + 1), std::string::npos) << said;
}

// Readings of the other sign are no misfit of the wire.
TEST_F(Warnings, ForcesOfTheOtherSign) {
  std::string text = experiment("");
  text.replace(text.find("travel_mm = 1.0\npoints = 5\n"), 27, "file = \"s.csv\"\n");
  write("x.toml", text);
  write("s.csv", "displacement_mm,force_N\n0,0\n0.2,-0.2\n0.4,-0.4\n0.6,-0.7\n0.8,-1\n1,-1.4\n");
  expect_said("", "series[s]: 100 % of the forces have the other sign than a wire that resists the push");
  expect_said("--set 'series[s].scale={ displacement_mm = -1 }'",
              "series[s]: displacement_mm goes below zero only, where it should count along the push");
}

// A pusher that is drawn back past first touch leaves the wire as it should.
TEST_F(Warnings, AWithdrawnPusherIsNone) {
  write("x.toml", experiment(""));
  std::string text = contents("x.toml");
  text.replace(text.find("travel_mm = 1.0\n"), 16, "path_mm = [0.0, 1.0, -0.5]\n");
  write("x.toml", text);
  ASSERT_EQ(run("push x.toml --out here --quiet --json"), 0) << contents("err.txt");
  EXPECT_TRUE(nlohmann::json::parse(contents("out.txt"))["warnings"].empty()) << contents("out.txt");
}

// A fitted stiffness that no wire has, on the page, too.
TEST_F(Warnings, AFitOfWhatCannotBe) {
  std::string csv = "displacement_mm,force_N\n";
  for (int i = 0; i <= 20; ++i)
    csv += std::to_string(0.05 * i) + "," + std::to_string(4.0 * i + 2.0 * i * i) + "\n";
  write("r.csv", csv);
  write("x.toml",
        experiment("bending_stiffness_Nm2 = 0.048\n") + "[fit]\nfree = [\"wire.bending_stiffness_Nm2\"]\n");
  std::string text = contents("x.toml");
  text.replace(text.find("travel_mm = 1.0\npoints = 5"), 26, "file = \"r.csv\"");
  write("x.toml", text);
  ASSERT_EQ(run("trace x.toml --out here"), 0) << contents("err.txt");
  EXPECT_NE(contents("err.txt").find("warning: fitted model"), std::string::npos) << contents("err.txt");
  EXPECT_FALSE(parsed("here/trace.json")["warnings"].empty());
  EXPECT_NE(contents("here/report.html").find("Warning: fitted model"), std::string::npos);
}

// An integrator that loses more than 1 % of the exchanged energy is reported: backward Euler at coarse
// tolerances damps a swing.
TEST_F(Warnings, AMotionThatLosesEnergy) {
  write("x.toml", R"(schema = "snare-scenario/2"
title = "a body on springs"
duration_s = 0.5
[[bodies]]
name = "b"
mass_kg = 1.0
inertia_kg_m2 = [0.01, 0.01, 0.01]
velocity_m_s = [1.0, 0.0, 0.0]
[[bushings]]
name = "springs"
frame = "world"
other_frame = "b"
translational_stiffness_N_m = 1000.0
rotational_stiffness_Nm_rad = 10.0
)");
  ASSERT_EQ(run("simulate x.toml --out here"), 0) << contents("err.txt");
  EXPECT_TRUE(parsed("here/summary.json")["warnings"].empty()) << contents("here/summary.json");
  ASSERT_EQ(
      run("simulate x.toml --out there --set solver.max_order=1 --set solver.body_position_tolerance_m=1e-4 "
          "--set solver.body_velocity_tolerance_m_s=1e-2"),
      0)
      << contents("err.txt");
  EXPECT_NE(contents("err.txt").find("warning: the integrator lost "), std::string::npos)
      << contents("err.txt");
  EXPECT_EQ(parsed("there/summary.json")["warnings"].size(), 1U);
}

TEST_F(Warnings, ABlowThatBreaks) {
  const std::string scenario = SNARE_SOURCE_DIR "/data/scenarios/air_table.toml";
  const int status =
      run("simulate '" + scenario +
          "' --out here --set duration_s=2e-4 --set output_interval_s=1e-5 --set wires[wire].elements=12 "
          "--set 'bodies[target].velocity_m_s=[0,400,0]'");
  EXPECT_TRUE(status == 0 || status == 3) << contents("err.txt");
  EXPECT_NE(contents("err.txt").find("is struck at 399."), std::string::npos) << contents("err.txt");
  EXPECT_FALSE(parsed("here/summary.json")["warnings"].empty());
  EXPECT_NE(contents("here/report.html").find("Warning: "), std::string::npos);
}

}  // namespace
}  // namespace snare::app
