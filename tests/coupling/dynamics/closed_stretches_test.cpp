#include "coupling/dynamics/contact/contact_intervals.hpp"

#include "coupling/dynamics/contact/contact_integral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace snare;
using coupling::ContactInterval;
using coupling::ContactIntervals;
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
  [[nodiscard]] std::vector<ContactInterval> stretches() const {
    const auto gap = [this](double u) { return GapPlace{u, value(u), slope(u), 0.0}; };
    std::vector<ContactInterval> found;
    std::vector<GapPlace> minima;
    ContactIntervals(length, 2.0 * length, largest_bend(), resolution)
        .find(gap, gap(0.0), gap(1.0), found, minima);
    return found;
  }
};

}  // namespace

// What is closed is what a look at very many places shows: every stretch, however it lies to the ends of the
// pieces.
TEST(ContactIntervals, NothingIsHiddenAndNothingOpenIsTaken) {
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
    const std::vector<ContactInterval> found = g.stretches();
    closed += found.empty() ? 0 : 1;
    several += found.size() > 1 ? 1 : 0;
    for (std::size_t j = 1; j < found.size(); ++j) EXPECT_LE(found[j - 1].to, found[j].from);
    for (int i = 0; i <= places; ++i) {
      const double u = static_cast<double>(i) / places, gap = g.value(u);
      if (std::abs(gap) < 1e-12) continue;
      const bool inside = std::any_of(found.begin(), found.end(),
                                      [u](const ContactInterval& s) { return u >= s.from && u <= s.to; });
      ASSERT_EQ(inside, gap < 0.0) << "case " << k << ", u " << u << ", gap " << gap;
    }
  }
  EXPECT_GT(closed, 1000);
  EXPECT_GT(several, 300);
}

// A step that has run away: no minimum is found, and the search ends.
TEST(ContactIntervals, WhatIsNoNumberEndsTheSearch) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN(),
                   endless = std::numeric_limits<double>::infinity();
  for (const double value : {none, endless, -endless}) {
    for (const double way : {length, none, endless}) {
      if (std::isfinite(value + way)) continue;
      const auto gap = [value](double u) { return GapPlace{u, value, value, value}; };
      std::vector<ContactInterval> found;
      std::vector<GapPlace> minima;
      ContactIntervals(length, way, value, resolution).find(gap, gap(0.0), gap(1.0), found, minima);
      EXPECT_TRUE(minima.empty());
    }
  }
}

// Dips side by side with a maximum between them, here above zero, that passes the beginning of the element:
// what is closed there continues from state to state though the slope at the beginning changes its sign.
TEST(ContactIntervals, NoStepWhereAMaximumPassesAVertex) {
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
    std::vector<ContactInterval> found;
    std::vector<GapPlace> minima;
    const double bend = (height * rate * rate + 2.0 * rise) / (length * length);
    ContactIntervals(length, length, bend, resolution).find(gap, gap(0.0), gap(1.0), found, minima);
    ASSERT_EQ(found.size(), 1U) << "maximum at " << top;
    EXPECT_LT(found[0].deepest.gap, -1e-8);
    const double now = found[0].to - found[0].from;
    if (k > -200) {
      EXPECT_NEAR(now, before, 1e-6) << "maximum at " << top;
    }
    before = now;
  }
}

namespace {

/// g = h (cos^2(pi x/2) + tilt x - level), x from -1.5 to 1.5 along the element: lobes at -1 and 1 with a
/// crest between them.
struct TwoLobes {
  double tilt = 0.0, level = 0.0;  // of h
  static constexpr double height = 1e-6, ends = 1.5;

  [[nodiscard]] GapPlace at(double u) const {
    const double x = ends * (2.0 * u - 1.0), pi = std::numbers::pi, wave = std::cos(0.5 * pi * x);
    return {u, height * (wave * wave + tilt * x - level),
            height * (tilt - 0.5 * pi * std::sin(pi * x)) * 2.0 * ends / length, 0.0};
  }
  /// Loads of a foundation, in all and about the middle: by the parts, and by very many places.
  [[nodiscard]] std::array<double, 2> by_parts() const {
    std::vector<ContactInterval> found;
    std::vector<GapPlace> minima;
    const double bend = height * std::pow(std::numbers::pi * 2.0 * ends / length, 2) / 2.0;
    ContactIntervals(length, 2.0 * length, bend, resolution)
        .find([this](double u) { return at(u); }, at(0.0), at(1.0), found, minima);
    std::array<double, 2> loads{};
    for (const ContactInterval& s : found) {
      coupling::for_each_place(s, [&](double u, double weight) {
        const double load = -at(u).gap / height * weight;
        loads[0] += load;
        loads[1] += load * (u - 0.5);
      });
    }
    return loads;
  }
  [[nodiscard]] std::array<double, 2> by_places() const {
    constexpr int places = 20000;
    std::array<double, 2> loads{};
    for (int k = 0; k < places; ++k) {
      const double u = (k + 0.5) / places, load = std::max(0.0, -at(u).gap / height) / places;
      loads[0] += load;
      loads[1] += load * (u - 0.5);
    }
    return loads;
  }
};

}  // namespace

// A stretch parts where its crest comes out, and a crest rises from what was one lobe: no load jumps, and
// loads stay right.
TEST(ContactIntervals, LoadsDoNotJumpWhereAStretchPartsOrACrestRises) {
  constexpr double step = 1e-4;
  const auto follow = [&](TwoLobes lobes, double TwoLobes::*what, double to) {
    const int steps = static_cast<int>(std::lround(std::abs(to - lobes.*what) / step));
    const double way = (to - lobes.*what) / steps;
    std::array<double, 2> before = lobes.by_parts();
    for (int k = 0; k < steps; ++k) {
      lobes.*what += way;
      const std::array<double, 2> now = lobes.by_parts();
      for (const std::size_t i : {0U, 1U})
        ASSERT_NEAR(now[i], before[i], 3.0 * step) << "tilt " << lobes.tilt << ", level " << lobes.level;
      before = now;
      if (k % 500 != 0) continue;
      const std::array<double, 2> right = lobes.by_places();
      for (const std::size_t i : {0U, 1U})
        EXPECT_NEAR(now[i], right[i], 0.05 * right[0]) << "tilt " << lobes.tilt << ", level " << lobes.level;
    }
  };
  for (const double tilt : {0.0, 0.1, -0.4, 0.8}) follow({tilt, 0.5}, &TwoLobes::level, 2.5);
  for (const double level : {0.9, 1.2, 2.0})
    follow({-2.0, level}, &TwoLobes::tilt, 2.0);  // one lobe beyond pi/2
}
