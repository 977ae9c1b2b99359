#pragma once

#include "coupling/dynamics/motion.hpp"
#include "base/toml_reader.hpp"

#include <optional>
#include <string_view>

namespace snare::scenario {

/// What all scenarios with wires in motion have in common: keys, units and ranges in docs/scenario_file.md. What is wrong is
/// reported to the tables' document.

/// Three numbers under a key; nothing when they are wrong.
[[nodiscard]] std::optional<Eigen::Vector3d> read_vector(const base::TomlTable& table, std::string_view key,
                                                         base::Range range, double unit);
/// The same, zero where the key is missing.
[[nodiscard]] Eigen::Vector3d read_vector_or_zero(const base::TomlTable& table, std::string_view key,
                                                  base::Range range, double unit);

/// What `[output]` says beside the interval.
struct MotionOutput {
  bool paraview = false;               ///< shapes of the wires are written
  double checkpoint_wall_time = 10.0;  ///< least wall time between two checkpoints that are written [s], >= 0
};
/// Also sets the options' interval of checkpoints; their duration must be known.
[[nodiscard]] MotionOutput read_motion_output(const base::TomlTable& table, coupling::MotionOptions& options);

/// Simulated time between two checkpoints where nobody asks for another: a tenth of a duration, at most a second [s].
[[nodiscard]] double default_checkpoint_interval(double duration);

/// `duration_s`, `output_interval_s` and the tolerances of `[solver]`.
void read_motion_options(const base::TomlTable& root, coupling::MotionOptions& options);

/// `[damping]` of the wires.
[[nodiscard]] wire::RodDamping read_damping(const base::TomlTable& table);

/// Law, coefficients, speeds and bristle of the friction. dynamic: the coefficient of fast sliding; dynamic_key: its key in the file.
[[nodiscard]] coupling::MotionFriction read_friction(const base::TomlTable& table, double dynamic, std::string_view dynamic_key);

}  // namespace snare::scenario
