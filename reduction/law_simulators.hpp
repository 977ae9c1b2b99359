#pragma once

#include "reduction/distil.hpp"

#include <string>
#include <vector>

namespace snare::reduction {

/// law_mujoco.xml: a slide joint for every law position with a polynomial of three numbers, F = k0 d + k1 d^2 + k2 d^3, through the full
/// wire, its error and that of the linear law, its range, a sensor that flags travels outside, and the damping of the first impact. No force
/// is negative at travels from 0 on, nor is the stiffness beyond the range. Newer versions of MuJoCo have such springs.
[[nodiscard]] std::string mujoco_snippet(const DistilledCase& one, const std::string& title);
/// Largest error of these polynomials against the full wire, one a law position [N].
[[nodiscard]] std::vector<double> joint_errors(const DistilledCase& one);

// Files of data alone have the continuation of the law written out around its range: no force at negative travel, linear from the end of the
// travel to twice it, linear from the end of the positions to the mounts, constant beyond them. A reader that continues the last rows and
// columns linearly continues the law. Their grids are refined, up to 16 times, until interpolation is within the stated bound of the table
// wherever they have numbers.

/// law_adams.adm: solver splines of force over travel for every law position, then one of force over travel and position.
struct AdamsSplines {
  std::string text;
  std::vector<double> place_errors;  ///< against the full wire's curve, one a law position [N]
  double surface_error =
      0.0;  ///< against the table [N]; errors are those of the worse of AKISPL and linear interpolation
};
[[nodiscard]] AdamsSplines adams_splines(const DistilledCase& one, const std::string& title);

/// law_simulink.csv, for a block that interpolates linearly in two inputs, as Simulink's 2-D Lookup Table does.
struct LookupTable {
  std::string csv;  ///< an empty cell and positions [m]; below travel [m] and forces [N] at the slack of the wire
  double largest_error = 0.0;  ///< of linear interpolation against the table, between the knots [N]
};
[[nodiscard]] LookupTable lookup_table(const DistilledCase& one);

}  // namespace snare::reduction
