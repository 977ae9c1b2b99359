// Scenarios in which laws stand for wires, bodies touch and loads act.

#include "coupling/dynamics/run/simulate.hpp"
#include "scenario/outcome.hpp"
#include "scenario/scenario.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace snare::scenario {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

const fs::path shipped = fs::path(SNARE_SOURCE_DIR) / "data/scenarios";

const std::string with_laws = R"(schema = "snare-scenario/2"
title = "laws"
duration_s = 0.02
output_interval_s = 0.001
[[snares]]
name = "snare"
ring_radius_mm = 100.0
[snares.wire]
construction = "solid"
diameter_mm = 1.5
length_mm = 200.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
model = "stretched"
tight_N = 20.0
rod = { half_stiffness_N_m = 5.0e5, half_length_mm = 100.0, half_span_mm = 99.0 }
[snares.wire_contact]
friction = 0.1
[[bodies]]
name = "visitor"
mass_kg = 500.0
inertia_kg_m2 = [400.0, 400.0, 100.0]
position_mm = [10.0, 0.0, 700.0]
[[shapes]]
name = "pin"
frame = "visitor"
kind = "capsule"
position_mm = [0.0, 0.0, -700.0]
radius_mm = 6.0
length_mm = 250.0
friction = 0.1
[[shapes]]
name = "face"
frame = "snare::housing"
kind = "ring"
wires = []
inner_radius_mm = 40.0
outer_radius_mm = 120.0
length_mm = 20.0
[[shapes]]
name = "plate"
frame = "visitor"
kind = "cylinder"
wires = []
position_mm = [0.0, 0.0, -600.0]
radius_mm = 100.0
length_mm = 10.0
rim_points = 6
[[bushings]]
name = "tie"
frame = "world"
other_frame = "visitor"
neutral = "frames"
translational_stiffness_N_m = 10.0
rotational_stiffness_Nm_rad = 0.0
[[contacts]]
name = "plate on face"
shape = "face"
other_shape = "plate"
model = "power"
k = 1.0e6
p = 1.5
friction = 0.2
[[loads]]
name = "thruster"
frame = "visitor"
force_N = [1.0, 0.0, 0.0]
begin_s = 0.001
duration_s = 0.002
pulses = 3
every_s = 0.005
[[sensors]]
name = "pull"
kind = "tension"
wire = "snare::wire_2"
)";

class CaptureLaws : public test::FolderFixture {
 protected:
  [[nodiscard]] WireMotions read(const std::vector<std::string>& settings,
                                 const std::string& text = with_laws) {
    std::ofstream(folder_ / "case.toml") << text;
    return read_file(folder_ / "case.toml", settings);
  }
  [[nodiscard]] static WireMotions read_file(const fs::path& file, const std::vector<std::string>& settings) {
    return read_scenario(file, test::overrides(settings)).motions;
  }
};

TEST_F(CaptureLaws, PutEverythingWhereItBelongs) {
  const WireMotions all = read({});
  const coupling::Motion& m = all.runs.front().motion;
  EXPECT_TRUE(m.wires.empty());
  EXPECT_TRUE(m.wire_pairs.empty());  // laws do not meet each other
  EXPECT_TRUE(m.contacts.empty());
  ASSERT_EQ(m.law_wires.size(), 3u);
  EXPECT_EQ(m.law_wires[1].name, "snare::wire_2");
  EXPECT_EQ(m.law_wires[1].shaft.name, "pin");
  EXPECT_NEAR((m.law_wires[1].shaft.X_WS.p - Vector3d(0.01, 0.0, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_EQ(m.law_wires[1].shaft.half_length, 0.125);
  ASSERT_EQ(m.body_contacts.size(), 1u);
  EXPECT_EQ(m.body_contacts[0].points.size(), 12u);  // two rims
  ASSERT_EQ(m.loads.size(), 1u);
  EXPECT_EQ(m.loads[0].times,
            (std::vector<double>{0.001, 0.003, 0.003, 0.006, 0.006, 0.008, 0.008, 0.011, 0.011, 0.013}));
  EXPECT_EQ(all.sensors[0].index, 1);
  const std::vector<std::string> names{"pin on snare::wire_1", "pin on snare::wire_2", "pin on snare::wire_3",
                                       "plate on face"};
  EXPECT_EQ(m.contact_names(), names);
  EXPECT_EQ(all.model_keys, std::vector<std::string>{"snares[snare].wire.model"});
  const coupling::Motion rods = read({"snares[snare].wire.model=\"rod\""}).runs.front().motion;
  // Eq. 1 with its numbers: F = 2 K (1 - l/sqrt(l^2 + 2 h x + x^2)) (h + x), h = sqrt(l^2 - L^2).
  const double h = std::sqrt(0.01 - 0.099 * 0.099), x = 2e-3;
  EXPECT_NEAR(rods.law_wires[0].law(x, 0.0).x(),
              1e6 * (1.0 - 0.1 / std::sqrt(0.01 + 2.0 * h * x + x * x)) * (h + x), 1e-9);
  EXPECT_NEAR(rods.law_wires[0].standoff, h, 1e-15);
}

TEST_F(CaptureLaws, SayWhatIsWrong) {
  const test::WrongSetting wrong[] = {
      {"snares[snare].wire.model=\"spring\"",
       "must be \"full\", \"quasi_static\", \"stretched\", \"rod\" or \"rod_linear\""},
      {"snares[snare].wire.rod.half_length_mm=90", "must be >= half_span_mm"},
      {"snares[snare].wire.rod.half_stiffness_N_m=0",
       "snares[snare].wire.rod.half_stiffness_N_m = 0, must be > 0"},
      {"snares[snare].wire.rod.damping_Ns_m=-1", "must be >= 0"},
      {"snares[snare].wires=0", "cannot stand beside wires = 0"},
      {"shapes[pin].kind=\"sphere\"",
       "must be a capsule, knife_edge, cylinder or grapple_shaft to meet snare::wire_1"},
      {"shapes[pin].wires=[]", "must have one that snare::wire_1 meets, for which a law stands"},
      {"shapes[plate].wires=[\"snare::wire_3\"]",
       "must not have snare::wire_3, for which a law stands: it meets pin already"},
      {"bushings[tie].neutral=\"middle\"",
       "bushings[tie].neutral = \"middle\", must be \"start\" or \"frames\""},
      {"contacts[plate on face].model=\"glue\"", "must be \"spring_dashpot\", \"power\" or \"step_damped\""},
      {"contacts[plate on face].shape=\"disc\"", "must be the name of a shape: \"pin\", \"face\", \"plate\""},
      {"contacts[plate on face].other_shape=\"face\"", "must be carried by something else than the first"},
      {"contacts[plate on face].k=-1", "contacts[plate on face].k = -1, must be > 0"},
      {"contacts[plate on face].friction=9", "contacts[plate on face].friction = 9"},
      {"contacts[plate on face].dynamic_speed_m_s=0.001", "must be > static_speed_m_s"},
      {"shapes[plate].rim_points=0", "shapes[plate].rim_points = 0"},
      {"shapes[plate].kind=\"plane\"", "must have points with which it touches: a plane has none"},
      {"loads[thruster].frame=\"moon\"", "loads[thruster].frame = \"moon\", must be the name of a frame"},
      {"loads[thruster].axes=\"body\"", "must be \"frame\" or \"world\""},
      {"loads[thruster].force_N=[1.0]", "loads[thruster].force_N = [1.0], must be an array of 3 numbers"},
      {"loads[thruster].every_s=0.001", "must be at least duration_s"},
      {"loads[thruster].ramp_s=0.5", "must be at most half of duration_s"},
      {"loads[thruster].duration_s=0", "loads[thruster].duration_s = 0, must be > 0"},
      {"loads[thruster].file=\"none.csv\"", "cannot stand beside file, which says all"},
      {"loads[thruster].pulses=0", "loads[thruster].pulses = 0"},
  };
  test::expect_refused(wrong, [&](const char* setting) { return read({setting}); });
}

// A thruster's table and its pulses are the same load, and nothing of it is lost between the steps: the
// momentum is the integral.
TEST_F(CaptureLaws, LoadsComeFromATableToo) {
  std::string text = with_laws;
  const std::string pulses =
      "force_N = [1.0, 0.0, 0.0]\nbegin_s = 0.001\nduration_s = 0.002\npulses = 3\nevery_s = 0.005\n";
  text.replace(text.find(pulses), pulses.size(), "file = \"load.csv\"\n");
  std::ofstream(folder_ / "load.csv")
      << "time_s,fx_N\n0.001,1\n0.003,1\n0.003,0\n0.006,0\n0.006,1\n0.008,1\n0.008,0\n0.011,0\n"
         "0.011,1\n0.013,1\n";
  const auto velocity = [](const WireMotions& motions) {
    Vector3d v;
    const coupling::MotionResult r = coupling::simulate(motions.runs[0].motion, motions.runs[0].options,
                                                        [&](const coupling::MotionSample& s) {
                                                          v = s.bodies[0].velocity;
                                                          return false;
                                                        });
    EXPECT_TRUE(r.report.usable()) << r.report.message;
    EXPECT_LT(r.momentum_error.norm(), 1e-9);
    return v;
  };
  const Vector3d table = velocity(read({}, text)), declared = velocity(read({}));
  EXPECT_EQ(table, declared);
  EXPECT_NEAR(declared.x(), (3.0 * 0.002 - 10.0 * 0.01 * 0.02) / 500.0, 1e-10);  // less the pull of the tie
}

// The shipped capture with strings in place of its wires: caught, in the order of the full wires (see the
// file), and the balances.
TEST_F(CaptureLaws, StringsCatchAsTheWiresDo) {
  const WireMotions motions = read_file(shipped / "ssrms_htv_capture.toml",
                                        {"snares[snare].wire.model=\"stretched\"", "duration_s=4.0"});
  std::vector<coupling::MotionSample> samples;
  const coupling::MotionResult r = coupling::simulate(motions.runs[0].motion, motions.runs[0].options,
                                                      [&](const coupling::MotionSample& s) {
                                                        samples.push_back(s);
                                                        return false;
                                                      });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_TRUE(outcome_of(*motions.capture, motions.runs[0].motion, samples).caught);
  EXPECT_LT(std::abs(r.energy.integrator), 1e-3 * r.energy.work);
  EXPECT_LT(r.momentum_error.norm(), 1e-6 * 16000.0 * 0.01);
  std::vector<double> first(3, 1e9);
  for (const coupling::MotionEvent& e : r.events) {
    if (e.kind == coupling::MotionEvent::Kind::touch)
      first[base::at(e.contact)] = std::min(first[base::at(e.contact)], e.time);
  }
  EXPECT_LT(first[2], first[0]);
  EXPECT_LT(first[0], first[1]);
  for (const coupling::WireUse& w : r.wires) EXPECT_NEAR(w.peak_tension, 500.0, 150.0);
}

}  // namespace
}  // namespace snare::scenario
