#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace snare::coupling {

/// A place on an element: u from 0 to 1, the gap there [m], its derivative by the material coordinate [-],
/// and by how much the surface itself bends it down, max(0, -X'.H X') [1/m].
struct GapPlace {
  double u = 0.0;
  double gap = 0.0;
  double slope = 0.0;
  double curvature_bound = 0.0;
};

/// A maximum of the gap within what is closed.
struct GapMaximum {
  double u = 0.0;       ///< from 0 to 1 [-]
  double gap = 0.0;     ///< [m], < 0
  double before = 0.0;  ///< the least gap between it and the crest or the end before it [m]
};

/// A stretch of an element on which the gap is negative, and its deepest place.
struct ContactInterval {
  double from = 0.0, to = 0.0;  ///< u, from 0 to 1 [-]
  GapPlace deepest;
  std::vector<GapMaximum> crests;  ///< in their order
  double behind = 0.0;             ///< the least gap behind the last of them [m]
};

/// Where the gap along an element is negative.                                                theory.md (G.7)
///
/// Between two places the gap cannot fall by more than the way there and back, so that far parts are left
/// out; what is left is halved until its second derivative bounds it to one sign. gap: u -> GapPlace, once
/// differentiable.
class ContactIntervals {
 public:
  /// length: of the element [m]; way: a bound of the length of its curve [m]; bend: of |X''| [1/m];
  /// resolution: on a shorter way zeros and minima are looked for [m].
  ContactIntervals(double length, double way, double bend, double resolution)
      : length_(length), way_(way), bend_(bend), resolution_(resolution) {}

  /// Appends the stretches in their order, and the local minima with negative gap.
  template <class Gap>
  void find(const Gap& gap, const GapPlace& begin, const GapPlace& end,
            std::vector<ContactInterval>& stretches, std::vector<GapPlace>& minima) const {
    if (std::isfinite(way_)) divide(gap, begin, end, {stretches, minima});
  }

 private:
  // Shares of the resolution: dips that are no deeper are left out, pieces that are no longer are not halved,
  // nor looked into for crests.
  static constexpr double least_dip = 1e-10, least_way = 1e-6, least_wave = 1.0 / 16.0;

  struct ContactCache {
    std::vector<ContactInterval>& stretches;
    std::vector<GapPlace>& minima;
  };

  template <class Gap>
  void divide(const Gap& gap, const GapPlace& a, const GapPlace& b, const ContactCache& found) const {
    const double way = way_ * (b.u - a.u);
    if (!(a.gap + b.gap < way)) return;  // nor is there anything to find where one of them is no number
    if (way <= resolution_) {
      if (lowest(a, b) >= -least_dip * resolution_) return;
      const bool shortest = way <= least_way * resolution_;
      const bool closed = shortest ? a.gap + b.gap < 0.0 : a.gap <= 0.0 && b.gap <= 0.0 && is_closed(a, b);
      if (closed) add(gap, a, b, found);
      if (closed || shortest) return;
      if (a.slope < 0.0 && b.slope > 0.0) {
        GapPlace bottom = turn(gap, a, b);
        bottom.slope = 0.0;
        divide(gap, a, bottom, found);
        divide(gap, bottom, b, found);
        return;
      }
      if (a.gap * b.gap < 0.0) {
        GapPlace edge = gap(a.gap < 0.0 ? zero(gap, a, b) : zero(gap, b, a));
        edge.gap = 0.0;
        divide(gap, a, edge, found);
        divide(gap, edge, b, found);
        return;
      }
    }
    const GapPlace middle = gap(0.5 * (a.u + b.u));
    divide(gap, a, middle, found);
    divide(gap, middle, b, found);
  }

  /// g'' >= -this on a piece [1/m].
  [[nodiscard]] double fall(const GapPlace& a, const GapPlace& b) const {
    return bend_ + 2.0 * std::max(a.curvature_bound, b.curvature_bound);
  }

  /// No gap between two places is below this [m]: of g_a + g_a' s - B s^2/2 and the same from b the larger
  /// one holds, and its least is at an end or where the two meet.
  [[nodiscard]] double lowest(const GapPlace& a, const GapPlace& b) const {
    const double w = length_ * (b.u - a.u), bend = fall(a, b);
    const double least = std::min(a.gap, b.gap);
    const double turn = b.slope - a.slope + bend * w;  // of their difference, which is linear in s
    if (turn <= 0.0) return least;
    const double s = std::clamp((a.gap - b.gap + b.slope * w + 0.5 * bend * w * w) / turn, 0.0, w);
    return std::min(least, a.gap + s * (a.slope - 0.5 * bend * s));
  }

  /// Whether the chord between two places with g <= 0, and the arch B s (w - s)/2 over it, are below zero.
  [[nodiscard]] bool is_closed(const GapPlace& a, const GapPlace& b) const {
    const double w = length_ * (b.u - a.u), bend = fall(a, b);
    if (bend * w == 0.0) return true;
    const double s = std::clamp(0.5 * w + (b.gap - a.gap) / (bend * w), 0.0, w);
    return a.gap + (b.gap - a.gap) * s / w + 0.5 * bend * s * (w - s) <= 0.0;
  }

  /// Whether a crest and a hollow may lie between two places where the gap goes the same way: the cubic with
  /// these ends does not go that way throughout.
  [[nodiscard]] bool waves(const GapPlace& a, const GapPlace& b) const {
    if (!(a.slope * b.slope > 0.0) || way_ * (b.u - a.u) <= least_wave * resolution_) return false;
    const double chord = (b.gap - a.gap) / (length_ * (b.u - a.u));
    return chord * a.slope <= 0.0 || std::hypot(a.slope, b.slope) > 3.0 * std::abs(chord);
  }

  /// A closed piece, which continues with the stretch before it or begins another.
  template <class Gap>
  void add(const Gap& gap, const GapPlace& a, const GapPlace& b, const ContactCache& found) const {
    if (waves(a, b)) {
      const GapPlace middle = gap(0.5 * (a.u + b.u));
      add(gap, a, middle, found);
      add(gap, middle, b, found);
      return;
    }
    GapPlace deepest = a.gap <= b.gap ? a : b;
    if (a.slope < 0.0 && b.slope >= 0.0) {
      deepest = b.slope == 0.0 ? b : turn(gap, a, b);
      if (deepest.gap < 0.0) found.minima.push_back(deepest);
    }
    if (found.stretches.empty() || found.stretches.back().to != a.u)
      found.stretches.push_back({a.u, a.u, a, {}, a.gap});
    ContactInterval& s = found.stretches.back();
    s.to = b.u;
    if (deepest.gap < s.deepest.gap) s.deepest = deepest;
    if (a.slope > 0.0 && b.slope <= 0.0) {
      const GapPlace crest = b.slope == 0.0 ? b : turn(gap, a, b);
      s.crests.push_back({crest.u, crest.gap, std::min(s.behind, a.gap)});
      s.behind = b.gap;
    }
    s.behind = std::min(s.behind, deepest.gap);
  }

  /// The minimum between a falling and a rising gap, or the maximum between a rising and a falling one: the
  /// zero of the slope (Illinois). Its place need not be sharp, since the gap is level there.
  template <class Gap>
  GapPlace turn(const Gap& gap, GapPlace low, GapPlace high) const {
    constexpr double level = 1e-9;
    const double sign = low.slope < high.slope ? 1.0 : -1.0;
    GapPlace best = sign * low.gap < sign * high.gap ? low : high;
    double f_low = sign * low.slope, f_high = sign * high.slope;
    for (int k = 0; k < 40 && high.u - low.u > 1e-12 && f_high > f_low; ++k) {
      const GapPlace p = gap(std::clamp((low.u * f_high - high.u * f_low) / (f_high - f_low), low.u, high.u));
      if (sign * p.gap < sign * best.gap || std::abs(p.slope) < level) best = p;
      if (std::abs(p.slope) < level) break;
      if (sign * p.slope < 0.0) {
        low = p;
        f_low = sign * p.slope;
        f_high *= 0.5;
      } else {
        high = p;
        f_high = sign * p.slope;
        f_low *= 0.5;
      }
    }
    return best;
  }

  /// Between a place inside and one outside: the zero of the gap. First guess by the parabola through both,
  /// then Newton's method held between the last places on either side.
  template <class Gap>
  double zero(const Gap& gap, const GapPlace& inside, const GapPlace& outside) const {
    double in = inside.u, out = outside.u;
    const double s = (outside.u - inside.u) * length_;  // signed way
    const double curvature = 2.0 * (outside.gap - inside.gap - inside.slope * s) / (s * s);
    const double rise = std::copysign(1.0, s) * inside.slope;
    const double root = std::sqrt(std::max(0.0, rise * rise - 2.0 * curvature * inside.gap));
    const double first = rise + root > 0.0 ? -2.0 * inside.gap / (rise + root) : std::abs(s);
    const double least = std::min(in, out), most = std::max(in, out);
    double u = std::clamp(in + std::copysign(std::min(first, std::abs(s)), s) / length_, least, most);
    for (int k = 0; k < 40; ++k) {
      const GapPlace p = gap(u);
      (p.gap < 0.0 ? in : out) = u;
      double next = p.slope != 0.0 ? u - p.gap / (p.slope * length_) : 0.5 * (in + out);
      if (!(next > std::min(in, out) && next < std::max(in, out))) next = 0.5 * (in + out);
      const double change = std::abs(next - u);
      u = next;
      if (change <= 1e-7 * std::abs(u - inside.u) + 1e-14) break;
    }
    return u;
  }

  double length_, way_, bend_, resolution_;
};

}  // namespace snare::coupling
