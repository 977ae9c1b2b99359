#include "coupling/contact/mesh_shape.hpp"
#include "coupling/contact/revolved_solids.hpp"
#include "coupling/contact/union_shape.hpp"
#include "tests/support/derivatives.hpp"
#include "tests/support/mesh_files.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

/// Two flanges on a shaft, the groove between them with a fillet of 0.1 on either side.
Profile flanged_shaft() {
  return rounded_profile(
      {{0.0, 0.0}, {0.6, 0.0}, {0.6, 0.3}, {0.3, 0.3}, {0.3, 0.9}, {0.6, 0.9}, {0.6, 1.2}, {0.0, 1.2}},
      {0.0, 0.0, 0.05, 0.1, 0.1, 0.0, 0.0, 0.0});
}

double least(const std::vector<Shape>& pieces, const Vector3d& p) {
  double d = 1e9;
  for (const Shape& piece : pieces) d = std::min(d, piece->distance(p));
  return d;
}

TEST(ShapePieces, AConvexShapeIsItsOwn) {
  for (const Shape& shape : {Shape(std::make_shared<Ball>(0.1)), Shape(std::make_shared<HalfSpace>(1.0)),
                             finite_cylinder(0.1, 0.3), truncated_cone(0.1, 0.2, 0.3)}) {
    ASSERT_EQ(pieces_of(shape).size(), 1u);
    EXPECT_EQ(pieces_of(shape)[0], shape);
  }
  // Nor has a ring a concave corner.
  EXPECT_EQ(pieces_of(hollow_cylinder(0.1, 0.2, 0.3, 0.0)).size(), 1u);
}

TEST(ShapePieces, ShaftAndCamHaveEachAGapAndANormalInTheirCorner) {
  constexpr double r = 1e-3;
  for (const double underside : {6e-3, 0.0}) {
    GrappleShaft g;
    g.underside_length = underside;
    const std::vector<Shape> pieces = pieces_of(grapple_shaft(g), r);
    ASSERT_EQ(pieces.size(), 2u);
    // Where a wire seats: its radius off the shaft, and off the cone (of 45 degrees, or the flat underside).
    const double below = underside > 0.0 ? r * std::tan(pi / 8.0) : r;
    const Vector3d seat(g.shaft_radius + r, 0.0, g.shaft_length - below);
    const Vector3d cone =
        underside > 0.0 ? Vector3d(std::sqrt(0.5), 0.0, -std::sqrt(0.5)) : Vector3d(0.0, 0.0, -1.0);
    const DistanceField shaft = pieces[0]->at(seat);
    const DistanceField cam = pieces[1]->at(seat);
    EXPECT_NEAR(shaft.distance, r, 1e-15);
    EXPECT_LT((shaft.normal - Vector3d::UnitX()).norm(), 1e-15);
    EXPECT_NEAR(cam.distance, r, 1e-15);
    EXPECT_LT((cam.normal - cone).norm(), 1e-12);
    // Along the corner each bends as its own surface does: 1/rho, and across the cone n_rho/rho.
    EXPECT_NEAR(shaft.hessian(1, 1), 1.0 / seat.x(), 1e-9);
    EXPECT_NEAR(cam.hessian(1, 1), cone.x() / seat.x(), 1e-9);
  }
}

TEST(ShapePieces, TheirLeastDistanceIsTheSolids) {
  const std::vector<std::pair<std::string, Shape>> solids{
      {"shaft", grapple_shaft({0.3, 1.0, 0.6, 0.3, 0.8, 0.2, 0.1})},
      {"cup", cup({.inner_radius = 0.5, .depth = 0.6, .thickness = 0.2, .rounding = 0.05, .fillet = 0.1})},
      {"thin cup", cup({.inner_radius = 0.5, .depth = 0.6, .thickness = 0.01})},
      {"flanges", std::make_shared<RevolvedShape>(flanged_shaft())},
      {"beads",
       std::make_shared<RevolvedShape>(Profile(
           {0.0, -0.5}, {{{0.5, 0.0}, 2.0}, {{0.3, 0.4}, 2.0}, {{0.5, 0.8}, 2.0}, {{0.0, 1.3}, 2.0}}))}};
  std::mt19937 random(23);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  for (const auto& [name, solid] : solids) {
    for (const double r : {0.0, 0.08, 0.15}) {
      const std::vector<Shape> pieces = pieces_of(solid, r);
      int outside = 0;
      for (int k = 0; k < 2000; ++k) {
        const Vector3d p(place(random), place(random), 0.5 + 1.2 * place(random));
        const double exact = solid->distance(p);
        if (exact > r) {
          EXPECT_NEAR(least(pieces, p), exact, 1e-15) << name << ' ' << r << ' ' << p.transpose();
        }
        if (exact < 0.0 && r == 0.0) {
          EXPECT_LT(least(pieces, p), 0.0) << name << ' ' << p.transpose();
        }
        if (exact <= r) continue;
        ++outside;
        for (const Shape& piece : pieces) {
          // No piece goes through the solid's own surface, and none changes faster than the way (G.7).
          const Vector3d q =
              p + 0.5 * exact * Vector3d(place(random), place(random), place(random)).normalized();
          EXPECT_GE(piece->distance(p), exact - 1e-15) << name;
          EXPECT_LE(std::abs(piece->distance(p) - piece->distance(q)), (p - q).norm() + 1e-15) << name;
          EXPECT_DOUBLE_EQ(piece->at(p).distance, piece->distance(p)) << name;
        }
      }
      EXPECT_GT(outside, 500) << name;
    }
  }
}

TEST(ShapePieces, AreOnceDifferentiableWhereAWireCanLie) {
  // Along the surface on which the axis of a wire moves: where a piece is touched its normal does not jump.
  constexpr double r = 0.05;
  const Profile profile = flanged_shaft();
  const Shape solid = std::make_shared<RevolvedShape>(profile);
  const std::vector<Shape> pieces = pieces_of(solid, r);
  ASSERT_EQ(pieces.size(), 1u);  // fillets of 0.1 let the wire in: everything is smooth
  const std::vector<Shape> thick = pieces_of(solid, 0.12);
  ASSERT_EQ(thick.size(), 3u);  // and do not let this one in: flange, shaft, flange
  std::mt19937 random(7);
  std::uniform_real_distribution<double> rho(0.31, 1.0);
  std::uniform_real_distribution<double> height(-0.3, 1.5);
  for (const auto& [list, radius] : {std::pair(pieces, r), std::pair(thick, 0.12)}) {
    for (const Shape& piece : list) {
      int met = 0;
      for (int k = 0; k < 20000; ++k) {
        // Down to the wire's distance from wherever it is.
        Vector3d p(rho(random), 0.0, height(random));
        for (int i = 0; i < 50; ++i) {
          const DistanceField f = solid->at(p);
          p -= (f.distance - radius) * f.normal;
        }
        if (std::abs(solid->distance(p) - radius) > 1e-9 || std::abs(piece->distance(p) - radius) > 1e-9)
          continue;
        ++met;
        const DistanceField at = piece->at(p);
        constexpr double h = 1e-7;
        for (const Vector3d& way : {Vector3d(at.normal.z(), 0.0, -at.normal.x()), at.normal}) {
          const Vector3d jump = piece->at(p + h * way).normal - piece->at(p - h * way).normal;
          EXPECT_LT(jump.norm(), 2.5 * h / r)
              << p.transpose();  // curvature at most 1/r, where a rim is sharp
        }
      }
      EXPECT_GT(met, 100);
    }
  }
}

TEST(ShapePieces, DerivativesMatchDifferences) {
  std::mt19937 random(29);
  std::uniform_real_distribution<double> place(-0.8, 0.8);
  for (const Shape& solid : {grapple_shaft({0.3, 1.0, 0.6, 0.3, 0.8, 0.2, 0.1}),
                             cup({.inner_radius = 0.5, .depth = 0.6, .thickness = 0.2})}) {
    for (const Shape& piece : pieces_of(solid)) {
      int compared = 0;
      for (int k = 0; k < 4000 && compared < 40; ++k) {
        const Vector3d p(place(random), place(random), 0.6 + place(random));
        const DistanceField f = piece->at(p);
        if (solid->distance(p) < 0.05 || std::hypot(p.x(), p.y()) < 0.1) continue;
        bool changes = false;
        for (int a = 0; a < 6; ++a) {
          const DistanceField g = piece->at(p + (a % 2 == 0 ? 0.03 : -0.03) * Vector3d::Unit(a / 2));
          changes = changes || (g.hessian - f.hessian).norm() > 0.25 * (1.0 + f.hessian.norm()) ||
                    (g.normal - f.normal).norm() > 0.5;
        }
        if (changes) continue;
        ++compared;
        const auto value = [&piece](const VectorXd& x) { return piece->distance(x); };
        const auto slope = [&piece](const VectorXd& x) -> VectorXd { return piece->at(x).normal; };
        EXPECT_LT(test::compare_gradient(value, p, f.normal, 0.01).relative, 1e-8) << p.transpose();
        if (f.hessian.norm() > 0.0) {
          EXPECT_LT(test::compare_jacobian(slope, p, f.hessian, 0.01).relative, 1e-6) << p.transpose();
        }
      }
      EXPECT_GE(compared, 20);
    }
  }
}

TEST(ShapePieces, TessellatedCupIsTheCupWithinItsTessellation) {
  constexpr int around = 128;
  const Shape solid = cup({.inner_radius = 0.5, .depth = 0.6, .thickness = 0.2});
  const MeshShape mesh(test::revolved_mesh(
      {{0.0, -0.2}, {0.7, -0.2}, {0.7, 0.6}, {0.5, 0.6}, {0.5, 0.0}, {0.0, 0.0}}, around));
  EXPECT_EQ(mesh.pieces(0.0).size(), 0u);  // not convex, and yet one
  const std::vector<Shape> pieces = pieces_of(solid);
  ASSERT_EQ(pieces.size(), 2u);
  std::mt19937 random(31);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  const double sagitta = 0.7 * (1.0 - std::cos(pi / around));  // of the chords
  for (int k = 0; k < 1000; ++k) {
    const Vector3d p(place(random), place(random), 0.2 + place(random));
    EXPECT_NEAR(mesh.distance(p), solid->distance(p), 1.5 * sagitta) << p.transpose();
    if (solid->distance(p) > 0.0) {
      EXPECT_NEAR(mesh.distance(p), least(pieces, p), 1.5 * sagitta) << p.transpose();
    }
  }
}

TEST(InteriorWalls, GapOfAWireAlongAHousing) {
  // From inside: R - rho; the Hessian is that of a hollow wall, -1/rho around the axis.
  const Shape ring = hollow_cylinder(0.5, 0.52, 1.0, 0.01);
  const Vector3d p(0.3, 0.4 * 0.75, 0.2);
  const double rho = std::hypot(p.x(), p.y());
  const DistanceField f = ring->at(p);
  EXPECT_NEAR(f.distance, 0.5 - rho, 1e-15);
  EXPECT_LT((f.normal + Vector3d(p.x(), p.y(), 0.0) / rho).norm(), 1e-15);
  EXPECT_NEAR(f.hessian.trace(), -1.0 / rho, 1e-13);
  // In the corner of a cup: wall and floor.
  const std::vector<Shape> pieces =
      pieces_of(cup({.inner_radius = 0.5, .depth = 0.3, .thickness = 0.02}), 0.01);
  ASSERT_EQ(pieces.size(), 2u);
  const Vector3d seat(0.49, 0.0, 0.01);
  EXPECT_NEAR(pieces[0]->distance(seat), 0.01, 1e-15);
  EXPECT_LT((pieces[0]->at(seat).normal + Vector3d::UnitX()).norm(), 1e-13);
  EXPECT_NEAR(pieces[1]->distance(seat), 0.01, 1e-15);
  EXPECT_LT((pieces[1]->at(seat).normal - Vector3d::UnitZ()).norm(), 1e-13);
}

TEST(InteriorWalls, AFilletIsTouchedByWiresThatFitIntoIt) {
  const Shape filleted = cup({.inner_radius = 0.5, .depth = 0.3, .thickness = 0.02, .fillet = 0.05});
  const Vector3d centre(0.45, 0.0, 0.05);
  const Vector3d p = centre + 0.03 * Vector3d(std::cos(0.3), 0.0, -std::sin(0.3));
  ASSERT_EQ(pieces_of(filleted, 0.02).size(), 1u);
  EXPECT_NEAR(filleted->distance(p), 0.02, 1e-15);
  EXPECT_LT((filleted->at(p).normal - (centre - p) / 0.03).norm(), 1e-13);
  // A thicker one touches wall and floor.
  const std::vector<Shape> pieces = pieces_of(filleted, 0.06);
  ASSERT_EQ(pieces.size(), 2u);
  for (const Shape& piece : pieces) EXPECT_NEAR(piece->distance({0.44, 0.0, 0.06}), 0.06, 1e-15);
}

TEST(UnionShapes, AreTheLeastOfTheirPieces) {
  // A ball half sunk into the ground.
  const UnionShape both({std::make_shared<HalfSpace>(1.0), std::make_shared<Ball>(0.5)});
  EXPECT_NEAR(both.distance({0.0, 0.0, 0.8}), 0.3, 1e-15);
  EXPECT_NEAR(both.at({2.0, 0.0, 0.1}).distance, 0.1, 1e-15);
  EXPECT_EQ(both.at({2.0, 0.0, 0.1}).normal, Vector3d::UnitZ());
  EXPECT_EQ(both.smallest_radius(), 0.5);
  EXPECT_EQ(both.pieces(0.0).size(), 2u);
  EXPECT_EQ(both.drawing().size(), 5u);
  // The pieces of its shapes are its own.
  const UnionShape more({std::make_shared<Ball>(0.1), grapple_shaft({})});
  EXPECT_EQ(more.pieces(1e-3).size(), 3u);
  EXPECT_EQ(more.distance({0.0, 0.0, 0.5}), std::min(0.4, grapple_shaft({})->distance({0.0, 0.0, 0.5})));
}

TEST(UnionShapes, WrongWallsAreNamed) {
  EXPECT_THAT(test::refusal([] { return hollow_cylinder(0.5, 0.4, 1.0, 0.0); }),
              HasSubstr("ring outer_radius = 0.4, must be > inner_radius"));
  EXPECT_THAT(test::refusal([] { return hollow_cylinder(0.4, 0.5, 1.0, 0.06); }),
              HasSubstr("ring rounding = 0.06, must be"));
  EXPECT_THAT(
      test::refusal([] { return cup({.inner_radius = 0.5, .depth = 0.1, .thickness = 0.0, .fillet = 0.2}); }),
      testing::AllOf(HasSubstr("cup thickness = 0, must be > 0"), HasSubstr("cup fillet = 0.2, must be")));
  EXPECT_THAT(
      test::refusal([] {
        return rounded_profile({{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}, {0.1, 5.0, 0.0});
      }),
      testing::AllOf(HasSubstr("rounding[1] = 0.1, must be 0 on the axis"),
                     HasSubstr("rounding[2] = 5, the arcs at the ends of the side before it must fit")));
}

}  // namespace
}  // namespace snare::coupling
