// Dashpots distilled of impacts on the wire in motion.

#include "reduction/impact_damping.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snare::reduction {
namespace {

numerics::HermiteCurve curve_of(double end, double (*force)(double)) {
  std::vector<double> d, f;
  for (int i = 0; i <= 200; ++i) {
    d.push_back(end * i / 200);
    f.push_back(force(d.back()));
  }
  return {d, f};
}

// A linear spring-dashpot that does not pull, in closed form: Schwager and Poeschel 2007.
TEST(ImpactDamping, LinearSpringDashpotReturnsAsPublished) {
  constexpr double k = 2000.0;
  constexpr double mass = 3.0;
  const numerics::HermiteCurve law = curve_of(0.05, [](double d) { return k * d; });
  for (const double c : {1.0, 20.0, 100.0}) {
    const double beta = 0.5 * c / mass;
    const double q = std::sqrt(k / mass - beta * beta);
    const double closed =
        std::exp(-beta / q * (std::numbers::pi - std::atan2(2.0 * beta * q, q * q - beta * beta)));
    const LawRebound found = rebound(law, c, mass, 0.2);
    EXPECT_NEAR(found.restitution, closed, 1e-6) << c;  // the last step is not cut at the parting
    EXPECT_NEAR(damping_of_restitution(law, closed, mass, 0.2), c, 1e-5 * c);
  }
  EXPECT_NEAR(rebound(law, 0.0, mass, 0.2).peak_force, 0.2 * std::sqrt(k * mass), 1e-6 * k);
  EXPECT_EQ(damping_of_restitution(law, 1.0, mass, 0.2), 0.0);
}

// A straight, slack-free wire without bending stiffness, pushed at mid-span: one strain d^2/(2 s (l - s))
// everywhere, hence F = EA l e(d) de/dd and, with the Kelvin-Voigt time tau, c(d) = tau EA l (de/dd)^2. That
// equation of one unknown is integrated here. The full wire has 12 elements and 2.4 g of mass, whose ripple
// is sqrt(2.4e-5) = 0.5 % of the force.
TEST(ImpactDamping, StraightWireLosesWhatItsMaterialTakes) {
  constexpr double l = 0.175;
  constexpr double axial = 19300.0;
  constexpr double tau = 2e-2;
  constexpr double mass = 100.0;
  constexpr double speed = 0.01;
  constexpr double curvature = 4.0 / (l * l);  // d2e/dd2

  double d = 0.0;
  double v = speed;
  double closed_peak = 0.0;
  const auto acceleration = [&](double x, double rate) {
    const double slope = curvature * x;
    return -axial * l * slope * (0.5 * slope * x + tau * slope * rate) / mass;
  };
  constexpr double step = 1e-5;
  while (d >= 0.0) {  // midpoint rule: 1e-12 of a period
    const double a = acceleration(d, v);
    const double middle = acceleration(d + 0.5 * step * v, v + 0.5 * step * a);
    closed_peak = std::max(closed_peak, -mass * a);
    d += step * (v + 0.5 * step * a);
    v += step * middle;
    if (v < 0.0 && a >= 0.0) break;
  }

  coupling::PushProblem test;
  test.wire.diameter = 1.5e-3;
  test.wire.length = l;
  test.wire.youngs_modulus = 193e9;
  test.wire.density = 7930.0;
  test.wire.axial_stiffness_override = axial;
  test.wire.bending_stiffness_override = 1e-5;
  test.mount.span = l;
  test.pusher.radius = 1e-3;
  test.contact_position = 0.5 * l;
  ImpactSettings settings;
  settings.mass = mass;
  settings.damping.axial_time = tau;
  settings.elements = 12;
  const numerics::HermiteCurve law =
      curve_of(0.02, [](double x) { return 0.5 * axial * l * curvature * curvature * x * x * x; });
  numerics::SolveReport report;
  const ImpactDamping impact = distil_impact(test, settings, speed, law, report);
  ASSERT_TRUE(report.usable()) << report.message;
  EXPECT_NEAR((1.0 - impact.restitution) / (1.0 + v / speed), 1.0, 0.01);
  EXPECT_NEAR(impact.peak_force / closed_peak, 1.0, 0.01);
  ASSERT_TRUE(impact.damping.has_value());
  EXPECT_GT(*impact.damping, 0.0);
}

// The same wire without damping between mounts that give: the tension is EA e' with 1/EA' = 1/EA + c/l of
// both compliances c together, and all of the body's energy is in EA' l e^2/2 at the peak. What each mount
// gives by itself does not matter, and nothing is lost.
TEST(ImpactDamping, MountsThatGiveSoftenTheImpact) {
  constexpr double l = 0.175, axial = 19300.0, mass = 1000.0, speed = 0.004;
  coupling::PushProblem test;
  test.wire.diameter = 1.5e-3;
  test.wire.length = test.mount.span = l;
  test.wire.youngs_modulus = 193e9;
  test.wire.density = 7930.0;
  test.wire.axial_stiffness_override = axial;
  test.wire.bending_stiffness_override = 1e-5;
  test.mount.translational_stiffness = 1e6;
  test.mount.own_translational_compliance = {1e-5, 3e-6};
  test.pusher.radius = 1e-3;
  test.contact_position = 0.5 * l;
  const double soft = 1.0 / (1.0 / axial + (2e-6 + 1.3e-5) / l);
  const double strain = speed * std::sqrt(mass / (soft * l));
  const double peak = soft * l * strain * 4.0 / (l * l) * l * std::sqrt(0.5 * strain);
  ImpactSettings settings;
  settings.mass = mass;
  settings.elements = 12;
  numerics::SolveReport report;
  const ImpactDamping impact =
      distil_impact(test, settings, speed, curve_of(0.02, [](double x) { return 1e6 * x * x * x; }), report);
  ASSERT_TRUE(report.usable()) << report.message;
  EXPECT_NEAR(impact.peak_force / peak, 1.0, 0.01);
  EXPECT_NEAR(impact.restitution, 1.0, 0.01);
}

TEST(ImpactDamping, NothingIsSaidBeyondTheLaw) {
  coupling::PushProblem test;
  test.wire.diameter = 1.5e-3;
  test.wire.length = 0.18;
  test.wire.youngs_modulus = 193e9;
  test.wire.density = 7930.0;
  test.mount.span = 0.175;
  test.pusher.radius = 6e-3;
  test.contact_position = 0.0875;
  ImpactSettings settings;
  settings.mass = 8.9;
  settings.damping.axial_time = settings.damping.bending_time = 1e-5;
  settings.elements = 20;
  numerics::SolveReport report;
  const ImpactDamping impact =
      distil_impact(test, settings, 0.1, curve_of(1e-4, [](double x) { return 1e4 * x; }), report);
  ASSERT_TRUE(report.usable()) << report.message;
  EXPECT_GT(impact.largest_travel, 1e-4);
  EXPECT_FALSE(impact.damping.has_value());
}

}  // namespace
}  // namespace snare::reduction
