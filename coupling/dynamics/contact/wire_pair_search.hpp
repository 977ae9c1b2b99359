#pragma once

#include "coupling/dynamics/contact/bezier_wire.hpp"
#include "coupling/dynamics/contact/element_boxes.hpp"
#include "coupling/dynamics/contact/foot_point.hpp"
#include "coupling/dynamics/model/model.hpp"

#include <Eigen/Core>

#include <array>
#include <utility>
#include <vector>

namespace snare::coupling {

/// The nearest points of two wires.
struct NearestPoints {
  std::array<double, 2> coordinates{0.0, 0.0};  ///< material [m]
  double gap = 0.0;                             ///< [m]
};

/// An element of one wire, and a run of elements of the other one that it may touch.
struct NearElements {
  int element = 0;
  int first = 0, last = 0;  ///< of the other wire
};

/// Which elements of two wires come near each other, and how long a step may be that no others do.
///                                                                                    theory.md (G.6), (G.13)
class WirePairSearch {
 public:
  WirePairSearch(const WirePair& pair, const wire::RodPart& a, const wire::RodPart& b);

  /// The curve of the first (0) or the second wire (1), element by element.
  [[nodiscard]] const BezierWire& curve(std::size_t wire) const { return curves_[wire]; }
  /// On a shorter way along a wire the gap has one minimum at most [m].
  [[nodiscard]] double resolution(std::size_t wire) const { return resolutions_[wire]; }
  /// The pair of places with the least gap, over all elements [m].
  [[nodiscard]] NearestPoints nearest(const numerics::VectorView& y) const;

  /// Told the unknowns y (SI units) of an accepted state.
  void update(const numerics::VectorView& y);
  /// Elements that may touch before the next accepted state, (of the first wire, of the second), in their
  /// order.
  [[nodiscard]] const std::vector<std::pair<int, int>>& candidates() const { return candidates_; }
  /// The same by the elements of either wire.
  [[nodiscard]] const std::vector<NearElements>& near(std::size_t wire) const { return near_[wire]; }
  /// A step in which no other elements can touch, and none pass each other, at twice the speeds of the state
  /// [s]; infinite at rest.
  [[nodiscard]] double longest_step() const { return longest_step_; }

 private:
  /// Moves the boxes to a state.
  void place(std::array<ElementBoxes, 2>& boxes, const numerics::VectorView& y) const;
  void look(std::size_t a, std::size_t b);
  void list_runs(std::size_t wire);
  void search(const std::array<ElementBoxes, 2>& boxes, const std::array<CubicPieces, 2>& pieces,
              std::size_t a, std::size_t b, NearestPoints& best) const;
  void search(const std::array<CubicPieces, 2>& pieces, int a, int b, NearestPoints& best) const;

  double thickness_;  // sum of the radii [m]
  std::array<const wire::RodPart*, 2> rods_;
  std::array<BezierWire, 2> curves_;
  std::array<double, 2> resolutions_{};
  double weight_sum_ = 1.0;
  double margin_ = 0.0;      // elements this near are candidates [m]
  double passed_ = 0.0;      // way that the wires have gone against each other since the start [m]
  double free_until_ = 0.0;  // others than the candidates do not touch before this way [m]
  double clear_ = 0.0;       // what was free when the boxes were last looked through [m]
  std::array<Eigen::Matrix3Xd, 2> last_;   // vertices of the last state [m]
  std::array<Eigen::VectorXd, 2> speeds_;  // of the vertices, less the mean of all [m/s]
  std::array<ElementBoxes, 2> boxes_;
  std::vector<std::pair<int, int>> candidates_;
  std::vector<std::pair<int, int>> turned_;  // workspace
  std::array<std::vector<NearElements>, 2> near_;
  double longest_step_ = 0.0;
};

}  // namespace snare::coupling
