#pragma once

#include "base/toml_reader.hpp"
#include "coupling/dynamics/law_wire.hpp"
#include "wire/rod_damping.hpp"
#include "wire/specification.hpp"

#include <optional>

namespace snare::scenario {

/// What stands for a wire of a scenario: `model`.
struct WireStandIn {
  bool quasi_static = false;
  /// A law instead of the rod, but for its place, its shaft and what all wires have.
  std::optional<coupling::LawWire> law = {};
};

/// Of a wire's table; its table `rod` is read whatever the model is.
[[nodiscard]] WireStandIn read_wire_stand_in(const base::TomlTable& table, const wire::WireSpecification& specification,
                                             const wire::RodDamping& damping);

}  // namespace snare::scenario
