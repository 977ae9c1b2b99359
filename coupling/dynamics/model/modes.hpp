#pragma once

#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/options.hpp"
#include "coupling/dynamics/model/result.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::coupling {

/// What moves in a mode, weighted so that its kinetic energy is that of unit masses [kg^1/2 m/s, up to a
/// factor]: comparable between meshes.
struct ModeShape {
  Eigen::VectorXcd bodies_and_arms;      ///< in the order of the motion
  std::vector<Eigen::Matrix3Xcd> wires;  ///< one column a vertex; of quasi-static ones none
};

/// A small oscillation of everything together about a state.                                 theory.md (M.31)
struct MotionMode {
  double frequency = 0.0;  ///< |lambda|/(2 pi): of the undamped oscillation [Hz]
  double damping = 0.0;    ///< ratio -Re lambda/|lambda| [-]; negative: it grows
  /// Shares of the kinetic energy [-], largest first: "BODY shift x" (axes of the world), "BODY turn x" (of
  /// the body), a joint with its motor, "ARM base", a wire.
  std::vector<std::pair<std::string, double>> shares;
  ModeShape shape;
  /// Estimated error of the frequency due to the mesh of the wires, from a coarser one [Hz]; none: not
  /// estimated, or the coarser mesh has no such mode.                                        theory.md (M.31)
  std::optional<double> mesh_error;

  /// Whether the mesh resolves the frequency to within a hundredth.
  [[nodiscard]] bool resolved() const { return mesh_error && *mesh_error <= 0.01 * frequency; }
};

/// What a motion does about a state of it.                                                   theory.md (M.31)
struct SmallMotions {
  std::vector<MotionMode> modes;  ///< ascending
  /// Largest |lambda|, of what only decays, too [1/s]; none: only the slowest modes were computed.
  std::optional<double> fastest;

  /// 2/|lambda|: the largest step of central differences on the fastest oscillation, and of Euler's method on
  /// the fastest decay [s].
  [[nodiscard]] std::optional<double> largest_explicit_step() const {
    return fastest && *fastest > 0.0 ? std::optional(2.0 / *fastest) : std::nullopt;
  }
};

/// Most unknowns for which all modes are computed: the work grows with their third power. Of more unknowns
/// the slowest `slowest_eigenvalues` are, whether they oscillate or only decay.
inline constexpr int most_unknowns_of_all_modes = 1200;
inline constexpr int slowest_eigenvalues = 200;

/// Oscillations of a motion about a state of it [SI units], by the eigenvalues of its linearised equations:
/// contacts, drives and stuck joints stay as they are, and what the state itself moves by is held. Of the
/// modes slower than 1e-3 rad/s and overdamped ones are left out.
///                                                                                           theory.md (M.31)
[[nodiscard]] SmallMotions small_motions_at(const Motion& motion, const MotionOptions& options,
                                            const MotionState& state);

/// Gives every mode its `mesh_error`: a third of its distance to the modes of the same shape of the same
/// motion on wires of half as many elements [Hz], which is the error where it falls with the square of an
/// element and more than it where it falls faster.
///                                                                                           theory.md (M.31)
void add_mesh_errors(SmallMotions& fine, const SmallMotions& coarse);

}  // namespace snare::coupling
