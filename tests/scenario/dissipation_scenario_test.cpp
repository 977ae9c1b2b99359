// What is dissipated never falls, in scenarios that are written down and drawn at random.

#include "coupling/dynamics/run/simulate.hpp"
#include "scenario/scenario.hpp"
#include "tests/support/folder_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace snare::scenario {
namespace {

class Dissipation : public test::FolderFixture {
 protected:
  /// Runs a scenario and expects that what was dissipated grows, by more than `least` [J] in all.
  void expect_growing(const std::string& text, double least) {
    const NamedMotion run = read_scenario(write("scene.toml", text), {}).motions.runs.at(0);
    double lost = 0.0, largest_fall = 0.0;
    const coupling::MotionResult result =
        coupling::simulate(run.motion, run.options, [&](const coupling::MotionSample& s) {
          largest_fall = std::max(largest_fall, lost - s.energy.dissipated);
          lost = s.energy.dissipated;
          return false;
        });
    ASSERT_TRUE(result.report.usable()) << result.report.message;
    EXPECT_GT(lost, least);
    EXPECT_LE(largest_fall, 1e-12 * (1.0 + lost));    // round-off of a sum
    EXPECT_LE(result.energy.corrected, 1e-3 * lost);  // else the dissipation grows by its correction alone
  }
};
class SlowDissipation : public Dissipation {};

constexpr const char* askew_head = R"(schema = "snare-scenario/2"
title = "a body that strikes wires askew"
duration_s = 0.04
output_interval_s = 0.001
[output]
checkpoint_interval_s = 10.0
)";

// The edge slides askew over the wire and leaves it: the approach across the wire and the rate of the gap
// have opposite signs.
TEST_F(Dissipation, OfAnEdgeThatLeavesAWireAskewGrows) {
  expect_growing(std::string(askew_head) + R"(
[damping]
bending_time_s = 1e-4
axial_time_s = 1e-5
mass_rate_1_s = 2.0
[gravity]
vector_m_s2 = [-2.792, 9.5396, -7.0029]
[[wires]]
name = "w1"
construction = "solid"
diameter_mm = 1.074195
length_mm = 176.75
youngs_modulus_GPa = 152.026
poisson_ratio = 0.3
density_kg_m3 = 7900.0
from_mm = [0.0, 0.0, 0.0]
to_mm = [175.0, 0.0, 0.0]
bulge = [0.0, -1.0, 0.0]
elements = 12
mount = "clamped"
[[bodies]]
name = "b"
mass_kg = 1.3229
inertia_kg_m2 = [0.001, 0.0013, 0.0009]
position_mm = [114.7989, -45.0, 4.68825]
rotation_deg = [-4.994393, -4.5999, 11.58999]
velocity_m_s = [-0.074657, 2.073917, 0.039077]
spin_rad_s = [1.119319, 2.783472, 1.946335]
force_N = [-0.33387, 0.378520, 0.609982]
drag_Ns_m = 0.5
[[shapes]]
name = "tip"
frame = "b"
kind = "knife_edge"
length_mm = 61.21934
position_mm = [-4.9650, 0.0, 0.28208]
rotation_deg = [13.958985, 10.611458, 0.0]
)",
                 0.1);
}

// A block that falls 12 um on to a ramp of 10 degrees slides until it is carried, by micrometres, and then
// rests: friction is 0.5. What lies there has touched once.
TEST_F(Dissipation, OfABlockThatRestsOnARampEnds) {
  for (const char* model :
       {"model = \"spring_dashpot\"\nk_N_m = 1e5\nc_Ns_m = 100.0\n",
        "model = \"spring_dashpot\"\nk_N_m = 5e3\nc_Ns_m = 50.0\n",
        "model = \"step_damped\"\nk = 1e7\np = 1.5\nc_Ns_m = 100.0\nfull_depth_mm = 0.1\n"}) {
    SCOPED_TRACE(model);
    const std::string text = std::string(R"(schema = "snare-scenario/2"
title = "a block on a ramp"
duration_s = 2.0
output_interval_s = 0.01
[gravity]
vector_m_s2 = [1.703483, 0.0, -9.660969]
[[bodies]]
name = "block"
mass_kg = 1.0
inertia_kg_m2 = [2e-3, 2e-3, 2e-3]
position_mm = [0.0, 0.0, 30.0]
[[shapes]]
name = "hull"
frame = "block"
kind = "cylinder"
radius_mm = 50.0
length_mm = 60.0
[[shapes]]
name = "ramp"
frame = "world"
kind = "plane"
[[contacts]]
name = "rest"
shape = "ramp"
other_shape = "hull"
friction = 0.5
)") + model;
    const NamedMotion run = read_scenario(write("scene.toml", text), {}).motions.runs.at(0);
    double late_speed = 0.0, place = 0.0, lost = 0.0, late_lost = 0.0;
    const coupling::MotionResult result =
        coupling::simulate(run.motion, run.options, [&](const coupling::MotionSample& s) {
          EXPECT_GE(s.energy.dissipated, lost);
          lost = s.energy.dissipated;
          place = s.bodies[0].position.x();
          if (s.time < 1.0) return false;
          if (late_lost == 0.0) late_lost = lost;
          late_speed = std::max(late_speed, s.bodies[0].velocity.norm());
          return false;
        });
    ASSERT_TRUE(result.report.usable()) << result.report.message;
    EXPECT_LT(std::abs(place), 1e-4);
    EXPECT_LT(late_speed, 1e-6);        // the tolerance of velocities
    EXPECT_LT(lost - late_lost, 2e-6);  // 1e-6 m/s against 2 N, in 1 s
    EXPECT_EQ(
        std::ranges::count(result.events, coupling::MotionEvent::Kind::touch, &coupling::MotionEvent::kind),
        1);
  }
}

// Edges and cylinders with friction of either law, one or two wires, bodies that meet with each of the laws.
TEST_F(SlowDissipation, OfRandomScenesGrows) {
  std::mt19937 random(51);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto vector = [&](double size) {
    return fmt::format("[{}, {}, {}]", between(-size, size), between(-size, size), between(-size, size));
  };
  const auto friction = [&](int k) {
    return fmt::format("friction = {}\nlaw = \"{}\"\n", between(0.0, 0.6),
                       k % 2 == 0 ? "stick_slip" : "smooth");
  };
  for (int k = 0; k < 14; ++k) {
    SCOPED_TRACE(k);
    std::string text = askew_head;
    text += "[gravity]\nvector_m_s2 = " + vector(10.0) + "\n";
    for (int w = 0; w < 1 + k % 2; ++w) {
      text += fmt::format(
          "[[wires]]\nname = \"w{}\"\nconstruction = \"solid\"\ndiameter_mm = {}\nlength_mm = "
          "{}\nyoungs_modulus_GPa = "
          "160.0\n"
          "poisson_ratio = 0.3\ndensity_kg_m3 = 7900.0\nfrom_mm = [0.0, {}, 0.0]\nto_mm = [175.0, {}, 0.0]\n"
          "bulge = [0.0, {}, 0.0]\nelements = 12\nmount = \"{}\"\n",
          w, between(0.8, 2.0), between(175.2, 178.0), 30.0 * w, 30.0 * w, w == 0 ? -1.0 : 1.0,
          k % 3 == 0 ? "pinned" : "clamped");
    }
    text += fmt::format(
        "[[bodies]]\nname = \"b\"\nmass_kg = {}\ninertia_kg_m2 = [0.001, 0.0013, 0.0009]\nposition_mm = [{}, "
        "-45.0, "
        "{}]\n"
        "rotation_deg = {}\nvelocity_m_s = [{}, {}, {}]\nspin_rad_s = {}\n",
        between(0.5, 2.0), between(60.0, 120.0), between(-5.0, 5.0), vector(12.0), between(-0.5, 0.5),
        between(1.0, 3.0), between(-0.2, 0.2), vector(3.0));
    text += k % 2 == 0
                ? "[[shapes]]\nname = \"tip\"\nframe = \"b\"\nkind = \"knife_edge\"\nlength_mm = 60.0\n"
                : "[[shapes]]\nname = \"tip\"\nframe = \"b\"\nkind = \"capsule\"\nradius_mm = 4.0\nlength_mm "
                  "= 60.0\n";
    text += "rotation_deg = " + vector(15.0) + "\n" + friction(k);
    // Something that the body falls on behind the wires.
    text +=
        "[[shapes]]\nname = \"wall\"\nframe = \"world\"\nkind = \"plane\"\nposition_mm = [0.0, 60.0, 0.0]\n"
        "rotation_deg = [90.0, 0.0, 0.0]\nwires = []\n";
    text +=
        "[[shapes]]\nname = \"ball\"\nframe = \"b\"\nkind = \"sphere\"\nradius_mm = 20.0\nposition_mm = "
        "[0.0, -30.0, "
        "0.0]\nwires = []\n";
    text += "[[contacts]]\nname = \"stop\"\nshape = \"wall\"\nother_shape = \"ball\"\n" + friction(k / 2) +
            std::vector<std::string>{
                "model = \"spring_dashpot\"\nk_N_m = 1e5\nc_Ns_m = 100.0\n",
                "model = \"power\"\nk = 1e7\np = 1.5\nc = 1e7\n",
                "model = \"step_damped\"\nk = 1e7\np = 1.5\nc_Ns_m = 100.0\nfull_depth_mm = 0.5\n"}
                [static_cast<std::size_t>(k % 3)];
    expect_growing(text, 1e-6);
  }
}

}  // namespace
}  // namespace snare::scenario
