#pragma once

#include "wire/frames.hpp"
#include "wire/mesh.hpp"
#include "wire/spatial_properties.hpp"
#include "wire/specification.hpp"

#include <Eigen/Core>

namespace snare::wire {

/// Material and mass-proportional damping of a wire.                                     theory.md (M.4)
struct RodDamping {
  /// Kelvin-Voigt time of bending: M = EI (kappa + tau dkappa/dt) [s], >= 0. A mode of angular frequency w
  /// then has the damping ratio tau w/2, that is tau = ln(A_0/A_n)/(pi n w) from n periods of a ring-down.
  double bending_time = 0.0;
  double axial_time = 0.0;  ///< of stretching: N = EA (e + tau de/dt) [s], >= 0
  double mass_rate = 0.0;   ///< force -a m v against motion in the world [1/s], >= 0: damping ratio a/(2 w)
};

/// Strands that slide on each other when the wire bends (Papailiou 1997), the slider of (W.13) in both
/// directions of bending, with a dashpot beside its spring:                                  theory.md (M.14)
///   z' = (m - z)/tau,   m = e for |e| <= slip_curvature, else slip_curvature e/|e|,   e = z + tau kappa'
/// z: curvature that the friction holds [1/m]; the strands add the moment extra_stiffness m to EI kappa. A
/// wire begins with z = 0, as one that has been shaken.
struct RodStrands {
  double extra_stiffness = 0.0;  ///< added to EI while the strands stick [N m^2], >= 0; 0: none
  double slip_curvature = 0.0;   ///< at which a virgin section begins to slip [1/m], > 0
  double time = 1e-5;            ///< tau, short beside the motion [s], > 0
  [[nodiscard]] bool act() const { return extra_stiffness > 0.0; }
};

/// How a wire's bending is discretised.
enum class Formulation {
  vertices,  ///< curvature lumped at the vertices, chords that stretch: second order                  (W.27)
  /// curvatures as unknowns, edges as beams: fourth order for loads on vertices, (W.31) to (W.33)
  higher_order
};

/// Constants of a wire in motion.
struct RodInMotion {
  SpatialRodProperties properties;  ///< stiffness, mounts, weight
  double mass_per_length = 0.0;     ///< [kg/m], > 0
  double length = 0.0;              ///< unstretched [m], > 0
  int elements = 60;                ///< >= 4
  double grading = 0.0;             ///< of the mesh, see MaterialMesh; 0: equal edges
  Formulation formulation = Formulation::vertices;
  /// All but a thousandth of its inertia is left out: positions follow the forces at once, but for what
  /// damping delays (M.18).
  bool quasi_static = false;
  RodDamping damping;
  RodStrands strands;

  /// Its mesh; no contact moves it, so that its middle vertex stays where it is.
  [[nodiscard]] int middle() const { return elements / 2; }
  [[nodiscard]] MaterialMesh mesh() const { return {middle(), elements - middle(), grading}; }
  [[nodiscard]] Controls controls() const { return {0.0, length * middle() / elements, length}; }
};

/// Tolerances of a wire's unknowns.
struct RodTolerances {
  double position = 1e-7;  ///< [m]
  double velocity = 1e-4;  ///< [m/s]
  double angle = 1e-6;     ///< of twist, and of what an edge of mean length turns by its curvature [rad]
};

/// Where a mount that moves points, and how it turns, at given unknowns of the DAE.
struct MountMotion {
  Frame frame;  ///< direction of increasing arc length and director, in the world
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [rad/s], in the world
};

/// A naturally straight wire of a specification (with its strands' friction) between clamps at the origin and
/// at (span, 0, 0) [m].
[[nodiscard]] RodInMotion rod_in_motion(const WireSpecification& wire, double span, int elements);

}  // namespace snare::wire
