#pragma once

#include "coupling/statics/push_sensitivity.hpp"
#include "coupling/statics/push_system.hpp"
#include "coupling/statics/push_problem.hpp"

#include <functional>
#include <string>
#include <vector>

namespace snare::coupling {

/// Something that happened along the path.
struct PushEvent {
  enum class Kind {
    first_touch, lift_off, touch, slip_begins, slip_ends, wrap_begins, wrap_ends, mount_slips, mount_holds,
    fold,         ///< the travel turns back along the path: under control of the travel the wire snaps here
    bifurcation,  ///< another branch crosses; beyond it this one is unstable
    snap          ///< the wire jumped to another stable shape
  };
  Kind kind{};
  double travel = 0.0;  ///< [m]
};
[[nodiscard]] std::string to_string(PushEvent::Kind kind);

/// One point of a force-displacement curve. SI units.
struct PushPoint {
  double travel = 0.0;         ///< of the pusher from first touch [m]
  double force = 0.0;          ///< on the pusher along the push, positive when the wire resists [N]
  double transverse_force = 0.0;  ///< on the pusher across the push, along the chord [N]
  double normal_force = 0.0;   ///< of the pusher on the wire, all contact points together [N], >= 0
  double friction_force = 0.0; ///< along the wire, the same way [N]; |friction| <= mu normal
  double axial_force = 0.0;    ///< on the pusher along z, where it is tilted [N]
  double tension_left = 0.0;   ///< axial force in the wire at the left mount, tension positive [N]
  double tension_right = 0.0;  ///< at the right mount [N]
  double contact_coordinate = 0.0;  ///< material coordinate of the (middle of the) contact from the left mount [m]
  double wrapped_length = 0.0; ///< length of wire that lies on the pusher [m]; 0 for contact at a point
  double energy = 0.0;         ///< elastic energy and potential of the weight [J]
  double dissipated = 0.0;     ///< friction work so far [J], never decreasing
  double imbalance = 0.0;      ///< |mounts + pusher + weight| [N]: action and reaction
  int out_of_plane_modes = 0;  ///< unstable ones that leave the plane, when asked for
  int unstable_modes = 0;      ///< negative eigenvalues of the constrained tangent: 0 is stable
  bool in_contact = true;
  bool slipping = false;       ///< friction only: the contact slides
  double viscous_stiffness = 0.0;  ///< rate form of the wire by the travel, when asked for [N/m]: theory.md (W.14)
  std::vector<double> force_by;    ///< d force / d number of every variation asked for
  int iterations = 0;          ///< Newton iterations since the point before
  bool converged = true;
};

/// Shape of the wire at one point, for plots. SI units, one entry a vertex (tension: the mean of its edges).
struct PushShape {
  double travel = 0.0;
  Eigen::Vector2d pusher_centre = Eigen::Vector2d::Zero();
  std::vector<double> x, y, arc, tension, moment;
};

struct PushOptions {
  int elements = 256;   ///< edges, a multiple of 4, >= 16
  double grading = -1;  ///< of the mesh; < 0 chooses from the boundary layer
  Instability instability = Instability::follow_path;
  int max_iterations = 12;      ///< Newton iterations a step
  double smallest_step = 1e-9;  ///< of the travel [m]
  bool examine_out_of_plane = false;  ///< count the modes that leave the plane (a spatial factorisation a point)
  bool examine_rates = false;     ///< fill viscous_stiffness (planar pushes)
  std::vector<PushVariation> variations;  ///< numbers by which the force is differentiated: see differentiable()
  std::vector<double> shapes_at;  ///< travels at which to keep the shape [m]
  std::function<bool(double travel)> progress;  ///< called after every point; false stops the run
};

struct PushCurve {
  std::vector<PushPoint> points;
  std::vector<PushEvent> events;
  std::vector<PushShape> shapes;
  double natural_height = 0.0;  ///< of the wire at the contact before the push [m]
  double touch_height = 0.0;    ///< of the pusher's centre at first touch [m]
  int newton_iterations = 0;    ///< all, with those of the initial shape
  numerics::SolveReport report; ///< why it ended; `points` hold what was reached
};

/// Force-displacement curve of one push by the discrete rod on one mesh.        theory.md (C.2)-(C.9)
/// The test must be admissible (see identification::read_experiment); travel may go up and down.
/// coarsening 1, 2 or 4: only every so ordinal vertex of the mesh is used.
[[nodiscard]] PushCurve solve_push(const PushProblem& test, const PushOptions& options, int coarsening = 1);

/// Whether PushOptions::variations can be answered: planar pushes.
[[nodiscard]] bool differentiable(const PushProblem& test);

/// The same from this mesh and from those of a half and a quarter of its edges, combined to cancel the errors in
/// h^2 and h^4 (Richardson 1911): F = (64 F_h - 20 F_2h + F_4h)/45.                  theory.md (W.11)
/// `discretisation_error` estimates what is left: twice the difference to (32 F_h - 12 F_2h + F_4h)/21, which cancels h^2
/// and h^3 (the half cells at clamps leave a little of h^3). Points at which the meshes
/// differ in their state of contact keep the finest mesh's values.
struct ExtrapolatedCurve {
  PushCurve curve;                           ///< of the finest mesh, extrapolated
  std::vector<double> discretisation_error;  ///< of the force, one a point [N]
};
[[nodiscard]] ExtrapolatedCurve solve_push_extrapolated(const PushProblem& test, const PushOptions& options);

}  // namespace snare::coupling
