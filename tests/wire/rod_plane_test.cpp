// A rod that is its own mirror image in a plane: what of it stays there.

#include "numerics/dense_solvers.hpp"
#include "wire/motion/rod_part.hpp"
#include "wire/motion/rod_rest.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <ostream>
#include <random>
#include <vector>

namespace snare::wire {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

struct Lying {
  Formulation formulation;
  int normal;            // of the plane
  bool stands_across;    // the mounts' director
  double strands = 0.0;  // their stiffness
  friend std::ostream& operator<<(std::ostream& s, const Lying& l) {
    return s << (l.formulation == Formulation::vertices ? "vertices" : "higher order") << ", plane across "
             << "xyz"[l.normal] << (l.stands_across ? ", director across" : ", director along")
             << (l.strands > 0.0 ? ", strands" : "");
  }
};

Vector3d along(int normal) {
  return Vector3d::Unit((normal + 1) % 3);
}
Vector3d up(int normal) {
  return Vector3d::Unit((normal + 2) % 3);
}

RodInMotion rod_of(const Lying& l) {
  RodInMotion rod;
  SpatialRodProperties& p = rod.properties;
  p.bending_stiffness = 1.0;
  p.second_bending_stiffness = 1.7;
  p.torsional_stiffness = 0.8;
  p.axial_stiffness = 300.0;
  p.natural_curvature[l.stands_across ? 1 : 0] = 0.3;
  p.weight = 2.0 * up(l.normal) - along(l.normal);
  for (SpatialEnd* end : {&p.left, &p.right}) {
    end->direction = along(l.normal);
    end->director = l.stands_across ? Vector3d::Unit(l.normal) : up(l.normal);
  }
  p.right.position = along(l.normal);
  rod.mass_per_length = 0.3;
  rod.length = 1.0;
  rod.elements = 7;
  rod.formulation = l.formulation;
  rod.damping = {1e-2, 1e-2, 0.1};
  rod.strands = {l.strands, 0.5, 1e-2};
  return rod;
}

Matrix3Xd crooked(const RodInMotion& rod, int normal, std::mt19937& random, double amount) {
  std::uniform_real_distribution<double> unit(-amount, amount);
  Matrix3Xd x(3, rod.elements + 1);
  for (int i = 0; i <= rod.elements; ++i) x.col(i) = static_cast<double>(i) / rod.elements * along(normal);
  for (int i = 1; i < rod.elements; ++i) x.col(i) += unit(random) * along(normal) + unit(random) * up(normal);
  return x;
}

class RodInPlane : public testing::TestWithParam<Lying> {};

// What stays as it is has no force and no rate, whatever the rest does, and neither feels the other.
TEST_P(RodInPlane, FeelsNothingAcrossIt) {
  const Lying& l = GetParam();
  const RodInMotion rod = rod_of(l);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  RodPart part("wire", rod, {});
  numerics::DaeSystem system({&part});
  VectorXd y = VectorXd::Zero(system.size());
  const Matrix3Xd start = crooked(rod, l.normal, random, 0.02);
  part.place(start, {}, y);
  const std::optional<RodPlane> plane = part.plane_across(l.normal);
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->bending, l.stands_across ? 1 : 0);
  const std::vector<int> across = part.restrict_to_plane(*plane);
  part.leave_plane();
  const int each = 3 + (l.formulation == Formulation::higher_order) + (l.strands > 0.0);
  EXPECT_EQ(static_cast<int>(across.size()), each * part.vertices());
  std::vector<bool> stays(static_cast<std::size_t>(y.size()), false);
  for (const int u : across) stays[static_cast<std::size_t>(u)] = true;
  VectorXd rate = VectorXd::Zero(y.size());
  for (int u = 0; u < y.size(); ++u) {
    if (stays[static_cast<std::size_t>(u)]) continue;
    y[u] += 0.02 * unit(random);
    rate[u] = 0.1 * unit(random);
  }
  const numerics::DaePoint at{0.0, y, rate};
  VectorXd rows(y.size());
  system.residual(at, rows);
  const Eigen::MatrixXd jacobian = numerics::dense(system.jacobian(at, 20.0));
  const double largest = jacobian.cwiseAbs().maxCoeff();
  const RodPart::Energies energies = part.energies(at);
  const VectorXd bending = part.section_loads(at).bending_moments;
  for (const int u : across) {
    EXPECT_LE(std::abs(rows[u]), 1e-14 * rows.cwiseAbs().maxCoeff()) << system.layout().name_of(u);
    for (int v = 0; v < y.size(); ++v) {
      if (stays[static_cast<std::size_t>(v)]) continue;
      EXPECT_LE(std::abs(jacobian(u, v)), 1e-13 * largest)
          << system.layout().name_of(u) << " by " << system.layout().name_of(v);
      EXPECT_LE(std::abs(jacobian(v, u)), 1e-13 * largest)
          << system.layout().name_of(v) << " by " << system.layout().name_of(u);
    }
  }
  // Held, they are 1 of their own rows, and what is left is as it was: by the formulas of space, and by those
  // of the plane.
  system.hold(across);
  for (const bool in_plane : {false, true}) {
    if (in_plane) EXPECT_EQ(part.restrict_to_plane(*plane), across);
    const Eigen::MatrixXd held = numerics::dense(system.jacobian(at, 20.0));
    VectorXd held_rows(y.size());
    system.residual(at, held_rows);
    const double exact = in_plane ? 1e-12 : 0.0;
    for (int u = 0; u < y.size(); ++u) {
      const bool stays_u = stays[static_cast<std::size_t>(u)];
      EXPECT_NEAR(held_rows[u], stays_u ? 0.0 : rows[u], exact * rows.cwiseAbs().maxCoeff());
      for (int v = 0; v < y.size(); ++v) {
        const bool either = stays_u || stays[static_cast<std::size_t>(v)];
        EXPECT_NEAR(held(u, v), either ? (u == v ? 1.0 : 0.0) : jacobian(u, v), exact * largest)
            << system.layout().name_of(u) << " by " << system.layout().name_of(v);
      }
    }
    const RodPart::Energies e = part.energies(at);
    EXPECT_NEAR(e.strain, energies.strain, exact * energies.strain);
    EXPECT_NEAR(e.dissipation, energies.dissipation, exact * energies.dissipation);
    EXPECT_LT((e.mount_forces[0] - energies.mount_forces[0]).norm(), 1e-12 * rows.cwiseAbs().maxCoeff());
    EXPECT_LT((e.mount_moments[1] - energies.mount_moments[1]).norm(), 1e-12 * rows.cwiseAbs().maxCoeff());
    EXPECT_LT((part.section_loads(at).bending_moments - bending).norm(), 1e-12 * bending.norm());
  }
  for (const int other : {(l.normal + 1) % 3, (l.normal + 2) % 3}) EXPECT_FALSE(part.plane_across(other));
}

INSTANTIATE_TEST_SUITE_P(
    Planes, RodInPlane,
    testing::Values(Lying{Formulation::vertices, 2, false}, Lying{Formulation::vertices, 0, true},
                    Lying{Formulation::vertices, 1, false, 0.5}, Lying{Formulation::vertices, 1, true, 0.5},
                    Lying{Formulation::higher_order, 2, true}, Lying{Formulation::higher_order, 1, false},
                    Lying{Formulation::higher_order, 0, false, 0.5}));

// Mounts, weight, nature and places that are not their own mirror images.
TEST(RodPlane, IsNoneWhereAnythingLeavesIt) {
  const Lying lying{Formulation::higher_order, 2, false};
  const auto stays = [&](const std::function<void(RodInMotion&)>& change, double shift = 0.0) {
    RodInMotion rod = rod_of(lying);
    change(rod);
    RodPart part("wire", rod, {});
    const numerics::DaeSystem system({&part});
    VectorXd y = VectorXd::Zero(system.size());
    std::mt19937 random(3);
    Matrix3Xd start = crooked(rod, 2, random, 0.02);
    start(2, 3) += shift;
    part.place(start, {}, y);
    return part.plane_across(2).has_value();
  };
  EXPECT_TRUE(stays([](RodInMotion&) {}));
  EXPECT_FALSE(stays([](RodInMotion&) {}, 1e-9));
  EXPECT_FALSE(stays([](RodInMotion& r) { r.properties.weight.z() = 1e-9; }));
  EXPECT_FALSE(stays([](RodInMotion& r) { r.properties.natural_curvature[1] = 0.1; }));
  EXPECT_FALSE(stays([](RodInMotion& r) { r.properties.natural_twist = 0.1; }));
  EXPECT_FALSE(stays([](RodInMotion& r) { r.properties.left.position.z() = 1e-9; }));
  EXPECT_FALSE(
      stays([](RodInMotion& r) { r.properties.right.direction = Vector3d(0.0, 1.0, 0.01).normalized(); }));
  EXPECT_FALSE(stays([](RodInMotion& r) { r.properties.right.twist_angle = 0.1; }));
  EXPECT_FALSE(
      stays([](RodInMotion& r) { r.properties.right.director = Vector3d(0.0, 1.0, 1.0).normalized(); }));
  EXPECT_TRUE(stays([](RodInMotion& r) { r.properties.right.kind = SpatialEnd::Kind::pin; }));
}

// An arch at rest is the same arch in whatever plane it stands.
TEST(RodPlane, RestsAsInAnyOtherPlane) {
  std::vector<VectorXd> heights;
  for (const double turn : {0.0, 0.3, 0.5 * pi}) {
    RodInMotion rod = rod_of({Formulation::higher_order, 2, false});
    SpatialRodProperties& p = rod.properties;
    p.second_bending_stiffness = p.bending_stiffness;
    p.axial_stiffness = 1e5;
    p.natural_curvature.setZero();
    p.weight.setZero();
    p.left.direction = p.right.direction = Vector3d::UnitX();
    p.right.position = {0.95, 0.0, 0.0};
    p.left.director = p.right.director = Vector3d::UnitY();
    Matrix3Xd start(3, rod.elements + 1);
    const Vector3d up(0.0, std::cos(turn), std::sin(turn));
    for (int i = 0; i <= rod.elements; ++i) {
      const double s = static_cast<double>(i) / rod.elements;
      start.col(i) = 0.95 * s * Vector3d::UnitX() + 0.07 * (1.0 - std::cos(2.0 * pi * s)) * up;
    }
    const RodRest rest = find_rest(rod, start);
    ASSERT_TRUE(rest.report.usable()) << rest.report.message;
    heights.emplace_back(rest.positions.transpose() * up);
  }
  for (const VectorXd& h : heights) EXPECT_LT((h - heights.front()).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_GT(heights.front().maxCoeff(), 0.1);
}

}  // namespace
}  // namespace snare::wire
