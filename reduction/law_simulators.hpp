#pragma once

#include "reduction/distil.hpp"
#include "reduction/mujoco_law.hpp"

#include <string>
#include <vector>

namespace snare::reduction {

/// The law at every law position of a case as MuJoCo can have it: the table's curve at the wire's slack.
[[nodiscard]] std::vector<MujocoLaw> mujoco_laws(const DistilledCase& one);
/// Largest difference of these curves and the full wire's over the travel, one a law position [N].
[[nodiscard]] std::vector<double> mujoco_errors(const DistilledCase& one);

// Files of data alone have the continuation of the law written out around its range: no force at negative
// travel, linear from the end of the travel to twice it, linear from the end of the positions to the mounts,
// constant beyond them. A reader that continues the last rows and columns linearly continues the law. Their
// grids are refined, up to 16 times, until interpolation is within the stated bound of the table wherever
// they have numbers.

/// law_adams.adm: solver splines of force over travel for every law position, then one of force over travel
/// and position.
struct AdamsSplines {
  std::string text;
  std::vector<double> place_errors;  ///< against the full wire's curve, one a law position [N]
  /// Against the table [N]; errors are those of the worse of AKISPL and linear interpolation.
  double surface_error = 0.0;
};
[[nodiscard]] AdamsSplines adams_splines(const DistilledCase& one, const std::string& title);

/// law_simulink.csv, for a block that interpolates linearly in two inputs, as Simulink's 2-D Lookup Table
/// does.
struct LookupTable {
  /// An empty cell and positions [m]; below travel [m] and forces [N] at the slack of the wire.
  std::string csv;
  double largest_error = 0.0;  ///< of linear interpolation against the table, between the knots [N]
};
[[nodiscard]] LookupTable lookup_table(const DistilledCase& one);

}  // namespace snare::reduction
