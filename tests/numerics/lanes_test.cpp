#include "numerics/lanes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace snare::numerics {
namespace {

constexpr double round_off = 4e-16;

TEST(Lanes, WorkOnEachNumberAsOnOne) {
  const std::array<double, 4> a{1.5, -2.25, 3.0, 1e-3}, b{0.1, 7.0, -0.3, 2.0};
  const Lanes x = Lanes::at(a.data()), y = Lanes::at(b.data());
  for (int k = 0; k < Lanes::count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    EXPECT_EQ((x + y)[k], a[i] + b[i]);
    EXPECT_EQ((x - 2.0 * y)[k], a[i] - 2.0 * b[i]);
    EXPECT_EQ((x / y)[k], a[i] / b[i]);
    EXPECT_EQ((-x)[k], -a[i]);
    EXPECT_EQ(abs(x)[k], std::abs(a[i]));
    EXPECT_EQ(sqrt(abs(x))[k], std::sqrt(std::abs(a[i])));
  }
  EXPECT_EQ(x.sum(), (a[0] + a[1]) + (a[2] + a[3]));
  EXPECT_TRUE(all_below(x, 3.5));
  EXPECT_FALSE(all_below(x, 3.0));
  EXPECT_TRUE(none_below(x, -2.25));
  EXPECT_FALSE(none_below(x, -2.0));
  EXPECT_FALSE(all_below(x / 0.0 * 0.0, 1.0));
  EXPECT_FALSE(none_below(x / 0.0 * 0.0, 1.0));
}

TEST(Lanes, AreStoredAndAddedWhereTheyAre) {
  std::vector<double> row(9, 1.0);
  Lanes(1.0, 2.0, 3.0, 4.0).store(row.data() + 1);
  Lanes(10.0, 20.0, 30.0, 40.0).add_to(row.data() + 3);
  EXPECT_EQ(row, (std::vector<double>{1.0, 1.0, 2.0, 13.0, 24.0, 31.0, 41.0, 1.0, 1.0}));
}

TEST(Lanes, VectorsAreThoseOfSpace) {
  const Eigen::Vector3d a(1.0, -2.0, 0.5), b(0.3, 4.0, -1.0);
  const Lanes3 x(a[0], a[1], a[2]), y(b[0], b[1], b[2]);
  EXPECT_DOUBLE_EQ(x.dot(y)[2], a.dot(b));
  for (int k = 0; k < 3; ++k) {
    EXPECT_DOUBLE_EQ(x.cross(y)[k][1], a.cross(b)[k]);
    EXPECT_DOUBLE_EQ((x - 2.0 * y)[k][3], (a - 2.0 * b)[k]);
  }
}

// Near zero by powers, elsewhere by the library: on both sides of the border and mixed.
TEST(Lanes, SineCosineAndPolarAngleAreThoseOfTheLibrary) {
  for (const double scale : {1e-9, 1e-3, 0.04, 0.0499, 0.0501, 0.249, 0.251, 1.0, 3.0}) {
    const Lanes angle(scale, -scale, 0.7 * scale, 0.0);
    const SineCosine<Lanes> of = sine_cosine(angle);
    const Lanes back = polar_angle(2.0 * of.sine, 2.0 * of.cosine);
    for (int k = 0; k < Lanes::count; ++k) {
      EXPECT_NEAR(of.sine[k], std::sin(angle[k]), round_off * std::abs(angle[k]));
      EXPECT_NEAR(of.cosine[k], std::cos(angle[k]), round_off);
      EXPECT_NEAR(back[k], angle[k], 2.0 * round_off * std::abs(angle[k]));
    }
  }
  const Lanes behind = polar_angle(Lanes(0.0, 1e-3, -1e-3, 1.0), Lanes(-1.0, -1.0, -1.0, 0.0));
  EXPECT_EQ(behind[0], std::numbers::pi);
  EXPECT_DOUBLE_EQ(behind[1], std::atan2(1e-3, -1.0));
  EXPECT_DOUBLE_EQ(behind[2], std::atan2(-1e-3, -1.0));
  EXPECT_DOUBLE_EQ(behind[3], 0.5 * std::numbers::pi);
}

}  // namespace
}  // namespace snare::numerics
