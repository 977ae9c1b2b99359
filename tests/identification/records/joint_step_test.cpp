#include "identification/motion_tracing/trace_records.hpp"
#include "identification/records/record_file.hpp"
#include "tests/support/folder_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <random>

namespace snare::identification {
namespace {

constexpr double inertia = 12500.0;  // kg m^2: half a tonne five metres out
constexpr double step_s = 0.5;       // of the motor's course
constexpr double noise_deg = 2e-5;   // a thousandth of the narrowest piece's width

/// The joint of Abiko et al., Table 2: N m/deg and N m s/deg from deflections of 0, 0.04 and 0.06 deg on,
/// torque continuous.
constexpr std::array<double, 3> from{0.0, 0.04, 0.06}, stiffness{12.5, 475.0, 475.0},
    damping{48.9, 87.3, 17.6};

/// Torque of the spring with its damper [N m] at a deflection [deg] and its rate [deg/s].
double torque(double x, double rate) {
  double sum = 0.0, size = std::abs(x), d = damping[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const double upper = i < 2 ? std::min(size, from[i + 1]) : size;
    if (upper > from[i]) sum += stiffness[i] * (upper - from[i]);
    if (size >= from[i]) d = damping[i];
  }
  return std::copysign(sum, x) + d * rate;
}

/// The link behind the joint while the motor steps, by Runge and Kutta's method with steps far below what the
/// jumps of the damping could show.
void write_step(const std::filesystem::path& file, double by_deg, unsigned seed) {
  constexpr double step = 2e-4, degree = 3.14159265358979323846 / 180.0;
  double q = 0.0, v = 0.0;  // deg, deg/s
  const auto acceleration = [&](double t, double angle, double rate) {
    const double s = std::min(1.0, t / step_s), rest = 1.0 - s;
    const double motor = by_deg * s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
    const double motor_rate = by_deg * 30.0 * s * s * rest * rest / step_s;
    return -torque(angle - motor, rate - motor_rate) / (inertia * degree);
  };
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0.0, noise_deg);
  std::ofstream out(file);
  out << "time_s,angle_deg\n";
  for (int i = 0; i <= 100000; ++i) {
    const double t = step * i;
    if (i % 250 == 0) out << fmt::format("{:.2f},{:.8f}\n", t, q + noise(engine));
    const double a1 = acceleration(t, q, v);
    const double v2 = v + 0.5 * step * a1, a2 = acceleration(t + 0.5 * step, q + 0.5 * step * v, v2);
    const double v3 = v + 0.5 * step * a2, a3 = acceleration(t + 0.5 * step, q + 0.5 * step * v2, v3);
    const double v4 = v + step * a3, a4 = acceleration(t + step, q + step * v3, v4);
    q += step / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    v += step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
}

class SlowJointStep : public test::FolderFixture {
 protected:
  std::filesystem::path write_all() const {
    write("link.urdf",
          R"(<robot name="link"><link name="base"/><link name="beam"><inertial><mass value="500"/>
<inertia ixx="12500" ixy="0" ixz="0" iyy="12500" iyz="0" izz="12500"/></inertial></link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="beam"/><axis xyz="0 0 1"/></joint></robot>)");
    // Declared a tenth off.
    write("arm.toml", R"(schema = "snare-arm/1"
title = "one joint"
source = "test"
urdf = "link.urdf"
tip = "beam"
[joint.hinge]
law = "piecewise"
from_deg = [0.0, 0.04, 0.06]
stiffness_Nm_deg = [13.7, 430.0, 520.0]
damping_Nms_deg = [44.0, 96.0, 19.3]
motor_inertia_kg_m2 = 80.0
drive = "locked"
[[pose]]
name = "zero"
angles_deg = [0]
)");
    write("scenario.toml", R"(schema = "snare-scenario/2"
title = "a step"
duration_s = 20.0
output_interval_s = 0.05
[[arms]]
name = "arm"
file = "arm.toml"
pose = "zero"
[[drives]]
joint = "arm::hinge"
mode = "course"
by_deg = 0.1
duration_s = 0.5
[[sensors]]
name = "angle"
kind = "joint_angle"
joint = "arm::hinge"
[solver]
max_order = 5
relative_tolerance = 1e-7
body_angle_tolerance_rad = 1e-9
body_spin_tolerance_rad_s = 1e-9
)");
    std::string record = "schema = \"snare-record/1\"\ntitle = \"steps\"\nscenario = \"scenario.toml\"\n";
    unsigned seed = 1;
    for (const double by : {0.07, 0.3, 1.2}) {
      const std::string name = fmt::format("step{}", seed);
      write_step(path(name + ".csv"), by, seed++);
      record += fmt::format(
          "[[records]]\nname = \"{0}\"\nfile = \"{0}.csv\"\nsigma = {1}\ncolumns = {{ angle_deg = \"angle\" "
          "}}\n"
          "set = {{ \"drives[1].by_deg\" = {2} }}\n",
          name, noise_deg, by);
    }
    record += "[fit]\nfree = [";
    for (const char* key : {"stiffness_Nm_deg", "damping_Nms_deg"})
      for (int k = 1; k <= 3; ++k) record += fmt::format("\"arms[arm].joint.hinge.{}[{}]\", ", key, k);
    return write("record.toml", record + "]\n");
  }
};

// Table 2 comes back from three steps: stiffnesses within 1 %, dampings within 5 %.
TEST_F(SlowJointStep, ThreeAmplitudesGiveBackTheThreePieces) {
  const RecordTrace trace = trace_records(read_records(write_all()), {.effects = false});
  ASSERT_TRUE(trace.report.usable()) << trace.report.message;
  ASSERT_EQ(trace.base.numbers.size(), 6u);
  for (std::size_t k = 0; k < 3; ++k) {
    const TracedNumber &s = trace.base.numbers[k], &d = trace.base.numbers[3 + k];
    EXPECT_NEAR(s.value, stiffness[k], 0.01 * stiffness[k]) << s.key << " +- " << s.stderr_;
    EXPECT_NEAR(d.value, damping[k], 0.05 * damping[k]) << d.key << " +- " << d.stderr_;
    RecordProperty(s.key, fmt::format("{} +- {}", s.value, s.stderr_));
  }
  EXPECT_LT(trace.base.chi2_dof, 2.0);
  RecordProperty("simulations", static_cast<int>(trace.fit_simulations));
}

}  // namespace
}  // namespace snare::identification
