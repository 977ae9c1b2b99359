#include "coupling/dynamics/contact/point_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> cloud(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  std::vector<Vector3d> points;
  for (int k = 0; k < count; ++k) points.emplace_back(place(random), 0.1 * place(random), place(random));
  if (count > 4) points[4] = points[2];  // two in one place
  return points;
}

TEST(PointTree, BallsHoldAllThatFollowsInThem) {
  const std::vector<Vector3d> points = cloud(100);
  const PointTree tree(points);
  std::vector<int> seen(points.size(), 0);
  std::vector<PointTree::Ball> around;  // of all balls in the order of the visit
  tree.visit([&](const PointTree::Ball& ball) {
    const std::size_t index = around.size();
    if (ball.point) {
      ++seen[*ball.point];
      for (const PointTree::Ball& outer : around) {
        if (outer.next <= index) continue;
        EXPECT_LE((points[*ball.point] - outer.centre).norm(), outer.radius * (1.0 + 1e-12));
      }
    }
    around.push_back(ball);
    return true;
  });
  EXPECT_TRUE(std::ranges::all_of(seen, [](int times) { return times == 1; }));
}

TEST(PointTree, FindsWhatASearchThroughAllFinds) {
  const std::vector<Vector3d> points = cloud(200);
  const PointTree tree(points);
  const Vector3d centre(0.3, 0.0, -0.2);
  std::vector<std::size_t> near;
  int asked = 0;
  tree.visit([&](const PointTree::Ball& ball) {
    ++asked;
    if ((ball.centre - centre).norm() - ball.radius > 0.2) return false;
    if (ball.point) near.push_back(*ball.point);
    return true;
  });
  std::ranges::sort(near);
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if ((points[k] - centre).norm() <= 0.2) all.push_back(k);
  }
  EXPECT_EQ(near, all);
  EXPECT_LT(asked, 100);
}

TEST(PointTree, MayBeEmptyOrOfOnePoint) {
  int asked = 0;
  const auto count = [&asked](const PointTree::Ball&) {
    ++asked;
    return true;
  };
  PointTree({}).visit(count);
  EXPECT_EQ(asked, 0);
  PointTree({Vector3d::Zero()}).visit(count);
  EXPECT_EQ(asked, 1);
}

}  // namespace
}  // namespace snare::coupling
