#include "validation/closed_forms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "validation/span_stiffness.hpp"

namespace snare::validation {
namespace {

using std::numbers::pi;
constexpr double kSpan = 0.175;                                 // [m]
const double kSolid = 193e9 * pi * std::pow(1.5e-3, 4) / 64.0;  // EI of the solid wire [N m^2]

struct Stiffness {
  double position;
  double at_50_newton;
  double without_tension;
  double string;
};

// Independent evaluation of the beam-string's formula, printed to 0.1 N/m.
constexpr Stiffness kPrinted[] = {
    {0.040, 7407.2, 4897.2, 1620.4}, {0.065, 3638.9, 2109.6, 1223.8}, {0.090, 3083.8, 1722.4, 1143.8}};
constexpr double kPrintedDigit = 0.05;  // half a unit of the last printed digit

TEST(ClosedForms, TensionedClampedWireHasThePrintedStiffness) {
  for (const Stiffness& row : kPrinted) {
    EXPECT_NEAR(tensioned_clamped_stiffness(kSolid, 50.0, kSpan, row.position), row.at_50_newton,
                kPrintedDigit);
    EXPECT_NEAR(tensioned_clamped_stiffness(kSolid, 0.0, kSpan, row.position), row.without_tension,
                kPrintedDigit);
    EXPECT_NEAR(string_force(50.0, kSpan, row.position, 1.0), row.string, kPrintedDigit);
  }
}

TEST(ClosedForms, TensionedClampedWireTendsToTheBeam) {
  for (const Stiffness& row : kPrinted) {
    const double s = row.position;
    const double beam = 3.0 * kSolid * std::pow(kSpan / (s * (kSpan - s)), 3);
    // Rounding of some twenty operations.
    EXPECT_NEAR(tensioned_clamped_stiffness(kSolid, 0.0, kSpan, s) / beam, 1.0, 1e-14);
    // 1e-9 N beside a buckling load of 60 N: 2e-11.
    EXPECT_NEAR(tensioned_clamped_stiffness(kSolid, 1e-9, kSpan, s) / beam, 1.0, 1e-10);
  }
}

TEST(ClosedForms, TensionedClampedWireTendsToTheString) {
  // Clamps and load shorten each side by sqrt(EI/T): relative excess 2 sqrt(EI/T) (1/s + 1/(l-s)) l/l at
  // most.
  for (const double tension : {1e4, 1e6, 1e10}) {
    const double layer = std::sqrt(kSolid / tension);
    for (const Stiffness& row : kPrinted) {
      const double ratio = tensioned_clamped_stiffness(kSolid, tension, kSpan, row.position) /
                           string_force(tension, kSpan, row.position, 1.0);
      EXPECT_GT(ratio, 1.0);
      EXPECT_LT(ratio, 1.0 + 4.0 * layer / row.position);
    }
  }
}

TEST(ClosedForms, StiffnessIsContinuousWhereSeriesMeetsExponentials) {
  // |u| = 1 on the left side; tension moves the stiffness by about 1e-9 of it per 1e-8, the rest is rounding.
  const double s = 0.04;
  const double tension = kSolid / (s * s);
  const double below = tensioned_clamped_stiffness(kSolid, tension * (1.0 - 1e-10), kSpan, s);
  const double above = tensioned_clamped_stiffness(kSolid, tension * (1.0 + 1e-10), kSpan, s);
  EXPECT_NEAR(above / below, 1.0, 1e-9);
}

TEST(ClosedForms, ClampedWireLosesItsStiffnessAtTheBucklingLoad) {
  const double load = buckling_load(ColumnEnds::clamped_clamped, kSolid, kSpan);
  const double before = tensioned_clamped_stiffness(kSolid, -load * (1.0 - 1e-6), kSpan, 0.065);
  const double free = tensioned_clamped_stiffness(kSolid, 0.0, kSpan, 0.065);
  EXPECT_GT(before, 0.0);
  EXPECT_LT(before / free, 2e-6);  // falls about linearly with the load
}

TEST(ClosedForms, SpanStiffnessMatchesItsEquationByIntegration) {
  // w'''' = T w'' by classical Runge-Kutta from the clamp, end values solved for unit deflection.
  for (const double tension : {40.0, 0.3, -0.3, -20.0}) {
    const double length = 1.3;
    const int steps = 2000;
    double columns[2][4] = {{0, 0, 1, 0}, {0, 0, 0, 1}};
    for (auto& y : columns) {
      const double h = length / steps;
      for (int i = 0; i < steps; ++i) {
        double k[4][4];
        double at[4] = {y[0], y[1], y[2], y[3]};
        for (int stage = 0; stage < 4; ++stage) {
          for (int j = 0; j < 3; ++j) k[stage][j] = at[j + 1];
          k[stage][3] = tension * at[2];
          const double step = stage == 2 ? h : 0.5 * h;
          for (int j = 0; j < 4; ++j) at[j] = y[j] + step * k[stage][j];
        }
        for (int j = 0; j < 4; ++j) y[j] += h / 6.0 * (k[0][j] + 2.0 * k[1][j] + 2.0 * k[2][j] + k[3][j]);
      }
    }
    // Unit deflection without slope: shear at that end, T w' - w''' taken with the sign of the pull.
    const auto& [a, b] = columns;
    const double det = a[0] * b[1] - b[0] * a[1];
    const double first = b[1] / det;
    const double second = -a[1] / det;
    const double force = -(first * a[3] + second * b[3]);
    const double moment = first * a[2] + second * b[2];
    const SpanStiffness k = span_stiffness(tension, length);
    // Fourth-order rule with 2000 steps: below 1e-11.
    EXPECT_NEAR(k.deflection.real() / force, 1.0, 1e-10) << tension;
    EXPECT_NEAR(std::abs(k.coupling.real() / moment), 1.0, 1e-10) << tension;
  }
}

TEST(ClosedForms, UnstretchedWireFollowsFromItsElongation) {
  const double stiffness = 341e3;
  const double s = 0.065;
  const double d = 1e-3;
  const double b = kSpan - s;
  const double left = std::hypot(s, d);
  const double right = std::hypot(b, d);
  const double tension = stiffness * (left + right - kSpan) / kSpan;
  const double exact = tension * (d / left + d / right);
  // The law keeps the leading order: (d/s)^2 = 2.4e-4.
  EXPECT_NEAR(unstretched_wire_force(stiffness, kSpan, s, d) / exact, 1.0, 3e-4);
}

TEST(ClosedForms, ThreePointBendingAtMidSpan) {
  EXPECT_NEAR(three_point_stiffness(2.0, 3.0, 1.5), 48.0 * 2.0 / 27.0, 1e-14);  // 48 EI/l^3, to rounding
}

TEST(ClosedForms, BucklingLoads) {
  // pi^2/4, pi^2, x^2 and 4 pi^2/l^2 to the digits written here.
  EXPECT_NEAR(first_root_of_tan_x_equals_x(), 4.493409457909064, 1e-14);  // Abramowitz and Stegun, table 4.20
  EXPECT_NEAR(buckling_load(ColumnEnds::clamped_free, 1.0, 1.0), 2.4674011002723, 1e-12);
  EXPECT_NEAR(buckling_load(ColumnEnds::pinned_pinned, 1.0, 1.0), 9.8696044010894, 1e-12);
  EXPECT_NEAR(buckling_load(ColumnEnds::clamped_pinned, 1.0, 1.0), 20.190728556426, 1e-11);
  EXPECT_NEAR(buckling_load(ColumnEnds::clamped_clamped, 1.0, 2.0), 9.8696044010894, 1e-12);
  EXPECT_NEAR(second_clamped_buckling_load(1.0, 1.0), 80.7629, 5e-5);  // last printed digit
  // Declared wire: 58.4 would be for 180 mm, 61.8 N for 175 mm.
  EXPECT_NEAR(buckling_load(ColumnEnds::clamped_clamped, kSolid, 0.180), 58.4, 0.05);
}

TEST(ClosedForms, CapstanOverHalfATurn) {
  EXPECT_NEAR(capstan_ratio(0.3, pi), 2.566332, 5e-7);  // exp(0.9424778) = e^0.94 x e^0.0024778
  EXPECT_EQ(capstan_ratio(0.0, 5.0), 1.0);
}

}  // namespace
}  // namespace snare::validation
