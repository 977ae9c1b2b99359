#pragma once

#include "numerics/dae.hpp"
#include "wire/motion/rod_model.hpp"
#include "wire/motion/rod_plane.hpp"
#include "wire/motion/rod_rows.hpp"
#include "wire/motion/rod_slots.hpp"

#include <optional>
#include <vector>

namespace snare::wire {

/// Derivatives of a rod's forces with those of damping, four edges and then four vertices at a time.
///                                                                             theory.md (M.3), (M.4), (W.33)
/// They are added up by edges, of which each has its vector e = x_{i+1} - x_i and its angle: by 4 x 4 blocks
/// D of what an edge does to itself and to its neighbours. From there they go to the vertices,
///   K_ij = D_{i-1,j-1} - D_{i-1,j} - D_{i,j-1} + D_ij,
/// all at once into the values of the Jacobian. The ends, where mounts act, are one by one.
class RodStiffness {
 public:
  /// four: see RodForces.
  explicit RodStiffness(const RodModel& model, bool four = numerics::has_four_lanes());

  /// In which plane the rod is: then what is across it is left out. None: in space. Before `attach`.
  void restrict_to_plane(const std::optional<RodPlane>& plane) { plane_ = plane; }
  /// Where the values are, in a pattern to which the slots are attached.
  void attach(const RodModel& model, const RodSlots& slots);

  struct Point {
    const RodRows& rows;  ///< as the forces at this point have left them
    const RodInstant& instant;
    const numerics::DaePoint& at;
    double c;  ///< of DaePart::jacobian [1/s]
  };
  /// Adds all but inertia, mounts that give, strands and what the ends damp, in SI units.
  void add(const RodModel& model, const Point& point, std::vector<double>& values);

 private:
  void work(const RodModel& model, const Point& point);
  void evaluate_avx2(const RodModel& model, const Point& point);
  void work_by_two(const RodModel& model, const Point& point);
  void work_on_edges(const RodModel& model, const Point& point);
  void work_on_vertices(const RodModel& model, const Point& point);
  void add_end(const RodModel& model, const Point& point, End end);
  template <class Components>
  void list_slots(const RodModel& model, const RodSlots& slots, const Components& components);
  template <class Components>
  void put_components(const RodModel& model, const Components& components, std::vector<double>& values) const;
  void put_all(const RodModel& model, std::vector<double>& values) const;
  void put_by_four(const RodModel& model, std::vector<double>& values) const;
  void put_by_two(const RodModel& model, std::vector<double>& values) const;

  bool four_;
  std::optional<RodPlane> plane_;
  RodRows blocks_;
  std::vector<int> slots_;  // of the entries, -1: none
};

}  // namespace snare::wire
