#pragma once

#include "reduction/distil.hpp"

#include <string>
#include <vector>

namespace snare::reduction {

/// A slide joint for every law position with a polynomial of three numbers, F = k0 d + k1 d^2 + k2 d^3, through the full wire, and how
/// far that and the linear law are from it; the damping of the first impact. Newer versions of MuJoCo have such springs.
[[nodiscard]] std::string mujoco_snippet(const DistilledCase& one, const std::string& title);
/// Largest error of these polynomials against the full wire, one a law position [N].
[[nodiscard]] std::vector<double> joint_errors(const DistilledCase& one);

/// ADAMS solver splines: one of force over travel for every law position, and one of force over travel and position.
[[nodiscard]] std::string adams_splines(const DistilledCase& one, const std::string& title);

/// Numbers for a block that interpolates linearly in two inputs, as Simulink's 2-D Lookup Table does.
struct LookupTable {
  std::string csv;  ///< an empty cell and positions [m]; below travel [m] and forces [N] at the slack of the wire
  double largest_error = 0.0;  ///< of linear interpolation against the table, between the knots [N]
};
/// With so many knots that the error is within the stated bound of the table, where sixteen times as many on either axis suffice.
/// Positions go to the other side of mid-span where left and right are alike.
[[nodiscard]] LookupTable lookup_table(const DistilledCase& one);

/// A Modelica package: force, force_unloading and in_range of the table, and every simple law, as functions of Modelica 3.2
/// without any library. name: of the package, snare_law if it is empty.
[[nodiscard]] std::string modelica_package(const DistilledCase& one, const std::string& title,
                                           const std::string& name = "");

}  // namespace snare::reduction
