#pragma once

#include <vector>

#include "numerics/report.hpp"
#include "validation/elastica_problem.hpp"

namespace snare::validation {

/// One section of the wire.
struct ElasticaPoint {
  double arc_length = 0.0;  ///< unstressed, from the left mount [m]
  double x = 0.0;           ///< [m]
  double y = 0.0;           ///< [m]
  double angle = 0.0;       ///< of the tangent against the chord [rad]
  double moment = 0.0;      ///< [N m]
  double tension = 0.0;     ///< [N]
};

/// An equilibrium of the pushed wire.
struct ElasticaState {
  numerics::SolveReport report;
  double travel = 0.0;               ///< of the pusher since the first touch [m]
  double force = 0.0;                ///< along the pusher's motion, by the pusher on the wire [N]
  double force_along_chord = 0.0;    ///< by the pusher on the wire, along +x [N]
  double pusher_height = 0.0;        ///< y of the pusher's axis [m]
  double tension_left = 0.0;         ///< N = n . t at the left mount [N]
  double tension_right = 0.0;        ///< at the right mount [N]
  double reaction_left_y = 0.0;      ///< by the left mount on the wire [N]
  double reaction_right_y = 0.0;     ///< by the right mount on the wire [N]
  bool wrapped = false;              ///< in contact along an arc, not in a point
  double contact_begin = 0.0;        ///< unstressed arc length of the first point in contact [m]
  double contact_end = 0.0;          ///< of the last; equals contact_begin in a point contact [m]
  double contact_x = 0.0;            ///< wire's axis at contact_begin [m]
  double contact_y = 0.0;            ///< [m]
  bool determinant_positive = true;  ///< of the shooting Jacobian: a change along a path tells a fold or
                                     ///< a branch point
  std::vector<ElasticaPoint> shape;  ///< section by section, both sides, ordered by arc length
};

/// Equilibria of the pushed elastica by multiple shooting; the reference the discrete rod is held against.
///
/// Equations: elastica_flow.hpp on either side of the contact, r, theta and M continuous there,
/// f = n(S-) - n(S+), and contact geometry r(S_c) = c + sigma R nu with nu the wire's left normal and
/// sigma = +1 with the bulge, -1 against it.  Sliding: f . t = friction_slope (sigma f . nu).
///
/// Wrapped contact (no friction): where the wire would be bent sharper than the cylinder, it lies on an
/// arc of curvature 1/R.  There n' + q nu = 0, M = EI(-sigma (1+e)/R - kappa0) and N = EA e give
/// e' (EA + EI/R^2) = 0: tension uniform, shear zero, and a point force at either lift-off point.
///
/// The unloaded shape is the first buckled mode; the path starts at the first touch, travel 0, and is
/// followed by adaptive steps.  Relative error of the force: below 1e-9, set by rounding (measured by
/// changing pieces_per_side from 4 to 32, declared wire and inextensible limit alike).  Boundary layers
/// sqrt(EI/T) thinner than a tenth of a piece lose digits: use more pieces. From a straight, unstretched wire
/// the path cannot be started when EA l^2/EI exceeds about 1e9.  Throws std::invalid_argument for a value
/// outside its range; when the path cannot be followed (a fold in travel) the state's report is not usable.
[[nodiscard]] ElasticaState push(const ElasticaPush& problem, double travel);

/// The same at several travels [m], in the order given, each continued from the one before. Ends with the
/// first state that could not be reached.
[[nodiscard]] std::vector<ElasticaState> push_path(const ElasticaPush& problem,
                                                   const std::vector<double>& travels);

/// The path by pseudo arc length from the first touch, through folds in travel. Point contact only.
/// step: length along the path, > 0, in the norm of the pusher's height over L and the root mean squares of
/// the sections' heights over L and angles [rad]; count: states, the first touch included.
[[nodiscard]] std::vector<ElasticaState> push_through_folds(const ElasticaPush& problem, double step,
                                                            int count);

}  // namespace snare::validation
