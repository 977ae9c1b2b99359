#include "scenario/robot_reader.hpp"

#include "base/index.hpp"

#include <optional>
#include <string>
#include <vector>

namespace snare::scenario {

using base::at;
using base::Range;
using base::TomlTable;
using coupling::MotionCarrier;

namespace {

/// Sign of the force of a contact on a body over that which results give; nothing where it is of others.
std::optional<double> sign_on(const coupling::Motion& motion, int contact, int body) {
  const auto is_it = [body](const MotionCarrier& c) {
    return c.kind == MotionCarrier::Kind::body && c.index == body;
  };
  const auto [kind, index] = motion.contact_place(at(contact));
  switch (kind) {
    case coupling::ContactKind::shape:
      return motion.contacts[index].body == body ? std::optional(-1.0) : std::nullopt;
    case coupling::ContactKind::law_wire:
      return is_it(motion.law_wires[index].shaft.carrier) ? std::optional(-1.0) : std::nullopt;
    case coupling::ContactKind::bodies:
      if (is_it(motion.body_contacts[index].carrier)) return 1.0;
      return is_it(motion.body_contacts[index].other) ? std::optional(-1.0) : std::nullopt;
    default:
      return std::nullopt;
  }
}

}  // namespace

void read_robots(Composition& c) {
  for (const TomlTable& body : c.document.root().tables("bodies")) {
    if (!body.has("robot")) continue;
    const TomlTable table = body.table("robot");
    coupling::MotionRobot robot;
    robot.mass = table.number("mass_kg", Range::above(0.0, 1e9));
    robot.delay = table.number("delay_s", Range::above(0.0, 10.0));
    const std::vector<std::string> names = table.texts_or_none("contacts");
    if (names.empty())
      table.fail("contacts", "must name the contacts whose force on the body the robot measures");
    const std::optional<int> index = c.body_names.find(body.text("name"));
    if (!body.boolean_or("driven", false)) body.fail("robot", "only of a body with driven = true");
    for (const std::string& name : names) {
      const int contact = c.contact(table, "contacts", name);
      if (!index || c.motion.contact_names().empty()) continue;
      const std::optional<double> sign = sign_on(c.motion, contact, *index);
      if (sign)
        robot.measured.push_back({contact, *sign});
      else if (c.motion.contact_names()[at(contact)] == name)
        table.fail("contacts", "must be contacts of this body: \"" + name + "\" is between others");
    }
    if (index) c.motion.bodies[at(*index)].robot = robot;
  }
}

}  // namespace snare::scenario
