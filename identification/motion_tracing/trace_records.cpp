#include "identification/motion_tracing/trace_records.hpp"

#include "identification/fitting/statistics.hpp"
#include "identification/motion_tracing/model_family.hpp"
#include "identification/motion_tracing/record_beginnings.hpp"
#include "identification/motion_tracing/record_findings.hpp"
#include "identification/motion_tracing/record_round.hpp"
#include "identification/motion_tracing/record_stage.hpp"
#include "identification/records/record_rank.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

constexpr double usual_share = 0.01;  // of a channel's rms less its mean: an error below is called no error
constexpr double like_noise = 0.002;  // p below which a residual is none
constexpr int most_reweighings = 3;
constexpr int most_restarts = 3;  // of a fit that is near a lower chi2

/// Everything that is kept along the way.
class Tracer {
 public:
  Tracer(const RecordSet& set, const RecordTraceOptions& options)
      : set_(set),
        options_(options),
        model_(set, [this] { return stop_ || (options_.stop && options_.stop()); }),
        fitted_(set.used(false)),
        heldout_(set.used(true)) {}

  RecordTrace run() {
    weigh(first_scales(set_, fitted_));
    if (!go_on("declared model")) return end("interrupted before the declared model was simulated");
    RecordFitOptions look;
    look.derivatives = FitDerivatives::last;
    look.progress = asked();
    // The numbers of every record for itself are no part of the model: also the declared one has its own.
    std::vector<RecordSetting> own, shared;
    for (const RecordSetting& s : model_.free_settings(fitted_))
      (s.number.record ? own : shared).push_back(s);
    look.fixed = shared;
    const RecordFit declared = fit_motion(model_, data_, own, look);
    if (!declared.report.usable()) return end(declared.report.message);
    trace_.findings = channel_findings(data_, {&declared.predictions});
    if (!go_on("base fit")) return end("interrupted before the base fit was finished");
    current_ = base_fit();
    settle();
    base_settings_ = current_.settings;
    trace_.fit_simulations = current_.simulations;
    trace_.fit_iterations = current_.iterations;
    if (!current_.report.usable()) return end(current_.report.message);
    trace_.declared = stage(declared, shared);
    trace_.base = trace_.final = stage(current_, {});
    tell_noise();
    trace_.simulations = model_.simulations();
    reached();
    trace_.kind = trace_.significant ? VerdictKind::not_explained : VerdictKind::nothing_missing;
    trace_.share_left = trace_.significant ? 1.0 : 0.0;
    if (options_.effects && (trace_.significant || large(trace_.base))) look_for_effects();
    find_findings();
    profile();
    families();
    warn();
    trace_.simulations = model_.simulations();
    for (const ModelFamily& f : trace_.families) trace_.simulations += f.simulations;
    trace_.interrupted = stop_;
    return std::move(trace_);
  }

 private:
  bool go_on(const std::string& what) {
    if (options_.progress && !options_.progress(what)) stop_ = true;
    return !stop_;
  }
  [[nodiscard]] std::function<bool(int, double)> asked() {
    return [this](int iteration, double chi2) {
      return go_on(fmt::format("iteration {}, misfit {:.5g}", iteration, chi2));
    };
  }
  /// Signs and units of the readings, and what is remarkable about the numbers of the final model.
  void find_findings() {
    for (Finding& f : channel_findings(data_, {&current_.predictions})) {
      if (std::ranges::find(trace_.findings, f.key, &Finding::key) == trace_.findings.end())
        trace_.findings.push_back(std::move(f));
    }
    for (Finding& f : number_findings(trace_.final, base_settings_)) trace_.findings.push_back(std::move(f));
    for (const Finding& f : trace_.findings) trace_.warnings.push_back(f.what);
    if (trace_.kind == VerdictKind::nothing_missing && !trace_.final.open.empty())
      trace_.kind = VerdictKind::cannot_tell;
  }
  /// Profiles of the numbers for which they are asked, in the final model.
  void profile() {
    for (const FreeNumber& f : set_.free) {
      for (std::size_t k = 0; f.profile && k < current_.settings.size(); ++k) {
        const RecordNumber& number = current_.settings[k].number;
        if (number.key != f.key && !(number.record && number.key.ends_with("." + f.key))) continue;
        if (!go_on("profile of " + number.key)) return;
        RecordFitOptions options;
        options.progress = asked();
        Profile found = profile_of(model_, data_, current_, k, options);
        if (stop_) return;  // half a profile is none
        trace_.profiles.push_back(std::move(found));
      }
    }
    // of a deviate squared: no interval moves by a twentieth of its width
    constexpr double worth_a_word = 0.1;
    for (const Profile& p : trace_.profiles) {
      if (p.fall > worth_a_word)
        trace_.warnings.push_back(fmt::format(
            "the profile of {} meets a sum of squares that is lower than that of the fit: begin from "
            "other values",
            p.key));
      for (const bool upper : {false, true})
        if ((upper ? p.upper : p.lower).end == ProfileEnd::open)
          trace_.warnings.push_back(fmt::format(
              "{} has no {} limit of 95 %: its profile stays below that to {:.4g} {}", p.key,
              upper ? "upper" : "lower", (upper ? p.points.back() : p.points.front()).value, p.unit));
    }
  }
  /// What other kinds of models take the numbers of the base for.
  void families() {
    if (set_.families.empty() || !go_on("families")) return;
    trace_.families = fit_families(set_, scales_, base_settings_, asked());
    for (std::string& told : family_differences(trace_.base.numbers, trace_.families))
      trace_.warnings.push_back(std::move(told));
  }
  /// Records that are too short, and numbers of the file that they do not show.
  void warn() {
    const std::optional<SlowMode>& slow = model_.slowest();
    for (const std::size_t r : fitted_) {
      const Record& record = set_.records[r];
      const double length = record.times[record.times.size() - 1] - record.times[0];
      if (slow && length < slow->period)
        trace_.warnings.push_back(fmt::format(
            "record {} lasts {:.4g} s, less than the slowest period of the declared scenario, {:.4g} s "
            "({}): it shows what belongs "
            "to that in part only",
            record.name, length, slow->period, slow->of));
    }
    if (const auto lower = lower_minimum(model_, current_, set_.method)) trace_.warnings.push_back(*lower);
    for (const TracedNumber& n : trace_.final.numbers) {
      const bool of_file = std::any_of(set_.free.begin(), set_.free.end(), [&](const FreeNumber& f) {
        return f.key == n.key && !(f.lower && *f.lower < 0.0);
      });
      if (!of_file || !(model_.declared().number(n.key).value_or(0.0) > 0.0)) continue;
      if (n.identified && half_width_95 * n.stderr_ >= std::abs(n.value))
        trace_.warnings.push_back(fmt::format(
            "{} is not identifiable from these records: {:.4g} with a standard error of {:.4g} {}", n.key,
            n.value, n.stderr_, n.unit));
    }
  }
  void reached() {
    if (!options_.reached) return;
    RecordTrace part = trace_;
    part.interrupted = true;
    options_.reached(part);
  }
  void weigh(const ChannelScales& scales) {
    scales_ = scales;
    data_ = record_data(set_, fitted_, scales);
    heldout_data_ = record_data(set_, heldout_, scales);
  }
  RecordTrace end(std::string why) {
    for (const Finding& f : trace_.findings) why += "; " + f.what;
    trace_.interrupted = stop_;
    static_cast<void>(trace_.report.end(
        stop_ ? numerics::Termination::interrupted : numerics::Termination::step_too_small, why));
    trace_.simulations = model_.simulations();
    return std::move(trace_);
  }

  /// Least squares with the channels weighed by what they leave, where their noise is not declared and there
  /// are several.
  RecordFit base_fit() {
    RecordFitOptions options;
    options.method = set_.method;
    options.simplex_change = set_.simplex_change;
    options.progress = asked();
    RecordFit fit = fit_motion(model_, data_, model_.free_settings(fitted_), options);
    if (fit.report.usable() && !fit.settings.empty() && options.method == FitMethod::gauss_newton &&
        out_of_step(data_, fit) && !stop_) {
      RecordFit grown = fit_from_beginnings(model_, data_, model_.free_settings(fitted_), options);
      grown.simulations += fit.simulations;
      if (grown.report.usable() && grown.chi2 < fit.chi2) fit = std::move(grown);
    }
    std::map<std::string, bool> undeclared;
    for (const ResidualPiece& p : data_.pieces) {
      const RecordChannel& c = set_.records[p.record].channels[p.channel];
      undeclared[c.sensor] = !c.sigma;
    }
    const bool several = undeclared.size() > 1 && std::any_of(undeclared.begin(), undeclared.end(),
                                                              [](const auto& u) { return u.second; });
    for (int k = 0; several && k < most_reweighings && fit.report.usable(); ++k) {
      ChannelScales scales;
      std::map<std::string, double> count;
      for (const ResidualPiece& p : data_.pieces) {
        const std::string& sensor = set_.records[p.record].channels[p.channel].sensor;
        scales[sensor] += fit.residual.segment(p.begin, p.size).squaredNorm() * p.scale * p.scale;
        count[sensor] += static_cast<double>(p.size);
      }
      for (auto& [sensor, scale] : scales)
        scale = std::max(std::sqrt(scale / count[sensor]), std::max(1e-300, reading_sigma(set_, sensor)));
      weigh(scales);
      const long before = fit.simulations;
      fit = fit_motion(model_, data_, fit.settings, options);
      fit.simulations += before;
    }
    return fit;
  }

  /// Asks which numbers of the present model the records determine. Where chi2 is lower near its answer a fit
  /// has not ended and continues from there, except a simplex, which ends early where the file asks for it.
  void settle() {
    for (int k = 0;; ++k) {
      find_rank(model_, data_, current_);
      if (current_.lower.empty() || set_.method != FitMethod::gauss_newton || k == most_restarts) return;
      RecordFitOptions options;
      options.progress = asked();
      RecordFit lower = fit_motion(model_, data_, current_.lower, options);
      if (!lower.report.usable() || lower.chi2 >= current_.chi2) return;
      lower.simulations += current_.simulations;
      current_ = std::move(lower);
    }
  }

  /// A fitted model on the held-out records: what belongs to a record is fitted there, the rest stays.
  std::optional<RecordFit> on_heldout(const RecordFit& fit, const std::vector<RecordSetting>& fixed) {
    if (heldout_.empty()) return std::nullopt;
    RecordFitOptions options;
    options.derivatives = FitDerivatives::last;
    options.progress = asked();
    for (const RecordSetting& s : together(fit.settings, fixed))
      if (!s.number.record) options.fixed.push_back(s);
    // From where the first model has led them: the same starts for all others.
    options.first_jacobian = heldout_jacobian_;
    if (heldout_starts_) return fit_motion(model_, heldout_data_, *heldout_starts_, options);
    std::vector<RecordSetting> own;
    for (const RecordSetting& s : model_.free_settings(heldout_))
      if (s.number.record) own.push_back(s);
    RecordFit fitted = fit_motion(model_, heldout_data_, own, options);
    if (fitted.report.usable()) {
      heldout_starts_ = fitted.settings;
      heldout_jacobian_ = fitted.jacobian;
    }
    return fitted;
  }

  RecordStage stage(const RecordFit& fit, const std::vector<RecordSetting>& fixed) {
    const std::optional<RecordFit> heldout = on_heldout(fit, fixed);
    heldout_residual_ = heldout && heldout->report.usable() ? heldout->residual : Eigen::VectorXd();
    return record_stage(model_, data_, fit, heldout && heldout->report.usable() ? &*heldout : nullptr,
                        heldout_data_);
  }

  /// Whether the error of a channel is more than is worth a name.
  [[nodiscard]] bool large(const RecordStage& s) const {
    return std::any_of(s.errors.begin(), s.errors.end(),
                       [&](const ChannelError& e) { return e.fitted && e.rmse > tolerance(e.sensor); });
  }

  /// Squares of a channel's residual over its variance, with the readings that it has.
  struct ChannelMisfit {
    double chi2 = 0.0, readings = 0.0;
  };
  [[nodiscard]] std::map<std::string, ChannelMisfit> misfits(const RecordStage& s,
                                                             const Eigen::VectorXd& residual) const {
    std::map<std::string, ChannelMisfit> found;
    for (const ResidualPiece& p : data_.pieces) {
      const std::string& sensor = set_.records[p.record].channels[p.channel].sensor;
      for (const ChannelError& e : s.errors) {
        if (!e.fitted || !(e.sigma > 0.0) || e.sensor != sensor) continue;
        found[sensor].chi2 +=
            residual.segment(p.begin, p.size).squaredNorm() * p.scale * p.scale / (e.sigma * e.sigma);
        found[sensor].readings += static_cast<double>(p.size);
      }
    }
    return found;
  }

  /// Whether an error is more than noise, and more than is worth a name.
  [[nodiscard]] bool more_than_noise(const RecordStage& s, const Eigen::VectorXd& residual, double* ljung,
                                     double* runs, double* lack) const {
    std::vector<Eigen::VectorXd> pieces;
    for (const ResidualPiece& p : data_.pieces) pieces.emplace_back(residual.segment(p.begin, p.size));
    const double l = ljung_box_p(pieces, 10), r = runs_p(pieces);
    // Each channel by itself, the numbers shared out by its readings; of several the smallest p counts as
    // often as there are channels.
    const double shared = static_cast<double>(s.numbers.size()) / static_cast<double>(residual.size());
    const std::map<std::string, ChannelMisfit> channels = misfits(s, residual);
    double f = 1.0;
    for (const auto& [sensor, m] : channels)
      f = std::min(f, static_cast<double>(channels.size()) *
                          chi_square_tail(m.chi2, std::max(1.0, m.readings * (1.0 - shared))));
    if (ljung != nullptr) *ljung = l;
    if (runs != nullptr) *runs = r;
    if (lack != nullptr) *lack = f;
    return large(s) && 3.0 * std::min({l, r, f}) < like_noise;
  }

  /// Error of a channel below which nothing is called missing, in its unit.
  [[nodiscard]] double tolerance(const std::string& sensor) const {
    bool declared = false;
    for (const Record& r : set_.records)
      for (const RecordChannel& c : r.channels) declared = declared || (c.sensor == sensor && c.sigma);
    if (declared && !set_.tolerance) return 0.0;
    return set_.tolerance.value_or(usual_share) * first_scales(set_, fitted_).at(sensor);
  }

  void tell_noise() {
    trace_.significant = omnibus_ =
        more_than_noise(trace_.base, current_.residual, &trace_.ljung_box, &trace_.runs, &trace_.lack_of_fit);
    double squares = 0.0;
    int count = 0;
    bool declared = true;
    for (const ChannelError& e : trace_.base.errors) {
      if (!e.fitted) continue;
      const double scale = scale_of(e.sensor);
      squares += e.sigma * e.sigma / (scale * scale);
      ++count;
      bool own = false;
      for (const Record& r : set_.records)
        for (const RecordChannel& c : r.channels) own = own || (c.sensor == e.sensor && c.sigma);
      declared = declared && own;
    }
    trace_.sigma = count > 0 ? std::sqrt(squares / count) : 0.0;
    trace_.noise_source = declared ? "declared" : "second_differences";
  }
  /// Of the unit in which RecordStage::rmse is told.
  [[nodiscard]] double scale_of(const std::string& sensor) const {
    double scale = 1.0;
    bool one = true;
    for (const ResidualPiece& p : data_.pieces) {
      const std::string& s = set_.records[p.record].channels[p.channel].sensor;
      one =
          one && s == set_.records[data_.pieces.front().record].channels[data_.pieces.front().channel].sensor;
      if (s == sensor) scale = p.scale;
    }
    return one ? 1.0 : scale;
  }

  /// The sensor with most beside its noise.
  [[nodiscard]] std::string worst_channel() const {
    std::string worst;
    double most = 0.0;
    for (const auto& [sensor, m] : misfits(trace_.base, current_.residual)) {
      if (m.chi2 - m.readings <= most) continue;
      most = m.chi2 - m.readings;
      worst = sensor;
    }
    return worst;
  }

  struct Reached {
    RecordFit fit;
    RecordStage stage;
    Eigen::VectorXd heldout;  // residual of the records held out
    std::size_t effects = 0;  // that are in it
  };
  /// Effects may carry over to the held-out records only together, as a loss that grows and one that does
  /// not. So they are asked at the end: of the models along the way the one that predicts the held-out
  /// records best stays, and what was added behind it goes where it makes the prediction worse by more than
  /// half a standard deviation: what these records hardly show they cannot take back.
  void keep_what_carries_over(std::vector<Reached>& kept) {
    if (heldout_data_.rows == 0 || kept.size() < 2 || stop_) return;  // what is only watched does not choose
    std::erase_if(kept, [](const Reached& k) { return k.heldout.size() == 0; });  // no motion with it
    if (kept.empty()) return;
    auto best = std::min_element(kept.begin(), kept.end(), [](const Reached& a, const Reached& b) {
      return a.heldout.squaredNorm() < b.heldout.squaredNorm();
    });
    const ColouredNoise noise = coloured_noise(heldout_data_, best->heldout);
    for (auto later = kept.end() - 1; later > best; --later) {
      const double half = coloured(heldout_data_, noise, later->heldout - best->heldout).norm();
      if (later->heldout.squaredNorm() > best->heldout.squaredNorm() + half) continue;
      best = later;
      break;
    }
    const std::size_t count = best->effects;
    for (std::size_t k = count; k < trace_.selected.size(); ++k)
      take_back(rounds_of_[k], "taken back: the records held out are not predicted better with it");
    rounds_of_.resize(count);
    trace_.selected.resize(count);
    trace_.selected_effects.resize(count);
    if (count == 0) trace_.channel.clear();
    current_ = best->fit;
    trace_.final = best->stage;
    trace_.kind = omnibus_ ? VerdictKind::not_explained : VerdictKind::nothing_missing;
    trace_.share_left = omnibus_ ? 1.0 : 0.0;
    trace_.significant = omnibus_ || count > 0;
    if (count > 0) judge();
    reached();
  }

  void take_back(std::size_t round, const std::string& reason) {
    trace_.rounds[round].reason = reason;
    trace_.rounds[round].added.clear();
  }

  /// Effects that were named before the last one and are no longer needed beside it: what imitated in part
  /// what was missing. Such an effect has numbers that are null within their errors, and without it the
  /// misfit grows by less than log n times what chance takes a number.
  bool drop_needless() {
    bool dropped = false;
    for (std::size_t e = 0; e + 1 < trace_.selected_effects.size() && !stop_;) {
      const std::vector<RecordNumber>& numbers = trace_.effects[trace_.selected_effects[e]].numbers;
      std::vector<RecordSetting> without;
      bool null = true;
      for (std::size_t k = 0; k < current_.settings.size(); ++k) {
        const RecordSetting& s = current_.settings[k];
        const bool own = std::any_of(numbers.begin(), numbers.end(),
                                     [&](const RecordNumber& n) { return n.key == s.number.key; });
        if (!own) {
          without.push_back(s);
          continue;
        }
        const auto i = static_cast<Eigen::Index>(k);
        const double variance = i < current_.covariance.rows() ? current_.covariance(i, i) : 0.0;
        null = null &&
               std::abs(s.value - s.number.declared) <= half_width_95 * std::sqrt(std::max(0.0, variance));
      }
      bool needless = false;
      if (null) {
        RecordFitOptions options;
        options.progress = asked();
        RecordFit fit = fit_motion(model_, data_, without, options);
        const double rows = std::max(1.0, static_cast<double>(data_.rows));
        const auto count = static_cast<double>(current_.settings.size() - without.size());
        needless =
            fit.report.usable() && fit.chi2 - current_.chi2 <= count * std::log(rows) * current_.chi2 / rows;
        if (needless) current_ = std::move(fit);
      }
      if (!needless) {
        ++e;
        continue;
      }
      take_back(rounds_of_[e], "taken back: not needed beside " + trace_.selected.back());
      const auto at = static_cast<std::ptrdiff_t>(e);
      trace_.selected.erase(trace_.selected.begin() + at);
      trace_.selected_effects.erase(trace_.selected_effects.begin() + at);
      rounds_of_.erase(rounds_of_.begin() + at);
      dropped = true;
    }
    return dropped;
  }

  /// The next round begins at the sizes that were found to show, less as much as the residual has fallen.
  void remember_sizes(const RoundResult& round) {
    const double fallen = round.better.residual.norm() / std::max(1e-300, current_.residual.norm());
    for (const RecordCandidate& c : round.round.candidates) {
      std::vector<RecordNumber>& numbers = trace_.effects[c.score.effect].numbers;
      for (std::size_t k = 0; k < c.score.numbers.size(); ++k)
        if (c.score.scale[k] > 0.0) numbers[c.score.numbers[k]].scale = fallen * c.score.scale[k];
    }
  }

  void look_for_effects() {
    trace_.effects = motion_effects(model_);
    // Numbers that are fitted already are no effects.
    std::erase_if(trace_.effects, [this](const RecordEffect& e) {
      return std::any_of(set_.free.begin(), set_.free.end(),
                         [&](const FreeNumber& f) { return f.key.starts_with(e.numbers.front().key); });
    });
    std::vector<Reached> kept{{current_, trace_.base, heldout_residual_, 0}};
    const Reached base = kept.front();
    for (int number = 1; number <= set_.most_effects; ++number) {
      if (!go_on(fmt::format("round {}: {} effects", number, trace_.effects.size()))) return;
      RoundInput input{
          model_, data_, current_, trace_.effects, trace_.selected_effects, options_.significance};
      for (const ChannelError& e : trace_.base.errors)
        if (e.fitted) input.tolerance[e.sensor] = tolerance(e.sensor);
      input.progress = asked();
      if (heldout_data_.rows > 0) {
        input.heldout_data = &heldout_data_;
        input.heldout_now = heldout_residual_.squaredNorm();
        input.heldout = [this](const RecordFit& fit) {
          const std::optional<RecordFit> there = on_heldout(fit, {});
          return there && there->report.usable() ? there->residual : Eigen::VectorXd();
        };
      }
      RoundResult round;
      if (out_of_step(data_, current_)) {
        // From the declared numbers: those fitted have gone astray with the records.
        std::vector<RecordSetting> start = current_.settings;
        for (RecordSetting& s : start) s.value = s.number.declared;
        round = round_from_beginnings(input, start);
      }
      if (!round.added && !stop_) round = record_round(input);
      if (stop_) return;
      trace_.rounds.push_back(round.round);
      if (!round.added) break;
      remember_sizes(round);
      current_ = std::move(round.better);
      trace_.selected.push_back(trace_.effects[*round.added].label());
      trace_.selected_effects.push_back(*round.added);
      rounds_of_.push_back(trace_.rounds.size() - 1);
      if (drop_needless()) kept.resize(1);  // the models along the way had what is dropped
      trace_.channel = trace_.effects[trace_.selected_effects.front()].channel;
      trace_.final = stage(current_, {});
      judge();
      trace_.significant = true;
      kept.push_back({current_, trace_.final, heldout_residual_, trace_.selected.size()});
      if (heldout_data_.rows == 0) reached();
      if (trace_.kind == VerdictKind::explained) break;
    }
    keep_what_carries_over(kept);
    if (!trace_.selected.empty() && !stop_) {
      settle();
      trace_.final = stage(current_, {});
      judge();
    }
    if (trace_.kind == VerdictKind::not_explained) withdraw(base);
    if (trace_.kind == VerdictKind::partly_explained || trace_.kind == VerdictKind::not_explained)
      trace_.leftovers = leftovers(model_, data_, current_);
    propose();
  }

  /// Nothing is named that leaves more than a little: what helped is told, and the model is again that
  /// without it.
  void withdraw(const Reached& base) {
    if (!trace_.selected.empty()) {
      trace_.partial = std::move(trace_.selected);
      trace_.with_partial = std::move(trace_.final);
      trace_.selected.clear();
      trace_.selected_effects.clear();
      trace_.final = trace_.base;
      current_ = base.fit;
    }
    trace_.channel = worst_channel();
  }

  void judge() {
    const double floor = trace_.sigma * trace_.sigma;
    const double base = std::max(0.0, trace_.base.rmse * trace_.base.rmse - floor);
    const double left = std::max(0.0, trace_.final.rmse * trace_.final.rmse - floor);
    trace_.share_left = base > 0.0 ? std::min(1.0, left / base) : 0.0;
    if (!more_than_noise(trace_.final, current_.residual, nullptr, nullptr, nullptr))
      trace_.kind = VerdictKind::explained;
    else
      trace_.kind = leaves_little() ? VerdictKind::partly_explained : VerdictKind::not_explained;
  }

  /// Whether little of the error is left, of all channels together and of each by itself: one that is
  /// followed well cannot hide another.
  [[nodiscard]] bool leaves_little() const {
    if (trace_.share_left > most_share_left) return false;
    for (std::size_t k = 0; k < trace_.final.errors.size(); ++k) {
      const ChannelError& e = trace_.final.errors[k];
      const double noise = e.sigma * e.sigma, left = e.rmse * e.rmse - noise;
      const double before = trace_.base.errors[k].rmse * trace_.base.errors[k].rmse - noise;
      if (e.fitted && left > noise && left > most_share_left * before) return false;
    }
    return true;
  }

  /// What to measure next: what settles the members of the class of the effect that was named last among
  /// those that are not alone.
  void propose() {
    for (const RecordRound& round : trace_.rounds) {
      if (round.added.empty() || round.classes.empty()) continue;
      for (const std::vector<std::string>& members : round.classes) {
        if (members.size() < 2 || std::find(members.begin(), members.end(), round.added) == members.end())
          continue;
        trace_.next_separates = members;
        trace_.next_measurement.clear();
        for (const RecordEffect& e : trace_.effects)
          if (std::find(members.begin(), members.end(), e.label()) != members.end())
            trace_.next_measurement += fmt::format("{}{}: {}", trace_.next_measurement.empty() ? "" : "; ",
                                                   e.label(), e.independent_check);
      }
    }
  }

  const RecordSet& set_;
  const RecordTraceOptions& options_;
  bool stop_ = false;
  RecordModel model_;
  std::vector<std::size_t> fitted_, heldout_;
  ChannelScales scales_;
  RecordData data_, heldout_data_;
  std::vector<RecordSetting> base_settings_;
  std::optional<std::vector<RecordSetting>>
      heldout_starts_;                // of the numbers of these records for themselves
  Eigen::MatrixXd heldout_jacobian_;  // there
  RecordFit current_;
  std::vector<std::size_t> rounds_of_;  // of every selected effect the round that named it
  Eigen::VectorXd heldout_residual_;    // of the last stage
  bool omnibus_ = false;  // what the base leaves is more than noise, whatever the effects' own tests say
  RecordTrace trace_;
};

}  // namespace

RecordTrace trace_records(const RecordSet& set, const RecordTraceOptions& options) {
  return Tracer(set, options).run();
}

}  // namespace snare::identification
