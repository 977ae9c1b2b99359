#pragma once

#include "tests/slow/referee_wire.hpp"

#include <Eigen/Geometry>

namespace snare::referee {

/// What rubs between wire and ball (M.9).
struct Rubbing {
  enum class Law { none, smooth, bristles };
  Law law = Law::none;
  double resting = 0.0, sliding = 0.0;              ///< coefficients
  double resting_speed = 0.0, sliding_speed = 0.0;  ///< up to the one, from the other on
  double give = 0.0, time = 0.0;                    ///< of a bristle

  [[nodiscard]] double coefficient(double speed) const {
    if (speed >= sliding_speed) return sliding;
    if (speed <= resting_speed) return resting;
    const double x = (speed - resting_speed) / (sliding_speed - resting_speed);
    return resting + (sliding - resting) * x * x * (3.0 - 2.0 * x);
  }
  /// Force over the load by the smooth law.
  [[nodiscard]] double smooth(double w) const {
    const double x = std::abs(w) / resting_speed;
    const double size = x < 1.0 ? resting * 0.5 * x * (3.0 - x * x) : coefficient(std::abs(w));
    return std::copysign(size, w);
  }
};

/// A free body in the plane that carries a ball.
struct Striker {
  double mass = 0.0, inertia = 0.0;
  Vector2 offset = Vector2::Zero();  ///< of the ball's centre from the centre of mass, in the body
  double radius = 0.0, wire_radius = 0.0;
  double modulus = 0.0, damping = 0.0;  ///< k and a of the foundation (M.8)
  Rubbing rubbing;
};

struct StrikerState {
  Vector2 place, velocity;
  double angle = 0.0, spin = 0.0;
};

/// What the contact does at one moment.
struct ContactForces {
  double normal = 0.0;                ///< sum of the load
  Vector2 on_wire = Vector2::Zero();  ///< its force
  double moment = 0.0;                ///< on the body, about its centre of mass
  double nearest_mount = 1e300;       ///< way from what is closed to a mount
  std::vector<double> bristle_rates;
};

/// The distributed load between ball and wire (M.6) to (M.9). The rule by which it is integrated on each
/// closed stretch is part of the
/// model: (M.8).
class PlanarContact {
 public:
  PlanarContact(const PlanarWire& wire, const Striker& striker) : wire_(wire), striker_(striker) {}

  /// Adds the forces on the vertices; bristles: deflections, one a vertex.
  [[nodiscard]] ContactForces add(const Places& x, const Places& v, const StrikerState& body,
                                  const std::vector<double>& bristles, Places& f) const {
    const std::size_t n = wire_.vertices();
    const Places slopes = vertex_slopes(x), rates = vertex_slopes(v);
    ContactForces sum;
    std::vector<double> flow(n, 0.0), pressed(n, 0.0);
    Places on_slopes(n, Vector2::Zero());
    const Vector2 centre = body.place + Eigen::Rotation2Dd(body.angle) * striker_.offset;
    const double reach = striker_.radius + striker_.wire_radius;
    double begin = 0.0;
    for (std::size_t e = 0; e < wire_.edges(); begin += wire_.rest[e], ++e) {
      const double h = wire_.rest[e];
      if ((0.5 * (x[e] + x[e + 1]) - centre).norm() > reach + 1.5 * h) continue;
      const auto gap = [&](double u) { return (place(e, u, x, slopes) - centre).norm() - reach; };
      // Between two samples the gap cannot fall by more than the way.
      for (const auto& [from, to] : closed_stretches(gap, 1.5 * h)) {
        sum.nearest_mount = std::min(sum.nearest_mount, way_to_mount(begin + from * h, begin + to * h));
        for_gauss_places(from, to, [&](double u, double weight) {
          const Vector2 at = place(e, u, x, slopes), normal = (at - centre).normalized();
          const Vector2 tangent = (6.0 * u * (1.0 - u) / h) * (x[e + 1] - x[e]) +
                                  (1.0 - u) * (1.0 - 3.0 * u) * slopes[e] +
                                  u * (3.0 * u - 2.0) * slopes[e + 1];
          const Vector2 arm = at - body.place;
          const Vector2 w = place(e, u, v, rates) - body.velocity - body.spin * Vector2(-arm.y(), arm.x());
          const double g = gap(u), gap_rate = normal.dot(w);
          const Vector2 along = tangent.normalized();
          const double across = gap_rate - normal.dot(along) * along.dot(w);
          const double stored = -striker_.modulus * g;
          const double load = stored * std::max(0.0, 1.0 - striker_.damping * opening(gap_rate, across));
          const Vector2 a = (tangent - normal.dot(tangent) * normal).normalized();
          const double slip = a.dot(w);
          double rub = 0.0;  // on the body, along a
          const Rubbing& r = striker_.rubbing;
          if (r.law == Rubbing::Law::smooth) rub = load * r.smooth(slip);
          if (r.law == Rubbing::Law::bristles && stored > 0.0) {
            const double growth = std::max(-striker_.modulus * gap_rate, -stored / r.time);
            for (std::size_t end = 0; end < 2; ++end) {
              const double hat = end == 0 ? 1.0 - u : u, z = bristles[e + end], total = z + r.time * slip;
              const double bound = r.give * r.coefficient(std::abs(slip)) * load / (r.resting * stored);
              const double carried = std::clamp(total, -bound, bound);
              rub += hat * r.resting * stored / r.give * carried;
              flow[e + end] += weight * h * hat * (stored * (carried - z) / r.time - 0.5 * growth * z);
              pressed[e + end] += weight * h * hat * stored;
            }
          }
          const Vector2 force = weight * h * (load * normal - rub * a);
          f[e] += (1.0 - u) * (1.0 - u) * (1.0 + 2.0 * u) * force;
          f[e + 1] += u * u * (3.0 - 2.0 * u) * force;
          on_slopes[e] += u * (1.0 - u) * (1.0 - u) * h * force;
          on_slopes[e + 1] -= u * u * (1.0 - u) * h * force;
          sum.normal += weight * h * load;
          sum.on_wire += force;
          sum.moment -= arm.x() * force.y() - arm.y() * force.x();
        });
      }
    }
    spread(on_slopes, f);
    constexpr double least_load = 1e-6;  // [N]
    for (std::size_t i = 0; i < n; ++i) {
      const double share = least_load / (pressed[i] + least_load);
      const double forgotten =
          bristles[i] == 0.0 ? 0.0 : 10.0 * share * share * share * bristles[i] / striker_.rubbing.time;
      sum.bristle_rates.push_back(flow[i] / (pressed[i] + least_load) - forgotten);
    }
    return sum;
  }

  /// How near what may touch next is: the least of the minima of the gap along the wire that are open.
  [[nodiscard]] double next_gap(const Places& x, const StrikerState& body) const {
    const Vector2 centre = body.place + Eigen::Rotation2Dd(body.angle) * striker_.offset;
    const double reach = striker_.radius + striker_.wire_radius;
    const Places slopes = vertex_slopes(x);
    constexpr std::size_t samples = 24;
    const auto at = [&](double s) {  // of elements
      const auto e = std::min(static_cast<std::size_t>(std::max(0.0, s)), wire_.edges() - 1);
      return (place(e, std::clamp(s - static_cast<double>(e), 0.0, 1.0), x, slopes) - centre).norm() - reach;
    };
    std::vector<double> gaps;
    for (std::size_t k = 0; k <= samples * wire_.edges(); ++k)
      gaps.push_back(at(static_cast<double>(k) / samples));
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      const double before = k > 0 ? gaps[k - 1] : gaps[k],
                   after = k + 1 < gaps.size() ? gaps[k + 1] : gaps[k];
      if (gaps[k] <= 0.0 || gaps[k] > std::min(before, after)) continue;
      const double s = static_cast<double>(k) / samples, beside = 1.0 / samples;
      const double g = gaps[k] > reach ? gaps[k] : at(lowest(at, s - beside, s + beside));
      if (g > 0.0) least = std::min(least, g);
    }
    return least;
  }

 private:
  using Stretch = std::array<double, 2>;

  /// Of the cubic over an element (M.6), with slopes at the vertices.
  [[nodiscard]] Vector2 place(std::size_t e, double u, const Places& x, const Places& slopes) const {
    const double h = wire_.rest[e];
    return (1.0 - u) * (1.0 - u) * (1.0 + 2.0 * u) * x[e] + u * (1.0 - u) * (1.0 - u) * h * slopes[e] +
           u * u * (3.0 - 2.0 * u) * x[e + 1] - u * u * (1.0 - u) * h * slopes[e + 1];
  }

  /// The mean of two rates that the damper answers.
  [[nodiscard]] static double opening(double gap_rate, double across) {
    if (gap_rate * across <= 0.0) return 0.0;
    return 2.0 * gap_rate * std::abs(gap_rate) * across * across /
           (std::pow(std::abs(gap_rate), 3) + std::pow(std::abs(across), 3));
  }

  /// The slope of the curve at a vertex: of the parabola through it and its neighbours (C.1), at an end
  /// through the last three vertices.
  struct Slope {
    std::size_t first;  ///< edge; the other one is behind it
    double before, after;
  };
  [[nodiscard]] Slope slope_at(std::size_t i) const {
    const std::size_t middle = std::clamp<std::size_t>(i, 1, wire_.edges() - 1);
    const double h0 = wire_.rest[middle - 1], h1 = wire_.rest[middle];
    const double before = h1 / (h0 * (h0 + h1)), after = h0 / (h1 * (h0 + h1));
    if (i < middle) return {0, 2.0 / h0 - before, -after};
    if (i > middle) return {middle - 1, -before, 2.0 / h1 - after};
    return {middle - 1, before, after};
  }
  [[nodiscard]] Places vertex_slopes(const Places& x) const {
    Places slopes;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Slope s = slope_at(i);
      slopes.push_back(s.before * (x[s.first + 1] - x[s.first]) +
                       s.after * (x[s.first + 2] - x[s.first + 1]));
    }
    return slopes;
  }
  void spread(const Places& on_slopes, Places& f) const {
    for (std::size_t i = 0; i < f.size(); ++i) {
      const Slope s = slope_at(i);
      f[s.first] -= s.before * on_slopes[i];
      f[s.first + 1] += (s.before - s.after) * on_slopes[i];
      f[s.first + 2] += s.after * on_slopes[i];
    }
  }

  [[nodiscard]] double way_to_mount(double from, double to) const {
    double way = std::numeric_limits<double>::infinity();
    if (wire_.left.kind != EndKind::free) way = std::min(way, from);
    if (wire_.right.kind != EndKind::free) way = std::min(way, wire_.length() - to);
    return way;
  }

  /// The place of a minimum between two places, by golden sections.
  template <class Gap>
  [[nodiscard]] static double lowest(const Gap& gap, double a, double b) {
    constexpr double golden = 0.6180339887498949;
    double c = b - golden * (b - a), d = a + golden * (b - a), at_c = gap(c), at_d = gap(d);
    while (b - a > 1e-9) {  // the gap is level there
      if (at_c < at_d) {
        b = d;
        d = c;
        at_d = at_c;
        at_c = gap(c = b - golden * (b - a));
      } else {
        a = c;
        c = d;
        at_c = at_d;
        at_d = gap(d = a + golden * (b - a));
      }
    }
    return 0.5 * (a + b);
  }

  /// Where a gap is negative: between zeros, found from samples and the minima between them.
  template <class Gap>
  [[nodiscard]] static std::vector<Stretch> closed_stretches(const Gap& gap, double way) {
    constexpr int samples = 24;
    std::vector<std::array<double, 2>> points;  // u, gap
    for (int k = 0; k <= samples; ++k) {
      const double u = static_cast<double>(k) / samples;
      points.push_back({u, gap(u)});
    }
    std::vector<std::array<double, 2>> all{points.front()};
    for (int k = 0; k < samples; ++k) {
      const auto i = static_cast<std::size_t>(k);
      // A minimum beside a sample that is open.
      for (const std::size_t m : {i, i + 1}) {
        const double left = points[m == 0 ? 0 : m - 1][1],
                     right = points[std::min<std::size_t>(m + 1, samples)][1];
        const bool is_least = points[m][1] >= 0.0 && points[m][1] <= std::min({left, right, way / samples});
        if (!is_least) continue;
        if (const double u = lowest(gap, points[i][0], points[i + 1][0]); gap(u) < 0.0)
          all.push_back({u, gap(u)});
        break;
      }
      all.push_back(points[i + 1]);
    }
    std::vector<Stretch> stretches;
    const auto zero = [&gap](double in, double out) {
      for (int k = 0; k < 60; ++k) {
        const double u = 0.5 * (in + out);
        (gap(u) < 0.0 ? in : out) = u;
      }
      return 0.5 * (in + out);
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i][1] >= 0.0) continue;
      const bool begins = i == 0 || all[i - 1][1] >= 0.0, ends = i + 1 == all.size() || all[i + 1][1] >= 0.0;
      if (begins) stretches.push_back({i == 0 ? 0.0 : zero(all[i][0], all[i - 1][0]), 1.0});
      if (ends && i + 1 < all.size()) stretches.back()[1] = zero(all[i][0], all[i + 1][0]);
    }
    return stretches;
  }

  /// Gauss's rule of three places.
  template <class Use>
  static void for_gauss_places(double from, double to, const Use& use) {
    const double half = 0.5 * (to - from), middle = 0.5 * (from + to), off = std::sqrt(0.6) * half;
    use(middle - off, 5.0 / 9.0 * half);
    use(middle, 8.0 / 9.0 * half);
    use(middle + off, 5.0 / 9.0 * half);
  }

  PlanarWire wire_;
  Striker striker_;
};

}  // namespace snare::referee
