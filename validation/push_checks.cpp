#include "validation/push_checks.hpp"

#include "base/units.hpp"
#include "coupling/statics/push_solver.hpp"
#include "validation/blind_push.hpp"
#include "validation/closed_forms.hpp"
#include "validation/declared_wire.hpp"
#include "validation/elastica.hpp"
#include "validation/elastica_push.hpp"
#include "validation/shallow_elastica.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::validation {

namespace {

using base::mm;
using coupling::PushProblem;
using std::numbers::pi;

const char* const multiple_shooting = "planar extensible elastica, multiple shooting";
const char* const by_collocation = "planar extensible elastica, collocation";

/// The same with the axial stiffness raised a thousandfold: inextensible to 1e-6 of a strain.
PushProblem stiffened(PushProblem test) {
  test.wire.axial_stiffness_override = 1e3 * test.wire.axial_stiffness();
  return test;
}

ElasticaPush elastica_of(const PushProblem& test) {
  ElasticaPush e;
  e.wire = {test.wire.length, test.wire.bending_stiffness(), test.wire.axial_stiffness(), 0.0};
  e.span = test.mount.span;
  e.position = test.contact_position;
  e.radius = test.pusher.radius > 0.0 ? test.pusher.radius + 0.5 * test.wire.diameter : 0.0;
  return e;
}

coupling::PushOptions fine(int elements = 256) {
  coupling::PushOptions options;
  options.elements = elements;
  return options;
}

double force_at(PushProblem test, double travel, int elements = 256) {
  test.travel = {travel};
  const coupling::ExtrapolatedCurve result = coupling::solve_push_extrapolated(test, fine(elements));
  return result.curve.points.empty() ? not_computed : result.curve.points.back().force;
}

/// A state in the units of the shallow limit.
struct Normalised {
  double force;       // F l^2 / (EI sqrt(delta))
  double deflection;  // y / (l sqrt(delta))
};

/// delta is the end shortening of the wire's stretched length, so that the little it stretches does not
/// count.
Normalised normalise(const PushProblem& test, const coupling::PushPoint& p, double height) {
  const double l = test.mount.span;
  const double tension = 0.5 * (p.tension_left + p.tension_right);
  const double stretched = test.wire.length * (1.0 + tension / test.wire.axial_stiffness());
  const double root = std::sqrt(stretched / l - 1.0);
  return {p.force * l * l / (test.wire.bending_stiffness() * root), height / (l * root)};
}

/// A shallow wire whose strain stays below a hundredth of its slack up to compressions or tensions of
/// `largest` EI/l^2: stiffer, round-off would show.
PushProblem shallow_test(double position, double slack, double largest) {
  PushProblem test = declared_wire(position, 0.0);
  const double l = test.mount.span;
  test.wire.length = l * (1.0 + slack);
  test.wire.axial_stiffness_override = 100.0 * largest * test.wire.bending_stiffness() / (l * l) / slack;
  return test;
}

/// Normalised force at a normalised deflection of the shallow wire, by bisection in travel.
double shallow_force(double position, double slack, double deflection, double largest) {
  PushProblem test = shallow_test(position * 175.0 * mm, slack, largest);
  const double root = std::sqrt(slack) * test.mount.span;
  const double natural = (1.0 - std::cos(2.0 * pi * position)) / pi;
  double low = 0.0;
  double high = 1.02 * (std::sqrt(2.0 * position * (1.0 - position)) - natural) * root;
  Normalised at{};
  for (int k = 0; k < 40; ++k) {
    const double travel = 0.5 * (low + high);
    test.travel = {0.5 * travel, travel};
    const coupling::ExtrapolatedCurve result = coupling::solve_push_extrapolated(test, fine());
    if (result.curve.points.size() < 2) return not_computed;
    at = normalise(test, result.curve.points.back(), result.curve.touch_height + travel);
    (at.deflection < deflection ? low : high) = travel;
  }
  return at.force;
}

std::vector<Row> buckled_shape_rows() {
  const char* group = "Buckled shape before the push";
  PushProblem test = stiffened(declared_wire(87.5 * mm, 0.0));
  test.travel = {0.0};
  const coupling::ExtrapolatedCurve stiff = coupling::solve_push_extrapolated(test, fine());
  const BuckledElastica reference =
      clamped_elastica(test.wire.bending_stiffness(), test.wire.length, test.mount.span);
  test = declared_wire(87.5 * mm, 0.0);
  test.travel = {0.0};
  const coupling::ExtrapolatedCurve declared = coupling::solve_push_extrapolated(test, fine());
  const char* integrals = "inextensible elastica, elliptic integrals (Love 1927)";
  ElasticaPush elastica = elastica_of(test);
  const ElasticaState unloaded = push(elastica, 0.0);
  return {{group, "compression, inextensible wire", "N", integrals, Kind::closed_form, reference.compression,
           -stiff.curve.points.front().tension_left, Limit::relative(1e-5)},
          {group, "height of the bulge, inextensible wire", "mm", integrals, Kind::closed_form,
           reference.height / mm, stiff.curve.natural_height / mm, Limit::relative(1e-5)},
          {group, "height of the bulge, declared wire", "mm", multiple_shooting, Kind::independent_code,
           unloaded.pusher_height / mm, declared.curve.natural_height / mm, Limit::relative(1e-6)},
          {group, "tension at the mount, declared wire", "N", multiple_shooting, Kind::independent_code,
           unloaded.tension_left, declared.curve.points.front().tension_left, Limit::relative(1e-5)}};
}

std::vector<Row> material_point_rows() {
  const char* group = "Material mid-point pushed outward by 1.5 mm";
  ElasticaPush elastica = elastica_of(declared_wire(87.5 * mm, 0.0));
  elastica.contact = ElasticaContact::material_point;
  elastica.material_coordinate = 90.0 * mm;
  const double reference = push(elastica, 1.5 * mm).force;
  return {{group, "force, default mesh", "N", multiple_shooting, Kind::independent_code, reference,
           force_at(declared_wire(87.5 * mm, 0.0), 1.5 * mm), Limit::relative(5e-6)},
          {group, "force, 128 edges", "N", multiple_shooting, Kind::independent_code, reference,
           force_at(declared_wire(87.5 * mm, 0.0), 1.5 * mm, 128), Limit::relative(1e-4)},
          {group, "force, six digits of another computation", "N", "232.983 N, computed apart from this code",
           Kind::independent_code, 232.983, force_at(declared_wire(87.5 * mm, 0.0), 1.5 * mm),
           Limit::relative(5e-6)}};
}

std::vector<Row> elastica_rows() {
  const char* group = "Declared wire, frictionless push";
  std::vector<Row> rows;
  for (const double radius : {0.0, 6.0}) {
    for (const double position : {40.0, 65.0, 90.0}) {
      PushProblem test = declared_wire(position * mm, radius * mm);
      test.travel = {0.2 * mm, 1.0 * mm, 2.0 * mm, 3.0 * mm, 4.0 * mm};
      const coupling::ExtrapolatedCurve result = coupling::solve_push_extrapolated(test, fine());
      const std::vector<ElasticaState> reference = push_path(elastica_of(test), test.travel);
      for (std::size_t i = 0; i < test.travel.size(); ++i) {
        if (i >= reference.size() || !reference[i].report.usable()) break;
        const double value = i < result.curve.points.size() ? result.curve.points[i].force : not_computed;
        rows.push_back({group,
                        fmt::format("force, {} at {:g} mm, travel {:g} mm",
                                    radius > 0.0 ? "cylinder" : "knife edge", position, test.travel[i] / mm),
                        "N", multiple_shooting, Kind::independent_code, reference[i].force, value,
                        Limit::relative(1e-4)});
      }
    }
  }
  return rows;
}

/// The declared wire between mounts that give as the published fits ask for, as far as they may reach.
std::vector<Row> giving_mount_rows() {
  const char* group = "Declared wire, mounts that give";
  constexpr double axial = 1.8e-5, rotational = 1.6;  // compliances [m/N], [rad/(N m)]
  std::vector<Row> rows;
  for (const double radius : {0.0, 6.0}) {
    for (const double position : {40.0, 65.0, 90.0}) {
      PushProblem test = declared_wire(position * mm, radius * mm);
      test.mount.translational_stiffness = 1.0 / axial;
      test.mount.rotational_stiffness = 1.0 / rotational;
      test.travel = {2.0 * mm, 6.0 * mm, 10.0 * mm, 14.0 * mm};
      const coupling::ExtrapolatedCurve result = coupling::solve_push_extrapolated(test, fine());
      ElasticaPush elastica = elastica_of(test);
      elastica.mount_axial_compliance = axial;
      elastica.mount_rotational_compliance = rotational;
      const std::vector<ElasticaState> shot = push_path(elastica, test.travel);
      BlindWire wire;
      wire.length = elastica.wire.length;
      wire.span = elastica.span;
      wire.bending_stiffness = elastica.wire.bending_stiffness;
      wire.axial_stiffness = elastica.wire.axial_stiffness;
      wire.position = elastica.position;
      wire.radius = elastica.radius;
      wire.mount_axial_compliance = axial;
      wire.mount_rotational_compliance = rotational;
      const std::vector<BlindReading> collocated = blind_push(wire, test.travel);
      for (std::size_t i = 0; i < test.travel.size(); ++i) {
        const double value = i < result.curve.points.size() ? result.curve.points[i].force : not_computed;
        const std::string place =
            fmt::format("force, {} at {:g} mm, travel {:g} mm", radius > 0.0 ? "cylinder" : "knife edge",
                        position, test.travel[i] / mm);
        const bool reached = i < shot.size() && shot[i].report.usable();
        rows.push_back({group, place, "N", multiple_shooting, Kind::independent_code,
                        reached ? shot[i].force : not_computed, value, Limit::relative(1e-4)});
        rows.push_back({group, place, "N", by_collocation, Kind::independent_code, collocated[i].force, value,
                        Limit::relative(1e-4)});
      }
    }
  }
  return rows;
}

std::vector<Row> wrapped_rows() {
  const char* group = "Soft wire (EI 5e-4 N m2, EA 114 kN) that wraps the pusher";
  std::vector<Row> rows;
  for (const double position : {87.5, 65.0}) {
    PushProblem test = declared_wire(position * mm, 6.0 * mm);
    test.wire.bending_stiffness_override = 5e-4;
    test.wire.axial_stiffness_override = 114e3;
    for (int i = 1; i <= 6; ++i) test.travel.push_back(i * mm);
    ElasticaPush elastica = elastica_of(test);
    elastica.pieces_per_side = 40;
    const std::vector<ElasticaState> reference = push_path(elastica, test.travel);
    const coupling::ExtrapolatedCurve result = coupling::solve_push_extrapolated(test, fine());
    for (const std::size_t i : {std::size_t{2}, std::size_t{3}, std::size_t{5}}) {
      if (i >= reference.size() || !reference[i].report.usable()) break;
      const double value = i < result.curve.points.size() ? result.curve.points[i].force : not_computed;
      rows.push_back({group,
                      fmt::format("force at {:g} mm, travel {:g} mm, {}", position, test.travel[i] / mm,
                                  reference[i].wrapped ? "wrapped" : "at a point"),
                      "N", multiple_shooting, Kind::independent_code, reference[i].force, value,
                      Limit::relative(2e-4)});
    }
  }
  return rows;
}

std::vector<Row> shallow_outward_rows() {
  struct Entry {
    double position, force, deflection;
  };
  // (f, a) of the inextensible shallow wire, P = 20, 0, -100, -1000.
  constexpr Entry table[] = {{0.5, 61.181, 0.641347},  {0.5, 123.936, 0.645497}, {0.5, 435.748, 0.659454},
                             {0.5, 3142.19, 0.686182}, {0.4, 67.100, 0.605935},  {0.4, 134.479, 0.619677},
                             {0.4, 459.565, 0.643166}, {0.4, 3231.43, 0.671176}};
  std::vector<Row> rows;
  for (const Entry& e : table) {
    // The printed deflection has six digits: use the closed form's own for the printed force.
    const ShallowState state = shallow_state_at(e.deflection, e.position);
    const double largest = std::max(40.0, std::abs(state.compression));
    const double one = shallow_force(e.position, 1e-4, e.deflection, largest);
    const double two = shallow_force(e.position, 2e-4, e.deflection, largest);
    const std::string name = fmt::format("f at a = {:g}, s = {:g}", e.deflection, e.position);
    rows.push_back({"Shallow limit, pushed outward", name + ", slack to 0", "", "closed form",
                    Kind::closed_form, state.force, 2.0 * one - two, Limit::relative(2e-4)});
  }
  return rows;
}

std::vector<Row> shallow_inward_rows() {
  const char* group = "Shallow limit, pushed inward";
  std::vector<Row> rows;
  struct Entry {
    double position, largest;
  };
  constexpr double slack = 1e-4;
  for (const Entry& e : {Entry{0.5, 129.530}, Entry{0.45, 85.977}, Entry{0.4, 75.573}}) {
    PushProblem test = shallow_test(e.position * 175.0 * mm, slack, 100.0);
    test.pusher.direction = coupling::PushDirection::inward;
    const double root = std::sqrt(slack) * test.mount.span;
    // The largest force lies within the first third of the way; at mid-span it is where the path branches.
    const int points = 200;
    for (int i = 1; i <= points; ++i) test.travel.push_back(0.3 * root * i / points);
    coupling::PushOptions options = fine();
    options.instability =
        e.position == 0.5 ? coupling::Instability::follow_path : coupling::Instability::switch_branch;
    const coupling::ExtrapolatedCurve result = coupling::solve_push_extrapolated(test, options);
    const std::vector<coupling::PushPoint>& points_reached = result.curve.points;
    if (points_reached.size() < 3) continue;
    if (e.position == 0.5) {
      double travel = 0.0;
      for (const coupling::PushEvent& event : result.curve.events) {
        if (event.kind == coupling::PushEvent::Kind::bifurcation) {
          travel = event.travel;
          break;
        }
      }
      test.travel = {0.5 * travel, travel};
      const coupling::ExtrapolatedCurve at = coupling::solve_push_extrapolated(test, options);
      const Normalised n = normalise(test, at.curve.points.back(), at.curve.touch_height - travel);
      rows.push_back({group, "a where the symmetric path branches, s = 0.5", "", "closed form",
                      Kind::closed_form, 0.62351, n.deflection, Limit::relative(3e-4)});
      rows.push_back({group, "largest f under load control, s = 0.5", "", "closed form", Kind::closed_form,
                      e.largest, n.force, Limit::relative(3e-3)});
      continue;
    }
    // Vertex of the parabola through the three highest points.
    std::size_t top = 1;
    for (std::size_t i = 1; i + 1 < points_reached.size(); ++i) {
      if (points_reached[i].force > points_reached[top].force) top = i;
    }
    coupling::PushPoint highest = points_reached[top];
    const double before = points_reached[top - 1].force;
    const double after = points_reached[top + 1].force;
    const double curvature = before - 2.0 * highest.force + after;
    highest.force -= 0.125 * (after - before) * (after - before) / curvature;
    const Normalised n = normalise(test, highest, 0.0);
    rows.push_back({group, fmt::format("largest f under load control, s = {:g}", e.position), "",
                    "closed form", Kind::closed_form, e.largest, n.force, Limit::relative(3e-3)});
  }
  return rows;
}

std::vector<Row> taut_rows() {
  const char* group = "Taut and tensioned wires";
  std::vector<Row> rows;
  const double position[] = {40.0, 65.0, 90.0};
  const double digest[] = {7407.2, 3638.9, 3083.8};
  for (int k = 0; k < 3; ++k) {
    PushProblem test = declared_wire(position[k] * mm, 0.0);
    test.wire.length = test.mount.span / (1.0 + 50.0 / test.wire.axial_stiffness());
    const double travel = 1e-4 * mm;
    rows.push_back({group, fmt::format("stiffness at {:g} mm under 50 N, clamped", position[k]), "N/m",
                    "w'''' - (T/EI) w'' = 0, closed form", Kind::closed_form, digest[k],
                    force_at(test, travel) / travel, Limit::relative(1e-4)});
  }
  PushProblem test = declared_wire(65.0 * mm, 0.0);
  test.wire.length = test.mount.span;
  test.wire.bending_stiffness_override = 1e-9;
  const double travel = 1.0 * mm;
  rows.push_back(
      {group, "force on a straight unstretched string at 65 mm", "N", "EA d^3/(2 l) (1/s + 1/(l - s))",
       Kind::closed_form,
       unstretched_wire_force(test.wire.axial_stiffness(), test.mount.span, test.contact_position, travel),
       force_at(test, travel, 512), Limit::relative(2e-3)});
  return rows;
}

std::vector<Row> friction_rows() {
  const char* group = "Coulomb friction on the pusher";
  PushProblem test = declared_wire(40.0 * mm, 6.0 * mm);
  test.pusher.friction = 0.2;
  constexpr int points = 400;
  for (int i = 0; i <= points; ++i) test.travel.push_back(2.0 * mm * i / points);
  for (int i = points - 1; i >= 0; --i) test.travel.push_back(2.0 * mm * i / points);
  const coupling::PushCurve loop = coupling::solve_push(test, fine());
  double area = 0.0;
  for (std::size_t i = 1; i < loop.points.size(); ++i) {
    const coupling::PushPoint& a = loop.points[i - 1];
    const coupling::PushPoint& b = loop.points[i];
    area += 0.5 * (a.force + b.force) * (b.travel - a.travel);
  }
  ElasticaPush elastica = elastica_of(test);
  elastica.friction_slope = -0.2;
  test.travel = {1.0 * mm, 2.0 * mm};
  const coupling::ExtrapolatedCurve pushed = coupling::solve_push_extrapolated(test, fine());
  double reference = 0.0;
  double best = 1e300;
  for (const double slope : {-0.2, 0.2}) {
    elastica.friction_slope = slope;
    const ElasticaState state = push(elastica, 2.0 * mm);
    if (!state.report.usable()) continue;
    if (std::abs(state.force - pushed.curve.points.back().force) < best) {
      best = std::abs(state.force - pushed.curve.points.back().force);
      reference = state.force;
    }
  }
  return {{group, "force while sliding, cylinder at 40 mm, mu 0.2, 2 mm", "N", multiple_shooting,
           Kind::independent_code, reference, pushed.curve.points.back().force, Limit::relative(1e-4)},
          {group, "dissipated energy beside the area of the loop", "mJ", "area of the computed loop",
           Kind::closed_form, 1e3 * area, 1e3 * loop.points.back().dissipated, Limit::relative(1e-2)},
          {group, "force at the end of the closed loop", "N", "no force at first touch", Kind::closed_form,
           0.0, loop.points.back().force,
           Limit::absolute(1e-6, "zero reference; the loop's largest force is that of sliding at 2 mm")}};
}

std::vector<Row> support_rows() {
  const char* group = "Three-point bending on two supports";
  PushProblem test = declared_wire(20.0 * mm, 0.0);
  test.mount.kind = wire::MountKind::supports;
  test.mount.span = 40.0 * mm;
  test.wire.length = 60.0 * mm;
  const double travel = 1e-3 * mm;
  return {{group, "stiffness of a small push at mid-span", "N/m", "48 EI/l^3", Kind::closed_form,
           three_point_stiffness(test.wire.bending_stiffness(), test.mount.span, test.contact_position),
           force_at(test, travel) / travel, Limit::relative(1e-4)}};
}

}  // namespace

std::vector<Check> static_wire_checks() {
  return {{"buckled shape", buckled_shape_rows},
          {"material mid-point", material_point_rows},
          {"push on the declared wire", elastica_rows},
          {"push between mounts that give", giving_mount_rows},
          {"push on a soft wire that wraps the pusher", wrapped_rows},
          {"shallow limit, outward", shallow_outward_rows},
          {"shallow limit, inward", shallow_inward_rows},
          {"taut and tensioned wires", taut_rows},
          {"friction on the pusher", friction_rows},
          {"three-point bending", support_rows}};
}

}  // namespace snare::validation
