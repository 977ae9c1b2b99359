#include "scenario/scenario.hpp"

#include "tests/support/folder_fixture.hpp"
#include "tests/support/mesh_files.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace snare::scenario {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

const fs::path shipped = fs::path(SNARE_SOURCE_DIR) / "data/scenarios/grapple_shaft.toml";

/// One wire, one body, and one shape of every kind.
constexpr const char* every_kind = R"(schema = "snare-scenario/2"
title = "every kind"
duration_s = 0.01
[gravity]
vector_m_s2 = [0.0, 0.0, -9.81]
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
bulge = [1.0, 0.0, 0.2]
strength_N = 5000.0
at_strength = "stop"
mount = "pinned"
elements = 20
[[bodies]]
name = "target"
mass_kg = 2.0
inertia_kg_m2 = [0.1, 0.2, 0.25]
position_mm = [-200.0, 0.0, 0.0]
rotation_deg = [0.0, 0.0, 90.0]
[[bodies]]
name = "machine"
driven = true
velocity_m_s = [0.0, 0.1, 0.0]
position_mm = [-300.0, 0.0, 0.0]
[[shapes]]
name = "edge"
body = "target"
kind = "knife_edge"
length_mm = 10.0
[[shapes]]
name = "pin"
body = "target"
kind = "cylinder"
radius_mm = 3.0
length_mm = 10.0
points = 2
[[shapes]]
name = "ball"
body = "machine"
kind = "sphere"
radius_mm = 3.0
wires = ["a"]
friction = 0.1
static_friction = 0.3
[[shapes]]
name = "rod"
body = "target"
kind = "capsule"
radius_mm = 3.0
length_mm = 10.0
position_mm = [0.0, 20.0, 0.0]
rotation_deg = [90.0, 0.0, 0.0]
[[shapes]]
name = "taper"
body = "target"
kind = "cone"
lower_radius_mm = 3.0
upper_radius_mm = 0.0
length_mm = 10.0
[[shapes]]
name = "shaft"
body = "target"
kind = "grapple_shaft"
[[shapes]]
name = "box"
body = "target"
kind = "mesh"
file = "box.stl"
unit = "mm"
[[shapes]]
name = "housing"
body = "target"
kind = "ring"
inner_radius_mm = 100.0
outer_radius_mm = 104.0
length_mm = 50.0
rounding_mm = 2.0
[[shapes]]
name = "end"
body = "target"
kind = "cup"
inner_radius_mm = 100.0
depth_mm = 50.0
thickness_mm = 4.0
rounding_mm = 1.0
fillet_mm = 3.0
[[shapes]]
name = "ground"
body = "target"
kind = "plane"
[[shapes]]
name = "spool"
body = "target"
kind = "revolved"
radius_mm = [0.0, 20.0, 20.0, 10.0, 10.0, 20.0, 20.0, 0.0]
height_mm = [0.0, 0.0, 5.0, 5.0, 25.0, 25.0, 30.0, 30.0]
rounding_mm = [0.0, 0.0, 1.0, 2.0, 2.0, 1.0, 0.0, 0.0]
)";

class MotionScenarios : public test::FolderFixture {
 protected:
  MotionScenarios() {
    test::write_mesh(path("box.stl"), test::cuboid(8e-3, 6e-3, 4e-3), 1e-3);
    write("every_kind.toml", every_kind);
  }
  [[nodiscard]] NamedMotion read(const std::vector<std::string>& settings) const {
    return read_scenario(path("every_kind.toml"), test::overrides(settings)).motions.runs.at(0);
  }
};

TEST_F(MotionScenarios, ReadEveryKindOfShape) {
  const NamedMotion s = read({});
  ASSERT_EQ(s.motion.wires.size(), 1u);
  ASSERT_EQ(s.motion.bodies.size(), 2u);
  ASSERT_EQ(s.motion.contacts.size(), 11u);
  const auto shape = [&s](std::size_t k) -> const coupling::ContactShape& {
    return *s.motion.contacts[k].shape;
  };
  EXPECT_NEAR(shape(0).distance({0.0, 4e-3, 5e-3}), 4e-3, 1e-15);
  EXPECT_NEAR(shape(1).distance({0.0, 7e-3, 8e-3}), 5e-3, 1e-15);
  EXPECT_NEAR(shape(2).distance({0.0, 7e-3, 0.0}), 4e-3, 1e-15);
  EXPECT_NEAR(shape(3).distance({0.0, 7e-3, 5e-3}), 4e-3, 1e-15);
  EXPECT_NEAR(shape(4).distance({0.0, 0.0, 6e-3}), 1e-3, 1e-15);
  EXPECT_NEAR(shape(5).distance({0.0, 7e-3, 30e-3}), 1e-3, 1e-15);
  EXPECT_NEAR(shape(6).distance({0.0, 0.0, 7e-3}), 5e-3, 1e-15);
  EXPECT_NEAR(shape(7).distance({0.0, 90e-3, 5e-3}), 10e-3, 1e-15);
  EXPECT_NEAR(shape(8).distance({0.0, 80e-3, 5e-3}), 5e-3, 1e-15);
  EXPECT_NEAR(shape(9).distance({0.0, 80e-3, 5e-3}), 5e-3, 1e-15);
  EXPECT_NEAR(shape(10).distance({0.0, 12e-3, 15e-3}), 2e-3, 1e-15);
  // A thin wire lies in the fillets, one of 2.5 mm does not.
  EXPECT_EQ(coupling::pieces_of(s.motion.contacts[10].shape, 1e-3).size(), 1u);
  EXPECT_EQ(coupling::pieces_of(s.motion.contacts[10].shape, 2.5e-3).size(), 3u);
  EXPECT_EQ(coupling::pieces_of(s.motion.contacts[5].shape, 1e-3).size(), 2u);
  EXPECT_EQ(s.motion.contacts[2].body, 1);
  EXPECT_EQ(s.motion.contacts[2].friction.static_coefficient, 0.3);
  EXPECT_EQ(s.motion.contacts[2].name, "ball on a");
  EXPECT_EQ(s.motion.contacts[2].wire_radius, 0.75e-3);
  EXPECT_TRUE(s.motion.bodies[1].driven);
  EXPECT_LT((s.motion.bodies[0].start.orientation * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-14);
  EXPECT_LT((s.motion.contacts[3].X_BS.R * Vector3d::UnitY() - Vector3d::UnitZ()).norm(), 1e-14);
  EXPECT_EQ(s.motion.gravity, Vector3d(0.0, 0.0, -9.81));
  // The wire stands between its mounts and bulges where it was told, across its chord.
  const coupling::MotionWire& w = s.motion.wires[0];
  EXPECT_EQ(w.strength.breaking_tension, 5000.0);
  EXPECT_TRUE(w.strength.ends_run);
  EXPECT_LT(w.positions.col(0).norm(), 1e-15);
  EXPECT_LT((w.positions.col(20) - Vector3d(0.0, 0.0, 0.099)).norm(), 1e-15);
  EXPECT_GT(w.positions(0, 10), 5e-3);
  EXPECT_LT(w.positions.row(1).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(w.rod.properties.left.kind, wire::SpatialEnd::Kind::twisting_pin);
  EXPECT_LT((w.rod.properties.left.direction - Vector3d::UnitZ()).norm(), 1e-14);
  // At rest it stays at rest: the turned mounts fit the turned wire.
  coupling::Motion still = s.motion;
  still.gravity.setZero();
  still.contacts.clear();
  still.bodies.clear();
  coupling::MotionOptions options;
  options.duration = 0.01;
  const coupling::MotionResult result = coupling::simulate(still, options);
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_LT(result.energy.kinetic, 1e-9);
}

TEST_F(MotionScenarios, WiresHaveFortyElementsOfHigherOrderWhereNothingIsNamed) {
  std::string text = every_kind;
  const std::string named = "elements = 20\n";
  text.erase(text.find(named), named.size());
  write("unnamed.toml", text);
  const wire::RodInMotion rod =
      read_scenario(path("unnamed.toml"), {}).motions.runs.at(0).motion.wires.at(0).rod;
  EXPECT_EQ(rod.elements, 40);
  EXPECT_EQ(rod.formulation, wire::Formulation::higher_order);
  const wire::RodInMotion plain = read({"wires[a].formulation=\"vertices\""}).motion.wires.at(0).rod;
  EXPECT_EQ(plain.elements, 20);
  EXPECT_EQ(plain.formulation, wire::Formulation::vertices);
}

TEST_F(MotionScenarios, SayWhatIsWrong) {
  const test::WrongSetting wrong[] = {
      {"schema=\"snare-scenario/3\"", "must be \"snare-scenario/2\""},
      {"kind=\"push\"", "belongs to older files: take the line out"},
      {"duration_s=-1", "duration_s = -1, must be > 0"},
      {"output_interval_s=1e-9", "gives more than 1e+06 lines"},
      {"body.mass_kg=1", "body, unknown key"},
      {"wires[a].diameter_mm=0", "wires[a].diameter_mm = 0, must be > 0"},
      {"wires[a].length_mm=90", "wires[a].length_mm = 90, must be >= 98.01"},
      {"wires[a].to_mm=[0.0, 0.0, 0.0]",
       "wires[a].to_mm = [0.0, 0.0, 0.0], must not be where the wire begins"},
      {"wires[a].bulge=[0.0, 0.0, 1.0]",
       "wires[a].bulge = [0.0, 0.0, 1.0], must have a bulge, a direction across the chord"},
      {"wires[a].mount=\"supports\"", "wires[a].mount = \"supports\", must be \"clamped\" or \"pinned\""},
      {"wires[a].yield_stress_MPa=500", "the wire is elastic and naturally straight in motion"},
      {"wires[a].elements=4", "wires[a].elements = 4"},
      {"wires[a].formulation=\"cubic\"", "wires[a].formulation = \"cubic\", must be \"vertices\""},
      {"bodies[target].mass_kg=0", "bodies[target].mass_kg = 0, must be > 0"},
      {"bodies[target].inertia_kg_m2=[1.0, 1.0, 3.0]", "triangle inequality"},
      {"bodies[machine].mass_kg=1",
       "bodies[machine].mass_kg = 1, a driven body moves at a constant velocity_m_s"},
      {"bodies[machine].name=\"target\"", "is taken by another body"},
      {"shapes[ball].body=\"moon\"",
       "shapes[ball].body = \"moon\", must be the name of a frame: \"machine\", \"target\", \"world\""},
      {"shapes[ball].wires=[\"b\"]", "must be the name of a wire: \"a\""},
      {"shapes[ball].kind=\"cube\"", "shapes[ball].kind = \"cube\", must be \"knife_edge\", \"cylinder\""},
      {"shapes[ball].radius_mm=-1", "shapes[ball].radius_mm = -1, must be > 0"},
      {"shapes[ball].length_mm=1", "shapes[ball].length_mm = 1, unknown key"},
      {"shapes[ball].points=0", "shapes[ball].points = 0"},
      {"shapes[ball].static_speed_m_s=2", "must be > static_speed_m_s"},
      {"shapes[taper].lower_radius_mm=0",
       "shapes[taper].upper_radius_mm = 0.0, must be > 0 where lower_radius_mm is 0"},
      {"shapes[shaft].cam_radius_mm=5", "grapple shaft cam_radius = 0.005, must be > shaft_radius"},
      {"shapes[housing].outer_radius_mm=90", "ring outer_radius = 0.09, must be > inner_radius"},
      {"shapes[housing].length_mm=0", "shapes[housing].length_mm = 0, must be > 0"},
      {"shapes[end].fillet_mm=60", "cup fillet = 0.06, must be >= 0 and <= 0.049"},
      {"shapes[ground].drawn_mm=-1", "shapes[ground].drawn_mm = -1, must be > 0"},
      {"shapes[spool].height_mm=[0.0, 1.0]", "shapes[spool].height_mm"},
      {"shapes[spool].radius_mm=[5.0, 20.0]", "shapes[spool].radius_mm"},
      {"shapes[spool].rounding_mm=[0.0, 0.0, 1.0, 9.5, 2.0, 1.0, 0.0, 0.0]",
       "rounding[4] = 0.0095, the arcs at the ends of the side before it must fit into its 0.01 m"},
      {"wires[a].strength_N=0", "wires[a].strength_N = 0, must be > 0"},
      {"wires[a].strength_N=5e-324", "wires[a].strength_N = 5e-324, must be >= 1e-09"},
      {"wires[a].at_strength=\"break\"", "wires[a].at_strength = \"break\", must be \"flag\" or \"stop\""},
      {"shapes[box].file=\"none.stl\"", "none.stl"},
      {"shapes[box].unit=\"inch\"", "shapes[box].unit = \"inch\", must be \"mm\" or \"m\""},
      {"gravity.vector_m_s2=[1.0]", "gravity.vector_m_s2"},
  };
  test::expect_refused(wrong, [&](const char* setting) { return read({setting}); });
  // What is wrong with a mesh is said at the shape, with the mesh's own file and triangles.
  coupling::TriangleMesh hole = test::cuboid(8e-3, 6e-3, 4e-3);
  hole.triangles.pop_back();
  test::write_mesh(folder_ / "hole.obj", hole, 1e-3);
  const std::string said = test::refusal([&] { return read({"shapes[box].file=\"hole.obj\""}); });
  EXPECT_THAT(said, HasSubstr("shapes[box].file = \"hole.obj\""));
  EXPECT_THAT(
      said,
      HasSubstr(
          "hole.obj: mesh edge of points 3, 5 = triangle 10, must have a triangle on its other side too"));
}

// A box of 8 mm whose file is in metres is 8 um large by the unit that the scenario states.
TEST_F(MotionScenarios, MeshesOfAnotherUnitAreDoubted) {
  const auto warned = [&](const std::string& unit) {
    return read({"shapes[box].unit=\"" + unit + "\""}).warnings;
  };
  test::write_mesh(path("box.stl"), test::cuboid(8e-3, 6e-3, 4e-3), 1.0);
  EXPECT_THAT(warned("mm"),
              Contains(HasSubstr("shape box: its mesh is only 0.008 mm large: is the file in metres")));
  EXPECT_THAT(warned("m"), Not(Contains(HasSubstr("mesh"))));
  test::write_mesh(path("box.stl"), test::cuboid(1.0, 0.6, 0.4), 1e-3);
  EXPECT_THAT(warned("mm"), Not(Contains(HasSubstr("mesh"))));
  EXPECT_THAT(warned("m"),
              Contains(HasSubstr("shape box: its mesh is 1e+03 m large: is the file in millimetres")));
}

const fs::path net = fs::path(SNARE_SOURCE_DIR) / "data/scenarios/ball_into_net.toml";

TEST(WirePairScenarios, ContactsNameTheirWires) {
  const WireMotions read = read_scenario(net, {{"contacts[middle on lower].foundation.modulus_N_m2", "5e9"},
                                               {"contacts[middle on lower].static_friction", "0.4"},
                                               {"wires[lower].diameter_mm", "1.0"}})
                               .motions;
  const coupling::Motion& motion = read.runs.at(0).motion;
  ASSERT_EQ(motion.wire_pairs.size(), 3u);
  const coupling::WirePair& pair = motion.wire_pairs[2];
  EXPECT_EQ(pair.name, "middle on lower");
  EXPECT_EQ(pair.wires, (std::array<int, 2>{1, 2}));
  EXPECT_EQ(pair.radii, (std::array<double, 2>{0.75e-3, 0.5e-3}));
  EXPECT_EQ(pair.foundation.modulus, 5e9);
  EXPECT_EQ(pair.friction.static_coefficient, 0.4);
  EXPECT_EQ(pair.friction.dynamic_coefficient, 0.2);
  EXPECT_EQ(motion.contact_names().back(), "middle on lower");
}

TEST(WirePairScenarios, SayWhatIsWrong) {
  const test::WrongSetting wrong[] = {
      {"other_wire=\"lowest\"",
       "other_wire = \"lowest\", must be the name of a wire: \"upper\", \"middle\", \"lower\""},
      {"other_wire=\"middle\"", "other_wire = \"middle\", must not be the wire itself"},
      {"wire=\"upper\"", "other_wire = \"lower\", is already in contact with this wire"},
      {"name=\"upper on middle\"", "is taken by another contact"},
      {"friction=-1", "friction = -1, must be >= 0"},
      {"foundation.modulus_N_m2=-1", "foundation.modulus_N_m2 = -1, must be >= 0"},
      {"body=\"ball\"", "body = \"ball\", unknown key"},
  };
  test::expect_refused(wrong, [](const std::string& setting) {
    return read_scenario(net, test::overrides({"contacts[middle on lower]." + setting}));
  });
}

TEST(ShippedScenarios, GrappleShaftHasOneWireTurned) {
  const WireMotions listed = read_scenario(shipped).motions;
  ASSERT_EQ(listed.runs.size(), 1u);
  const NamedMotion& s = listed.runs[0];
  EXPECT_EQ(s.motion.wires.size(), 3u);
  EXPECT_EQ(s.motion.contacts.size(), 6u);
  // The three wires are one wire turned: bulges of 18.88 mm at 120 degrees (the digest of the declared wire).
  for (const coupling::MotionWire& w : s.motion.wires) {
    const Vector3d middle = w.positions.col(20);
    EXPECT_NEAR(middle.head<2>().norm(), 0.02 + 0.01888, 2e-5) << w.name;
  }
}

}  // namespace
}  // namespace snare::scenario
