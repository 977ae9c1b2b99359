#pragma once

#include "scenario/composition.hpp"

namespace snare::scenario {

/// A shape of the list and the wires that laws stand for, of those with these indices: it becomes their
/// shaft.
void set_shaft(Composition& composition, const std::string& name, const PlacedShape& shape,
               const coupling::MotionFriction& friction, const std::vector<int>& on);
/// What must be so behind all shapes.
void require_shafts(Composition& composition);

/// An item of `[[contacts]]` between two shapes.
void read_body_contact(Composition& composition, const base::TomlTable& table, const std::string& name);

}  // namespace snare::scenario
