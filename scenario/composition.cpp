#include "scenario/composition.hpp"

#include "base/index.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace snare::scenario {

using base::at;
using base::TomlTable;
using coupling::MotionCarrier;
using multibody::Pose;

const MotorJoint* Composition::joint(const TomlTable& table, std::string_view key) const {
  const std::string name = table.text(key);
  const auto found = joints.find(name);
  if (found != joints.end()) return &found->second;
  std::string known;
  for (const auto& [one, motor] : joints) known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", one);
  if (!name.empty() && !placement.is_excused(name))
    table.fail(key, known.empty() ? "must be a joint with a motor; there is none"
                                  : "must be a joint with a motor: " + known);
  return nullptr;
}

int Composition::contact(const TomlTable& table, std::string_view key) const {
  return contact(table, key, table.text(key));
}

int Composition::contact(const TomlTable& table, std::string_view key, const std::string& name) const {
  const std::vector<std::string> names = motion.contact_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  std::string known;
  for (const std::string& one : names) known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", one);
  if (!name.empty())
    table.fail(key, known.empty() ? "must be a contact; there is none" : "must be a contact: " + known);
  return 0;
}

int Composition::wire(const TomlTable& table, std::string_view key) const {
  const std::string name = table.text(key);
  const std::optional<int> index = wire_names.find(name);
  if (!index && !name.empty()) table.fail(key, wire_names.requirement());
  return index ? counted(*index) : 0;
}

int Composition::counted(int declared) const {
  const auto by_law = [](const DeclaredWire& w) { return w.law.has_value(); };
  const auto before = wires.begin() + declared;
  const auto laws = static_cast<int>(std::count_if(wires.begin(), before, by_law));
  if (!wires[at(declared)].law) return declared - laws;
  return static_cast<int>(wires.size() -
                          at(static_cast<int>(std::count_if(wires.begin(), wires.end(), by_law)))) +
         laws;
}

int Composition::body_on(const PlacedFrame& frame, const std::string& name, double mass) {
  if (frame.carrier.kind == MotionCarrier::Kind::body) return frame.carrier.index;
  coupling::MotionBody body;
  body.name = name;
  body.start.position = frame.X_WF.p;
  body.start.orientation = Eigen::Quaterniond(frame.X_WF.R);
  const int index = static_cast<int>(motion.bodies.size());
  if (frame.carrier.kind == MotionCarrier::Kind::world) {
    body.driven = true;
  } else {
    // A ball of a decimetre's radius.
    body.properties.mass = mass;
    body.properties.inertia = 0.4 * mass * 0.01 * Eigen::Matrix3d::Identity();
    coupling::MotionWeld weld;
    weld.name = name + " weld";
    weld.carrier = frame.carrier;
    weld.body = index;
    motion.welds.push_back(weld);
  }
  motion.bodies.push_back(body);
  return index;
}

void Composition::add_shape(const std::string& name, const coupling::MotionContact& shape,
                            const PlacedFrame& frame, double mass, const std::vector<int>& on) {
  if (std::all_of(on.begin(), on.end(), [this](int wire) { return wires[at(wire)].law.has_value(); })) return;
  const int body = body_on(frame, name, mass);
  const Pose X_BF = pose_of(motion.bodies[at(body)].start).inverse() * frame.X_WF;
  for (const int wire : on) {
    const DeclaredWire& met = wires[at(wire)];
    if (met.law) continue;
    coupling::MotionContact contact = shape;
    contact.body = body;
    contact.wire = counted(wire);
    contact.X_BS = X_BF * shape.X_BS;
    contact.name = fmt::format("{} on {}", name, met.wire.name);
    contact.wire_radius = 0.5 * met.specification.diameter;
    motion.contacts.push_back(contact);
  }
}

}  // namespace snare::scenario
