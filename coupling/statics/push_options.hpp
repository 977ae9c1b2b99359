#pragma once

#include "coupling/statics/push_problem.hpp"

#include <array>
#include <functional>
#include <vector>

namespace snare::coupling {

/// One number that a push test depends on, for the derivatives of its curve.
struct PushVariation {
  std::function<void(PushProblem& test, double amount)> apply;  ///< changes the number by this amount
  /// Amount for the central differences of the residual, > 0; admissible both ways
  double step = 0.0;
  /// d travel / d amount at every point: -1 for a zero of the travel that is displaced
  double travel = 0.0;
  /// d compliance / d amount of the left and the right mount along the chord [m/N], where they are rigid:
  /// each then moves by its reaction.
  std::array<double, 2> mount_compliance{};
};

/// How a push is computed, and what is asked of it beside the force.
struct PushOptions {
  int elements = 256;   ///< edges, a multiple of 4, >= 16
  double grading = -1;  ///< of the mesh; < 0 chooses from the boundary layer
  Instability instability = Instability::follow_path;
  int max_iterations = 12;      ///< Newton iterations a step
  double smallest_step = 1e-9;  ///< of the travel [m]
  double largest_step = 0.05;   ///< of the travel, as a share of the span [-], > 0
  /// Error of one step of a path with steps of its own, as a share of the forces on the wire [-], > 0
  double path_tolerance = 1e-3;
  /// PushCurve::steps of another mesh or of a test that differs little, to be taken instead of steps of its
  /// own: forces are then smooth functions of the numbers of the test
  std::vector<std::vector<double>> steps;
  /// Count the modes that leave the plane (a spatial factorisation a point)
  bool examine_out_of_plane = false;
  bool examine_rates = false;  ///< fill viscous_stiffness (planar pushes)
  /// Numbers by which the force is differentiated: see differentiable()
  std::vector<PushVariation> variations;
  std::vector<double> shapes_at;                ///< travels at which to keep the shape [m]
  std::function<bool(double travel)> progress;  ///< called after every point; false stops the run
  std::function<bool()> stop;                   ///< asked between points, too; true stops the run
};

}  // namespace snare::coupling
