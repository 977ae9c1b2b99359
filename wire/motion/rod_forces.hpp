#pragma once

#include "numerics/dae.hpp"
#include "wire/motion/rod_losses.hpp"
#include "wire/motion/rod_model.hpp"
#include "wire/motion/rod_plane.hpp"
#include "wire/motion/rod_rows.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <vector>

namespace snare::wire {

/// Energy and forces of a rod in motion with those of damping and strands, four edges and then four vertices
/// at a time.
///                                                                             theory.md (M.3), (M.4), (M.14)
/// The vertices at the ends, where mounts act, are one by one.
class RodForces {
 public:
  /// four: whether four numbers are worked on at once, which the processor has to be able to, or two by two;
  /// the bits are the same.
  explicit RodForces(const RodModel& model, bool four = numerics::has_four_lanes());

  /// In which plane the rod is: then what is across it is left out. None: in space.
  void restrict_to_plane(const std::optional<RodPlane>& plane);
  /// Told the state from whose frames the next ones go.
  void take_frames(const RodInstant& accepted);
  /// At a point: frames, directors and twists of `trial`, whose mounts and unknowns are set, and what the rod
  /// does.
  void evaluate(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial, const RodSums& out);

  /// All numbers as they are at the last point.
  [[nodiscard]] const RodRows& rows() const { return rows_; }

 private:
  using Row = RodRow;
  void take_unknowns(const RodModel& model, const numerics::DaePoint& at);
  void work(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial, const RodSums& out);
  void evaluate_avx2(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial,
                     const RodSums& out);
  void work_by_two(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial,
                   const RodSums& out);
  void work_on_edges(const RodModel& model, RodInstant& trial, const RodSums& out);
  void work_on_vertices(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial,
                        const RodSums& out);
  void turn_frames(RodInstant& trial) const;
  void gather(const RodModel& model, const RodSums& out);
  void add_end(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial, End end,
               const RodSums& out);

  bool four_;
  std::optional<RodPlane> plane_;
  RodRows rows_;
};

}  // namespace snare::wire
