#include "identification/tracing/round.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/fitting/statistics.hpp"
#include "identification/tracing/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace snare::identification {

namespace {

constexpr double collinear = 0.95;         // |cos| above which effects are one class
constexpr double same_direction = 0.9995;  // |cos| above which the refits of two effects end alike
// difference of BIC below which the likelihood does not decide (Kass and
constexpr double indistinct_bic = 6.0;
// Raftery 1995); 98.6 % of a chi-square of one degree of freedom
constexpr double separable_chi2 =
    10.0;                           // z^2 (1 - cos^2) above which a rival of the leader need not be refitted
constexpr double least_fall = 0.9;  // of the root mean square error, which must fall below this share
constexpr double out_of_class_bic = 30.0;  // well beyond it
constexpr double worthwhile_bic = 2.0;     // gain of BIC that an effect must bring
constexpr std::size_t most_refits = 6;
// An effect is refitted if its searched start is within this share and margin of the least chi2 of the
// search.
constexpr double searched_share = 1.5, searched_margin = 60.0;
constexpr double starts_tried = 10.0;  // an effect, by which the p of its refit is multiplied
// A refit gains about z^2 of chi2, more where the model bends (thresholds): effects whose z^2 is below this
// share of the best gain cannot lead and are not refitted.
constexpr double refit_share = 0.4;
constexpr double near_significance = 0.05;
// of the logarithm of a number that an effect moves, at the start of its refit
constexpr double most_ratio = 0.7;
// Of the excess of chi2 over the degrees of freedom: where a refit takes more, no other minimum can be much
// better.
constexpr double nearly_all = 0.95;

/// The first settings moved by so much (their coordinates), within their bounds; ratios at most by
/// `most_ratio`.
std::vector<Setting> moved(const Model& model, std::vector<Setting> settings, const Eigen::VectorXd& shift) {
  for (Eigen::Index k = 0; k < shift.size(); ++k) {
    Setting& s = settings[static_cast<std::size_t>(k)];
    const double most = s.parameter->parametrisation == Parametrisation::shift ? 1e300 : most_ratio;
    s.coordinate = std::clamp(s.coordinate + std::clamp(shift[k], -most, most), model.lower(*s.parameter),
                              model.upper(*s.parameter));
  }
  return settings;
}

/// Those of two settings that leave less: numbers that are hardly told may move far, to first order.
std::vector<Setting> nearer(const Model& model, const Data& data, const std::vector<Setting>& one,
                            const std::vector<Setting>& other) {
  const auto same = [](const Setting& a, const Setting& b) { return a.coordinate == b.coordinate; };
  if (std::equal(one.begin(), one.end(), other.begin(), same)) return one;
  const auto left = [&](const std::vector<Setting>& settings) {
    const Evaluation at = model.evaluate(settings);
    return at.complete ? data.residual(at).squaredNorm() : std::numeric_limits<double>::infinity();
  };
  return left(other) < left(one) ? other : one;
}

/// The numbers with which an effect begins, behind those of a fit.
std::vector<Setting> with(std::vector<Setting> settings, const Effect& effect, const RefitStart& from) {
  for (std::size_t k = 0; k < from.coordinates.size(); ++k) {
    const EffectNumber& number = effect.numbers[k];
    if (number.optional && from.coordinates[k] == 0.0) continue;
    settings.push_back({&number.parameter, from.coordinates[k]});
  }
  return settings;
}

/// The starts of a refit, best first: that of the search, those of the score, and those of the score with the
/// earlier effects at their first trials.
std::vector<std::vector<Setting>> starts_of(const Model& model, const Data& data, const Current& current,
                                            const Candidate& candidate) {
  const Score& score = candidate.score;
  std::vector<std::vector<Setting>> result;
  if (candidate.searched) result.push_back(candidate.searched->settings);
  for (const RefitStart& from : score.starts) {
    const std::vector<Setting> start = with(current.fit.fitted(), *score.effect, from);
    result.push_back(nearer(model, data, start, moved(model, start, from.shift)));
  }
  if (!current.anew.empty() && !score.starts.empty())
    result.push_back(with(current.anew, *score.effect, score.starts.front()));
  return result;
}

/// The model with an effect added, fitted from each start; not usable where none of them gives a fit. A start
/// that removes nearly all of the excess of chi2 ends the search, and a start that does not approach the best
/// chi2 so far is abandoned.
Fit refit(const Model& model, const Data& data, const Current& current, const Candidate& candidate,
          double rival, Progress& progress) {
  Fit best;
  best.chi2 = std::numeric_limits<double>::max();
  best.free = current.fit.free;
  best.report.termination = numerics::Termination::step_too_small;
  double to_beat = rival;
  for (const std::vector<Setting>& start : starts_of(model, data, current, candidate)) {
    FitOptions fitting;
    fitting.max_iterations = 30;
    fitting.tolerance = 1e-4;
    fitting.rival = to_beat;
    fitting.progress = [&](int iteration, double) {
      return progress.go_on(
          fmt::format("refit with {}: iteration {}", candidate.score.effect->name, iteration));
    };
    Fit one = fit(model, data, start, {}, fitting);
    if (one.report.usable() && one.bic() < best.bic()) best = std::move(one);
    if (!best.report.usable()) continue;
    if (current.fit.chi2 - best.chi2 > nearly_all * (current.fit.chi2 - best.dof())) break;
    to_beat = rival > 0.0 ? std::min(rival, best.chi2) : best.chi2;
  }
  return best;
}

/// Whether the refitted numbers of an effect make sense: inside their plausible ranges, and not driven to a
/// bound.
void judge_plausibility(const Model& model, const Fit& current, const Fit& refitted, Candidate& candidate) {
  const Effect& effect = *candidate.score.effect;
  for (std::size_t k = 0; k < candidate.numbers.size(); ++k) {
    const FittedNumber& n = candidate.numbers[k];
    const EffectNumber& range =
        *std::find_if(effect.numbers.begin(), effect.numbers.end(),
                      [&n](const EffectNumber& e) { return e.parameter.key == n.key; });
    const Parameter& p = range.parameter;
    const double coordinate = refitted.settings[current.free + k].coordinate;
    const double width = model.upper(p) - model.lower(p);
    const bool at_lower = coordinate - model.lower(p) < 1e-6 * width;
    const bool at_bound = at_lower || model.upper(p) - coordinate < 1e-6 * width;
    if (n.value < range.plausible_lower || n.value > range.plausible_upper) {
      candidate.plausible = false;
      candidate.why_implausible = fmt::format("{} = {:.4g} {}, plausible is {:g} to {:g}", n.key, n.value,
                                              n.unit, range.plausible_lower, range.plausible_upper);
    } else if (at_bound && !(effect.one_sided && at_lower)) {
      candidate.plausible = false;
      candidate.why_implausible =
          fmt::format("{} = {:.4g} {} is at the end of what it may be", n.key, n.value, n.unit);
    }
  }
}

/// Why what an effect changes is not to be named; empty when it may be.
std::string too_small(const Model& model, const Data& data, const Current& now, const Fit& refitted,
                      double tolerance) {
  const Fit& current = now.fit;
  const double before = fitted_rmse(data, current.evaluation);
  const double after = fitted_rmse(data, refitted.evaluation);
  if (refitted.dof() < fewest_dof(refitted.free)) {
    return fmt::format("{} readings leave {:g} degrees of freedom beside {} numbers, {:g} are needed",
                       data.rows(), refitted.dof(), refitted.free, fewest_dof(refitted.free));
  }
  double fall = before - after;
  // Noise hides how much of the error falls: the bound of what is left beside it tells.
  if (tolerance > 0.0 && fall <= tolerance && after <= least_fall * before)
    fall = now.left.upper - remainder(model, data, refitted).upper;
  if (tolerance > 0.0 && !worth_a_name(before, after, fall, tolerance)) {
    return fmt::format(
        "it lowers the error by {:.3g} N, which is not worth a name: needed are a tenth and {:.3g} N",
        before - after, tolerance);
  }
  // What is beside the noise must fall by a tenth, as a root mean square.
  const double excess = current.chi2 - current.dof();
  if (current.chi2 - refitted.chi2 < (1.0 - least_fall * least_fall) * excess)
    return "it takes away less than a tenth of what is beside the noise";
  return "";
}

/// What a refit says of an effect: BIC, plausibility, size, and whether held-out series gain by it.
void judge(const Model& model, const Data& data, const HeldOut& heldout, const Current& now,
           const AcceptanceCriteria& demands, std::optional<double> heldout_before, Candidate& candidate,
           const Fit& refitted) {
  const Fit& current = now.fit;
  candidate.refitted = refitted.report.usable();
  if (!candidate.refitted) return;
  candidate.score.unobservable.clear();  // absorbed at null, but not at this size
  candidate.score.absorbed = false;
  candidate.rmse = fitted_rmse(data, refitted.evaluation);
  candidate.delta_bic = refitted.bic() - current.bic();
  const auto added = static_cast<double>(refitted.free - current.free);
  if (added > 0.0 && refitted.chi2 < current.chi2)
    candidate.refit_p = std::min(
        1.0, demands.refits * fisher_tail((current.chi2 - refitted.chi2) / added, added, data.noise.dof));
  const std::vector<FittedNumber> all = numbers_of(model, refitted);
  candidate.numbers.assign(all.begin() + static_cast<std::ptrdiff_t>(current.free), all.end());
  judge_plausibility(model, current, refitted, candidate);
  candidate.why_too_small = too_small(model, data, now, refitted, demands.tolerance);
  if (heldout.empty()) return;
  const std::optional<double> after = heldout.rmse(refitted.settings);
  // At the noise already it need not improve any more.
  const double sigma = data.noise.mean_sigma(model.series());
  candidate.heldout_improves = heldout_before && after && (*after < *heldout_before || *after < 1.1 * sigma);
}

/// |cos| of the angle between the changes of the curves by two effects; 0 where one of them has no direction.
double cosine(const Candidate& a, const Candidate& b) {
  if (a.score.direction.size() == 0 || b.score.direction.size() == 0) return 0.0;
  return std::abs(a.score.direction.dot(b.score.direction));
}

/// Classes: the leading effect with all whose refits are within 6 of its BIC, in units of the variance that
/// it leaves where that is more than the noise's; then the others by their directions, |cos| > 0.95, or as
/// what the base model's numbers do already.
void classify(const Fit& current, double inflation, Round& round, const std::vector<Fit>& fits) {
  std::vector<Candidate>& all = round.candidates;
  std::vector<bool> placed(all.size(), false);
  const auto alike = [](const Candidate& a, const Candidate& b) { return cosine(a, b) > collinear; };
  const auto absorbed = [](const Candidate& c) { return c.score.absorbed; };
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (placed[i]) continue;
    std::vector<std::string> names;
    const bool with_base = absorbed(all[i]);
    if (with_base) {
      for (std::size_t k = 0; k < current.free; ++k) {
        for (const Effect& e : catalogue()) {
          if (e.numbers.front().parameter.key == current.settings[k].parameter->key) names.push_back(e.name);
        }
      }
    }
    for (std::size_t j = i; j < all.size(); ++j) {
      if (placed[j]) continue;
      const bool leader = i == 0 && all[i].refitted && all[i].delta_bic < -worthwhile_bic;
      const bool rival = all[j].refitted && all[j].plausible && j < fits.size() &&
                         all[j].delta_bic - all[i].delta_bic < indistinct_bic * inflation;
      const bool same = j == i || (with_base ? absorbed(all[j])
                                             : !absorbed(all[j]) && (leader ? rival : alike(all[i], all[j])));
      if (!same) continue;
      placed[j] = true;
      all[j].class_index = round.classes.size();
      names.push_back(all[j].score.effect->name);
    }
    round.classes.push_back(names);
  }
}

/// Candidates of the scores, observable ones first, the largest |z| first.
std::vector<Candidate> by_score(std::vector<Score> scores) {
  std::stable_sort(scores.begin(), scores.end(), [](const Score& a, const Score& b) {
    if (a.unobservable.empty() != b.unobservable.empty()) return a.unobservable.empty();
    return a.z * a.z > b.z * b.z;
  });
  std::vector<Candidate> result;
  for (Score& s : scores) {
    Candidate c;
    c.score = std::move(s);
    result.push_back(std::move(c));
  }
  return result;
}

/// An effect that the fitted numbers absorb at null may show at a finite size.
bool worth_a_refit(const Candidate& c) {
  return c.score.unobservable.empty() || c.score.absorbed;
}

/// The least chi2 that an effect promises: that of its search, or the current one less the square of its
/// score.
double promised_chi2(const Candidate& c, const Fit& current) {
  const bool scored = c.score.unobservable.empty();
  const double by_score = current.chi2 - (scored ? c.score.z * c.score.z : 0.0);
  if (!c.searched) return scored ? by_score : std::numeric_limits<double>::max();
  return std::min(by_score, c.searched->chi2);
}

/// Searches the start of every effect that these data may show, and sorts the effects by the chi2 that they
/// promise; the likeliest come first, so that the others are abandoned early.
void search_starts(const Model& model, const Data& data, const Current& current,
                   std::vector<Candidate>& candidates, Progress& progress) {
  const StartSearch search(model, data, current.fit);
  double least = current.fit.chi2;
  for (Candidate& c : candidates) {
    if (!worth_a_refit(c)) continue;
    c.searched = search.best(*c.score.effect, searched_share * least + searched_margin, progress);
    if (c.searched) least = std::min(least, c.searched->chi2);
  }
  std::stable_sort(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    return promised_chi2(a, current.fit) < promised_chi2(b, current.fit);
  });
}

/// Whether an effect that changes the curves in the same way has been refitted and did not come near the
/// best.
bool as_one_that_lost(const std::vector<Candidate>& candidates, const std::vector<Fit>& fits,
                      std::size_t which, double worst) {
  for (std::size_t k = 0; k < which; ++k) {
    const bool lost = candidates[k].refitted && fits[k].chi2 >= worst;
    if (lost && cosine(candidates[k], candidates[which]) > same_direction) return true;
  }
  return false;
}

/// Refits the significant ones and what is nearly in their direction. One fit a candidate, empty where there
/// was none.
std::vector<Fit> refit_best(const Model& model, const Data& data, const HeldOut& heldout,
                            const Current& current, const AcceptanceCriteria& demands,
                            std::vector<Candidate>& candidates, const std::string& round,
                            Progress& progress) {
  std::vector<Fit> fits(candidates.size());
  const std::optional<double> before = heldout.rmse(current.fit.settings);
  double least = current.fit.chi2;
  for (const Candidate& c : candidates) {
    if (current.search && worth_a_refit(c)) least = std::min(least, promised_chi2(c, current.fit));
  }
  std::size_t refits = 0;
  double best_gain = 0.0;
  for (std::size_t i = 0; i < candidates.size() && refits < most_refits; ++i) {
    Candidate& c = candidates[i];
    if (!worth_a_refit(c)) continue;
    const bool by_score = c.score.unobservable.empty() && c.score.adjusted_p <= near_significance &&
                          (refits == 0 || c.score.z * c.score.z >= refit_share * best_gain - 10.0);
    const bool by_search = c.searched && c.searched->chi2 < current.fit.chi2 - out_of_class_bic &&
                           c.searched->chi2 < searched_share * least + searched_margin;
    if (!by_score && !by_search) continue;
    // What cannot come near the best so far is not followed to its own bottom.
    const double rival = best_gain > 0.0 ? current.fit.chi2 - best_gain + out_of_class_bic : 0.0;
    if (rival > 0.0 && as_one_that_lost(candidates, fits, i, rival)) continue;
    if (!progress.go_on(round + ": refit with " + c.score.effect->name)) break;
    fits[i] = refit(model, data, current, c, rival, progress);
    judge(model, data, heldout, current, demands, before, c, fits[i]);
    if (c.refitted && c.plausible) best_gain = std::max(best_gain, current.fit.chi2 - fits[i].chi2);
    ++refits;
  }
  return fits;
}

/// Refits what has not been refitted and is so near the leader in direction that the scores cannot tell it
/// from it.
void refit_rivals(const Model& model, const Data& data, const HeldOut& heldout, const Current& current,
                  const AcceptanceCriteria& demands, std::vector<Candidate>& candidates,
                  std::vector<Fit>& fits, const std::string& round, Progress& progress) {
  const Candidate& leader = candidates.front();
  if (!leader.refitted || leader.score.direction.size() == 0) return;
  const double gain = current.fit.chi2 - fits.front().chi2;
  const std::optional<double> before = heldout.rmse(current.fit.settings);
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    Candidate& c = candidates[i];
    if (c.refitted || fits[i].free > 0 || !c.score.unobservable.empty() || c.score.direction.size() == 0)
      continue;
    const double cosine = c.score.direction.dot(leader.score.direction);
    if (gain * (1.0 - cosine * cosine) > separable_chi2) continue;
    if (!progress.go_on(round + ": refit with " + c.score.effect->name)) break;
    fits[i] = refit(model, data, current, c, current.fit.chi2 - gain + out_of_class_bic, progress);
    judge(model, data, heldout, current, demands, before, c, fits[i]);
  }
}

/// P of the effect: of its score at null, and of its refit where the starts were searched, whichever is less.
double p_of(const Candidate& c) {
  return c.searched ? std::min(c.score.adjusted_p, c.refit_p) : c.score.adjusted_p;
}

/// May be added to the model.
bool eligible(const Candidate& c, double significance) {
  return c.refitted && c.plausible && c.why_too_small.empty() && p_of(c) < significance &&
         c.delta_bic < -worthwhile_bic && c.heldout_improves.value_or(true);
}

/// Eligible first, by BIC; then the other refitted ones; then by score as they stand. Fits along with them.
void rank(std::vector<Candidate>& candidates, std::vector<Fit>& fits, double significance) {
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const Candidate& x = candidates[a];
    const Candidate& y = candidates[b];
    if (eligible(x, significance) != eligible(y, significance)) return eligible(x, significance);
    if (x.refitted != y.refitted) return x.refitted;
    return x.refitted && x.delta_bic < y.delta_bic;
  });
  std::vector<Candidate> ranked;
  std::vector<Fit> ranked_fits;
  for (const std::size_t i : order) {
    ranked.push_back(std::move(candidates[i]));
    ranked_fits.push_back(std::move(fits[i]));
  }
  candidates = std::move(ranked);
  fits = std::move(ranked_fits);
}

/// Adds the first candidate: its refit to the bottom.
void add_first(const Model& model, const Data& data, const std::vector<Fit>& fits, RoundFits& result) {
  Round& round = result.round;
  const Candidate& first = round.candidates.front();
  round.added = first.score.effect->name;
  round.reason = fmt::format("it has p = {:.2g} (all effects counted), the refit lowers BIC by {:.4g}",
                             p_of(first), -first.delta_bic);
  if (first.score.effect->trials != nullptr && !first.score.starts.empty())
    result.begun = with({}, *first.score.effect, first.score.starts.front());
  result.better = fits.front();
  const Fit polished = fit(model, data, result.better.fitted());
  if (polished.report.usable() && polished.chi2 <= result.better.chi2) result.better = polished;
}

/// The refits that make sense: those of the first one's class, then all others.
void keep_rivals(const std::vector<Fit>& fits, RoundFits& result) {
  const std::vector<Candidate>& candidates = result.round.candidates;
  if (candidates.empty()) return;
  const auto in_class = [&](const Candidate& c) { return c.class_index == candidates.front().class_index; };
  for (const bool members : {true, false}) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const Candidate& c = candidates[i];
      if (in_class(c) != members || !c.refitted || !c.plausible) continue;
      result.rivals.push_back(fits[i]);
      result.rivals.back().evaluation = {};
      result.rival_names.push_back(c.score.effect->name);
    }
  }
}

/// Of the best refits in their order; one that could not come near the leader ended before its own bottom.
std::vector<RefitCurves> best_curves(const Data& data, const std::vector<Candidate>& candidates,
                                     const std::vector<Fit>& fits) {
  constexpr std::size_t most = 4;
  std::vector<RefitCurves> result;
  for (std::size_t i = 0; i < candidates.size() && result.size() < most; ++i) {
    if (!candidates[i].refitted) continue;
    RefitCurves& one = result.emplace_back(RefitCurves{candidates[i].score.effect->name, {}});
    for (const std::size_t k : data.series) {
      const Eigen::VectorXd& f = fits[i].evaluation.force[k];
      one.force.emplace_back(f.data(), f.data() + f.size());
    }
  }
  return result;
}

}  // namespace

double fewest_dof(std::size_t numbers) {
  return std::max(5.0, 2.0 * static_cast<double>(numbers));
}

RoundFits look_for_effect(const Model& model, const Data& data, const HeldOut& heldout,
                          const Current& current, std::size_t number, const AcceptanceCriteria& asked,
                          Progress& progress) {
  AcceptanceCriteria demands = asked;
  const double significance = demands.significance;
  const std::string name = fmt::format("round {}", number);
  RoundFits result;
  Round& round = result.round;
  round.candidates = by_score(score_effects(model, data, current.fit, significance));
  progress.clock(name + ": scores");
  if (current.search) {
    search_starts(model, data, current, round.candidates, progress);
    demands.refits =
        starts_tried * static_cast<double>(std::ranges::count_if(round.candidates, worth_a_refit));
    progress.clock(name + ": where effects may begin");
  }
  std::vector<Fit> fits =
      refit_best(model, data, heldout, current, demands, round.candidates, name, progress);
  rank(round.candidates, fits, significance);
  double inflation = 1.0;
  if (!round.candidates.empty() && round.candidates.front().refitted) {
    refit_rivals(model, data, heldout, current, demands, round.candidates, fits, name, progress);
    rank(round.candidates, fits, significance);
    inflation = remainder(model, data, fits.front()).inflation();
  }
  progress.clock(name + ": refits");
  classify(current.fit, inflation, round, fits);
  round.curves = best_curves(data, round.candidates, fits);
  keep_rivals(fits, result);
  if (!round.candidates.empty() && eligible(round.candidates.front(), significance)) {
    add_first(model, data, fits, result);
    return result;
  }
  const bool any = std::any_of(round.candidates.begin(), round.candidates.end(), [&](const Candidate& c) {
    return worth_a_refit(c) && p_of(c) < significance;
  });
  round.reason =
      any ? "the significant effects do not survive the refit (BIC, plausible values, size, held-out series)"
          : "no effect of the catalogue is significant";
  return result;
}

}  // namespace snare::identification
