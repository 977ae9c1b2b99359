#pragma once

#include "base/toml_reader.hpp"
#include "coupling/dynamics/model/law_wire.hpp"
#include "scenario/push_law.hpp"
#include "wire/motion/rod_damping.hpp"
#include "wire/specification.hpp"

#include <optional>
#include <string>

namespace snare::scenario {

/// What stands for a wire of a scenario: `model`.
struct WireStandIn {
  bool quasi_static = false;
  /// A law instead of the rod, but for its place, its shaft and what all wires have.
  std::optional<coupling::LawWire> law = {};
  std::optional<PushModel> push = {};  ///< of a law of pushes, which its place and shaft complete
};

/// Of a wire's table; the tables of laws' numbers are read whatever the model is. beside: of a wire that laws
/// of pushes may stand for.
[[nodiscard]] WireStandIn read_wire_stand_in(const base::TomlTable& table,
                                             const wire::WireSpecification& specification,
                                             const wire::RodDamping& damping,
                                             const std::optional<BesideScenario>& beside);
/// The models of which a wire's table has the numbers, beside those that need none.
[[nodiscard]] std::vector<std::string> models_with_numbers(const base::TomlTable& table);

}  // namespace snare::scenario
