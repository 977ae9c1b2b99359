#include "identification/tracing/reading_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace snare::identification {

namespace {

// of the largest computed force: readings below it say nothing of the sign
constexpr double weight_from = 0.05;
constexpr double nearly_all_turned = 0.8;  // of these readings

/// Share of the readings whose sign is against that of the computed force, of those where it counts; nothing
/// without any.
std::optional<double> share_against(const std::vector<double>& measured,
                                    const std::vector<double>& computed) {
  double largest = 0.0, count = 0.0, against = 0.0;
  for (const double f : computed) largest = std::max(largest, std::abs(f));
  for (std::size_t i = 0; i < std::min(measured.size(), computed.size()); ++i) {
    if (std::abs(computed[i]) <= weight_from * largest) continue;
    count += 1.0;
    against += measured[i] * computed[i] < 0.0 ? 1.0 : 0.0;
  }
  if (count < 3.0) return std::nullopt;
  return against / count;
}

/// Whether the travel goes below zero and never above, but for a fiftieth.
bool goes_down(const std::vector<double>& displacement) {
  const auto [low, high] = std::minmax_element(displacement.begin(), displacement.end());
  return *low < 0.0 && *high <= -0.02 * *low;
}

/// The series with the readings of its travel times `factor`.
Series with_travel(Series series, double factor) {
  for (double& d : series.readings->displacement) d *= factor;
  series.test.travel = series.readings->displacement;
  return series;
}

/// Whether a travel in another unit is longer than the wire, which no push is.
bool beyond_wire(const std::vector<Series>& series, double factor) {
  return std::ranges::any_of(series, [&](const Series& s) {
    if (!s.readings) return false;
    const auto beyond = [&](double d) { return std::abs(d * factor) > s.test.wire.length; };
    return std::ranges::any_of(s.readings->displacement, beyond);
  });
}

bool is_stiffness(const Parameter& p) {
  return p.key.ends_with("wire.axial_stiffness_N") || p.key.ends_with("wire.bending_stiffness_Nm2") ||
         p.key.ends_with("wire.youngs_modulus_GPa");
}

/// Fitted stiffnesses over their declared values, as logarithms.
struct Ratios {
  std::vector<double> log;
  std::string keys;
  bool bound = false;  // one of them stands on its bound, so that it has no value
};
Ratios ratios_of(const Model& model, const Fit& fit) {
  Ratios ratios;
  for (std::size_t k = 0; k < fit.free; ++k) {
    const Setting& s = fit.settings[k];
    if (!is_stiffness(*s.parameter)) continue;
    const bool bound =
        at_bound(s.coordinate, model.lower(*s.parameter), model.upper(*s.parameter)) != AtBound::none;
    ratios.bound = ratios.bound || bound;
    if (bound || !fit.rank.is_known(k)) continue;
    ratios.log.push_back(s.coordinate);
    ratios.keys += (ratios.keys.empty() ? "" : " and ") + s.parameter->key;
  }
  return ratios;
}

/// Whether all ratios are the one of a slip: within a tenth where there is one, within a fifth where two
/// agree on it. For the factor of lbf, which strands have as well, half of that.
bool all_near(const std::vector<double>& log, double of) {
  if (log.empty()) return false;
  const bool common = std::abs(std::log(of)) < std::log(6.0);
  const double near = (common ? 0.5 : 1.0) * (log.size() > 1 ? 0.2 : 0.1);
  return std::all_of(log.begin(), log.end(), [&](double r) { return std::abs(r - std::log(of)) < near; });
}

Finding slip_finding(std::string key, double ratio, double factor, const std::string& what) {
  Finding f{.kind = FindingKind::unit_slip, .key = std::move(key)};
  f.value = ratio;
  f.limit = factor;
  f.what = what;
  return f;
}

/// The readings in another unit: forces and travels times their factors, noise likewise, without its
/// correlation.
struct Rescaled {
  Model model;
  Data data;
};
Rescaled rescaled(const Model& model, const Data& data, double force, double travel) {
  std::vector<Series> series = model.series();
  Data scaled{.series = data.series, .measured = data.measured, .noise = {}, .placings = {}};
  if (travel != 1.0)
    for (const std::size_t k : data.series) series[k] = with_travel(series[k], travel);
  for (Eigen::VectorXd& f : scaled.measured) f *= force;
  scaled.noise.source = data.noise.source;
  for (const double s : data.noise.sigma) scaled.noise.sigma.push_back(force * s);
  return {Model(std::move(series), model.solver()), std::move(scaled)};
}

double peak_of(const std::vector<Eigen::VectorXd>& forces) {
  double peak = 0.0;
  for (const Eigen::VectorXd& f : forces)
    if (f.size() > 0) peak = std::max(peak, f.cwiseAbs().maxCoeff());
  return peak;
}

/// A slip with which the readings can be fitted by stiffnesses near the declared ones.
struct SlipTrial {
  const char* words = "";
  double factor = 1.0, distance = std::numeric_limits<double>::infinity();
};

/// The fit of one slip, if it does: compared with chi2 of the fit as it is.
std::optional<SlipTrial> try_slip(const Model& model, const Data& data, const Fit& base, double force,
                                  double travel, double chi2) {
  constexpr double plausible = 3.0;                         // between the largest forces
  constexpr double much_better = 0.2;                       // of chi2
  const double near = std::log(travel == 1.0 ? 1.3 : 2.0);  // of the stiffnesses to the declared ones
  if (beyond_wire(model.series(), travel)) return std::nullopt;
  const Rescaled now = rescaled(model, data, force, travel);
  const Evaluation declared = now.model.evaluate({});
  const double measured = peak_of(now.data.measured), computed = peak_of(declared.force);
  if (!declared.complete || !(computed > 0.0) ||
      std::abs(std::log(measured / computed)) > std::log(plausible))
    return std::nullopt;
  std::vector<Setting> start = base.fitted();
  for (Setting& s : start)
    s.coordinate =
        s.parameter->coordinate(now.model.declared(*s.parameter), now.model.declared(*s.parameter));
  FitOptions options;
  options.max_iterations = 20;
  const Fit trial = fit(now.model, now.data, start, {}, options);
  if (!trial.report.usable() || !(trial.chi2 < much_better * chi2)) return std::nullopt;
  const Ratios ratios = ratios_of(now.model, trial);
  SlipTrial found;
  found.distance = 0.0;
  for (const double r : ratios.log) found.distance = std::max(found.distance, std::abs(r));
  if (ratios.bound || found.distance > near) return std::nullopt;
  found.factor = force * travel;
  return found;
}

}  // namespace

std::vector<Finding> sign_findings(const std::vector<Series>& series,
                                   const std::vector<std::vector<double>>& declared,
                                   const SolverSettings& solver) {
  std::vector<Finding> findings;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const Series& s = series[k];
    if (!s.readings || s.law) continue;
    const std::string key = "series[" + s.name + "]";
    std::vector<double> computed = k < declared.size() ? declared[k] : std::vector<double>();
    const bool down = goes_down(s.readings->displacement);
    if (down) {
      const Evaluation up = Model({with_travel(s, -1.0)}, solver).evaluate({});
      computed.clear();
      if (up.complete) computed.assign(up.force.front().begin(), up.force.front().end());
    }
    const std::optional<double> against = share_against(s.readings->force, computed);
    const bool turned = against && *against >= nearly_all_turned;
    if (!down && !turned) continue;
    Finding f{.kind = FindingKind::sign_turned, .key = key, .sure = true};
    f.value = turned ? *against : 1.0;
    const std::string forces =
        turned ? fmt::format("{:.0f} % of the forces have the other sign than a wire that resists the push",
                             100.0 * *against)
               : std::string();
    const std::string travels = "displacement_mm goes below zero only, where it should count along the push";
    f.what = fmt::format(
        "{}: {}{}{}; turn the sign of the readings round, in a file by scale = {{ \"COLUMN\" = -1 }}", key,
        down ? travels : "", down && turned ? ", and " : "", forces);
    findings.push_back(std::move(f));
  }
  return findings;
}

std::vector<Finding> unit_findings(const Model& model, const Data& data, const Fit& base) {
  const Ratios ratios = ratios_of(model, base);
  for (const UnitSlip& slip : unit_slips) {
    if (ratios.bound || slip.force[0] == '\0' || !all_near(ratios.log, 1.0 / slip.factor)) continue;
    const double ratio = std::exp(ratios.log.front());
    return {slip_finding(ratios.keys, ratio, slip.factor,
                         fmt::format("{} {} {:.3g} times the declared {}: it looks like {}", ratios.keys,
                                     ratios.log.size() > 1 ? "are" : "is", ratio,
                                     ratios.log.size() > 1 ? "values" : "value", slip.force))};
  }
  const double peak = peak_of(data.measured);
  double squares = 0.0, chi2 = 0.0, count = 0.0;
  for (const std::size_t k : data.series) {
    const double left = (data.measured[k] - base.evaluation.force[k]).squaredNorm();
    squares += left;
    chi2 += left / (data.noise.sigma[k] * data.noise.sigma[k]);
    count += static_cast<double>(data.measured[k].size());
  }
  constexpr double poor = 0.05;
  const bool poorly = squares > count * std::pow(poor * peak, 2) && chi2 > 9.0 * count;
  if (ratios.keys.empty() && !ratios.bound) return {};
  if (!ratios.bound && !poorly) return {};
  SlipTrial best;
  bool of_force = true;
  for (const UnitSlip& slip : unit_slips) {
    for (const bool force : {true, false}) {
      const char* words = force ? slip.force : slip.travel;
      if (words[0] == '\0') continue;
      std::optional<SlipTrial> trial =
          try_slip(model, data, base, force ? slip.factor : 1.0, force ? 1.0 : slip.factor, chi2);
      if (!trial || trial->distance >= best.distance) continue;
      trial->words = words;
      best = *trial;
      of_force = force;
    }
  }
  if (!std::isfinite(best.distance)) return {};
  return {slip_finding(
      of_force ? "force_N" : "displacement_mm", best.factor, best.factor,
      fmt::format("it looks like {}: times {:.4g} the readings are fitted by stiffnesses near the "
                  "declared ones",
                  best.words, best.factor))};
}

}  // namespace snare::identification
