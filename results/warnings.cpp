#include "results/warnings.hpp"

#include "coupling/statics/largest_stress.hpp"
#include "identification/fitting/model.hpp"
#include "results/in_mm.hpp"
#include "wire/physical_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace snare::results {

namespace {

using coupling::PushPoint;

/// Sentences, each once: wires of several series are the same wire.
class Sentences {
 public:
  void add(const std::string& of, const std::vector<std::string>& found) {
    for (const std::string& text : found) {
      const std::string sentence = of.empty() ? text : fmt::format("{}: {}", of, text);
      if (std::find(all_.begin(), all_.end(), sentence) == all_.end()) all_.push_back(sentence);
    }
  }
  [[nodiscard]] std::vector<std::string> take() { return std::move(all_); }

 private:
  std::vector<std::string> all_;
};

/// Warns of a wire that leaves the pusher as the pusher moves on. A pusher that is drawn back leaves the wire
/// as it should.
std::vector<std::string> lost_contact(const std::vector<PushPoint>& points) {
  if (points.empty() || points.back().in_contact) return {};
  const auto last =
      std::find_if(points.rbegin(), points.rend(), [](const PushPoint& p) { return p.in_contact; });
  if (last == points.rend()) return {"the pusher never touches the wire: every force is zero"};
  if (std::prev(last)->travel < last->travel) return {};
  return {fmt::format("the wire leaves the pusher after a travel of {:.4g} mm: no force from there on",
                      1e3 * last->travel)};
}

/// Warns of supports that would have to pull a wire which its weight lifts off them.
std::vector<std::string> pulling_supports(const coupling::PushProblem& test,
                                          const std::vector<PushPoint>& points) {
  if (test.mount.kind != wire::MountKind::supports) return {};
  const double towards = test.pusher.direction == coupling::PushDirection::outward ? 1.0 : -1.0;
  double last = -1.0, largest = 0.0;
  for (const PushPoint& p : points) {
    const double pull = towards > 0.0 ? std::max(p.reaction_across_left, p.reaction_across_right)
                                      : -std::min(p.reaction_across_left, p.reaction_across_right);
    if (pull > 1e-6 * std::abs(p.force) + 1e-9) last = p.travel, largest = std::max(largest, pull);
  }
  if (last < 0.0) return {};
  return {
      fmt::format("the supports would have to pull by up to {:.3g} N, up to a travel of {:.4g} mm: the "
                  "weight lifts the wire off "
                  "them, which is not computed; push the other way, or turn gravity",
                  largest, 1e3 * last)};
}

/// Warns of points on a branch that a wire which is free to move leaves, from the bifurcation on where there
/// is one.
std::vector<std::string> unstable_branch(const coupling::PushCurve& curve) {
  const auto unstable = [](const PushPoint& p) { return p.converged && p.unstable_modes > 0; };
  const auto first = std::find_if(curve.points.begin(), curve.points.end(), unstable);
  if (first == curve.points.end()) return {};
  const auto last = std::find_if(curve.points.rbegin(), curve.points.rend(), unstable);
  double begin = first->travel;
  for (const coupling::PushEvent& e : curve.events) {
    if (e.kind == coupling::PushEvent::Kind::bifurcation && e.travel <= first->travel) begin = e.travel;
  }
  return {fmt::format(
      "the curve runs along an unstable branch from a travel of {:.4g} mm to {:.4g} mm: a wire that is free "
      "leaves it there; solver.instability = \"switch_branch\" goes on along the stable one",
      1e3 * begin, 1e3 * last->travel)};
}

/// Warns of a stress above the strength of every wire, of the series where it is largest; the others are
/// named.
std::vector<std::string> overload_of(const std::vector<identification::Series>& series,
                                     const std::vector<identification::Prediction>& predictions) {
  std::vector<std::pair<double, std::size_t>> over;  // stress and series
  for (std::size_t k = 0; k < std::min(series.size(), predictions.size()); ++k) {
    const wire::WireSpecification& wire = series[k].test.wire;
    const double stress = coupling::largest_stress(wire, predictions[k].curve.curve.points);
    if (!wire::overload(wire, stress).empty()) over.emplace_back(stress, k);
  }
  if (over.empty()) return {};
  std::ranges::sort(over, std::greater{});
  const identification::Series& worst = series[over.front().second];
  std::string text =
      fmt::format("series {}: {}", worst.name, wire::overload(worst.test.wire, over.front().first).front());
  std::vector<std::string> others;
  for (std::size_t i = 1; i < over.size(); ++i) others.push_back(series[over[i].second].name);
  if (!others.empty()) text += fmt::format(". It is too large in {}, too", fmt::join(others, ", "));
  return {text};
}

}  // namespace

std::vector<std::string> push_warnings(const std::vector<identification::Series>& series,
                                       const std::vector<identification::Prediction>& predictions,
                                       const std::string& of) {
  Sentences sentences;
  for (const identification::Series& s : series) sentences.add(of, wire::doubts(s.test.wire));
  sentences.add(of, overload_of(series, predictions));
  for (std::size_t k = 0; k < std::min(series.size(), predictions.size()); ++k) {
    const std::vector<PushPoint>& points = predictions[k].curve.curve.points;
    const std::string whose = (of.empty() ? "" : of + ", ") + "series " + series[k].name;
    sentences.add(whose, lost_contact(points));
    sentences.add(whose, unstable_branch(predictions[k].curve.curve));
    sentences.add(whose, pulling_supports(series[k].test, points));
  }
  return sentences.take();
}

std::vector<std::string> trace_warnings(const identification::Experiment& experiment,
                                        const identification::Trace& trace) {
  std::vector<identification::Series> series = trace.series;
  for (identification::Series& s : series) {  // the wires are asked, not what was read
    s.readings.reset();
    s.test.travel.clear();
  }
  const identification::Model model(std::move(series), experiment.solver, false);
  std::vector<std::string> warnings;
  for (const identification::Finding& f : trace.findings) warnings.push_back(f.what);
  constexpr double too_far = 5.0;  // deviations of a place
  for (const identification::PlaceEstimate& p : trace.places) {
    if (p.sigma > 0.0 && std::abs(p.shift) > too_far * p.sigma)
      warnings.push_back(fmt::format(
          "series {}: the fit puts the pusher {:.3g} mm from where it is declared, {:.3g} times its standard "
          "deviation: something else is wrong, and the fitted numbers cannot be relied on",
          fmt::join(p.series, ", "), in_mm(p.shift), std::abs(p.shift) / p.sigma));
  }
  for (std::string& w :
       push_warnings(model.apply(trace.final_settings).series, trace.final_predictions, "fitted model"))
    warnings.push_back(std::move(w));
  return warnings;
}

std::vector<std::string> wire_warnings(const reduction::WireFile& file) {
  Sentences sentences;
  for (const reduction::WireCase& one : file.cases) sentences.add("", wire::doubts(one.test.wire));
  return sentences.take();
}

namespace {

/// Reports an error of the energy balance beyond 1 % of the energy exchanged: the largest change of kinetic,
/// elastic or potential energy, of dissipated energy or of work. Where less is exchanged than the default
/// tolerance of places resolves to 1 % against the largest force, as by a body that settles to rest, it
/// reports nothing.
std::vector<std::string> energy_doubts(const FinishedMotion& run) {
  constexpr double most = 0.01;
  const std::vector<coupling::MotionSample>& samples = run.samples;
  if (samples.empty()) return {};
  double force = 0.1;  // [N]: where nothing presses
  for (const double peak : run.result.peak_force) force = std::max(force, peak);
  const double least = force * coupling::MotionOptions{}.body_position_tolerance / most;  // [J]
  const coupling::EnergyBalance& start = samples.front().energy;
  double exchanged = 0.0, gained = 0.0;
  for (const coupling::MotionSample& s : samples) {
    const coupling::EnergyBalance& e = s.energy;
    for (const double change :
         {e.kinetic - start.kinetic, e.strain - start.strain, e.potential - start.potential,
          e.dissipated - start.dissipated, e.work - start.work})
      exchanged = std::max(exchanged, std::abs(change));
    if (std::abs(e.integrator) > std::abs(gained)) gained = e.integrator;
  }
  if (exchanged < least || std::abs(gained) <= most * exchanged) return {};
  return {fmt::format(
      "the integrator {} {:.3g} J, {:.2g} % of the {:.3g} J that were exchanged: take smaller tolerances "
      "([solver])",
      gained > 0.0 ? "gained" : "lost", std::abs(gained), 100.0 * std::abs(gained) / exchanged, exchanged)};
}

}  // namespace

std::vector<std::string> motion_warnings(const std::vector<FinishedMotion>& finished) {
  Sentences sentences;
  for (const FinishedMotion& run : finished) {
    const coupling::Motion& motion = run.asked.motion;
    const std::string of = finished.size() > 1 ? run.asked.name + ", " : "";
    sentences.add("", run.asked.warnings);
    sentences.add(finished.size() > 1 ? run.asked.name : "", energy_doubts(run));
    for (std::size_t k = 0; k < motion.wires.size(); ++k) {
      // Its diameter is known from what touches it.
      const auto touching = std::find_if(motion.contacts.begin(), motion.contacts.end(), [k](const auto& c) {
        return c.wire == static_cast<int>(k) && c.wire_radius > 0.0;
      });
      if (touching == motion.contacts.end()) continue;
      const double diameter = 2.0 * touching->wire_radius;
      const double area = std::numbers::pi * diameter * diameter / 4.0;
      const double strength = wire::strongest_wire(diameter) * area;
      double tension = 0.0;
      for (const coupling::MotionSample& s : run.samples) {
        for (std::size_t end = 2 * k; end < std::min(2 * k + 2, s.mount_forces.size()); ++end)
          tension = std::max(tension, s.mount_forces[end].norm());
      }
      const std::string wire =
          of + (motion.wires[k].name == "wire" ? "the wire" : "wire " + motion.wires[k].name);
      if (tension > strength) {
        sentences.add(
            wire,
            {fmt::format(
                "a mount holds it with {:.4g} N; the strongest wire of steel of {:.4g} mm breaks at {:.4g} N",
                tension, 1e3 * diameter, strength)});
      }
      const wire::RodInMotion& rod = motion.wires[k].rod;
      const double limit =
          wire::breaking_speed(rod.properties.axial_stiffness, rod.mass_per_length, strength);
      for (const coupling::MotionEvent& e : run.result.events) {
        const auto contact = static_cast<std::size_t>(e.contact);
        if (contact >= motion.contacts.size() || motion.contacts[contact].wire != static_cast<int>(k) ||
            e.kind != coupling::MotionEvent::Kind::touch || e.approach_speed <= limit)
          continue;
        sentences.add(wire,
                      {fmt::format("is struck at {:.4g} m/s; a wire of steel breaks at once at {:.4g} m/s",
                                   e.approach_speed, limit)});
        break;
      }
    }
    const std::size_t first = motion.first_contact(coupling::ContactKind::law_wire);
    for (std::size_t k = 0; k < motion.law_wires.size(); ++k) {
      const coupling::LawWire& wire = motion.law_wires[k];
      if (!wire.covers) continue;
      const double span = (wire.p_to - wire.p_from).norm();
      const auto left = std::ranges::find_if(run.samples, [&](const coupling::MotionSample& s) {
        const coupling::ContactSample& c = s.contacts[first + k];
        return c.closed && !wire.covers(-c.gap, c.arc / wire.length * span);
      });
      if (left == run.samples.end()) continue;
      const coupling::ContactSample& c = left->contacts[first + k];
      sentences.add(
          of + wire.name,
          {fmt::format("its law was made for less: from {:.4g} s on it is pushed by {:.4g} mm at {:.4g} mm",
                       left->time, -1e3 * c.gap, 1e3 * c.arc / wire.length * span)});
    }
  }
  return sentences.take();
}

}  // namespace snare::results
