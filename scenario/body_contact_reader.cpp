#include "scenario/body_contact_reader.hpp"

#include "base/index.hpp"
#include "base/units.hpp"
#include "scenario/contact_law_reader.hpp"
#include "scenario/motion_reader.hpp"
#include "scenario/shape_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace snare::scenario {

using base::at;
using base::Choice;
using base::Range;
using base::TomlTable;

namespace {

/// The smooth law, which the laws that replace wires use, needs speeds above zero.
coupling::MotionFriction smooth(coupling::MotionFriction friction) {
  constexpr double least_speed = 1e-3;  // [m/s]
  friction.law = coupling::ContactFriction::smooth;
  if (friction.static_speed <= 0.0) friction.static_speed = least_speed;
  if (friction.dynamic_speed <= friction.static_speed) friction.dynamic_speed = 2.0 * friction.static_speed;
  return friction;
}

/// The shape under a key, reported when there is none.
const PlacedShape* shape_under(const Composition& c, const TomlTable& table, std::string_view key) {
  const std::string name = table.text(key);
  const auto found = c.shapes.find(name);
  if (found != c.shapes.end()) return &found->second;
  if (!name.empty() && !c.shape_names.find(name)) table.fail(key, c.shape_names.requirement());
  return nullptr;
}

/// A table was distilled with a pusher of one radius.
void check_pusher(const DeclaredWire& wire, const ShaftSize& size, const TomlTable& shape) {
  if (!wire.push || !wire.push->table) return;
  constexpr double same = 1e-6;
  const double radius = wire.push->table->wire.radius;
  if (std::abs(size.radius - radius) > same * std::max(radius, 1e-3))
    shape.fail("radius_mm", fmt::format("must be {:.6g}, with which the law of {} was distilled",
                                        radius / base::mm, wire.wire.name));
}

}  // namespace

void set_shaft(Composition& c, const std::string& name, const PlacedShape& shape,
               const coupling::MotionFriction& friction, const std::vector<int>& on) {
  const std::optional<ShaftSize> size = read_shaft_size(shape.table);
  for (const int wire : on) {
    std::optional<coupling::LawWire>& law = c.wires[at(wire)].law;
    if (!law) continue;
    const std::string& of = c.wires[at(wire)].wire.name;
    if (!size) {
      shape.table.fail(
          "kind",
          fmt::format("must be a capsule, knife_edge, cylinder or grapple_shaft to meet {}, for which a "
                      "law stands; wires = [...] names those that it meets",
                      of));
      continue;
    }
    if (law->shaft.half_length > 0.0) {
      shape.table.fail("wires", fmt::format("must not have {}, for which a law stands: it meets {} already",
                                            of, law->shaft.name));
      continue;
    }
    law->shaft = {name, shape.on.carrier, shape.on.X_WF, size->radius, size->half_length};
    law->shaft.X_WS.p += shape.on.X_WF.R.col(2) * size->height;
    if (law->kind == coupling::LawWire::Kind::push) {
      check_pusher(c.wires[at(wire)], *size, shape.table);
      continue;
    }
    law->friction = smooth(friction);
  }
}

void require_shafts(Composition& c) {
  for (const DeclaredWire& w : c.wires) {
    if (w.law && !(w.law->shaft.half_length > 0.0))
      c.document.root().fail("shapes",
                             fmt::format("must have one that {} meets, for which a law stands", w.wire.name));
  }
}

void read_body_contact(Composition& c, const TomlTable& table, const std::string& name) {
  static constexpr Choice<LawModel> laws[] = {{"spring_dashpot", LawModel::spring_dashpot},
                                              {"power", LawModel::power},
                                              {"step_damped", LawModel::step_damped}};
  coupling::BodyContact contact;
  contact.name = name;
  const PlacedShape* shape = shape_under(c, table, "shape");
  const PlacedShape* other = shape_under(c, table, "other_shape");
  if (const auto model = table.choice("model", laws)) contact.law = read_contact_law(table, *model);
  contact.friction =
      read_friction(table, table.number_or("friction", 0.0, Range::from(0.0, 5.0)), "friction");
  if (shape == nullptr || other == nullptr) return;
  const bool same = shape->on.carrier.kind == other->on.carrier.kind &&
                    shape->on.carrier.index == other->on.carrier.index &&
                    shape->on.carrier.frame == other->on.carrier.frame;
  if (same) table.fail("other_shape", "must be carried by something else than the first");
  const ShapePoints points = read_shape_points(other->table, c.folder);
  if (points.points.empty())
    table.fail("other_shape",
               "must have points with which it touches: a plane has none, and may be the first");
  contact.carrier = shape->on.carrier;
  contact.X_WS = shape->on.X_WF;
  contact.shape = shape->shape;
  contact.other = other->on.carrier;
  contact.X_WP = other->on.X_WF;
  contact.points = points.points;
  contact.radius = points.radius;
  c.motion.body_contacts.push_back(contact);
}

}  // namespace snare::scenario
