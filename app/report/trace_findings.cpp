#include "app/report/trace_findings.hpp"

#include "identification/effects/catalogue.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace snare::app {

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
      " No single function of one channel carries over from series to series; the {} comes nearest ({:.0f} %).",
      to_string(f.channel), 100.0 * std::max(0.0, f.carried_over));
}

}  // namespace

std::string verdict(const Trace& t) {
  if (t.explained && t.selected.empty()) {
    return fmt::format("The base model explains the readings to the noise (rmse {:.3g} N); no effect is missing.",
                       t.base.rmse);
  }
  if (t.explained) {
    std::string text = t.alternatives.empty() ? "Explained. " : "Explained, but not decided. ";
    for (std::size_t k = 0; k < t.selected.size(); ++k) text += explanation(t, k);
    return text + fmt::format("The error falls from {:.3g} N to {:.3g} N.", t.base.rmse, t.final.rmse);
  }
  const std::string text = t.rival_explanation ? fmt::format(
                                                     "Not explained: {} would bring the error of {:.3g} N "
                                                     "down to the noise, but a single cause that "
                                                     "the catalogue does not have does so more simply.",
                                                     fmt::join(t.partial, " and "), t.base.rmse)
                                               : fmt::format(
                                                     "Not explained: the catalogue has no effect that brings "
                                                     "the error of {:.3g} N down to the noise.",
                                                     t.base.rmse);
  return t.functions.empty() ? text : text + nearest_channel(t.functions.front());
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

}  // namespace snare::app
