#include "wire/edge_beam.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace snare::wire {

using Eigen::Vector2d;

namespace {

// Functions of x = w^2 = z/4.
constexpr double least = -1.0;    // below it the parabola
constexpr double series = 0.02;   // within it powers: eight terms leave 1e-12 of the second derivative
constexpr double fraction = 2.0;  // below it a ratio of polynomials

/// sum c_n x^n and its derivatives by x.
template <std::size_t terms>
Flexibility polynomial(const std::array<double, terms>& c, double x) {
  Flexibility f{0.0, 0.0, 0.0};
  for (std::size_t n = terms; n-- > 0;) {
    f.second = f.second * x + 2.0 * f.first;
    f.first = f.first * x + f.value;
    f.value = f.value * x + c[n];
  }
  return f;
}

/// f/g and its derivatives.
Flexibility ratio(const Flexibility& f, const Flexibility& g) {
  const double inverse = 1.0 / g.value;
  const double value = f.value * inverse;
  const double first = (f.first - value * g.first) * inverse;
  return {value, first, (f.second - 2.0 * first * g.first - value * g.second) * inverse};
}

/// y = 1/(1 + x g) and its derivatives.
Flexibility alike_of(const Flexibility& g, double x) {
  const double y = 1.0 / (1.0 + x * g.value);
  const double slope = g.value + x * g.first;
  const double first = -y * y * slope;
  return {y, first, -2.0 * y * first * slope - y * y * (2.0 * g.first + x * g.second)};
}

// Half of a function of x = z/4 by z, d/dz = 1/4 d/dx, `rest` beyond the x where it is known: there its parabola.
Flexibility by_z(const Flexibility& f, double rest) {
  const double first = f.first + rest * f.second;
  return {0.5 * (f.value + 0.5 * rest * (f.first + first)), 0.125 * first, f.second / 32.0};
}

/// At z + dz, to second order.
void advance(Flexibility& f, double dz) {
  f.value += dz * (f.first + 0.5 * dz * f.second);
  f.first += dz * f.second;
}

}  // namespace

// C = y/2 with y = tanh(w)/w, D = g/2 with g = (w coth w - 1)/w^2. By powers; by y = 1/(1 + x g) and
// g = 1/(3 + x/(5 + x/(7 + ...))), of which nine denominators leave 1e-16 and 2e-13 of the second derivative; and by
// 2 x y' = 1 - y - x y^2 and g = (1/y - 1)/x with their derivatives.
Flexibilities flexibilities(double z) {
  const double x = std::max(0.25 * z, least);
  const double rest = 0.25 * z - x;
  if (std::abs(x) < series) {
    return {by_z(polynomial(std::array{1.0, -1.0 / 3.0, 2.0 / 15.0, -17.0 / 315.0, 62.0 / 2835.0, -1382.0 / 155925.0,
                                       21844.0 / 6081075.0, -929569.0 / 638512875.0},
                            x),
                 rest),
            by_z(polynomial(std::array{1.0 / 3.0, -1.0 / 45.0, 2.0 / 945.0, -1.0 / 4725.0, 2.0 / 93555.0,
                                       -1382.0 / 638512875.0, 4.0 / 18243225.0, -3617.0 / 162820783125.0},
                            x),
                 rest)};
  }
  if (x < fraction) {
    const Flexibility g = ratio(polynomial(std::array{218243025.0, 16081065.0, 289575.0, 1430.0, 1.0}, x),
                                polynomial(std::array{654729075.0, 91891800.0, 2837835.0, 25740.0, 55.0}, x));
    return {by_z(alike_of(g, x), rest), by_z(g, rest)};
  }
  const double w = std::sqrt(x);
  const double y = std::tanh(w) / w;
  const double y1 = (1.0 - y - x * y * y) / (2.0 * x);
  const double y2 = (-3.0 * y1 - y * y - 2.0 * x * y * y1) / (2.0 * x);
  const double g = (1.0 / y - 1.0) / x;
  const double g1 = (-y1 / (y * y) - g) / x;
  const double g2 = (-y2 / (y * y) + 2.0 * y1 * y1 / (y * y * y) - 2.0 * g1) / x;
  return {by_z({y, y1, y2}, rest), by_z({g, g1, g2}, rest)};
}

EdgeBeam edge_beam(const EdgeBeamConstants& p, double chord, const Vector2d& near, const Vector2d& far,
                   EdgeDerivatives wanted) {
  const double h = p.rest;
  const Vector2d& ei = p.bending_stiffness;
  const Vector2d sum = near + far;
  const Vector2d difference = near - far;
  const Vector2d s2 = sum.cwiseAbs2();
  const Vector2d d2 = difference.cwiseAbs2();
  std::array<Flexibilities, 2> of{};
  double lever = 1.0;  // of the bow under N: dP/dN with P = N (1 + N/EA), as the edge is stretched
  const auto by_stiffness = [&](double tension) -> Vector2d {  // z
    return tension * (1.0 + tension / p.axial_stiffness) * h * h * ei.cwiseInverse();
  };
  // l - h = N h/EA + dW/dN with W(P) = h/4 sum EI (C s^2 + D d^2): its right side rises with N and is concave but for
  // the square of the strain, so that Newton's method converges.
  const double compliance = h / p.axial_stiffness;
  const double cube = h * h * h;
  double tension = (chord - h + cube * (s2.sum() / 96.0 + d2.sum() / 1440.0)) / compliance;  // of C, D at 0
  double by_tension_twice = 0.0;
  constexpr int most = 50;
  for (int k = 0; k < most; ++k) {
    const Vector2d z = by_stiffness(tension);
    of[0] = flexibilities(z[0]);
    of[1] = ei[0] == ei[1] ? of[0] : flexibilities(z[1]);
    lever = 1.0 + 2.0 * tension / p.axial_stiffness;
    double bow = 0.0;  // dW/dP
    by_tension_twice = 0.0;
    for (std::size_t j = 0; j < 2; ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      const auto& [C, D] = of[j];
      bow += 0.25 * cube * (C.first * s2[i] + D.first * d2[i]);
      by_tension_twice += 0.25 * cube * h * h / ei[i] * (C.second * s2[i] + D.second * d2[i]);
    }
    by_tension_twice = lever * lever * by_tension_twice + 2.0 * bow / p.axial_stiffness;
    bow *= lever;
    const double change = (chord - h - tension * compliance - bow) / (compliance + by_tension_twice);
    tension += change;
    // The next change would be of the order of the square of this one.
    constexpr double small = 1e-6;
    const Vector2d dz = by_stiffness(tension) - z;
    if (dz.cwiseAbs().maxCoeff() > small && std::abs(change) > 1e-15 * p.axial_stiffness) continue;
    lever = 1.0 + 2.0 * tension / p.axial_stiffness;
    for (std::size_t j = 0; j < 2; ++j) {
      advance(of[j].alike, dz[static_cast<Eigen::Index>(j)]);
      advance(of[j].against, dz[static_cast<Eigen::Index>(j)]);
    }
    break;
  }

  EdgeBeam b;
  b.tension = tension;
  b.energy = tension * (chord - h) - 0.5 * tension * tension * compliance;
  b.gradient[EdgeBeam::chord] = tension;
  for (int j = 0; j < 2; ++j) {
    const auto& [c, d] = of[static_cast<std::size_t>(j)];
    b.energy -= 0.25 * h * ei[j] * (c.value * s2[j] + d.value * d2[j]);
    b.gradient[EdgeBeam::near + j] = -0.5 * h * ei[j] * (c.value * sum[j] + d.value * difference[j]);
    b.gradient[EdgeBeam::far + j] = -0.5 * h * ei[j] * (c.value * sum[j] - d.value * difference[j]);
  }
  if (wanted == EdgeDerivatives::first) return b;

  Eigen::Matrix<double, EdgeBeam::count, 1> by_tension;  // d2/dN d(l, k)
  by_tension[EdgeBeam::chord] = 1.0;
  b.hessian.setZero();
  for (int j = 0; j < 2; ++j) {
    const auto& [c, d] = of[static_cast<std::size_t>(j)];
    const int a = EdgeBeam::near + j;
    const int z = EdgeBeam::far + j;
    by_tension[a] = -0.5 * cube * lever * (c.first * sum[j] + d.first * difference[j]);
    by_tension[z] = -0.5 * cube * lever * (c.first * sum[j] - d.first * difference[j]);
    b.hessian(a, a) = b.hessian(z, z) = -0.5 * h * ei[j] * (c.value + d.value);
    b.hessian(a, z) = b.hessian(z, a) = -0.5 * h * ei[j] * (c.value - d.value);
  }
  // N eliminated: H - H_N H_N^T/H_NN with H_NN = -(h/EA + d2W/dN2).
  b.hessian += by_tension * by_tension.transpose() / (compliance + by_tension_twice);
  return b;
}

}  // namespace snare::wire
