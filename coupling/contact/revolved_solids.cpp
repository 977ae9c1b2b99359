#include "coupling/contact/revolved_solids.hpp"

#include "base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace snare::coupling {

using Eigen::Vector2d;

namespace {

constexpr double with_round_off = 1.0 + 1e-9;  // of a side that roundings take whole

/// Dimensions of one solid, and what is wrong with them.
class Dimensions {
 public:
  explicit Dimensions(std::string solid) : solid_(std::move(solid)) {}
  void require(bool fine, const std::string& key, double value, const std::string& requirement) {
    if (!fine) problems_.push_back({"", 0, solid_ + " " + key, fmt::format("{}", value), requirement});
  }
  void raise() const {
    if (!problems_.empty()) throw base::InputError(problems_);
  }

 private:
  std::string solid_;
  std::vector<base::InputProblem> problems_;
};

}  // namespace

std::shared_ptr<const ContactShape> finite_cylinder(double radius, double length) {
  return truncated_cone(radius, radius, length);
}

std::shared_ptr<const ContactShape> truncated_cone(double lower_radius, double upper_radius, double length) {
  std::vector<ProfileEdge> edges;
  if (lower_radius > 0.0) edges.push_back({{lower_radius, -0.5 * length}, 0.0});
  edges.push_back({{upper_radius, 0.5 * length}, 0.0});
  if (upper_radius > 0.0) edges.push_back({{0.0, 0.5 * length}, 0.0});
  return std::make_shared<RevolvedShape>(Profile({0.0, -0.5 * length}, edges));
}

std::shared_ptr<const ContactShape> hollow_cylinder(double inner_radius, double outer_radius, double length,
                                                    double rounding) {
  const double wall = outer_radius - inner_radius;
  Dimensions d("ring");
  d.require(inner_radius > 0.0, "inner_radius", inner_radius, "must be > 0");
  d.require(wall > 0.0, "outer_radius", outer_radius, "must be > inner_radius");
  d.require(length > 0.0, "length", length, "must be > 0");
  d.require(
      rounding >= 0.0 && 2.0 * rounding <= with_round_off * std::min(wall, length), "rounding", rounding,
      fmt::format("must be >= 0 and <= {}, half the wall and half the length", 0.5 * std::min(wall, length)));
  d.raise();
  const double top = 0.5 * length;
  return std::make_shared<RevolvedShape>(
      rounded_profile({{inner_radius, -top}, {outer_radius, -top}, {outer_radius, top}, {inner_radius, top}},
                      std::vector<double>(4, rounding)));
}

std::shared_ptr<const ContactShape> cup(const Cup& c) {
  Dimensions d("cup");
  d.require(c.inner_radius > 0.0, "inner_radius", c.inner_radius, "must be > 0");
  d.require(c.depth > 0.0, "depth", c.depth, "must be > 0");
  d.require(c.thickness > 0.0, "thickness", c.thickness, "must be > 0");
  d.require(c.rounding >= 0.0 && 2.0 * c.rounding <= with_round_off * c.thickness, "rounding", c.rounding,
            fmt::format("must be >= 0 and <= {}, half the thickness", 0.5 * c.thickness));
  const double room = std::min(c.inner_radius, c.depth - c.rounding);
  d.require(c.fillet >= 0.0 && c.fillet <= with_round_off * room, "fillet", c.fillet,
            fmt::format("must be >= 0 and <= {}", room));
  d.raise();
  const double outer_radius = c.inner_radius + c.thickness;
  return std::make_shared<RevolvedShape>(
      rounded_profile({{0.0, -c.thickness},
                       {outer_radius, -c.thickness},
                       {outer_radius, c.depth},
                       {c.inner_radius, c.depth},
                       {c.inner_radius, 0.0},
                       {0.0, 0.0}},
                      {0.0, c.rounding, c.rounding, c.rounding, c.fillet, 0.0}));
}

Profile grapple_profile(const GrappleShaft& s) {
  const double top = s.shaft_length + s.underside_length;
  const Vector2d widest(s.cam_radius, top);
  const Vector2d end(s.end_radius, top + s.cam_length);
  const double chord = (end - widest).norm();
  Dimensions d("grapple shaft");
  d.require(s.shaft_radius > 0.0, "shaft_radius", s.shaft_radius, "must be > 0");
  d.require(s.shaft_length > 0.0, "shaft_length", s.shaft_length, "must be > 0");
  d.require(s.cam_radius > s.shaft_radius, "cam_radius", s.cam_radius, "must be > shaft_radius");
  d.require(s.underside_length >= 0.0, "underside_length", s.underside_length, "must be >= 0");
  d.require(s.cam_length > 0.0, "cam_length", s.cam_length, "must be > 0");
  d.require(s.end_radius > 0.0 && s.end_radius < s.cam_radius, "end_radius", s.end_radius,
            "must be > 0 and < cam_radius");
  d.require(s.bulge >= 0.0 && s.bulge <= with_round_off * 0.5 * chord, "bulge", s.bulge,
            fmt::format("must be >= 0 and <= {}, half its chord", 0.5 * chord));
  d.raise();
  // Radius of an arc of height b over a chord c: (c^2/4 + b^2)/(2 b).
  const double curvature = 2.0 * s.bulge / (0.25 * chord * chord + s.bulge * s.bulge);
  return {{0.0, 0.0},
          {{{s.shaft_radius, 0.0}, 0.0},
           {{s.shaft_radius, s.shaft_length}, 0.0},
           {widest, 0.0},
           {end, curvature},
           {{0.0, end.y()}, 0.0}}};
}

std::shared_ptr<const ContactShape> grapple_shaft(const GrappleShaft& shaft) {
  return std::make_shared<RevolvedShape>(grapple_profile(shaft));
}

}  // namespace snare::coupling
