#include "scenario/mount_reader.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <cmath>

namespace snare::scenario {

using base::Choice;
using base::Range;
using base::TomlTable;
using coupling::MountGive;
using Kind = wire::SpatialEnd::Kind;

namespace {

constexpr Choice<Kind> kinds[] = {{"clamped", Kind::clamp}, {"pinned", Kind::twisting_pin}};

enum class Side { left, right, both };
constexpr Choice<Side> sides[] = {{"left", Side::left}, {"right", Side::right}, {"both", Side::both}};

MountGive read_give(const TomlTable& table) {
  MountGive give;
  give.stiffness = table.number_or("translational_stiffness_N_m", give.stiffness, Range::above(0.0, 1e9));
  for (const char* key : {"translational_damping_Ns_m", "slip_tension_N"}) {
    if (table.has(key) && !table.has("translational_stiffness_N_m"))
      table.fail(key, "only beside translational_stiffness_N_m");
  }
  give.damping = table.number_or("translational_damping_Ns_m", 0.0, Range::from(0.0, 1e6));
  give.slip_force = table.number_or("slip_tension_N", give.slip_force, Range::above(0.0, 1e9));
  return give;
}

}  // namespace

bool WireMounts::give_way() const {
  return std::ranges::any_of(give, &MountGive::gives) ||
         std::ranges::any_of(rotational_stiffness, [](double k) { return !std::isinf(k); });
}

void WireMounts::set(wire::SpatialRodProperties& properties) const {
  for (const wire::End which : wire::ends) {
    wire::SpatialEnd& end = properties.end(which);
    end.kind = kind;
    end.rotational_stiffness = rotational_stiffness[index_of(which)];
    end.translational_stiffness = give[index_of(which)].stiffness;
  }
}

WireMounts read_mounts(const TomlTable& wire, Kind otherwise) {
  WireMounts mounts;
  mounts.kind = otherwise;
  if (!wire.has("mount")) return mounts;
  if (!wire.holds_table("mount")) {
    mounts.kind = wire.choice("mount", kinds).value_or(otherwise);
    return mounts;
  }
  const TomlTable table = wire.table("mount");
  if (table.has("kind")) mounts.kind = table.choice("kind", kinds).value_or(otherwise);
  const Side side = table.has("side") ? table.choice("side", sides).value_or(Side::both) : Side::both;
  const MountGive give = read_give(table);
  const double turning =
      table.number_or("rotational_stiffness_Nm_rad", mounts.rotational_stiffness[0], Range::above(0.0, 1e9));
  if (table.has("rotational_stiffness_Nm_rad") && mounts.kind != Kind::clamp)
    table.fail("rotational_stiffness_Nm_rad", "only of clamped mounts: pinned ones turn freely");
  for (const wire::End end : wire::ends) {
    if (side == (end == wire::End::left ? Side::right : Side::left)) continue;
    mounts.give[index_of(end)] = give;
    mounts.rotational_stiffness[index_of(end)] = turning;
  }
  return mounts;
}

}  // namespace snare::scenario
