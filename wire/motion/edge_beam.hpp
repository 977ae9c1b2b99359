#pragma once

#include "wire/curvature.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace snare::wire {

/// An edge of the rod of higher order: a beam between two vertices, whose curvatures EI k at its ends and
/// whose tension bend it off its chord.                                                      theory.md (W.32)
struct EdgeBeamConstants {
  double rest = 0.0;                                            ///< unstretched length h [m], > 0
  double axial_stiffness = 0.0;                                 ///< EA [N], > 0
  Eigen::Vector2d bending_stiffness = Eigen::Vector2d::Zero();  ///< EI_1, EI_2 [N m^2], > 0
};

/// Its energy as a function of the chord l and of the curvatures k_a, k_b (of kappa_1, kappa_2) at its ends,
/// and the derivatives by (l, k_a1, k_a2, k_b1, k_b2).
///
///   E = stat_N [ N (l - h) - N^2 h/(2 EA)
///       - h/4 sum_j EI_j (C(z_j) (k_a + k_b)_j^2 + D(z_j) (k_a - k_b)_j^2) ]
///   z_j = N (1 + N/EA) h^2/EI_j,   C = tanh(w)/(2 w),   D = (w coth w - 1)/(2 w^2),   w = sqrt(z)/2
///
/// The vertices' terms EI k phi make it the energy of the rod, stationary in k.
struct EdgeBeam {
  static constexpr int chord = 0, near = 1, far = 3, count = 5;
  double energy = 0.0;   ///< [J]
  double tension = 0.0;  ///< N [N]
  Eigen::Matrix<double, count, 1> gradient;
  Eigen::Matrix<double, count, count> hessian;
};
/// chord: l [m], > 0; near, far: k_a, k_b [1/m].
[[nodiscard]] EdgeBeam edge_beam(const EdgeBeamConstants& constants, double chord,
                                 const Eigen::Vector2d& near, const Eigen::Vector2d& far);

/// A flexibility of a beam under tension and its derivatives by z.
template <class S>
struct FlexibilityOf {
  S value, first, second;  ///< C or D and its derivatives by z [-]
};
using Flexibility = FlexibilityOf<double>;
/// C of a beam whose ends turn alike, D of one whose ends turn against each other.           theory.md (W.32)
/// For z < -4, a compression of 4/pi^2 of the load that buckles the edge itself, their parabolas at -4.
template <class S>
struct FlexibilitiesOf {
  FlexibilityOf<S> alike, against;
};
using Flexibilities = FlexibilitiesOf<double>;
/// z [-], as above.
template <class S>
[[nodiscard]] FlexibilitiesOf<S> flexibilities_at(const S& z);
[[nodiscard]] Flexibilities flexibilities(double z);

/// An edge whose tension is in balance with its chord and its bow.
template <class S>
struct BalancedBeam {
  S tension;                             ///< N [N]
  S energy;                              ///< E [J]
  Pair<S> near, far;                     ///< dE/dk_a, dE/dk_b [N m^2]
  std::array<FlexibilitiesOf<S>, 2> of;  ///< of the two directions
  S lever;                               ///< dP/dN of P = N (1 + N/EA), z = P h^2/EI [-]
  S softness;                            ///< -d2E/dN2 [m/N]
};
/// rest, chord: h, l [m]; near, far: k_a, k_b [1/m].
template <class S>
[[nodiscard]] BalancedBeam<S> balanced_beam(const S& rest, const S& chord, const Pair<S>& near,
                                            const Pair<S>& far, double axial_stiffness,
                                            const Pair<double>& bending_stiffness);

/// Second derivatives of its energy by the chord and the curvatures at its ends; blocks of the latter by
/// rows.
template <class S>
struct BeamStiffness {
  S chord;                           ///< [N/m]
  Pair<S> chord_near, chord_far;     ///< [N m]
  std::array<Pair<S>, 2> near;       ///< of k_a [N m^3]
  std::array<Pair<S>, 2> next, far;  ///< of k_a by k_b, of k_b
};
template <class S>
[[nodiscard]] BeamStiffness<S> beam_stiffness(const BalancedBeam<S>& beam, const S& rest, const Pair<S>& near,
                                              const Pair<S>& far, const Pair<double>& bending_stiffness);

// Here, for the compiler to put in where wires in motion spend their time.

namespace beam {

// Functions of x = w^2 = z/4.
inline constexpr double least = -1.0;    // below it the parabola
inline constexpr double fraction = 2.0;  // below it a ratio of polynomials

/// sum c_n x^n and its derivatives by x.
template <class S, std::size_t terms>
[[nodiscard, gnu::always_inline]] inline FlexibilityOf<S> polynomial(const std::array<double, terms>& c,
                                                                     const S& x) {
  FlexibilityOf<S> f{0.0, 0.0, 0.0};
  for (std::size_t n = terms; n-- > 0;) {
    f.second = f.second * x + 2.0 * f.first;
    f.first = f.first * x + f.value;
    f.value = f.value * x + c[n];
  }
  return f;
}

/// f/g and its derivatives.
template <class S>
[[nodiscard, gnu::always_inline]] inline FlexibilityOf<S> ratio(const FlexibilityOf<S>& f,
                                                                const FlexibilityOf<S>& g) {
  const S inverse = 1.0 / g.value;
  const S value = f.value * inverse;
  const S first = (f.first - value * g.first) * inverse;
  return {value, first, (f.second - 2.0 * first * g.first - value * g.second) * inverse};
}

/// y = 1/(1 + x g) and its derivatives.
template <class S>
[[nodiscard, gnu::always_inline]] inline FlexibilityOf<S> alike_of(const FlexibilityOf<S>& g, const S& x) {
  const S y = 1.0 / (1.0 + x * g.value);
  const S slope = g.value + x * g.first;
  const S first = -y * y * slope;
  return {y, first, -2.0 * y * first * slope - y * y * (2.0 * g.first + x * g.second)};
}

/// Half of a function of x = z/4 by z, d/dz = 1/4 d/dx.
template <class S>
[[nodiscard, gnu::always_inline]] inline FlexibilityOf<S> by_z(const FlexibilityOf<S>& f) {
  return {0.5 * f.value, 0.125 * f.first, 0.03125 * f.second};
}

/// At z + dz, to second order.
template <class S>
[[gnu::always_inline]] inline void advance(FlexibilityOf<S>& f, const S& dz) {
  f.value += dz * (f.first + 0.5 * dz * f.second);
  f.first += dz * f.second;
}

// C = y/2 with y = tanh(w)/w, D = g/2 with g = (w coth w - 1)/w^2. By y = 1/(1 + x g) and g = 1/(3 + x/(5 +
// x/(7 + ...))), of which nine denominators leave 1e-16 and 2e-13 of the second derivative; and by 2 x y' = 1
// - y - x y^2 and g = (1/y - 1)/x with their derivatives.
template <class S>
[[nodiscard, gnu::always_inline]] inline FlexibilitiesOf<S> of_small(const S& x) {
  constexpr std::array over{218243025.0, 16081065.0, 289575.0, 1430.0, 1.0};
  constexpr std::array under{654729075.0, 91891800.0, 2837835.0, 25740.0, 55.0};
  const FlexibilityOf<S> g = ratio(polynomial(over, x), polynomial(under, x));
  return {by_z(alike_of(g, x)), by_z(g)};
}
template <class S>
[[nodiscard, gnu::always_inline]] inline FlexibilitiesOf<S> of_large(const S& x) {
  const S w = numerics::sqrt(x);
  const S half = 0.5 / x;
  const S y = numerics::each(w, [](double a) { return std::tanh(a); }) / w;
  const S y1 = (1.0 - y - x * y * y) * half;
  const S y2 = (-3.0 * y1 - y * y - 2.0 * x * y * y1) * half;
  const S inverse = 1.0 / y;
  const S g = 2.0 * half * (inverse - 1.0);
  const S g1 = -2.0 * half * (y1 * inverse * inverse + g);
  const S g2 = 2.0 * half * (2.0 * y1 * y1 * inverse * inverse * inverse - y2 * inverse * inverse - 2.0 * g1);
  return {by_z<S>({y, y1, y2}), by_z<S>({g, g1, g2})};
}

}  // namespace beam

template <class S>
[[nodiscard, gnu::always_inline]] inline FlexibilitiesOf<S> flexibilities_at(const S& z) {
  const S x = 0.25 * z;
  if (numerics::none_below(x, beam::least) && numerics::all_below(x, beam::fraction))
    return beam::of_small(x);
  if (numerics::none_below(x, beam::fraction)) return beam::of_large(x);
  if constexpr (std::is_same_v<S, double>) {  // under too much compression
    FlexibilitiesOf<S> f = beam::of_small(beam::least);
    beam::advance(f.alike, z - 4.0 * beam::least);
    beam::advance(f.against, z - 4.0 * beam::least);
    return f;
  } else {
    FlexibilitiesOf<S> f;
    for (int k = 0; k < S::count; ++k) {
      const Flexibilities one = flexibilities(z[k]);
      const auto set = [k](FlexibilityOf<S>& all, const Flexibility& g) {
        all.value.v[k] = g.value;
        all.first.v[k] = g.first;
        all.second.v[k] = g.second;
      };
      set(f.alike, one.alike);
      set(f.against, one.against);
    }
    return f;
  }
}

// l - h = N h/EA + dW/dN with W(P) = h/4 sum EI (C s^2 + D d^2), s and d sum and difference of k_a and k_b:
// its right side rises with N and is concave but for the square of the strain, so that Newton's method
// converges.
template <class S>
[[nodiscard, gnu::always_inline]] inline BalancedBeam<S> balanced_beam(const S& rest, const S& chord,
                                                                       const Pair<S>& near,
                                                                       const Pair<S>& far,
                                                                       double axial_stiffness,
                                                                       const Pair<double>& ei) {
  const bool round = ei[0] == ei[1];
  const double flexibility = 1.0 / axial_stiffness;
  const Pair<S> sum{near[0] + far[0], near[1] + far[1]};
  const Pair<S> difference{near[0] - far[0], near[1] - far[1]};
  const Pair<S> s2{sum[0] * sum[0], sum[1] * sum[1]};
  const Pair<S> d2{difference[0] * difference[0], difference[1] * difference[1]};
  const S square = rest * rest;
  const S cube = square * rest;
  const S compliance = flexibility * rest;
  const auto load = [&](const S& tension) __attribute__((always_inline)) {  // P h^2
    return tension * (1.0 + flexibility * tension) * square;
  };
  BalancedBeam<S> b;
  b.tension = (chord - rest + cube * ((s2[0] + s2[1]) / 96.0 + (d2[0] + d2[1]) / 1440.0)) /
              compliance;  // of C, D at 0
  constexpr int most = 50;
  for (int k = 0; k < most; ++k) {
    const S before = load(b.tension);
    b.of[0] = flexibilities_at<S>(before / ei[0]);
    b.of[1] = round ? b.of[0] : flexibilities_at<S>(before / ei[1]);
    b.lever = 1.0 + 2.0 * flexibility * b.tension;
    S bow = 0.0, twice = 0.0;  // 4/h^3 dW/dP and, over h^2, its derivative
    for (std::size_t j = 0; j < 2; ++j) {
      const auto& [C, D] = b.of[j];
      bow += C.first * s2[j] + D.first * d2[j];
      twice += (C.second * s2[j] + D.second * d2[j]) / ei[j];
    }
    bow *= 0.25 * cube;
    b.softness = compliance + b.lever * b.lever * (0.25 * cube * square) * twice + 2.0 * flexibility * bow;
    const S change = (chord - rest - b.tension * compliance - bow * b.lever) / b.softness;
    b.tension += change;
    // The next change would be of the order of the square of this one.
    constexpr double small = 1e-6;
    const S moved = load(b.tension) - before;
    const double least_stiffness = std::min(ei[0], ei[1]);
    const bool settled = numerics::all_below(numerics::abs(moved), small * least_stiffness) ||
                         numerics::all_below(numerics::abs(change), 1e-15 * axial_stiffness);
    if (!settled && k + 1 < most) continue;
    b.lever = 1.0 + 2.0 * flexibility * b.tension;
    for (std::size_t j = 0; j < 2; ++j) {
      beam::advance<S>(b.of[j].alike, moved / ei[j]);
      beam::advance<S>(b.of[j].against, moved / ei[j]);
    }
    break;
  }
  b.energy = b.tension * (chord - rest) - 0.5 * b.tension * b.tension * compliance;
  for (std::size_t j = 0; j < 2; ++j) {
    const auto& [C, D] = b.of[j];
    const S half = (-0.5 * ei[j]) * rest;
    b.energy += 0.5 * half * (C.value * s2[j] + D.value * d2[j]);
    b.near[j] = half * (C.value * sum[j] + D.value * difference[j]);
    b.far[j] = half * (C.value * sum[j] - D.value * difference[j]);
  }
  return b;
}

// N eliminated: H - H_N H_N^T/H_NN with H_NN = -softness, of which H has no part by the chord.
template <class S>
[[nodiscard, gnu::always_inline]] inline BeamStiffness<S> beam_stiffness(const BalancedBeam<S>& beam,
                                                                         const S& rest, const Pair<S>& near,
                                                                         const Pair<S>& far,
                                                                         const Pair<double>& ei) {
  const S inverse = 1.0 / beam.softness;
  const S factor = -0.5 * rest * rest * rest * beam.lever;
  BeamStiffness<S> h;
  h.chord = inverse;
  Pair<S> by_near, by_far;  // d2E/dN dk
  for (std::size_t j = 0; j < 2; ++j) {
    const auto& [C, D] = beam.of[j];
    const S sum = C.first * (near[j] + far[j]);
    const S difference = D.first * (near[j] - far[j]);
    by_near[j] = factor * (sum + difference);
    by_far[j] = factor * (sum - difference);
    h.chord_near[j] = by_near[j] * inverse;
    h.chord_far[j] = by_far[j] * inverse;
  }
  for (std::size_t j = 0; j < 2; ++j) {
    for (std::size_t k = 0; k < 2; ++k) {
      h.near[j][k] = by_near[j] * h.chord_near[k];
      h.next[j][k] = by_near[j] * h.chord_far[k];
      h.far[j][k] = by_far[j] * h.chord_far[k];
    }
    const auto& [C, D] = beam.of[j];
    const S half = (-0.5 * ei[j]) * rest;
    h.near[j][j] += half * (C.value + D.value);
    h.far[j][j] += half * (C.value + D.value);
    h.next[j][j] += half * (C.value - D.value);
  }
  return h;
}

}  // namespace snare::wire
