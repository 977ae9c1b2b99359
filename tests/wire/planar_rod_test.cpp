#include "wire/planar_rod.hpp"

#include "tests/support/random_rods.hpp"
#include "tests/support/rod_derivatives.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <random>

namespace snare::wire {
namespace {

constexpr Controls kControls{0.0, 0.45, 1.05};

TEST(PlanarRod, DerivativesMatchDifferences) {
  std::mt19937 random(20240601);
  for (const PlanarEnd::Kind kind : {PlanarEnd::Kind::clamp, PlanarEnd::Kind::pin, PlanarEnd::Kind::free}) {
    PlanarRodProperties p = test::planar_properties();
    p.left.kind = kind;
    const PlanarRod rod(MaterialMesh(4, 6, 0.8), p);
    SCOPED_TRACE(static_cast<int>(kind));
    test::expect_exact(test::check_rod_derivatives(rod, test::random_state(rod, kControls, random, 0.4)));
  }
}

TEST(PlanarRod, EnergyIsInvariantAndGradientTurnsWithTheRod) {
  std::mt19937 random(7);
  PlanarRodProperties p = test::planar_properties();
  p.left.kind = PlanarEnd::Kind::free;
  p.right.kind = PlanarEnd::Kind::free;
  p.weight.setZero();
  const PlanarRod rod(MaterialMesh(4, 6, 0.0), p);
  const PlanarState state = test::random_state(rod, kControls, random, 0.4);
  const Eigen::Rotation2Dd turn(1.3);
  PlanarState moved = state;
  RodAssembly at = test::assembled(rod, state);
  for (int i = 0; i < rod.mesh().vertices(); ++i) {
    moved.q.segment<2>(2 * i) = turn * vertex(state, i) + Eigen::Vector2d(0.4, -2.0);
    at.gradient.segment<2>(2 * i) = turn * Eigen::Vector2d(at.gradient.segment<2>(2 * i));
  }
  const RodAssembly there = test::assembled(rod, moved);
  EXPECT_NEAR(there.energy, at.energy,
              1e-12 * at.energy);  // coordinates of order 2 lose 4 eps an edge of 0.1
  EXPECT_LT((there.gradient - at.gradient).lpNorm<Eigen::Infinity>(),
            1e-11 * at.gradient.lpNorm<Eigen::Infinity>());  // round-off of the coordinates times EA/l0
}

TEST(PlanarRod, HeldRowsAreThoseOfTheIdentity) {
  std::mt19937 random(8);
  PlanarRodProperties p = test::planar_properties();
  p.right.translational_stiffness = std::numeric_limits<double>::infinity();
  const PlanarRod rod(MaterialMesh(4, 4, 0.0), p);
  RodAssembly at = test::assembled(rod, test::random_state(rod, kControls, random, 0.2));
  rod.hold_mounts(at);
  const Eigen::MatrixXd k = test::dense(at.hessian);
  for (const int row : {0, 1, 16, 17}) {
    EXPECT_EQ(at.gradient[row], 0.0);
    EXPECT_EQ((k.row(row) - Eigen::VectorXd::Unit(18, row).transpose()).norm(), 0.0);
    EXPECT_EQ(at.control_columns[1][row], 0.0);
  }
  EXPECT_NE(at.gradient[2], 0.0);
}

TEST(PlanarRod, MomentsOfACircularArc) {
  // A free rod on a circle has M = EI (curvature - natural) at every inner vertex, to second order in the
  // edge.
  PlanarRodProperties p;
  p.bending_stiffness = 0.7;
  p.axial_stiffness = 5.0;
  p.natural_curvature = 0.4;
  p.left.kind = PlanarEnd::Kind::free;
  p.right.kind = PlanarEnd::Kind::free;
  const PlanarRod rod(MaterialMesh(20, 20, 0.0), p);
  PlanarState state;
  state.controls = {0.0, 0.5, 1.0};
  state.q.resize(rod.unknowns());
  for (int i = 0; i <= 40; ++i) state.q.segment<2>(2 * i) << std::sin(i / 40.0), 1.0 - std::cos(i / 40.0);
  const Eigen::VectorXd moment = rod.moments(state);
  EXPECT_EQ(moment[0], 0.0);
  // kappa/l = 2 tan(h/2)/h, h = 1/40, exceeds 1 by h^2/12 = 5e-5, times the slope 1 + h^2/4.
  EXPECT_NEAR(moment[20], 0.7 * 0.6, 3e-4 * 0.42);
  EXPECT_NEAR(rod.tensions(state)[0], 5.0 * (2.0 * std::sin(1.0 / 80.0) * 40.0 - 1.0), 1e-12);
}

}  // namespace
}  // namespace snare::wire
