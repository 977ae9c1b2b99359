#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

// Equations of motion of one wire, written down from docs/theory once more: energies, of which complex steps
// give the forces, lumped masses, and what touches them. They share no code with the rod, its contact and its
// integrator.
namespace snare::referee {

using Complex = std::complex<double>;
using Vector2 = Eigen::Vector2d;
using Places = std::vector<Vector2>;

enum class EndKind { clamp, pin, free };

/// Edges of a wire as (W.10) spreads them on either side of its middle vertex.
inline std::vector<double> graded_edges(double length, int edges, double grading) {
  const int middle = edges / 2;
  const double at = length * middle / edges;
  const auto share = [grading](double u) {
    return grading == 0.0 ? u : 0.5 * (1.0 + std::tanh(grading * (2.0 * u - 1.0)) / std::tanh(grading));
  };
  const auto place = [&](int i) {
    return i <= middle ? at * share(static_cast<double>(i) / middle)
                       : at + (length - at) * share(static_cast<double>(i - middle) / (edges - middle));
  };
  std::vector<double> rest;
  for (int i = 0; i < edges; ++i) rest.push_back(place(i + 1) - place(i));
  return rest;
}

/// An end of a wire in its plane.
struct PlanarEnd {
  EndKind kind = EndKind::clamp;
  double direction = 0.0;  ///< of increasing arc length at a clamp, from the x axis [rad]
};

/// A round wire in its plane. SI units.
struct PlanarWire {
  std::vector<double> rest;                                      ///< lengths of the edges, unstretched
  double bending = 0.0;                                          ///< EI
  double axial = 0.0;                                            ///< EA
  double natural = 0.0;                                          ///< curvature, positive to the left
  double mass_per_length = 0.0;                                  ///< rho A
  bool has_curvatures = false;                                   ///< (W.31) to (W.33) instead of (W.1), (W.2)
  double bending_time = 0.0, axial_time = 0.0, mass_rate = 0.0;  ///< damping (M.4)
  Vector2 gravity = Vector2::Zero();
  PlanarEnd left, right;

  [[nodiscard]] std::size_t edges() const { return rest.size(); }
  [[nodiscard]] std::size_t vertices() const { return rest.size() + 1; }
  [[nodiscard]] bool holds(std::size_t vertex) const {
    return (vertex == 0 && left.kind != EndKind::free) || (vertex == edges() && right.kind != EndKind::free);
  }
  /// Length of the cell of a vertex.
  [[nodiscard]] double cell(std::size_t i) const {
    return 0.5 * ((i > 0 ? rest[i - 1] : 0.0) + (i < edges() ? rest[i] : 0.0));
  }
  [[nodiscard]] double mass(std::size_t i) const { return mass_per_length * cell(i); }
  [[nodiscard]] double length() const {
    double sum = 0.0;
    for (const double h : rest) sum += h;
    return sum;
  }
};

/// Flexibilities C and D of an edge under tension and their derivatives by z (W.32).
template <class S>
struct EdgeFlexibility {
  S c, c_slope, d, d_slope;
};

/// y = tanh(w)/w of x = w^2, x of either sign.
inline double tanh_over(double x) {
  const double w = std::sqrt(std::abs(x));
  return x > 0.0 ? std::tanh(w) / w : std::tan(w) / w;
}
inline Complex tanh_over(Complex x) {
  const Complex w = std::sqrt(x);
  return std::tanh(w) / w;
}

/// By y, C = y/2 and D = (1/y - 1)/(2 x), with y' = (1 - x y^2 - y)/(2 x); near zero by the power series of
/// tanh and coth.
template <class S>
EdgeFlexibility<S> smooth_flexibility(S z) {
  const S x = 0.25 * z;
  if (std::abs(x) < 0.01) {
    constexpr double a[] = {1.0, -1.0 / 3.0, 2.0 / 15.0, -17.0 / 315.0, 62.0 / 2835.0, -1382.0 / 155925.0};
    constexpr double b[] = {1.0 / 3.0,     -1.0 / 45.0,   2.0 / 945.0,
                            -1.0 / 4725.0, 2.0 / 93555.0, -1382.0 / 638512875.0};
    EdgeFlexibility<S> f{0.0, 0.0, 0.0, 0.0};
    for (int k = 5; k >= 0; --k) {
      f.c_slope = f.c_slope * x + f.c;
      f.c = f.c * x + a[k];
      f.d_slope = f.d_slope * x + f.d;
      f.d = f.d * x + b[k];
    }
    return {0.5 * f.c, 0.125 * f.c_slope, 0.5 * f.d, 0.125 * f.d_slope};
  }
  const S y = tanh_over(x), slope = (1.0 - x * y * y - y) / (2.0 * x), more = 1.0 / y - 1.0;
  return {0.5 * y, 0.125 * slope, 0.5 * more / x, -0.125 * (slope / (y * y * x) + more / (x * x))};
}

/// Below z = -4 parabolas.
inline EdgeFlexibility<double> edge_flexibility(double z) {
  constexpr double least = -4.0, step = 1e-20;
  if (z >= least) return smooth_flexibility(z);
  EdgeFlexibility<double> f = smooth_flexibility(least);
  const EdgeFlexibility<Complex> beside = smooth_flexibility(Complex(least, step));
  const double dz = z - least, c2 = beside.c_slope.imag() / step, d2 = beside.d_slope.imag() / step;
  return {f.c + dz * (f.c_slope + 0.5 * dz * c2), f.c_slope + dz * c2, f.d + dz * (f.d_slope + 0.5 * dz * d2),
          f.d_slope + dz * d2};
}

/// Curvatures and tensions are nowhere stationary: an edge is pressed far beyond the load that buckles it by
/// itself.
struct NoBalance : std::runtime_error {
  NoBalance() : std::runtime_error("curvatures and tensions do not balance") {}
};

/// Forces within a planar wire.
class PlanarForces {
 public:
  explicit PlanarForces(const PlanarWire& wire) : wire_(wire), turns_(wire.vertices()) {
    const auto n = static_cast<Eigen::Index>(wire.vertices() + wire.edges());
    unknowns_ = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < wire.vertices(); ++i) unknowns_[index(i)] = wire.natural;
  }

  /// Adds the forces on the vertices at places x and velocities v.
  void add(const Places& x, const Places& v, Places& f) {
    const PlanarWire& w = wire_;
    for (std::size_t i = 0; i < w.vertices(); ++i) turns_[i] = turn(i, x);
    if (w.has_curvatures) balance(x);
    for (std::size_t e = 0; e < w.edges(); ++e) {
      const Vector2 chord = x[e + 1] - x[e], t = chord.normalized();
      const double strain_rate = t.dot(v[e + 1] - v[e]) / w.rest[e];
      const double elastic =
          w.has_curvatures ? unknowns_[tension_index(e)] : w.axial * (chord.norm() / w.rest[e] - 1.0);
      const Vector2 pull = (elastic + w.axial * w.axial_time * strain_rate) * t;
      f[e] += pull;
      f[e + 1] -= pull;
    }
    for (std::size_t i = 0; i < w.vertices(); ++i) {
      const Turn& k = turns_[i];
      if (!k.exists) continue;
      const Vector2 before_rate = i > 0 ? Vector2(v[i] - v[i - 1]) : Vector2::Zero();
      const Vector2 after_rate = i < w.edges() ? Vector2(v[i + 1] - v[i]) : Vector2::Zero();
      const double rate = k.by_before.dot(before_rate) + k.by_after.dot(after_rate), l = w.cell(i);
      // By kappa = 2 tan(phi/2): with curvatures as unknowns the moment EI (k - n) acts on phi.
      const double moment =
          w.has_curvatures ? w.bending * (unknowns_[index(i)] - w.natural) / (1.0 + 0.25 * k.kappa * k.kappa)
                           : w.bending / l * (k.kappa - w.natural * l);
      const double total = moment + w.bending_time * w.bending / l * rate;
      if (i > 0) {
        f[i - 1] += total * k.by_before;
        f[i] -= total * k.by_before;
      }
      if (i < w.edges()) {
        f[i] += total * k.by_after;
        f[i + 1] -= total * k.by_after;
      }
    }
    for (std::size_t i = 0; i < w.vertices(); ++i) f[i] += w.mass(i) * (w.gravity - w.mass_rate * v[i]);
  }

 private:
  /// kappa = 2 tan(phi/2) of a vertex and its derivatives by the edges before and after it.
  struct Turn {
    bool exists = false;
    double kappa = 0.0;
    Vector2 by_before = Vector2::Zero(), by_after = Vector2::Zero();
  };

  static Complex kappa(const std::array<Complex, 4>& q) {
    const Complex cross = q[0] * q[3] - q[1] * q[2], dot = q[0] * q[2] + q[1] * q[3];
    return 2.0 * cross / (std::sqrt(q[0] * q[0] + q[1] * q[1]) * std::sqrt(q[2] * q[2] + q[3] * q[3]) + dot);
  }

  [[nodiscard]] Turn turn(std::size_t i, const Places& x) const {
    const auto mount = [](const PlanarEnd& end) {
      return Vector2(std::cos(end.direction), std::sin(end.direction));
    };
    Turn t;
    const bool left = i == 0, right = i == wire_.edges();
    t.exists = !(left && wire_.left.kind != EndKind::clamp) && !(right && wire_.right.kind != EndKind::clamp);
    if (!t.exists) return t;
    const Vector2 a = left ? mount(wire_.left) : Vector2(x[i] - x[i - 1]);
    const Vector2 b = right ? mount(wire_.right) : Vector2(x[i + 1] - x[i]);
    const std::array<Complex, 4> q{a.x(), a.y(), b.x(), b.y()};
    t.kappa = kappa(q).real();
    for (std::size_t k = 0; k < 4; ++k) {
      constexpr double step = 1e-30;
      if ((left && k < 2) || (right && k >= 2)) continue;
      std::array<Complex, 4> moved = q;
      moved[k] += Complex(0.0, step);
      (k < 2 ? t.by_before : t.by_after)[static_cast<Eigen::Index>(k % 2)] = kappa(moved).imag() / step;
    }
    return t;
  }

  [[nodiscard]] static Eigen::Index index(std::size_t vertex) { return static_cast<Eigen::Index>(vertex); }
  [[nodiscard]] Eigen::Index tension_index(std::size_t edge) const {
    return static_cast<Eigen::Index>(wire_.vertices() + edge);
  }

  /// What the curvatures and the tensions leave of (W.32), (W.33) being stationary.
  [[nodiscard]] Eigen::VectorXd residual(const Eigen::VectorXd& z, const Places& x) const {
    const PlanarWire& w = wire_;
    Eigen::VectorXd r = Eigen::VectorXd::Zero(z.size());
    for (std::size_t e = 0; e < w.edges(); ++e) {
      const double h = w.rest[e], tension = z[tension_index(e)], near = z[index(e)], far = z[index(e + 1)];
      const EdgeFlexibility<double> f =
          edge_flexibility(tension * (1.0 + tension / w.axial) * h * h / w.bending);
      const double sum = near + far, difference = near - far;
      r[index(e)] -= 0.5 * h * (f.c * sum + f.d * difference);
      r[index(e + 1)] -= 0.5 * h * (f.c * sum - f.d * difference);
      r[tension_index(e)] = (x[e + 1] - x[e]).norm() / h - 1.0 - tension / w.axial -
                            (1.0 + 2.0 * tension / w.axial) * 0.25 * h * h *
                                (f.c_slope * sum * sum + f.d_slope * difference * difference);
    }
    for (std::size_t i = 0; i < w.vertices(); ++i) {
      if (turns_[i].exists) {
        r[index(i)] += 2.0 * std::atan(0.5 * turns_[i].kappa);
      } else {
        r[index(i)] = z[index(i)] - w.natural;
      }
    }
    return r;
  }

  /// Newton's method with a matrix that is kept as long as it serves; where that fails, from the chords'
  /// strains with a matrix a step.
  void balance(const Places& x) {
    if (iterate(x, 8)) return;
    for (std::size_t i = 0; i < wire_.vertices(); ++i) unknowns_[index(i)] = wire_.natural;
    for (std::size_t e = 0; e < wire_.edges(); ++e)
      unknowns_[tension_index(e)] = wire_.axial * ((x[e + 1] - x[e]).norm() / wire_.rest[e] - 1.0);
    has_matrix_ = false;
    if (!iterate(x, 1)) throw NoBalance();
  }

  /// renewal: iterations with one matrix.
  [[nodiscard]] bool iterate(const Places& x, int renewal) {
    double last = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 60; ++k) {
      if (!has_matrix_ || (k > 0 && k % renewal == 0)) {
        Eigen::MatrixXd matrix(unknowns_.size(), unknowns_.size());
        for (Eigen::Index j = 0; j < unknowns_.size(); ++j) {
          const double step = j < static_cast<Eigen::Index>(wire_.vertices()) ? 1e-5 : 1e-6 * wire_.axial;
          Eigen::VectorXd up = unknowns_, down = unknowns_;
          up[j] += step;
          down[j] -= step;
          matrix.col(j) = (residual(up, x) - residual(down, x)) / (2.0 * step);
        }
        matrix_.compute(matrix);
        has_matrix_ = true;
      }
      const Eigen::VectorXd change = matrix_.solve(residual(unknowns_, x));
      unknowns_ -= change;
      // Of tensions relative to EA, of curvatures to 1/L.
      const auto n = static_cast<Eigen::Index>(wire_.vertices());
      const double size = change.head(n).cwiseAbs().maxCoeff() * wire_.length() +
                          change.tail(unknowns_.size() - n).cwiseAbs().maxCoeff() / wire_.axial;
      if (!unknowns_.allFinite()) return false;
      if (size < 1e-15 || (size < 1e-13 && size >= 0.5 * last)) return true;
      last = size;
    }
    return last < 1e-12;
  }

  PlanarWire wire_;
  std::vector<Turn> turns_;
  Eigen::VectorXd unknowns_;  // curvatures, tensions
  Eigen::PartialPivLU<Eigen::MatrixXd> matrix_;
  bool has_matrix_ = false;
};

}  // namespace snare::referee
