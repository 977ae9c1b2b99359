#include "coupling/contact/contact_law.hpp"
#include "base/units.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace snare::coupling {
namespace {

using base::mm;

/// Derivatives of a law against central differences.
void expect_derivatives(const ContactLaw& law, double d, double rate) {
  const Eigen::Vector3d at = law(d, rate);
  const double h = 1e-7;
  // Differences of a smooth function over 1e-7 of its argument: 1e-6 of its size.
  EXPECT_NEAR((law(d + h, rate).x() - law(d - h, rate).x()) / (2.0 * h), at.y(),
              1e-6 * (std::abs(at.y()) + 1.0));
  EXPECT_NEAR((law(d, rate + h).x() - law(d, rate - h).x()) / (2.0 * h), at.z(),
              1e-6 * (std::abs(at.z()) + 1.0));
}

TEST(ContactLaw, DerivativesMatchDifferences) {
  for (const ContactLaw& law :
       {spring_dashpot(3e3, 5.0), power_law(2e4, 1.5, 40.0, 1.0), power_law(2e4, 2.6, 40.0, 1.3),
        power_law(2e4, 1.5, 4.0, 1.0, 0.0), power_law(2e4, 1.5, 40.0, 1.2, 2.0),
        step_damped_law(2e4, 1.5, 5.0, 3.0 * mm), step_damped_law(2e4, 1.5, 5.0, 1.0 * mm),
        quadratic_law(890183.0, 1297.6, 0.3), stretched_wire_law(5.55e5, 90 * mm, 87.5 * mm),
        stretched_wire_tangent(5.55e5, 90 * mm, 87.5 * mm)}) {
    expect_derivatives(law, 2.0 * mm, 0.05);
    expect_derivatives(law, 2.0 * mm, -0.05);
  }
}

TEST(ContactLaw, NeverPullsAndIsZeroApart) {
  const ContactLaw dashpot = spring_dashpot(1e3, 100.0);
  EXPECT_EQ(dashpot(1.0 * mm, -1.0), Eigen::Vector3d::Zero());  // 1 N - 100 N
  EXPECT_EQ(dashpot(-1.0 * mm, 1.0), Eigen::Vector3d::Zero());
  // Negative between 0.35 and 1.11 mm as printed (Abiko et al., Table 4, s = 90 mm).
  EXPECT_EQ(quadratic_law(890183.0, -1297.6, 0.3457)(0.7 * mm, 0.0).x(), 0.0);
  EXPECT_EQ(power_law(1e3, 1.5, 1e6, 1.0)(1.0 * mm, -1.0), Eigen::Vector3d::Zero());
}

// The spring's force is the slope of its energy, and the damping never gives power, also where the force is
// cut off.
TEST(ContactLaw, StoresItsSpringAndLosesTheRest) {
  for (const ContactLaw& law :
       {spring_dashpot(3e3, 50.0), power_law(2e4, 1.5, 4e4, 1.0), power_law(2e4, 2.6, 40.0, 1.3, 0.0),
        step_damped_law(2e4, 1.5, 50.0, 3.0 * mm), quadratic_law(890183.0, -1297.6, 0.3457),
        quadratic_law(-4e5, 1000.0, 0.1), quadratic_law(0.0, 1000.0, -0.5),
        stretched_wire_law(5.55e5, 90 * mm, 87.5 * mm), stretched_wire_tangent(5.55e5, 90 * mm, 87.5 * mm)}) {
    EXPECT_EQ(law.energy(0.0), 0.0);
    EXPECT_EQ(law.energy(-1.0 * mm), 0.0);
    for (const double d : {0.1 * mm, 0.45 * mm, 0.7 * mm, 1.5 * mm, 4.0 * mm}) {
      const Eigen::Vector3d spring = law.elastic(d);
      const double h = 1e-8;
      EXPECT_NEAR((law.energy(d + h) - law.energy(d - h)) / (2.0 * h), spring.x(), 1e-5 * (spring.x() + 1.0));
      EXPECT_NEAR((law.elastic(d + h).y() - law.elastic(d - h).y()) / (2.0 * h), spring.z(),
                  1e-5 * (std::abs(spring.z()) + std::abs(spring.y()) / d + 1.0));
      EXPECT_EQ(spring.x(), law(d, 0.0).x());
      for (const double rate : {-3.0, -0.1, -1e-4, 1e-4, 0.1, 3.0})
        EXPECT_GE((law(d, rate).x() - spring.x()) * rate, 0.0) << d << " " << rate;
    }
  }
}

// Honda et al. 2014: l = 90, L = 87.5 mm, K = 5.55e5 N/m gives 60810 N/m; exact over linear 1.068 at 1 mm,
// 1.74 at 10 mm.
TEST(ContactLaw, StretchedWireOfHonda) {
  const double k = 5.55e5;
  const ContactLaw exact = stretched_wire_law(k, 90 * mm, 87.5 * mm);
  const ContactLaw linear = stretched_wire_tangent(k, 90 * mm, 87.5 * mm);
  EXPECT_NEAR(linear(1.0, 0.0).x(), 60810.0, 5.0);  // printed to five digits
  EXPECT_NEAR(exact(1 * mm, 0.0).x() / linear(1 * mm, 0.0).x(), 1.068, 5e-4);
  EXPECT_NEAR(exact(10 * mm, 0.0).x() / linear(10 * mm, 0.0).x(), 1.74, 5e-3);
  // Without slack: the cubic K x^3/l^2, to the next order (x/l)^2 (3/4).
  const ContactLaw cubic = stretched_wire_law(k, 90 * mm, 90 * mm);
  EXPECT_NEAR(cubic(1 * mm, 0.0).x(), k * std::pow(1 * mm, 3) / std::pow(90 * mm, 2),
              2e-4 * cubic(1 * mm, 0.0).x());
}

}  // namespace
}  // namespace snare::coupling
