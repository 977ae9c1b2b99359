#include "wire/motion/curved_rod.hpp"

#include "numerics/dae.hpp"
#include "tests/support/derivatives.hpp"
#include "tests/support/random_rods.hpp"
#include "tests/support/sparse_product.hpp"
#include "wire/motion/edge_beam.hpp"
#include "wire/motion/rod_part.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace snare::wire {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// The flexibilities of a beam under tension and under compression, from its exact solution by hyperbolic and
// circular functions, on either side of where powers end and where the ratio of polynomials does.
TEST(EdgeBeam, FlexibilitiesAreThoseOfABeamColumn) {
  for (const double z : {-3.9, -1.0, -0.1, -1e-3, 1e-3, 0.07, 0.09, 1.0, 7.9, 8.1, 30.0, 4e3}) {
    const double w = 0.5 * std::sqrt(std::abs(z));
    const double t = z > 0.0 ? std::tanh(w) : std::tan(w);
    EXPECT_NEAR(flexibilities(z).alike.value, t / (2.0 * w), 1e-13);
    // (w coth w - 1)/(2 w^2): its digits are lost where w is small.
    const double antisymmetric = (z > 0.0 ? w / t - 1.0 : 1.0 - w / t) / (2.0 * w * w);
    EXPECT_NEAR(flexibilities(z).against.value, antisymmetric, 1e-13 + 1e-15 / (w * w));
  }
}

TEST(EdgeBeam, FlexibilitiesHaveTheirDerivatives) {
  for (const double z : {-9.0, -4.5, -3.0, -0.05, 0.0, 0.05, 2.0, 7.9, 8.1, 50.0}) {
    for (const auto which : {&Flexibilities::alike, &Flexibilities::against}) {
      const auto f = [which](double at) { return flexibilities(at).*which; };
      const auto value = [&](const VectorXd& x) { return f(z + x[0]).value; };
      const auto first = [&](const VectorXd& x) {
        return VectorXd(VectorXd::Constant(1, f(z + x[0]).first));
      };
      const VectorXd origin = VectorXd::Zero(1);
      // Of values up to 0.5 with slopes down to 1e-4.
      EXPECT_LT(test::compare_gradient(value, origin, VectorXd::Constant(1, f(z).first)).relative, 1e-8) << z;
      EXPECT_LT(test::compare_jacobian(first, origin, VectorXd::Constant(1, f(z).second)).relative, 1e-7)
          << z;
    }
  }
}

TEST(EdgeBeam, HasItsDerivatives) {
  const EdgeBeamConstants constants{0.5, 30.0, {0.7, 1.9}};
  Eigen::Matrix<double, 5, 1> x;
  x << 0.47, 0.9, -0.4, 0.2, 1.3;
  const auto beam = [&](const VectorXd& q) {
    return edge_beam(constants, q[0], Vector2d(q.segment<2>(1)), Vector2d(q.segment<2>(3)));
  };
  const auto energy = [&](const VectorXd& q) { return beam(q).energy; };
  const auto gradient = [&](const VectorXd& q) { return VectorXd(beam(q).gradient); };
  EXPECT_LT(test::compare_gradient(energy, x, beam(x).gradient, 0.1).relative, 1e-10);
  EXPECT_LT(test::compare_jacobian(gradient, x, beam(x).hessian, 0.1).relative, 1e-10);
}

RodInMotion disturbed_rod(const SpatialRodProperties& properties) {
  RodInMotion rod;
  rod.properties = properties;
  rod.mass_per_length = 0.3;
  rod.length = 1.0;
  rod.elements = 6;
  rod.grading = 1.0;
  rod.formulation = Formulation::higher_order;
  return rod;
}

/// A rod of seven vertices, disturbed by a seeded sequence.
struct Disturbed {
  RodPart part;
  numerics::DaeSystem system;
  VectorXd y, rate;
  Disturbed(const RodInMotion& rod, double out_of_plane) : part("wire", rod, {}), system({&part}) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    y = rate = VectorXd::Zero(system.size());
    Matrix3Xd positions(3, 7);
    for (int i = 0; i < 7; ++i)
      positions.col(i) << part.coordinate(i), 0.02 * unit(random), out_of_plane * 0.02 * unit(random);
    part.place(positions, {}, y);
    for (int i = 0; i < 7; ++i) {
      for (int k = 0; k < 3; ++k)
        y[part.velocity_of(i) + k] = (k == 2 ? out_of_plane : 1.0) * 0.1 * unit(random);
      y[part.angle_of(i)] += out_of_plane * 0.1 * unit(random);
      rate[part.angle_of(i)] += out_of_plane * 0.1 * unit(random);
      y.segment<2>(part.model().curvature_of(i)) += 0.1 * Vector2d(unit(random), out_of_plane * unit(random));
    }
  }
};

// Everything at once: not round, naturally bent and twisted, mounts that give, a graded mesh. Balances by
// places, angles and curvatures are second derivatives, of which the frames' holonomy is no part.
TEST(CurvedRod, SecondDerivativesMatchDifferences) {
  Disturbed d(disturbed_rod(test::general_properties()), 1.0);
  std::vector<int> unknown, balance;
  for (int i = 0; i < 7; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (d.part.is_held(i, k)) continue;
      unknown.push_back(d.part.position_of(i) + k);
      balance.push_back(d.part.velocity_of(i) + k);
    }
    for (const int u :
         {d.part.angle_of(i), d.part.model().curvature_of(i), d.part.model().curvature_of(i) + 1}) {
      if (i == 6 && u == d.part.angle_of(i)) continue;
      unknown.push_back(u);
      balance.push_back(u);
    }
  }
  const VectorXd y = d.y;
  const numerics::SparseMatrix& sparse = d.system.jacobian({0.0, y, d.rate}, 0.0);
  const auto size = static_cast<int>(unknown.size());
  Eigen::MatrixXd analytic = Eigen::MatrixXd::Zero(size, size);
  for (int a = 0; a < size; ++a) {
    for (int b = 0; b < size; ++b) {
      const int slot = sparse.slot(balance[base::at(a)], unknown[base::at(b)]);
      if (slot >= 0) analytic(a, b) = sparse.value[base::at(slot)];
    }
  }
  EXPECT_LT((analytic - analytic.transpose()).norm(), 1e-12 * analytic.norm());
  const auto gradient = [&](const VectorXd& s) {
    VectorXd moved = y, rows(y.size()), g(size);
    for (int a = 0; a < size; ++a) moved[unknown[base::at(a)]] += s[a];
    d.system.residual({0.0, moved, d.rate}, rows);
    for (int a = 0; a < size; ++a) g[a] = rows[balance[base::at(a)]];
    return g;
  };
  const test::DerivativeError error =
      test::compare_symmetric_part(gradient, VectorXd::Zero(size), analytic, 1e-2);
  EXPECT_LT(error.relative, 1e-9) << error.worst;
}

// The turning of a vertex pushes its edges across themselves alone: along the last one the mount feels its
// tension.
TEST(CurvedRod, TensionIsWhatTheMountFeels) {
  SpatialRodProperties properties = test::general_properties();
  properties.weight.setZero();
  properties.right.translational_stiffness = std::numeric_limits<double>::infinity();
  Disturbed d(disturbed_rod(properties), 1.0);
  for (int i = 0; i < 7; ++i) d.y.segment<3>(d.part.velocity_of(i)).setZero();
  const numerics::DaePoint at{0.0, d.y, VectorXd::Zero(d.y.size())};
  const RodPart::SectionLoads loads = d.part.section_loads(at);
  const Vector3d edge = d.y.segment<3>(d.part.position_of(6)) - d.y.segment<3>(d.part.position_of(5));
  const double felt = d.part.energies(at).mount_forces[1].dot(edge.normalized());
  EXPECT_NEAR(loads.tensions[5], felt, 1e-12 * std::abs(felt));
  const Vector2d bent = d.y.segment<2>(d.part.model().curvature_of(3)) - properties.natural_curvature;
  const Vector2d stiffness(properties.bending_stiffness, properties.second_bending_stiffness);
  EXPECT_DOUBLE_EQ(loads.bending_moments[3], stiffness.cwiseProduct(bent).norm());
}

// In a plane, with damping and at rates. Out of it the holonomy of the frames, which the Jacobian leaves out,
// acts through the rates of curvature.
TEST(CurvedRod, DampedJacobianMatchesDifferencesInThePlane) {
  SpatialRodProperties p = test::round_properties();
  p.second_bending_stiffness = 1.1;
  p.natural_curvature = {0.4, 0.0};
  p.weight.z() = 0.0;
  RodInMotion rod = disturbed_rod(p);
  rod.damping = {0.02, 0.01, 0.1};
  Disturbed d(rod, 0.0);
  constexpr double c = 5.0;
  const VectorXd y = d.y;
  std::vector<int> in_plane;
  for (int i = 0; i < 7; ++i) {
    for (const int first : {d.part.position_of(i), d.part.velocity_of(i)})
      in_plane.insert(in_plane.end(), {first, first + 1});
    in_plane.push_back(d.part.model().curvature_of(i));
  }
  const auto size = static_cast<int>(in_plane.size());
  const numerics::SparseMatrix& sparse = d.system.jacobian({0.0, y, d.rate}, c);
  Eigen::MatrixXd analytic(size, size);
  for (int j = 0; j < size; ++j)
    analytic.col(j) = (sparse * VectorXd(VectorXd::Unit(y.size(), in_plane[base::at(j)])))(in_plane);
  const auto f = [&](const VectorXd& s) {
    VectorXd rows(y.size()), moved = y, moved_rate = d.rate;
    moved(in_plane) += s;
    moved_rate(in_plane) += c * s;
    d.system.residual({0.0, moved, moved_rate}, rows);
    return VectorXd(rows(in_plane));
  };
  const test::DerivativeError error = test::compare_jacobian(f, VectorXd::Zero(size), analytic, 1e-2);
  EXPECT_LT(error.relative, 1e-9) << error.worst;
}

}  // namespace
}  // namespace snare::wire
