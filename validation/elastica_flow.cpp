#include "validation/elastica_flow.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace snare::validation {
namespace {

// Section (x, y, angle, moment), then for each of the four parameters the derivative of the section.
constexpr std::size_t kSize = 20;
using Bundle = std::array<double, kSize>;

Bundle rate_of(const ElasticaLaw& law, const Bundle& y, ElasticaForce n) {
  const double c = std::cos(y[2]);
  const double s = std::sin(y[2]);
  const double tension = n.x * c + n.y * s;
  const double shear = -n.x * s + n.y * c;
  const double stretch = 1.0 + law.compliance * tension;
  Bundle r{};
  r[0] = stretch * c;
  r[1] = stretch * s;
  r[2] = law.natural_curvature + y[3];
  r[3] = -stretch * shear;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t at = 4 + 4 * k;
    const double d_angle = y[at + 2];
    const double dnx = k == 2 ? 1.0 : 0.0;
    const double dny = k == 3 ? 1.0 : 0.0;
    // dN/dtheta = V and dV/dtheta = -N.
    const double d_tension = shear * d_angle + c * dnx + s * dny;
    const double d_shear = -tension * d_angle - s * dnx + c * dny;
    const double d_stretch = law.compliance * d_tension;
    r[at] = d_stretch * c - stretch * s * d_angle;
    r[at + 1] = d_stretch * s + stretch * c * d_angle;
    r[at + 2] = y[at + 3];
    r[at + 3] = -d_stretch * shear - stretch * d_shear;
  }
  return r;
}

Bundle added(const Bundle& a, double factor, const Bundle& b) {
  Bundle result;
  for (std::size_t i = 0; i < kSize; ++i) result[i] = a[i] + factor * b[i];
  return result;
}

// Gragg's modified midpoint rule with an even number of steps; its error is a series in step^2.
Bundle midpoint(const ElasticaLaw& law, const Bundle& start, ElasticaForce n, double length, int steps) {
  const double h = length / steps;
  Bundle before = start;
  Bundle now = added(start, h, rate_of(law, start, n));
  for (int i = 1; i < steps; ++i) {
    const Bundle next = added(before, 2.0 * h, rate_of(law, now, n));
    before = now;
    now = next;
  }
  const Bundle last = rate_of(law, now, n);
  Bundle result;
  for (std::size_t i = 0; i < kSize; ++i) result[i] = 0.5 * (now[i] + before[i] + h * last[i]);
  return result;
}

// Each derivative column and the section itself is measured against its own largest entry.
double relative_difference(const Bundle& a, const Bundle& b) {
  double worst = 0.0;
  for (std::size_t block = 0; block < kSize; block += 4) {
    double scale = 1.0;
    double difference = 0.0;
    for (std::size_t i = block; i < block + 4; ++i) {
      scale = std::max(scale, std::abs(a[i]));
      difference = std::max(difference, std::abs(a[i] - b[i]));
    }
    worst = std::max(worst, difference / scale);
  }
  return worst;
}

constexpr int kColumns = 9;
constexpr double kTolerance = 1e-14;
constexpr int kDeepest = 8;

Bundle integrate(const ElasticaLaw& law, const Bundle& start, ElasticaForce n, double length, int depth) {
  std::array<Bundle, kColumns> row{};
  for (int k = 0; k < kColumns; ++k) {
    const int steps = 2 * (k + 1);
    Bundle value = midpoint(law, start, n, length, steps);
    // Aitken-Neville in step^2: row[j] holds the previous row's j-th column.
    for (int j = 0; j < k; ++j) {
      const double coarse = 2.0 * (k - j);
      const double ratio = steps / coarse;
      const Bundle better = [&] {
        Bundle b;
        const auto old = row[static_cast<std::size_t>(j)];
        for (std::size_t i = 0; i < kSize; ++i) {
          b[i] = value[i] + (value[i] - old[i]) / (ratio * ratio - 1.0);
        }
        return b;
      }();
      row[static_cast<std::size_t>(j)] = value;
      value = better;
    }
    const bool settled =
        k > 2 && relative_difference(value, row[static_cast<std::size_t>(k - 1)]) < kTolerance;
    row[static_cast<std::size_t>(k)] = value;
    if (settled) return value;
  }
  if (depth == kDeepest) return row[kColumns - 1];
  const Bundle middle = integrate(law, start, n, 0.5 * length, depth + 1);
  return integrate(law, middle, n, 0.5 * length, depth + 1);
}

}  // namespace

SectionForces section_forces(ElasticaForce force, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {force.x * c + force.y * s, -force.x * s + force.y * c};
}

ElasticaSection section_rate(const ElasticaLaw& law, const ElasticaSection& section, ElasticaForce force) {
  const auto [tension, shear] = section_forces(force, section.angle);
  const double stretch = 1.0 + law.compliance * tension;
  return {stretch * std::cos(section.angle), stretch * std::sin(section.angle),
          law.natural_curvature + section.moment, -stretch * shear};
}

ElasticaFlow elastica_flow(const ElasticaLaw& law, const ElasticaSection& start, ElasticaForce force,
                           double length) {
  Bundle bundle{start.x, start.y, start.angle, start.moment};
  bundle[4 + 2] = 1.0;      // d angle / d angle
  bundle[4 + 4 + 3] = 1.0;  // d moment / d moment
  const Bundle y = integrate(law, bundle, force, length, 0);
  ElasticaFlow flow;
  flow.end = {y[0], y[1], y[2], y[3]};
  flow.rate = section_rate(law, flow.end, force);
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t k = 0; k < 4; ++k) flow.sensitivity[row][k] = y[4 + 4 * k + row];
  }
  return flow;
}

}  // namespace snare::validation
