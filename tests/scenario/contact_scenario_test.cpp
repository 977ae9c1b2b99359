#include "scenario/contact_scenario.hpp"

#include "coupling/dynamics/law_part.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/sparse_product.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

namespace snare::scenario {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using ::testing::HasSubstr;

const std::filesystem::path air_table = std::filesystem::path(SNARE_SOURCE_DIR) / "data/scenarios/air_table.toml";

ContactScenario air_table_with(const std::vector<std::string>& settings) {
  return read_contact_scenario(air_table, test::overrides(settings));
}

TEST(ContactScenario, ReadsTheAirTable) {
  const ContactScenario s = air_table_with({});
  EXPECT_DOUBLE_EQ(s.body.properties.mass, 8.9);
  EXPECT_DOUBLE_EQ(s.push.contact_position, 0.09);
  EXPECT_EQ(s.probe, Vector3d(0.05, 0.1, 0.0));
  ASSERT_EQ(s.models.size(), 3u);
  EXPECT_FALSE(s.models[0].law);
  EXPECT_NEAR(s.models[1].law(5e-3, 0.0).x(), 890183.0 * 25e-6 - 1297.6 * 5e-3 + 0.3457, 1e-12);
  EXPECT_EQ(s.options.max_step, 1e9);  // no touch is missed without a limit
  EXPECT_EQ(s.friction.law, coupling::ContactFriction::stick_slip);
  EXPECT_DOUBLE_EQ(s.friction.static_coefficient, 0.3);
  EXPECT_DOUBLE_EQ(s.friction.bristle_displacement, 1e-6);
}

TEST(ContactScenario, SmoothFrictionHasNoBristle) {
  EXPECT_EQ(air_table_with({"friction.law=\"smooth\""}).friction.law, coupling::ContactFriction::smooth);
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{"friction.law=\"smooth\"", "friction.bristle_time_s=1e-5"}, "belongs to law = \"stick_slip\""},
      {{"friction.law=\"smooth\"", "friction.static_speed_m_s=0"}, "must be > 0 with the smooth law"}};
  for (const auto& one : wrong) {
    EXPECT_THAT(test::refusal([&] { return air_table_with(one.first); }), HasSubstr(one.second));
  }
  const ContactScenario at_once = air_table_with({"friction.static_speed_m_s=0", "friction.dynamic_speed_m_s=0"});
  EXPECT_EQ(at_once.friction.dynamic_speed, 0.0);
}

TEST(ContactScenario, SaysWhatIsWrong) {
  const test::WrongSetting wrong[] = {
      {"kind=\"push\"", "kind"},
      {"schema=\"snare-scenario/2\"", "must be \"snare-scenario/1\""},
      {"duration_s=0", "duration_s = 0, must be > 0"},
      {"output_interval_s=1e-8", "gives more than 1e+06 lines"},
      {"contact_position_mm=180", "inside the span"},
      {"body.mass_kg=-1", "body.mass_kg = -1, must be > 0"},
      {"body.inertia_kg_m2=[1.0, 1.0, 3.0]", "triangle inequality"},
      {"body.inertia_kg_m2=[1.0, 1.0]", "inertia_kg_m2"},
      {"body.mas_kg=1", "mass_kg"},
      {"mount.kind=\"supports\"", "supports"},
      {"mount.slip_tension_N=10", "mounts are rigid in motion"},
      {"wire.natural_curvature_1_m=2", "naturally straight in motion"},
      {"friction.dynamic_speed_m_s=0.005", "must be > static_speed_m_s"},
      {"friction.law=\"bristle\"", "\"stick_slip\""},
      {"friction.static_friction=0.05", "must be at least pusher.friction"},
      {"friction.bristle_displacement_m=0", "friction.bristle_displacement_m = 0, must be"},
      {"friction.bristle_time_s=-1e-5", "friction.bristle_time_s = -1e-5, must be"},
      {"friction.bristle_m=1", "unknown"},
      {"solver.elements=2", "elements = 2"},
      {"solver.formulation=\"cubic\"", "solver.formulation = \"cubic\", must be \"vertices\" or \"higher_order\""},
      {"wire.diameter_mm=0", "diameter_mm = 0"},
  };
  test::expect_refused(wrong, [](const char* setting) { return air_table_with({setting}); });
}

TEST(ContactScenario, NamesTheFormulationOfItsWire) {
  const auto of = [](const ContactScenario& s) { return motion_of(s, s.models[0]).wires[0].rod.formulation; };
  EXPECT_EQ(of(air_table_with({})), wire::Formulation::vertices);
  EXPECT_EQ(of(air_table_with({"solver.formulation=\"higher_order\""})), wire::Formulation::higher_order);
}

// Digest of Table 4: the quadratic at s = 90 mm, head-on, without damping: 8.9 kg at 0.1 m/s.
TEST(ContactScenario, TakesModelsAndDampingOfTheWire) {
  const ContactScenario s = air_table_with({"damping.strand_time_s=2e-5"});
  EXPECT_DOUBLE_EQ(s.strand_time, 2e-5);
  EXPECT_TRUE(motion_of(s, {"still", "quasi_static", {}, true}).wires[0].rod.quasi_static);
  EXPECT_FALSE(motion_of(s, s.models[0]).wires[0].rod.quasi_static);
}

TEST(ContactScenario, QuadraticLawHeadOn) {
  const ContactScenario s =
      air_table_with({"body.probe_mm=[0.0, 100.0, 0.0]", "duration_s=0.4", "solver.relative_tolerance=1e-7",
                      "solver.position_tolerance_m=1e-9", "solver.velocity_tolerance_m_s=1e-6"});
  const coupling::MotionResult r = coupling::simulate(motion_of(s, s.models[1]), s.options);
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  // Quadrature of A d^2 + B d + C (cut off where it would pull) against m v^2/2 gives depth 6.07 mm, force 25.2 N;
  // printed to three digits, steps end up to 1e-3 beside the peak.
  EXPECT_NEAR(r.peak_force[0], 25.2, 0.1);
  EXPECT_NEAR(r.impulse[0].y(), 1.78, 0.01);
  EXPECT_NEAR(r.energy.dissipated, 0.0, 1e-3 * 0.5 * 8.9 * 0.01);  // an elastic law gives all back
}

TEST(LawPart, JacobianMatchesDifferences) {
  coupling::MotionBody body;
  body.properties.inertia = Vector3d(0.2, 0.3, 0.4).asDiagonal();
  const coupling::MotionOptions options;
  coupling::BodyPart part(body, Vector3d::Zero(), options);
  coupling::PointContactLaw spring;
  spring.point = {0.05, 0.1, -0.02};
  spring.origin = {0.0, 0.05, 0.0};
  spring.direction = Vector3d(0.2, 0.9, 0.1).normalized();
  spring.law = coupling::power_law(3e3, 1.5, 200.0, 1.0);
  coupling::LawPart law(spring, part);
  numerics::DaeSystem system({&part, &law});
  VectorXd y = VectorXd::Zero(system.size());
  part.place(y);
  y.segment<4>(part.quaternion()) = Eigen::Vector4d(0.98, 0.1, -0.12, 0.11).normalized();
  y.segment<3>(part.velocity()) << 0.1, 0.3, -0.1;
  y.segment<3>(part.spin()) << 0.3, -0.2, 0.5;
  const VectorXd rate = VectorXd::Zero(y.size());
  ASSERT_GT(law.sample({0.0, y, rate}).normal_force, 1.0);
  constexpr double c = 10.0;
  const numerics::SparseMatrix& sparse = system.jacobian({0.0, y, rate}, c);
  const Eigen::Vector4d q = y.segment<4>(part.quaternion());
  VectorXd plus(y.size()), minus(y.size());
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    VectorXd direction = VectorXd::Unit(y.size(), k);
    // Along the sphere: the length of the quaternion has an equation of its own.
    if (k >= part.quaternion() && k < part.quaternion() + 4)
      direction.segment<4>(part.quaternion()) -= q[k - part.quaternion()] * q;
    constexpr double h = 1e-6;
    const VectorXd up = y + h * direction, down = y - h * direction;
    const VectorXd up_rate = rate + c * h * direction, down_rate = rate - c * h * direction;
    system.residual({0.0, up, up_rate}, plus);
    system.residual({0.0, down, down_rate}, minus);
    const VectorXd product = sparse * direction;
    // Central differences over 1e-6: 1e-7 of the largest entries, m c and k, some 3e3.
    EXPECT_LT(((plus - minus) / (2.0 * h) - product).lpNorm<Eigen::Infinity>(), 3e-4) << k;
  }
}

}  // namespace
}  // namespace snare::scenario
