// Wires that begin on a line: pendulums, strings, thrown rods, and what is refused.
#include "base/units.hpp"
#include "scenario/scenario.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <boost/math/special_functions/ellint_1.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::scenario {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

constexpr double gravity = 9.81;
const std::string with_gravity = "[gravity]\nvector_m_s2 = [0.0, 0.0, -9.81]\n";
const std::string closely =
    "[solver]\nrelative_tolerance = 1e-8\nposition_tolerance_m = 1e-9\nvelocity_tolerance_m_s = 1e-6\n";

struct Course {
  coupling::MotionResult result;
  std::vector<coupling::MotionSample> samples;
};

class WireStarts : public test::FolderFixture {
 protected:
  /// Keys of the scenario, and of a steel wire of 1.5 mm.
  [[nodiscard]] NamedMotion read(const std::string& keys, const std::string& wire) const {
    return read_scenario(
               write("s.toml", "schema = \"snare-scenario/2\"\ntitle = \"a start\"\n" + keys + R"([[wires]]
name = "w"
construction = "solid"
diameter_mm = 1.5
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
)" + wire))
        .motions.runs.at(0);
  }
  [[nodiscard]] static Course course_of(const NamedMotion& motion) {
    Course all;
    all.result = coupling::simulate(motion.motion, motion.options, [&all](const coupling::MotionSample& s) {
      all.samples.push_back(s);
      return false;
    });
    EXPECT_TRUE(all.result.report.usable()) << all.result.report.message;
    return all;
  }
};

/// Time at which a quantity of the samples first falls through zero, straight between them.
template <class F>
double falls_through_zero(const std::vector<coupling::MotionSample>& samples, const F& of) {
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const double before = of(samples[k - 1]), after = of(samples[k]);
    if (before > 0.0 && after <= 0.0)
      return samples[k - 1].time + before / (before - after) * (samples[k].time - samples[k - 1].time);
  }
  return -1.0;
}

double largest_energy_error(const std::vector<coupling::MotionSample>& samples) {
  double worst = 0.0;
  for (const coupling::MotionSample& s : samples) worst = std::max(worst, std::abs(s.energy.integrator));
  return worst;
}

// A uniform rod about its end: a quarter of the period 4 sqrt(2 L/(3 g)) K(sin(angle/2)). The lumped masses
// of n elements have a moment of inertia that is larger by 1/(2 n^2). The wire bends by 2e-4 of its length,
// which counts twice.
TEST_F(WireStarts, PinnedWireSwingsAsAPhysicalPendulum) {
  constexpr double length = 0.18;
  constexpr int elements = 20;
  for (const double angle : {5.0 * pi / 180.0, 0.5 * pi}) {
    const double quarter = std::sqrt(2.0 * length / (3.0 * gravity)) *
                           boost::math::ellint_1(std::sin(0.5 * angle)) *
                           std::sqrt(1.0 + 0.5 / (elements * elements));
    const NamedMotion motion = read(
        fmt::format("duration_s = {}\noutput_interval_s = 5e-4\n", 1.1 * quarter) + with_gravity + closely,
        fmt::format("length_mm = 180.0\nelements = {}\nfrom_mm = [0.0, 0.0, 0.0]\nto_mm = [{}, 0.0, {}]\n"
                    "ends = {{ left = \"pinned\", right = \"free\" }}\n",
                    elements, 180.0 * std::sin(angle), -180.0 * std::cos(angle)));
    const Course all = course_of(motion);
    const double found = falls_through_zero(
        all.samples, [](const coupling::MotionSample& s) { return s.wires[0].rightCols<1>().x(); });
    EXPECT_NEAR(found, quarter, 3e-5 * quarter) << angle;
    const double drop =
        0.0140 * length * gravity * 0.5 * length * (1.0 - std::cos(angle));  // of the energy [J]
    EXPECT_LT(largest_energy_error(all.samples), 1e-4 * drop) << angle;      // of some thousand steps at 1e-8
    EXPECT_GT(coupling::end_tension(all.samples.back(), 0), 0.0);  // of the pin: the free end pulls nothing
  }
}

// Past the level from which it fell nothing is singular: the pin is a ball joint. Pushed by a thousandth out
// of its plane it swings in space.
TEST_F(WireStarts, PinnedWireSwingsUpToWhereItBegan) {
  const double half =
      2.0 * std::sqrt(2.0 * 0.18 / (3.0 * gravity)) * boost::math::ellint_1(std::sin(0.25 * pi));
  const std::string points = "x_mm,y_mm,z_mm,vy_m_s\n0,0,0,0\n90,0,0,0.0005\n180,0,0,0.001\n";
  write("line.csv", points);
  const NamedMotion motion =
      read(fmt::format("duration_s = {}\noutput_interval_s = 0.01\n", half) + with_gravity,
           "elements = 12\nshape_file = \"line.csv\"\nends = { left = \"pinned\", right = \"free\" }\n");
  const Course all = course_of(motion);
  const Eigen::Vector3d tip = all.samples.back().wires[0].rightCols<1>();
  EXPECT_NEAR(tip.x(), -0.18, 2e-3);  // of the period, 1/(4 n^2), and of the waves of its release
  EXPECT_GT(std::abs(tip.y()), 1e-6);
}

// A string that begins in its first sine at a stretch e: omega = k sqrt(EA e/((1 + e) rho A) (1 + EI k^2/(EA
// e))), k = pi/L, and for lumped masses on edges of length h less by sin(k h/2)/(k h/2). Its amplitude a adds
// a share of some (a/L)^2/e: 4e-7.
TEST_F(WireStarts, PluckedStringHasItsFrequency) {
  constexpr double span = 0.2, stretch = 1e-3, amplitude = 4e-6, bending = 1e-6;
  constexpr int elements = 40;
  std::string points = "x_mm,y_mm,z_mm\n";
  for (int i = 0; i <= 20; ++i)
    points += fmt::format("{},{},0\n", 10.0 * i, 1e3 * amplitude * std::sin(pi * i / 20.0));
  write("sine.csv", points);
  const double area = 0.25 * pi * 1.5e-3 * 1.5e-3, length = span / (1.0 + stretch);
  const double tension = 193e9 * area * stretch, mass = 7930.0 * area;
  const double k = pi / length, half_phase = 0.5 * pi / elements;
  const double omega = k * std::sqrt(tension / ((1.0 + stretch) * mass) * (1.0 + bending / tension * k * k)) *
                       std::sin(half_phase) / half_phase;
  const double quarter = 0.5 * pi / omega;
  const NamedMotion motion = read(
      fmt::format("duration_s = {}\noutput_interval_s = {}\n[solver]\nrelative_tolerance = 1e-8\n"
                  "position_tolerance_m = 1e-12\nvelocity_tolerance_m_s = 1e-8\n"
                  "[damping]\nbending_time_s = 0.0\naxial_time_s = 0.0\n",
                  1.1 * quarter, quarter / 50.0),
      fmt::format("length_mm = {}\nelements = {}\nbending_stiffness_Nm2 = {}\nshape_file = \"sine.csv\"\n"
                  "mount = \"pinned\"\n",
                  1e3 * length, elements, bending));
  const Course all = course_of(motion);
  const double found = falls_through_zero(
      all.samples, [](const coupling::MotionSample& s) { return s.wires[0](1, elements / 2); });
  EXPECT_NEAR(found, quarter,
              1e-4 * quarter);  // of samples a fiftieth of a quarter apart, straight between them
  EXPECT_NEAR(coupling::end_tension(all.samples.front(), 0), tension, 1e-5 * tension);
}

// A free wire that is thrown with a spin: its middle flies as a point, it turns evenly and stays straight,
// stretched by the spin alone, rho omega^2 L^2/(8 E) at its middle: 1e-9.
TEST_F(WireStarts, ThrownWireFliesAsARigidRod) {
  constexpr double speed = 2.0, spin = 20.0, time = 0.2, half = 0.05;
  write("thrown.csv",
        fmt::format("x_mm,y_mm,z_mm,vx_m_s,vy_m_s,vz_m_s\n-50,0,0,{0},{1},1\n50,0,0,{0},{2},1\n", speed,
                    -spin * half, spin * half));
  const NamedMotion motion = read(
      fmt::format("duration_s = {}\noutput_interval_s = 0.02\n[gravity]\nvector_m_s2 = [0.0, 0.0, -9.81]\n",
                  time),
      "elements = 12\nshape_file = \"thrown.csv\"\nends = { left = \"free\", right = \"free\" }\n");
  const Course all = course_of(motion);
  for (const coupling::MotionSample& s : all.samples) {
    const double t = s.time;
    const Eigen::Vector3d middle(speed * t, 0.0, t - 0.5 * gravity * t * t);
    const Eigen::Vector3d along(std::cos(spin * t), std::sin(spin * t), 0.0);
    EXPECT_LT((s.wires[0].col(6) - middle).norm(), 1e-5) << t;  // some hundred steps of a tolerance of 3e-7 m
    EXPECT_LT((s.wires[0].rightCols<1>() - middle - half * along).norm(), 2e-4)
        << t;  // of a way of 0.2 m about the middle
    EXPECT_LT(std::abs((s.wires[0].rightCols<1>() - s.wires[0].col(0)).norm() - 2.0 * half), 1e-6) << t;
    EXPECT_EQ(coupling::end_tension(s, 0), 0.0);
  }
}

// A clamped wire bent to an arc keeps the direction of the arc at its clamp, and springs back from it.
TEST_F(WireStarts, ClampHoldsTheDirectionOfTheLine) {
  std::string points = "x_mm,y_mm,z_mm\n";
  for (int i = 0; i <= 40; ++i) {
    const double angle = 0.25 * pi + 0.5 * pi * i / 40.0;
    points += fmt::format("{},{},0\n", 100.0 * std::cos(angle), 100.0 * std::sin(angle));
  }
  write("arc.csv", points);
  const NamedMotion motion =
      read("duration_s = 0.001\noutput_interval_s = 0.0005\n",
           "shape_file = \"arc.csv\"\nends = { left = \"clamped\", right = \"free\" }\n");
  const coupling::MotionWire& w = motion.motion.wires[0];
  EXPECT_NEAR(w.rod.length, 0.05 * pi, 1e-7);
  EXPECT_LT((w.rod.properties.left.direction - Eigen::Vector3d(-std::sqrt(0.5), std::sqrt(0.5), 0.0)).norm(),
            1e-4);
  const Course all = course_of(motion);
  EXPECT_NEAR(all.samples.front().energy.strain,
              0.5 * w.rod.properties.bending_stiffness * 100.0 * w.rod.length,
              2e-2 * all.samples.front().energy.strain);  // of the free end's cell, which has no moment
  EXPECT_LT(largest_energy_error(all.samples), 1e-2 * all.samples.front().energy.strain);
}

// The coordinate says how a hanging wire is stretched: at rest where its tension bears its weight.
TEST_F(WireStarts, HangingWireStaysWhereItsStretchBearsIt) {
  constexpr double length = 1.0, stiffness = 100.0;  // [m], [N]
  const double weight = 7930.0 * 0.25 * pi * 1.5e-3 * 1.5e-3 * gravity;
  std::string points = "s_mm,x_mm,y_mm,z_mm\n";
  for (int i = 0; i <= 10; ++i) {
    const double s = 0.1 * i;
    points +=
        fmt::format("{},0,0,{}\n", 1e3 * s, -1e3 * (s + weight / stiffness * (length * s - 0.5 * s * s)));
  }
  write("hanging.csv", points);
  const NamedMotion motion =
      read("duration_s = 0.2\noutput_interval_s = 0.01\n[gravity]\nvector_m_s2 = [0.0, 0.0, -9.81]\n",
           "axial_stiffness_N = 100.0\nelements = 20\nshape_file = \"hanging.csv\"\n"
           "ends = { left = \"pinned\", right = \"free\" }\n");
  const Course all = course_of(motion);
  for (const coupling::MotionSample& s : all.samples) {
    EXPECT_LT((s.wires[0] - all.samples.front().wires[0]).norm(),
              1e-5);  // of an edge's mean stretch, taken at its middle
    // The pin bears all but half the weight of the edge beside it.
    EXPECT_NEAR(coupling::end_tension(s, 0), weight * length, 1e-3 * weight * length);
  }
}

TEST_F(WireStarts, GoOnFromACheckpoint) {
  write("line.csv", "x_mm,y_mm,z_mm,vz_m_s\n0,0,0,0\n50,1,0,0.1\n100,0,3,0\n");
  const NamedMotion motion =
      read("duration_s = 0.002\noutput_interval_s = 0.0005\n[output]\ncheckpoint_interval_s = 0.001\n",
           "elements = 8\nshape_file = \"line.csv\"\nmount = \"clamped\"\n");
  std::optional<coupling::MotionState> kept;
  const auto none = [](const coupling::MotionSample&) { return false; };
  const coupling::MotionResult whole = coupling::simulate(
      motion.motion, motion.options, none, nullptr, [&kept](const coupling::MotionState& s) { kept = s; });
  ASSERT_TRUE(kept);
  const coupling::MotionResult rest = coupling::simulate(motion.motion, motion.options, none, &*kept);
  EXPECT_EQ(whole.last.unknowns, rest.last.unknowns);
}

TEST_F(WireStarts, RefuseWhatContradictsTheWire) {
  write("arc.csv", "x_mm,y_mm,z_mm\n0,0,0\n50,20,0\n100,0,0\n");
  write("twice.csv", "x_mm,y_mm,z_mm\n0,0,0\n50,20,0\n50,20,0\n");
  write("back.csv", "s_mm,x_mm,y_mm,z_mm\n0,0,0,0\n50,50,0,0\n50,100,0,0\n");
  write("late.csv", "s_mm,x_mm,y_mm,z_mm\n1,0,0,0\n50,50,0,0\n");
  write("long.csv", "s_mm,x_mm,y_mm,z_mm\n0,0,0,0\n50,60,0,0\n100,120,0,0\n");
  std::string kink = "x_mm,y_mm,z_mm\n";  // a right angle of points half a millimetre apart
  for (int i = 0; i <= 20; ++i)
    kink += fmt::format("{},{},0\n", 0.5 * std::min(i, 10), 0.5 * std::max(i - 10, 0));
  write("kink.csv", kink);
  write("moving.csv", "x_mm,y_mm,z_mm,vy_m_s\n0,0,0,1\n100,0,0,0\n");
  write("one.csv", "x_mm,y_mm,z_mm\n0,0,0\n");
  write("text.csv", "x_mm,y_mm,z_mm\n0,0,0\n50,a,0\n");
  const std::string keys = "duration_s = 0.01\n";
  const auto refused = [&](const std::string& wire) {
    return test::refusal([&] { return read(keys, wire); });
  };
  const std::pair<const char*, const char*> wrong[] = {
      {"length_mm = 90\nshape_file = \"arc.csv\"\n", "length_mm = 90, must be >= "},
      {"length_mm = 90\nshape_file = \"arc.csv\"\n", "the wire begins on a line of 109.823 mm"},
      {"shape_file = \"twice.csv\"\n", "must have points apart from each other; nos 2 and 3 are not"},
      {"shape_file = \"back.csv\"\n", "apart from each other, with s_mm that ascends; nos 2 and 3 are not"},
      {"shape_file = \"late.csv\"\n", "must have s_mm that begins with 0"},
      {"shape_file = \"long.csv\"\n", "must stretch the wire by -1 to 10 %; it does by 20 % at 0 mm"},
      {"length_mm = 99\nshape_file = \"back.csv\"\n", "nos 2 and 3"},
      {"shape_file = \"kink.csv\"\n", "must bend by radii above half the diameter, 0.75 mm"},
      {"shape_file = \"moving.csv\"\n", "must have no velocity at its first point: that end is held"},
      {"shape_file = \"one.csv\"\n", "must have 2 to 20001 points, has 1"},
      {"shape_file = \"text.csv\"\n", "text.csv:3: y_mm = a"},
      {"shape_file = \"none.csv\"\n", "none.csv"},
      {"elements = 8\nshape_file = \"turn.csv\"\n", "elements = 8, must be more: the wire begins bent by"},
      {"shape_file = \"arc.csv\"\nfrom_mm = [0.0, 1.0, 0.0]\n",
       "from_mm = [0.0, 1.0, 0.0], must be [0, 0, 0], where the line of arc.csv begins"},
      {"shape_file = \"arc.csv\"\nbulge = [0.0, 1.0, 0.0]\n", "bulge = "},
      {"shape_file = \"arc.csv\"\nmodel = \"stretched\"\n",
       "must be \"full\" or \"quasi_static\" of a wire with shape_file"},
      {"shape_file = \"arc.csv\"\nmount = \"pinned\"\nends = { left = \"free\", right = \"free\" }\n",
       "mount = \"pinned\", cannot stand beside ends"},
      {"shape_file = \"arc.csv\"\nends = { left = \"free\" }\n", "ends.right"},
      {"shape_file = \"arc.csv\"\nmodel = \"quasi_static\"\nends = { left = \"pinned\", right = \"free\" }\n",
       "a free end that no clamp holds"},
      {"length_mm = 100\nfrom_mm = [0.0, 0.0, 0.0]\nto_mm = [130.0, 0.0, 0.0]\nends = { left = \"free\", "
       "right = "
       "\"free\" }\n",
       "length_mm = 100, must be >= 118.182 and <= 131.313"},
  };
  std::string turn = "x_mm,y_mm,z_mm\n";
  for (int i = 0; i <= 60; ++i)
    turn += fmt::format("{},{},0\n", 4.0 * std::sin(0.2 * i), 4.0 * std::cos(0.2 * i) + 0.2 * i);
  write("turn.csv", turn);
  for (const auto& [wire, words] : wrong) EXPECT_THAT(refused(wire), HasSubstr(words)) << wire;
  EXPECT_EQ(refused("shape_file = \"arc.csv\"\nfrom_mm = [0.0, 0.0, 0.0]\nto_mm = [100.0, 0.0005, 0.0]\n"),
            "accepted");
}

// Axes and place of its first frame.
TEST_F(WireStarts, CountsInTheFirstFrame) {
  write("line.csv", "x_mm,y_mm,z_mm\n0,0,0\n100,0,0\n");
  const NamedMotion motion = read(
      "duration_s = 0.01\n[[frames]]\nname = \"f\"\nposition_mm = [0.0, 0.0, 7.0]\nrotation_deg = [0.0, 0.0, "
      "90.0]\n",
      "shape_file = \"line.csv\"\nfrom_frame = \"f\"\nends = { left = \"pinned\", right = \"free\" }\n");
  const Eigen::Matrix3Xd& x = motion.motion.wires[0].positions;
  EXPECT_LT((x.rightCols<1>() - Eigen::Vector3d(0.0, 0.1, 0.007)).norm(), 1e-15);
}

}  // namespace
}  // namespace snare::scenario
