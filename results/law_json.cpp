#include "results/law_json.hpp"

#include "reduction/export_text.hpp"
#include "reduction/law_simulators.hpp"
#include "results/in_mm.hpp"
#include "results/version.hpp"
#include "results/warnings.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace snare::results {

namespace {

using nlohmann::json;
using namespace reduction;

constexpr double map_share = 0.05;  // of the full force

json interval_in_mm(const Interval& range) {
  return json::array({in_mm(range.low), in_mm(range.high)});
}

json error_json(const LawError& e) {
  return {{"largest_force_N", e.largest_force},
          {"rms_force_N", e.rms_force},
          {"largest_stiffness_N_m", e.largest_stiffness},
          {"rms_stiffness_N_m", e.rms_stiffness},
          {"largest_energy_J", e.largest_energy},
          {"rms_energy_J", e.rms_energy},
          {"force_range_N", e.force_range},
          {"stiffness_range_N_m", e.stiffness_range},
          {"energy_range_J", e.energy_range},
          {"points", e.points}};
}

json law_entry(const FittedLaw& law) {
  json parameters = json::object();
  const std::vector<coupling::LawParameter> names = law.form->parameters();
  json covariance = json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    parameters[names[i].name] = {{"value", law.values[k]},
                                 {"unit", names[i].unit},
                                 {"stderr", std::sqrt(std::max(0.0, law.covariance(k, k)))}};
    json row = json::array();
    for (std::size_t j = 0; j < names.size(); ++j)
      row.push_back(law.covariance(k, static_cast<Eigen::Index>(j)));
    covariance.push_back(row);
  }
  return {
      {"name", law.form->name()},      {"formula", law.form->formula()},         {"parameters", parameters},
      {"covariance", covariance},      {"travel_mm", interval_in_mm(law.range)}, {"converged", law.converged},
      {"error", error_json(law.error)}};
}

json place_json(const DistilledPlace& place) {
  json laws = json::array();
  for (const FittedLaw& law : place.laws) laws.push_back(law_entry(law));
  json result{{"position_mm", in_mm(place.position)},
              {"laws", laws},
              {"spring_dashpot",
               {{"travel_mm", in_mm(place.stiffness.travel)},
                {"secant_stiffness_N_m", place.stiffness.secant},
                {"tangent_stiffness_N_m", place.stiffness.tangent}}}};
  if (place.recorded) {
    result["recorded"] = {{"displacement_offset_mm", in_mm(place.recorded->offset)},
                          {"quadratic", law_entry(place.recorded->quadratic)},
                          {"displacement_mm", in_mm(place.recorded->stiffness.travel)},
                          {"secant_stiffness_N_m", place.recorded->stiffness.secant}};
  }
  if (place.dissipation) {
    const Dissipation& d = *place.dissipation;
    result["damping"] = {{"source", "loop of friction and strands over the whole travel, at any rate alike"},
                         {"loop_J", d.loop},
                         {"absorbed_J", d.absorbed},
                         {"loss_factor", d.loss_factor},
                         {"damping_times_rate_N_m", d.damping_times_rate}};
    const LoadUnloadFit& f = *place.load_unload;
    result["load_unload"] = {{"formula", "F = L(d) ((1 + r)/2 + z (1 - r)/2), dz = 2 dd/lambda, |z| <= 1"},
                             {"returned", f.law.returned()},
                             {"turn_mm", in_mm(f.law.turn())},
                             {"largest_error_N", f.largest_error},
                             {"rms_error_N", f.rms_error},
                             {"loop_J", f.loop}};
  } else {
    result["damping"] = {{"source", "nothing dissipates in this wire at rest"},
                         {"damping_times_rate_N_m", 0.0}};
  }
  json impacts = json::array();
  for (const ImpactDamping& i : place.impacts) {
    impacts.push_back({{"speed_m_s", i.speed},
                       {"restitution", i.restitution},
                       {"integrator_loss", i.integrator_loss},
                       {"peak_force_N", i.peak_force},
                       {"largest_travel_mm", in_mm(i.largest_travel)},
                       {"duration_s", i.duration},
                       {"damping_Ns_m", i.damping ? json(*i.damping) : json()},
                       {"law_peak_force_N", i.damping ? json(i.law_peak_force) : json()}});
  }
  if (!impacts.empty()) result["impacts"] = impacts;
  return result;
}

json table_error_json(const TableError& e) {
  return {{"bound_N", e.bound},
          {"bound_share", e.force_range > 0.0 ? e.bound / e.force_range : 0.0},
          {"largest_N", e.largest},
          {"rms_N", e.rms},
          {"largest_stiffness_N_m", e.largest_stiffness},
          {"rms_stiffness_N_m", e.rms_stiffness},
          {"largest_energy_J", e.largest_energy},
          {"discretisation_N", e.discretisation},
          {"force_range_N", e.force_range},
          {"points", e.points},
          {"worst",
           {{"travel_mm", in_mm(e.worst_travel)},
            {"position_mm", in_mm(e.worst.position)},
            {"slack_mm", in_mm(e.worst.slack)}}}};
}

json table_json(const BuiltTable& built) {
  const coupling::ForceTable& t = *built.loading;
  json result{
      {"interpolation",
       "tricubic Hermite, C1, F L^2/EI over d/L, s/L, slack/L; nodes hold the value and its derivatives "
       "d, s, ds, e, de, se, dse, travel fastest, then position, then slack"},
      {"travel", t.axes()[0]},
      {"position", t.axes()[1]},
      {"slack", t.axes()[2]},
      {"span_m", t.span()},
      {"force_scale_N", t.force_scale()},
      {"mirrored", t.mirrored()},
      {"nodes", t.nodes()},
      {"monotone", t.proven_monotone()           ? "proven"
                   : t.least_stiffness(4) >= 0.0 ? "sampled"
                                                 : "no"},
      {"error", table_error_json(built.loading_error)},
      {"refinements", built.rounds},
      {"curves", built.curves}};
  if (built.unloading) {
    result["unloading"] = {{"nodes", built.unloading->nodes()},
                           {"error", table_error_json(built.unloading_error)}};
  }
  return result;
}

json map_json(const LawMap& map) {
  json rows = json::array();
  for (const LawMapRow& row : map.rows) {
    json entry{{"slack_mm", in_mm(row.slack)}};
    const auto add = [&](const char* name, const std::vector<double> LawMapRow::*law) {
      const auto range = map.within(row, law, map_share);
      entry[name] = range ? interval_in_mm(*range) : json();
    };
    add("stretched_wire_mm", &LawMapRow::stretched);
    add("tensioned_wire_mm", &LawMapRow::tensioned);
    rows.push_back(entry);
  }
  return {{"position_mm", in_mm(map.position)},
          {"to_mm", in_mm(map.travel.back())},
          {"within", map_share},
          {"rows", rows}};
}

/// The three forms for MuJoCo, one entry a law position.
json mujoco_json(const DistilledCase& one) {
  json linear = json::array(), loops = json::array();
  for (const MujocoLaw& law : mujoco_laws(one)) {
    linear.push_back(law.linear_error);
    loops.push_back(
        law.loop ? json{{"loop_J", law.loop->energy}, {"largest_error_N", law.loop->largest_error}} : json());
  }
  return {{"form", "the table's curve at the position"},
          {"against", "full wire"},
          {"largest_error_N", mujoco_errors(one)},
          {"linear_largest_error_N", linear},
          {"loop", loops}};
}

/// How far each export is off, and where it is not a continuation.
json exports_json(const DistilledCase& one) {
  const coupling::ForceTable& table = *one.table.loading;
  json positions = json::array();
  for (const Interval& part : covered_positions(table)) positions.push_back(interval_in_mm(part));
  const json range{{"travel_mm", json::array({0.0, in_mm(table.axes()[0].back() * table.span())})},
                   {"position_mm", positions}};
  json result = json::object();
  for (const char* language : {"c", "cpp", "modelica", "python"}) {
    result[language] = {
        {"form", "the table itself"},
        {"against", "full wire"},
        {"largest_error_N", std::max(one.table.loading_error.bound, one.table.unloading_error.bound)}};
  }
  result["mujoco"] = mujoco_json(one);
  result["simulink"] = {{"form", "linear in travel and position"},
                        {"against", "table"},
                        {"largest_error_N", lookup_table(one).largest_error},
                        {"range", range}};
  const AdamsSplines adams = adams_splines(one, "");
  result["adams"] = {{"form", "cubic (AKISPL) or linear in the travel, linear in the position"},
                     {"against", "table"},
                     {"largest_error_N", adams.surface_error},
                     {"curves_largest_error_N", adams.place_errors},
                     {"range", range}};
  return result;
}

/// A stiffness of the left and the right mount over that of the wire [-]; null of a rigid one.
json mounts_over_wire(double left, double right, double wire) {
  return {finite(left / wire), finite(right / wire)};
}

json groups_json(const DistilledCase& one) {
  const wire::MountSpecification& m = one.wire.test.mount;
  const wire::WireSpecification& w = one.wire.test.wire;
  return {{"EA_L2_over_EI", one.groups.axial},
          {"R_over_L", one.groups.radius},
          {"friction", one.groups.friction},
          {"mounts", m.kind == wire::MountKind::clamped  ? "clamped"
                     : m.kind == wire::MountKind::pinned ? "pinned"
                                                         : "supports"},
          {"mount_translation_L_over_EA",
           mounts_over_wire(m.translational_stiffness_of(0), m.translational_stiffness_of(1),
                            w.axial_stiffness() / m.span)},
          {"mount_rotation_L_over_EI",
           mounts_over_wire(m.rotational_stiffness_of(0), m.rotational_stiffness_of(1),
                            w.bending_stiffness() / m.span)}};
}

json case_json(const DistilledCase& one) {
  json places = json::array();
  for (const DistilledPlace& place : one.places) places.push_back(place_json(place));
  const wire::WireSpecification& w = one.wire.test.wire;
  return {{"groups", groups_json(one)},
          {"wire",
           {{"bending_stiffness_Nm2", w.bending_stiffness()},
            {"axial_stiffness_N", w.axial_stiffness()},
            {"length_mm", in_mm(w.length)},
            {"span_mm", in_mm(one.wire.test.mount.span)},
            {"radius_mm", in_mm(one.wire.test.pusher.radius)},
            {"friction", one.wire.test.pusher.friction}}},
          {"ranges",
           {{"travel_mm", interval_in_mm(one.wire.travel)},
            {"position_mm", interval_in_mm(one.wire.position)},
            {"slack_mm", interval_in_mm(one.wire.slack)}}},
          {"table", table_json(one.table)},
          {"positions", places},
          {"map", map_json(one.map)},
          {"exports", exports_json(one)}};
}

}  // namespace

json law_json(const WireFile& file, const Distillation& distillation) {
  json result{{"schema", "snare-law/1"},
              {"version", version()},
              {"title", file.title},
              {"source", file.source},
              {"outside_the_range", "continued linearly and flagged, or refused, as the caller chooses"},
              {"cases", json::array()}};
  for (const DistilledCase& one : distillation.cases) result["cases"].push_back(case_json(one));
  result["warnings"] = wire_warnings(file);
  return result;
}

}  // namespace snare::results
