#pragma once

#include "coupling/statics/push_problem.hpp"
#include "coupling/statics/push_system.hpp"
#include "numerics/path.hpp"

#include <functional>
#include <memory>

namespace snare::benchmarks {

/// The wire that all timings are made on: solid SUS-304, 1.5 mm, 180 mm between clamps 175 mm apart, a knife
/// edge at mid-span pushing outward to 1.5 mm in 20 equal steps.
[[nodiscard]] coupling::PushProblem declared_push();

/// Force on that pusher at 1.5 mm [N]: planar extensible elastica by multiple shooting (snare::validation),
/// which shares no code with the rod.
inline constexpr double reference_force = 232.98287479;

/// A wire under the pusher as a path problem, and one point of it.
struct PressedWire {
  std::unique_ptr<wire::PlanarRod> rod;
  std::unique_ptr<coupling::PushSystem> system;
  numerics::PathPoint point;
};

/// In equilibrium at a travel [m]. Throws std::runtime_error where that is not reached.
[[nodiscard]] PressedWire pressed_wire(int elements, double travel);

/// Not in equilibrium: the inextensible buckled shape theta = A sin(2 pi S/L), touched without force. Its
/// matrix costs what any other does, and it is there for any number of elements (a multiple of 4).
[[nodiscard]] PressedWire buckled_shape(int elements);

/// What one Newton iteration does: assembly, convergence check, factorisation, solution. Throws
/// std::runtime_error when the matrix is singular.
void newton_iteration(coupling::PushSystem& system, const numerics::PathPoint& point,
                      numerics::PathWorkspace& workspace);

/// Wall-clock times of pieces of work that are run in turn, so that a disturbance of the machine meets all of
/// them.
/// Returns the median time of each [s] over `rounds` rounds of `repeats` runs.
[[nodiscard]] std::vector<double> median_times(const std::vector<std::function<void()>>& works, int rounds,
                                               int repeats);

}  // namespace snare::benchmarks
