#include "scenario/sensor_reader.hpp"

#include <fmt/format.h>

#include <cmath>

namespace snare::scenario {

using base::Choice;
using base::Range;
using base::TomlTable;

std::vector<Sensor> read_sensors(const Composition& c, double output_interval) {
  using Kind = Sensor::Kind;
  static constexpr Choice<Kind> kinds[] = {
      {"position", Kind::position},         {"attitude", Kind::attitude},
      {"velocity", Kind::velocity},         {"rate", Kind::rate},
      {"joint_angle", Kind::joint_angle},   {"motor_angle", Kind::motor_angle},
      {"motor_rate", Kind::motor_rate},     {"joint_torque", Kind::joint_torque},
      {"drive_torque", Kind::drive_torque}, {"contact_force", Kind::contact_force},
      {"tension", Kind::tension},           {"mount_force", Kind::mount_force}};
  std::vector<Sensor> sensors;
  Names names("sensor");
  for (const TomlTable& table : c.document.root().tables("sensors")) {
    Sensor s;
    s.name = names.take(table);
    const std::optional<Kind> kind = table.choice("kind", kinds);
    s.kind = kind.value_or(Kind::position);
    if (kind && s.components() == 3) {
      static_cast<void>(table.text("frame"));
      s.frame = c.placement.frame(table, "frame").value_or(PlacedFrame{});
      s.relative_to = c.placement.frame(table, "relative_to").value_or(PlacedFrame{});
    } else if (kind == Kind::contact_force) {
      s.index = c.contact(table, "contact");
    } else if (kind == Kind::tension || kind == Kind::mount_force) {
      s.index = c.wire(table, "wire");
    } else if (kind) {
      if (const MotorJoint* joint = c.joint(table, "joint")) {
        s.index = joint->arm;
        s.joint = joint->joint;
        s.slides = joint->slides;
      }
    }
    const double rate = table.number_or("rate_Hz", 1.0 / output_interval, Range::above(0.0, 1e6));
    s.interval = 1.0 / rate;
    const double share = s.interval / output_interval;
    if (!(std::abs(share - std::round(share)) < 1e-6 * share) || share < 0.5)
      table.fail("rate_Hz",
                 fmt::format("must be 1/output_interval_s, {:.9g}, or that divided by a whole number",
                             1.0 / output_interval));
    s.delay = table.number_or("delay_s", 0.0, Range::from(0.0, 1e4));
    s.noise = table.number_or("noise", 0.0, Range::from(0.0, 1e9));
    s.seed =
        static_cast<unsigned>(table.integer_or("seed", static_cast<int>(sensors.size()) + 1, 0, 2147483647));
    sensors.push_back(std::move(s));
  }
  return sensors;
}

}  // namespace snare::scenario
