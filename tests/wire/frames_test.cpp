#include "wire/frames.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>

namespace snare::wire {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// A few operations on numbers of order one.
constexpr double kRoundOff = 4e-15;

Vector3d random_unit(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(random), normal(random), normal(random)).normalized();
}

TEST(Frames, AnyNormalIsUnitAndPerpendicular) {
  std::mt19937 random(1);
  for (int k = 0; k < 20; ++k) {
    const Vector3d t = k < 3 ? Vector3d(Vector3d::Unit(k)) : random_unit(random);
    EXPECT_NEAR(any_normal(t).dot(t), 0.0, kRoundOff);
    EXPECT_NEAR(any_normal(t).norm(), 1.0, kRoundOff);
  }
}

TEST(Frames, ParallelTransportIsTheSmallestRotation) {
  std::mt19937 random(2);
  for (int k = 0; k < 20; ++k) {
    const Vector3d from = random_unit(random);
    const Vector3d to = random_unit(random);
    const Vector3d v = any_normal(from);
    const Vector3d expected = Eigen::Quaterniond::FromTwoVectors(from, to) * v;
    // 1 + from.to may be small: its reciprocal magnifies the round-off.
    EXPECT_LT((parallel_transport<double>(v, from, to) - expected).norm(),
              10.0 * kRoundOff / (1.0 + from.dot(to)));
  }
  const Vector3d t = random_unit(random);
  EXPECT_LT((parallel_transport<double>(any_normal(t), t, t) - any_normal(t)).norm(), kRoundOff);
}

TEST(Frames, TransportDoesNotTurnAboutTheTangent) {
  // d(director)/dt = (tangent x d(tangent)/dt) x director: no component along tangent x director.
  std::mt19937 random(3);
  const Vector3d t = random_unit(random);
  const Frame frame{t, any_normal(t)};
  const Vector3d rate = random_unit(random);
  const double h = 1e-4;
  const Frame ahead = transport(frame, (t + h * rate).normalized());
  const Frame behind = transport(frame, (t - h * rate).normalized());
  // Central difference: error h^2 = 1e-8.
  EXPECT_NEAR((ahead.director - behind.director).dot(t.cross(frame.director)) / (2.0 * h), 0.0, 1e-8);
}

TEST(Frames, StayOrthonormalOverManySteps) {
  std::mt19937 random(4);
  Frame frame{Vector3d::UnitX(), Vector3d::UnitY()};
  for (int k = 0; k < 10000; ++k)
    frame = transport(frame, (frame.tangent + 0.3 * random_unit(random)).normalized());
  EXPECT_NEAR(frame.director.norm(), 1.0, kRoundOff);
  EXPECT_NEAR(frame.director.dot(frame.tangent), 0.0, kRoundOff);
}

TEST(Frames, HolonomyIsTheSolidAngle) {
  // Around the octant x -> y -> z -> x the director turns by the octant's area, pi/2, to the left.
  const Frame start{Vector3d::UnitX(), Vector3d::UnitY()};
  Frame frame = transport(start, Vector3d::UnitY());
  frame = transport(frame, Vector3d::UnitZ());
  frame = transport(frame, Vector3d::UnitX());
  EXPECT_NEAR(reference_twist(start, frame, 0.0), pi / 2.0, kRoundOff);
}

TEST(Frames, ReferenceTwistInvertsTurnedDirector) {
  std::mt19937 random(5);
  const Vector3d t = random_unit(random);
  const Frame before{t, any_normal(t)};
  const Vector3d u = (t + 0.5 * random_unit(random)).normalized();
  for (const double angle : {-3.0, -0.4, 0.0, 1.0, 3.1}) {
    Frame after = transport(before, u);
    after.director = turned_director(after, angle);
    EXPECT_NEAR(reference_twist(before, after, 0.0), angle, kRoundOff);
    EXPECT_NEAR(reference_twist(before, after, angle + 40.0 * pi + 0.5), angle + 40.0 * pi,
                1e-13);  // eps * 130
    EXPECT_NEAR(reference_twist(before, after, angle - 40.0 * pi - 3.0), angle - 40.0 * pi, 1e-13);
  }
}

TEST(Frames, ReferenceTwistCountsTurnsWithoutJumps) {
  const Frame before;
  double twist = 0.0;
  for (int k = 1; k <= 1000; ++k) {
    Frame after;
    after.director = turned_director(before, 0.5 * k);
    twist = reference_twist(before, after, twist);
  }
  EXPECT_NEAR(twist, 500.0, 1e-12);  // eps * 500
}

}  // namespace
}  // namespace snare::wire
