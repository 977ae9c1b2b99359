#include "coupling/dynamics/closed_stretches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace snare;
using coupling::ClosedStretch;
using coupling::ClosedStretches;
using coupling::GapPlace;

namespace {

constexpr double length = 14e-3, resolution = 1.25e-3;

/// g = depth q(u), q of degree four, with the bounds that the search asks for.
struct Quartic {
  std::array<double, 5> q{};
  double depth = 0.0;

  [[nodiscard]] double value(double u) const {
    return depth * (q[0] + u * (q[1] + u * (q[2] + u * (q[3] + u * q[4]))));
  }
  [[nodiscard]] double slope(double u) const {
    return depth * (q[1] + u * (2 * q[2] + u * (3 * q[3] + u * 4 * q[4]))) / length;
  }
  [[nodiscard]] double largest_bend() const {
    double largest = 0.0;
    for (int k = 0; k <= 1000; ++k) {
      const double u = k / 1000.0;
      largest = std::max(largest, std::abs(2 * q[2] + u * (6 * q[3] + u * 12 * q[4])));
    }
    return 1.01 * depth * largest / (length * length);
  }
  [[nodiscard]] std::vector<ClosedStretch> stretches() const {
    const auto gap = [this](double u) { return GapPlace{u, value(u), slope(u), 0.0}; };
    std::vector<ClosedStretch> found;
    std::vector<GapPlace> minima;
    ClosedStretches(length, 2.0 * length, largest_bend(), resolution).find(gap, gap(0.0), gap(1.0), found, minima);
    return found;
  }
};

}  // namespace

// What is closed is what a look at very many places shows: every stretch, however it lies to the ends of the pieces.
TEST(ClosedStretches, NothingIsHiddenAndNothingOpenIsTaken) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  constexpr int places = 20000;
  int closed = 0, several = 0;
  for (int k = 0; k < 2000; ++k) {
    Quartic g;
    g.depth = std::pow(10.0, -6.0 + 2.0 * even(random));
    // Zeros mostly on the element, so that signs and slopes change often.
    std::array<double, 4> zeros{};
    for (double& z : zeros) z = 0.5 + 0.8 * even(random);
    const double sign = even(random) < 0.0 ? -30.0 : 30.0;
    g.q = {sign, 0, 0, 0, 0};
    for (const double z : zeros) {
      for (std::size_t i = 4; i > 0; --i) g.q[i] = g.q[i - 1] - z * g.q[i];
      g.q[0] *= -z;
    }
    const std::vector<ClosedStretch> found = g.stretches();
    closed += found.empty() ? 0 : 1;
    several += found.size() > 1 ? 1 : 0;
    for (std::size_t j = 1; j < found.size(); ++j) EXPECT_LE(found[j - 1].to, found[j].from);
    for (int i = 0; i <= places; ++i) {
      const double u = static_cast<double>(i) / places, gap = g.value(u);
      if (std::abs(gap) < 1e-12) continue;
      const bool inside =
          std::any_of(found.begin(), found.end(), [u](const ClosedStretch& s) { return u >= s.from && u <= s.to; });
      ASSERT_EQ(inside, gap < 0.0) << "case " << k << ", u " << u << ", gap " << gap;
    }
  }
  EXPECT_GT(closed, 1000);
  EXPECT_GT(several, 300);
}

// A step that has run away: no minimum is found, and the search ends.
TEST(ClosedStretches, WhatIsNoNumberEndsTheSearch) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN(), endless = std::numeric_limits<double>::infinity();
  for (const double value : {none, endless, -endless}) {
    for (const double way : {length, none, endless}) {
      if (std::isfinite(value + way)) continue;
      const auto gap = [value](double u) { return GapPlace{u, value, value, value}; };
      std::vector<ClosedStretch> found;
      std::vector<GapPlace> minima;
      ClosedStretches(length, way, value, resolution).find(gap, gap(0.0), gap(1.0), found, minima);
      EXPECT_TRUE(minima.empty());
    }
  }
}

// Dips side by side with a maximum between them, here above zero, that passes the beginning of the element: what is closed there
// goes on from state to state though the slope at the beginning changes its sign.
TEST(ClosedStretches, NoStepWhereAMaximumPassesAVertex) {
  constexpr double wave = 0.06, height = 2e-7, rise = 1e-4;
  constexpr double rate = 2.0 * std::numbers::pi / wave;
  double before = 0.0;
  for (int k = -200; k <= 200; ++k) {
    const double top = 1e-5 * k;
    const auto gap = [top](double u) {
      const double x = u - top;
      return GapPlace{u, height * std::cos(rate * x) + rise * x * x,
                      (-height * rate * std::sin(rate * x) + 2.0 * rise * x) / length, 0.0};
    };
    std::vector<ClosedStretch> found;
    std::vector<GapPlace> minima;
    const double bend = (height * rate * rate + 2.0 * rise) / (length * length);
    ClosedStretches(length, length, bend, resolution).find(gap, gap(0.0), gap(1.0), found, minima);
    ASSERT_EQ(found.size(), 1U) << "maximum at " << top;
    EXPECT_LT(found[0].deepest.gap, -1e-8);
    const double now = found[0].to - found[0].from;
    if (k > -200) {
      EXPECT_NEAR(now, before, 1e-6) << "maximum at " << top;
    }
    before = now;
  }
}
