#pragma once

#include "coupling/statics/push_curve.hpp"
#include "coupling/statics/push_options.hpp"
#include "coupling/statics/push_problem.hpp"

#include <vector>

namespace snare::coupling {

/// Force-displacement curve of one push by the discrete rod on one mesh.        theory.md (C.2)-(C.9)
/// The lengths, stiffnesses and positions of `test` must be positive and fit each other, as a reader of tests
/// sees to; travel may go up and down. coarsening 1, 2 or 4: every, every second or every fourth vertex of
/// the mesh is used.
[[nodiscard]] PushCurve solve_push(const PushProblem& test, const PushOptions& options, int coarsening = 1);

/// Whether PushOptions::variations can be answered: planar pushes.
[[nodiscard]] bool differentiable(const PushProblem& test);

/// The same from this mesh and from those of a half and a quarter of its edges, combined to cancel the errors
/// in h^2 and h^4 (Richardson 1911): F = (64 F_h - 20 F_2h + F_4h)/45.                  theory.md (W.11)
/// `discretisation_error` estimates what is left: twice the difference to (32 F_h - 12 F_2h + F_4h)/21, which
/// cancels h^2 and h^3 (the half cells at clamps leave a little of h^3). The meshes take the same steps:
/// theory.md (N.9). A path with steps of its own adds their error: the largest change of the force up to the
/// point when the coarsest mesh leaves out every second step. Points at which the meshes differ in their
/// state of contact keep the finest mesh's values; their error is what the forces of the meshes differ by,
/// not a number where neither coarser mesh has come there.
struct ExtrapolatedCurve {
  PushCurve curve;                           ///< of the finest mesh, extrapolated
  std::vector<double> discretisation_error;  ///< of the force, one a point [N]
};
[[nodiscard]] ExtrapolatedCurve solve_push_extrapolated(const PushProblem& test, const PushOptions& options);

/// Curve of this mesh alone. `discretisation_error` is that of the path's own steps; the mesh's is not known.
[[nodiscard]] ExtrapolatedCurve solve_push_with_path_error(const PushProblem& test,
                                                           const PushOptions& options);

}  // namespace snare::coupling
