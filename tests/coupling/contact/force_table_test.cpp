#include "coupling/contact/force_table.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <vector>

namespace snare::coupling {
namespace {

// Of a function that is cubic along every axis the table is exact, slopes too; its mirror image answers beyond
// mid-span.
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
  EXPECT_THROW(static_cast<void>(table.at(0.01 * span, 0.1 * span, 0.002 * span, Outside::refuse)), std::domain_error);
}

}  // namespace
}  // namespace snare::coupling
