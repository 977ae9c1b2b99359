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
  const auto is_it = [body](const MotionCarrier& c) { return c.kind == MotionCarrier::Kind::body && c.index == body; };
  std::size_t k = at(contact);
  if (k < motion.contacts.size()) return motion.contacts[k].body == body ? std::optional(-1.0) : std::nullopt;
  k -= motion.contacts.size() + motion.point_contacts.size() + motion.wire_pairs.size();
  if (at(contact) < motion.contacts.size() + motion.point_contacts.size() + motion.wire_pairs.size())
    return std::nullopt;
  if (k < motion.law_wires.size()) return is_it(motion.law_wires[k].shaft.carrier) ? std::optional(-1.0) : std::nullopt;
  const coupling::BodyContact& c = motion.body_contacts[k - motion.law_wires.size()];
  if (is_it(c.carrier)) return 1.0;
  return is_it(c.other) ? std::optional(-1.0) : std::nullopt;
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
    if (names.empty()) table.fail("contacts", "must name the contacts whose force on the body the robot measures");
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
