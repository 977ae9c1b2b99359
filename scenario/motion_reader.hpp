#pragma once

#include "base/toml_reader.hpp"
#include "coupling/dynamics/run/simulate.hpp"

#include <Eigen/Core>

#include <optional>
#include <string_view>

namespace snare::scenario {

/// What all scenarios with wires in motion have in common: keys, units and ranges in docs/scenario_file.md.
/// What is wrong is reported to the tables' document.

inline constexpr base::Range durations{0.0, 1e6, false};  ///< of whatever lasts [s]
inline constexpr double most_outputs = 1e6;               ///< lines of a history, checkpoints of a run
/// What a window of work must bring a motion on by [s]: see
/// docs/decisions/interruption-and-faults.md#runs-that-stall.
inline constexpr double least_advance = 0.002;
/// Its key: when to give up makes no difference to what a run that continues computes.
inline constexpr std::string_view least_advance_key = "solver.least_advance_s";
inline constexpr double farthest_mm = 1e5;  ///< of anything from anything [mm]

/// Three numbers under a key; nothing when they are wrong. Range in the file's unit, of which one is `unit`
/// SI units; result in SI.
[[nodiscard]] std::optional<Eigen::Vector3d> read_vector(const base::TomlTable& table, std::string_view key,
                                                         base::Range range, double unit);
/// The same, zero where the key is missing. In SI likewise.
[[nodiscard]] Eigen::Vector3d read_vector_or_zero(const base::TomlTable& table, std::string_view key,
                                                  base::Range range, double unit);

/// Rotation matrix R by an axis times an angle in degrees under a key; the identity where it is missing.
[[nodiscard]] Eigen::Matrix3d read_rotation_vector(const base::TomlTable& table, std::string_view key);
/// R = Rz(yaw) Ry(pitch) Rx(roll) [-] of roll, pitch, yaw in degrees under a key, as in URDF; the identity
/// where it is missing.
[[nodiscard]] Eigen::Matrix3d read_roll_pitch_yaw(const base::TomlTable& table, std::string_view key);

/// `mass_kg` and `inertia_kg_m2`, about the principal axes.
[[nodiscard]] multibody::RigidBodyProperties read_body_properties(const base::TomlTable& table);

/// What `[output]` says beside the interval.
struct MotionOutput {
  bool paraview = false;               ///< shapes of the wires are written
  bool modes = false;                  ///< small oscillations about the end
  double checkpoint_wall_time = 10.0;  ///< least wall time between two checkpoints that are written [s], >= 0
};
/// Also sets the options' interval of checkpoints; their duration must be known.
[[nodiscard]] MotionOutput read_motion_output(const base::TomlTable& table, coupling::MotionOptions& options);

/// `duration_s`, `output_interval_s` and the tolerances of `[solver]`.
void read_motion_options(const base::TomlTable& root, coupling::MotionOptions& options);

/// `[damping]` of the wires.
[[nodiscard]] wire::RodDamping read_damping(const base::TomlTable& table);

/// `[foundation]` between wire and shape.
[[nodiscard]] coupling::ElasticFoundation read_foundation(const base::TomlTable& table);
/// `strength_N` and `at_strength` of a wire.
[[nodiscard]] coupling::WireStrength read_strength(const base::TomlTable& table,
                                                   const wire::WireSpecification& wire);
/// `formulation` of a wire: how its bending is discretised.
[[nodiscard]] wire::Formulation read_formulation(const base::TomlTable& table);

/// Law, coefficients [-], speeds and bristle of the friction. dynamic: the coefficient of fast sliding;
/// dynamic_key: its key in the file.
[[nodiscard]] coupling::MotionFriction read_friction(const base::TomlTable& table, double dynamic,
                                                     std::string_view dynamic_key);

}  // namespace snare::scenario
