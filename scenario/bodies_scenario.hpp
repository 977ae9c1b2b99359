#pragma once

#include "base/toml_reader.hpp"
#include "scenario/world.hpp"

#include <filesystem>
#include <string_view>

namespace snare::scenario {

/// The keys of a contact scenario that lists its bodies instead of having one [body], one [wire] and one [pusher].
inline constexpr std::string_view list_keys[] = {"wires", "bodies", "shapes"};

/// Any bodies with any shapes among any wires: reads what is particular to a scenario of kind "contact" with lists, the
/// meshes in `folder` too, and finishes the document. One run, with a contact for every shape and every wire that it may
/// touch, named "SHAPE on WIRE", and the contacts of wires with each other.
[[nodiscard]] WireMotions read_bodies(base::TomlDocument& document, const std::filesystem::path& folder);

}  // namespace snare::scenario
