#pragma once

#include "base/toml_reader.hpp"
#include "coupling/statics/push_problem.hpp"

#include <array>
#include <optional>
#include <string>

namespace snare::scenario {

/// The tables that describe one push in a file: keys, units and ranges in docs/experiment_file.md.
struct PushTables {
  base::TomlTable wire, mount, pusher, bulge, gravity;
};

/// Those of a file, or of one of its tables.
[[nodiscard]] PushTables push_tables(const base::TomlTable& root);

/// Reads and checks wire, mounts, pusher, bulge and gravity; what is wrong is reported to the tables'
/// document. Contact position and travel are left to the caller.
[[nodiscard]] coupling::PushProblem read_push_problem(const PushTables& tables);

/// Keys in [mount] of the stiffness of the left and of the right mount by itself, in series with that of
/// each.
inline constexpr std::array<const char*, 2> own_translational_keys{"translational_stiffness_left_N_m",
                                                                   "translational_stiffness_right_N_m"};
inline constexpr std::array<const char*, 2> own_rotational_keys{"rotational_stiffness_left_Nm_rad",
                                                                "rotational_stiffness_right_Nm_rad"};
/// Keys in [mount] with which mounts are not rigid.
[[nodiscard]] std::array<const char*, 7> keys_of_giving_mounts();

/// Reports what the wire of an impact does not have: supports, mounts that slip, yielding, natural curvature.
void require_simple_motion(const PushTables& tables, const coupling::PushProblem& test);

/// Reads and checks a wire alone, of a table with the keys of [wire].
/// Whether a wire's ends are held, so that its axial stiffness counts.
enum class Held { at_its_ends, on_supports };
/// natural_length: of a wire that may leave its length out [m].
[[nodiscard]] wire::WireSpecification read_wire(const base::TomlTable& table, Held held = Held::at_its_ends,
                                                std::optional<double> natural_length = {});
/// Reports what is wrong with a wire between mounts `span` [m] apart, neither of them a support.
void check_wire_between_mounts(const wire::WireSpecification& wire, double span,
                               const base::TomlTable& table);
/// The same of wire and mounts alone.
[[nodiscard]] coupling::PushProblem read_wire_and_mounts(const PushTables& tables);

/// What is wrong with a contact at `position` along the chord [m]; nothing when it is far enough from both
/// mounts.
[[nodiscard]] std::optional<std::string> position_problem(double position, double span);

}  // namespace snare::scenario
