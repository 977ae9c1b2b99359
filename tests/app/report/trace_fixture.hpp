#pragma once

#include "identification/effects/catalogue.hpp"
#include "identification/tracing/trace.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace snare::app {

inline identification::Experiment traced_experiment() {
  identification::Experiment experiment;
  experiment.title = "Push on a wire";
  experiment.source = "somebody, somewhere";
  return experiment;
}

inline identification::Series series(const std::string& name, double position,
                                     const std::vector<double>& force, const std::vector<double>& time) {
  identification::Series s;
  s.name = name;
  s.test.contact_position = position;
  s.test.mount.span = 0.175;
  s.readings = identification::Readings{{0.0, 1e-3, 2e-3}, force, time};
  return s;
}

inline identification::Prediction prediction(const std::vector<double>& force) {
  identification::Prediction p;
  p.force = force;
  return p;
}

inline identification::Candidate candidate(const char* effect, double z, double adjusted_p) {
  identification::Candidate c;
  c.score.effect = identification::find_effect(effect);
  c.score.z = z;
  c.score.adjusted_p = adjusted_p;
  return c;
}

/// Two series, the second held out, of the first a published law; one effect added.
inline identification::Trace explained_trace() {
  using identification::FittedNumber;
  identification::Trace t;
  t.series = {series("s40", 0.040, {0.1, 0.6, 2.9}, {}),
              series("s65", 0.065, {0.0, 0.5, 2.0}, {0.0, 5.0, 10.0})};
  t.series[0].law = identification::QuadraticLaw{719880.0, -13.578, 0.0533, 0.9976, 3e-3};
  t.heldout = {false, true};
  t.noise.sigma = {0.148, 0.148};
  t.noise.source = "declared";
  t.from_laws = true;
  t.mesh_error = 0.00627;
  t.declared = {348.4, 29.6, 6107038.0, {}, {}, {}};
  const FittedNumber base{"wire.axial_stiffness_N", "N", 341059.0, 17216.4, 617.0, 16047.2, 18470.9, false};
  t.base = {0.1826, 0.0155, 1.668, {}, {base}, {}};
  const FittedNumber stiffness{
      "wire.axial_stiffness_N", "N", 341059.0, 27023.7, 2122.0, 23168.6, 31520.3, false};
  const FittedNumber stress{"plasticity.yield_stress_MPa", "MPa", std::nan(""), 181.8, 20.0, 147.5, {}, true};
  t.final = {0.1622, 0.0138, 1.331, {}, {stiffness, stress}, {}};
  t.declared_predictions = {prediction({0.0, 20.0, 301.5}), prediction({0.0, 0.6, 2.1})};
  t.base_predictions = {prediction({0.0, 0.8, 2.7}), prediction({0.0, 0.4, 1.9})};
  t.final_predictions = std::vector{prediction({0.0, 0.7, 2.8}), prediction({0.0, 0.5, 1.95})};
  t.base_tests = {0.35, 0.071, 7.9e-06, false};
  t.final_tests = {0.88, 0.083, 0.0099, false};
  t.significant = true;

  identification::Round round;
  round.added = "plasticity";
  round.reason = "the refit lowers BIC by 35.86";
  round.classes = {{"plasticity"}, {"span", "force_gain", "axial_stiffness"}};
  round.candidates = {candidate("plasticity", 5.758, 2.2e-07), candidate("span", -0.5143, 1.0),
                      candidate("force_gain", 0.0, 1.0)};
  identification::Candidate& yields = round.candidates[0];
  yields.refitted = true;
  yields.rmse = 0.1621;
  yields.delta_bic = -35.86;
  yields.numbers = {{"plasticity.yield_stress_MPa", "MPa", std::nan(""), 181.8, {}, 145.4, 227.2, true}};
  yields.heldout_improves = true;
  identification::Candidate& span = round.candidates[1];
  span.refitted = true;
  span.rmse = 0.18;
  span.delta_bic = 4.2;
  span.numbers = {{"mount.span_mm", "mm", 175.0, 9.0, {}, {}, 9.5, false}};
  span.plausible = false;
  span.why_implausible = "mount.span_mm = 9 mm";
  span.score.detectable = 0.0362;
  round.candidates[2].score.unobservable = "the fitted numbers change the curves in the same way";
  t.rounds = {round};

  t.selected = {"plasticity"};
  t.selected_classes = {{"plasticity"}};
  t.heldout_rmse = {0.301, 0.205};
  t.left_out_rmse = {0.5, 0.7};
  t.explained = t.decided = true;
  t.kind = identification::VerdictKind::explained;
  t.channel = "wire";
  t.seconds = {{"reading", 1e-05}, {"base fit", 3.65}, {"intervals", 4.81}};
  t.next = identification::NextExperiment{"push at s = 30 mm", {"plasticity", "span"}, 1.25, 8.4};
  return t;
}

inline identification::Trace unexplained_trace() {
  using identification::Channel;
  identification::Trace t = explained_trace();
  t.explained = t.decided = false;
  t.kind = identification::VerdictKind::not_explained;
  t.selected.clear();
  t.selected_classes.clear();
  t.final = t.base;
  t.final_predictions = t.base_predictions;
  t.next.reset();
  t.heldout_rmse.reset();
  t.partial = {"plasticity", "gravity"};
  t.partial_rmse = 0.233;
  identification::ChannelFunction pusher;
  pusher.channel = Channel::pusher;
  pusher.argument = "force on the pusher [N]";
  pusher.effect = "the pusher lags behind the travel [mm]";
  pusher.at = {0.0, 1.0, 2.0};
  pusher.value = {0.0, 0.1, 0.4};
  pusher.deviation = {0.01, 0.02, 0.05};
  pusher.carried_over = 0.4;
  pusher.explained = 0.55;
  pusher.shape = "high between 1 and 2";
  identification::ChannelFunction wire;
  wire.channel = Channel::wire;
  wire.argument = "place along the wire [mm]";
  wire.effect = "changes the bending stiffness";
  wire.carried_over = -43.1;
  wire.explained = 0.88;
  wire.shape = "nowhere beyond three standard deviations";
  t.functions = {pusher, wire};
  return t;
}

}  // namespace snare::app
