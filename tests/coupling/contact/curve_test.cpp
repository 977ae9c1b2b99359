#include "coupling/contact/curve.hpp"

#include <gtest/gtest.h>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;

// A parabola x(S) = a + b S + c S^2 has the slope b at S = 0 whatever the edges.
TEST(VertexSlope, IsExactOnAParabola) {
  const Vector3d b(0.9, -0.3, 0.2);
  const Vector3d c(4.0, 7.0, -2.0);
  const double h0 = 0.02;
  const double h1 = 0.005;
  const VertexSlope<3> slope = vertex_slope<3>(b * h0 - c * h0 * h0, b * h1 + c * h1 * h1, h0, h1);
  EXPECT_LT((slope.u - b).norm(), 1e-14);  // round-off of numbers of the order of 1
}

TEST(VertexSlope, DerivativesByTheRestLengthsMatchDifferences) {
  const Vector3d e0(0.02, 0.004, -0.001);
  const Vector3d e1(0.006, -0.001, 0.002);
  const double h0 = 0.019;
  const double h1 = 0.007;
  const VertexSlope<3> slope = vertex_slope<3>(e0, e1, h0, h1);
  const double d = 1e-7;
  const Vector3d by_before =
      (vertex_slope<3>(e0, e1, h0 + d, h1).u - vertex_slope<3>(e0, e1, h0 - d, h1).u) / (2.0 * d);
  const Vector3d by_after =
      (vertex_slope<3>(e0, e1, h0, h1 + d).u - vertex_slope<3>(e0, e1, h0, h1 - d).u) / (2.0 * d);
  // Round-off 1e-16/1e-7 and (d/h)^2, 2e-10 of derivatives of the order of 1/h.
  EXPECT_LT((slope.by_before - by_before).norm(), 1e-7 / h0);
  EXPECT_LT((slope.by_after - by_after).norm(), 1e-7 / h1);
}

// At an end of the wire, in the plane: the slope of the only edge, e/h, and its derivative -e/h^2.
TEST(VertexSlope, OfAnEndIsThatOfItsEdge) {
  const Eigen::Vector2d e(0.02, 0.01);
  const Eigen::Vector2d none = Eigen::Vector2d::Zero();
  const VertexSlope<2> left = vertex_slope<2>(none, e, 0.0, 0.025);
  const VertexSlope<2> right = vertex_slope<2>(e, none, 0.025, 0.0);
  EXPECT_LT((left.u - e / 0.025).norm(), 1e-15);
  EXPECT_LT((right.u - left.u).norm(), 1e-15);
  EXPECT_LT((left.by_after + e / (0.025 * 0.025)).norm(), 1e-12);
  EXPECT_EQ(left.before, 0.0);
  EXPECT_EQ(right.after, 0.0);
}

}  // namespace
}  // namespace snare::coupling
