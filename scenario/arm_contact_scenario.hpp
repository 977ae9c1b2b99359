#pragma once

#include "base/toml_reader.hpp"
#include "scenario/world.hpp"

#include <filesystem>
#include <vector>

namespace snare::scenario {

/// An arm that carries the wire or the body of a contact scenario: reads what is particular to a scenario of kind
/// "arm_contact", the arm and the contact scenario in `folder` too, and finishes the document.
/// contact_overrides: of the contact scenario.
/// The world is the wire's frame at the start; the base of the arm follows from there. An arm that carries the body starts
/// with the joint rates that give its tip the body's motion, as nearly as they can (least squares), its motors alike.
[[nodiscard]] WireMotions read_arm_contact(base::TomlDocument& document, const std::filesystem::path& folder,
                                           const std::vector<base::Override>& contact_overrides);

}  // namespace snare::scenario
