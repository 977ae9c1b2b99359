#include "coupling/contact/revolved_solids.hpp"

#include "base/errors.hpp"
#include "tests/support/derivatives.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

namespace snare::coupling {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using ::testing::HasSubstr;
using Shape = std::shared_ptr<const ContactShape>;

constexpr double pi = std::numbers::pi;

/// A shape with what is known of it by other means: points on its surface at most `spacing` apart, and what
/// is inside.
struct Sampled {
  std::string name;
  Shape shape;
  std::vector<Vector3d> surface;
  double spacing = 0.0;
  std::function<bool(const Vector3d&)> inside;
};

/// Turns a chain of points (distance from the axis, height) about the axis, both ways at most `spacing`
/// apart.
std::vector<Vector3d> revolve(const std::vector<Vector2d>& chain, double spacing) {
  std::vector<Vector3d> points;
  for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
    const Vector2d way = chain[k + 1] - chain[k];
    const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / spacing)));
    for (int i = 0; i <= steps; ++i) {
      const Vector2d p = chain[k] + way * i / steps;
      const int around = std::max(1, static_cast<int>(std::ceil(2.0 * pi * p.x() / spacing)));
      for (int j = 0; j < around; ++j) {
        const double a = 2.0 * pi * j / around;
        points.emplace_back(p.x() * std::cos(a), p.x() * std::sin(a), p.y());
      }
    }
  }
  return points;
}

/// Points of an arc about a centre.
std::vector<Vector2d> arc(const Vector2d& centre, double radius, double from, double to) {
  std::vector<Vector2d> points;
  for (int k = 0; k <= 200; ++k) {
    const double a = from + (to - from) * k / 200.0;
    points.emplace_back(centre + radius * Vector2d(std::cos(a), std::sin(a)));
  }
  return points;
}

double radius_of(const Vector3d& p) {
  return std::hypot(p.x(), p.y());
}

// All of a size of one, so that differences are at their best.
std::vector<Sampled> sampled_shapes() {
  constexpr double spacing = 0.02;
  std::vector<Sampled> list;
  const std::vector<Vector2d> ball = arc({0.0, 0.0}, 0.7, -0.5 * pi, 0.5 * pi);
  list.push_back({"sphere", std::make_shared<Ball>(0.7), revolve(ball, spacing), spacing,
                  [](const Vector3d& p) { return p.norm() < 0.7; }});
  std::vector<Vector2d> capsule = arc({0.0, -0.5}, 0.3, -0.5 * pi, 0.0);
  for (const Vector2d& p : arc({0.0, 0.5}, 0.3, 0.0, 0.5 * pi)) capsule.push_back(p);
  list.push_back({"capsule", std::make_shared<Capsule>(0.3, 1.0), revolve(capsule, spacing), spacing,
                  [](const Vector3d& p) {
                    return (p - Vector3d(0.0, 0.0, std::clamp(p.z(), -0.5, 0.5))).norm() < 0.3;
                  }});
  list.push_back({"knife edge", std::make_shared<Capsule>(0.0, 1.0),
                  revolve({{0.0, -0.5}, {0.0, 0.5}}, spacing), spacing,
                  [](const Vector3d&) { return false; }});
  list.push_back({"cylinder", finite_cylinder(0.5, 1.2),
                  revolve({{0.0, -0.6}, {0.5, -0.6}, {0.5, 0.6}, {0.0, 0.6}}, spacing), spacing,
                  [](const Vector3d& p) { return radius_of(p) < 0.5 && std::abs(p.z()) < 0.6; }});
  list.push_back(
      {"truncated cone", truncated_cone(0.6, 0.2, 1.0),
       revolve({{0.0, -0.5}, {0.6, -0.5}, {0.2, 0.5}, {0.0, 0.5}}, spacing), spacing,
       [](const Vector3d& p) { return std::abs(p.z()) < 0.5 && radius_of(p) < 0.4 - 0.4 * p.z(); }});
  list.push_back(
      {"full cone", truncated_cone(0.6, 0.0, 1.0), revolve({{0.0, -0.5}, {0.6, -0.5}, {0.0, 0.5}}, spacing),
       spacing, [](const Vector3d& p) { return std::abs(p.z()) < 0.5 && radius_of(p) < 0.3 - 0.6 * p.z(); }});
  // A cam of chord (0.6, 1.0) to (0.6, 0.4) rotated: the arc's circle is found here from its three points.
  GrappleShaft g;
  g.shaft_radius = 0.3;
  g.shaft_length = 1.0;
  g.cam_radius = 0.6;
  g.underside_length = 0.3;
  g.cam_length = 0.8;
  g.end_radius = 0.2;
  g.bulge = 0.1;
  const Vector2d a(0.6, 1.3), c(0.2, 2.1);
  const Vector2d way = (c - a).normalized();
  const Vector2d b = 0.5 * (a + c) + 0.1 * Vector2d(way.y(), -way.x());
  // The centre is as far from b as from a.
  const Vector2d up = (0.5 * (a + c) - b).normalized();
  const double radius = (a - b).squaredNorm() / (2.0 * up.dot(a - b));
  const Vector2d centre = b + radius * up;
  const auto angle = [&centre](const Vector2d& p) {
    return std::atan2(p.y() - centre.y(), p.x() - centre.x());
  };
  std::vector<Vector2d> shaft{{0.0, 0.0}, {0.3, 0.0}, {0.3, 1.0}};
  for (const Vector2d& p : arc(centre, radius, angle(a), angle(c))) shaft.push_back(p);
  shaft.emplace_back(0.0, 2.1);
  list.push_back({"grapple shaft", grapple_shaft(g), revolve(shaft, spacing), spacing,
                  [centre, radius](const Vector3d& p) {
                    const double r = radius_of(p), z = p.z();
                    if (z < 0.0 || z > 2.1) return false;
                    if (z < 1.0) return r < 0.3;
                    if (z < 1.3) return r < 0.3 + (z - 1.0);
                    return r < centre.x() + std::sqrt(radius * radius - (z - centre.y()) * (z - centre.y()));
                  }});
  // A waist: a concave arc of radius 0.5 between two rims.
  std::vector<Vector2d> waist{{0.0, -0.4}, {0.6, -0.4}};
  for (const Vector2d& p : arc({0.9, 0.0}, 0.5, pi + std::asin(0.8), pi - std::asin(0.8))) waist.push_back(p);
  waist.emplace_back(0.0, 0.4);
  list.push_back({"waist",
                  std::make_shared<RevolvedShape>(
                      Profile({0.0, -0.4}, {{{0.6, -0.4}, 0.0}, {{0.6, 0.4}, -2.0}, {{0.0, 0.4}, 0.0}})),
                  revolve(waist, spacing), spacing, [](const Vector3d& p) {
                    const double r = radius_of(p);
                    return std::abs(p.z()) < 0.4 && r < 0.6 && std::hypot(r - 0.9, p.z()) > 0.5;
                  }});
  list.push_back(
      {"cup", cup({.inner_radius = 0.5, .depth = 0.6, .thickness = 0.2}),
       revolve({{0.0, -0.2}, {0.7, -0.2}, {0.7, 0.6}, {0.5, 0.6}, {0.5, 0.0}, {0.0, 0.0}}, spacing), spacing,
       [](const Vector3d& p) {
         return p.z() > -0.2 && p.z() < 0.6 && radius_of(p) < 0.7 && (p.z() < 0.0 || radius_of(p) > 0.5);
       }});
  // A ring rounded to half its wall: all within 0.15 of a cylinder's wall.
  std::vector<Vector2d> ring{{0.4, -0.25}};
  for (const Vector2d& p : arc({0.55, -0.25}, 0.15, -pi, 0.0)) ring.push_back(p);
  for (const Vector2d& p : arc({0.55, 0.25}, 0.15, 0.0, pi)) ring.push_back(p);
  ring.emplace_back(0.4, -0.25);
  list.push_back(
      {"ring", hollow_cylinder(0.4, 0.7, 0.8, 0.15), revolve(ring, spacing), spacing, [](const Vector3d& p) {
         return std::hypot(radius_of(p) - 0.55, p.z() - std::clamp(p.z(), -0.25, 0.25)) < 0.15;
       }});
  return list;
}

TEST(ContactShapes, DistanceIsThatToTheSampledSurface) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-1.2, 1.2);
  for (const Sampled& s : sampled_shapes()) {
    int inside = 0;
    for (int k = 0; k < 60; ++k) {
      Vector3d p(place(random), place(random), place(random));
      if (s.name == "grapple shaft") p.z() += 1.2;
      if (k % 4 == 0) p *= 0.3;  // some more of them inside
      double brute = 1e9;
      for (const Vector3d& q : s.surface) brute = std::min(brute, (p - q).norm());
      const double d = s.shape->distance(p);
      inside += s.inside(p) ? 1 : 0;
      EXPECT_EQ(d < 0.0, s.inside(p)) << s.name << ' ' << p.transpose();
      EXPECT_DOUBLE_EQ(d, s.shape->at(p).distance) << s.name;
      // A sample is at most half a diagonal of the grid beside the foot, and not nearer than it.
      const double beside = 0.5 * std::numbers::sqrt2 * s.spacing;
      EXPECT_GE(brute, std::abs(d) - 1e-4)
          << s.name << ' ' << p.transpose();  // 1e-4: chords of the sampled arcs
      EXPECT_LE(brute, std::abs(d) + beside) << s.name << ' ' << p.transpose();
    }
    EXPECT_GT(inside, s.name == "knife edge" ? -1 : 3) << s.name;
  }
}

TEST(ContactShapes, AreDrawnOnTheirSurface) {
  for (const Sampled& shape : sampled_shapes()) {
    const std::vector<Eigen::Matrix3Xd> lines = shape.shape->drawing();
    ASSERT_FALSE(lines.empty()) << shape.name;
    Eigen::AlignedBox3d box;
    for (const Eigen::Matrix3Xd& line : lines) {
      ASSERT_GE(line.cols(), 2) << shape.name;
      for (const auto& p : line.colwise()) {
        EXPECT_LT(std::abs(shape.shape->distance(p)), 1e-12) << shape.name;
        box.extend(Vector3d(p));
      }
    }
    EXPECT_GT(box.sizes().maxCoeff(), 0.1) << shape.name;
  }
}

TEST(ContactShapes, DerivativesMatchDifferences) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1.2, 1.2);
  for (const Sampled& s : sampled_shapes()) {
    int compared = 0;
    for (int k = 0; k < 200 && compared < 40; ++k) {
      Vector3d p(place(random), place(random), place(random));
      if (s.name == "grapple shaft") p.z() += 1.2;
      if (s.inside(p)) continue;
      const DistanceField f = s.shape->at(p);
      EXPECT_NEAR(f.normal.norm(), 1.0, 1e-14) << s.name;
      EXPECT_LT((f.hessian - f.hessian.transpose()).norm(), 1e-12) << s.name;
      EXPECT_LT((f.hessian * f.normal).norm(), 1e-12) << s.name;  // of a gradient that stays unit
      // Where the nearest feature changes within the differences the Hessian jumps; not there.
      bool changes = false;
      for (int a = 0; a < 6; ++a) {
        const Vector3d q = p + (a % 2 == 0 ? 0.03 : -0.03) * Vector3d::Unit(a / 2);
        changes = changes || (s.shape->at(q).hessian - f.hessian).norm() > 0.25 * (1.0 + f.hessian.norm());
      }
      if (changes || std::abs(f.distance) < 0.1 || radius_of(p) < 0.1) continue;
      ++compared;
      const auto value = [&s](const VectorXd& x) { return s.shape->distance(x); };
      const auto slope = [&s](const VectorXd& x) -> VectorXd { return s.shape->at(x).normal; };
      const test::DerivativeError first = test::compare_gradient(value, p, f.normal, 0.01);
      EXPECT_LT(first.relative, 1e-9) << s.name << ' ' << p.transpose() << ' ' << first.worst;
      if (f.hessian.norm() == 0.0) {
        EXPECT_EQ((s.shape->at(p + Vector3d(1e-3, 2e-3, -1e-3)).normal - f.normal).norm(), 0.0) << s.name;
        continue;
      }
      const test::DerivativeError second = test::compare_jacobian(slope, p, f.hessian, 0.01);
      EXPECT_LT(second.relative, 1e-8) << s.name << ' ' << p.transpose() << ' ' << second.worst;
    }
    EXPECT_GE(compared, 20) << s.name;
  }
}

TEST(ContactShapes, TurnAboutTheirAxisWithoutChange) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.83, Vector3d::UnitZ()).toRotationMatrix();
  for (const Sampled& s : sampled_shapes()) {
    const Vector3d p(0.61, -0.43, 0.77);
    const DistanceField before = s.shape->at(p);
    const DistanceField after = s.shape->at(turn * p);
    EXPECT_NEAR(before.distance, after.distance, 1e-15) << s.name;
    EXPECT_LT((turn * before.normal - after.normal).norm(), 1e-14) << s.name;
    EXPECT_LT((turn * before.hessian * turn.transpose() - after.hessian).norm(), 1e-13) << s.name;
  }
}

TEST(ContactShapes, AreOnceDifferentiableAcrossARim) {
  // Round the rim of a cylinder at the wire's radius: no jump of distance or normal, curvature 1/radius at
  // the rim.
  const Shape cylinder = finite_cylinder(0.5, 1.0);
  constexpr double radius = 0.05;
  const Vector3d rim(0.5, 0.0, 0.5);
  const auto at = [&](double angle) {
    return cylinder->at(rim + radius * Vector3d(std::cos(angle), 0.0, std::sin(angle)));
  };
  for (double angle : {0.0, 0.5 * pi}) {
    const DistanceField before = at(angle - 1e-9), after = at(angle + 1e-9);
    EXPECT_NEAR(before.distance, after.distance, 1e-12);
    EXPECT_LT((before.normal - after.normal).norm(), 1e-8);
  }
  EXPECT_NEAR(at(0.7).distance, radius, 1e-15);
  EXPECT_NEAR(at(0.7).hessian.trace(), 1.0 / radius + std::cos(0.7) / (0.5 + radius * std::cos(0.7)), 1e-9);
  EXPECT_NEAR(at(-0.2).hessian.trace(), 1.0 / (0.5 + radius * std::cos(-0.2)), 1e-9);  // beside the wall
  EXPECT_EQ(at(0.5 * pi + 0.2).hessian.norm(), 0.0);                                   // above the flat end
}

TEST(ContactShapes, KnowTheirAxis) {
  // On the axis of a ball-ended profile: the limit of both curvatures.
  const double k = 1.0 / 0.8;
  const RevolvedShape ball(Profile({0.0, -0.8}, {{{0.8, 0.0}, k}, {{0.0, 0.8}, k}}));
  const Ball same(0.8);
  for (const Vector3d& p : {Vector3d(0.0, 0.0, 1.1), Vector3d(1e-9, 0.0, 1.1), Vector3d(0.3, 0.4, -0.9)}) {
    EXPECT_NEAR(ball.distance(p), same.distance(p), 1e-15);
    EXPECT_LT((ball.at(p).hessian - same.at(p).hessian).norm(), 1e-8) << p.transpose();
  }
}

TEST(ContactShapes, WrongProfilesAreNamed) {
  using Edges = std::vector<ProfileEdge>;
  const std::tuple<Vector2d, Edges, const char*> wrong[] = {
      {{0.0, 0.0}, Edges{{{0.0, 1.0}, 0.0}}, "profile = 1 edges, must have two or more"},
      {{0.0, 0.0},
       Edges{{{-1.0, 0.0}, 0.0}, {{0.0, 1.0}, 0.0}},
       "profile[1] = (-1, 0), must be finite and right of the axis"},
      {{0.0, 0.0},
       Edges{{{1.0, 0.0}, 0.0}, {{1.0, 0.0}, 0.0}, {{0.0, 1.0}, 0.0}},
       "profile[2] = (1, 0), must not be where the edge begins"},
      {{0.0, 0.0},
       Edges{{{1.0, 0.0}, 0.0}, {{0.5, 1.0}, 0.0}},
       "profile[2] = (0.5, 1), must end on the axis"},
      {{0.0, 0.0},
       Edges{{{1.0, 0.0}, 0.0}, {{1.0, 2.0}, 1.5}, {{0.0, 2.0}, 0.0}},
       "needs a radius of curvature of half its chord of 2 m"},
      {{0.0, 0.0}, Edges{{{1.0, 0.0}, 0.0}, {{0.0, -1.0}, 0.0}}, "must run upward"},
      {{1.0, 0.0},
       Edges{{{2.0, 0.0}, 0.0}, {{1.0, 1.0}, 0.0}},
       "profile[2] = (1, 1), must end where it began"},
      {{-1.0, 0.0}, Edges{{{2.0, 0.0}, 0.0}, {{0.0, 1.0}, 0.0}}, "must begin on the axis or right of it"},
      {{0.0, 0.0},
       Edges{{{1.0, 0.0}, 0.0}, {{1.0, 1.0}, 0.0}, {{0.5, -1.0}, 0.0}, {{0.5, 2.0}, 0.0}, {{0.0, 2.0}, 0.0}},
       "must not cross itself"},
  };
  for (const auto& one : wrong) {
    const auto make = [&] {
      return std::make_from_tuple<Profile>(std::tie(std::get<0>(one), std::get<1>(one)));
    };
    EXPECT_THAT(test::refusal(make), HasSubstr(std::get<2>(one)));
  }
  GrappleShaft shaft;
  shaft.cam_radius = 5e-3;
  shaft.bulge = 1.0;
  const std::string said = test::refusal([&] { return grapple_shaft(shaft); });
  EXPECT_THAT(said, HasSubstr("grapple shaft cam_radius = 0.005, must be > shaft_radius"));
  EXPECT_THAT(said, HasSubstr("grapple shaft bulge = 1, must be >= 0 and <= "));
}

}  // namespace
}  // namespace snare::coupling
