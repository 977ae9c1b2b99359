#include "results/motion_history.hpp"

#include "base/csv.hpp"
#include "base/in_unit.hpp"
#include "base/index.hpp"
#include "base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace snare::results {

namespace {

using base::at;
using base::degree;
using base::mm;
using coupling::MotionSample;
using Eigen::Vector3d;
using multibody::ArmSample;
using multibody::RigidBodyState;

/// Columns of a history, each a number of every sample: in SI, written in a unit of so many SI units.
template <class Sample>
class Columns {
 public:
  using Number = std::function<double(const Sample&)>;

  void add(std::string name, Number number, double unit = 1.0) {
    columns_.push_back({std::move(name), std::move(number), unit, false});
  }
  void add_count(std::string name, Number number) {
    columns_.push_back({std::move(name), std::move(number), 1.0, true});
  }
  /// Columns BEFORExAFTER, BEFOREyAFTER and, of three, BEFOREzAFTER.
  void add_vector(const std::string& before, const std::string& after,
                  const std::function<Vector3d(const Sample&)>& vector, double unit = 1.0, int count = 3) {
    for (int k = 0; k < count; ++k)
      add(
          fmt::format("{}{}{}", before, "xyz"[k], after), [vector, k](const Sample& s) { return vector(s)[k]; }, unit);
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Column& column : columns_) names.push_back(column.name);
    return names;
  }
  void append(const Sample& sample, std::vector<base::CsvCell>& row) const {
    for (const Column& column : columns_) row.push_back(column.cell(sample));
  }

 private:
  struct Column {
    std::string name;
    Number number;
    double unit;
    bool count;  // written as a whole number

    [[nodiscard]] base::CsvCell cell(const Sample& sample) const {
      const double value = number(sample);
      if (count) return static_cast<long long>(value);
      return unit == 1.0 ? value : base::in_unit(value, unit);
    }
  };
  std::vector<Column> columns_;
};

void add_energies(Columns<MotionSample>& columns) {
  for (const auto& [name, energy] : energies)
    columns.add(fmt::format("{}_J", name), [energy = energy](const MotionSample& s) { return s.energy.*energy; });
}

const RigidBodyState& body(const MotionSample& s) {
  return s.bodies.front();
}

/// Angle about z [rad] of a body that turns mainly about it.
double angle(const RigidBodyState& s) {
  const Eigen::Quaterniond& q = s.orientation;
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

void add_only_contact(Columns<MotionSample>& columns) {
  columns.add("force_N", [](const MotionSample& s) { return s.contacts.front().normal_force; });
  columns.add(
      "penetration_mm", [](const MotionSample& s) { return -s.contacts.front().gap; }, mm);
  columns.add(
      "contact_arc_mm", [](const MotionSample& s) { return s.contacts.front().arc; }, mm);
}

/// Force on the left or the right mount's end of the first wire [N]; zero where a law stands for it.
Vector3d mount_force(const MotionSample& s, std::size_t mount) {
  return s.mount_forces.empty() ? Vector3d::Zero() : s.mount_forces[mount];
}

/// One body that meets one wire: what happens in the plane of the push.
Columns<MotionSample> body_on_wire() {
  Columns<MotionSample> columns;
  add_only_contact(columns);
  columns.add_vector(
      "body_", "_mm", [](const MotionSample& s) { return body(s).position; }, mm, 2);
  columns.add(
      "body_angle_deg", [](const MotionSample& s) { return angle(body(s)); }, degree);
  columns.add_vector(
      "body_v", "_m_s", [](const MotionSample& s) { return body(s).velocity; }, 1.0, 2);
  columns.add("body_spin_rad_s", [](const MotionSample& s) { return body(s).spin.z(); });
  columns.add_vector(
      "mount_left_", "_N", [](const MotionSample& s) { return mount_force(s, 0); }, 1.0, 2);
  columns.add_vector(
      "mount_right_", "_N", [](const MotionSample& s) { return mount_force(s, 1); }, 1.0, 2);
  add_energies(columns);
  columns.add("slip_speed_m_s", [](const MotionSample& s) { return s.contacts.front().slip_speed; });
  columns.add_count("sticking", [](const MotionSample& s) { return s.contacts.front().sticking ? 1.0 : 0.0; });
  return columns;
}

/// Force of the arm on what it carries, world axes [N].
Vector3d carried_force(const coupling::Motion& motion, const MotionSample& s) {
  if (!s.welds.empty()) return s.welds.front().force;
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < motion.mounts.size(); ++k) sum += s.mount_forces[k];
  return sum;
}

/// The same with an arm.
Columns<MotionSample> body_on_wire_with_arm(const coupling::Motion& motion) {
  Columns<MotionSample> columns;
  add_only_contact(columns);
  columns.add_vector(
      "body_", "_mm", [](const MotionSample& s) { return body(s).position; }, mm);
  columns.add_vector("body_v", "_m_s", [](const MotionSample& s) { return body(s).velocity; });
  columns.add_vector("body_spin_", "_rad_s", [](const MotionSample& s) { return body(s).spin; });
  columns.add_vector("carried_", "_N", [&motion](const MotionSample& s) { return carried_force(motion, s); });
  const multibody::ElasticArm& arm = motion.arms.front().arm;
  for (int j = 0; j < arm.motors(); ++j) {
    const std::string& name = arm.joints[at(j)].name;
    columns.add(
        name + "_motor_deg", [j](const MotionSample& s) { return s.arms.front().state.motor[j]; }, degree);
    columns.add(
        name + "_deflection_deg", [&motion, j](const MotionSample& s) { return joint_deflection(motion, s, j); },
        degree);
    columns.add(name + "_torque_Nm", [j](const MotionSample& s) { return s.arms.front().joint_torque[j]; });
  }
  add_energies(columns);
  return columns;
}

/// Lists of bodies and contacts.
Columns<MotionSample> bodies_among_wires(const coupling::Motion& motion) {
  Columns<MotionSample> columns;
  for (std::size_t k = 0; k < motion.bodies.size(); ++k) {
    const std::string name = motion.bodies[k].name + " ";
    columns.add_vector(
        name, "_mm", [k](const MotionSample& s) { return s.bodies[k].position; }, mm);
    columns.add(name + "qw", [k](const MotionSample& s) { return s.bodies[k].orientation.w(); });
    columns.add_vector(name + "q", "", [k](const MotionSample& s) { return Vector3d(s.bodies[k].orientation.vec()); });
    columns.add_vector(name + "v", "_m_s", [k](const MotionSample& s) { return s.bodies[k].velocity; });
    columns.add_vector(name + "w", "_rad_s", [k](const MotionSample& s) { return s.bodies[k].spin; });
  }
  const std::vector<std::string> contacts = motion.contact_names();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const std::string name = contacts[k] + " ";
    columns.add(name + "points",
                [k](const MotionSample& s) { return static_cast<double>(s.contacts[k].points.size()); });
    columns.add(
        name + "gap_mm", [k](const MotionSample& s) { return s.contacts[k].gap; }, mm);
    columns.add(
        name + "arc_mm", [k](const MotionSample& s) { return s.contacts[k].arc; }, mm);
    columns.add(name + "normal_N", [k](const MotionSample& s) { return s.contacts[k].normal_force; });
    columns.add_vector(name + "f", "_N", [k](const MotionSample& s) { return s.contacts[k].force; });
  }
  return columns;
}

/// Joints of arms and snares, wires on mounts, bushings.
void add_composed(const coupling::Motion& motion, Columns<MotionSample>& columns) {
  for (std::size_t a = 0; a < motion.arms.size(); ++a) {
    const multibody::ElasticArm& arm = motion.arms[a].arm;
    for (int j = 0; j < arm.motors(); ++j) {
      const multibody::ElasticJoint& joint = arm.joints[at(j)];
      const std::string name = motion.arms[a].joint_name(j);
      const bool slides = arm.tree.body(joint.body).joint == multibody::JointKind::prismatic;
      const double unit = slides ? mm : degree;
      const char* angle = slides ? "mm" : "deg";
      columns.add(
          fmt::format("{} motor_{}", name, angle), [a, j](const MotionSample& s) { return s.arms[a].state.motor[j]; },
          unit);
      columns.add(
          fmt::format("{} deflection_{}", name, angle),
          [&arm, a, j](const MotionSample& s) { return multibody::deflection(arm, s.arms[a].state, j); }, unit);
      columns.add(fmt::format("{} torque_{}", name, slides ? "N" : "Nm"),
                  [a, j](const MotionSample& s) { return s.arms[a].joint_torque[j]; });
    }
  }
  const std::vector<coupling::WireFacts> wires = motion.wire_facts();
  for (std::size_t w = 0; w < wires.size(); ++w) {
    columns.add(wires[w].name + " tension_N", [w](const MotionSample& s) { return coupling::end_tension(s, w); });
  }
  for (std::size_t b = 0; b < motion.bushings.size(); ++b) {
    const std::string name = motion.bushings[b].name + " ";
    columns.add_vector(
        name + "d", "_mm", [b](const MotionSample& s) { return s.bushings[b].shift; }, mm);
    columns.add_vector(
        name + "turn_", "_deg", [b](const MotionSample& s) { return s.bushings[b].turn; }, degree);
    columns.add_vector(name + "f", "_N", [b](const MotionSample& s) { return s.bushings[b].on_second.force; });
    columns.add_vector(name + "m", "_Nm", [b](const MotionSample& s) { return s.bushings[b].on_second.moment; });
  }
}

Columns<MotionSample> columns_of(const scenario::WireMotions& motions) {
  if (!motions.probe) {
    Columns<MotionSample> columns = bodies_among_wires(motions.runs.front().motion);
    if (motions.composed) add_composed(motions.runs.front().motion, columns);
    add_energies(columns);
    return columns;
  }
  const bool with_arm = !motions.runs.empty() && !motions.runs.front().motion.arms.empty();
  return with_arm ? body_on_wire_with_arm(motions.runs.front().motion) : body_on_wire();
}

Columns<ArmSample> columns_of(const multibody::ElasticArm& arm) {
  Columns<ArmSample> columns;
  for (int j = 0; j < arm.motors(); ++j) {
    const std::string& name = arm.joints[at(j)].name;
    columns.add(
        name + "_motor_deg", [j](const ArmSample& s) { return s.state.motor[j]; }, degree);
    columns.add(
        name + "_deflection_deg", [j](const ArmSample& s) { return s.deflection[j]; }, degree);
    columns.add(name + "_joint_torque_Nm", [j](const ArmSample& s) { return s.joint_torque[j]; });
    columns.add(name + "_drive_torque_Nm", [j](const ArmSample& s) { return s.drive_torque[j]; });
  }
  columns.add("energy_J", [](const ArmSample& s) { return s.energy; });
  columns.add("work_drives_J", [](const ArmSample& s) { return s.work.motors; });
  columns.add("work_loads_J", [](const ArmSample& s) { return s.work.loads; });
  columns.add("lost_J", [](const ArmSample& s) { return s.work.lost; });
  columns.add_vector("momentum_", "_Ns", [](const ArmSample& s) { return s.momentum.force; });
  return columns;
}

/// Samples of one run; unnamed: the only one.
template <class Sample>
struct Run {
  std::string_view name;
  const std::vector<Sample>& samples;
};

enum class Runs { named, only };

template <class Sample>
void give(TableSink& sink, const Columns<Sample>& columns, const std::vector<Run<Sample>>& runs, Runs kind) {
  std::vector<std::string> names;
  if (kind == Runs::named) names.emplace_back("model");
  names.emplace_back("time_s");
  for (std::string& name : columns.names()) names.push_back(std::move(name));
  sink.begin(std::move(names));
  for (const Run<Sample>& run : runs) {
    for (const Sample& s : run.samples) {
      std::vector<base::CsvCell> row;
      if (kind == Runs::named) row.emplace_back(run.name);
      row.emplace_back(s.time);
      columns.append(s, row);
      sink.row(row);
    }
  }
}

/// A reading, in the unit of its column: one without noise has no tail of the conversion either.
double as_read(const scenario::Sensor& sensor, double reading) {
  const double unit = sensor.unit();
  return unit == 1.0 || sensor.noise > 0.0 ? reading : base::without_tail(reading, unit);
}

}  // namespace

void give_history(TableSink& sink, const scenario::WireMotions& motions, const std::vector<FinishedMotion>& finished) {
  std::vector<Run<MotionSample>> runs;
  runs.reserve(finished.size());
  for (const FinishedMotion& run : finished) runs.push_back({run.asked.name, run.samples});
  give(sink, columns_of(motions), runs, motions.probe ? Runs::named : Runs::only);
}

void give_telemetry(TableSink& sink, const scenario::WireMotions& motions,
                    const std::vector<coupling::MotionSample>& samples) {
  // A line for every time at which a sensor reads; cells of those that do not are empty.
  std::vector<std::string> names{"time_s"};
  std::vector<scenario::Readings> readings;
  std::map<double, std::vector<std::pair<std::size_t, std::size_t>>> lines;
  for (const scenario::Sensor& sensor : motions.sensors) {
    for (std::string& name : sensor.columns()) names.push_back(std::move(name));
    readings.push_back(scenario::read_off(sensor, motions.runs.front().motion, samples));
    for (std::size_t i = 0; i < readings.back().times.size(); ++i) {
      // Rates that divide the output's give the same time from either, but for round-off.
      const double time = std::round(readings.back().times[i] * 1e9) / 1e9;
      lines[time].emplace_back(readings.size() - 1, i);
    }
  }
  sink.begin(std::move(names));
  for (const auto& [time, read] : lines) {
    std::vector<base::CsvCell> row{time};
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const auto found = std::find_if(read.begin(), read.end(), [k](const auto& one) { return one.first == k; });
      for (const std::vector<double>& component : readings[k].values) {
        if (found == read.end())
          row.emplace_back(std::monostate{});
        else
          row.emplace_back(as_read(motions.sensors[k], component[found->second]));
      }
    }
    sink.row(row);
  }
}

void give_history(TableSink& sink, const multibody::ElasticArm& arm, const multibody::ArmHistory& history) {
  give<ArmSample>(sink, columns_of(arm), {{"", history.samples}}, Runs::only);
}

void write_history(const std::filesystem::path& file, const scenario::WireMotions& motions,
                   const std::vector<FinishedMotion>& finished) {
  CsvSink csv(file);
  give_history(csv, motions, finished);
  csv.commit();
}

void write_history(const std::filesystem::path& file, const multibody::ElasticArm& arm,
                   const multibody::ArmHistory& history) {
  CsvSink csv(file);
  give_history(csv, arm, history);
  csv.commit();
}

void write_telemetry(const std::filesystem::path& file, const scenario::WireMotions& motions,
                     const std::vector<coupling::MotionSample>& samples) {
  CsvSink csv(file);
  give_telemetry(csv, motions, samples);
  csv.commit();
}

}  // namespace snare::results
