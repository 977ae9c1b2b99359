#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace snare::coupling {

/// Balls round points, and round those balls, so that what is far from all need not be asked of each.
class PointTree {
 public:
  struct Ball {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< in the frame of the points [m]
    double radius = 0.0;                               ///< [m]
    std::optional<std::size_t> point;                  ///< of a leaf, which has no radius
    std::size_t next = 0;                              ///< the ball behind all that this one holds
  };

  /// Points in one frame [m].
  explicit PointTree(const std::vector<Eigen::Vector3d>& points);

  /// Calls `enter` with a ball, and where it says true with the balls inside, down to the points.
  template <class Enter>
  void visit(const Enter& enter) const {
    for (std::size_t k = 0; k < balls_.size();) k = enter(balls_[k]) ? k + 1 : balls_[k].next;
  }

 private:
  void add(const std::vector<Eigen::Vector3d>& points, std::vector<std::size_t> members);

  std::vector<Ball> balls_;  // each before those inside it
};

}  // namespace snare::coupling
