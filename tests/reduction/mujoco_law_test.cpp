// The numbers of the MuJoCo forms: their sums are the curve, its tangent beyond the end, and the loop of the
// load/unload law.

#include "reduction/mujoco_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace snare::reduction {
namespace {

constexpr double end = 4e-3;

/// A curve that is no single cubic, with a soft or a falling end.
numerics::HermiteCurve curve(double last_slope_factor) {
  std::vector<double> x, v, m;
  for (int i = 0; i <= 9; ++i) {
    const double d = end * std::pow(i / 9.0, 1.3);
    x.push_back(d);
    v.push_back(2000.0 * d + 6e5 * d * d + 0.2 * std::sin(2000.0 * d));
    m.push_back(2000.0 + 1.2e6 * d + 400.0 * std::cos(2000.0 * d));
  }
  m.back() *= last_slope_factor;
  return {x, v, m};
}

TEST(MujocoLaw, SpringsAreTheCurveAndItsTangent) {
  for (const double factor : {1.0, -0.5}) {
    const numerics::HermiteCurve c = curve(factor);
    const MujocoLaw law = mujoco_law(0.09, c, std::nullopt, {});
    for (int i = -50; i <= 400; ++i) {
      const double d = end * i / 100.0;
      const double wanted = d < 0.0   ? 0.0
                            : d < end ? c.value(d)
                                      : c.value(end) + std::max(0.0, c.slopes().back()) * (d - end);
      EXPECT_NEAR(force_of(law.springs, d), wanted, 1e-11 * c.value(end)) << d;
    }
    EXPECT_GE(law.steepest, c.slopes().front());
    EXPECT_FALSE(law.loop.has_value());
  }
}

TEST(MujocoLaw, TheLinearFormIsTheGivenOneOrTheLeastSquares) {
  EXPECT_DOUBLE_EQ(mujoco_law(0.09, curve(1.0), 4321.0, {}).linear_stiffness, 4321.0);
  const numerics::HermiteCurve straight({0.0, 0.5 * end, end}, {0.0, 1.5, 3.0},
                                        {3.0 / end, 3.0 / end, 3.0 / end});
  const MujocoLaw law = mujoco_law(0.09, straight, std::nullopt, {});
  EXPECT_NEAR(law.linear_stiffness, 3.0 / end, 1e-9);
  EXPECT_NEAR(law.linear_error, 0.0, 1e-12);
}

TEST(MujocoLaw, TheLoopLosesTheEnergyOfTheLaw) {
  const numerics::HermiteCurve c = curve(1.0);
  for (const double returned : {0.5, 0.9, 0.999}) {
    scenario::DistilledLoss loss;
    loss.loop = {returned, 0.1 * end, 0.95 * (1.0 - returned) * c.integral(end)};
    const MujocoLaw law = mujoco_law(0.09, c, std::nullopt, loss);
    ASSERT_TRUE(law.loop.has_value());
    EXPECT_NEAR(law.loop->energy / loss.loop->energy, 1.0, 1e-12);
    // Half the difference of the branches is 0.5 (1 - r) of the force; a tenth of it is left to the ramps of
    // the sliders.
    EXPECT_LT(law.loop->largest_error, 1.1 * (1.0 - returned) * c.value(end));
    for (const MujocoSlider& s : law.loop->sliders) EXPECT_GT(s.tension, 0.0);
  }
}

TEST(MujocoLaw, ElongationsRiseFromTheFirstTouchOn) {
  const MujocoSlider slider{1e-3, 2e-4, 1.0, 1e-5};
  EXPECT_EQ(elongation(slider, 1e-3), 0.0);
  EXPECT_EQ(elongation(slider, -1.0), 0.0);
  double before = 0.0;
  for (int i = 1; i < 100; ++i) {
    const double now = elongation(slider, 1e-3 + 5e-5 * i);
    EXPECT_GT(now, before);
    before = now;
  }
  // Far beyond its sites the tendon grows by twice the travel.
  EXPECT_NEAR((elongation(slider, 0.1 + 1e-6) - elongation(slider, 0.1)) / 1e-6, 2.0, 1e-5);
}

}  // namespace
}  // namespace snare::reduction
