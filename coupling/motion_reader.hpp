#pragma once

#include "coupling/motion.hpp"
#include "numerics/toml_reader.hpp"

#include <optional>
#include <string_view>

namespace snare::coupling {

/// What all scenarios with wires in motion have in common: keys, units and ranges in docs/scenario_file.md. What is wrong is
/// reported to the tables' document.

/// Three numbers under a key; nothing when they are wrong.
[[nodiscard]] std::optional<Eigen::Vector3d> read_vector(const numerics::TomlTable& table, std::string_view key,
                                                         numerics::Range range, double unit);
/// The same, zero where the key is missing.
[[nodiscard]] Eigen::Vector3d read_vector_or_zero(const numerics::TomlTable& table, std::string_view key,
                                                  numerics::Range range, double unit);

/// What `[output]` says beside the interval.
struct MotionOutput {
  bool paraview = false;               ///< shapes of the wires are written
  double checkpoint_wall_time = 10.0;  ///< least wall time between two checkpoints that are written [s], >= 0
};
/// Also sets the options' interval of checkpoints; their duration must be known.
[[nodiscard]] MotionOutput read_motion_output(const numerics::TomlTable& table, MotionOptions& options);

/// Simulated time between two checkpoints where nobody asks for another: a tenth of a duration, at most a second [s].
[[nodiscard]] double default_checkpoint_interval(double duration);

/// `duration_s`, `output_interval_s` and the tolerances of `[solver]`.
void read_motion_options(const numerics::TomlTable& root, MotionOptions& options);

/// `[damping]` of the wires.
[[nodiscard]] wire::RodDamping read_damping(const numerics::TomlTable& table);

/// Law, coefficients, speeds and bristle of the friction. dynamic: the coefficient of fast sliding; dynamic_key: its key in the file.
[[nodiscard]] MotionFriction read_friction(const numerics::TomlTable& table, double dynamic, std::string_view dynamic_key);

}  // namespace snare::coupling
