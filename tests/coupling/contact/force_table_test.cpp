#include "coupling/contact/force_table.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <vector>

namespace snare::coupling {
namespace {

// Of a function that is cubic along every axis the table is exact, slopes too; its mirror image answers
// beyond mid-span.
TEST(ForceTable, IsExactForCubicsAndMirrors) {
  const ForceTable::Axes axes{{{0.0, 0.01, 0.02, 0.03}, {0.2, 0.3, 0.35, 0.5}, {0.001, 0.002, 0.004, 0.005}}};
  const auto f = [](double d, double s, double e) {
    return d * (1.0 + 50.0 * d) * (2.0 - s * (1.0 - s)) * (1.0 + 40.0 * e * (1.0 - 30.0 * e));
  };
  const auto fd = [](double d, double s, double e) {
    return (1.0 + 100.0 * d) * (2.0 - s * (1.0 - s)) * (1.0 + 40.0 * e * (1.0 - 30.0 * e));
  };
  std::vector<double> values, slopes;
  for (const double e : axes[2]) {
    for (const double s : axes[1]) {
      for (const double d : axes[0]) {
        values.push_back(f(d, s, e));
        slopes.push_back(fd(d, s, e));
      }
    }
  }
  const double span = 2.0;
  const double ei = 4.0;
  // Values in N at travels in m: the groups divide by the span.
  std::vector<double> slopes_m = slopes;
  for (double& m : slopes_m) m /= span;
  const ForceTable table(axes, values, slopes_m, span, ei, true);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const double d = 0.03 * u(random);
    const double s = 0.2 + 0.3 * u(random);
    const double e = 0.001 + 0.004 * u(random);
    EXPECT_NEAR(table.force(d * span, s * span, e * span), f(d, s, e), 1e-13);
    EXPECT_NEAR(table.force(d * span, (1.0 - s) * span, e * span), f(d, s, e), 1e-13);
    EXPECT_NEAR(table.at(d * span, s * span, e * span, Outside::refuse).stiffness * span, fd(d, s, e), 1e-11);
  }
  EXPECT_TRUE(table.proven_monotone());
  EXPECT_TRUE(table.at(0.04 * span, 0.3 * span, 0.002 * span, Outside::extrapolate).extrapolated);
  EXPECT_THROW(static_cast<void>(table.at(0.01 * span, 0.1 * span, 0.002 * span, Outside::refuse)),
               std::domain_error);
}

/// A loose wire's force in shape: stiffer towards the mount and with less slack, so steeply that tangents
/// beyond the range become negative.
/// softening: falls at the end of the travel.
ForceTable steep_table(bool mirrored, double softening = 0.0) {
  const ForceTable::Axes axes{
      {{0.0, 0.004, 0.009, 0.015, 0.02}, {0.2, 0.3, 0.4, 0.5}, {0.001, 0.002, 0.003}}};
  std::vector<double> values, slopes;
  for (const double e : axes[2]) {
    for (const double s : axes[1]) {
      for (const double d : axes[0]) {
        const double stiffness = 1.0 / (s * (1.0 - s)) * (0.0032 - e);
        values.push_back(stiffness * (d + 80.0 * d * d - softening * 4000.0 * d * d * d));
        slopes.push_back(stiffness * (1.0 + 160.0 * d - softening * 12000.0 * d * d));
      }
    }
  }
  return {axes, values, slopes, 1.0, 1.0, mirrored};
}

// Outside the range a force is never negative and never falls along the travel, and the stiffness that is
// stated is its slope, however far the point is; inside nothing changes. For rising and softening tables,
// with mirror image and without.
TEST(ForceTable, ContinuationNeitherAttractsNorFalls) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> travel(0.0, 0.5), position(-0.3, 1.3), slack(-0.01, 0.02);
  constexpr double h = 1e-7;
  for (const ForceTable& table : {steep_table(true), steep_table(false), steep_table(true, 1.0)}) {
    int raised = 0;
    for (int i = 0; i < 3000; ++i) {
      const double s = position(random);
      const double e = slack(random);
      const double d = travel(random) * (i % 2 == 0 ? 1.0 : 0.04) + h;
      const LawValue here = table.at(d, s, e, Outside::extrapolate);
      EXPECT_GE(here.force, 0.0);
      if (!here.extrapolated) continue;
      EXPECT_GE(here.stiffness, 0.0) << d << " " << s << " " << e;
      const double low = table.at(d - h, s, e, Outside::extrapolate).force;
      const double high = table.at(d + h, s, e, Outside::extrapolate).force;
      EXPECT_GE(high, low - 1e-13 * (1.0 + low));  // round-off
      raised += here.stiffness == 0.0 ? 1 : 0;
      // Central differences of pieces that are cubic at most: h^2, round-off over h; a knot between the
      // points changes the curvature.
      EXPECT_NEAR(here.stiffness, (high - low) / (2.0 * h), 1e-4 * (1.0 + here.stiffness));
      EXPECT_THROW(static_cast<void>(table.at(d, s, e, Outside::refuse)), std::domain_error);
    }
    EXPECT_GT(raised, 10);  // places where the tangent alone would attract
  }
}

// Where the tangent itself rises the continuation is the tangent, and it meets the table at the edge of the
// range.
TEST(ForceTable, ContinuationIsLinearAndContinuous) {
  const ForceTable table = steep_table(true);
  constexpr double h = 1e-6;
  const auto force = [&](double d, double s, double e) {
    return table.at(d, s, e, Outside::extrapolate).force;
  };
  for (const double d : {0.001, 0.007, 0.02}) {
    // Differences inside, at the edge, of second order: h^2 times third derivatives of some 1e3 times the
    // force.
    const double f = force(d, 0.2, 0.003);
    const double by_s =
        (-3.0 * f + 4.0 * force(d, 0.2 + h, 0.003) - force(d, 0.2 + 2.0 * h, 0.003)) / (2.0 * h);
    const double by_e =
        (3.0 * f - 4.0 * force(d, 0.2, 0.003 - h) + force(d, 0.2, 0.003 - 2.0 * h)) / (2.0 * h);
    EXPECT_NEAR(force(d, 0.15, 0.003), f - 0.05 * by_s, 1e-7 * f);
    EXPECT_NEAR(force(d, 0.2, 0.0031), f + 1e-4 * by_e, 1e-7 * f);
    EXPECT_NEAR(force(d, 0.85, 0.003), force(d, 0.15, 0.003), 1e-13);
  }
  const LawValue end = table.at(0.02, 0.3, 0.002, Outside::refuse);
  EXPECT_NEAR(force(0.1, 0.3, 0.002), end.force + 0.08 * end.stiffness, 1e-12);
  EXPECT_EQ(force(0.01, -0.2, 0.002), force(0.01, 0.0, 0.002));  // no wire beyond the mounts
}

}  // namespace
}  // namespace snare::coupling
