#include "coupling/contact/profile.hpp"

#include "base/errors.hpp"
#include "base/index.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace snare::coupling {

using base::at;
using Eigen::Vector2d;

namespace {

// Right hand of a direction in the half plane.
Vector2d right_of(const Vector2d& d) {
  return {d.y(), -d.x()};
}

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Chords of an arc when a profile is tested for crossing itself.
constexpr int test_chords = 16;
// Edges that turn by less inward meet smoothly, whatever the digits of their file [rad].
constexpr double smooth_turn = 1e-4;

bool segments_cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const double abc = cross(b - a, c - a);
  const double abd = cross(b - a, d - a);
  const double cda = cross(d - c, a - c);
  const double cdb = cross(d - c, b - c);
  return abc * abd < 0.0 && cda * cdb < 0.0;
}

}  // namespace

Vector2d Profile::Edge::normal_at(const Vector2d& p) const {
  if (curvature == 0.0) return right_of(direction);
  return std::copysign(1.0, curvature) * (p - centre).normalized();
}

Profile::Profile(const Vector2d& start, const std::vector<ProfileEdge>& edges) : loop_(start.x() > 0.0) {
  std::vector<base::InputProblem> problems;
  const auto complain = [&problems](std::size_t k, const Vector2d& value, const std::string& requirement) {
    problems.push_back({"", 0, fmt::format("profile[{}]", k + 1),
                        fmt::format("({}, {})", value.x(), value.y()), requirement});
  };
  if (edges.size() < 2)
    problems.push_back({"", 0, "profile", fmt::format("{} edges", edges.size()), "must have two or more"});
  if (!start.allFinite() || start.x() < 0.0)
    problems.push_back({"", 0, "profile", fmt::format("({}, {})", start.x(), start.y()),
                        "must begin on the axis or right of it"});
  Vector2d from = start;
  for (std::size_t k = 0; k < edges.size() && problems.empty(); ++k) {
    const ProfileEdge& given = edges[k];
    Edge edge;
    edge.from = from;
    edge.to = given.end;
    edge.length = (given.end - from).norm();
    edge.curvature = given.curvature;
    if (!given.end.allFinite() || !std::isfinite(given.curvature) || given.end.x() < 0.0) {
      complain(k, given.end, "must be finite and right of the axis");
    } else if (edge.length == 0.0) {
      complain(k, given.end, "must not be where the edge begins");
    } else if (std::abs(given.curvature) * edge.length > 2.0) {
      complain(k, given.end,
               fmt::format("needs a radius of curvature of half its chord of {} m or more", edge.length));
    } else if (k + 1 == edges.size() && (loop_ ? given.end != start : given.end.x() != 0.0)) {
      complain(k, given.end, loop_ ? "must end where it began" : "must end on the axis");
    }
    edge.direction = (edge.to - edge.from) / edge.length;
    if (given.curvature != 0.0) {
      const double radius = 1.0 / std::abs(given.curvature);
      const double deep = std::sqrt(std::max(0.0, radius * radius - 0.25 * edge.length * edge.length));
      edge.centre =
          0.5 * (edge.from + edge.to) - std::copysign(deep, given.curvature) * right_of(edge.direction);
    }
    edges_.push_back(edge);
    from = edge.to;
  }
  if (problems.empty()) {
    const std::vector<Vector2d> line = outline(whole(), test_chords);
    double area = 0.0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) area += 0.5 * cross(line[i], line[i + 1]);
    if (!(area > 0.0))
      problems.push_back({"", 0, "profile", "", "must run upward, with the outside on its right"});
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
  const int n = whole().count;
  for (int k = 0; k <= n; ++k) {
    // On the axis the other side is the mirror image.
    const Vector2d mirror(-1.0, 1.0);
    const Vector2d before = k > 0 || loop_ ? edge(k - 1 + n).normal_at(edge(k - 1 + n).to)
                                           : edge(0).normal_at(edge(0).from).cwiseProduct(mirror);
    const Vector2d after = k < n || loop_ ? edge(k).normal_at(edge(k).from)
                                          : edge(n - 1).normal_at(edge(n - 1).to).cwiseProduct(mirror);
    corners_.push_back(
        {k < n ? edge(k).from : edge(n - 1).to, before + after, cross(before, after) < -smooth_turn});
  }
}

const Profile::Edge& Profile::edge(int index) const {
  return edges_[at(index % static_cast<int>(edges_.size()))];
}

std::vector<Profile::Chain> Profile::chains(double wire_radius) const {
  const int n = whole().count;
  const auto too_narrow = [&](int k) { return edge(k).curvature * wire_radius <= -1.0; };
  const auto begins = [&](int k) {
    if (!loop_ && k == 0) return true;
    return corners_[at(k % n)].concave || too_narrow(k - 1 + n);
  };
  int first = 0;
  while (first < n && !begins(first)) ++first;
  if (first == n) return {whole()};
  std::vector<Chain> chains;
  for (int k = first; k < first + n; ++k) {
    if (too_narrow(k)) continue;
    if (begins(k)) chains.push_back({k % n, 0});
    ++chains.back().count;
  }
  return chains;
}

std::vector<Vector2d> Profile::outline(Chain chain, int divisions) const {
  std::vector<Vector2d> line{edge(chain.first).from};
  for (int k = chain.first; k < chain.first + chain.count; ++k) {
    const Edge& e = edge(k);
    if (e.curvature != 0.0) {
      const Vector2d a = e.from - e.centre;
      const double sweep = std::atan2(cross(a, e.to - e.centre), a.dot(e.to - e.centre));
      for (int i = 1; i < divisions; ++i) {
        const double angle = sweep * i / divisions;
        line.emplace_back(e.centre + Vector2d(std::cos(angle) * a.x() - std::sin(angle) * a.y(),
                                              std::sin(angle) * a.x() + std::cos(angle) * a.y()));
      }
    }
    line.push_back(e.to);
  }
  return line;
}

Profile::Near Profile::nearest(const Vector2d& p, Chain chain) const {
  Near best;
  double least = std::numeric_limits<double>::infinity();
  const int end = chain.first + chain.count;
  for (int k = chain.first; k < end; ++k) {
    const Edge& e = edge(k);
    const Vector2d a = p - e.from;
    // Inside the edge: within the chord's ends, or within the arc's angle.
    if (e.curvature == 0.0) {
      const double along = a.dot(e.direction);
      if (along > 0.0 && along < e.length) {
        const double signed_distance = a.dot(right_of(e.direction));
        if (std::abs(signed_distance) < least) {
          least = std::abs(signed_distance);
          best = {signed_distance, right_of(e.direction), 0.0};
        }
      }
    } else {
      const double convex = std::copysign(1.0, e.curvature);
      const Vector2d radial = p - e.centre;
      // A convex arc turns to the left about its centre, a concave one to the right; both sweep half a turn
      // at most.
      if (convex * cross(e.from - e.centre, radial) > 0.0 && convex * cross(radial, e.to - e.centre) > 0.0) {
        const double signed_distance = convex * (radial.norm() - 1.0 / std::abs(e.curvature));
        if (std::abs(signed_distance) < least) {
          least = std::abs(signed_distance);
          best = {signed_distance, convex * radial.normalized(), convex / radial.norm()};
        }
      }
    }
  }
  for (int k = chain.first; k <= end; ++k) {
    const Corner& corner = corners_[at(k <= whole().count ? k : k - whole().count)];
    const Vector2d away = p - corner.place;
    const double d = away.norm();
    if (d >= least) continue;
    least = d;
    const double side = away.dot(corner.normal) >= 0.0 ? 1.0 : -1.0;
    if (d > 0.0)
      best = {side * d, side * away / d, side / d};
    else
      best = {0.0, corner.normal.normalized(), 0.0};
  }
  return best;
}

Profile rounded_profile(const std::vector<Vector2d>& corners, const std::vector<double>& radii) {
  assert(corners.size() == radii.size());
  const std::size_t n = corners.size();
  if (n < 3)
    throw base::InputError({"", 0, "profile", fmt::format("{} corners", n), "must have three or more"});
  const bool loop = corners.front().x() > 0.0;
  std::vector<base::InputProblem> problems;
  // Of every corner: how far from it its arc begins on either side, and the arc's curvature.
  std::vector<double> reach(n, 0.0);
  std::vector<double> curvature(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    if (radii[k] == 0.0) continue;
    const auto complain = [&](const std::string& requirement) {
      problems.push_back(
          {"", 0, fmt::format("rounding[{}]", k + 1), fmt::format("{}", radii[k]), requirement});
    };
    if (!loop && (k == 0 || k + 1 == n)) {
      complain("must be 0 on the axis");
      continue;
    }
    const Vector2d in = corners[k] - corners[(k + n - 1) % n];
    const Vector2d out = corners[(k + 1) % n] - corners[k];
    const double turn = std::atan2(cross(in, out), in.dot(out));
    reach[k] = radii[k] * std::tan(0.5 * std::abs(turn));
    if (turn != 0.0) curvature[k] = std::copysign(1.0 / radii[k], turn);
    if (!(radii[k] > 0.0 && std::isfinite(radii[k]))) complain("must be finite and >= 0");
  }
  constexpr double round_off = 1e-9;  // of a side that two arcs take whole
  std::vector<ProfileEdge> edges;
  Vector2d start = corners.front();
  if (loop) start += reach[0] * (corners[1] - corners[0]).normalized();
  Vector2d from = start;
  const auto add = [&](const Vector2d& to, double bend) {
    edges.push_back({to, bend});
    from = to;
  };
  for (std::size_t i = 1; i <= (loop ? n : n - 1); ++i) {
    const std::size_t k = i % n;
    const Vector2d& corner = corners[k];
    const Vector2d side = corner - corners[i - 1];
    const double left = side.norm() - reach[i - 1] - reach[k];
    if (left < -round_off * side.norm())
      problems.push_back(
          {"", 0, fmt::format("rounding[{}]", k + 1), fmt::format("{}", radii[k]),
           fmt::format("the arcs at the ends of the side before it must fit into its {} m", side.norm())});
    const Vector2d arc_begin = corner - reach[k] * side.normalized();
    if (left > round_off * side.norm() || side.norm() == 0.0) add(arc_begin, 0.0);
    if (reach[k] > 0.0)
      add(k == 0 ? start : Vector2d(corner + reach[k] * (corners[(k + 1) % n] - corner).normalized()),
          curvature[k]);
  }
  if (!problems.empty()) throw base::InputError(problems);
  if (loop) edges.back().end = start;
  return {start, edges};
}

}  // namespace snare::coupling
