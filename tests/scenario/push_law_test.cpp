#include "scenario/push_law.hpp"

#include "coupling/dynamics/model/start.hpp"
#include "scenario/scenario.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace snare::scenario {
namespace {

using Eigen::Vector2d;
using ::testing::HasSubstr;

const std::filesystem::path air_table =
    std::filesystem::path(SNARE_SOURCE_DIR) / "data/scenarios/air_table.toml";

NamedMotion air_table_with(const std::vector<std::string>& settings) {
  return read_scenario(air_table, test::overrides(settings)).motions.runs.at(0);
}

// Vertices on a parabola of curvature k: a disc of radius R below touches it where the normals agree, R
// beyond along the normal.
TEST(PushLaws, ADiscTouchesAParabolaAlongItsNormal) {
  constexpr double span = 0.2, k = 4.0, R = 0.01;
  Eigen::Matrix3Xd rest = Eigen::Matrix3Xd::Zero(3, 201);
  for (int i = 0; i <= 200; ++i) {
    const double x = span * i / 200;
    rest(0, i) = x;
    rest(1, i) = 0.5 * k * x * (span - x);
  }
  for (const double side : {1.0, -1.0}) {
    const numerics::HermiteCurve touch = first_touch(rest, R, side);
    for (const double x : {0.05, 0.1, 0.13}) {
      const double slope = side * 0.5 * k * (span - 2.0 * x), length = std::hypot(1.0, slope);
      const double s = x + R * slope / length;  // of the disc's centre, R below the wire along its normal
      EXPECT_NEAR(touch.value(s), side * 0.5 * k * x * (span - x) - R / length, 1e-7) << x;
      EXPECT_NEAR(touch.slope(s), slope, 1e-4) << x;
    }
  }
}

TEST(PushLaws, OfThePapersStandForTheWire) {
  const NamedMotion run = air_table_with({"wires[wire].model=\"quadratic\""});
  EXPECT_TRUE(run.motion.wires.empty());
  ASSERT_EQ(run.motion.law_wires.size(), 1u);
  const coupling::LawWire& wire = run.motion.law_wires[0];
  EXPECT_EQ(wire.kind, coupling::LawWire::Kind::push);
  EXPECT_TRUE(wire.push_jumps);  // by C
  // 5 mm behind the touch, which is 0.1 mm before the probe, wherever along the chord.
  const double touch = 0.1 - 0.0880123 + 0.1e-3;
  for (const double s : {0.05, 0.09}) {
    const coupling::WirePush p = wire.push(Vector2d(s, touch + 5e-3), 0.3);
    EXPECT_NEAR(p.depth, 5e-3, 1e-5);  // of a discrete wire on a slope
    EXPECT_NEAR(p.force.y(), (890183.0 * p.depth - 1297.6) * p.depth + 0.3457, 1e-9);
    EXPECT_EQ(p.force.x(), 0.0);
    EXPECT_NEAR(p.by_place(1, 1), 2.0 * 890183.0 * p.depth - 1297.6, 1e-6);
  }
  EXPECT_DOUBLE_EQ(run.options.max_step, 1e-4 / 0.1);
  EXPECT_EQ(air_table_with({}).options.max_step, 1e9);  // no touch is missed without a limit
}

// Digest of Table 4: the quadratic at s = 90 mm, head-on, without damping: 8.9 kg at 0.1 m/s.
TEST(PushLaws, QuadraticHeadOn) {
  const NamedMotion run =
      air_table_with({"wires[wire].model=\"quadratic\"", "shapes[probe].position_mm=[0.0, 100.0, 0.0]",
                      "bodies[target].position_mm=[90.0, -88.0123, 0.0]", "duration_s=0.4",
                      "solver.relative_tolerance=1e-7"});
  const coupling::MotionResult r = coupling::simulate(run.motion, run.options);
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  // Quadrature of A d^2 + B d + C (cut off where it would pull) against m v^2/2 gives depth 6.07 mm, force
  // 25.2 N; printed to three digits, steps end up to 1e-3 beside the peak.
  EXPECT_NEAR(r.peak_force[0], 25.2, 0.1);
  EXPECT_NEAR(r.impulse[0].y(), 1.78, 0.01);
  EXPECT_NEAR(r.energy.dissipated, 0.0, 1e-3 * 0.5 * 8.9 * 0.01);  // an elastic law gives all back
}

// What the law has stored up to where it is cut off stays stored there: a run that ends at 0.7 mm, between
// the zeros at 0.35 and 1.11 mm.
TEST(PushLaws, KeepTheirEnergyWhereTheyAreCutOff) {
  const NamedMotion run = air_table_with(
      {"wires[wire].model=\"quadratic\"", "shapes[probe].position_mm=[0.0, 100.0, 0.0]",
       "bodies[target].position_mm=[90.0, -88.0123, 0.0]", "bodies[target].velocity_m_s=[0.0, 0.02, 0.0]",
       "duration_s=0.04", "solver.relative_tolerance=1e-7"});
  const coupling::MotionResult r = coupling::simulate(run.motion, run.options);
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  const double d = (1297.6 - std::sqrt(1297.6 * 1297.6 - 4.0 * 890183.0 * 0.3457)) / (2.0 * 890183.0);
  const double stored = ((890183.0 / 3.0 * d - 1297.6 / 2.0) * d + 0.3457) * d;
  EXPECT_NEAR(r.energy.strain, stored, 1e-9 * stored);
  EXPECT_NEAR(r.energy.integrator, 0.0, 1e-3 * 0.5 * 8.9 * 0.02 * 0.02);
}

TEST(PushLaws, SayWhatIsWrong) {
  const test::WrongSetting wrong[] = {
      {"wires[wire].model=\"cubic\"", "wires[wire].model = \"cubic\", must be \"full\", \"quasi_static\""},
      {"wires[wire].quadratic.position_mm=180", "position_mm must be >= 1.75 and <= 173.25: inside the span"},
      {"wires[wire].quadratic.position_mm=0", "wires[wire].quadratic.position_mm = 0, must be > 0"},
      {"wires[wire].quadratic.direction=\"up\"", "must be \"outward\" or \"inward\""},
      {"wires[wire].quadratic.k_N_m=1", "wires[wire].quadratic.k_N_m = 1, unknown key"},
      {"wires[wire].spring_dashpot.k_N_m=-1", "wires[wire].spring_dashpot.k_N_m = -1, must be > 0"},
      {"wires[wire].to_frame=\"target\"",
       "must not be \"quadratic\" of a wire whose mounts move against each other"},
      {"shapes[probe].kind=\"sphere\"",
       "must be a capsule, knife_edge, cylinder or grapple_shaft to meet wire"},
      {"wires[wire].length_mm=500", "must lie over its chord at rest for a law to stand for it"},
  };
  test::expect_refused(wrong, [](const std::string& setting) {
    return air_table_with({"wires[wire].model=\"quadratic\"", setting});
  });
  EXPECT_THAT(test::refusal([] { return air_table_with({"wires[wire].model=\"power\""}); }),
              HasSubstr("wires[wire].power, missing, must be a table"));
}

/// The least of a law.json with a table of the air table's wire.
nlohmann::json law_json(double span, double slack) {
  const double bending = 193e9 * EIGEN_PI / 64.0 * std::pow(1.5e-3, 4),
               axial = 193e9 * EIGEN_PI / 4.0 * 2.25e-6;
  std::vector<double> nodes;
  // F L^2/EI = 1e4 x^2 g(s) over x = d/L, s, with a level g at mid-span: the value, d, s, ds; nothing by the
  // slack.
  const std::vector<std::array<double, 3>> knots{{0.1, 1.2, 4.0}, {0.5, 2.0, 0.0}};  // s, g, dg/ds
  for (int e = 0; e < 2; ++e) {
    for (const auto& [s, g, slope] : knots) {
      for (const double x : {0.0, 0.02, 0.05}) {
        for (const double v :
             {1e4 * x * x * g, 2e4 * x * g, 1e4 * x * x * slope, 2e4 * x * slope, 0.0, 0.0, 0.0, 0.0})
          nodes.push_back(v);
      }
    }
  }
  const nlohmann::json table{{"travel", {0.0, 0.02, 0.05}},
                             {"position", {0.1, 0.5}},
                             {"slack", {(slack - 1e-3) / span, (slack + 1e-3) / span}},
                             {"span_m", span},
                             {"force_scale_N", bending / (span * span)},
                             {"mirrored", true},
                             {"nodes", nodes},
                             {"error", {{"bound_N", 0.1}, {"force_range_N", 10.0}}}};
  const nlohmann::json wire{{"bending_stiffness_Nm2", bending},
                            {"axial_stiffness_N", axial},
                            {"length_mm", 1e3 * (span + slack)},
                            {"span_mm", 1e3 * span},
                            {"radius_mm", 6.0},
                            {"friction", 0.0}};
  const nlohmann::json ranges{{"travel_mm", {0.0, 50.0 * span}},
                              {"position_mm", {100.0 * span, 500.0 * span}},
                              {"slack_mm", {1e3 * slack - 1.0, 1e3 * slack + 1.0}}};
  return {{"schema", "snare-law/1"},
          {"title", "made for the test"},
          {"cases",
           {{{"wire", wire}, {"ranges", ranges}, {"table", table}, {"positions", nlohmann::json::array()}}}}};
}

class TablesOfPushes : public test::FolderFixture {
 protected:
  [[nodiscard]] NamedMotion read(const nlohmann::json& law, const std::vector<std::string>& settings) const {
    write("law.json", law.dump());
    std::vector<std::string> all{"wires[wire].model=\"table\"",
                                 "wires[wire].table.file=\"" + path("law.json").string() + "\""};
    all.insert(all.end(), settings.begin(), settings.end());
    return air_table_with(all);
  }
};

// The force is minus the slope of an energy, along the chord too, on either half of it.
TEST_F(TablesOfPushes, HaveAnEnergy) {
  const NamedMotion run = read(law_json(0.175, 0.005), {});
  ASSERT_EQ(run.motion.law_wires.size(), 1u);
  const coupling::WirePushLaw& push = run.motion.law_wires[0].push;
  const DistilledLaw law = read_laws("law.json", law_json(0.175, 0.005)).front();
  for (const Vector2d& place : {Vector2d(0.05, 0.012), Vector2d(0.125, 0.011), Vector2d(0.09, 0.018)}) {
    const coupling::WirePush p = push(place, 0.0);
    ASSERT_GT(p.depth, 1e-4);
    constexpr double h = 1e-7;
    for (int k = 0; k < 2; ++k) {
      const Vector2d step = h * Vector2d::Unit(k);
      const coupling::WirePush up = push(place + step, 0.0), down = push(place - step, 0.0);
      EXPECT_NEAR((up.energy - down.energy) / (2.0 * h), p.force[k], 1e-5 * p.force.norm()) << k;
      EXPECT_LT(((up.force - down.force) / (2.0 * h) - p.by_place.col(k)).norm(), 1e-4 * p.by_place.norm())
          << k;
    }
    EXPECT_NEAR(p.force.y(), law.loading->force(p.depth, place.x(), 0.005), 1e-12 * p.force.y());
  }
}

TEST_F(TablesOfPushes, KeepTheEnergyOfAnImpactBesideTheMiddle) {
  const NamedMotion run = read(
      law_json(0.175, 0.005),
      {"bodies[target].position_mm=[10.0, -93.0, 0.0]", "duration_s=0.3", "solver.relative_tolerance=1e-9",
       "solver.body_position_tolerance_m=1e-12", "solver.body_velocity_tolerance_m_s=1e-9",
       "solver.body_angle_tolerance_rad=1e-11", "solver.body_spin_tolerance_rad_s=1e-8"});
  const coupling::MotionResult r = coupling::simulate(run.motion, run.options);
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  ASSERT_EQ(r.events.size(), 2u);
  EXPECT_EQ(r.energy.dissipated, 0.0);
  EXPECT_NEAR(r.energy.kinetic, 0.0445, 1e-6 * 0.0445);            // falls with the tolerances
  EXPECT_GT(std::abs(r.impulse[0].x()), 0.01 * r.impulse[0].y());  // along the chord
}

TEST_F(TablesOfPushes, AreOfTheirWireAlone) {
  const nlohmann::json law = law_json(0.175, 0.005);
  const auto told = [&](const nlohmann::json& of, const std::vector<std::string>& settings) {
    return test::refusal([&] { return read(of, settings); });
  };
  EXPECT_THAT(told(law_json(0.17, 0.005), {}),
              HasSubstr("must have been distilled from this wire: its span is 170 mm, here 175 mm"));
  EXPECT_THAT(told(law, {"wires[wire].youngs_modulus_GPa=190.0"}), HasSubstr("its bending stiffness is"));
  EXPECT_THAT(told(law, {"wires[wire].length_mm=182.0"}),
              HasSubstr("must have this wire's slack of 7 mm in its range, 4 to 6 mm"));
  EXPECT_THAT(told(law, {"shapes[probe].radius_mm=5.0"}),
              HasSubstr("must be 6, with which the law of wire was distilled"));
  EXPECT_THAT(told(law, {"wires[wire].table.case=2"}),
              HasSubstr("wires[wire].table.case = 2, must be at most 1"));
  EXPECT_THAT(told(nlohmann::json::object(), {}), HasSubstr("law.json: schema, missing"));
}

}  // namespace
}  // namespace snare::scenario
