#include "coupling/contact/revolved_shape.hpp"

#include "base/errors.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Right hand of a direction in the plane (distance from the axis, height).
Vector2d right_of(const Vector2d& d) {
  return {d.y(), -d.x()};
}

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Chords of an arc when a profile is tested for crossing itself.
constexpr int test_chords = 16;

bool segments_cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const double abc = cross(b - a, c - a);
  const double abd = cross(b - a, d - a);
  const double cda = cross(d - c, a - c);
  const double cdb = cross(d - c, b - c);
  return abc * abd < 0.0 && cda * cdb < 0.0;
}

}  // namespace

RevolvedShape::RevolvedShape(double start, std::vector<ProfilePiece> pieces) {
  std::vector<base::InputProblem> problems;
  const auto complain = [&problems](std::size_t k, const Vector2d& value, const std::string& requirement) {
    problems.push_back(
        {"", 0, fmt::format("profile[{}]", k + 1), fmt::format("({}, {})", value.x(), value.y()), requirement});
  };
  if (pieces.size() < 2)
    problems.push_back({"", 0, "profile", fmt::format("{} pieces", pieces.size()), "must have two or more"});
  Vector2d from(0.0, start);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const ProfilePiece& given = pieces[k];
    Piece piece;
    piece.from = from;
    piece.to = given.end;
    piece.length = (given.end - from).norm();
    piece.curvature = given.curvature;
    if (!given.end.allFinite() || !std::isfinite(given.curvature) || given.end.x() < 0.0) {
      complain(k, given.end, "must be finite and right of the axis");
    } else if (piece.length == 0.0) {
      complain(k, given.end, "must not be where the piece begins");
    } else if (std::abs(given.curvature) * piece.length > 2.0) {
      complain(k, given.end,
               fmt::format("needs a radius of curvature of half its chord of {} m or more", piece.length));
    } else if (k + 1 == pieces.size() && given.end.x() != 0.0) {
      complain(k, given.end, "must end on the axis");
    }
    if (!problems.empty()) break;
    piece.direction = (piece.to - piece.from) / piece.length;
    if (given.curvature != 0.0) {
      const double radius = 1.0 / std::abs(given.curvature);
      const double deep = std::sqrt(std::max(0.0, radius * radius - 0.25 * piece.length * piece.length));
      piece.centre = 0.5 * (piece.from + piece.to) - std::copysign(deep, given.curvature) * right_of(piece.direction);
    }
    pieces_.push_back(piece);
    from = piece.to;
  }
  if (problems.empty()) {
    const std::vector<Vector2d> line = outline(test_chords);
    double area = 0.0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) area += 0.5 * cross(line[i], line[i + 1]);
    if (!(area > 0.0)) problems.push_back({"", 0, "profile", "", "must run upward, with the outside on its right"});
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      if (line[i].x() < 0.0)
        problems.push_back(
            {"", 0, "profile", fmt::format("({}, {})", line[i].x(), line[i].y()), "must not cross the axis"});
      for (std::size_t j = i + 2; j + 1 < line.size(); ++j) {
        if (segments_cross(line[i], line[i + 1], line[j], line[j + 1]))
          problems.push_back(
              {"", 0, "profile", fmt::format("({}, {})", line[i].x(), line[i].y()), "must not cross itself"});
      }
    }
  }
  if (!problems.empty()) throw base::InputError(problems);
  for (std::size_t k = 0; k <= pieces_.size(); ++k) {
    // On the axis the other side is the mirror image.
    const Vector2d mirror(-1.0, 1.0);
    Vector2d before = Vector2d::Zero();
    Vector2d after = Vector2d::Zero();
    if (k > 0) before = normal_at(pieces_[k - 1], pieces_[k - 1].to);
    if (k < pieces_.size()) after = normal_at(pieces_[k], pieces_[k].from);
    if (k == 0) before = after.cwiseProduct(mirror);
    if (k == pieces_.size()) after = before.cwiseProduct(mirror);
    corner_normal_.emplace_back(before + after);
  }
}

Vector2d RevolvedShape::normal_at(const Piece& piece, const Vector2d& p) const {
  if (piece.curvature == 0.0) return right_of(piece.direction);
  return std::copysign(1.0, piece.curvature) * (p - piece.centre).normalized();
}

// The cut along two planes through the axis, and the circles of the corners.
std::vector<Eigen::Matrix3Xd> RevolvedShape::drawing() const {
  constexpr int arc_chords = 8;
  constexpr int circle_chords = 36;
  const std::vector<Vector2d> profile = outline(arc_chords);
  const auto n = static_cast<Eigen::Index>(profile.size());
  std::vector<Eigen::Matrix3Xd> lines(2, Eigen::Matrix3Xd::Zero(3, 2 * n));
  for (Eigen::Index k = 0; k < n; ++k) {
    const Vector2d& p = profile[static_cast<std::size_t>(k)];
    for (Eigen::Index plane = 0; plane < 2; ++plane) {
      Eigen::Matrix3Xd& line = lines[static_cast<std::size_t>(plane)];
      line(plane, k) = p.x();
      line(plane, 2 * n - 1 - k) = -p.x();
      line(2, k) = line(2, 2 * n - 1 - k) = p.y();
    }
  }
  for (const Piece& piece : pieces_) {
    if (piece.to.x() > 0.0) lines.push_back(circle_drawing(piece.to.x(), piece.to.y(), circle_chords));
  }
  return lines;
}

std::vector<Vector2d> RevolvedShape::outline(int divisions) const {
  std::vector<Vector2d> line{pieces_.front().from};
  for (const Piece& piece : pieces_) {
    if (piece.curvature != 0.0) {
      const Vector2d a = piece.from - piece.centre;
      const double sweep = std::atan2(cross(a, piece.to - piece.centre), a.dot(piece.to - piece.centre));
      for (int i = 1; i < divisions; ++i) {
        const double angle = sweep * i / divisions;
        line.emplace_back(piece.centre + Vector2d(std::cos(angle) * a.x() - std::sin(angle) * a.y(),
                                                  std::sin(angle) * a.x() + std::cos(angle) * a.y()));
      }
    }
    line.push_back(piece.to);
  }
  return line;
}

RevolvedShape::Near RevolvedShape::nearest(const Vector2d& p) const {
  Near best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    const Piece& piece = pieces_[k];
    const Vector2d a = p - piece.from;
    // Inside the piece: within the chord's ends, or within the arc's angle.
    if (piece.curvature == 0.0) {
      const double along = a.dot(piece.direction);
      if (along > 0.0 && along < piece.length) {
        const double signed_distance = a.dot(right_of(piece.direction));
        if (std::abs(signed_distance) < least) {
          least = std::abs(signed_distance);
          best = {signed_distance, right_of(piece.direction), 0.0};
        }
      }
    } else {
      const double convex = std::copysign(1.0, piece.curvature);
      const Vector2d radial = p - piece.centre;
      // A convex arc turns to the left about its centre, a concave one to the right; both sweep half a turn at most.
      if (convex * cross(piece.from - piece.centre, radial) > 0.0 &&
          convex * cross(radial, piece.to - piece.centre) > 0.0) {
        const double signed_distance = convex * (radial.norm() - 1.0 / std::abs(piece.curvature));
        if (std::abs(signed_distance) < least) {
          least = std::abs(signed_distance);
          best = {signed_distance, convex * radial.normalized(), convex / radial.norm()};
        }
      }
    }
  }
  for (std::size_t k = 0; k <= pieces_.size(); ++k) {
    const Vector2d corner = k < pieces_.size() ? pieces_[k].from : pieces_.back().to;
    const Vector2d away = p - corner;
    const double d = away.norm();
    if (d >= least) continue;
    least = d;
    const double side = away.dot(corner_normal_[k]) >= 0.0 ? 1.0 : -1.0;
    if (d > 0.0)
      best = {side * d, side * away / d, side / d};
    else
      best = {0.0, corner_normal_[k].normalized(), 0.0};
  }
  return best;
}

double RevolvedShape::distance(const Vector3d& p) const {
  return nearest({std::hypot(p.x(), p.y()), p.z()}).distance;
}

// phi(x, y, z) = d(rho, z): the Hessian is that of d in the plane through the axis, and d_rho/rho along the parallel circle.
DistanceField RevolvedShape::at(const Vector3d& p) const {
  const double rho = std::hypot(p.x(), p.y());
  const Near near = nearest({rho, p.z()});
  const Vector3d out = rho > 0.0 ? Vector3d(p.x() / rho, p.y() / rho, 0.0) : Vector3d::UnitX();
  const Vector3d around = Vector3d::UnitZ().cross(out);
  const Vector3d tangent = -near.normal.y() * out + near.normal.x() * Vector3d::UnitZ();
  DistanceField field;
  field.distance = near.distance;
  field.normal = near.normal.x() * out + near.normal.y() * Vector3d::UnitZ();
  // On the axis d_rho vanishes where phi is smooth, and d_rho/rho becomes d_rho_rho; beside it the quotient is round-off.
  constexpr double close = 1e-6;  // d_rho/rho - d_rho_rho is of second order in rho
  const bool on_axis = rho * std::abs(near.bending) < close && std::abs(near.normal.x()) < close && rho < close;
  const double hoop = on_axis     ? near.bending * near.normal.y() * near.normal.y()
                      : rho > 0.0 ? near.normal.x() / rho
                                  : 0.0;
  field.hessian = near.bending * tangent * tangent.transpose() + hoop * around * around.transpose();
  return field;
}

std::shared_ptr<const ContactShape> finite_cylinder(double radius, double length) {
  return truncated_cone(radius, radius, length);
}

std::shared_ptr<const ContactShape> truncated_cone(double lower_radius, double upper_radius, double length) {
  std::vector<ProfilePiece> pieces;
  if (lower_radius > 0.0) pieces.push_back({{lower_radius, -0.5 * length}, 0.0});
  pieces.push_back({{upper_radius, 0.5 * length}, 0.0});
  if (upper_radius > 0.0) pieces.push_back({{0.0, 0.5 * length}, 0.0});
  return std::make_shared<RevolvedShape>(-0.5 * length, std::move(pieces));
}

std::shared_ptr<const RevolvedShape> grapple_shaft(const GrappleShaft& s) {
  std::vector<base::InputProblem> problems;
  const auto require = [&problems](bool fine, const std::string& key, double value, const std::string& requirement) {
    if (!fine) problems.push_back({"", 0, "grapple shaft " + key, fmt::format("{}", value), requirement});
  };
  const double top = s.shaft_length + s.underside_length;
  const Vector2d widest(s.cam_radius, top);
  const Vector2d end(s.end_radius, top + s.cam_length);
  const double chord = (end - widest).norm();
  require(s.shaft_radius > 0.0, "shaft_radius", s.shaft_radius, "must be > 0");
  require(s.shaft_length > 0.0, "shaft_length", s.shaft_length, "must be > 0");
  require(s.cam_radius > s.shaft_radius, "cam_radius", s.cam_radius, "must be > shaft_radius");
  require(s.underside_length >= 0.0, "underside_length", s.underside_length, "must be >= 0");
  require(s.cam_length > 0.0, "cam_length", s.cam_length, "must be > 0");
  require(s.end_radius > 0.0 && s.end_radius < s.cam_radius, "end_radius", s.end_radius,
          "must be > 0 and < cam_radius");
  require(s.bulge >= 0.0 && s.bulge <= 0.5 * chord, "bulge", s.bulge,
          fmt::format("must be >= 0 and <= {}, half its chord", 0.5 * chord));
  if (!problems.empty()) throw base::InputError(problems);
  // Radius of an arc of height b over a chord c: (c^2/4 + b^2)/(2 b).
  const double curvature = 2.0 * s.bulge / (0.25 * chord * chord + s.bulge * s.bulge);
  return std::make_shared<RevolvedShape>(0.0, std::vector<ProfilePiece>{{{s.shaft_radius, 0.0}, 0.0},
                                                                        {{s.shaft_radius, s.shaft_length}, 0.0},
                                                                        {widest, 0.0},
                                                                        {end, curvature},
                                                                        {{0.0, end.y()}, 0.0}});
}

}  // namespace snare::coupling
