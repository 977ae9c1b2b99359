#include "validation/shallow_elastica.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "validation/closed_forms.hpp"

namespace snare::validation {
namespace {

using std::numbers::pi;

struct Row {
  double compression;
  double position;
  double force;
  double force_digit;  // half a unit of the last digit given
  double deflection;
  double deflection_digit;
};

// Values computed before and apart from this code, to the digits they were given with.
constexpr Row kTable[] = {
    {4 * pi * pi, 0.5, 0.0, 1e-15, 2.0 / pi, 1e-15}, {20.0, 0.5, 61.181, 5e-4, 0.641347, 5e-7},
    {0.0, 0.5, 123.936, 5.5e-4, 0.645497, 5e-7},     {-100.0, 0.5, 435.748, 5e-4, 0.659454, 5e-7},
    {-1000.0, 0.5, 3142.19, 5e-3, 0.686182, 5e-7},   {4 * pi * pi, 0.4, 0.0, 1e-15, 0.5758, 5e-5},
    {20.0, 0.4, 67.100, 5e-4, 0.605935, 5e-7},       {0.0, 0.4, 134.479, 5e-4, 0.619677, 5e-7},
    {-100.0, 0.4, 459.565, 5e-4, 0.643166, 5e-7},    {-1000.0, 0.4, 3231.43, 5e-3, 0.671176, 5e-7},
};

TEST(ShallowElastica, OutwardTable) {
  for (const Row& row : kTable) {
    const ShallowState state = shallow_state(row.compression, row.position);
    EXPECT_NEAR(state.force, row.force, row.force_digit) << row.compression << " " << row.position;
    EXPECT_NEAR(state.deflection, row.deflection, row.deflection_digit)
        << row.compression << " " << row.position;
  }
  // 192 EI/l^3 times the deflection sqrt(5/12) at mid-span; taut: sqrt(2 s (1 - s)), printed to six digits at
  // 0.4.
  EXPECT_NEAR(shallow_state(0.0, 0.5).force, 192.0 * std::sqrt(5.0 / 12.0), 1e-11);
  EXPECT_NEAR(shallow_taut_deflection(0.5), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(shallow_taut_deflection(0.4), 0.692820, 5e-7);
}

TEST(ShallowElastica, CentrePathHasItsClosedForm) {
  // d = F (lam - 4 tan(lam/4))/(4 lam^3), F positive against the bulge; tan -> tanh in tension.
  for (const double lam : {0.5, 2.0, 5.0, 6.2, 6.4, 8.5, 11.0}) {
    const ShallowState state = shallow_state(lam * lam, 0.5);
    const double formula = -(lam - 4.0 * std::tan(lam / 4.0)) / (4.0 * lam * lam * lam);
    // lam - 4 tan(lam/4) cancels to lam^3/48: at lam = 0.5 about 200 roundings.
    EXPECT_NEAR(state.deflection / state.force / formula, 1.0, 1e-12) << lam;
  }
  for (const double lam : {0.5, 3.0, 10.0, 100.0, 1e4}) {
    const ShallowState state = shallow_state(-lam * lam, 0.5);
    const double formula = (lam - 4.0 * std::tanh(lam / 4.0)) / (4.0 * lam * lam * lam);
    EXPECT_NEAR(state.deflection / state.force / formula, 1.0, 1e-12) << lam;
  }
}

TEST(ShallowElastica, WithoutCompressionItIsTheClampedBeam) {
  for (const double s : {0.5, 0.4, 0.25, 0.1}) {
    const ShallowState state = shallow_state(0.0, s);
    EXPECT_NEAR(state.force / state.deflection * std::pow(s * (1.0 - s), 3) / 3.0, 1.0,
                1e-13);  // some hundred roundings
  }
}

TEST(ShallowElastica, EndShorteningIsOne) {
  // The profile is built here by integrating w'''' + P w'' = f delta from the left clamp, with w'' and w'''
  // there chosen so that w = w' = 0 at the right one, and 1/2 int w'^2 is summed beside it.
  for (const double s : {0.5, 0.3}) {
    for (const double compression : {60.0, 20.0, 0.0, -50.0}) {
      const ShallowState state = shallow_state(compression, s);
      // Three solutions: unit w'', unit w''' at the clamp, and the load's; slope sampled on a grid.
      const int steps = 4000;
      const int at_load = static_cast<int>(std::lround(s * steps));
      const double h = 1.0 / steps;
      std::vector<double> slope[3];
      double end[3][2];
      double height[3] = {};
      for (int which = 0; which < 3; ++which) {
        double y[4] = {0, 0, which == 0 ? 1.0 : 0.0, which == 1 ? 1.0 : 0.0};
        for (int i = 0; i <= steps; ++i) {
          if (i == at_load) {
            height[which] = y[0];
            if (which == 2) y[3] += state.force;
          }
          slope[which].push_back(y[1]);
          if (i == steps) break;
          double k[4][4];
          double at[4] = {y[0], y[1], y[2], y[3]};
          for (int stage = 0; stage < 4; ++stage) {
            for (int j = 0; j < 3; ++j) k[stage][j] = at[j + 1];
            k[stage][3] = -compression * at[2];
            const double step = stage == 2 ? h : 0.5 * h;
            for (int j = 0; j < 4; ++j) at[j] = y[j] + step * k[stage][j];
          }
          for (int j = 0; j < 4; ++j) y[j] += h / 6.0 * (k[0][j] + 2.0 * k[1][j] + 2.0 * k[2][j] + k[3][j]);
        }
        end[which][0] = y[0];
        end[which][1] = y[1];
      }
      const double det = end[0][0] * end[1][1] - end[1][0] * end[0][1];
      const double a = (-end[2][0] * end[1][1] + end[1][0] * end[2][1]) / det;
      const double b = (-end[0][0] * end[2][1] + end[2][0] * end[0][1]) / det;
      double shortening = 0.0;
      for (int i = 0; i <= steps; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double w = a * slope[0][at] + b * slope[1][at] + slope[2][at];
        const double weight = i == 0 || i == steps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        shortening += 0.5 * weight * h / 3.0 * w * w;
      }
      // Simpson and Runge-Kutta with 4000 steps: about 1e-12; the load sits on an even grid point.
      EXPECT_NEAR(shortening, 1.0, 1e-9) << s << " " << compression;
      EXPECT_NEAR(a * height[0] + b * height[1], state.deflection, 1e-9) << s << " " << compression;
    }
  }
}

TEST(ShallowElastica, ForceIsTheEnergysDerivative) {
  // dU/da = f with U = 1/2 int w''^2 = 1/2 (f a + P int w'^2) = f a/2 + P (multiply the equation by w).
  const auto energy = [](const ShallowState& s) { return 0.5 * s.force * s.deflection + s.compression; };
  for (const double compression : {70.0, 30.0, -30.0, -300.0}) {
    for (const double s : {0.45, 0.3}) {
      if (compression > 66.0 && s == 0.3) continue;
      const double step = 1e-4 * std::abs(compression);
      const ShallowState low = shallow_state(compression - step, s);
      const ShallowState high = shallow_state(compression + step, s);
      const double slope = (energy(high) - energy(low)) / (high.deflection - low.deflection);
      // Central difference: relative 1e-6 from the step, as much from rounding.
      EXPECT_NEAR(slope / shallow_state(compression, s).force, 1.0, 1e-5) << compression << " " << s;
    }
  }
}

TEST(ShallowElastica, GivenDeflectionIsFound) {
  const ShallowState wanted = shallow_state(-37.0, 0.4);
  const ShallowState found = shallow_state_at(wanted.deflection, 0.4);
  // Deflection changes little with P: its last digit is worth some 1e-13 of P.
  EXPECT_NEAR(found.compression, -37.0, 1e-9);
  EXPECT_NEAR(found.force / wanted.force, 1.0, 1e-10);
}

TEST(ShallowElastica, InwardLargestForces) {
  EXPECT_NEAR(shallow_largest_inward(0.5).force, -129.530,
              5e-4);  // digits as given, computed apart from this code
  EXPECT_NEAR(shallow_largest_inward(0.45).force, -85.977, 5e-4);
  EXPECT_NEAR(shallow_largest_inward(0.4).force, -75.573, 5e-4);
}

TEST(ShallowElastica, InwardBifurcationAtMidSpan) {
  const ShallowState state = shallow_largest_inward(0.5);
  EXPECT_NEAR(state.compression, 80.7629, 5e-5);  // last digits given
  EXPECT_NEAR(state.deflection, 0.62351, 5e-6);
  // Branch: F = 207.744 EI d/L^3; given cut, not rounded: it is 207.7448.
  EXPECT_NEAR(-shallow_branch_stiffness(), 207.744, 1e-3);
  EXPECT_NEAR(state.force / state.deflection / shallow_branch_stiffness(), 1.0, 1e-13);
}

TEST(ShallowElastica, LargestInwardForceIsAMaximum) {
  for (const double s : {0.45, 0.4, 0.35}) {
    const ShallowState best = shallow_largest_inward(s);
    // Forces against the bulge are negative: the largest is the least.
    EXPECT_LT(best.force, shallow_state(best.compression + 0.1, s).force);
    EXPECT_LT(best.force, shallow_state(best.compression - 0.1, s).force);
    EXPECT_NEAR(best.force, shallow_largest_inward(1.0 - s).force,
                1e-9);  // mirror image: forces of 100 to rounding
  }
}

}  // namespace
}  // namespace snare::validation
