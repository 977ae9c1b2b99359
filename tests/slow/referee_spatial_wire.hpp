#pragma once

#include "tests/slow/referee_wire.hpp"

#include <Eigen/Geometry>

namespace snare::referee {

using Vector3 = Eigen::Vector3d;
using Complex3 = std::array<Complex, 3>;

/// An end of a wire in space.
struct SpatialWireEnd {
  EndKind kind = EndKind::clamp;
  bool holds_twist = true;               ///< a clamp does; a pin may
  Vector3 direction = Vector3::UnitX();  ///< of increasing arc length, of an end that holds twist
  Vector3 director = Vector3::UnitY();   ///< of the material there
};

/// A round, naturally straight wire in space with its curvature at the vertices. Its bending does not
/// dissipate: then nothing but their sum matters of how its edges turn about themselves.
struct SpatialWire {
  std::vector<double> rest;
  double bending = 0.0, torsional = 0.0, axial = 0.0;  ///< EI, GJ, EA
  double natural_twist = 0.0;
  double mass_per_length = 0.0;
  double axial_time = 0.0, mass_rate = 0.0;
  Vector3 gravity = Vector3::Zero();
  SpatialWireEnd left, right;

  [[nodiscard]] std::size_t edges() const { return rest.size(); }
  [[nodiscard]] std::size_t vertices() const { return rest.size() + 1; }
  [[nodiscard]] bool holds(std::size_t vertex) const {
    return (vertex == 0 && left.kind != EndKind::free) || (vertex == edges() && right.kind != EndKind::free);
  }
  [[nodiscard]] double cell(std::size_t i) const {
    return 0.5 * ((i > 0 ? rest[i - 1] : 0.0) + (i < edges() ? rest[i] : 0.0));
  }
  [[nodiscard]] double mass(std::size_t i) const { return mass_per_length * cell(i); }
};

inline Complex dot(const Complex3& a, const Complex3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Complex3 cross(const Complex3& a, const Complex3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Complex3 complex3(const Vector3& a) {
  return {a.x(), a.y(), a.z()};
}
inline Complex3 unit(const Complex3& a) {
  const Complex size = std::sqrt(dot(a, a));
  return {a[0] / size, a[1] / size, a[2] / size};
}
/// Parallel transport of v from the tangent a to b (W.20).
inline Complex3 carried(const Complex3& v, const Complex3& a, const Complex3& b) {
  const Complex share = dot(v, b) / (1.0 + dot(a, b));
  return {v[0] - share * (a[0] + b[0]), v[1] - share * (a[1] + b[1]), v[2] - share * (a[2] + b[2])};
}

/// Adds the forces on the vertices at places x and velocities v.
///   E = sum EA e^2 h/2 + sum EI |kb|^2/(2 l) + GJ/(2 L) (turn - natural L)^2
/// Twist is quasi-static, so its torque is the same in all cells: what counts is the turn of the right end's
/// director against that of the left one, carried along the edges. No torque where an end lets the wire turn.
inline void add_spatial_forces(const SpatialWire& w, const std::vector<Vector3>& x,
                               const std::vector<Vector3>& v, std::vector<Vector3>& f) {
  constexpr double step = 1e-30;
  const std::size_t n = w.edges();
  for (std::size_t e = 0; e < n; ++e) {
    const Vector3 chord = x[e + 1] - x[e], t = chord.normalized();
    const double strain = chord.norm() / w.rest[e] - 1.0, rate = t.dot(v[e + 1] - v[e]) / w.rest[e];
    const Vector3 pull = w.axial * (strain + w.axial_time * rate) * t;
    f[e] += pull;
    f[e + 1] -= pull;
  }
  for (std::size_t i = 0; i <= n; ++i) {
    const bool left = i == 0, right = i == n;
    if ((left && w.left.kind != EndKind::clamp) || (right && w.right.kind != EndKind::clamp)) continue;
    const Complex3 a = complex3(left ? w.left.direction : Vector3(x[i] - x[i - 1]));
    const Complex3 b = complex3(right ? w.right.direction : Vector3(x[i + 1] - x[i]));
    const auto energy = [&](const Complex3& before, const Complex3& after) {
      const Complex c = dot(unit(before), unit(after));
      return 0.5 * w.bending / w.cell(i) * 4.0 * (1.0 - c) / (1.0 + c);
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const auto c = static_cast<Eigen::Index>(k);
      if (!left) {
        Complex3 moved = a;
        moved[k] += Complex(0.0, step);
        const double slope = energy(moved, b).imag() / step;
        f[i - 1][c] += slope;
        f[i][c] -= slope;
      }
      if (!right) {
        Complex3 moved = b;
        moved[k] += Complex(0.0, step);
        const double slope = energy(a, moved).imag() / step;
        f[i][c] += slope;
        f[i + 1][c] -= slope;
      }
    }
  }
  if (w.left.holds_twist && w.right.holds_twist) {
    double length = 0.0;
    for (const double h : w.rest) length += h;
    const auto turned = [&](std::size_t vertex, std::size_t k) {  // sine and cosine of the turn
      Complex3 at = complex3(w.left.direction), director = complex3(w.left.director);
      for (std::size_t e = 0; e <= n; ++e) {
        Complex3 next = complex3(w.right.direction);
        if (e < n) {
          Complex3 chord = complex3(x[e + 1] - x[e]);
          if (vertex == e) chord[k] -= Complex(0.0, step);
          if (vertex == e + 1) chord[k] += Complex(0.0, step);
          next = unit(chord);
        }
        director = carried(director, at, next);
        at = next;
      }
      const Complex3 end = complex3(w.right.director);
      return std::array<Complex, 2>{dot(cross(at, director), end), dot(director, end)};
    };
    for (std::size_t i = 0; i <= n; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [sine, cosine] = turned(i, k);
        const double turn = std::atan2(sine.real(), cosine.real());
        const double by = (cosine.real() * sine.imag() - sine.real() * cosine.imag()) / step;
        f[i][static_cast<Eigen::Index>(k)] -= w.torsional / length * (turn - w.natural_twist * length) * by;
      }
    }
  }
  for (std::size_t i = 0; i <= n; ++i) f[i] += w.mass(i) * (w.gravity - w.mass_rate * v[i]);
}

}  // namespace snare::referee
