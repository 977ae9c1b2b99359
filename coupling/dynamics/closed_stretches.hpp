#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace snare::coupling {

/// A place on an element: u from 0 to 1, the gap there [m] and its derivative by the material coordinate [-].
struct GapPlace {
  double u = 0.0;
  double gap = 0.0;
  double slope = 0.0;
};

/// A stretch of an element on which the gap is negative, and its deepest place.
struct ClosedStretch {
  double from = 0.0, to = 0.0;  ///< u, from 0 to 1 [-]
  GapPlace deepest;
};

/// Where the gap along an element is negative.                                                theory.md (G.7)
///
/// Between two places the gap cannot fall by more than the way there and back, so that far parts are left out; what is left
/// is halved until no minimum can hide in it. gap: u -> GapPlace.
class ClosedStretches {
 public:
  /// length: of the element [m]; way: a bound of the length of its curve [m]; resolution: on a shorter way the gap has one
  /// minimum at most [m].
  ClosedStretches(double length, double way, double resolution) : length_(length), way_(way), resolution_(resolution) {}

  /// Appends the stretches in their order, and the local minima with negative gap.
  template <class Gap>
  void find(const Gap& gap, const GapPlace& begin, const GapPlace& end, std::vector<ClosedStretch>& stretches,
            std::vector<GapPlace>& minima) const {
    divide(gap, begin, end, stretches, minima);
  }

 private:
  template <class Gap>
  void divide(const Gap& gap, const GapPlace& a, const GapPlace& b, std::vector<ClosedStretch>& stretches,
              std::vector<GapPlace>& minima) const {
    const double way = way_ * (b.u - a.u);
    if (a.gap + b.gap >= way) return;
    if (way > resolution_) {
      const GapPlace middle = gap(0.5 * (a.u + b.u));
      divide(gap, a, middle, stretches, minima);
      divide(gap, middle, b, stretches, minima);
      return;
    }
    GapPlace deepest = a.gap <= b.gap ? a : b;
    if (a.slope < 0.0 && b.slope >= 0.0) {
      deepest = minimum(gap, a, b);
      if (deepest.gap < 0.0) minima.push_back(deepest);
    }
    if (deepest.gap >= 0.0) return;
    const double from = a.gap < 0.0 ? a.u : zero(gap, deepest, a);
    const double to = b.gap < 0.0 ? b.u : zero(gap, deepest, b);
    if (!stretches.empty() && a.gap < 0.0 && stretches.back().to == from) {
      stretches.back().to = to;
      if (deepest.gap < stretches.back().deepest.gap) stretches.back().deepest = deepest;
    } else {
      stretches.push_back({from, to, deepest});
    }
  }

  /// Between a falling and a rising gap: the zero of the slope (Illinois). Its place need not be sharp, since the gap is level
  /// there.
  template <class Gap>
  GapPlace minimum(const Gap& gap, GapPlace low, GapPlace high) const {
    constexpr double level = 1e-9;
    GapPlace best = low.gap < high.gap ? low : high;
    double f_low = low.slope, f_high = high.slope;
    for (int k = 0; k < 40 && high.u - low.u > 1e-12 && f_high > f_low; ++k) {
      const GapPlace p = gap((low.u * f_high - high.u * f_low) / (f_high - f_low));
      if (p.gap < best.gap || std::abs(p.slope) < level) best = p;
      if (std::abs(p.slope) < level) break;
      if (p.slope < 0.0) {
        low = p;
        f_low = p.slope;
        f_high *= 0.5;
      } else {
        high = p;
        f_high = p.slope;
        f_low *= 0.5;
      }
    }
    return best;
  }

  /// Between a place inside and one outside: the zero of the gap. First guess by the parabola through both, then Newton's method
  /// held between the last places on either side.
  template <class Gap>
  double zero(const Gap& gap, const GapPlace& inside, const GapPlace& outside) const {
    double in = inside.u, out = outside.u;
    const double s = (outside.u - inside.u) * length_;  // signed way
    const double curvature = 2.0 * (outside.gap - inside.gap - inside.slope * s) / (s * s);
    const double rise = std::copysign(1.0, s) * inside.slope;
    const double root = std::sqrt(std::max(0.0, rise * rise - 2.0 * curvature * inside.gap));
    const double first = rise + root > 0.0 ? -2.0 * inside.gap / (rise + root) : std::abs(s);
    double u = in + std::copysign(std::min(first, std::abs(s)), s) / length_;
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

  double length_, way_, resolution_;
};

}  // namespace snare::coupling
