// Large deflection of cantilevers by both rods, beside closed forms.

#include "tests/support/loaded_rod.hpp"
#include "validation/elastica.hpp"
#include "wire/spatial_rod.hpp"
#include "wire/statics/equilibrium.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace snare::wire {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kForce = 2.0;  // F L^2/EI: the tip turns by 0.8 rad

// The closed form is inextensible; with EA = 1e7 EI/L^2 the wire strains by F/EA = 2e-7 at most.
constexpr double kAxialStiffness = 1e7;
constexpr double kExtension = 2e-7;

constexpr Controls kUnit{0.0, 0.5, 1.0};

Vector2d planar_tip(int half_edges) {
  PlanarRodProperties p;
  p.bending_stiffness = 1.0;
  p.axial_stiffness = kAxialStiffness;
  p.right.kind = PlanarEnd::Kind::free;
  const test::TipLoadedRod<PlanarRod> rod(PlanarRod(MaterialMesh(half_edges, half_edges, 0.0), p),
                                          {0.0, kForce});
  PlanarState state;
  state.controls = kUnit;
  state.q = Eigen::VectorXd::Zero(rod.rod().unknowns());
  for (int i = 0; i <= 2 * half_edges; ++i) state.q[2 * i] = rod.mesh().coordinate(i, kUnit);
  const EquilibriumReport report = find_equilibrium(rod, state);
  EXPECT_TRUE(report.usable()) << report.message;
  EXPECT_EQ(report.negative_pivots, 0);
  return vertex(state, 2 * half_edges);
}

// The same in a plane turned out of the coordinate planes, with a twist of the clamp that must not matter.
Vector2d spatial_tip(int half_edges, double clamp_angle) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.9, Vector3d(1.0, -2.0, 0.7).normalized()).toRotationMatrix();
  SpatialRodProperties p;
  p.bending_stiffness = 1.0;
  p.second_bending_stiffness = 1.0;
  p.torsional_stiffness = 0.8;
  p.axial_stiffness = kAxialStiffness;
  p.left.direction = turn.col(0);
  p.left.director = turn.col(1);
  p.left.twist_angle = clamp_angle;
  p.right.kind = SpatialEnd::Kind::free;
  p.right.position = turn.col(0);
  const test::TipLoadedRod<SpatialRod> rod(SpatialRod(MaterialMesh(half_edges, half_edges, 0.0), p),
                                           kForce * turn.col(1));
  SpatialState state = rod.rod().straight_state(kUnit);
  const EquilibriumReport report = find_equilibrium(rod, state);
  EXPECT_TRUE(report.usable()) << report.message;
  EXPECT_EQ(report.negative_pivots, 0);
  const Vector3d tip = turn.transpose() * vertex(state, 2 * half_edges);
  EXPECT_NEAR(tip.z(), 0.0, 1e-9);  // stays in its plane: residual 1e-9 over the stiffness 3
  EXPECT_NEAR(rod.rod().torques(state).cwiseAbs().maxCoeff(), 0.0, 1e-8);
  return tip.head<2>();
}

void expect_tip(const std::array<Vector2d, 3>& tips) {
  const validation::CantileverTip exact = validation::cantilever_tip(1.0, 1.0, kForce);
  const auto deflection = test::extrapolate({tips[0].y(), tips[1].y(), tips[2].y()});
  const auto reach = test::extrapolate({tips[0].x(), tips[1].x(), tips[2].x()});
  // The third-order error of the clamp's half cell is still a tenth of the second-order one at 40 edges.
  EXPECT_NEAR(deflection.order, 2.0, 0.2);
  EXPECT_NEAR(reach.order, 2.0, 0.2);
  // Extension; the rest of the extrapolation is of fourth order, 1e-8.
  EXPECT_NEAR(deflection.limit, exact.deflection, 2.0 * kExtension);
  EXPECT_NEAR(reach.limit, 1.0 - exact.shortening, 2.0 * kExtension);
}

TEST(Cantilever, PlanarRodUnderATipForce) {
  expect_tip({planar_tip(20), planar_tip(40), planar_tip(80)});
}

TEST(Cantilever, SpatialRodUnderATipForce) {
  expect_tip({spatial_tip(20, 0.0), spatial_tip(40, 0.0), spatial_tip(80, 0.0)});
}

TEST(Cantilever, TwistOfTheClampDoesNotMatterForARoundRod) {
  EXPECT_LT((spatial_tip(10, 2.5) - spatial_tip(10, 0.0)).norm(),
            1e-9);  // residual 1e-9 over the stiffness 3
}

TEST(Cantilever, NaturalCurvatureMakesACircle) {
  // Three quarters of a turn towards a director that the clamp has turned by 0.6 rad. On a free, untwisted,
  // naturally curved rod every vertex turns by 2 atan(kappa h/2): an exact polygon, whose inner vertices lie
  // on a circle.
  SpatialRodProperties p;
  p.bending_stiffness = 1.0;
  p.second_bending_stiffness = 2.0;
  p.torsional_stiffness = 0.8;
  p.axial_stiffness = 1e4;
  p.natural_curvature = {4.7 * std::cos(0.6), -4.7 * std::sin(0.6)};
  p.left.twist_angle = 0.6;
  p.right.kind = SpatialEnd::Kind::free;
  p.right.position = Vector3d::UnitX();
  const int n = 40;
  const SpatialRod rod(MaterialMesh(n / 2, n / 2, 0.0), p);
  SpatialState state = rod.straight_state(kUnit);
  Eigen::VectorXd q = state.q;
  for (int e = 0; e < n; ++e) q[4 * e + 3] = 0.6;
  accept(state, q);
  const EquilibriumReport report = find_equilibrium(rod, state);
  ASSERT_TRUE(report.usable()) << report.message;
  const double step = 2.0 * std::atan(0.5 * 4.7 / n);
  Vector3d x = Vector3d::Zero();
  double angle = 2.0 * std::atan(0.25 * 4.7 / n);  // of the half cell
  for (int e = 0; e < n; ++e, angle += step) {
    x += Vector3d(std::cos(angle), std::sin(angle), 0.0) / n;
    EXPECT_LT((vertex(state, e + 1) - x).norm(), 1e-7)
        << e;  // residual 1e-10 (EI/L^2 + tension) over stiffness
  }
}

}  // namespace
}  // namespace snare::wire
