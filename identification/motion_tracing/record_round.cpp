#include "identification/motion_tracing/record_round.hpp"

#include "identification/motion_tracing/record_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

namespace snare::identification {

namespace {

constexpr std::size_t most_refits = 5;  // of effects that come out within their physical range
// with those that do not: what is missing may be hidden behind many that imitate it in part
constexpr std::size_t most_tried = 15;
constexpr double promising = 0.3;  // of the best promise: what falls less is not refitted
// of the motion, as roots of sums of squares: a fit that leaves it is out of step
constexpr double good_part = 0.2;
constexpr double least_fall = 1e-4;    // share of the misfit below which a refit has not moved
constexpr int enough_iterations = 12;  // to compare effects; the one that is named is fitted to the end
constexpr double apart = 2.0;  // deviates by which the misfits of two refits must differ to be told apart

/// The model with the numbers of an effect beside those that are fitted. From null the first step moves both
/// as they belong together.
RecordFit refit(const RoundInput& in, const RecordScore& score) {
  const RecordEffect& effect = in.effects[score.effect];
  const auto from = [&](const std::function<double(std::size_t)>& value, bool at_null) {
    std::vector<RecordSetting> start = in.current.settings;
    for (std::size_t k = 0; k < score.numbers.size(); ++k) {
      RecordNumber number = effect.numbers[score.numbers[k]];
      number.scale = score.scale[k];
      start.push_back({number, value(k)});
    }
    RecordFitOptions options;
    options.progress = in.progress;
    options.max_iterations = enough_iterations;
    options.derivatives = FitDerivatives::search;
    if (at_null) {  // the derivatives are known there: those of the fit and of the score
      options.first_jacobian.resize(in.data.rows, in.current.jacobian.cols() + score.whole.cols());
      options.first_jacobian << in.current.jacobian, score.whole;
    }
    return fit_motion(in.model, in.data, start, options);
  };
  RecordFit fit = from([&](std::size_t k) { return effect.numbers[score.numbers[k]].declared; }, true);
  if (fit.chi2 < (1.0 - least_fall) * in.current.chi2 || in.model.stopped()) return fit;
  // Nothing shows next to null: begin where the score points.
  RecordFit again = from([&](std::size_t k) { return score.start[k]; }, false);
  return again.chi2 < fit.chi2 ? again : fit;
}

/// Effects that do the same to these records leave the same misfit but for the accuracy of the integration;
/// then the order of the catalogue decides.
constexpr double the_same = 1e-4;

/// Bayesian criterion of prewhitened residuals, up to what all models share.
double bic(const RecordData& data, const ColouredNoise& noise, const RecordFit& fit) {
  return whitened(data, noise, fit.residual).squaredNorm() +
         static_cast<double>(fit.settings.size()) * std::log(static_cast<double>(data.rows));
}

/// A refit, and what noise alone would have taken of its misfit by as many numbers.
struct Refit {
  RecordFit fit;
  double chance = 0.0;  ///< in the mean
  double readings = 1.0;
  Eigen::VectorXd heldout;  ///< residual of the records held out, where they were asked

  /// To choose by: as in the Bayesian criterion a number must take log n times what it takes by chance.
  [[nodiscard]] double criterion() const {
    return fit.chi2 + heldout.squaredNorm() + chance * std::log(readings);
  }
  /// To compare with: without what chance has taken.
  [[nodiscard]] double misfit() const { return fit.chi2 + heldout.squaredNorm() + chance; }
};

/// Whether a refit is worse than the best beyond what noise does to the difference e of their residuals: the
/// misfit of the worse is larger by |e|^2 + 2 e'r, of standard deviation 2 s, s = |Sigma^(1/2)' e|. Refits
/// that are the same have e = 0 but for round-off.
bool is_worse(const Refit& best, const Refit& other, double s) {
  constexpr double round_off = 1e-9;
  return other.misfit() - best.misfit() > apart * 2.0 * s + round_off * best.misfit();
}

/// Whether the records tell two refits apart.
bool told_apart(const RecordData& data, const ColouredNoise& noise, const Refit& best, const Refit& other) {
  return is_worse(best, other, coloured(data, noise, other.fit.residual - best.fit.residual).norm());
}

/// Among refits that the fitted records do not tell apart (indices, the best first) the records held out
/// choose, too: what both together do not tell apart, the best of both first. `of` are the effects' places in
/// the catalogue, which decides between those that do the same.
std::vector<std::size_t> settle(const RoundInput& in, const ColouredNoise& noise, std::vector<Refit>& fits,
                                const std::vector<std::size_t>& of, std::vector<std::size_t> members) {
  for (const std::size_t k : members) fits[k].heldout = in.heldout(fits[k].fit);
  std::erase_if(members, [&](std::size_t k) { return fits[k].heldout.size() == 0; });
  if (members.empty()) return members;
  std::stable_sort(members.begin(), members.end(),
                   [&](std::size_t a, std::size_t b) { return fits[a].criterion() < fits[b].criterion(); });
  for (std::size_t k = 1; k < members.size(); ++k)
    if (fits[members[k]].criterion() <= (1.0 + the_same) * fits[members[0]].criterion() &&
        of[members[k]] < of[members[0]])
      std::swap(members[0], members[k]);
  const Refit& best = fits[members[0]];
  const ColouredNoise there = coloured_noise(*in.heldout_data, best.heldout);
  std::erase_if(members, [&](std::size_t k) {
    const double here = coloured(in.data, noise, fits[k].fit.residual - best.fit.residual).norm();
    const double beside = coloured(*in.heldout_data, there, fits[k].heldout - best.heldout).norm();
    return is_worse(best, fits[k], std::hypot(here, beside));
  });
  return members;
}

/// Why an effect that is significant is not named.
std::string objection(const RoundInput& in, const RecordCandidate& c, const RecordFit& fit) {
  const RecordEffect& effect = in.effects[c.score.effect];
  const double value = c.settings.front().value;
  if (!c.plausible)
    return fmt::format("{} = {:.5g} {} is outside {:.5g} to {:.5g}, the physical range",
                       c.numbers.front().key, value, c.numbers.front().unit, effect.plausible_lower,
                       effect.plausible_upper);
  bool large = false;
  for (const ResidualPiece& p : in.data.pieces) {
    const std::string& sensor = in.data.set->records[p.record].channels[p.channel].sensor;
    const double fall = in.current.residual.segment(p.begin, p.size).squaredNorm() -
                        fit.residual.segment(p.begin, p.size).squaredNorm();
    const double error = std::sqrt(std::max(0.0, fall) / static_cast<double>(p.size)) * p.scale;
    large = large || error > in.tolerance.at(sensor);
  }
  if (!large) return "what it changes is too small to be worth a name";
  return "";
}

}  // namespace

bool out_of_step(const RecordData& data, const RecordFit& fit) {
  const Eigen::VectorXd readings = data.signal(fit.predictions) + fit.residual;
  double moves = 0.0;
  for (const ResidualPiece& p : data.pieces) {
    const auto own = readings.segment(p.begin, p.size).array();
    moves += (own - own.mean()).square().sum();
  }
  return fit.residual.squaredNorm() > good_part * good_part * moves;
}

namespace {

/// A round of effects: scored, refitted, put in order, and one of them named.
class EffectRound {
 public:
  explicit EffectRound(const RoundInput& in)
      : in_(in), all_(out_of_step(in.data, in.current)), scores_(score_the_rest()) {
    present_ = bic(in.data, scores_.noise, in.current);
  }

  RoundResult named() {
    if (candidates().empty() || !significant(candidates().front())) {
      result_.round.reason = "no effect of the catalogue is significant";
      return std::move(result_);
    }
    fits_.resize(candidates().size());
    if (!refit_the_promising() || (all_ && !fit_the_best_further())) return std::move(result_);
    put_in_order();
    if (const RecordCandidate& best = candidates().front(); !may_be_named(0)) {
      result_.round.reason = best.refitted
                                 ? fmt::format("{}: {}", in_.effects[best.score.effect].label(), best.why_not)
                                 : "no effect could be fitted";
      return std::move(result_);
    }
    const auto [members, several] = members_of_the_best();
    name(members, several);
    fit_to_the_end();
    return std::move(result_);
  }

 private:
  std::vector<RecordCandidate>& candidates() { return result_.round.candidates; }
  [[nodiscard]] bool significant(const RecordCandidate& c) const {
    return c.score.unobservable.empty() && c.score.adjusted_p < in_.significance;
  }
  [[nodiscard]] bool may_be_named(std::size_t k) {
    return candidates()[k].refitted && candidates()[k].why_not.empty();
  }

  /// Scores of the effects that are not selected; the candidates, the most promising first.
  RecordScores score_the_rest() {
    std::vector<RecordEffect> asked;
    std::vector<std::size_t> index;
    for (std::size_t e = 0; e < in_.effects.size(); ++e) {
      if (std::ranges::find(in_.selected, e) != in_.selected.end()) continue;
      asked.push_back(in_.effects[e]);
      index.push_back(e);
    }
    RecordScores scores = score_motion(in_.model, in_.data, in_.current, {}, asked, in_.significance);
    for (RecordScore& score : scores.scores) {
      score.effect = index[score.effect];
      candidates().emplace_back().score = std::move(score);
    }
    std::ranges::stable_sort(candidates(), [&](const RecordCandidate& a, const RecordCandidate& b) {
      if (significant(a) != significant(b)) return significant(a);
      return significant(a) ? a.score.fall > b.score.fall : a.score.p < b.score.p;
    });
    return scores;
  }

  void take(std::size_t k, RecordFit found) {
    RecordCandidate& c = candidates()[k];
    const RecordFit& fit = fits_[k].fit = std::move(found);
    if (fit.residual.size() == 0 || fit.covariance.size() == 0) return;
    c.refitted = true;
    fits_[k].chance = c.score.chance;
    fits_[k].readings = static_cast<double>(in_.data.rows);
    const std::vector<TracedNumber> numbers = traced_numbers(in_.model, fit);
    const auto own = static_cast<std::ptrdiff_t>(in_.current.settings.size());  // behind those of the fit
    c.numbers.assign(numbers.begin() + own, numbers.end());
    c.settings.assign(fit.settings.begin() + own, fit.settings.end());
    c.rmse = record_stage(in_.model, in_.data, fit, nullptr, {}).rmse;
    c.delta_bic = bic(in_.data, scores_.noise, fit) - present_;
    const RecordEffect& effect = in_.effects[c.score.effect];
    const double value = c.settings.front().value;
    c.plausible = value >= effect.plausible_lower && value <= effect.plausible_upper;
    c.why_not = objection(in_, c, fit);
  }

  /// Of a fit that is out of step all are refitted that are significant. False: stopped.
  bool refit_the_promising() {
    const double promise = candidates().front().score.fall;
    std::size_t plausible = 0;
    for (std::size_t k = 0; k < candidates().size() && (all_ || (k < most_tried && plausible < most_refits));
         ++k) {
      const RecordCandidate& c = candidates()[k];
      if (!significant(c) || (!all_ && plausible > 0 && c.score.fall < promising * promise)) break;
      if (in_.model.stopped()) return false;
      take(k, refit(in_, c.score));
      if (c.refitted && c.plausible) ++plausible;
    }
    return true;
  }

  /// The way may be long: the best are compared where it ends. False: stopped.
  bool fit_the_best_further() {
    std::vector<std::size_t> best;
    for (std::size_t k = 0; k < candidates().size(); ++k)
      if (candidates()[k].refitted && candidates()[k].plausible) best.push_back(k);
    std::ranges::sort(best, {}, [&](std::size_t k) { return fits_[k].criterion(); });
    best.resize(std::min(best.size(), most_refits));
    for (const std::size_t k : best) {
      if (in_.model.stopped()) return false;
      RecordFitOptions options;
      options.progress = in_.progress;
      options.derivatives = FitDerivatives::search;
      options.first_jacobian = fits_[k].fit.jacobian;
      RecordFit further = fit_motion(in_.model, in_.data, fits_[k].fit.settings, options);
      if (further.chi2 < fits_[k].fit.chi2) take(k, std::move(further));
    }
    return true;
  }

  /// Refitted ones by their misfit, those that may be named first.
  void put_in_order() {
    std::vector<std::size_t> order(candidates().size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
      const RecordCandidate &x = candidates()[a], &y = candidates()[b];
      if (x.refitted != y.refitted) return x.refitted;
      if (!x.refitted) return false;
      if (x.why_not.empty() != y.why_not.empty()) return x.why_not.empty();
      return fits_[a].criterion() < fits_[b].criterion();
    });
    for (std::size_t k = 1; k < order.size() && may_be_named(order[k]); ++k)
      if (fits_[order[k]].criterion() <= (1.0 + the_same) * fits_[order[0]].criterion() &&
          candidates()[order[k]].score.effect < candidates()[order[0]].score.effect)
        std::swap(order[0], order[k]);
    std::vector<RecordCandidate> sorted;
    std::vector<Refit> sorted_fits;
    for (const std::size_t k : order) {
      sorted.push_back(std::move(candidates()[k]));
      sorted_fits.push_back(std::move(fits_[k]));
    }
    candidates() = std::move(sorted);
    fits_ = std::move(sorted_fits);
  }

  /// Those that the records do not tell from the best, and whether the fitted records left several.
  std::pair<std::vector<std::size_t>, bool> members_of_the_best() {
    std::vector<std::size_t> members{0}, of;
    for (std::size_t k = 0; k < candidates().size(); ++k) {
      of.push_back(candidates()[k].score.effect);
      if (k > 0 && may_be_named(k) && !told_apart(in_.data, scores_.noise, fits_.front(), fits_[k]))
        members.push_back(k);
    }
    const bool several = members.size() > 1;
    if (in_.heldout && several) {
      const std::vector<std::size_t> settled = settle(in_, scores_.noise, fits_, of, members);
      for (const std::size_t k : members)
        if (fits_[k].heldout.size() > 0)
          candidates()[k].heldout_improves = fits_[k].heldout.squaredNorm() < in_.heldout_now;
      if (!settled.empty()) members = settled;
    }
    return {members, several};
  }

  /// Names the first of a class and puts it before all others.
  void name(const std::vector<std::size_t>& members, bool several) {
    RecordRound& round = result_.round;
    round.classes.emplace_back();
    for (const std::size_t k : members)
      round.classes.front().push_back(in_.effects[candidates()[k].score.effect].label());
    for (std::size_t k = 0; k < candidates().size(); ++k) {
      RecordCandidate& c = candidates()[k];
      const bool same = std::ranges::find(members, k) != members.end();
      c.class_index = same ? 0 : round.classes.size();
      if (!same) round.classes.push_back({in_.effects[c.score.effect].label()});
    }
    round.added = round.classes.front().front();
    round.reason = members.size() > 1 ? "best of a class that these records cannot tell apart"
                   : several ? "the records held out tell it from others that do as well in those fitted"
                             : "explains most, and nothing else does as well";
    const auto chosen = static_cast<std::ptrdiff_t>(members.front());
    std::rotate(candidates().begin(), candidates().begin() + chosen, candidates().begin() + chosen + 1);
    std::rotate(fits_.begin(), fits_.begin() + chosen, fits_.begin() + chosen + 1);
    result_.added = candidates().front().score.effect;
    result_.better = std::move(fits_.front().fit);
  }

  /// And with the derivatives of its place.
  void fit_to_the_end() {
    if (in_.model.stopped()) return;
    RecordFitOptions options;
    options.progress = in_.progress;
    options.first_jacobian = result_.better.jacobian;
    RecordFit fit = fit_motion(in_.model, in_.data, result_.better.settings, options);
    if (fit.chi2 <= result_.better.chi2) result_.better = std::move(fit);
  }

  const RoundInput& in_;
  bool all_;  // the fit is out of step: every effect that is significant is refitted
  RoundResult result_;
  RecordScores scores_;
  std::vector<Refit> fits_;
  double present_ = 0.0;  // criterion of the model without any of them
};

}  // namespace

RoundResult record_round(const RoundInput& in) {
  return EffectRound(in).named();
}

}  // namespace snare::identification
