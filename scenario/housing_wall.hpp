#pragma once

#include "scenario/list_items.hpp"

#include <map>
#include <string>

namespace snare::scenario {

/// Shapes of wires at rest against their walls, in their own frames, by what they hang on: wires of one snare
/// are alike.
using PressedRests = std::map<std::string, Eigen::Matrix3Xd>;

/// The wire at rest where its mounts are, and where it would bow beyond the wall of its housing against that.
/// Throws InputError when it finds no rest.
[[nodiscard]] coupling::MotionWire at_rest_in_wall(DeclaredWire wire, PressedRests& known);

}  // namespace snare::scenario
