// Random pushes of loose wires: the discrete rod as `snare push` solves it against the continuous elastica by
// multiple shooting (validation/elastica_push.hpp), which shares no equations and no code with it.

#include "base/units.hpp"
#include "coupling/statics/push_solver.hpp"
#include "tests/slow/referee_draws.hpp"
#include "validation/elastica_push.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace snare::referee {
namespace {

using base::mm;
using std::numbers::pi;

/// A wire of a metal or a plastic: solid, or a rope with a share of the bending stiffness of its solid
/// section.
struct Material {
  const char* name;
  double modulus, density;                    // [Pa], [kg/m^3]
  double least_diameter, most_diameter;       // [m]
  double least_bending_share, bending_share;  // of E pi d^4/64; 1: solid
  double axial_share;                         // of E pi d^2/4
};
const std::vector<Material> materials{{"steel", 193e9, 7930.0, 0.3 * mm, 2.0 * mm, 1.0, 1.0, 1.0},
                                      {"steel rope", 193e9, 7930.0, 0.8 * mm, 3.0 * mm, 0.01, 0.1, 0.5},
                                      {"nitinol", 60e9, 6450.0, 0.3 * mm, 1.5 * mm, 1.0, 1.0, 1.0},
                                      {"nylon", 3e9, 1140.0, 0.3 * mm, 2.5 * mm, 1.0, 1.0, 1.0}};

wire::WireSpecification random_wire(Draws& draw) {
  const Material m = draw.one_of(materials);
  wire::WireSpecification w;
  w.diameter = draw.of_any_size(m.least_diameter, m.most_diameter);
  w.youngs_modulus = m.modulus;
  w.density = m.density;
  if (m.least_bending_share < 1.0) {
    w.construction = wire::Construction::strand;
    const double share = draw.of_any_size(m.least_bending_share, m.bending_share);
    w.bending_stiffness_override = share * m.modulus * pi * std::pow(w.diameter, 4) / 64.0;
    w.axial_stiffness_override = m.axial_share * m.modulus * pi * w.diameter * w.diameter / 4.0;
  }
  return w;
}

/// Height of an inextensible wire that is taut over a point at x.
double taut_height(double span, double length, double x) {
  double low = 0.0, high = length;
  for (int k = 0; k < 60; ++k) {
    const double h = 0.5 * (low + high);
    (std::hypot(x, h) + std::hypot(span - x, h) < length ? low : high) = h;
  }
  return low;
}

/// Travels up to a share of the way on which an inextensible wire becomes taut, or, against the bulge, of its
/// height.
coupling::PushProblem random_push(Draws& draw) {
  coupling::PushProblem p;
  p.wire = random_wire(draw);
  p.mount.span = draw.of_any_size(60.0 * mm, 260.0 * mm);
  p.mount.kind = draw.chance(0.25) ? wire::MountKind::pinned : wire::MountKind::clamped;
  const double slack = draw.of_any_size(0.002, 0.08);
  p.wire.length = p.mount.span * (1.0 + slack);
  if (draw.chance(0.3)) p.wire.natural_curvature = draw.between(-2.0, 2.0) / p.mount.span;
  p.contact_position = p.mount.span * draw.between(0.15, 0.85);
  if (draw.chance(0.6)) p.pusher.radius = p.mount.span * draw.of_any_size(0.005, 0.08);
  if (draw.chance(0.25)) p.pusher.friction = draw.between(0.05, 0.4);
  if (draw.chance(0.2)) p.pusher.direction = coupling::PushDirection::inward;
  const double height = 2.0 / pi * p.mount.span * std::sqrt(slack);
  const double share = p.contact_position / p.mount.span;
  const double natural = p.mount.kind == wire::MountKind::clamped ? height * std::pow(std::sin(pi * share), 2)
                                                                  : height * std::sin(pi * share);
  const double way = p.pusher.direction == coupling::PushDirection::inward
                         ? 0.5 * natural
                         : taut_height(p.mount.span, p.wire.length, p.contact_position) - 0.95 * natural;
  const double top = way * draw.between(0.2, 1.05);
  const int points = draw.count(3, 6);
  for (int i = 1; i <= points; ++i) p.travel.push_back(top * i / points);
  if (draw.chance(0.3))
    p.mount.translational_stiffness = p.wire.axial_stiffness() / p.wire.length * draw.of_any_size(0.1, 100.0);
  if (p.mount.kind == wire::MountKind::clamped && draw.chance(0.4))
    p.mount.rotational_stiffness = p.wire.bending_stiffness() / p.wire.length * draw.of_any_size(0.1, 100.0);
  return p;
}

std::string described(const coupling::PushProblem& p, int elements) {
  std::string text = fmt::format(
      "{} edges, EI {:.9g} N m^2, EA {:.9g} N, d {:.9g} m, length {:.12g} m, span {:.12g} m, natural "
      "curvature {:.9g} 1/m, {} by {:.9g} N/m and {:.9g} N m/rad, at {:.12g} m, pusher radius {:.9g} m, "
      "friction {:.6g}, {}, travels [m]",
      elements, p.wire.bending_stiffness(), p.wire.axial_stiffness(), p.wire.diameter, p.wire.length,
      p.mount.span, p.wire.natural_curvature, p.mount.kind == wire::MountKind::pinned ? "pinned" : "clamped",
      p.mount.translational_stiffness_of(0), p.mount.rotational_stiffness_of(0), p.contact_position,
      p.pusher.radius, p.pusher.friction,
      p.pusher.direction == coupling::PushDirection::inward ? "inward" : "outward");
  for (const double d : p.travel) text += fmt::format(" {:.12g}", d);
  return text;
}

/// The same push of the elastica. Its curvature is positive to the left, against the bulge. friction_slope:
/// see ElasticaPush.
validation::ElasticaPush elastica_of(const coupling::PushProblem& p, double friction_slope, double tension) {
  validation::ElasticaPush e;
  e.wire = {p.wire.length, p.wire.bending_stiffness(), p.wire.axial_stiffness(), -p.wire.natural_curvature};
  e.span = p.mount.span;
  e.ends = p.mount.kind == wire::MountKind::pinned ? validation::ElasticaEnds::pinned
                                                   : validation::ElasticaEnds::clamped;
  e.mount_axial_compliance = 1.0 / p.mount.translational_stiffness_of(0);
  e.mount_rotational_compliance = 1.0 / p.mount.rotational_stiffness_of(0);
  e.side = p.pusher.direction == coupling::PushDirection::inward ? validation::ElasticaSide::against_bulge
                                                                 : validation::ElasticaSide::with_bulge;
  e.position = p.contact_position;
  e.radius = p.pusher.radius > 0.0 ? p.pusher.radius + 0.5 * p.wire.diameter : 0.0;
  e.friction_slope = friction_slope;
  // Pieces of less than five boundary layers.
  const double layer = std::sqrt(e.wire.bending_stiffness / std::max(tension, 1e-9));
  e.pieces_per_side = std::clamp(static_cast<int>(0.2 * e.wire.length / layer), 16, 80);
  return e;
}

/// First travel at which a path of equilibria may have several branches, or the end of the curve.
double end_of_unique_path(const coupling::PushCurve& curve) {
  using Kind = coupling::PushEvent::Kind;
  double end = std::numeric_limits<double>::infinity();
  for (const coupling::PushEvent& e : curve.events) {
    if (e.kind == Kind::fold || e.kind == Kind::bifurcation || e.kind == Kind::snap ||
        e.kind == Kind::lift_off)
      end = std::min(end, e.travel);
  }
  return end;
}

/// The elastica at the travels of the push. The path is followed in shorter steps than those, and ends where
/// the sign of its determinant
/// changes: there it has passed a branch point or a fold, or has jumped to another branch.
std::vector<validation::ElasticaState> reference_path(const validation::ElasticaPush& elastica,
                                                      const std::vector<double>& travel) {
  constexpr int parts = 4;
  std::vector<double> all;
  double from = 0.0;
  for (const double to : travel) {
    for (int k = 1; k < parts; ++k) all.push_back(from + (to - from) * k / parts);
    all.push_back(to);
    from = to;
  }
  std::vector<validation::ElasticaState> states;
  int passed = 0;
  bool positive = true;
  for (const validation::ElasticaState& s : validation::push_path(elastica, all)) {
    if (passed == 0) positive = s.determinant_positive;
    if (!s.report.usable() || (!s.wrapped && s.determinant_positive != positive)) break;
    if (++passed % parts == 0) states.push_back(s);
  }
  return states;
}

/// Results on one mesh.
struct Count {
  int points = 0;
  int beyond = 0;  // the stated error
};

/// What came of all comparisons.
struct Comparison {
  std::map<int, Count> by_edges;
  int without_reference = 0, unfinished = 0;
  std::string unfinished_text;
  double worst = 0.0;      // difference over its limit [-]
  std::string worst_text;  // the problem of it
  std::vector<std::string> failures;
};

/// Below this the two cannot be told apart: share of the largest force on the wire. The elastica errs by 1e-9
/// of the force, Newton's method of the discrete rod ends at 1e-10 of its forces, and a small force is the
/// difference of large tensions.
constexpr double floor_share = 1e-7;

/// The stated error is an estimate from the forces of three meshes (W.11). Where their differences happen to
/// cancel it says too little: how much may then be left, as a share of the largest force, at 256 edges; on
/// coarser meshes more, by the third power of the element.
constexpr double unseen_share = 2e-4;

void compare(const coupling::PushProblem& p, int elements, int index, Comparison& sum) {
  coupling::PushOptions options;
  options.elements = elements;
  const coupling::ExtrapolatedCurve result = coupling::solve_push_extrapolated(p, options);
  const std::string text = fmt::format("problem {}: {}", index, described(p, elements));
  if (!result.curve.report.usable()) {
    ++sum.unfinished;
    sum.unfinished_text += text + ": " + result.curve.report.message + "\n";
  }
  double tension = 0.0;
  for (const coupling::PushPoint& at : result.curve.points) tension = std::max(tension, at.largest_tension);
  const bool rubs = p.pusher.friction > 0.0;
  std::vector<std::vector<validation::ElasticaState>> references;
  for (const double sign : {-1.0, 1.0}) {
    references.push_back(reference_path(elastica_of(p, sign * p.pusher.friction, tension), p.travel));
    if (!rubs) break;
  }
  const double unique = end_of_unique_path(result.curve);
  for (std::size_t i = 0; i < p.travel.size() && p.travel[i] < unique; ++i) {
    const auto found = std::ranges::find(result.curve.points, p.travel[i], &coupling::PushPoint::travel);
    if (found == result.curve.points.end()) break;
    // Friction: the elastica slides, at a point.
    if (rubs && (!found->slipping || found->wrapped_length > 0.0)) continue;
    const double error =
        result.discretisation_error[static_cast<std::size_t>(found - result.curve.points.begin())];
    double force = std::numeric_limits<double>::infinity();
    for (const auto& path : references) {
      if (i >= path.size() || (rubs && path[i].wrapped)) continue;
      if (std::abs(path[i].force - found->force) < std::abs(force - found->force)) force = path[i].force;
    }
    if (!std::isfinite(force) || !std::isfinite(error)) {
      ++sum.without_reference;
      continue;
    }
    const double difference = std::abs(found->force - force);
    const double largest =
        std::max({std::abs(force), std::abs(found->tension_left), std::abs(found->tension_right)});
    const double stated = error + floor_share * largest;
    const double limit = stated + unseen_share * std::pow(256.0 / elements, 3) * largest;
    Count& count = sum.by_edges[elements];
    ++count.points;
    if (difference > stated) ++count.beyond;
    if (difference <= sum.worst * limit) continue;
    sum.worst = difference / limit;
    sum.worst_text =
        fmt::format("{}: at {:.12g} m {:.10g} N, elastica {:.10g} N, stated error {:.3g} N, limit {:.3g} N",
                    text, p.travel[i], found->force, force, error, limit);
    if (difference > limit) sum.failures.push_back(sum.worst_text);
  }
}

TEST(SlowReferees, RandomPushesAgreeWithTheElastica) {
  Comparison sum;
  const Problems problems(800);
  for (int k = problems.first; k < problems.end; ++k) {
    Draws draw(problems.seed, k);
    const coupling::PushProblem p = random_push(draw);
    compare(p, draw.one_of<int>({64, 128, 256, 256}), k, sum);
  }
  for (const std::string& f : sum.failures) ADD_FAILURE() << f;
  int points = 0;
  for (const auto& [edges, count] : sum.by_edges) {
    points += count.points;
    // Measured on 2000 problems: 8 % at 64 edges, 1 % at 128, 2 % at 256.
    const double share = edges == 64 ? 0.15 : 0.05;
    EXPECT_LE(count.beyond, std::max(3.0, share * count.points))
        << "points beyond their stated error, of " << count.points << " with " << edges << " edges";
    RecordProperty(fmt::format("points at {} edges", edges), count.points);
    RecordProperty(fmt::format("beyond the stated error at {} edges", edges), count.beyond);
  }
  // A solver may stop, and says so; rarely.
  EXPECT_LE(sum.unfinished, std::max(1, (problems.end - problems.first) / 200)) << sum.unfinished_text;
  EXPECT_GE(points, 3 * (problems.end - problems.first) / 2);  // of some five a problem
  if (HasFailure()) ADD_FAILURE() << "worst of " << points << " points: " << sum.worst_text;
  RecordProperty("points without a reference", sum.without_reference);
  RecordProperty("worst share of the limit", std::to_string(sum.worst));
}

}  // namespace
}  // namespace snare::referee
