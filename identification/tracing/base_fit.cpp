#include "identification/tracing/base_fit.hpp"

#include "base/errors.hpp"
#include "coupling/statics/push_path.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/published_fit.hpp"
#include "identification/tracing/score.hpp"
#include "identification/tracing/start_search.hpp"
#include "identification/tracing/trace_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace snare::identification {

using base::InputError;

namespace {

/// Why the series to which a number belongs cannot show it; empty where they may.
std::string unseen(const Parameter& p, const std::vector<Series>& all) {
  std::vector<Series> series;
  for (const Series& s : all)
    if (p.only.empty() || p.only == s.name) series.push_back(s);
  if (series.empty()) return "its series is held out";
  for (const Effect& e : catalogue()) {
    const bool own = std::ranges::any_of(
        e.numbers, [&](const EffectNumber& n) { return p.key.ends_with(n.parameter.key); });
    // The declared model has the effect of a threshold already, so its absence cannot be a reason.
    const bool declared = p.parametrisation == Parametrisation::magnitude;
    if (own && !declared && e.unobservable != nullptr) return e.unobservable(series);
  }
  if (p.unseen == nullptr) return "";
  const bool none = std::ranges::all_of(series, [&](const Series& s) { return *p.unseen(s.test) != '\0'; });
  return none ? p.unseen(series.front().test) : "";
}

/// A start of the base fit from fractions of the declared section's stiffnesses, after a few steps on a
/// coarse mesh. Empty where none comes below `best`, computed on the same mesh.
std::vector<Setting> far_start(const Model& model, const Data& data, const std::vector<Setting>& start,
                               const Fit& best, Progress& progress) {
  const Model coarse(model.series(), few_edges(model.solver()));
  const Evaluation here = coarse.evaluate(best.settings);
  double least = best.report.usable() && here.complete ? data.residual(here).squaredNorm() : 1e300;
  std::vector<Setting> section = as_the_section_has(model, start);
  if (section.empty()) section = start;
  std::vector<Setting> found;
  for (const double bending : {1.0, 0.1}) {
    for (const double axial : {1.0, 0.1, 0.01}) {
      if (!progress.go_on("base model: starts far from the declared values")) return {};
      std::vector<Setting> one = section;
      for (Setting& s : one) {
        const bool bends = s.parameter->key == "wire.bending_stiffness_Nm2";
        if (!bends && s.parameter->key != "wire.axial_stiffness_N") continue;
        s.coordinate = std::clamp(s.coordinate + std::log(bends ? bending : axial), model.lower(*s.parameter),
                                  model.upper(*s.parameter));
      }
      FitOptions fitting;
      fitting.max_iterations = 10;
      fitting.tolerance = 1e-3;
      fitting.rival = least < 1e300 ? least : 0.0;
      const Fit reached = fit(coarse, data, one, {}, fitting);
      if (!reached.report.usable() || !(reached.chi2 < 0.99 * least)) continue;
      least = reached.chi2;
      found = reached.fitted();
    }
  }
  return found;
}

}  // namespace

Fit fit_base(const Experiment& experiment, const std::vector<std::string>& free, const Model& model,
             Data& data, Progress& progress) {
  std::vector<std::string> keys = free;
  if (keys.empty()) keys = experiment.free;
  if (keys.empty()) keys = default_free(experiment);
  std::vector<Setting> start;
  bool length = false;
  for (const std::string& key : keys) {
    const Parameter& p = parameters().at(key);
    const double declared = model.declared(p);
    if (!std::isfinite(declared)) {
      throw InputError(
          {experiment.file.string(), 0, "fit.free", fmt::format("\"{}\"", key),
           "is a threshold that the declared model does not have: declare a value to start from"});
    }
    if (const std::string why = unseen(p, model.series()); !why.empty()) {
      throw InputError({experiment.file.string(), 0, "fit.free", fmt::format("\"{}\"", key),
                        "no reading depends on it: " + why});
    }
    start.push_back({&p, p.coordinate(declared, declared)});
    length = length || key == "wire.length_mm";
  }
  const double most = static_cast<double>(data.rows()) - data.noise.estimated - 3.0;
  if (static_cast<double>(keys.size()) > most) {
    const char* what = data.noise.estimated > 0.0 ? "published numbers" : "readings";
    throw InputError({experiment.file.string(), 0, "fit.free", std::to_string(keys.size()) + " keys",
                      fmt::format("must leave at least 3 degrees of freedom: at most {:g} keys with {} {}",
                                  std::max(0.0, most), data.rows(), what)});
  }
  if (data.noise.sigma.empty()) data.noise.sigma.assign(model.series().size(), 1.0);
  FitOptions fitting;
  fitting.progress = [&progress](int iteration, double) {
    return progress.go_on(fmt::format("base model: iteration {}", iteration));
  };
  const std::vector<Setting> declared = start;
  Fit best = fit(model, data, start, {}, fitting);
  const auto begin_at = [&](const std::vector<Setting>& other_start) {
    const Fit other = fit(model, data, other_start, {}, fitting);
    if (other.report.usable() && (!best.report.usable() || other.chi2 < best.chi2)) best = other;
  };
  if (length) {
    // Where a wire goes from loose to taut there is a minimum on either side.
    const coupling::PushProblem& test = model.series().front().test;
    for (const double of_slack : {0.6, 1.3}) {
      std::vector<Setting> looser = start;
      for (Setting& s : looser) {
        if (s.parameter->key == "wire.length_mm")
          s.coordinate = (of_slack - 1.0) * std::max(0.0, test.wire.length - test.mount.span);
      }
      begin_at(looser);
    }
    // A loose wire that is nearly straight lies in a valley of its own.
    for (Setting& s : start) {
      if (s.parameter->key == "wire.bending_stiffness_Nm2") s.coordinate = std::log(0.05);
      if (s.parameter->key == "wire.axial_stiffness_N") s.coordinate = std::log(0.3);
      if (s.parameter->key == "wire.length_mm") {
        s.coordinate = s.parameter->coordinate(model.declared(*s.parameter), 1.002 * test.mount.span);
      }
    }
    begin_at(start);
    // So does one whose record began before the touch.
    bool zero = false;
    for (Setting& s : start) {
      if (!s.parameter->key.ends_with("reading.displacement_offset_mm")) continue;
      zero = true;
      s.coordinate = 1e-3;
    }
    if (zero && progress.go_on("base model: with a late touch")) begin_at(start);
  }
  const bool stiffness = std::ranges::any_of(keys, [](const std::string& key) {
    return key == "wire.bending_stiffness_Nm2" || key == "wire.axial_stiffness_N";
  });
  if (stiffness && !data.published()) {
    const std::vector<Setting> far = far_start(model, data, declared, best, progress);
    if (!far.empty()) begin_at(far);
  }
  return best;
}

namespace {

/// Sets the standard deviation of published fits to that of greatest likelihood, its bias corrected, if it is
/// smaller than that about parabolas: a wrong model makes it larger, which would hide the missing effect.
/// Fits again.
void settle_scatter(const Model& model, Data& data, Fit& base) {
  const SummaryStatistics found =
      summary_statistics(model, data.series, base.settings, base.free, {.scatter = data.noise.scatter});
  if (found.series.size() != data.series.size()) return;
  std::size_t at = 0;
  for (const std::size_t k : data.series) {
    const double sigma = found.series[at++].scatter;
    if (!model.series()[k].force_sigma && sigma < data.noise.sigma[k])
      data.noise.set_published_sigma(k, sigma);
  }
  base = fit(model, data,
             {found.settings.begin(), found.settings.begin() + static_cast<std::ptrdiff_t>(base.free)});
}

}  // namespace

void settle_noise(const Model& model, Data& data, Fit& base) {
  if (data.published() && data.noise.estimated > 0.0) settle_scatter(model, data, base);
  if (!base.report.usable()) return;
  const bool declared = !data.noise.source.empty();
  if (!declared) {
    std::vector<Eigen::VectorXd> residuals;
    for (std::size_t k = 0; k < data.measured.size(); ++k) {
      residuals.push_back(data.measured[k] - base.evaluation.force[k]);
    }
    data.noise = noise_from_residuals(model.series(), residuals, base.evaluation.force);
  }
  const bool exact =
      std::ranges::all_of(model.series(), [](const Series& s) { return s.position_sigma == 0.0; });
  if (!exact) data.placings = find_placings(model, base.settings, parameters().at(place_key));
  if (!declared || !exact) base = fit(model, data, base.fitted());
  if (!exact && data.placings.empty()) {
    base.report.end(
        numerics::Termination::step_too_small,
        "the base model cannot be computed beside its places: contact_position_sigma_mm cannot be weighed");
  }
}

namespace {

/// The numbers of a fit with number k moved by so many standard errors, the others along its valley, within
/// their bounds.
std::vector<Setting> along_valley(const Model& model, const Fit& fit, Eigen::Index k, double errors) {
  std::vector<Setting> settings = fit.fitted();
  const double error = std::sqrt(fit.covariance(k, k));
  for (std::size_t j = 0; j < settings.size() && error > 0.0; ++j) {
    Setting& s = settings[j];
    s.coordinate = std::clamp(s.coordinate + errors * fit.covariance(static_cast<Eigen::Index>(j), k) / error,
                              model.lower(*s.parameter), model.upper(*s.parameter));
  }
  return settings;
}

}  // namespace

void leave_kinks(const Model& model, const Data& data, Fit& base, Progress& progress) {
  const std::vector<Series> now = model.apply(base.settings).series;
  if (data.published() ||
      std::ranges::none_of(now, [](const Series& s) { return coupling::remembers(s.test); }))
    return;
  constexpr int most_rounds = 3;
  constexpr double worthwhile = 1e-3;  // of chi2
  // of its rise in a smooth valley, below which there may be another minimum
  constexpr double smooth_share = 0.5;
  for (int round = 0; round < most_rounds; ++round) {
    const Fit from = base;
    for (Eigen::Index k = 0; k < from.covariance.cols(); ++k) {
      for (const double errors : {0.5, -0.5, 1.0, -1.0}) {
        if (!progress.go_on("base model: starts near it")) return;
        const std::vector<Setting> start = along_valley(model, from, k, errors);
        const Evaluation at = model.evaluate(start);
        if (!at.complete || data.residual(at).squaredNorm() > base.chi2 + smooth_share * errors * errors)
          continue;
        Fit other = fit(model, data, start);
        if (other.report.usable() && other.chi2 < base.chi2) base = std::move(other);
      }
    }
    if (from.chi2 - base.chi2 < worthwhile) return;
  }
}

}  // namespace snare::identification
