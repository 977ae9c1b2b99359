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
#include <utility>

namespace snare::results {

namespace {

using base::at;
using base::degree;
using base::mm;
using coupling::MotionSample;
using Eigen::Vector3d;

/// Columns of a history, each a number of every sample: in SI, written in a unit of so many SI units.
class Columns {
 public:
  using Number = std::function<double(const MotionSample&)>;

  void add(std::string name, Number number, double unit = 1.0) {
    columns_.push_back({std::move(name), std::move(number), unit});
  }
  /// Columns BEFORExAFTER, BEFOREyAFTER, BEFOREzAFTER.
  void add_vector(const std::string& before, const std::string& after,
                  const std::function<Vector3d(const MotionSample&)>& vector, double unit = 1.0) {
    for (int k = 0; k < 3; ++k)
      add(
          fmt::format("{}{}{}", before, "xyz"[k], after),
          [vector, k](const MotionSample& s) { return vector(s)[k]; }, unit);
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Column& column : columns_) names.push_back(column.name);
    return names;
  }
  void append(const MotionSample& sample, std::vector<base::CsvCell>& row) const {
    for (const Column& column : columns_) row.push_back(column.cell(sample));
  }

 private:
  struct Column {
    std::string name;
    Number number;
    double unit;

    [[nodiscard]] base::CsvCell cell(const MotionSample& sample) const {
      const double value = number(sample);
      return unit == 1.0 ? value : base::in_unit(value, unit);
    }
  };
  std::vector<Column> columns_;
};

void add_energies(Columns& columns) {
  for (const auto& [name, energy] : energies)
    columns.add(fmt::format("{}_J", name),
                [energy = energy](const MotionSample& s) { return s.energy.*energy; });
}

/// Lists of bodies and contacts.
Columns of_bodies_and_contacts(const coupling::Motion& motion) {
  Columns columns;
  for (std::size_t k = 0; k < motion.bodies.size(); ++k) {
    const std::string name = motion.bodies[k].name + " ";
    columns.add_vector(
        name, "_mm", [k](const MotionSample& s) { return s.bodies[k].position; }, mm);
    columns.add(name + "qw", [k](const MotionSample& s) { return s.bodies[k].orientation.w(); });
    columns.add_vector(name + "q", "",
                       [k](const MotionSample& s) { return Vector3d(s.bodies[k].orientation.vec()); });
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
void add_what_carries(const coupling::Motion& motion, Columns& columns) {
  for (std::size_t a = 0; a < motion.arms.size(); ++a) {
    const multibody::ElasticArm& arm = motion.arms[a].arm;
    for (int j = 0; j < arm.motors(); ++j) {
      const multibody::ElasticJoint& joint = arm.joints[at(j)];
      const std::string name = motion.arms[a].joint_name(j);
      const bool slides = arm.tree.body(joint.body).joint == multibody::JointKind::prismatic;
      const double unit = slides ? mm : degree;
      const char* angle = slides ? "mm" : "deg";
      columns.add(
          fmt::format("{} motor_{}", name, angle),
          [a, j](const MotionSample& s) { return s.arms[a].state.motor[j]; }, unit);
      columns.add(
          fmt::format("{} deflection_{}", name, angle),
          [&arm, a, j](const MotionSample& s) { return multibody::deflection(arm, s.arms[a].state, j); },
          unit);
      columns.add(fmt::format("{} torque_{}", name, slides ? "N" : "Nm"),
                  [a, j](const MotionSample& s) { return s.arms[a].joint_torque[j]; });
    }
  }
  const std::vector<coupling::WireFacts> wires = motion.wire_facts();
  for (std::size_t w = 0; w < wires.size(); ++w) {
    columns.add(wires[w].name + " tension_N",
                [w](const MotionSample& s) { return coupling::end_tension(s, w); });
  }
  for (std::size_t b = 0; b < motion.bushings.size(); ++b) {
    const std::string name = motion.bushings[b].name + " ";
    columns.add_vector(
        name + "d", "_mm", [b](const MotionSample& s) { return s.bushings[b].shift; }, mm);
    columns.add_vector(
        name + "turn_", "_deg", [b](const MotionSample& s) { return s.bushings[b].turn; }, degree);
    columns.add_vector(name + "f", "_N",
                       [b](const MotionSample& s) { return s.bushings[b].on_second.force; });
    columns.add_vector(name + "m", "_Nm",
                       [b](const MotionSample& s) { return s.bushings[b].on_second.moment; });
  }
}

/// A reading, in the unit of its column: one without noise has no tail of the conversion either.
double as_read(const scenario::Sensor& sensor, double reading) {
  const double unit = sensor.unit();
  return unit == 1.0 || sensor.noise > 0.0 ? reading : base::without_tail(reading, unit);
}

}  // namespace

void give_history(TableSink& sink, const coupling::Motion& motion, const std::vector<MotionSample>& samples) {
  Columns columns = of_bodies_and_contacts(motion);
  add_what_carries(motion, columns);
  add_energies(columns);
  std::vector<std::string> names{"time_s"};
  for (std::string& name : columns.names()) names.push_back(std::move(name));
  sink.begin(std::move(names));
  for (const MotionSample& s : samples) {
    std::vector<base::CsvCell> row{s.time};
    columns.append(s, row);
    sink.row(row);
  }
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
      const auto found =
          std::find_if(read.begin(), read.end(), [k](const auto& one) { return one.first == k; });
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

void write_history(const std::filesystem::path& file, const coupling::Motion& motion,
                   const std::vector<MotionSample>& samples) {
  CsvSink csv(file);
  give_history(csv, motion, samples);
  csv.commit();
}

void write_telemetry(const std::filesystem::path& file, const scenario::WireMotions& motions,
                     const std::vector<coupling::MotionSample>& samples) {
  CsvSink csv(file);
  give_telemetry(csv, motions, samples);
  csv.commit();
}

}  // namespace snare::results
