// The contact of two wires at one state: forces, derivatives, what is near.

#include "coupling/dynamics/contact/wire_pair_part.hpp"
#include "tests/support/crossed_wires.hpp"
#include "tests/support/dae_jacobian.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

namespace snare::coupling {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::crossed_wires;

constexpr double degree = std::numbers::pi / 180.0;

/// Two rods and their contact as a system of their own.
struct Pair {
  wire::RodPart first, second;
  WirePairPart contact;
  numerics::DaeSystem system;
  VectorXd y, rate;

  explicit Pair(const Motion& motion)
      : first("first", motion.wires[0].rod, {}),
        second("second", motion.wires[1].rod, {}),
        contact(motion.wire_pairs[0], first, second),
        system({&first, &second, &contact}),
        y(VectorXd::Zero(system.size())),
        rate(y) {
    const auto still = [](const MotionWire& w) { return Matrix3Xd::Zero(3, w.positions.cols()); };
    first.place(motion.wires[0].positions, still(motion.wires[0]), y);
    second.place(motion.wires[1].positions, still(motion.wires[1]), y);
    look();
  }
  void look() { contact.update_candidates(y); }
  [[nodiscard]] WirePairPart::Sums sums() { return contact.sums(y); }
  /// What the contact alone adds to the rows.
  [[nodiscard]] VectorXd rows() {
    VectorXd rows = VectorXd::Zero(y.size());
    contact.residual({0.0, y, rate}, rows);
    return rows;
  }
  /// Force and moment about the origin of what the contact does to a wire, by its rows.
  struct Wrench {
    Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
  };
  [[nodiscard]] Wrench on(const wire::RodPart& rod, const VectorXd& rows) const {
    Wrench w;
    for (int i = 0; i < rod.vertices(); ++i) {
      const Vector3d f = -rows.segment<3>(rod.velocity_of(i));
      w.force += f;
      w.moment += Vector3d(y.segment<3>(rod.position_of(i))).cross(f);
    }
    return w;
  }
};

/// Two wires in waves that press on each other some micrometres deep, and move.
std::unique_ptr<Pair> wavy(double angle, const MotionFriction& friction, double depth) {
  Motion motion = crossed_wires(angle, 5e-3, 8);
  motion.wire_pairs[0].friction = friction;
  motion.wire_pairs[0].radii = {1e-3, 0.7e-3};
  motion.wire_pairs[0].foundation = {3e8, 1.0};
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (MotionWire& w : motion.wires) {
    for (int i = 1; i < 8; ++i)
      w.positions.col(i) += 1e-3 * Vector3d(unit(random), 0.2 * unit(random), unit(random));
  }
  auto made = std::make_unique<Pair>(motion);
  Pair& p = *made;
  const double up = p.contact.search().nearest(p.y).gap + depth;
  for (int i = 0; i <= 8; ++i) p.y[p.second.position_of(i) + 1] += up;
  for (const wire::RodPart* rod : {&p.first, &p.second}) {
    for (int i = 0; i <= 8; ++i) {
      for (int a = 0; a < 3; ++a) p.y[rod->velocity_of(i) + a] = 0.1 * unit(random);
    }
  }
  for (double& r : p.rate) r = 0.1 * unit(random);
  p.look();
  return made;
}

MotionFriction soft_friction() {
  MotionFriction f{0.3, 0.1, 0.01, 1.0};
  // A bristle as soft as the wires, so that no row drowns the others.
  f.bristle_displacement = 1e-4;
  f.bristle_time = 1e-3;
  return f;
}

// A wire that crosses another under an angle: g = -d + c s^2/2, c = sin^2(angle)/D, so F = 4/3 k sqrt(2/c)
// d^(3/2), at every place.
TEST(WirePair, WiresThatCrossMeetTheForceOfTheirDepth) {
  for (const double angle : {90.0, 30.0, 10.0}) {
    for (const double depth : {1e-7, 1e-6}) {
      for (const double shift : {0.0, 3.7e-3, 8.8e-3, 9.98e-3}) {
        Motion motion = crossed_wires(angle * degree, -depth, 20);
        motion.wire_pairs[0].foundation.modulus = 5e11;
        motion.wires[1].positions.colwise() += Vector3d(shift, 0.0, 0.0);
        const WirePairPart::Sums s = Pair(motion).sums();
        const double expected =
            4.0 / 3.0 * 5e11 * std::sqrt(2.0 * 0.002) / std::sin(angle * degree) * depth * std::sqrt(depth);
        // The gap is no parabola to d/D of itself, a thousandth at most.
        EXPECT_NEAR(s.force.y(), expected, 1e-3 * expected) << angle << ' ' << depth << ' ' << shift;
        EXPECT_NEAR(s.normal, expected, 1e-3 * expected);
      }
    }
  }
}

// Side by side over all their length: k d a length, whatever the elements.
TEST(WirePair, ParallelWiresBearTheFoundationsLoadAlongTheirLength) {
  for (const int elements : {30, 60, 120}) {
    constexpr double depth = 1e-6, modulus = 1e9;
    Motion motion = crossed_wires(0.0, -depth, elements);
    motion.wire_pairs[0].foundation.modulus = modulus;
    const WirePairPart::Sums s = Pair(motion).sums();
    // Either wire ends 0.72 mm before the other; the sphere at its end bears over some sqrt(2 D d) = 60 um
    // more.
    const double length = 0.2 - 0.6 * 0.0012;
    EXPECT_NEAR(s.force.y(), modulus * depth * length, 5e-4 * modulus * depth * length) << elements;
  }
}

TEST(WirePair, JacobianMatchesDifferences) {
  for (const double angle : {80.0, 25.0}) {
    for (const double stretch : {-1.0, 0.3, 0.9995}) {
      SCOPED_TRACE(testing::Message() << angle << ' ' << stretch);
      const MotionFriction friction = stretch < 0.0 ? MotionFriction{} : soft_friction();
      const auto made = wavy(angle * degree, friction, 5e-6);
      Pair& p = *made;
      ASSERT_GT(p.sums().normal, 0.1);
      for (const wire::RodPart* rod : {&p.first, &p.second}) {
        for (int i = 0; stretch > 0.0 && i <= 8; ++i) {
          const int z = p.contact.bristle_of(rod == &p.first ? 0 : 1, i);
          p.y.segment<2>(z) = stretch * friction.bristle_displacement * Vector2d(0.6, -0.8);
        }
      }
      const test::DerivativeError error = test::compare_dae_jacobian(
          p.system, p.y, p.rate, Eigen::MatrixXd::Identity(p.y.size(), p.y.size()), 1e-4);
      // Gauss's rule is exact for a gap that is a parabola: what is left is the share of the third order in
      // it.
      EXPECT_LT(error.relative, 1e-5) << error.worst;
    }
  }
}

// Whatever the friction: equal and opposite forces at one point, but for what would twist the wires.
TEST(WirePair, ForcesOnBothWiresBalanceWithTheirMoments) {
  for (const double angle : {80.0, 20.0}) {
    const auto made = wavy(angle * degree, soft_friction(), 3e-6);
    Pair& p = *made;
    for (int i = 0; i <= 8; ++i) {
      p.y.segment<2>(p.contact.bristle_of(0, i)) = 5e-5 * Vector2d(0.6, -0.8);
      p.y.segment<2>(p.contact.bristle_of(1, i)) = 5e-5 * Vector2d(-0.3, 0.8);
    }
    const VectorXd rows = p.rows();
    const Pair::Wrench first = p.on(p.first, rows), second = p.on(p.second, rows);
    ASSERT_GT(first.force.norm(), 0.1);
    EXPECT_LT((first.force + second.force).norm(), 1e-12 * first.force.norm());
    EXPECT_LT((first.moment + second.moment + p.sums().held_moment).norm(), 1e-12 * first.force.norm() * 0.1);
    EXPECT_LT((p.sums().force - first.force).norm(), 1e-12 * first.force.norm());
  }
}

// The crossing goes along both wires over some of their vertices: no force on a vertex has a kink.
TEST(WirePair, ForcesAreSmoothAsTheCrossingGoesOverVertices) {
  Motion motion = crossed_wires(60.0 * degree, -1e-6, 8);
  motion.wire_pairs[0].foundation.modulus = 1e10;
  for (const Vector3d& along : {Vector3d(1.0, 0.0, 0.0), Vector3d(0.5, 0.0, std::sqrt(0.75))}) {
    Pair p(motion);
    constexpr double step = 2e-5;  // of elements of 25 mm
    VectorXd before = p.rows(), here = before;
    const double force = p.sums().normal;
    double bend = 0.0, way = 0.0;
    for (int k = 0; k < 1500; ++k) {
      for (int i = 0; i <= 8; ++i) p.y.segment<3>(p.second.position_of(i)) += step * along;
      p.contact.update_candidates(p.y);
      const VectorXd next = p.rows();
      if (k > 0) bend = std::max(bend, (next - 2.0 * here + before).lpNorm<Eigen::Infinity>());
      way = std::max(way, (next - here).lpNorm<Eigen::Infinity>());
      before = here;
      here = next;
    }
    // A kink would show as some (step/h) F = 8e-4 F; the weights N'' bend by 6 (step/h)^2 = 4e-6.
    EXPECT_GT(way, 3e-4 * force);
    EXPECT_LT(bend, 4e-5 * force);
  }
}

// Both straight wires turned about the line through their nearest points, and moved, as one body do not slide
// on each other.
TEST(WirePair, ARigidMotionOfBothIsNoSliding) {
  Motion motion = crossed_wires(50.0 * degree, -1e-6, 8);
  motion.wire_pairs[0].friction = soft_friction();
  Pair p(motion);
  // Turns across both wires do not turn the wires about themselves.
  const Vector3d spin(0.0, 3.0, 0.0), velocity(0.3, 0.1, -0.2);
  for (const wire::RodPart* rod : {&p.first, &p.second}) {
    for (int i = 0; i <= 8; ++i)
      p.y.segment<3>(rod->velocity_of(i)) =
          velocity + spin.cross(Vector3d(p.y.segment<3>(rod->position_of(i))));
  }
  ASSERT_GT(p.sums().normal, 0.01);
  EXPECT_NEAR(p.sums().lost_power, 0.0, 1e-12);
  for (const ContactSample& s : p.contact.sample({0.0, p.y, p.y}).points) EXPECT_LT(s.slip_speed, 1e-12);
}

// Side by side they also turn about the axis across both without sliding.
TEST(WirePair, ParallelWiresThatTurnTogetherDoNotSlide) {
  Motion motion = crossed_wires(0.0, -1e-6, 8);
  motion.wire_pairs[0].friction = soft_friction();
  Pair p(motion);
  const Vector3d spin(0.0, 3.0, -2.0);
  for (const wire::RodPart* rod : {&p.first, &p.second}) {
    for (int i = 0; i <= 8; ++i)
      p.y.segment<3>(rod->velocity_of(i)) = spin.cross(Vector3d(p.y.segment<3>(rod->position_of(i))));
  }
  for (const ContactSample& s : p.contact.sample({0.0, p.y, p.y}).points) EXPECT_LT(s.slip_speed, 1e-6);
}

// Without friction and damping the forces are the derivatives of the energy.
TEST(WirePair, ForcesAreTheGradientOfTheEnergy) {
  for (const double angle : {80.0, 20.0}) {
    const auto made = wavy(angle * degree, {}, 2e-6);
    Pair& p = *made;
    p.y.segment(p.first.velocity_of(0), 27).setZero();
    p.y.segment(p.second.velocity_of(0), 27).setZero();
    const VectorXd rows = p.rows();
    for (const wire::RodPart* rod : {&p.first, &p.second}) {
      for (int i = 1; i < 8; ++i) {
        for (int a = 0; a < 3; ++a) {
          const int k = rod->position_of(i) + a;
          const double at = p.y[k], step = 2e-8;
          p.y[k] = at + step;
          const double more = p.sums().energy;
          p.y[k] = at - step;
          const double less = p.sums().energy;
          p.y[k] = at;
          const double force = rows[rod->velocity_of(i) + a];
          EXPECT_NEAR(force, (more - less) / (2.0 * step), 1e-4 * p.sums().normal) << i << ' ' << a;
        }
      }
    }
  }
}

// The nearest points of two wires in waves against dense sampling.
TEST(WirePair, NearestPointsAreThoseOfSampledWires) {
  const auto made = wavy(35.0 * degree, {}, -1e-3);
  const Pair& p = *made;
  const auto point = [&](const wire::RodPart& rod, std::size_t wire, double s) {
    const BezierWire& curve = p.contact.search().curve(wire);
    const int e = curve.element_at(s);
    return Vector3d(curve.control(e, p.y) * bernstein((s - curve.begin(e)) / rod.constants().length * 8.0));
  };
  double least = 1.0;
  for (int i = 0; i <= 2000; ++i) {
    const Vector3d x = point(p.first, 0, 0.2 * i / 2000.0);
    for (int j = 0; j <= 2000; ++j)
      least = std::min(least, (x - point(p.second, 1, 0.2 * j / 2000.0)).norm());
  }
  EXPECT_NEAR(p.contact.search().nearest(p.y).gap, least - 1.7e-3, 2e-6);
}

}  // namespace
}  // namespace snare::coupling
