#include "scenario/scenario.hpp"

#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

namespace snare::scenario {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using ::testing::HasSubstr;

const fs::path source = SNARE_SOURCE_DIR;

/// An arm with a snare, a visitor with a shaft, and one of everything else.
const std::string one_of_everything = R"(schema = "snare-scenario/2"
title = "one of everything"
duration_s = 0.02
output_interval_s = 0.001
[damping]
bending_time_s = 1.0e-4
[[arms]]
name = "rms"
file = ")" + (source / "data/arms/jemrms_like.toml").string() +
                                      R"("
pose = "bent"
base_frame = "pad"
base_mm = [100.0, 0.0, 0.0]
[[frames]]
name = "pad"
rotation_deg = [0.0, 0.0, 90.0]
[[snares]]
name = "snare"
frame = "rms::tip"
position_mm = [0.0, 0.0, 50.0]
ring_radius_mm = 100.0
heights_mm = [-4.0, 0.0, 4.0]
[snares.ring]
start_deg = 115.0
[snares.carriage]
mass_kg = 2.0
[snares.wall]
radius_mm = 112.0
friction = 0.1
[snares.wire]
construction = "solid"
diameter_mm = 1.5
length_mm = 200.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
model = "quasi_static"
elements = 20
tight_N = 20.0
strength_N = 5000.0
[snares.wire_contact]
friction = 0.1
[[bodies]]
name = "visitor"
frame = "snare::fixed"
mass_kg = 500.0
inertia_kg_m2 = [400.0, 400.0, 100.0]
position_mm = [20.0, 0.0, 700.0]
velocity_m_s = [0.0, 0.0, -0.01]
[[bodies]]
name = "fixture"
frame = "visitor"
mass_kg = 10.0
inertia_kg_m2 = [1.0, 1.0, 1.0]
position_mm = [0.0, 0.0, -500.0]
[[bodies]]
name = "counterweight"
mass_kg = 10.0
inertia_kg_m2 = [1.0, 1.0, 1.0]
position_mm = [0.0, 5000.0, 0.0]
[[frames]]
name = "shaft"
frame = "fixture"
position_mm = [0.0, 0.0, -300.0]
[[shapes]]
name = "pin"
frame = "shaft"
kind = "capsule"
radius_mm = 6.0
length_mm = 250.0
position_mm = [0.0, 0.0, 125.0]
friction = 0.1
[[wires]]
name = "tether"
construction = "solid"
diameter_mm = 1.0
length_mm = 101.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
elements = 10
from_frame = "visitor"
from_mm = [2000.0, 0.0, 0.0]
to_frame = "visitor"
to_mm = [2100.0, 0.0, 0.0]
[[bushings]]
name = "gf"
frame = "visitor"
other_frame = "fixture"
translational_stiffness_N_m = 1.0e6
rotational_stiffness_Nm_rad = [1.0e4, 1.0e4, 2.0e4]
rotational_damping_Nms_rad = 10.0
[[welds]]
name = "ballast"
body = "counterweight"
frame = "visitor"
[[drives]]
joint = "rms::joint_1"
mode = "limp"
[[phases]]
name = "close"
at_s = 0.005
[[phases.drives]]
joint = "snare::ring"
mode = "course"
to_deg = 178.0
rate_deg_s = 58.0
[[phases]]
name = "tight"
when = [{ torque = "snare::ring", above_Nm = 10.0 }, { touch = ["pin on snare::wire_1"] }, { tension = "snare::wire_2", above_N = 5.0 }, { distance = ["shaft", "snare::fixed"], below_mm = 500.0 }, { speed = ["shaft", "snare::fixed"], below_m_s = 1.0 }, { angle = "snare::ring", above_deg = 116.0 }]
hold_s = 0.01
[[phases.drives]]
joint = "snare"
mode = "locked"
[[sensors]]
name = "gyro"
kind = "rate"
frame = "visitor"
rate_Hz = 500
noise = 0.01
[[sensors]]
name = "ring_torque"
kind = "joint_torque"
joint = "snare::ring"
[capture]
snare = "snare"
shaft_frame = "shaft"
)";

class Compositions : public test::FolderFixture {
 protected:
  [[nodiscard]] WireMotions read(const std::vector<std::string>& settings,
                                 const std::string& text = one_of_everything) {
    std::ofstream(folder_ / "case.toml") << text;
    return read_scenario(folder_ / "case.toml", test::overrides(settings)).motions;
  }
  /// The text with one piece in place of another, which it must have once.
  static std::string with(const std::string& piece, const std::string& other,
                          std::string text = one_of_everything) {
    const std::size_t found = text.find(piece);
    EXPECT_NE(found, std::string::npos) << piece;
    if (found != std::string::npos) text.replace(found, piece.size(), other);
    return text;
  }
};

class SlowCompositions : public Compositions {};

// The fixed mounts stand at first_wire_deg + 360 (k - 1)/n about the axis, and only the turning ones go the
// other way.
TEST_F(Compositions, WiresOfASnareAreCountedTheSameWhicheverWayItCloses) {
  const WireMotions left = read({}), right = read({"snares[snare].turns=\"right\""});
  for (std::size_t k = 1; k <= 3; ++k) {
    const Eigen::Matrix3Xd& a = left.runs.front().motion.wires[k].positions;
    const Eigen::Matrix3Xd& b = right.runs.front().motion.wires[k].positions;
    EXPECT_NEAR((a.col(0) - b.col(0)).norm(), 0.0, 1e-12);  // rounding on metres
    EXPECT_GT((a.rightCols<1>() - b.rightCols<1>()).norm(), 0.1);
  }
}

TEST_F(Compositions, ShapesWithoutAFrameStandOnTheWorld) {
  EXPECT_NO_THROW(
      static_cast<void>(read({}, with("name = \"pin\"\nframe = \"shaft\"\n", "name = \"pin\"\n"))));
}

TEST_F(Compositions, PutEverythingWhereItBelongs) {
  const WireMotions all = read({});
  const coupling::Motion& m = all.runs.front().motion;
  ASSERT_EQ(m.arms.size(), 1u);
  // Six joints of the arm, the carriage and the ring.
  EXPECT_EQ(m.arms[0].arm.motors(), 8);
  EXPECT_NEAR(m.arms[0].start.q[7], 115.0 * std::numbers::pi / 180.0, 1e-12);
  ASSERT_EQ(m.wires.size(), 4u);
  EXPECT_EQ(m.wires[0].name, "tether");
  EXPECT_EQ(m.wires[1].name, "snare::wire_1");
  EXPECT_EQ(m.mounts.size(), 8u);
  EXPECT_EQ(m.wire_pairs.size(), 3u);
  EXPECT_EQ(m.bushings.size(), 1u);
  // Wires on the circle of their ring about the axis of the snare, 115 degrees apart, at their heights.
  const Vector3d a = m.wires[1].positions.col(0), b = m.wires[1].positions.rightCols<1>();
  EXPECT_NEAR((b - a).norm(), 0.2 * std::sin(57.5 * std::numbers::pi / 180.0), 1e-12);
  const Vector3d c = m.wires[2].positions.col(0), d = m.wires[3].positions.col(0);
  EXPECT_NEAR((c - a).norm(), std::hypot(0.1 * std::sqrt(3.0), 0.004), 1e-12);
  EXPECT_NEAR((d - c).norm(), std::hypot(0.1 * std::sqrt(3.0), 0.004), 1e-12);
  // The pin meets all wires, the wall those of its snare: visitor's fixture carries the one, a body of its
  // own the other.
  int pins = 0, walls = 0;
  for (const coupling::MotionContact& contact : m.contacts) {
    pins += contact.name.starts_with("pin on ");
    walls += contact.name.starts_with("snare::wall on snare::wire_");
  }
  EXPECT_EQ(pins, 4);
  EXPECT_EQ(walls, 3);
  EXPECT_EQ(m.welds.size(), 2u);
  EXPECT_EQ(m.phases.size(), 2u);
  EXPECT_EQ(m.phases[1].bounds.size(), 6u);
  EXPECT_EQ(m.phases[1].drives.size(), 2u);
  EXPECT_EQ(m.arms[0].drives[0].mode, multibody::DriveMode::limp);
  EXPECT_EQ(all.sensors.size(), 2u);
  ASSERT_TRUE(all.capture);
  EXPECT_EQ(all.capture->wires, (std::vector<int>{1, 2, 3}));
}

TEST_F(Compositions, HaveDefaultsInTheUnitsOfTheFile) {
  const WireMotions all = read({}, with("[snares.ring]\nstart_deg = 115.0\n", ""));
  EXPECT_NEAR(all.runs.front().motion.arms[0].start.motor[7], 115.0 * std::numbers::pi / 180.0, 1e-12);
  // The wall is 60 mm long and 5 mm thick.
  Eigen::AlignedBox3d box;
  for (const DrawnLines& d : all.drawn) {
    if (d.name != "snare::wall") continue;
    for (const Eigen::Matrix3Xd& line : d.lines)
      for (Eigen::Index i = 0; i < line.cols(); ++i) box.extend(line.col(i));
  }
  EXPECT_NEAR(box.sizes().z(), 0.06, 1e-12);
  EXPECT_NEAR(box.sizes().x(), 2.0 * (0.112 + 0.005), 1e-12);
}

TEST_F(Compositions, RunAllOfItInOneSystem) {
  const WireMotions all = read({});
  const NamedMotion& run = all.runs.front();
  const coupling::MotionResult result = coupling::simulate(run.motion, run.options);
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_LT(result.largest_drift, 1e-7);
  ASSERT_EQ(result.phases.size(), 1u);
  EXPECT_EQ(result.phases[0].time, 0.005);
}

// A list of the older schema is read when it says what the refusal asks for.
TEST_F(Compositions, ListsOfTheOlderSchemaNeedTwoLinesChanged) {
  std::stringstream text;
  text << std::ifstream(source / "data/scenarios/grapple_shaft.toml").rdbuf();
  const std::string newer = text.str();
  const std::string older = with("snare-scenario/2\"", "snare-scenario/1\"\nkind = \"contact\"", newer);
  EXPECT_THAT(test::refusal([&] { return read({}, older); }),
              testing::EndsWith("schema = \"snare-scenario/1\", is read no more: change the line to schema = "
                                "\"snare-scenario/2\" and take kind out"));
  EXPECT_EQ(read({}, newer).runs.front().motion.wires.size(), 3u);
}

// The frames of the second one are there already.
TEST_F(Compositions, TwoSnaresOfOneNameAreWrongInput) {
  const std::size_t begin = one_of_everything.find("[[snares]]");
  const std::string snare = one_of_everything.substr(begin, one_of_everything.find("[[bodies]]") - begin);
  EXPECT_THROW(static_cast<void>(read({}, one_of_everything + snare)), base::InputError);
}

// A mass whose reciprocal is no number.
TEST_F(Compositions, AStartThatIsNotFiniteIsRefused) {
  const WireMotions all = read({"bodies[visitor].mass_kg=5e-324"});
  EXPECT_THROW(static_cast<void>(coupling::simulate(all.runs.front().motion, all.runs.front().options,
                                                    [](const coupling::MotionSample&) { return false; })),
               base::InputError);
}

TEST_F(Compositions, SayWhatIsWrong) {
  const test::WrongSetting wrong[] = {
      {"kind=\"contact\"", "belongs to older files: take the line out"},
      {"duration_s=0", "duration_s = 0, must be > 0"},
      {"output_interval_s=-1", "output_interval_s = -1, must be > 0"},
      {"arms[rms].file=\"none.toml\"", "none.toml"},
      {"arms[rms].pose=\"bend\"",
       "arms[rms].pose = \"bend\", must be a pose of the arm: \"straight\", \"bent\""},
      {"arms[rms].hold=\"free\"",
       "arms[rms].hold = \"free\", must be \"as_described\", \"limp\" or \"locked\""},
      {"arms[rms].base_frame=\"moon\"", "arms[rms].base_frame = \"moon\", must be the name of a frame: "},
      {"arms[rms].base_frame=\"counterweight\"", "must stand still"},
      {"arms[rms].tip_frame=\"pad\"", "cannot stand beside base_frame"},
      {"arms[rms].held_joints=[\"joint_1\"]", "held_joints = [\"joint_1\"], only beside reach_frame"},
      {"arms[rms].reach_frame=\"visitor\"",
       "bodies[visitor].frame = \"snare::fixed\", must not stand on itself"},
      {"arms[rms].base_mm=[1.0]", "arms[rms].base_mm = [1.0], must be an array of 3 numbers"},
      {"arms[rms].name=\"a::b\"", "must not have \"::\""},
      {"bodies[visitor].name=\"<b>\"",
       "must be 1 to 64 letters, digits, spaces or \"_-.+()\", the first a letter"},
      {"sensors[gyro].name=\"../gyro\"", "must be 1 to 64 letters"},
      {"snares[snare].wire.torsional_stiffness_Nm2=1e-9",
       "must leave a quasi-static wire a torsional stiffness of at least 0.001 of its bending stiffness"},
      {"damping.axial_time_s=1.0", "damping.axial_time_s = 1.0, must be"},
      {"solver.least_advance_s=-1.0", "solver.least_advance_s = -1.0, must be >= 0"},
      {"frames[pad].frame=\"rms::tip\"", "must not stand on itself by way of others"},
      {"frames[pad].frame=\"pad\"", "must not stand on itself by way of others"},
      {"frames[shaft].frame=\"nowhere\"", "frames[shaft].frame = \"nowhere\", must be the name of a frame: "},
      {"frames[shaft].name=\"pad\"", "is taken by another frame"},
      {"frames[shaft].name=\"visitor\"", "is taken by a body, an arm or a snare"},
      {"frames[pad].rpy_deg=[0,0,1]", "cannot stand beside rotation_deg"},
      {"snares[snare].frame=\"counterweight\"", "must be fixed in the world or on an arm"},
      {"snares[snare].frame=\"visitor\"",
       "snares[snare].frame = \"visitor\", must not stand on itself by way of others"},
      {"snares[snare].frame=\"rms::thumb\"",
       "snares[snare].frame = \"rms::thumb\", must be the name of a frame"},
      {"snares[snare].ring_radius_mm=0", "snares[snare].ring_radius_mm = 0, must be > 0"},
      {"snares[snare].wires=4", "snares[snare].heights_mm = [-4.0, 0.0, 4.0], must be an array of 4 numbers"},
      {"snares[snare].wires=-1", "snares[snare].wires = -1"},
      {"snares[snare].turns=\"up\"", "snares[snare].turns = \"up\", must be \"left\" or \"right\""},
      {"snares[snare].ring.start_deg=400", "snares[snare].ring.start_deg = 400"},
      {"snares[snare].wire.length_mm=150", "snares[snare].wire.length_mm = 150, must be >= 1"},
      {"snares[snare].ring.stiffness_Nm_rad=0", "snares[snare].ring.stiffness_Nm_rad = 0, must be > 0"},
      {"snares[snare].ring.stiffness_N_m=1", "snares[snare].ring.stiffness_N_m = 1, unknown key"},
      {"snares[snare].carriage.mass_kg=-1", "snares[snare].carriage.mass_kg = -1, must be > 0"},
      {"snares[snare].wall.radius_mm=100", "snares[snare].wall.radius_mm = 100, must be > 1"},
      {"snares[snare].wire.diameter_mm=0", "snares[snare].wire.diameter_mm = 0, must be > 0"},
      {"snares[snare].wire.model=\"table\"",
       "snares[snare].wire.model = \"table\", must be \"full\", \"quasi_static\", \"stretched\", \"rod\" or "
       "\"rod_linear\""},
      {"snares[snare].wire.strand_slip_breadth=1",
       "only beside strand_extra_stiffness_Nm2 and strand_slip_curvature_1_m"},
      {"snares[snare].wire.tight_N=0", "snares[snare].wire.tight_N = 0, must be > 0"},
      {"snares[snare].wire.tight_hold_s=-1", "snares[snare].wire.tight_hold_s = -1, must be >= 0"},
      {"snares[snare].wire_contact.friction=9", "snares[snare].wire_contact.friction = 9"},
      {"bodies[visitor].frame=\"shaft\"", "must not stand on itself by way of others"},
      {"bodies[visitor].mass_kg=0", "bodies[visitor].mass_kg = 0, must be > 0"},
      {"bodies[visitor].robot.mass_kg=5", "bodies[visitor].robot, only of a body with driven = true"},
      {"bodies[fixture].name=\"visitor\"", "is taken by another body"},
      {"shapes[pin].frame=\"axle\"", "shapes[pin].frame = \"axle\", must be the name of a frame"},
      {"shapes[pin].body=\"visitor\"", "cannot stand beside body, which means the same"},
      {"shapes[pin].wires=[\"rope\"]", "must be the name of a wire: \"tether\", \"snare::wire_1\""},
      {"wires[tether].to_frame=\"none\"", "wires[tether].to_frame = \"none\", must be the name of a frame"},
      {"wires[tether].to_mm=[2000.0,0.0,0.0]", "must not be where the wire begins"},
      {"damping.mass_rate_1_s=1", "damping.mass_rate_1_s = 1, must be 0: it drags against the world"},
      {"bushings[gf].other_frame=\"visitor\"",
       "bushings[gf].other_frame = \"visitor\", must be another frame"},
      {"bushings[gf].translational_stiffness_N_m=-1",
       "bushings[gf].translational_stiffness_N_m = -1, must be >= 0"},
      {"bushings[gf].rotational_stiffness_Nm_rad=[1.0,2.0]", "must be an array of 3 numbers"},
      {"welds[ballast].body=\"moon\"",
       "welds[ballast].body = \"moon\", must be the name of a body: \"visitor\""},
      {"welds[ballast].frame=\"counterweight\"",
       "welds[ballast].frame = \"counterweight\", must not be on the body itself"},
      {"drives[1].joint=\"rms::elbow\"", "must be a joint, or an arm or a snare for all of theirs: "},
      {"drives[1].mode=\"hold\"", "must be \"locked\", \"servo\", \"limp\", \"torque\" or \"course\""},
      {"drives[1].to_deg=5", "drives[1].to_deg = 5, unknown key"},
      {"phases[close].at_s=-1", "phases[close].at_s = -1, must be >= 0"},
      {"phases[tight].at_s=0.001", "must not be before that of an earlier phase"},
      {"phases[close].hold_s=1", "only beside conditions"},
      {"phases[close].name=\"tight\"", "is taken by another phase"},
      {"phases[close].drives[1].rate_deg_s=0", "phases[close].drives[1].rate_deg_s = 0, must be > 0"},
      {"phases[close].drives[1].duration_s=1", "cannot stand beside rate_deg_s"},
      {"phases[close].drives[1].by_deg=5", "cannot stand beside to_deg"},
      {"phases[close].drives[1].course_file=\"none.csv\"", "cannot stand beside course_file"},
      {"phases[tight].when[1].above_Nm=\"much\"", "phases[tight].when[1].above_Nm = \"much\""},
      {"phases[tight].when[1].below_Nm=1", "must have either above_Nm or below_Nm"},
      {"phases[tight].when[3].sensor=\"gyro\"", "cannot stand beside tension"},
      {"phases[tight].when[3].tension=\"rope\"", "must be the name of a wire: \"tether\""},
      {"phases[tight].when[2].touch=[\"pin on rope\"]", "must be a contact: \"pin on tether\""},
      {"phases[tight].when[4].distance=[\"shaft\"]", "must name two frames"},
      {"phases[tight].when[6].angle=\"snare::hoop\"", "must be a joint with a motor: "},
      {"sensors[gyro].kind=\"radar\"", "sensors[gyro].kind = \"radar\", must be \"position\""},
      {"sensors[gyro].frame=\"moon\"", "sensors[gyro].frame = \"moon\", must be the name of a frame"},
      {"sensors[gyro].rate_Hz=300", "must be 1/output_interval_s, 1000, or that divided by a whole number"},
      {"sensors[gyro].noise=-1", "sensors[gyro].noise = -1, must be >= 0"},
      {"sensors[ring_torque].joint=\"snare\"", "must be a joint with a motor"},
      {"sensors[ring_torque].name=\"gyro\"", "is taken by another sensor"},
      {"capture.snare=\"net\"", "capture.snare = \"net\", must be a snare: \"snare\""},
      {"capture.shaft_frame=\"axle\"", "capture.shaft_frame = \"axle\", must be the name of a frame"},
      {"capture.hold_s=-1", "capture.hold_s = -1, must be >= 0"},
      {"gravity.vector_m_s2=[0.0]", "gravity.vector_m_s2 = [0.0], must be an array of 3 numbers"},
      {"solver.max_order=9", "solver.max_order = 9"},
      {"solver.newton_share=0.6", "solver.newton_share = 0.6"},
      {"output.modes=1", "output.modes = 1"},
      {"bushing=1", "bushing = 1, unknown key"},
  };
  test::expect_refused(wrong, [&](const char* setting) { return read({setting}); });
  EXPECT_NO_THROW((void)read({"frames[shaft].rpy_deg=[0,0,1]"}));
  const auto reaching = [](const std::string& how) {
    return with("pose = \"bent\"", "pose = \"bent\"\nreach_" + how);
  };
  const auto sensing = [](const std::string& how) {
    return with("{ tension = \"snare::wire_2\", above_N = 5.0 }", "{ " + how + " }");
  };
  const auto robot = [](const std::string& how) {
    const std::string place = "position_mm = [0.0, 5000.0, 0.0]\n";
    return with(place, place + "driven = true\n[bodies.robot]\n" + how + "\n");
  };
  const std::pair<std::string, const char*> texts[] = {
      {with("[[welds]]\nname = \"ballast\"\nbody = \"counterweight\"\nframe = \"visitor\"",
            "[[welds]]\nname = \"a\"\nbody = \"counterweight\"\nframe = \"fixture\"\n[[welds]]\nname = "
            "\"b\"\nbody = "
            "\"counterweight\"\nframe = \"visitor\""),
       "is welded already: two welds would hold six freedoms twice"},
      {with(
           "body = \"counterweight\"\nframe = \"visitor\"",
           "body = \"visitor\"\nframe = \"fixture\"\n[[welds]]\nname = \"back\"\nbody = \"fixture\"\nframe = "
           "\"visitor\""),
       "must not hold each other in a circle"},
      {with("[[drives]]", "[[drives]]\njoint = \"rms\"\nmode = \"locked\"\n[[drives]]"), "is driven already"},
      {with("{ touch = [\"pin on snare::wire_1\"] }", "{ above_N = 1.0 }"),
       "must have one of touch, sensor, contact, tension"},
      {reaching("frame = \"counterweight\"\nreach_mm = [0.0, 90000.0, 0.0]"),
       "is out of reach: the tip comes no nearer than 85024.9 mm and 78.3807 deg"},
      {reaching("frame = \"moon\""), "arms[rms].reach_frame = \"moon\", must be the name of a frame: "},
      {reaching("frame = \"counterweight\"\nheld_joints = [\"joint_9\"]"),
       "arms[rms].held_joints[1] = \"joint_9\", must be a joint of the arm: \"joint_1\""},
      {reaching("frame = \"counterweight\"\nheld_joints = [\"joint_1\"]"),
       "needs six joints that move, there are 5"},
      {with("base_frame = \"pad\"\nbase_mm = [100.0, 0.0, 0.0]",
            "reach_frame = \"pad\"\ntip_frame = \"counterweight\""),
       "arms[rms].reach_frame = \"pad\", cannot stand beside tip_frame, by which the base follows"},
      {sensing("sensor = \"radar\""), "must be a sensor: \"gyro\", \"ring_torque\""},
      {sensing("sensor = \"gyro\", axis = \"w\", above_deg_s = 5.0"),
       "axis = \"w\", must be \"x\", \"y\" or \"z\""},
      {sensing("sensor = \"ring_torque\", axis = \"x\", above_Nm = 5.0"),
       "only of a sensor that reads three numbers"},
      {sensing("sensor = \"gyro\", axis = \"x\""), "must have either above_deg_s or below_deg_s"},
      {robot("mass_kg = 5.0\ndelay_s = 0.001\ncontacts = [\"pin on snare::wire_1\"]"),
       "must be contacts of this body: \"pin on snare::wire_1\" is between others"},
      {robot("mass_kg = 5.0\ndelay_s = 0.0\ncontacts = [\"pin on tether\"]"),
       "robot.delay_s = 0.0, must be > 0"},
      {robot("mass_kg = 5.0\ndelay_s = 0.001"),
       "must name the contacts whose force on the body the robot measures"},
      {"schema = \"snare-scenario/2\"\ntitle = \"nothing\"\nduration_s = 1.0\n",
       "must list something that moves"},
      {"schema = \"snare-scenario/3\"\ntitle = \"later\"\n", "must be \"snare-scenario/2\""},
  };
  for (const auto& one : texts) {
    EXPECT_THAT(test::refusal([&] { return read({}, one.first); }), HasSubstr(one.second));
  }
}

// Centred and without friction, in equilibrium, a taut wire on a shaft is 2 sqrt(R^2 - r^2) + r (theta -
// theta_t) long, theta_t = 2 acos(r/R): that gives the angle of the ring at a tension. On the shaft the
// tension is T - EI/(2 r^2) and the moment
// EI/r, so that the ring's torque is n (T r + EI/(2 r)).                                               (M.24)
TEST_F(SlowCompositions, SnareTightensAsTheClosedForm) {
  constexpr double degree = std::numbers::pi / 180.0;
  const WireMotions all = read({}, R"(schema = "snare-scenario/2"
title = "a snare closes on a pin"
duration_s = 1.2
output_interval_s = 0.01
[damping]
bending_time_s = 1.0e-4
[[snares]]
name = "snare"
ring_radius_mm = 100.0
[snares.ring]
start_deg = 140.0
[snares.wire]
construction = "solid"
bending_stiffness_Nm2 = 1.0e-4
diameter_mm = 1.5
length_mm = 200.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
model = "quasi_static"
elements = 120
[[shapes]]
name = "pin"
frame = "world"
kind = "cylinder"
radius_mm = 6.0
length_mm = 60.0
[[phases]]
name = "close"
[[phases.drives]]
joint = "snare::ring"
mode = "course"
to_deg = 178.5
rate_deg_s = 58.0
)");
  const NamedMotion& run = all.runs.front();
  std::vector<coupling::MotionSample> samples;
  const coupling::MotionResult result =
      coupling::simulate(run.motion, run.options, [&](const coupling::MotionSample& s) {
        samples.push_back(s);
        return false;
      });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  const coupling::MotionSample& end = samples.back();
  const double R = 0.1, r = 0.00675, length = 0.2;
  const double stiffness = run.motion.wires[0].rod.properties.axial_stiffness;
  const double bending = run.motion.wires[0].rod.properties.bending_stiffness;
  for (std::size_t w = 0; w < 3; ++w) {
    const double tension = coupling::end_tension(end, w);
    ASSERT_GT(tension, 400.0);
    const double taut = length * (1.0 + tension / stiffness);
    const double angle = 2.0 * std::acos(r / R) + (taut - 2.0 * std::sqrt(R * R - r * r)) / r;
    EXPECT_NEAR(end.arms[0].state.q[0], angle, 1e-4 * angle);
    EXPECT_NEAR(angle, 178.5 * degree, 1e-3);
    const double torque = 3.0 * (tension * r + 0.5 * bending / r);
    EXPECT_NEAR(-end.arms[0].joint_torque[0], torque, 3e-4 * torque);
  }
}

}  // namespace
}  // namespace snare::scenario
