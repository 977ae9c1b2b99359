#include "results/trace_findings.hpp"

#include "identification/effects/catalogue.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace snare::results {

using identification::Prediction;
using identification::Series;
using identification::Trace;

namespace {

/// One selected effect, or the alternatives that these readings leave.
std::string explanation(const Trace& t, std::size_t k) {
  const std::vector<std::string>& members = t.selected_classes[k];
  const identification::Effect& e = *identification::find_effect(t.selected[k]);
  if (members.size() == 1) return fmt::format("{}: {}. ", e.name, e.meaning);
  std::vector<std::string> inside;
  for (const std::string& m : members) {
    if (!m.starts_with("outside:")) inside.push_back(m);
  }
  const bool outside = inside.size() < members.size();
  std::string text = inside.size() == 1
                         ? fmt::format("{} ({}), ", e.name, e.meaning)
                         : fmt::format("One of {}, carried on as {}, {}", fmt::join(inside, ", "), e.name,
                                       outside ? "" : "which these readings cannot tell apart. ");
  if (!outside) return text;
  const identification::ChannelFunction& f = t.alternatives.front();
  return text + fmt::format(
                    "or a cause outside the catalogue: something in the {} that {}, as a function of {}. "
                    "These readings cannot tell them apart. ",
                    to_string(f.channel), f.effect, f.argument);
}

/// Where an unexplained residual comes from.
std::string nearest_channel(const identification::ChannelFunction& f) {
  if (f.accepted) {
    return fmt::format(
        " The residual comes through the {}: a function of {} that {} carries over from series to series "
        "({:.0f} % of the excess); it is {}.",
        to_string(f.channel), f.argument, f.effect, 100.0 * f.carried_over, f.shape);
  }
  return fmt::format(
      " No single function of one channel carries over from series to series; the {} comes nearest ({:.0f} "
      "%).",
      to_string(f.channel), 100.0 * std::max(0.0, f.carried_over));
}

/// 0.31 %, of the largest force.
std::string share_of_peak(const Trace& t, double force) {
  return t.peak_force > 0.0 ? fmt::format("{:.2g} % of the largest force", 100.0 * force / t.peak_force)
                            : std::string("of no force");
}

/// P of a bootstrap, which cannot be smaller than one of its replicates.
std::string bootstrap_p(double p) {
  return p <= identification::least_bootstrap_p ? fmt::format("p <= {:g}", identification::least_bootstrap_p)
                                                : fmt::format("p = {:.2g}", p);
}

/// What more to measure where the readings support no further number.
std::string take_more(const Trace& t) {
  const auto fitted = t.base.numbers.size();
  if (t.from_laws) {
    return fmt::format(
        " {} published numbers cannot support an effect in addition to {} fitted ones: too few degrees of "
        "freedom "
        "would "
        "be left.",
        t.rows, fitted);
  }
  const double enough = static_cast<double>(fitted + 1) + identification::fewest_dof(fitted + 1);
  return fmt::format(
      " These {} readings cannot tell more: one number beside the {} fitted ones would leave too few. Take "
      "at least "
      "{:g}, better twenty a series, on loading and back, at two positions.",
      t.rows, fitted, enough);
}

std::string nothing_missing(const Trace& t) {
  std::string text;
  if (t.from_laws) {
    text = fmt::format(
        "Nothing missing: the base model, {} numbers of it fitted, agrees with the {} published ones ({}); "
        "no effect "
        "is "
        "missing.",
        t.base.numbers.size(), t.rows, bootstrap_p(t.base_tests.lack_of_fit));
  } else if (t.base_tests.within_noise()) {
    text = fmt::format(
        "Nothing missing: the base model explains the readings to the noise (rmse {:.3g} N); no effect "
        "is missing. Hidden in the noise could be up to {:.2g} N rms, {}.",
        t.base.rmse, t.remaining.upper, share_of_peak(t, t.remaining.upper));
  } else if (t.base_tests.within(t.tolerance)) {
    text = fmt::format(
        "Nothing missing worth a name: the base model leaves {:.3g} N rms, at most {:.2g} N of it not "
        "noise ({}), within the tolerance of {:.3g} N; no effect is missing beyond that.",
        t.base.rmse, t.remaining.upper, share_of_peak(t, t.remaining.upper), t.tolerance);
  } else {
    text = fmt::format(
        "Nothing missing worth a name: the base model leaves {:.3g} N rms, some {:.2g} N of it not noise, "
        "less than "
        "the tolerance of {:.3g} N; but it may be {:.2g} N ({}), and no effect of the catalogue lowers that "
        "by more "
        "than the tolerance.",
        t.base.rmse, t.remaining.rmse, t.tolerance, t.remaining.upper, share_of_peak(t, t.remaining.upper));
  }
  return t.few_readings ? text + take_more(t) : text;
}

/// The selected effects, and by how much the error falls.
std::string effects_of(const Trace& t) {
  std::string text;
  for (std::size_t k = 0; k < t.selected.size(); ++k) text += explanation(t, k);
  return text + fmt::format("The error falls from {:.3g} N to {:.3g} N.", t.base.rmse, t.final.rmse);
}

/// Why an answer is not the only one.
std::string reservation(const Trace& t) {
  if (t.decided || t.serial || !t.alternatives.empty()) return "";
  if (t.one_condition) {
    return " All readings are of one position and one slack: a cause outside the catalogue that acts on the "
           "travel "
           "would "
           "look the same. Push at another position to settle it.";
  }
  if (!identification::each_alone(t.selected_classes)) return "";
  if (!t.final_tests.agrees(t.tolerance))
    return " Noise leaves as much less than once in twenty times: take it as likely, not as settled.";
  return " Conditions left out are not predicted better for every effect: take it as likely, not as settled.";
}

std::string partly_explained(const Trace& t) {
  std::string text = "Partly explained. " + effects_of(t);
  text += fmt::format(
      " Left is {:.2g} N rms that is not noise, at most {:.2g} N ({}), {:.2g} % of what the base model "
      "leaves",
      t.remaining.rmse, t.remaining.upper, share_of_peak(t, t.remaining.upper),
      100.0 * t.remaining.share_of_excess);
  if (!t.remaining.channel.empty()) text += fmt::format("; it comes nearest to the {}", t.remaining.channel);
  return text +
         ". The forces may be relied on to that; the intervals of the numbers do not hold what is left." +
         reservation(t);
}

bool impossible(const identification::Finding& f) {
  return f.kind == identification::FindingKind::impossible_stiffness && f.sure;
}

/// The readings do not determine the numbers of a model that describes them.
std::string cannot_tell(const Trace& t) {
  if (t.serial_rival) {
    return fmt::format(
        "Cannot tell: {} would explain the error of {:.3g} N, but autocorrelated noise "
        "explains it as well. Repeat a series: a residual that comes back is no noise.",
        fmt::join(t.partial, " and "), t.base.rmse);
  }
  const double hidden = t.remaining.upper / (identification::most_hidden * t.peak_force);
  if (hidden > 1.0) {
    return fmt::format(
        "Cannot tell: the base model leaves {:.3g} N rms, which noise explains, but up to {:.2g} N ({}) "
        "could hide in "
        "it, and no effect of that size can be excluded. It takes {:.2g} times less noise, or {:.2g} times "
        "as many "
        "readings.",
        t.base.rmse, t.remaining.upper, share_of_peak(t, t.remaining.upper), hidden, hidden * hidden);
  }
  return fmt::format(
      "Cannot tell: the base model describes the readings (rmse {:.3g} N), but they do not determine its "
      "numbers, so "
      "that an "
      "effect that acts like one of these would not be seen. Hold one of the numbers that go together at a "
      "value that "
      "was "
      "measured otherwise.",
      t.base.rmse);
}

/// How much autocorrelated noise widens the intervals.
std::string serial_words(const identification::SerialNoise& s, std::size_t readings) {
  return fmt::format(
      " The residual is autocorrelated over {:.2g} readings ({:.2g} % of its variance): these {} readings "
      "are worth "
      "{:.2g} "
      "independent ones, and the intervals take that into account.",
      s.length, 100.0 * s.smooth, readings, s.effective);
}

std::string not_explained(const Trace& t) {
  using Kind = identification::FindingKind;
  std::string text;
  const auto first = [&](auto... kinds) {
    return std::ranges::find_if(t.findings,
                                [&](const identification::Finding& f) { return ((f.kind == kinds) || ...); });
  };
  if (const auto odd = first(Kind::series_of_another_specimen); odd != t.findings.end())
    return fmt::format("Not explained by one wire: {}. Leave it out, or trace it by itself.", odd->what);
  if (const auto odd = first(Kind::series_exchanged, Kind::sign_turned, Kind::unit_slip);
      odd != t.findings.end())
    return fmt::format("Not explained as the readings stand: {}.", odd->what);
  if (t.rival_explanation) {
    text = fmt::format(
        "Not explained: {} would bring the error of {:.3g} N down to the noise, but a single cause that the "
        "catalogue "
        "does not have does so more simply.",
        fmt::join(t.partial, " and "), t.base.rmse);
  } else if (std::ranges::any_of(t.findings, impossible)) {
    text = fmt::format("Not explained: the fit leaves {:.3g} N rms, but with numbers that no such wire has.",
                       t.base.rmse);
  } else if (t.from_laws) {
    text = fmt::format(
        "Not explained: with {} numbers fitted, the base model is rejected: lost readings of it would rarely "
        "give {} "
        "published numbers as unlikely as these ({}).",
        t.base.numbers.size(), t.rows, bootstrap_p(t.base_tests.lack_of_fit));
  } else if (t.few_readings) {
    text = fmt::format("Not explained: the base model leaves {:.3g} N rms.", t.base.rmse);
  } else {
    text = fmt::format(
        "Not explained: the catalogue has no effect that brings the error of {:.3g} N down to the noise.",
        t.base.rmse);
  }
  if (t.few_readings) text += take_more(t);
  if (t.functions.empty()) return text;
  if (t.one_condition)
    return text + " All readings are of one position and one slack: its channel cannot be told.";
  return text + nearest_channel(t.functions.front());
}

/// What a wrong zero of the travel would change.
std::string zero_words(const identification::ZeroCheck& z) {
  return fmt::format(
      " Note: the readings ask for a zero of the travel at {:.3g} mm ({:.3g} to "
      "{:.3g}); "
      "with it {} would be {:.4g} {} in place of {:.4g}. Find the touch, or free "
      "reading.displacement_offset_mm.",
      z.offset, z.lower, z.upper, z.key, z.with, z.unit, z.without);
}

}  // namespace

std::string verdict(const Trace& t) {
  using identification::VerdictKind;
  std::string text;
  switch (t.kind) {
    case VerdictKind::nothing_missing:
      text = nothing_missing(t);
      break;
    case VerdictKind::explained:
      text = (t.decided ? "Explained. " : "Explained, but not decided. ") + effects_of(t) + reservation(t);
      break;
    case VerdictKind::partly_explained:
      text = partly_explained(t);
      break;
    case VerdictKind::not_explained:
      text = not_explained(t);
      break;
    case VerdictKind::cannot_tell:
      text = cannot_tell(t);
      break;
  }
  if (t.serial && t.kind != VerdictKind::not_explained) text += serial_words(*t.serial, t.rows);
  if (t.zero && t.zero->doubtful) text += zero_words(*t.zero);
  return text;
}

std::optional<double> reading_noise(const Trace& trace) {
  if (trace.noise.sigma.empty()) return std::nullopt;
  std::vector<Series> fitted;
  for (std::size_t k = 0; k < trace.series.size(); ++k) {
    if (!trace.heldout[k]) fitted.push_back(trace.series[k]);
  }
  return trace.noise.mean_sigma(fitted);
}

std::optional<double> law_distance(const Trace& trace, std::size_t k, const std::vector<Prediction>& model) {
  const Series& series = trace.series[k];
  if (!series.law || model.size() <= k) return std::nullopt;
  std::vector<double> law;
  for (const double d : series.readings->displacement) law.push_back(series.law->force(d));
  return identification::misfit(law, model[k].force).rmse;
}

}  // namespace snare::results
