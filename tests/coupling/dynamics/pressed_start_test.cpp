#include "coupling/dynamics/run/pressed_start.hpp"

#include "coupling/dynamics/model/start.hpp"
#include "wire/specification.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::coupling {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double ring = 0.1, length = 0.2, wire_radius = 0.75e-3;
const double open = 115.0 * std::numbers::pi / 180.0;

/// A wire of a snare that is open: between pins on a ring.
wire::RodInMotion open_wire(int elements) {
  wire::RodInMotion rod;
  rod.length = length;
  rod.elements = elements;
  rod.mass_per_length = 0.014;
  rod.properties.bending_stiffness = rod.properties.second_bending_stiffness = 0.048;
  rod.properties.axial_stiffness = 3.4e5;
  rod.properties.torsional_stiffness = 0.037;
  rod.properties.left.kind = rod.properties.right.kind = wire::SpatialEnd::Kind::twisting_pin;
  const double span = 2.0 * ring * std::sin(0.5 * open);
  rod.properties.right.position = {span, 0.0, 0.0};
  return rod;
}

RoundWall wall_of(double inner) {
  RoundWall wall;
  wall.centre = {ring * std::sin(0.5 * open), -ring * std::cos(0.5 * open), 0.0};
  wall.inner_radius = inner;
  wall.outer_radius = inner + 0.005;
  wall.length = 0.06;
  return wall;
}

/// Half of an inextensible elastica from the middle on, about the wall's centre, y through the middle of the
/// wire: along a circle over an angle, then free as a force on its end bends it. State: x, y, tangent's
/// angle, curvature.
Vector4d end_of(double radius, double angle, const Vector2d& force) {
  constexpr int steps = 2000;
  const double free = 0.5 * length - radius * angle, h = free / steps, EI = 0.048;
  Vector4d s(radius * std::sin(angle), radius * std::cos(angle), -angle, -1.0 / radius);
  const auto rate = [&](const Vector4d& a) -> Vector4d {
    return {std::cos(a[2]), std::sin(a[2]), a[3],
            (force.x() * std::sin(a[2]) - force.y() * std::cos(a[2])) / EI};
  };
  for (int k = 0; k < steps; ++k) {
    const Vector4d k1 = rate(s), k2 = rate(s + 0.5 * h * k1), k3 = rate(s + 0.5 * h * k2),
                   k4 = rate(s + h * k3);
    s += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return s;
}

/// Angle over which the wire lies on the wall, to either side of its middle, and the force on its pin: by
/// Newton's method from where the pin is and no couple acts.
Vector3d lying(double radius) {
  const auto miss = [&](const Vector3d& u) -> Vector3d {
    const Vector4d e = end_of(radius, u[0], u.tail<2>());
    return {(e[0] - ring * std::sin(0.5 * open)) / ring, (e[1] - ring * std::cos(0.5 * open)) / ring,
            e[3] * ring};
  };
  Vector3d u(0.3, -5.0, 5.0);
  for (int k = 0; k < 60; ++k) {
    const Vector3d f = miss(u);
    Eigen::Matrix3d J;
    for (int i = 0; i < 3; ++i) {
      Vector3d v = u;
      const double step = i == 0 ? 1e-6 : 1e-4;
      v[i] += step;
      J.col(i) = (miss(v) - f) / step;
    }
    const Vector3d by = J.fullPivLu().solve(f);
    u -= by * std::min(1.0, 0.2 / std::max(std::abs(by[0]), by.tail<2>().norm() / 20.0));
  }
  EXPECT_LT(miss(u).norm(), 1e-9);
  return u;
}

TEST(PressedStart, IsTheElasticaThatLiesOnItsWall) {
  const double inner = 0.1012, radius = inner - wire_radius;
  const Vector3d u = lying(radius);
  ASSERT_GT(u[0], 0.05);
  const RoundWall wall = wall_of(inner);
  for (const int elements : {40, 80}) {
    const Eigen::Matrix3Xd x = pressed_wire(open_wire(elements), wire_radius, wall);
    // Of every vertex, what the elastica has at its arc length.
    double worst = 0.0;
    for (int i = elements / 2; i <= elements; ++i) {
      const double s = length * i / elements - 0.5 * length;
      const double phi = std::min(u[0], s / radius);
      Vector2d p(radius * std::sin(phi), radius * std::cos(phi));
      if (s > radius * u[0]) {
        // The free part up to there.
        Vector4d a(radius * std::sin(u[0]), radius * std::cos(u[0]), -u[0], -1.0 / radius);
        constexpr int steps = 400;
        const double h = (s - radius * u[0]) / steps;
        const auto rate = [&](const Vector4d& b) -> Vector4d {
          return {std::cos(b[2]), std::sin(b[2]), b[3],
                  (u[1] * std::sin(b[2]) - u[2] * std::cos(b[2])) / 0.048};
        };
        for (int k = 0; k < steps; ++k) {
          const Vector4d k1 = rate(a), k2 = rate(a + 0.5 * h * k1), k3 = rate(a + 0.5 * h * k2),
                         k4 = rate(a + h * k3);
          a += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
        p = a.head<2>();
      }
      worst = std::max(worst, ((x.col(i) - wall.centre).head<2>() - p).norm());
      EXPECT_NEAR(x(2, i), 0.0, 1e-9);
    }
    EXPECT_LT(worst, 2e-5);  // of a bow of 1.2 mm beyond the ring
    EXPECT_LE((x.colwise() - wall.centre).colwise().norm().maxCoeff(), radius + 1e-8);
  }
}

TEST(PressedStart, OfAWireThatClearsItsWallIsItsRest) {
  const wire::RodInMotion rod = open_wire(40);
  EXPECT_EQ(pressed_wire(rod, wire_radius, wall_of(0.12)), resting_wire(rod));
}

TEST(PressedStart, NeedsRoomForTheArc) {
  wire::RodInMotion rod = open_wire(40);
  rod.length = 0.21;  // longer than the ring's arc
  EXPECT_ANY_THROW(static_cast<void>(pressed_wire(rod, wire_radius, wall_of(0.1012))));
}

}  // namespace
}  // namespace snare::coupling
