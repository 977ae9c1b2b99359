#include "scenario/phase_reader.hpp"

#include "base/index.hpp"
#include "base/units.hpp"
#include "scenario/drive_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

namespace snare::scenario {

using base::at;
using base::Range;
using base::TomlTable;
using coupling::MotionSignal;
using coupling::SignalBound;

namespace {

/// What a condition may be about: the key that names it, and those of its two bounds.
struct Quantity {
  const char* key;
  MotionSignal::Kind kind;
  const char *above, *below;
  double unit;
};
constexpr Quantity quantities[] = {
    {"contact", MotionSignal::Kind::contact_force, "above_N", "below_N", 1.0},
    {"tension", MotionSignal::Kind::wire_tension, "above_N", "below_N", 1.0},
    {"torque", MotionSignal::Kind::joint_torque, "above_Nm", "below_Nm", 1.0},
    {"angle", MotionSignal::Kind::joint_angle, "above_deg", "below_deg", base::degree},
    {"distance", MotionSignal::Kind::distance, "above_mm", "below_mm", base::mm},
    {"speed", MotionSignal::Kind::speed, "above_m_s", "below_m_s", 1.0},
};

/// Least force of a contact that counts as touching [N].
constexpr double touching = 1e-3;

/// Two frames by their names.
void read_frames(const Composition& c, const TomlTable& table, const char* key, MotionSignal& signal) {
  const std::vector<std::string> names = table.texts_or_none(key);
  if (names.size() != 2) {
    table.fail(key, "must name two frames");
    return;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const std::optional<PlacedFrame> frame = c.placement.find(names[k]);
    if (!frame) {
      table.fail_element(key, k, c.placement.requirement());
      continue;
    }
    signal.carriers[k] = frame->carrier;
    signal.poses[k] = frame->X_WF;
  }
}

/// Index among what the motion senses, where the sensor is added if it is not there yet.
class Sensed {
 public:
  Sensed(Composition& c, const std::vector<Sensor>& sensors) : c_(c), sensors_(sensors) {}

  [[nodiscard]] const Sensor* find(const std::string& name) const {
    const auto found = std::ranges::find(sensors_, name, &Sensor::name);
    return found == sensors_.end() ? nullptr : &*found;
  }
  [[nodiscard]] std::string requirement() const {
    std::string known;
    for (const Sensor& s : sensors_) known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", s.name);
    return known.empty() ? "must be a sensor; there is none" : "must be a sensor: " + known;
  }
  [[nodiscard]] int index(const Sensor& sensor) {
    const auto [place, added] = indices_.try_emplace(sensor.name, static_cast<int>(c_.motion.sensed.size()));
    if (added) c_.motion.sensed.push_back(sensed_by(sensor));
    return place->second;
  }

 private:
  Composition& c_;
  const std::vector<Sensor>& sensors_;
  std::map<std::string, int> indices_;
};

/// `above_UNIT` or `below_UNIT`, in the unit of the sensor's columns, of one of its numbers or of their size.
void read_sensed(const TomlTable& table, Sensed& sensed, std::vector<coupling::SensedBound>& bounds) {
  const std::string name = table.text("sensor");
  const Sensor* sensor = sensed.find(name);
  static constexpr base::Choice<int> axes[] = {{"x", 0}, {"y", 1}, {"z", 2}};
  const std::optional<int> axis = table.has("axis") ? table.choice("axis", axes) : std::nullopt;
  if (sensor == nullptr) {
    if (!name.empty()) table.fail("sensor", sensed.requirement());
    return;
  }
  if (table.has("axis") && sensor->components() == 1)
    table.fail("axis", "only of a sensor that reads three numbers");
  coupling::SensedBound b;
  b.sensed = sensed.index(*sensor);
  b.component = sensor->components() == 1 ? 0 : axis.value_or(-1);
  const std::string above = "above_" + sensor->unit_name(), below = "below_" + sensor->unit_name();
  b.above = table.has(above);
  if (b.above == table.has(below))
    table.fail(b.above ? below : above, fmt::format("must have either {} or {}", above, below));
  b.bound = table.number_or(b.above ? above : below, 0.0, Range::from(-1e12, 1e12));
  bounds.push_back(b);
}

void read_condition(const Composition& c, const TomlTable& table, Sensed& sensed,
                    coupling::MotionPhase& phase) {
  std::vector<SignalBound>& bounds = phase.bounds;
  const Quantity* asked = nullptr;
  std::string known;
  for (const Quantity& q : quantities) {
    known += fmt::format("{}{}", known.empty() ? "" : ", ", q.key);
    if (!table.has(q.key)) continue;
    if (asked != nullptr) table.fail(q.key, fmt::format("cannot stand beside {}", asked->key));
    asked = &q;
  }
  if (table.has("touch")) {
    const std::vector<std::string> names = table.texts_or_none("touch");
    for (const std::string& name : names) {
      SignalBound b;
      b.signal.index = c.contact(table, "touch", name);
      b.bound = touching;
      bounds.push_back(b);
    }
    return;
  }
  if (table.has("sensor")) {
    if (asked != nullptr) table.fail("sensor", fmt::format("cannot stand beside {}", asked->key));
    read_sensed(table, sensed, phase.sensed);
    return;
  }
  if (asked == nullptr) {
    table.fail("", "must have one of touch, sensor, " + known);
    return;
  }
  SignalBound b;
  b.signal.kind = asked->kind;
  switch (asked->kind) {
    case MotionSignal::Kind::contact_force:
      b.signal.index = c.contact(table, asked->key);
      break;
    case MotionSignal::Kind::wire_tension:
      b.signal.index = c.wire(table, asked->key);
      break;
    case MotionSignal::Kind::joint_torque:
    case MotionSignal::Kind::joint_angle:
      if (const MotorJoint* joint = c.joint(table, asked->key)) {
        b.signal.index = joint->arm;
        b.signal.joint = joint->joint;
      }
      break;
    case MotionSignal::Kind::distance:
    case MotionSignal::Kind::speed:
      read_frames(c, table, asked->key, b.signal);
  }
  b.above = table.has(asked->above);
  if (b.above == table.has(asked->below))
    table.fail(b.above ? asked->below : asked->above,
               fmt::format("must have either {} or {}", asked->above, asked->below));
  b.bound =
      table.number_or(b.above ? asked->above : asked->below, 0.0, Range::from(-1e12, 1e12), asked->unit);
  bounds.push_back(b);
}

}  // namespace

void read_phases(Composition& c, const std::vector<Sensor>& sensors) {
  Sensed sensed(c, sensors);
  Names names("phase");
  double last = 0.0;
  for (const TomlTable& table : c.document.root().tables("phases")) {
    coupling::MotionPhase phase;
    phase.name = names.take(table);
    phase.not_before = table.number_or("at_s", 0.0, Range::from(0.0, 1e6));
    if (table.has("at_s") && phase.not_before < last)
      table.fail(
          "at_s",
          fmt::format("must not be before that of an earlier phase, {:.9g}: phases begin in their order",
                      last));
    last = std::max(last, phase.not_before);
    phase.after_previous = table.number_or("after_s", 0.0, Range::from(0.0, 1e6));
    for (const TomlTable& condition : table.tables("when")) read_condition(c, condition, sensed, phase);
    if (table.has("hold_s") && phase.bounds.empty() && phase.sensed.empty())
      table.fail("hold_s", "only beside conditions, when = [...]");
    phase.hold = table.number_or("hold_s", 0.0, Range::from(0.0, 1e6));
    for (const TomlTable& drive : table.tables("drives")) {
      for (const MotorJoint& j : read_joints(c, drive))
        phase.drives.push_back(
            {j.arm, j.joint,
             read_drive(drive, c.folder, c.motion.arms[at(j.arm)].drives[at(j.joint)], j.slides, c.input)});
    }
    phase.ends_run = table.boolean_or("ends_run", false);
    c.motion.phases.push_back(std::move(phase));
  }
}

}  // namespace snare::scenario
