#include "scenario/listed_wire.hpp"

#include "base/csv.hpp"
#include "base/decimal.hpp"
#include "base/files.hpp"
#include "base/index.hpp"
#include "base/units.hpp"
#include "scenario/motion_reader.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace snare::scenario {

using base::mm;
using base::Range;
using base::TomlTable;
using coupling::CentreLine;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Kind = wire::SpatialEnd::Kind;

namespace {

constexpr double least_stretch = -0.01, most_stretch = 0.1;        // of a start [-]
constexpr double rounding = 1e-3 * mm;                             // of places in files
constexpr double sharpest_turn = 45.0 * std::numbers::pi / 180.0;  // between two elements [rad]
constexpr double thickest = 0.2;                                   // diameter over length
constexpr std::size_t most_points = 20001;

/// How the left and the right end are held.
using EndKinds = std::array<Kind, 2>;

/// Points of the line on which a wire begins, in the world.
struct StartPoints {
  std::string file;  ///< as the table names it; empty: straight from `from_mm` to `to_mm`
  /// Coordinates of the unstretched wire, or before its length is known along the line.
  coupling::LinePoints points;
  bool is_material = false;  ///< whether the file has given them
};

bool is_one_free(const EndKinds& ends) {
  return ends[0] == Kind::free || ends[1] == Kind::free;
}

std::string in_mm(double metres) {
  return fmt::format("{:.6g}", metres / mm);
}

std::string in_mm(const Vector3d& p) {
  return fmt::format("[{}, {}, {}]", in_mm(p.x()), in_mm(p.y()), in_mm(p.z()));
}

/// The columns of a file, places and velocities in its own axes.
std::optional<StartPoints> read_points(const TomlTable& table, const std::string& name,
                                       const BesideScenario& beside) {
  using Column = base::CsvColumn;
  const Range place = Range::from(-farthest_mm, farthest_mm), speed = Range::from(-1e3, 1e3);
  const auto optional = Column::Presence::optional;
  const std::vector<Column> columns{
      {"x_mm", Column::Presence::required, place, mm},
      {"y_mm", Column::Presence::required, place, mm},
      {"z_mm", Column::Presence::required, place, mm},
      {"vx_m_s", optional, speed},
      {"vy_m_s", optional, speed},
      {"vz_m_s", optional, speed},
      {"s_mm", optional, Range::from(0.0, farthest_mm), mm, Column::Order::non_decreasing}};
  const base::CsvTable csv = base::read_csv(beside.folder / name, columns);
  beside.input += base::read_text(beside.folder / name);
  if (csv.rows < 2 || csv.rows > most_points) {
    table.fail("shape_file", fmt::format("must have 2 to {} points, has {}", most_points, csv.rows));
    return std::nullopt;
  }
  const auto n = static_cast<Eigen::Index>(csv.rows);
  StartPoints start{name, {Matrix3Xd(3, n), Matrix3Xd::Zero(3, n), csv.columns[6]}, !csv.columns[6].empty()};
  for (int k = 0; k < 3; ++k) {
    start.points.places.row(k) = Eigen::Map<const Eigen::RowVectorXd>(csv.columns[base::at(k)].data(), n);
    const std::vector<double>& v = csv.columns[base::at(3 + k)];
    if (!v.empty()) start.points.velocities.row(k) = Eigen::Map<const Eigen::RowVectorXd>(v.data(), n);
  }
  return start;
}

/// Whether neighbouring points differ, and coordinates of the unstretched wire ascend from 0.
bool are_in_order(const StartPoints& start, const TomlTable& table) {
  const auto& [places, velocities, coordinates] = start.points;
  if (start.is_material && coordinates.front() != 0.0) {
    table.fail("shape_file", "must have s_mm that begins with 0, at the first end of the wire");
    return false;
  }
  for (Eigen::Index i = 1; i < places.cols(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool apart = (places.col(i) - places.col(i - 1)).norm() > 0.0;
    if (apart && (!start.is_material || coordinates[k] > coordinates[k - 1])) continue;
    if (start.file.empty())
      table.fail("to_mm", "must not be where the wire begins");
    else
      table.fail("shape_file", fmt::format("must have points apart from each other{}; nos {} and {} are not",
                                           start.is_material ? ", with s_mm that ascends" : "", i, i + 1));
    return false;
  }
  return true;
}

/// Reports a length that is not that of the line; the coordinates become those of the unstretched wire.
bool fits_length(DeclaredWire& w, const TomlTable& table, StartPoints& start) {
  const double given = w.specification.length, along = start.points.coordinates.back();
  if (!(given > 0.0)) return false;  // which has been reported
  if (start.is_material) {
    if (!base::exceeds(std::abs(given - along), rounding)) {
      w.specification.length = along;
      return true;
    }
    table.fail("length_mm",
               fmt::format("must be {}, the last s_mm of {}, or be left out", in_mm(along), start.file));
    return false;
  }
  const double stretch = along / given - 1.0;
  if (stretch < least_stretch || stretch > most_stretch) {
    table.fail(
        "length_mm",
        fmt::format(
            "must be >= {} and <= {}, or be left out: the wire begins on a line of {} mm, of which it may "
            "be shorter by {:g} and longer by {:g} %",
            in_mm(along / (1.0 + most_stretch)), in_mm(along / (1.0 + least_stretch)), in_mm(along),
            100.0 * most_stretch, -100.0 * least_stretch));
    return false;
  }
  for (double& s : start.points.coordinates) s *= given / along;
  return true;
}

/// Reports stretches and curvatures along the line that the wire cannot have, at the points and between them.
void check_line(const CentreLine& line, const DeclaredWire& w, const StartPoints& start,
                const TomlTable& table) {
  const std::vector<double>& at = start.points.coordinates;
  const double sharpest = 2.0 / w.specification.diameter;
  for (std::size_t i = 0; i < 2 * at.size() - 1; ++i) {
    const double s = 0.5 * (at[i / 2] + at[(i + 1) / 2]);
    const double stretch = line.stretch(s), curvature = line.curvature(s);
    if (stretch < least_stretch || stretch > most_stretch) {
      table.fail(
          "shape_file",
          fmt::format(
              "must stretch the wire by {:g} to {:g} %; it does by {:.3g} % at {} mm from its beginning",
              100.0 * least_stretch, 100.0 * most_stretch, 100.0 * stretch, in_mm(s)));
      return;
    }
    if (curvature < sharpest) continue;
    table.fail(
        "shape_file",
        fmt::format("must bend by radii above half the diameter, {} mm; its radius is {} mm at {} mm from "
                    "its beginning",
                    in_mm(1.0 / sharpest), in_mm(1.0 / curvature), in_mm(s)));
    return;
  }
  const wire::MaterialMesh mesh = w.wire.rod.mesh();
  const wire::Controls controls = w.wire.rod.controls();
  Vector3d before = line.direction(0.0);
  for (int e = 0; e < mesh.edges(); ++e) {
    const Vector3d edge =
        line.place(mesh.coordinate(e + 1, controls)) - line.place(mesh.coordinate(e, controls));
    const double turn = std::atan2(before.cross(edge).norm(), before.dot(edge));
    if (turn > sharpest_turn) {
      table.fail(
          "elements",
          fmt::format("must be more: the wire begins bent by {:.0f} deg between two neighbouring elements, "
                      "{} mm from its beginning; at most 45",
                      turn * 180.0 / std::numbers::pi, in_mm(mesh.coordinate(e, controls))));
      return;
    }
    before = edge.normalized();
  }
}

/// Reports an end that is not where the file says, and the velocity of one that is held.
void check_end(wire::End end, const DeclaredWire& w, const StartPoints& start, const PlacedFrame& on,
               const TomlTable& table) {
  const bool left = end == wire::End::left;
  const char* const place_key = left ? "from_mm" : "to_mm";
  const CentreLine& line = *w.line;
  const double s = left ? 0.0 : line.length();
  const Vector3d place = on.X_WF.R.transpose() * (line.place(s) - on.X_WF.p);
  if (!start.file.empty() && table.has(place_key)) {
    const auto given = read_vector(table, place_key, Range::from(-farthest_mm, farthest_mm), mm);
    if (given && base::exceeds((*given - place).norm(), rounding))
      table.fail(place_key, fmt::format("must be {}, where the line of {} {}, or be left out", in_mm(place),
                                        start.file, left ? "begins" : "ends"));
  }
  const Kind kind = w.wire.rod.properties.end(end).kind;
  if (kind != Kind::free && line.velocity(s).norm() > 0.0)
    table.fail("shape_file", fmt::format("must have no velocity at its {} point: that end is held",
                                         left ? "first" : "last"));
}

/// Reports what cannot stand beside a line on which the wire begins.
void check_keys(const DeclaredWire& w, const StartPoints& start, const TomlTable& table) {
  const wire::SpatialRodProperties& p = w.wire.rod.properties;
  if (table.has("bulge")) table.fail("bulge", "belongs to a wire that begins at rest between two mounts");
  if (w.law)
    table.fail("model", "must be \"full\" or \"quasi_static\" of a wire with shape_file or a free end");
  if (p.right.kind == Kind::free && table.has("to_frame"))
    table.fail("to_frame", "must not be given: that end is free");
  const bool turns =
      is_one_free({p.left.kind, p.right.kind}) && p.left.kind != Kind::clamp && p.right.kind != Kind::clamp;
  if (w.wire.rod.quasi_static && turns)
    table.fail(
        "model",
        "must be \"full\" of a wire with a free end that no clamp holds: it has no equilibrium to follow");
  if (start.points.velocities.isZero(0.0)) return;
  if (w.wire.rod.quasi_static) table.fail("model", "must be \"full\" of a wire that begins with velocities");
  if (w.from_carrier.kind != coupling::MotionCarrier::Kind::world ||
      w.to_carrier.kind != coupling::MotionCarrier::Kind::world)
    table.fail(
        "shape_file",
        "must have no velocities of a wire that an arm or a body carries: it begins with their motion");
}

/// Kinds of `ends`; none without it. Between a free end and a pin nothing twists the wire, so that the pin is
/// a ball joint, about which it may turn by any angle.
std::optional<EndKinds> read_ends(const TomlTable& table) {
  static constexpr base::Choice<Kind> kinds[] = {
      {"clamped", Kind::clamp}, {"pinned", Kind::twisting_pin}, {"free", Kind::free}};
  if (!table.has("ends")) return std::nullopt;
  if (table.has("mount")) table.fail("mount", "cannot stand beside ends, which say how each end is held");
  const TomlTable each = table.table("ends");
  EndKinds ends{each.choice("left", kinds).value_or(Kind::clamp),
                each.choice("right", kinds).value_or(Kind::clamp)};
  for (Kind& kind : ends) {
    if (kind == Kind::twisting_pin && is_one_free(ends)) kind = Kind::pin;
  }
  return ends;
}

/// The points of `shape_file`, or those of a straight wire with a free end. None after a problem, which is
/// reported.
std::optional<StartPoints> read_start_points(const TomlTable& table, const BesideScenario& beside,
                                             const PlacedFrame& from, const PlacedFrame& to) {
  const auto in_world = [](const PlacedFrame& on, const Matrix3Xd& places) -> Matrix3Xd {
    return (on.X_WF.R * places).colwise() + on.X_WF.p;
  };
  std::optional<StartPoints> start;
  if (table.has("shape_file")) {
    const std::string name = table.text("shape_file");
    if (name.empty()) return std::nullopt;
    try {
      start = read_points(table, name, beside);
    } catch (const base::InputError& error) {
      for (const base::InputProblem& p : error.problems())
        table.fail("shape_file",
                   p.file.empty() ? fmt::format("{} = {}, {}", p.key, p.value, p.requirement) : p.message());
    }
    if (!start) return std::nullopt;
    start->points.places = in_world(from, start->points.places);
    start->points.velocities = from.X_WF.R * start->points.velocities;
  } else {
    const Range range = Range::from(-farthest_mm, farthest_mm);
    const auto begin = read_vector(table, "from_mm", range, mm), end = read_vector(table, "to_mm", range, mm);
    if (!begin || !end) return std::nullopt;
    start = StartPoints{"", {Matrix3Xd(3, 2), Matrix3Xd::Zero(3, 2), {}}, false};
    start->points.places << in_world(from, *begin), in_world(to, *end);
  }
  if (!are_in_order(*start, table)) return std::nullopt;
  try {
    if (!start->is_material) start->points = coupling::measured_points(start->points);
  } catch (const std::domain_error& error) {
    table.fail("shape_file", error.what());
    return std::nullopt;
  }
  return start;
}

/// Lays a wire of which all but its place is known onto the line through its points, and reports where it
/// does not fit there.
void lay_on_line(DeclaredWire& w, const TomlTable& table, StartPoints start, const PlacedFrame& from,
                 const PlacedFrame& to) {
  if (w.wire.rod.properties.left.kind != Kind::free) w.from_carrier = from.carrier;
  if (w.wire.rod.properties.right.kind != Kind::free) w.to_carrier = to.carrier;
  check_keys(w, start, table);
  if (!fits_length(w, table, start)) return;
  if (w.specification.diameter >= thickest * w.specification.length)
    table.fail("diameter_mm",
               fmt::format("must be < {}, a fifth of the length of {} mm",
                           in_mm(thickest * w.specification.length), in_mm(w.specification.length)));
  set_rod(w, w.specification.length);
  try {
    w.line.emplace(start.points);
  } catch (const std::domain_error& error) {
    table.fail("shape_file", error.what());
    return;
  }
  check_line(*w.line, w, start, table);
  check_end(wire::End::left, w, start, from, table);
  check_end(wire::End::right, w, start, to, table);
}

}  // namespace

DeclaredWire read_listed_wire(const TomlTable& table, Names& names, const Placement& placement,
                              const wire::RodDamping& damping, const BesideScenario& beside) {
  const std::string name = names.take(table);
  const PlacedFrame from = placement.frame(table, "from_frame").value_or(PlacedFrame{});
  const PlacedFrame to = placement.frame(table, "to_frame").value_or(PlacedFrame{});
  const std::optional<EndKinds> ends = read_ends(table);
  const bool on_a_line = table.has("shape_file") || (ends && is_one_free(*ends));
  const std::optional<StartPoints> start =
      on_a_line ? read_start_points(table, beside, from, to) : std::nullopt;
  std::optional<double> natural_length;
  if (on_a_line) natural_length = start ? start->points.coordinates.back() : 1.0;
  DeclaredWire w = read_wire_item(table, damping, wire::SpatialEnd::Kind::clamp, beside, natural_length);
  w.wire.name = name;
  if (ends) {
    w.wire.rod.properties.left.kind = (*ends)[0];
    w.wire.rod.properties.right.kind = (*ends)[1];
  }
  if (on_a_line) {
    for (const char* key : {"from_mm", "to_mm", "bulge"}) static_cast<void>(table.has(key));
    if (start) lay_on_line(w, table, *start, from, to);
    return w;
  }
  const auto place = [&table](const PlacedFrame& on, std::string_view key, Vector3d& point) {
    if (const auto given = read_vector(table, key, Range::from(-farthest_mm, farthest_mm), mm))
      point = on.X_WF.p + on.X_WF.R * *given;
  };
  place(from, "from_mm", w.from);
  place(to, "to_mm", w.to);
  w.from_carrier = from.carrier;
  w.to_carrier = to.carrier;
  if (table.has("bulge"))
    w.bulge = read_vector(table, "bulge", Range::from(-1e3, 1e3), 1.0).value_or(w.bulge);
  w.bulge = from.X_WF.R * w.bulge;
  stretch(w, table, "to_mm", table.has("bulge") ? "bulge" : "");
  return w;
}

coupling::MotionWire on_line(DeclaredWire w) {
  coupling::begin_on(*w.line, w.wire);
  for (const wire::End end :
       wire::ends) {  // the spring of a mount that gives is a part of the motion, at ease at the start
    w.wire.rod.properties.end(end).translational_stiffness = std::numeric_limits<double>::infinity();
  }
  return w.wire;
}

}  // namespace snare::scenario
