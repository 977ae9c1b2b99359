#include "results/motion_summary.hpp"
#include "results/in_mm.hpp"

#include "base/index.hpp"
#include "coupling/dynamics/model/modes.hpp"
#include "results/finite_json.hpp"
#include "results/version.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace snare::results {

using nlohmann::json;

namespace {

using base::at;
using coupling::MotionEvent;
using coupling::MotionResult;
using coupling::MotionSample;
using multibody::RigidBodyState;

json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

json vector_in_mm(const Eigen::Vector3d& v) {
  return {in_mm(v.x()), in_mm(v.y()), in_mm(v.z())};
}

json time_json(const std::optional<double>& time) {
  return time ? json(*time) : json();
}

/// Ending, energies, errors of the balances, drifts and cost of a motion.
json result_json(const MotionResult& r) {
  const numerics::IdaStatistics& n = r.statistics;
  json object{{"finished", r.report.usable()},
              {"message", r.report.usable() ? json() : json(r.report.message)},
              {"steps", n.steps},
              {"residuals", n.residuals},
              {"jacobians", n.jacobians},
              {"factorizations", n.factorizations},
              {"analyses", n.analyses},
              {"restarts", n.restarts},
              {"time_s", r.report.time},
              {"momentum_error_Ns", vector_json(r.momentum_error)},
              {"angular_momentum_error_Nms", vector_json(r.angular_momentum_error)},
              {"largest_penetration_m", r.largest_penetration},
              {"largest_drift", r.largest_drift},
              {"wall_s", r.wall_seconds},
              {"real_time_factor", real_time_factor(r)}};
  for (const auto& [name, energy] : energies) object["energy_J"][name] = r.energy.*energy;
  object["energy_J"]["dissipation_correction"] = r.energy.corrected;
  return object;
}

/// What wires with a declared strength had to bear at most; none where none has.
json strength_json(const FinishedMotion& run) {
  json list = json::array();
  const std::vector<coupling::WireFacts> wires = run.asked.motion.wire_facts();
  for (std::size_t k = 0; k < run.result.strength.size(); ++k) {
    const coupling::WireFacts& wire = wires[k];
    const coupling::StrengthUse& use = run.result.strength[k];
    if (!std::isfinite(wire.strength.breaking_tension)) continue;
    list.push_back({{"wire", wire.name},
                    {"strength_N", wire.strength.breaking_tension},
                    {"largest_share", use.share},
                    {"tension_N", use.tension},
                    {"bending_N", use.bending},
                    {"arc_mm", in_mm(use.arc)},
                    {"time_s", use.time}});
  }
  return list.empty() ? json::object() : json{{"strength", list}};
}

/// What quasi-static wires leave out: energies beside those above, forces beside those of the contacts.
json left_out_json(const FinishedMotion& run) {
  json list = json::array();
  for (std::size_t k = 0; k < run.result.left_out.size(); ++k) {
    const coupling::MotionWire& wire = run.asked.motion.wires[k];
    if (!wire.rod.quasi_static) continue;
    const coupling::LeftOutInertia& left_out = run.result.left_out[k];
    list.push_back({{"wire", wire.name},
                    {"left_out_kinetic_J", left_out.kinetic},
                    {"left_out_force_N", left_out.force}});
  }
  return list.empty() ? json::object() : json{{"quasi_static", list}};
}

/// Velocities of a body before and after.
json velocities_json(const RigidBodyState& before, const RigidBodyState& after) {
  return {{"velocity_before_m_s", vector_json(before.velocity)},
          {"velocity_after_m_s", vector_json(after.velocity)},
          {"spin_before_rad_s", vector_json(before.spin)},
          {"spin_after_rad_s", vector_json(after.spin)}};
}

/// contact: index as results count; with what is said of it beside.
json listed_contact_json(const FinishedMotion& run, std::size_t contact, const json& parts) {
  const Touches touches = touches_of(run.result, contact);
  json object{{"contact", run.asked.motion.contact_names()[contact]},
              {"peak_force_N", run.result.peak_force[contact]},
              {"impulse_Ns", vector_json(run.result.impulse[contact])},
              {"touches", touches.count},
              {"in_contact_at_the_end", run.samples.back().contacts[contact].closed},
              {"first_touch_s", time_json(touches.first)},
              {"last_lift_off_s", time_json(touches.last_lift_off)},
              {"most_points", most_points(run, contact)}};
  object.update(parts);
  return object;
}

json listed_contacts_json(const FinishedMotion& run) {
  const coupling::Motion& motion = run.asked.motion;
  json list = json::array();
  for (std::size_t k = 0; k < motion.contacts.size(); ++k) {
    const coupling::MotionContact& c = motion.contacts[k];
    list.push_back(listed_contact_json(
        run, k, {{"body", motion.bodies[at(c.body)].name}, {"wire", motion.wires[at(c.wire)].name}}));
  }
  const std::size_t first = motion.first_contact(coupling::ContactKind::wire_pair);
  for (std::size_t k = 0; k < motion.wire_pairs.size(); ++k) {
    const std::array<int, 2>& wires = motion.wire_pairs[k].wires;
    list.push_back(listed_contact_json(
        run, first + k,
        {{"wire", motion.wires[at(wires[0])].name}, {"other_wire", motion.wires[at(wires[1])].name}}));
  }
  const std::size_t laws = motion.first_contact(coupling::ContactKind::law_wire);
  const std::size_t bodies = motion.first_contact(coupling::ContactKind::bodies);
  for (std::size_t k = 0; k < motion.law_wires.size(); ++k)
    list.push_back(listed_contact_json(run, laws + k, {{"wire", motion.law_wires[k].name}}));
  for (std::size_t k = 0; k < motion.body_contacts.size(); ++k)
    list.push_back(listed_contact_json(run, bodies + k, json::object()));
  return list;
}

/// When a wire was touched first by any shape or other wire.
std::optional<double> first_touch(const FinishedMotion& run, std::size_t wire) {
  const coupling::Motion& motion = run.asked.motion;
  std::optional<double> first;
  const auto consider = [&](std::size_t contact) {
    const Touches touches = touches_of(run.result, contact);
    if (touches.first && (!first || *touches.first < *first)) first = touches.first;
  };
  for (std::size_t k = 0; k < motion.contacts.size(); ++k) {
    if (at(motion.contacts[k].wire) == wire) consider(k);
  }
  for (std::size_t k = 0; k < motion.wire_pairs.size(); ++k) {
    const std::array<int, 2>& wires = motion.wire_pairs[k].wires;
    if (at(wires[0]) == wire || at(wires[1]) == wire)
      consider(motion.first_contact(coupling::ContactKind::wire_pair) + k);
  }
  if (wire >= motion.wires.size())
    consider(motion.first_contact(coupling::ContactKind::law_wire) + wire - motion.wires.size());
  return first;
}

/// Lists of bodies and contacts.
json lists_json(const FinishedMotion& run) {
  const coupling::Motion& motion = run.asked.motion;
  json summary = result_json(run.result);
  summary.update(strength_json(run));
  summary.update(left_out_json(run));
  summary.update(
      {{"bodies", json::array()}, {"contacts", listed_contacts_json(run)}, {"events", json::array()}});
  for (std::size_t k = 0; k < motion.bodies.size(); ++k) {
    const RigidBodyState& after = run.samples.back().bodies[k];
    json body = velocities_json(run.samples.front().bodies[k], after);
    body["body"] = motion.bodies[k].name;
    body["position_after_mm"] = vector_in_mm(after.position);
    summary["bodies"].push_back(body);
  }
  const std::vector<std::string> contacts = motion.contact_names();
  for (const MotionEvent& e : run.result.events) {
    json event{{"time_s", e.time},
               {"what", coupling::to_string(e.kind)},
               {"contact", contacts[at(e.contact)]},
               {"point", e.point + 1},
               {"arc_mm", in_mm(e.arc)}};
    if (e.kind == MotionEvent::Kind::touch) event["approach_m_s"] = e.approach_speed;
    summary["events"].push_back(event);
  }
  return summary;
}

/// Least, largest and last of what every column of the sensors has read.
json sensors_json(const scenario::WireMotions& motions, const FinishedMotion& run) {
  json all = json::object();
  for (const scenario::Sensor& sensor : motions.sensors) {
    const scenario::Readings readings = scenario::read_off(sensor, run.asked.motion, run.samples);
    const std::vector<std::string> columns = sensor.columns();
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const std::vector<double>& values = readings.values[k];
      if (values.empty()) continue;
      const auto [least, largest] = std::minmax_element(values.begin(), values.end());
      all[columns[k]] = {{"least", *least}, {"largest", *largest}, {"last", values.back()}};
    }
  }
  return all;
}

/// Largest torque in every joint, or force where it slides, at the output times.
json peak_torques(const FinishedMotion& run) {
  json all = json::object();
  const coupling::Motion& motion = run.asked.motion;
  for (std::size_t a = 0; a < motion.arms.size(); ++a) {
    for (int j = 0; j < motion.arms[a].arm.motors(); ++j) {
      double peak = 0.0;
      for (const MotionSample& s : run.samples) peak = std::max(peak, std::abs(s.arms[a].joint_torque[j]));
      all[motion.arms[a].joint_name(j)] = peak;
    }
  }
  return all;
}

/// Small oscillations about the end, each with the error of the mesh, estimated by the same motion on a
/// coarser one.
coupling::SmallMotions small_motions(const scenario::WireMotions& motions, const FinishedMotion& run,
                                     const std::function<bool()>& stop) {
  coupling::MotionOptions options = run.asked.options;
  options.stop = stop;
  coupling::SmallMotions small = coupling::small_motions_at(run.asked.motion, options, run.result.last);
  if (!motions.on_half_mesh) {
    for (coupling::MotionMode& mode : small.modes) mode.mesh_error = 0.0;
    return small;
  }
  const coupling::MotionResult coarse = coupling::simulate(*motions.on_half_mesh, options);
  if (coarse.report.usable())
    add_mesh_errors(small, coupling::small_motions_at(*motions.on_half_mesh, options, coarse.last));
  return small;
}

/// The small oscillations, and by what moves the frequency of that in which it has the largest share, of
/// those that the mesh resolves.
json modes_json(const coupling::SmallMotions& small) {
  json list = json::array(), frequencies = json::object();
  std::map<std::string, double> largest;
  for (const coupling::MotionMode& mode : small.modes) {
    json shares = json::object();
    for (const auto& [name, share] : mode.shares) {
      shares[name] = share;
      if (!mode.resolved() || share <= largest[name]) continue;
      largest[name] = share;
      frequencies[name] = mode.frequency;
    }
    list.push_back({{"frequency_Hz", mode.frequency},
                    {"discretisation_error_Hz", mode.mesh_error ? json(*mode.mesh_error) : json()},
                    {"resolved", mode.resolved()},
                    {"damping_ratio", mode.damping},
                    {"shares", shares}});
  }
  const std::optional<double> step = small.largest_explicit_step();
  return {{"modes", list},
          {"frequencies_Hz", frequencies},
          {"largest_explicit_step_s", step ? json(*step) : json()}};
}

json swings_json(const std::vector<scenario::Swing>& swings) {
  json list = json::array();
  for (const scenario::Swing& s : swings)
    list.push_back({{"begin_s", s.begin},
                    {"end_s", s.end},
                    {"peak_deg", in_degrees(s.peak)},
                    {"frequency_Hz", s.frequency()}});
  return list;
}

}  // namespace

json outcome_json(const scenario::WireMotions& motions, const FinishedMotion& run) {
  const coupling::Motion& motion = run.asked.motion;
  json outcome{{"caught", nullptr}, {"events", json::array()}};
  for (const char* key :
       {"first_touch_s", "tight_s", "peak_tension_N", "strength_N", "peak_force_N", "impulse_Ns"})
    outcome[key] = json::object();
  const std::vector<coupling::WireFacts> wires = motion.wire_facts();
  for (std::size_t w = 0; w < wires.size(); ++w) {
    const coupling::WireFacts& wire = wires[w];
    outcome["first_touch_s"][wire.name] = time_json(first_touch(run, w));
    outcome["strength_N"][wire.name] = finite(wire.strength.breaking_tension);
    const bool watched = w < run.result.wires.size();
    outcome["tight_s"][wire.name] = watched ? finite(run.result.wires[w].tight_at) : json();
    outcome["peak_tension_N"][wire.name] = watched ? json(run.result.wires[w].peak_tension) : json();
  }
  const std::vector<std::string> contacts = motion.contact_names();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    outcome["peak_force_N"][contacts[k]] = run.result.peak_force[k];
    outcome["impulse_Ns"][contacts[k]] = vector_json(run.result.impulse[k]);
  }
  outcome["peak_torque_Nm"] = peak_torques(run);
  for (const coupling::PhaseBeginning& p : run.result.phases)
    outcome["events"].push_back(
        {{"time_s", p.time}, {"what", "phase"}, {"phase", motion.phases[at(p.phase)].name}});
  if (!motions.capture) return outcome;
  const scenario::CaptureOutcome capture = scenario::outcome_of(*motions.capture, motion, run.samples);
  outcome["caught"] = capture.caught;
  outcome["enclosed"] = capture.enclosed;
  outcome["caught_since_s"] = time_json(capture.caught_since);
  outcome["shaft_speed_m_s"] = capture.speed;
  outcome["shaft_place_mm"] = vector_in_mm(capture.place);
  return outcome;
}

json motion_summary(const scenario::Scenario& asked, const FinishedMotion& finished,
                    const std::function<bool()>& stop) {
  const scenario::WireMotions& motions = asked.motions;
  json summary{{"schema", "snare-summary/1"},
               {"title", asked.title},
               {"source", asked.source},
               {"version", version()},
               {"duration_s", motions.duration}};
  summary.update(lists_json(finished));
  summary["outcome"] = outcome_json(motions, finished);
  if (!motions.sensors.empty()) summary["sensors"] = sensors_json(motions, finished);
  if (motions.swinging) summary["swings"] = swings_json(swings_of(motions, finished));
  if (motions.output.modes && finished.result.report.usable())
    summary.update(modes_json(small_motions(motions, finished, stop)));
  return summary;
}

}  // namespace snare::results
