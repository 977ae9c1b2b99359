#pragma once

#include <Eigen/Core>

#include <vector>

namespace snare::coupling {

/// One edge of a profile, from the end of the one before: a straight line or the minor arc of a circle.
struct ProfileEdge {
  Eigen::Vector2d end = Eigen::Vector2d::Zero();  ///< (distance from the axis, height z) [m]
  /// [1/m]; > 0 bulges outward, < 0 inward, 0: straight; at most 2/(length of the chord).
  double curvature = 0.0;
};

/// The section of a solid of revolution in the half plane (rho, z), bounded by straight edges and arcs.
///
/// It runs upward with the outside on its right: from the lower end on the axis to the upper one, or, where
/// the solid has a hole along its axis, round a loop back to its start.                       theory.md (G.3)
class Profile {
 public:
  /// Edges one after the other, counted on from the first through the start of a loop.
  struct Chain {
    int first = 0;
    int count = 0;
  };
  /// The nearest point of a chain.
  struct Near {
    double distance = 0.0;                              ///< signed by the side of the edges beside it [m]
    Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< its gradient in the half plane
    double bending = 0.0;                               ///< its second derivative across the gradient [1/m]
  };

  /// start: on the axis or, of a loop, off it [m]. Throws InputError: fewer than two edges, a point left of
  /// the axis or where the one before is, an end that is neither on the axis nor the start, an arc of too
  /// small a radius, a profile that crosses itself or has the outside on its left.
  Profile(const Eigen::Vector2d& start, const std::vector<ProfileEdge>& edges);

  /// All its edges: once round a loop, else from end to end on the axis.
  [[nodiscard]] Chain whole() const { return {0, static_cast<int>(edges_.size())}; }
  /// What is left between its concave corners when arcs that are hollow with a radius of `wire_radius` [m] or
  /// less, in which no such wire fits, are left out. Between them these chains are nearest to whatever is
  /// farther out than that.
  ///                                                                                         theory.md (G.11)
  [[nodiscard]] std::vector<Chain> chains(double wire_radius) const;
  /// p: (rho, z) [m].
  [[nodiscard]] Near nearest(const Eigen::Vector2d& p, Chain chain) const;
  /// Points along a chain, arcs in `divisions` chords, for drawing [m].
  [[nodiscard]] std::vector<Eigen::Vector2d> outline(Chain chain, int divisions) const;

 private:
  /// With what is needed again and again.
  struct Edge {
    Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();     // of an arc
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();  // of the chord, unit
    double length = 0.0;                                  // of the chord
    double curvature = 0.0;
    [[nodiscard]] Eigen::Vector2d normal_at(const Eigen::Vector2d& p) const;
  };
  /// Where edges meet.
  struct Corner {
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();  // sum of those on both sides
    bool concave = false;
  };
  [[nodiscard]] const Edge& edge(int index) const;

  bool loop_ = false;
  std::vector<Edge> edges_;
  std::vector<Corner> corners_;  // before every edge, and behind the last
};

/// Edges through the corners of a polygon, each rounded by an arc of its radius that touches both sides [m,
/// >= 0; 0: sharp]. Where the first corner is off the axis the last is joined to it. Throws InputError as the
/// profile does, and where a side is too short for the arcs at its ends or an end on the axis is rounded.
[[nodiscard]] Profile rounded_profile(const std::vector<Eigen::Vector2d>& corners,
                                      const std::vector<double>& radii);

}  // namespace snare::coupling
