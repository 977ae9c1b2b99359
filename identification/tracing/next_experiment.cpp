#include "identification/tracing/next_experiment.hpp"

#include "coupling/statics/largest_stress.hpp"
#include "identification/effects/catalogue.hpp"
#include "wire/physical_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

struct Design {
  Series series;
  std::string words;
};

constexpr int points_a_leg = 15;

/// Load and unload over the highest travel of the present tests, at their mean speed times `speed`.
Design design(const Series& present, double travel, double duration, double fraction, double closer,
              double speed, coupling::PushDirection direction) {
  Design d;
  d.series.name = "proposed";
  d.series.test = present.test;
  coupling::PushProblem& t = d.series.test;
  t.mount.span -= closer;
  t.contact_position = fraction * t.mount.span;
  t.pusher.direction = direction;
  Readings r;
  for (int i = 0; i < 2 * points_a_leg - 1; ++i) {
    const int leg = i < points_a_leg ? i : 2 * points_a_leg - 2 - i;
    r.displacement.push_back(travel * (leg + 1) / points_a_leg);
    if (duration > 0.0) r.time.push_back(duration / speed * i / (2 * points_a_leg - 2));
  }
  r.force.assign(r.displacement.size(), 0.0);
  d.series.readings = r;
  const bool supports = t.mount.kind == wire::MountKind::supports;
  d.words = fmt::format("push at {:.0f} mm from the left {}, {:.3g} mm and back", 1e3 * t.contact_position,
                        supports ? "support" : "mount", 1e3 * travel);
  if (closer != 0.0) {
    d.words +=
        fmt::format(", the {} {:.3g} mm {} ({:.4g} mm)", supports ? "supports" : "mounts",
                    1e3 * std::abs(closer), closer > 0.0 ? "closer" : "farther apart", 1e3 * t.mount.span);
  }
  if (direction != present.test.pusher.direction) {
    d.words += direction == coupling::PushDirection::inward ? ", against the bulge" : ", with the bulge";
  }
  if (speed != 1.0) d.words += fmt::format(", at {:g} times the speed", speed);
  return d;
}

/// Of all series over their whole travels [Pa].
double largest_stress(const Evaluation& evaluation, const std::vector<Series>& series) {
  double stress = 0.0;
  for (std::size_t k = 0; k < std::min(series.size(), evaluation.predictions.size()); ++k) {
    stress = std::max(
        stress, coupling::largest_stress(series[k].test.wire, evaluation.predictions[k].curve.curve.points));
  }
  return stress;
}

/// A push, the difference of two models in it [N], and the largest stress of the wire [Pa].
struct Proposal {
  std::string words;
  double difference = 0.0, stress = 0.0;
};

/// What settles each of some effects by itself.
std::string checks_of(const std::vector<std::string>& names) {
  std::string checks;
  for (const std::string& name : names) {
    const Effect* e = find_effect(name);
    if (e != nullptr) checks += (checks.empty() ? "" : "; or ") + e->independent_check;
  }
  return checks;
}

}  // namespace

NextExperiment next_experiment(const Model& model, const std::vector<Setting>& one,
                               const std::vector<Setting>& other, const std::vector<std::string>& names,
                               double sigma) {
  const Series& present = model.series().front();
  double travel = 0.0;
  double duration = 0.0;
  for (const Series& s : model.series()) {
    const std::vector<double>& d = measured_displacement(s);
    travel = std::max(travel, *std::max_element(d.begin(), d.end()));
    if (s.readings && !s.readings->time.empty())
      duration = std::max(duration, s.readings->time.back() - s.readings->time.front());
  }
  const bool supports = present.test.mount.kind == wire::MountKind::supports;
  const coupling::PushDirection along = present.test.pusher.direction;
  std::vector<Design> designs;
  for (const double fraction : {0.5, 0.35, 0.2}) {
    for (const double closer : {0.0, 0.01 * present.test.mount.span, -0.01 * present.test.mount.span}) {
      if (!supports && present.test.wire.length < 0.995 * (present.test.mount.span - closer)) continue;
      designs.push_back(design(present, travel, duration, fraction, closer, 1.0, along));
    }
    for (const double farther : {0.5, 1.5})
      designs.push_back(design(present, farther * travel, duration, fraction, 0.0, 1.0, along));
    if (duration > 0.0) designs.push_back(design(present, travel, duration, fraction, 0.0, 10.0, along));
  }
  if (supports)
    designs.push_back(design(present, travel, duration, 0.5, -0.5 * present.test.mount.span, 1.0, along));

  // Annealed stainless steel yields at a tenth of what the strongest wire bears (205 MPa, ASTM A580).
  constexpr double noticeable = 1.05, share = 0.1;
  const double known = largest_stress(model.evaluate(one), model.series());
  const double bearable =
      std::max(noticeable * known, share * wire::strongest_wire(present.test.wire.diameter));
  Proposal gentle, any;
  for (const Design& d : designs) {
    const Model alone({d.series}, model.solver());
    const Evaluation a = alone.evaluate(one);
    const Evaluation b = alone.evaluate(other);
    if (!a.complete || !b.complete) continue;
    const double difference =
        (a.force[0] - b.force[0]).norm() / std::sqrt(static_cast<double>(a.force[0].size()));
    const double stress = std::max(largest_stress(a, {d.series}), largest_stress(b, {d.series}));
    if (difference > any.difference) any = {d.words, difference, stress};
    if (stress <= bearable && difference > gentle.difference) gentle = {d.words, difference, stress};
  }
  // Below the noise of one reading even many readings would hardly tell.
  const auto tells = [sigma](const Proposal& p) { return sigma > 0.0 && p.difference >= sigma; };
  const Proposal& best = tells(gentle) ? gentle : any;
  NextExperiment next{"", names, best.difference, sigma > 0.0 ? best.difference / sigma : 0.0};
  const std::string checks = checks_of(names);
  const std::string there = fmt::format(
      "(there they differ by {:.3g} N, {:.2g} times the noise of a reading)", next.difference, next.sigmas);
  if (!tells(best))
    next.what = "no push of this kind separates them; " + checks;
  else if (best.stress <= bearable)
    next.what = fmt::format("{} {}; or {}", best.words, there, checks);
  else
    next.what = fmt::format(
        "{}; or {}, which loads the wire to {:.3g} MPa after {:.3g} MPa so far and may break it {}", checks,
        best.words, best.stress / 1e6, known / 1e6, there);
  return next;
}

}  // namespace snare::identification
