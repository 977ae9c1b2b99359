#pragma once

#include "base/toml_reader.hpp"
#include "coupling/dynamics/model/arm.hpp"
#include "wire/spatial_properties.hpp"

#include <array>
#include <limits>

namespace snare::scenario {

/// The mounts of a wire of a scenario, at its left and its right end.
struct WireMounts {
  wire::SpatialEnd::Kind kind = wire::SpatialEnd::Kind::clamp;
  std::array<coupling::MountGive, 2> give;  ///< along the chord, theory.md (M.38)
  /// Of clamps that turn [N m/rad]; infinite: rigid.
  std::array<double, 2> rotational_stiffness{std::numeric_limits<double>::infinity(),
                                             std::numeric_limits<double>::infinity()};

  /// Whether one of them gives along the chord or in rotation.
  [[nodiscard]] bool give_way() const;
  /// Of the wire's ends: kind and stiffnesses, those along the chord as springs in the wire's own frame.
  void set(wire::SpatialRodProperties& properties) const;
};

/// Of `mount` in a wire's table: a name, or a table with its kind and what gives.
[[nodiscard]] WireMounts read_mounts(const base::TomlTable& wire, wire::SpatialEnd::Kind otherwise);

}  // namespace snare::scenario
