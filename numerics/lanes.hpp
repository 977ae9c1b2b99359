#pragma once

#include <Eigen/Core>

#include <emmintrin.h>
#include <array>
#include <cmath>

namespace snare::numerics {

/// Four numbers that are worked on at once, and vectors of three of them: formulas written for a number type
/// S and vectors Vector3<S> hold for one place (S = double) and for four (S = Lanes). Every operation rounds
/// as that of a single number does, whatever the processor has: two by two, or four at once in functions
/// compiled for that, into which all of this is put.
struct Lanes {
  using Four [[gnu::vector_size(32)]] = double;
  static constexpr int count = 4;
  Four v{};

  [[gnu::always_inline]] Lanes() = default;
  [[gnu::always_inline]] Lanes(double s)
      : v{s, s, s, s} {}  // NOLINT(google-explicit-constructor): a constant
  [[gnu::always_inline]] Lanes(double a, double b, double c, double d) : v{a, b, c, d} {}
  /// Four numbers behind each other.
  [[gnu::always_inline]] static Lanes at(const double* p) { return {p[0], p[1], p[2], p[3]}; }
  [[gnu::always_inline]] void store(double* p) const {
    using Unaligned [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
    *reinterpret_cast<Unaligned*>(p) = v;
  }
  [[gnu::always_inline]] void add_to(double* p) const { (at(p) + *this).store(p); }
  [[nodiscard, gnu::always_inline]] double operator[](int k) const { return v[k]; }
  [[nodiscard, gnu::always_inline]] double sum() const { return (v[0] + v[1]) + (v[2] + v[3]); }

  [[gnu::always_inline]] friend Lanes operator+(const Lanes& a, const Lanes& b) { return made(a.v + b.v); }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes& a, const Lanes& b) { return made(a.v - b.v); }
  [[gnu::always_inline]] friend Lanes operator*(const Lanes& a, const Lanes& b) { return made(a.v * b.v); }
  [[gnu::always_inline]] friend Lanes operator/(const Lanes& a, const Lanes& b) { return made(a.v / b.v); }
  [[gnu::always_inline]] Lanes operator-() const { return made(-v); }
  [[gnu::always_inline]] Lanes& operator+=(const Lanes& o) { return *this = *this + o; }
  [[gnu::always_inline]] Lanes& operator-=(const Lanes& o) { return *this = *this - o; }
  [[gnu::always_inline]] Lanes& operator*=(const Lanes& o) { return *this = *this * o; }

 private:
  [[gnu::always_inline]] static Lanes made(const Four& f) {
    Lanes l;
    l.v = f;
    return l;
  }
};

/// The same function of every number.
template <class Function>
[[nodiscard, gnu::always_inline]] inline Lanes each(const Lanes& x, const Function& of) {
  return {of(x[0]), of(x[1]), of(x[2]), of(x[3])};
}
[[nodiscard, gnu::always_inline]] inline Lanes sqrt(const Lanes& x) {
  const __m128d low = _mm_sqrt_pd(_mm_set_pd(x[1], x[0]));
  const __m128d high = _mm_sqrt_pd(_mm_set_pd(x[3], x[2]));
  return {low[0], low[1], high[0], high[1]};
}
[[nodiscard, gnu::always_inline]] inline Lanes abs(const Lanes& x) {
  return each(
      x, [](double a) __attribute__((always_inline)) { return std::abs(a); });
}
/// Whether all four are below, or at least, a bound; not where one is no number.
[[nodiscard, gnu::always_inline]] inline bool all_below(const Lanes& x, const Lanes& bound) {
  const auto is = x.v < bound.v;
  return (is[0] & is[1] & is[2] & is[3]) != 0;
}
[[nodiscard, gnu::always_inline]] inline bool none_below(const Lanes& x, const Lanes& bound) {
  const auto is = x.v >= bound.v;
  return (is[0] & is[1] & is[2] & is[3]) != 0;
}

// The same of a single number.
template <class Function>
[[nodiscard, gnu::always_inline]] inline double each(double x, const Function& of) {
  return of(x);
}
[[nodiscard, gnu::always_inline]] inline double abs(double x) {
  return std::abs(x);
}
[[nodiscard, gnu::always_inline]] inline double sqrt(double x) {
  return std::sqrt(x);
}
[[nodiscard, gnu::always_inline]] inline bool all_below(double x, double bound) {
  return x < bound;
}
[[nodiscard, gnu::always_inline]] inline bool none_below(double x, double bound) {
  return x >= bound;
}

/// Sine and cosine of an angle [rad]: up to a quarter by powers, which leave 1e-18.
template <class S>
struct SineCosine {
  S sine, cosine;
};
[[nodiscard]] inline SineCosine<double> sine_cosine(double angle) {
  return {std::sin(angle), std::cos(angle)};
}
[[nodiscard, gnu::always_inline]] inline SineCosine<Lanes> sine_cosine(const Lanes& a) {
  constexpr double small = 0.25;
  if (!all_below(abs(a), small)) {
    SineCosine<Lanes> of;
    for (int k = 0; k < Lanes::count; ++k) {
      of.sine.v[k] = std::sin(a[k]);
      of.cosine.v[k] = std::cos(a[k]);
    }
    return of;
  }
  const Lanes u = a * a;
  const Lanes sine =
      1.0 -
      u * (1.0 / 6) *
          (1.0 - u * (1.0 / 20) * (1.0 - u * (1.0 / 42) * (1.0 - u * (1.0 / 72) * (1.0 - u * (1.0 / 110)))));
  const Lanes cosine =
      1.0 -
      u * (1.0 / 2) *
          (1.0 - u * (1.0 / 12) *
                     (1.0 - u * (1.0 / 30) *
                                (1.0 - u * (1.0 / 56) * (1.0 - u * (1.0 / 90) * (1.0 - u * (1.0 / 132))))));
  return {a * sine, cosine};
}

/// Angle of a point in the plane, in (-pi, pi] [rad]: near the first axis by powers, which leave 1e-18 of it.
[[nodiscard]] inline double polar_angle(double sine, double cosine) {
  return std::atan2(sine, cosine);
}
[[nodiscard, gnu::always_inline]] inline Lanes polar_angle(const Lanes& sine, const Lanes& cosine) {
  constexpr double small = 0.05;
  const Lanes ratio = sine / cosine;
  if (!all_below(0.0, cosine) || !all_below(abs(ratio), small)) {
    Lanes angle;
    for (int k = 0; k < Lanes::count; ++k) angle.v[k] = std::atan2(sine[k], cosine[k]);
    return angle;
  }
  const Lanes u = ratio * ratio;
  return ratio *
         (1.0 -
          u * (1.0 / 3 - u * (1.0 / 5 - u * (1.0 / 7 - u * (1.0 / 9 - u * (1.0 / 11 - u * (1.0 / 13)))))));
}

/// Three of them.
struct Lanes3 {
  std::array<Lanes, 3> of{};

  [[gnu::always_inline]] Lanes3() = default;
  [[gnu::always_inline]] Lanes3(const Lanes& a, const Lanes& b, const Lanes& c) : of{a, b, c} {}
  [[gnu::always_inline]] static Lanes3 Zero() { return {}; }
  /// From three rows of numbers, four of each.
  [[gnu::always_inline]] static Lanes3 at(const double* row, int length) {
    return {Lanes::at(row), Lanes::at(row + length), Lanes::at(row + 2 * length)};
  }
  [[gnu::always_inline]] void store(double* row, int length) const {
    for (const int k : {0, 1, 2}) (*this)[k].store(row + k * length);
  }
  [[gnu::always_inline]] void add_to(double* row, int length) const {
    for (const int k : {0, 1, 2}) (*this)[k].add_to(row + k * length);
  }
  [[nodiscard, gnu::always_inline]] const Lanes& operator[](int k) const {
    return of[static_cast<std::size_t>(k)];
  }
  [[nodiscard, gnu::always_inline]] Lanes& operator[](int k) { return of[static_cast<std::size_t>(k)]; }
  [[nodiscard, gnu::always_inline]] Lanes dot(const Lanes3& o) const {
    return of[0] * o.of[0] + of[1] * o.of[1] + of[2] * o.of[2];
  }
  [[nodiscard, gnu::always_inline]] Lanes squaredNorm() const { return dot(*this); }
  [[nodiscard, gnu::always_inline]] Lanes3 cross(const Lanes3& o) const {
    return {of[1] * o.of[2] - of[2] * o.of[1], of[2] * o.of[0] - of[0] * o.of[2],
            of[0] * o.of[1] - of[1] * o.of[0]};
  }
  [[gnu::always_inline]] friend Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
    return {a.of[0] + b.of[0], a.of[1] + b.of[1], a.of[2] + b.of[2]};
  }
  [[gnu::always_inline]] friend Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
    return {a.of[0] - b.of[0], a.of[1] - b.of[1], a.of[2] - b.of[2]};
  }
  [[gnu::always_inline]] friend Lanes3 operator*(const Lanes& s, const Lanes3& a) {
    return {s * a.of[0], s * a.of[1], s * a.of[2]};
  }
  [[gnu::always_inline]] Lanes3& operator+=(const Lanes3& o) { return *this = *this + o; }
  [[gnu::always_inline]] Lanes3& operator-=(const Lanes3& o) { return *this = *this - o; }
  [[gnu::always_inline]] Lanes3& operator*=(const Lanes& s) { return *this = s * *this; }
};

/// Four matrices of three rows and columns.
struct Lanes33 {
  std::array<Lanes, 9> of{};
  [[gnu::always_inline]] static Lanes33 Zero() { return {}; }
  [[nodiscard, gnu::always_inline]] const Lanes& operator()(int row, int column) const {
    return of[static_cast<std::size_t>(3 * column + row)];
  }
  [[nodiscard, gnu::always_inline]] Lanes& operator()(int row, int column) {
    return of[static_cast<std::size_t>(3 * column + row)];
  }
};

/// M v and M^T v, of any unit.
[[nodiscard, gnu::always_inline]] inline Lanes3 times(const Lanes33& m, const Lanes3& v) {
  return {m(0, 0) * v[0] + m(0, 1) * v[1] + m(0, 2) * v[2], m(1, 0) * v[0] + m(1, 1) * v[1] + m(1, 2) * v[2],
          m(2, 0) * v[0] + m(2, 1) * v[1] + m(2, 2) * v[2]};
}
[[nodiscard, gnu::always_inline]] inline Lanes3 transposed_times(const Lanes33& m, const Lanes3& v) {
  return {m(0, 0) * v[0] + m(1, 0) * v[1] + m(2, 0) * v[2], m(0, 1) * v[0] + m(1, 1) * v[1] + m(2, 1) * v[2],
          m(0, 2) * v[0] + m(1, 2) * v[1] + m(2, 2) * v[2]};
}
[[nodiscard]] inline Eigen::Vector3d times(const Eigen::Matrix3d& m, const Eigen::Vector3d& v) {
  return m * v;
}
[[nodiscard]] inline Eigen::Vector3d transposed_times(const Eigen::Matrix3d& m, const Eigen::Vector3d& v) {
  return m.transpose() * v;
}

/// Vectors of three, and matrices of three rows and columns, of a number type.
template <class S>
struct Space;
template <>
struct Space<double> {
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;
};
template <>
struct Space<Lanes> {
  using Vector = Lanes3;
  using Matrix = Lanes33;
};
template <class S>
using Vector3 = typename Space<S>::Vector;
template <class S>
using Matrix3 = typename Space<S>::Matrix;

/// Whether this processor works on four numbers at once.
[[nodiscard]] inline bool has_four_lanes() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}

}  // namespace snare::numerics
