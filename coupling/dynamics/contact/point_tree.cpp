#include "coupling/dynamics/contact/point_tree.hpp"

#include <algorithm>
#include <numeric>

namespace snare::coupling {

using Eigen::Vector3d;

PointTree::PointTree(const std::vector<Vector3d>& points) {
  std::vector<std::size_t> all(points.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  balls_.reserve(2 * points.size());
  if (!points.empty()) add(points, std::move(all));
}

// Halves along the longest side of the box round the points.
void PointTree::add(const std::vector<Vector3d>& points, std::vector<std::size_t> members) {
  const std::size_t self = balls_.size();
  Ball& ball = balls_.emplace_back();
  if (members.size() == 1) {
    ball.centre = points[members.front()];
    ball.point = members.front();
  } else {
    Vector3d low = points[members.front()], high = low;
    for (const std::size_t k : members) {
      low = low.cwiseMin(points[k]);
      high = high.cwiseMax(points[k]);
    }
    ball.centre = 0.5 * (low + high);
    for (const std::size_t k : members) ball.radius = std::max(ball.radius, (points[k] - ball.centre).norm());
    Eigen::Index side = 0;
    (high - low).maxCoeff(&side);
    const auto middle = members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
    std::nth_element(members.begin(), middle, members.end(), [&](std::size_t a, std::size_t b) {
      return points[a][side] != points[b][side] ? points[a][side] < points[b][side] : a < b;
    });
    add(points, {members.begin(), middle});
    add(points, {middle, members.end()});
  }
  balls_[self].next = balls_.size();
}

}  // namespace snare::coupling
