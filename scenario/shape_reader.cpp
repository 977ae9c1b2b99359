#include "scenario/shape_reader.hpp"

#include "base/archive.hpp"
#include "base/units.hpp"
#include "coupling/contact/mesh_shape.hpp"
#include "coupling/contact/revolved_solids.hpp"
#include "scenario/motion_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace snare::scenario {

using base::Choice;
using base::Range;
using base::TomlTable;

namespace {

using base::mm;
constexpr double far = farthest_mm;

enum class ShapeKind {
  knife_edge,
  cylinder,
  sphere,
  capsule,
  cone,
  grapple_shaft,
  ring,
  cup,
  plane,
  revolved,
  mesh
};

std::optional<ShapeKind> read_kind(const TomlTable& table) {
  static constexpr Choice<ShapeKind> kinds[] = {{"knife_edge", ShapeKind::knife_edge},
                                                {"cylinder", ShapeKind::cylinder},
                                                {"sphere", ShapeKind::sphere},
                                                {"capsule", ShapeKind::capsule},
                                                {"cone", ShapeKind::cone},
                                                {"grapple_shaft", ShapeKind::grapple_shaft},
                                                {"ring", ShapeKind::ring},
                                                {"cup", ShapeKind::cup},
                                                {"plane", ShapeKind::plane},
                                                {"revolved", ShapeKind::revolved},
                                                {"mesh", ShapeKind::mesh}};
  return table.choice("kind", kinds);
}

// The document is told what a maker of shapes finds wrong.
template <class Make>
std::shared_ptr<const coupling::ContactShape> made(const TomlTable& table, std::string_view key,
                                                   const Make& make) {
  try {
    return make();
  } catch (const base::InputError& error) {
    for (const base::InputProblem& p : error.problems())
      table.fail(key,
                 p.file.empty() ? fmt::format("{} = {}, {}", p.key, p.value, p.requirement) : p.message());
  }
  return nullptr;
}

// A polygon in the half plane (radius, height), its corners rounded.
std::shared_ptr<const coupling::ContactShape> read_revolved(const TomlTable& table) {
  constexpr std::size_t most_corners = 1000;
  const std::vector<double> radius = table.numbers("radius_mm", 3, most_corners, Range::from(0.0, far), mm);
  const std::size_t n = radius.size();
  if (n == 0) return nullptr;
  const std::vector<double> height = table.numbers("height_mm", n, n, Range::from(-far, far), mm);
  std::vector<double> rounding(n, 0.0);
  if (table.has("rounding_mm")) rounding = table.numbers("rounding_mm", n, n, Range::from(0.0, far), mm);
  if (height.size() != n || rounding.size() != n) return nullptr;
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t k = 0; k < n; ++k) corners.emplace_back(radius[k], height[k]);
  return made(table, "kind", [&] {
    return std::make_shared<coupling::RevolvedShape>(coupling::rounded_profile(corners, rounding));
  });
}

coupling::GrappleShaft read_grapple_shaft(const TomlTable& table) {
  coupling::GrappleShaft s;
  s.shaft_radius = table.number_or("shaft_radius_mm", s.shaft_radius, Range::above(0.0, far), mm);
  s.shaft_length = table.number_or("shaft_length_mm", s.shaft_length, Range::above(0.0, far), mm);
  s.cam_radius = table.number_or("cam_radius_mm", s.cam_radius, Range::above(0.0, far), mm);
  s.underside_length = table.number_or("underside_length_mm", s.underside_length, Range::from(0.0, far), mm);
  s.cam_length = table.number_or("cam_length_mm", s.cam_length, Range::above(0.0, far), mm);
  s.end_radius = table.number_or("end_radius_mm", s.end_radius, Range::above(0.0, far), mm);
  s.bulge = table.number_or("bulge_mm", s.bulge, Range::from(0.0, far), mm);
  return s;
}

}  // namespace

std::shared_ptr<const coupling::ContactShape> read_shape(const TomlTable& table,
                                                         const std::filesystem::path& folder,
                                                         std::string& meshes) {
  const Range size = Range::above(0.0, far);
  const Range from_zero = Range::from(0.0, far);
  const auto kind = read_kind(table);
  if (!kind) return nullptr;
  switch (*kind) {
    case ShapeKind::knife_edge:
      return std::make_shared<coupling::Capsule>(0.0, table.number("length_mm", size, mm));
    case ShapeKind::sphere:
      return std::make_shared<coupling::Ball>(table.number("radius_mm", size, mm));
    case ShapeKind::capsule: {
      const double radius = table.number("radius_mm", size, mm);
      return std::make_shared<coupling::Capsule>(radius, table.number("length_mm", size, mm));
    }
    case ShapeKind::cylinder: {
      const double radius = table.number("radius_mm", size, mm);
      const double length = table.number("length_mm", size, mm);
      if (!(radius > 0.0 && length > 0.0)) return nullptr;  // reported
      return coupling::finite_cylinder(radius, length);
    }
    case ShapeKind::cone: {
      const double lower = table.number("lower_radius_mm", from_zero, mm);
      const double upper = table.number("upper_radius_mm", from_zero, mm);
      const double length = table.number("length_mm", size, mm);
      if (lower == 0.0 && upper == 0.0)
        table.fail("upper_radius_mm", "must be > 0 where lower_radius_mm is 0");
      if (!(std::max(lower, upper) > 0.0 && lower >= 0.0 && upper >= 0.0 && length > 0.0)) return nullptr;
      return coupling::truncated_cone(lower, upper, length);
    }
    case ShapeKind::grapple_shaft: {
      const coupling::GrappleShaft s = read_grapple_shaft(table);
      return made(table, "kind", [&s] { return grapple_shaft(s); });
    }
    case ShapeKind::ring: {
      const double inner = table.number("inner_radius_mm", size, mm);
      const double outer = table.number("outer_radius_mm", size, mm);
      const double length = table.number("length_mm", size, mm);
      const double rounding = table.number_or("rounding_mm", 0.0, from_zero, mm);
      if (!std::isfinite(inner + outer + length + rounding)) return nullptr;
      return made(table, "kind", [&] { return coupling::hollow_cylinder(inner, outer, length, rounding); });
    }
    case ShapeKind::cup: {
      coupling::Cup c;
      c.inner_radius = table.number("inner_radius_mm", size, mm);
      c.depth = table.number("depth_mm", size, mm);
      c.thickness = table.number("thickness_mm", size, mm);
      c.rounding = table.number_or("rounding_mm", 0.0, from_zero, mm);
      c.fillet = table.number_or("fillet_mm", 0.0, from_zero, mm);
      if (!std::isfinite(c.inner_radius + c.depth + c.thickness + c.rounding + c.fillet)) return nullptr;
      return made(table, "kind", [&] { return coupling::cup(c); });
    }
    case ShapeKind::plane:
      return std::make_shared<coupling::HalfSpace>(0.5 * table.number_or("drawn_mm", 100.0 * mm, size, mm));
    case ShapeKind::revolved:
      return read_revolved(table);
    case ShapeKind::mesh: {
      static constexpr Choice<double> units[] = {{"mm", 1e-3}, {"m", 1.0}};
      const std::string name = table.text("file");
      const auto unit = table.choice("unit", units);
      if (name.empty() || !unit) return nullptr;
      return made(table, "file", [&] {
        coupling::TriangleMesh mesh = coupling::read_triangle_mesh(folder / name, *unit);
        base::ByteWriter bytes;
        bytes(mesh.points);
        for (std::array<int, 3>& triangle : mesh.triangles) {
          for (int& corner : triangle) bytes(corner);
        }
        meshes += fmt::format("{:x};", base::fingerprint(bytes.bytes()));
        return std::make_shared<coupling::MeshShape>(mesh);
      });
    }
  }
  return nullptr;
}

std::optional<ShaftSize> read_shaft_size(const TomlTable& table) {
  const auto kind = read_kind(table);
  if (!kind) return std::nullopt;
  const Range size = Range::above(0.0, far);
  switch (*kind) {
    case ShapeKind::knife_edge:
      return ShaftSize{0.0, 0.5 * table.number("length_mm", size, mm), 0.0};
    case ShapeKind::capsule:
    case ShapeKind::cylinder:
      return ShaftSize{table.number("radius_mm", size, mm), 0.5 * table.number("length_mm", size, mm), 0.0};
    case ShapeKind::grapple_shaft: {
      const coupling::GrappleShaft s = read_grapple_shaft(table);
      return ShaftSize{s.shaft_radius, 0.5 * s.shaft_length, 0.5 * s.shaft_length};
    }
    default:
      return std::nullopt;
  }
}

namespace {

/// Points of a shape's rims and axis as its table asks for them.
class PointReader {
 public:
  explicit PointReader(const TomlTable& table)
      : table_(table), around_(table.integer_or("rim_points", 8, 1, 1000)) {}

  ShapePoints of(ShapeKind kind, const std::filesystem::path& folder) {
    switch (kind) {
      case ShapeKind::sphere:
        result_.points.emplace_back(Eigen::Vector3d::Zero());
        result_.radius = size("radius_mm");
        break;
      case ShapeKind::knife_edge:
      case ShapeKind::capsule:
        axis(half_length());
        if (kind == ShapeKind::capsule) result_.radius = size("radius_mm");
        break;
      case ShapeKind::cylinder:
      case ShapeKind::cone:
      case ShapeKind::ring:
        rims_at_the_ends(kind, half_length());
        break;
      case ShapeKind::grapple_shaft: {
        const coupling::GrappleShaft s = read_grapple_shaft(table_);
        const double cam = s.shaft_length + s.underside_length;
        rim(s.shaft_radius, 0.0);
        rim(s.cam_radius, cam);
        rim(s.end_radius, cam + s.cam_length);
        break;
      }
      case ShapeKind::cup: {
        const double inner = size("inner_radius_mm"), thickness = size("thickness_mm");
        const double depth = size("depth_mm");
        rim(inner, depth);
        rim(inner + thickness, depth);
        rim(inner + thickness, -thickness);
        break;
      }
      case ShapeKind::plane:
        break;
      case ShapeKind::revolved: {
        const std::vector<double> radius = table_.numbers("radius_mm", 3, 1000, Range::from(0.0, far), mm);
        const std::vector<double> height =
            table_.numbers("height_mm", radius.size(), radius.size(), Range::from(-far, far), mm);
        for (std::size_t k = 0; k < std::min(radius.size(), height.size()); ++k) rim(radius[k], height[k]);
        break;
      }
      case ShapeKind::mesh:
        mesh(folder);
        break;
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] double size(const char* key) const { return table_.number(key, Range::above(0.0, far), mm); }
  [[nodiscard]] double size_or_zero(const char* key) const {
    return table_.number(key, Range::from(0.0, far), mm);
  }
  [[nodiscard]] double half_length() const { return 0.5 * size("length_mm"); }
  void rim(double radius, double height) {
    const int count = radius > 0.0 ? around_ : 1;
    for (int k = 0; k < count; ++k) {
      const double azimuth = 2.0 * std::numbers::pi * k / count;
      result_.points.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth), height);
    }
  }
  void axis(double half) {
    const int along = table_.integer_or("axis_points", 2, 2, 1000);
    for (int k = 0; k < along; ++k)
      result_.points.emplace_back(0.0, 0.0, half * (2.0 * k / (along - 1) - 1.0));
  }
  void rims_at_the_ends(ShapeKind kind, double half) {
    if (kind == ShapeKind::cone) {
      rim(size_or_zero("lower_radius_mm"), -half);
      rim(size_or_zero("upper_radius_mm"), half);
      return;
    }
    for (const double z : {-half, half}) {
      rim(size(kind == ShapeKind::ring ? "inner_radius_mm" : "radius_mm"), z);
      if (kind == ShapeKind::ring) rim(size("outer_radius_mm"), z);
    }
  }
  void mesh(const std::filesystem::path& folder) {
    static constexpr Choice<double> units[] = {{"mm", 1e-3}, {"m", 1.0}};
    const auto unit = table_.choice("unit", units);
    const std::string name = table_.text("file");
    if (name.empty() || !unit) return;
    try {
      result_.points = coupling::read_triangle_mesh(folder / name, *unit).points;
    } catch (const base::InputError&) {  // told where the shape is read
      result_.points.clear();
    }
  }

  const TomlTable& table_;
  int around_;  // points of a rim
  ShapePoints result_;
};

}  // namespace

ShapePoints read_shape_points(const TomlTable& table, const std::filesystem::path& folder) {
  const auto kind = read_kind(table);
  return kind ? PointReader(table).of(*kind, folder) : ShapePoints();
}

}  // namespace snare::scenario
