#include "validation/distil_checks.hpp"

#include "coupling/contact/law_form.hpp"
#include "coupling/contact/tensioned_wire.hpp"
#include "coupling/statics/push_solver.hpp"
#include "reduction/snare_joint.hpp"
#include "reduction/table_builder.hpp"
#include "validation/closed_forms.hpp"
#include "validation/declared_wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

namespace snare::validation {

namespace {

constexpr double recorded_range = 4e-3;  // [m], assumed: the papers do not print it

/// A wire as loose as a rope: a fifth of the bending stiffness of the published test's, a twentieth of the
/// axial one.
coupling::PushProblem soft_wire() {
  coupling::PushProblem test = declared_wire(87.5e-3, 6e-3);
  test.wire.bending_stiffness_override = 0.0094;
  test.wire.axial_stiffness_override = 19300.0;
  test.wire.length = 175.49e-3;
  return test;
}

std::vector<Row> table_rows() {
  reduction::WireCase wire;
  wire.test = soft_wire();
  wire.travel = {0.0, recorded_range};
  wire.position = {0.035, 0.0875};
  wire.slack = {0.75 * wire.nominal_slack(), 1.25 * wire.nominal_slack()};
  reduction::DistilSettings settings;
  settings.elements = 128;
  reduction::CurveStore store(wire, settings, reduction::sampling_travel(wire, settings));
  const reduction::BuiltTable built = reduction::build_table(store, settings);
  if (!built.report.usable()) throw std::runtime_error(built.report.message);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  constexpr int places = 200;
  double worst = 0.0;
  for (int i = 0; i < places; ++i) {
    coupling::PushProblem test = wire.test;
    test.contact_position = wire.position.low + (wire.position.high - wire.position.low) * u(random);
    const double slack = wire.slack.low + (wire.slack.high - wire.slack.low) * u(random);
    test.wire.length = test.mount.span + slack;
    test.travel = {wire.travel.high * u(random)};
    coupling::PushOptions options;
    options.elements = 2 * settings.elements;
    const coupling::PushCurve curve = coupling::solve_push_extrapolated(test, options).curve;
    if (curve.points.empty()) throw std::runtime_error(curve.report.message);
    const double table = built.loading->force(test.travel.front(), test.contact_position, slack);
    worst = std::max(worst, std::abs(table - curve.points.back().force));
  }
  const double range = built.loading_error.force_range;
  return {
      {"distilled laws", "table of 20 x 9 x 5 at 200 random places, error over the range of the force", "",
       "full wire, solved anew on a finer mesh", Kind::convergence, 0.0, worst / range,
       Limit::absolute(0.005, "zero reference; the value is a share of the range of the force")},
      {"distilled laws", "the same over the bound that the table states", "",
       "full wire, solved anew on a finer mesh", Kind::convergence, 0.0, worst / built.loading_error.bound,
       Limit::absolute(1.0, "an upper bound; the value is a share of the bound that the table states")}};
}

std::vector<Row> closed_form_rows() {
  std::vector<Row> rows;
  const coupling::LawPlace middle{0.175, 0.0875, 0.180, 0.01};
  Eigen::VectorXd p(2);
  p << 5.55e5 * 0.09, 0.0;
  const auto exact = coupling::stretched_wire_law(middle);
  const auto linear = coupling::stretched_wire_linearised(middle);
  const std::string honda = "Honda et al., eqs 1 and 2, evaluated by hand";
  rows.push_back({"distilled laws", "stretched wire, K_contact", "N/m", honda, Kind::closed_form, 60810.0,
                  linear->stiffness(p, 1e-3), Limit::relative(1e-4)});  // printed to four digits
  rows.push_back({"distilled laws", "stretched wire, exact over linear at 1 mm", "", honda, Kind::closed_form,
                  1.068, exact->force(p, 1e-3) / linear->force(p, 1e-3), Limit::relative(4.6e-4)});
  rows.push_back({"distilled laws", "stretched wire, exact over linear at 10 mm", "", honda,
                  Kind::closed_form, 1.74, exact->force(p, 1e-2) / linear->force(p, 1e-2),
                  Limit::relative(2.8e-3)});
  for (const double s : {0.04, 0.065, 0.09}) {
    rows.push_back({"distilled laws", fmt::format("tensioned clamped wire, 50 N, s = {:g} mm", 1e3 * s),
                    "N/m", "w'''' - m^2 w'' = 0 on both sides, solved by itself", Kind::closed_form,
                    tensioned_clamped_stiffness(0.04796, 50.0, 0.175, s),
                    coupling::tensioned_stiffness(0.04796, 50.0, 0.175, s).value, Limit::relative(1e-9)});
  }
  return rows;
}

std::vector<Row> snare_rows() {
  std::vector<Row> rows;
  const std::string group = "shaft in a closed snare";
  const std::string paper = "Nakanishi et al., ground test: what is stated";
  const coupling::SnareSpecification snare = half_scale_snare();
  const auto stiffness = [&](const Eigen::Vector3d& u) {
    const coupling::ShaftPath path = coupling::move_shaft(snare, {u});
    if (!path.report.usable()) throw std::runtime_error(path.report.message);
    return path.points.back().force.dot(u) / u.squaredNorm();
  };
  const double x = stiffness({1e-5, 0.0, 0.0});
  rows.push_back({group, "stiffness in y over that in x", "", "three wires at 120 degrees", Kind::closed_form,
                  1.0, stiffness({0.0, 1e-5, 0.0}) / x, Limit::relative(0.01)});
  for (const int axis : {0, 1, 2}) {
    const char* name = axis == 0 ? "x" : axis == 1 ? "y" : "z";
    const reduction::JointCycle cycle = reduction::cycle_snare(snare, axis, axis == 2 ? 0.010 : 0.003, 120);
    if (!cycle.report.usable()) throw std::runtime_error(cycle.report.message);
    // The slip between two points counts as one straight step.
    rows.push_back({group, fmt::format("{}: dissipation over the loop's area", name), "",
                    "energy balance of a closed cycle", Kind::closed_form, 1.0, cycle.dissipated / cycle.loop,
                    Limit::relative(0.005)});
    const double width = cycle.half_width / cycle.force_range;
    if (axis < 2) {
      rows.push_back({group, fmt::format("{}: R^2 of a straight line, linear", name), "", paper,
                      Kind::published_measurement, 1.0, cycle.linear_r2, Limit::relative(0.05)});
      rows.push_back(
          {group, fmt::format("{}: half width of the loop over the force, slight hysteresis", name), "",
           paper, Kind::published_measurement, 0.0, width,
           Limit::absolute(0.1, "an upper bound for \"slight\"; the value is a share of the force")});
    } else {
      rows.push_back(
          {group, "z: R^2 of a straight line, not linear", "", paper, Kind::published_measurement, 0.0,
           cycle.linear_r2,
           Limit::absolute(0.8, "an upper bound for \"not linear\"; R^2 is a share of the variance")});
      rows.push_back({group, "z: half width of the loop over the force, clear hysteresis", "", paper,
                      Kind::published_measurement, 0.5, width, Limit::relative(0.2)});
      rows.push_back(
          {group, "z: rms error of constant friction over the force", "", paper, Kind::published_measurement,
           0.0, cycle.rms_error / cycle.force_range,
           Limit::absolute(0.05,
                           "an upper bound for \"constant friction\"; the value is a share of the force")});
    }
  }
  return rows;
}

}  // namespace

coupling::SnareSpecification half_scale_snare() {
  coupling::SnareSpecification snare;
  snare.wire = soft_wire();
  snare.wire.wire.diameter *= 0.5;
  snare.wire.wire.length *= 0.5;
  snare.wire.mount.span *= 0.5;
  snare.wire.pusher.radius *= 0.5;
  *snare.wire.wire.bending_stiffness_override /= 16.0;
  *snare.wire.wire.axial_stiffness_override /= 4.0;
  snare.wire.pusher.friction = 0.1;  // Honda et al., Table 3, dynamic
  snare.seat = 5e-3;                 // beyond the 3 mm by which the shaft is moved
  return snare;
}

std::vector<Check> distil_checks() {
  return {{"table at random places", table_rows},
          {"closed forms of stretched and tensioned wires", closed_form_rows},
          {"shaft in a closed snare", snare_rows}};
}

}  // namespace snare::validation
