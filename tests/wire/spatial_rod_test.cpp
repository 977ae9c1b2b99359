#include "wire/spatial_rod.hpp"

#include "tests/support/random_rods.hpp"
#include "tests/support/rod_derivatives.hpp"
#include "wire/statics/equilibrium.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <numbers>
#include <random>

namespace snare::wire {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr Controls kControls{0.0, 0.45, 1.05};

constexpr SpatialEnd::Kind kKinds[] = {SpatialEnd::Kind::clamp, SpatialEnd::Kind::twisting_pin,
                                       SpatialEnd::Kind::pin, SpatialEnd::Kind::free};

TEST(SpatialRod, DerivativesOfARoundRodMatchDifferences) {
  std::mt19937 random(1);
  for (const SpatialEnd::Kind kind : kKinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    SpatialRodProperties p = test::round_properties();
    p.left.kind = kind;
    const SpatialRod rod(MaterialMesh(3, 4, 0.8), p);
    test::expect_exact(test::check_rod_derivatives(rod, test::random_state(rod, kControls, random, 0.4)));
  }
}

TEST(SpatialRod, DerivativesOfAGeneralRodMatchDifferences) {
  std::mt19937 random(2);
  for (const SpatialEnd::Kind kind : kKinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    SpatialRodProperties p = test::general_properties();
    p.right.kind = kind;
    const SpatialRod rod(MaterialMesh(3, 4, 0.8), p);
    test::expect_exact(test::check_rod_derivatives(rod, test::random_state(rod, kControls, random, 0.4)));
  }
}

TEST(SpatialRod, HessianIsTheSecondDerivativeOfTheEnergy) {
  // The energy with frames carried from one state is a function of q; its Hessian has no skew part to hide.
  std::mt19937 random(3);
  const SpatialRod rod(MaterialMesh(2, 2, 0.5), test::general_properties());
  const SpatialState state = test::random_state(rod, kControls, random, 0.3);
  const Eigen::MatrixXd hessian = test::dense(test::assembled(rod, state).hessian);
  const double h = 3e-4;
  const auto energy = [&](int i, double a, int j, double b) {
    Eigen::VectorXd q = state.q;
    q[i] += a;
    q[j] += b;
    return rod.energy(test::moved_to(state, q));
  };
  Eigen::MatrixXd second(rod.unknowns(), rod.unknowns());
  for (int i = 0; i < rod.unknowns(); ++i) {
    for (int j = 0; j < rod.unknowns(); ++j) {
      second(i, j) = (energy(i, h, j, h) - energy(i, h, j, -h) - energy(i, -h, j, h) + energy(i, -h, j, -h)) /
                     (4.0 * h * h);
    }
  }
  // Second order: truncation h^2 / (edge 0.25)^2 about 1e-6 of the largest entry, round-off 1e-15/h^2 = 1e-8.
  EXPECT_LT((second - hessian).cwiseAbs().maxCoeff(), 2e-5 * hessian.cwiseAbs().maxCoeff());
}

TEST(SpatialRod, InThePlaneIsThePlanarRod) {
  std::mt19937 random(4);
  PlanarRodProperties p = test::planar_properties();
  for (const double curvature : {0.0, 0.4}) {
    p.natural_curvature = curvature;
    SpatialRodProperties s = test::round_properties();
    s.natural_curvature = {curvature, 0.0};
    s.weight = {p.weight.x(), p.weight.y(), 0.0};
    const PlanarRod planar(MaterialMesh(5, 7, 0.8), p);
    const SpatialRod spatial(MaterialMesh(5, 7, 0.8), s);
    const PlanarState flat = test::random_state(planar, kControls, random, 0.4);
    Eigen::VectorXd q = Eigen::VectorXd::Zero(spatial.unknowns());
    for (int i = 0; i < planar.mesh().vertices(); ++i) q.segment<2>(4 * i) = vertex(flat, i);
    const SpatialState state = spatial.make_state(q, kControls);

    const RodAssembly a = test::assembled(planar, flat);
    const RodAssembly b = test::assembled(spatial, state);
    const Eigen::MatrixXd ka = test::dense(a.hessian);
    const Eigen::MatrixXd kb = test::dense(b.hessian);
    const double force = a.gradient.lpNorm<Eigen::Infinity>();
    const double stiffness = ka.cwiseAbs().maxCoeff();
    // Round-off: a few dozen operations on terms of the largest entry's size.
    EXPECT_NEAR(b.energy, a.energy, 1e-13 * std::abs(a.energy) + 1e-14);
    for (int i = 0; i < planar.unknowns(); ++i) {
      const int row = 4 * (i / 2) + i % 2;
      EXPECT_NEAR(b.gradient[row], a.gradient[i], 1e-13 * force);
      for (int j = 0; j < planar.unknowns(); ++j) {
        EXPECT_NEAR(kb(row, 4 * (j / 2) + j % 2), ka(i, j), 1e-13 * stiffness) << i << " " << j;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(b.control_columns[k][row], a.control_columns[k][i],
                    1e-13 * a.control_columns[k].lpNorm<Eigen::Infinity>());
      }
    }
    EXPECT_LT((b.control_gradient - a.control_gradient).norm(), 1e-13 * a.control_gradient.norm() + 1e-13);
    EXPECT_LT((b.control_hessian - a.control_hessian).norm(), 1e-13 * a.control_hessian.norm());
    // Nothing out of the plane.
    for (int i = 0; i < planar.mesh().vertices(); ++i) {
      EXPECT_NEAR(b.gradient[4 * i + 2], 0.0, 1e-14 * force);
      EXPECT_NEAR(b.gradient[4 * i + 3], 0.0, 1e-14 * force);
    }
    const Eigen::Matrix3Xd moments = spatial.moments(state);
    const Eigen::VectorXd moment = planar.moments(flat);
    EXPECT_LT((moments.row(2).transpose() - moment).norm(), 1e-13 * moment.norm());
    EXPECT_LT(moments.topRows(2).norm(), 1e-13 * moment.norm());
    EXPECT_LT((spatial.tensions(state) - planar.tensions(flat)).norm(), 1e-13 * planar.tensions(flat).norm());
  }
}

TEST(SpatialRod, EnergyIsInvariantAndGradientTurnsWithTheRod) {
  std::mt19937 random(5);
  for (const bool round : {true, false}) {
    SpatialRodProperties p = round ? test::round_properties() : test::general_properties();
    p.weight.setZero();
    p.right.translational_stiffness = std::numeric_limits<double>::infinity();
    SpatialRod rod(MaterialMesh(4, 5, 0.5), p);
    const SpatialState state = test::random_state(rod, kControls, random, 0.4);
    const RodAssembly at = test::assembled(rod, state);

    // Mounts and rod turn together.
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(1.1, Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
    SpatialEnd left = p.left;
    SpatialEnd right = p.right;
    for (SpatialEnd* end : {&left, &right}) {
      end->direction = (turn * end->direction).eval();
      end->director = (turn * end->director).eval();
    }
    rod.set_mounts(left, right);
    Eigen::VectorXd q = state.q;
    for (int i = 0; i < rod.mesh().vertices(); ++i) {
      q.segment<3>(4 * i) = turn * vertex(state, i) + Vector3d(0.2, -1.0, 0.5);
    }
    const RodAssembly there = test::assembled(rod, rod.make_state(q, kControls));
    Eigen::VectorXd expected = at.gradient;
    for (int i = 0; i < rod.mesh().vertices(); ++i) {
      expected.segment<3>(4 * i) = turn * Vector3d(at.gradient.segment<3>(4 * i));
    }
    // Coordinates of order one lose eps on edges of 0.1: 1e-15 relative, times the stiffness ratio 1e2 to
    // 1e3.
    EXPECT_NEAR(there.energy, at.energy, 1e-12 * at.energy);
    EXPECT_LT((there.gradient - expected).lpNorm<Eigen::Infinity>(),
              1e-11 * expected.lpNorm<Eigen::Infinity>());
  }
}

TEST(SpatialRod, FreeRodHasNoNetForceNorMoment) {
  std::mt19937 random(6);
  SpatialRodProperties p = test::general_properties();
  p.weight.setZero();
  p.left.kind = SpatialEnd::Kind::free;
  p.right.kind = SpatialEnd::Kind::free;
  const SpatialRod rod(MaterialMesh(4, 5, 0.5), p);
  const SpatialState state = test::random_state(rod, kControls, random, 0.4);
  const RodAssembly at = test::assembled(rod, state);
  Vector3d force = Vector3d::Zero();
  Vector3d moment = Vector3d::Zero();
  for (int i = 0; i < rod.mesh().vertices(); ++i) {
    const Vector3d f = at.gradient.segment<3>(4 * i);
    force += f;
    moment += vertex(state, i).cross(f);
  }
  // A rotation omega turns every edge and, at fixed theta, its frame by omega less the transport's share;
  // what the frame lacks is omega.t: so the torques dE/dtheta belong to the balance.
  for (int e = 0; e < rod.mesh().edges(); ++e) {
    moment += at.gradient[4 * e + 3] * (vertex(state, e + 1) - vertex(state, e)).normalized();
  }
  const double size = at.gradient.lpNorm<Eigen::Infinity>();
  EXPECT_LT(force.norm(), 1e-13 * size);  // sums of ten terms
  EXPECT_LT(moment.norm(), 1e-13 * size);
}

TEST(SpatialRod, MomentsBalanceTheForcesOnEveryEdge) {
  // dE by a rotation of all that follows vertex i is the moment there plus what the tension does: for the
  // part after i, held at nothing, M_i = sum of (x_j - x_i) x f_j + sum dE/dtheta t over that part.
  std::mt19937 random(9);
  SpatialRodProperties p = test::general_properties();
  p.weight.setZero();
  p.right.kind = SpatialEnd::Kind::free;
  const SpatialRod rod(MaterialMesh(4, 5, 0.5), p);
  const SpatialState state = test::random_state(rod, kControls, random, 0.4);
  const RodAssembly at = test::assembled(rod, state);
  const Eigen::Matrix3Xd moments = rod.moments(state);
  const int n = rod.mesh().edges();
  for (int i = 0; i < n; ++i) {
    Vector3d moment = Vector3d::Zero();
    for (int j = i + 1; j <= n; ++j) {
      moment += (vertex(state, j) - vertex(state, i)).cross(Vector3d(at.gradient.segment<3>(4 * j)));
    }
    for (int e = i; e < n; ++e) {
      moment += at.gradient[4 * e + 3] * (vertex(state, e + 1) - vertex(state, e)).normalized();
    }
    // Sums of forces that are 20 times the moments.
    EXPECT_LT((moments.col(i) - moment).norm(), 1e-12 * moments.norm()) << i;
  }
}

TEST(SpatialRod, ManyTurnsOfAMountAreCounted) {
  // A straight round rod, one mount turned by 20.3 turns in steps of 0.7 turns: GJ angle/L throughout.
  SpatialRodProperties p = test::round_properties();
  p.weight.setZero();
  p.left.rotational_stiffness = std::numeric_limits<double>::infinity();
  p.right.translational_stiffness = std::numeric_limits<double>::infinity();
  p.right.direction = Vector3d::UnitX();
  p.right.director = Vector3d::UnitY();
  SpatialRod rod(MaterialMesh(6, 6, 0.5), p);
  SpatialState state = rod.straight_state({0.0, 0.4, 1.0});
  const double turns = 20.3;
  for (int step = 1; step <= 29; ++step) {
    // Once by the twist angle, which the director does not show, once by the director in steps of 0.3 turns.
    SpatialEnd right = p.right;
    right.twist_angle = 2.0 * pi * turns * step / 29;
    rod.set_mounts(p.left, right);
    rod.adopt_mounts(state);
  }
  Eigen::VectorXd q = state.q;
  for (int e = 0; e < 12; ++e) {
    const double middle =
        0.5 * (rod.mesh().coordinate(e, state.controls) + rod.mesh().coordinate(e + 1, state.controls));
    q[4 * e + 3] = 2.0 * pi * turns * middle;
  }
  accept(state, q);
  const Eigen::VectorXd torque = rod.torques(state);
  for (int i = 0; i <= 12; ++i)
    EXPECT_NEAR(torque[i], 0.5 * 2.0 * pi * turns, 1e-11);  // eps of 130 rad / 0.02

  // The director instead: the reference twist at the mount follows.
  for (int step = 1; step <= 70; ++step) {
    SpatialEnd right = p.right;
    right.director = Eigen::AngleAxisd(2.0 * pi * turns * step / 70, Vector3d::UnitX()) * p.right.director;
    rod.set_mounts(p.left, right);
    rod.adopt_mounts(state);
  }
  EXPECT_NEAR(state.reference_twist.back(), 2.0 * pi * turns, 1e-10);
  EXPECT_LT((rod.torques(state) - torque).norm(), 1e-9);
}

TEST(SpatialRod, MountThatGivesInTwistIsInSeries) {
  // Torque of a straight rod: angle/(L/GJ + 1/k).
  SpatialRodProperties p;
  p.bending_stiffness = 0.7;
  p.second_bending_stiffness = 0.7;
  p.torsional_stiffness = 0.5;
  p.axial_stiffness = 5.0;
  p.left.twisting_stiffness = 0.4;
  p.right.position = 1.05 * Vector3d::UnitX();
  p.right.twist_angle = 0.9;
  const SpatialRod rod(MaterialMesh(4, 5, 0.7), p);
  SpatialState state = rod.straight_state(kControls);
  const EquilibriumReport report = find_equilibrium(rod, state);
  ASSERT_TRUE(report.usable()) << report.message;
  const double torque = 0.9 / (1.05 / 0.5 + 1.0 / 0.4);
  // Residual 1e-10 (EI/L^2 + tension) of the solver.
  for (int i = 0; i <= 9; ++i) EXPECT_NEAR(rod.torques(state)[i], torque, 1e-9);
}

TEST(SpatialRod, TwistingPinHoldsTheTwistOnly) {
  // A rod that leaves a twisting pin at an angle is neither bent nor twisted by it.
  SpatialRodProperties p = test::round_properties();
  p.weight.setZero();
  p.left.kind = SpatialEnd::Kind::twisting_pin;
  p.left.direction = Vector3d(1.0, 1.0, 0.3).normalized();
  p.left.director = p.left.direction.cross(Vector3d::UnitZ()).normalized();
  p.right.kind = SpatialEnd::Kind::pin;
  p.right.position = 1.05 * Vector3d::UnitX();
  const SpatialRod rod(MaterialMesh(4, 5, 0.7), p);
  const RodAssembly at = test::assembled(rod, rod.straight_state(kControls));
  EXPECT_NEAR(at.energy, 0.0, 1e-15);
  EXPECT_LT(at.gradient.lpNorm<Eigen::Infinity>(), 1e-13);  // EA eps L/h
}

TEST(SpatialRod, BeginsUntwistedFromTheEndThatIsHeld) {
  for (const SpatialEnd::Kind free : {SpatialEnd::Kind::free, SpatialEnd::Kind::pin}) {
    SpatialRodProperties p = test::round_properties();
    p.weight.setZero();
    p.left.kind = free;
    p.right.position = 1.05 * Vector3d::UnitX();
    p.right.direction = Vector3d::UnitX();
    for (const double turn : {0.0, 0.7, 0.5 * pi, 2.5}) {
      p.right.director = {0.0, std::cos(turn), std::sin(turn)};
      const SpatialRod rod(MaterialMesh(4, 5, 0.7), p);
      EXPECT_NEAR(rod.energy(rod.straight_state(kControls)), 0.0, 1e-15) << turn;
    }
  }
}

TEST(SpatialRod, RoundRodBendsIndependentlyOfItsTwist) {
  std::mt19937 random(10);
  SpatialRodProperties p = test::round_properties();
  p.left.kind = SpatialEnd::Kind::free;
  p.right.kind = SpatialEnd::Kind::free;
  const SpatialRod rod(MaterialMesh(4, 5, 0.5), p);
  SpatialState state = test::random_state(rod, kControls, random, 0.4);
  for (int e = 0; e < 9; ++e)
    state.q[4 * e + 3] = -Eigen::VectorXd::Map(state.reference_twist.data(), 10).head(e + 1).sum();
  const double untwisted = rod.energy(state);
  SpatialState twisted = state;
  for (int e = 0; e < 9; ++e) twisted.q[4 * e + 3] += 2.9 * e;
  double twist_energy = 0.0;
  for (int i = 1; i < 9; ++i) {
    const double l = 0.5 * (rod.mesh().rest_length(i - 1, kControls) + rod.mesh().rest_length(i, kControls));
    twist_energy += 0.5 * 0.5 / l * 2.9 * 2.9;
  }
  EXPECT_NEAR(rod.energy(twisted) - untwisted, twist_energy, 1e-12 * twist_energy);  // round-off of the sums
}

TEST(SpatialRod, NaturalHelixKeepsAnEnergyOfSecondOrder) {
  // Vertices on a helix whose Darboux vector is that of the natural state: kappa_1 turns with the twist.
  const auto energy = [](int half_edges) {
    SpatialRodProperties p = test::general_properties();
    p.weight.setZero();
    p.left.kind = SpatialEnd::Kind::free;
    p.right.kind = SpatialEnd::Kind::free;
    const double curvature = 2.0;
    const double torsion = 1.5;
    p.natural_curvature = {curvature, 0.0};
    p.natural_twist = torsion;
    const SpatialRod rod(MaterialMesh(half_edges, half_edges, 0.0), p);
    const double w = std::hypot(curvature, torsion);
    const double radius = curvature / (w * w);
    const double pitch = torsion / (w * w);
    const auto point = [&](double s) {
      return Vector3d(radius * std::cos(w * s), radius * std::sin(w * s), pitch * w * s);
    };
    const int n = 2 * half_edges;
    Eigen::VectorXd q = Eigen::VectorXd::Zero(rod.unknowns());
    for (int i = 0; i <= n; ++i) q.segment<3>(4 * i) = point(static_cast<double>(i) / n);
    SpatialState state = rod.make_state(q, {0.0, 0.5, 1.0});
    // m1 of every edge along the principal normal at its middle.
    for (int e = 0; e < n; ++e) {
      const double s = (e + 0.5) / n;
      const Vector3d normal(-std::cos(w * s), -std::sin(w * s), 0.0);
      Frame wanted{state.frames[static_cast<std::size_t>(e)].tangent, normal};
      wanted.director -= wanted.tangent.dot(normal) * wanted.tangent;
      wanted.director.normalize();
      q[4 * e + 3] =
          reference_twist(state.frames[static_cast<std::size_t>(e)], wanted, e == 0 ? 0.0 : q[4 * e - 1]);
    }
    accept(state, q);
    return rod.energy(state);
  };
  // Mean directors see cos(m/2) of the curvature, m = torsion h: 1/2 (EI_1 + EI_2)/2 curvature^2 (m/2)^2 is
  // left per length. The two half cells at the free ends are missing, 1/n, and the next order is h^2.
  const double coarse = energy(20);
  EXPECT_NEAR(coarse, 0.5 * 1.3 * 4.0 * std::pow(1.5 / 80.0, 2), 0.04 * coarse);
  EXPECT_NEAR(coarse / energy(40), 4.0, 0.1);
}

}  // namespace
}  // namespace snare::wire
