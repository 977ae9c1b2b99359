#pragma once

#include "numerics/dae.hpp"
#include "wire/rod_model.hpp"
#include "wire/rod_rows.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace snare::wire {

/// What damping and strands do at a point.
struct RodLosses {
  double power = 0.0;                                                                        ///< that they take [W]
  double strand_energy = 0.0;                                                                ///< stored [J]
  std::array<Eigen::Vector3d, 2> couples{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  ///< of the mounts [N m]
  std::vector<Eigen::Vector2d> strand_rates;  ///< z' of every vertex [1/(m s)]
};

/// Energy and forces of a rod in motion with those of damping and strands, four edges and then four vertices at a time.
///                                                                                  theory.md (M.3), (M.4), (M.14)
/// The vertices at the ends, where mounts act, are one by one.
class RodForces {
 public:
  /// four: whether four numbers are worked on at once, which the processor has to be able to, or two by two; the bits are the
  /// same.
  explicit RodForces(const RodModel& model, bool four = numerics::has_four_lanes());

  /// Told the state from whose frames the next ones go.
  void take_frames(const RodInstant& accepted);
  struct Results {
    RodAssembly& assembly;           ///< energy and gradient by bands
    Eigen::Matrix2Xd& by_curvature;  ///< dE/dk [N m^2] of higher order
    RodLosses& losses;
  };
  /// At a point: frames, directors and twists of `trial`, whose mounts and unknowns are set, and what the rod does.
  void evaluate(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial, const Results& out);

  /// All numbers as they are at the last point.
  [[nodiscard]] const RodRows& rows() const { return rows_; }

 private:
  using Row = RodRow;
  void take_unknowns(const RodModel& model, const numerics::DaePoint& at);
  void work(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial, const Results& out);
  void work_by_four(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial, const Results& out);
  void work_by_two(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial, const Results& out);
  void work_on_edges(const RodModel& model, RodInstant& trial, const Results& out);
  void work_on_vertices(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial, const Results& out);
  void gather(const RodModel& model, const Results& out);
  void add_end(const RodModel& model, const numerics::DaePoint& at, RodInstant& trial, End end, const Results& out);

  bool four_;
  RodRows rows_;
};

}  // namespace snare::wire
