#pragma once

#include "scenario/list_items.hpp"

namespace snare::scenario {

/// A wire of the list, with its ends on frames. It begins at rest between its mounts, on the line of a file,
/// or with a free end
/// straight: keys and columns in docs/scenario_file.md.
[[nodiscard]] DeclaredWire read_listed_wire(const base::TomlTable& table, Names& names,
                                            const Placement& placement, const wire::RodDamping& damping,
                                            const BesideScenario& beside);
/// The wire on its line.                                                                     theory.md (M.37)
[[nodiscard]] coupling::MotionWire on_line(DeclaredWire wire);

}  // namespace snare::scenario
