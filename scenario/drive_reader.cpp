#include "scenario/drive_reader.hpp"

#include "base/csv.hpp"
#include "base/files.hpp"
#include "base/index.hpp"
#include "base/units.hpp"
#include "scenario/motion_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace snare::scenario {

using base::at;
using base::Choice;
using base::Range;
using base::TomlTable;
using multibody::Course;
using multibody::Drive;
using multibody::DriveMode;

namespace {

/// Keys of angles or of lengths.
struct Units {
  const char *to, *by, *rate, *stiffness, *damping, *limit, *column, *torque;
  double unit;
};
constexpr Units of_angles{"to_deg",   "by_deg",    "rate_deg_s", "proportional_Nm_rad", "derivative_Nms_rad",
                          "limit_Nm", "angle_deg", "torque_Nm",  base::degree};
constexpr Units of_lengths{"to_mm",           "by_mm",   "rate_mm_s",   "proportional_N_m",
                           "derivative_Ns_m", "limit_N", "position_mm", "force_N",
                           base::mm};

using CourseMaker = std::function<Course(double time, double from)>;

/// Mean about one row with the weights of a raised cosine that ends a half width of time away, and no farther
/// than the rows go on both sides.
double smoothed(const std::vector<double>& times, const std::vector<double>& values, std::size_t row,
                double half_width) {
  const double width = std::min({half_width, times[row] - times.front(), times.back() - times[row]});
  if (!(width > 0.0)) return values[row];
  double sum = 0.0, weights = 0.0;
  const auto add = [&](std::size_t k) {
    const double weight = 1.0 + std::cos(std::numbers::pi * (times[k] - times[row]) / width);
    sum += weight * values[k];
    weights += weight;
  };
  for (std::size_t k = row; k < times.size() && times[k] - times[row] < width; ++k) add(k);
  for (std::size_t k = row; k-- > 0 && times[row] - times[k] < width;) add(k);
  return sum / weights;
}

/// A course from a CSV of `time_s` and the position, counted from where the motor is when it begins, or from
/// its zero.
CourseMaker table_course(const TomlTable& table, const std::filesystem::path& folder, const Units& u,
                         std::string& input) {
  const std::string name = table.text("course_file");
  static constexpr Choice<bool> counts[] = {{"motor", false}, {"zero", true}};
  const bool from_zero = table.has("counted_from") && table.choice("counted_from", counts).value_or(false);
  const std::string column = table.text_or("course_column", u.column);
  const double factor = table.number_or("course_factor", 1.0, Range::from(-1e9, 1e9));
  const int every = table.integer_or("course_every", 1, 1, 1000000);
  const double smooth = table.number_or("course_smooth_s", 0.0, Range::from(0.0, 1e3));
  if (name.empty()) return {};
  try {
    const base::CsvTable csv = base::read_csv(
        folder / name,
        {{"time_s", base::CsvColumn::Presence::required, Range::from(0.0, 1e6)},
         {column, base::CsvColumn::Presence::required, Range::from(-1e6, 1e6), factor * u.unit}});
    std::vector<double> times, values;
    for (std::size_t k = 0; k < csv.rows; k += base::at(every)) {
      times.push_back(csv.columns[0][k]);
      values.push_back(smooth > 0.0 ? smoothed(csv.columns[0], csv.columns[1], k, smooth)
                                    : csv.columns[1][k]);
    }
    bool ascending = times.size() >= 2 && times.front() == 0.0;
    for (std::size_t k = 1; k < times.size(); ++k) ascending = ascending && times[k] > times[k - 1];
    if (!ascending) {
      table.fail("course_file", "must have two lines or more, of time_s from 0 on, ascending");
      return {};
    }
    for (std::size_t k = 0; k < times.size(); ++k) input += fmt::format("{} {}\n", times[k], values[k]);
    return [times, values, from_zero, smooth](double time, double from) {
      const double begin = from_zero ? values.front() : from;
      return smooth > 0.0 ? Course::smoothly_through(begin, time, times, values)
                          : Course::through(begin, time, times, values);
    };
  } catch (const base::InputError& error) {
    for (const base::InputProblem& problem : error.problems())
      table.fail("course_file", fmt::format("{}: {}", problem.file, problem.requirement));
    return {};
  }
}

/// Where the motor is told to go; nothing where the table does not say: it stays.
CourseMaker read_course(const TomlTable& table, const std::filesystem::path& folder, const Units& u,
                        std::string& input) {
  if (table.has("course_file")) {
    for (const char* key : {u.to, u.by, u.rate}) {
      if (table.has(key)) table.fail(key, "cannot stand beside course_file");
    }
    return table_course(table, folder, u, input);
  }
  const bool by = table.has(u.by);
  if (!by && !table.has(u.to)) {
    for (const char* key : {u.rate, "duration_s", "ramp_s"}) {
      if (table.has(key)) table.fail(key, fmt::format("only beside {} or {}", u.to, u.by));
    }
    return {};
  }
  if (by && table.has(u.to)) table.fail(u.by, fmt::format("cannot stand beside {}", u.to));
  const double way = table.number(by ? u.by : u.to, Range::from(-1e5, 1e5), u.unit);
  const auto target = [way, by](double from) { return by ? from + way : way; };
  if (table.has(u.rate)) {
    if (table.has("duration_s")) table.fail("duration_s", fmt::format("cannot stand beside {}", u.rate));
    const double rate = table.number(u.rate, Range::above(0.0, 1e5), u.unit);
    const double ramp = table.number_or("ramp_s", 0.05, Range::above(0.0, 1e4));
    return [=](double time, double from) {
      return target(from) == from ? Course::standing(from)
                                  : Course::at_rate(from, target(from), time, rate, ramp);
    };
  }
  const double duration = table.number("duration_s", Range::above(0.0, 1e6));
  return [=](double time, double from) { return Course(from, target(from), time, duration); };
}

/// A torque or a force over time: constant, or straight between the lines of a CSV of `time_s`.
DriveMaker read_torque(const TomlTable& table, const std::filesystem::path& folder, const Units& u,
                       std::string& input) {
  const auto made = [](std::vector<double> times, std::vector<double> values) {
    return [times = std::move(times), values = std::move(values)](double time, double) {
      return Drive::with_torque(time, times, values);
    };
  };
  if (!table.has("torque_file")) {
    for (const char* key : {"torque_column", "torque_factor", "torque_every"})
      if (table.has(key)) table.fail(key, "only beside torque_file");
    return made({0.0}, {table.number(u.torque, Range::from(-1e12, 1e12))});
  }
  if (table.has(u.torque)) table.fail(u.torque, "cannot stand beside torque_file");
  const std::string name = table.text("torque_file");
  const std::string column = table.text_or("torque_column", u.torque);
  const double factor = table.number_or("torque_factor", 1.0, Range::from(-1e9, 1e9));
  const int every = table.integer_or("torque_every", 1, 1, 1000000);
  if (name.empty()) return made({0.0}, {0.0});
  try {
    using Presence = base::CsvColumn::Presence;
    const base::CsvTable csv = base::read_csv(
        folder / name,
        {{"time_s", Presence::required, Range::from(0.0, 1e6), 1.0, base::CsvColumn::Order::non_decreasing},
         {column, Presence::required, Range::from(-1e12, 1e12), factor}});
    std::vector<double> times, values;
    for (std::size_t k = 0; k < csv.rows; k += base::at(every)) {
      times.push_back(csv.columns[0][k]);
      values.push_back(csv.columns[1][k]);
      input += fmt::format("{} {}\n", times.back(), values.back());
    }
    if (!times.empty()) return made(std::move(times), std::move(values));
    table.fail("torque_file", fmt::format("{} must have a line or more", name));
  } catch (const base::InputError& error) {
    for (const base::InputProblem& problem : error.problems())
      table.fail("torque_file", fmt::format("{}: {}", problem.file, problem.requirement));
  }
  return made({0.0}, {0.0});
}

}  // namespace

DriveMaker read_drive(const TomlTable& table, const std::filesystem::path& folder, const Drive& as_described,
                      bool slides, std::string& input) {
  static constexpr Choice<DriveMode> modes[] = {{"locked", DriveMode::locked},
                                                {"servo", DriveMode::servo},
                                                {"limp", DriveMode::limp},
                                                {"torque", DriveMode::torque},
                                                {"course", DriveMode::course}};
  const Units& u = slides ? of_lengths : of_angles;
  Drive drive;
  drive.mode = table.choice("mode", modes).value_or(DriveMode::limp);
  if (drive.mode == DriveMode::servo) {
    const bool described = as_described.mode == DriveMode::servo;
    const auto gain = [&](const char* key, double value, Range range) {
      return described ? table.number_or(key, value, range) : table.number(key, range);
    };
    drive.proportional = gain(u.stiffness, as_described.proportional, Range::above(0.0, 1e15));
    drive.derivative = gain(u.damping, as_described.derivative, Range::from(0.0, 1e15));
    drive.rate_share = table.number_or("rate_share", as_described.rate_share, Range::from(0.0, 1.0));
    drive.limit =
        table.number_or(u.limit, described ? as_described.limit : drive.limit, Range::above(0.0, 1e15));
  }
  if (drive.mode == DriveMode::locked || drive.mode == DriveMode::limp)
    return [drive](double, double angle) {
      Drive d = drive;
      d.course = Course::standing(angle);
      return d;
    };
  if (drive.mode == DriveMode::torque) return read_torque(table, folder, u, input);
  const CourseMaker course = read_course(table, folder, u, input);
  return [drive, course](double time, double angle) {
    Drive d = drive;
    d.course = course ? course(time, angle) : Course::standing(angle);
    return d;
  };
}

std::vector<MotorJoint> read_joints(const Composition& c, const TomlTable& table) {
  const std::string name = table.text("joint");
  std::vector<MotorJoint> found;
  std::string known;
  for (const auto& [joint, motor] : c.joints) {
    if (joint == name || joint.starts_with(name + "::")) found.push_back(motor);
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", joint);
  }
  if (found.empty() && !name.empty() && !c.placement.is_excused(name))
    table.fail("joint", known.empty() ? "must be a joint with a motor; there is none"
                                      : "must be a joint, or an arm or a snare for all of theirs: " + known);
  const bool alike = std::all_of(found.begin(), found.end(),
                                 [&](const MotorJoint& j) { return j.slides == found[0].slides; });
  const std::string mode = table.text_or("mode", "");
  if (!alike && (mode == "servo" || mode == "course" || mode == "torque"))
    table.fail("joint", "must not name joints that turn and joints that slide at once");
  return found;
}

void read_drives(Composition& c) {
  std::map<std::pair<int, int>, bool> taken;
  for (const TomlTable& table : c.document.root().tables("drives")) {
    for (const MotorJoint& j : read_joints(c, table)) {
      if (std::exchange(taken[{j.arm, j.joint}], true)) table.fail("joint", "is driven already");
      coupling::MotionArm& arm = c.motion.arms[at(j.arm)];
      multibody::Drive& drive = arm.drives[at(j.joint)];
      const double begin = table.number_or("begin_s", 0.0, Range::from(0.0, 1e6));
      drive = read_drive(table, c.folder, drive, j.slides, c.input)(begin, arm.start.motor[j.joint]);
    }
  }
}

}  // namespace snare::scenario
