#include "app/report/trace_report.hpp"

#include "app/report/report_page.hpp"
#include "app/report/report_words.hpp"
#include "app/report/trace_rounds.hpp"
#include "results/in_mm.hpp"
#include "results/trace_findings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace snare::app {

using namespace results;

namespace {

using identification::ChannelFunction;
using identification::FittedNumber;
using identification::ModelError;
using identification::Prediction;
using identification::Series;
using identification::Trace;

/// A curve, or a band, that makes the frame this many times higher than the rest gets a close-up.
constexpr double dwarfing_ratio = 1.5, dwarfing_band_ratio = 6.0;
/// Stages of the run shorter than this are not listed [s].
constexpr double least_stage_seconds = 0.01;

// ---- What the sections share
// ----------------------------------------------------------------------------------

/// Nothing was added: the final model is the base model.
bool unchanged(const Trace& trace) {
  return trace.selected.empty();
}

Values travel_mm(const Series& series) {
  return in_mm(series.readings->displacement);
}

/// Forces of series k; none where the run was interrupted before.
Values forces(const std::vector<Prediction>& model, std::size_t k) {
  return k < model.size() ? model[k].force : Values{};
}

// ---- Sections
// -------------------------------------------------------------------------------------------------

std::string noise_source(const Trace& trace) {
  const identification::Noise& noise = trace.noise;
  if (noise.source == "replicates" && noise.smooth > 0.0) {
    return fmt::format(
        "from the spread of repeated series; {} of its variance is smooth, over {} mm of travel",
        percent(noise.smooth), shown(1e3 * noise.length, 2));
  }
  if (trace.from_laws) return "the scatter that the published R\u00b2 implies";
  if (noise.source == "declared") return "as declared in the experiment file";
  if (noise.source == "replicates") return "from the spread of repeated series";
  if (noise.source == "residual") {
    return "from the roughness of the residual: none is declared, no series is repeated";
  }
  return noise.source;
}

KeyFigure error_figure(const Trace& trace, const ModelError& error, const std::string& label,
                       std::string remark) {
  const auto rmse = known(error.rmse);
  const auto nrmse = known(error.nrmse);
  const auto sigma = known(reading_noise(trace));
  if (rmse && sigma && *sigma > 0.0) {
    remark += fmt::format("; {} times the noise", format_number(*rmse / *sigma, 2));
  }
  if (nrmse) {
    remark += *nrmse < 1.0 ? fmt::format("; {} of the force's range", percent(nrmse))
                           : fmt::format("; {} times the force's range", shown(nrmse, 3));
  }
  return {label, measured(rmse, " N rms"), remark, Tone::plain};
}

/// Names of the selected effects; those that cannot be told apart as alternatives.
std::string effects_found(const Trace& trace) {
  Words found = trace.selected;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (k >= trace.selected_classes.size() || trace.selected_classes[k].size() < 2) continue;
    Words members = trace.selected_classes[k];
    for (std::string& m : members) {
      if (!m.starts_with("outside:")) continue;
      m = fmt::format("something in the {} that the catalogue does not have", m.substr(8));
    }
    found[k] = (found.size() > 1 ? "one of " : "") + joined(members, " or ");
  }
  return spaced(joined(found, "; "));
}

KeyFigure effect_figure(const Trace& trace) {
  const char* label = "Effect found";
  if (trace.kind == identification::VerdictKind::partly_explained) {
    return {label, effects_found(trace),
            "in part; at most " + measured(trace.remaining.upper, " N rms") + " is left", Tone::plain};
  }
  if (trace.kind == identification::VerdictKind::cannot_tell)
    return {label, "cannot tell", "the readings do not determine the numbers of the base model", Tone::plain};
  if (!trace.explained) {
    const std::string partial = spaced(joined(trace.partial));
    const std::string why = partial.empty() ? "no effect of the catalogue fits" : "not settled by " + partial;
    return {label, "not explained", why, Tone::bad};
  }
  if (unchanged(trace)) {
    const bool noise = trace.base_tests.within_noise();
    return {label, "none missing",
            noise ? "what the base model leaves looks like noise"
                  : "what the base model leaves is not worth a name",
            Tone::good};
  }
  if (!trace.decided) {
    const bool likely = identification::each_alone(trace.selected_classes);
    const char* why = likely ? "likely, but not settled" : "these readings cannot tell which";
    return {label, effects_found(trace), why, Tone::plain};
  }
  return {label, effects_found(trace), trace.channel.empty() ? "" : "sits in: " + trace.channel, Tone::good};
}

/// How well series that a fit has not seen are predicted.
std::optional<KeyFigure> prediction_figure(const Trace& trace) {
  const bool heldout = trace.heldout_rmse && known(trace.heldout_rmse->first);
  const auto& errors = heldout ? trace.heldout_rmse : trace.left_out_rmse;
  if (!errors || !known(errors->first) || !known(errors->second)) return std::nullopt;
  const auto [before, after] = *errors;
  const Tone tone = after < before ? Tone::good : after > before ? Tone::bad : Tone::plain;
  return KeyFigure{heldout ? "Held-out error, base to final" : "Prediction error, base to final",
                   fmt::format("{} \u2192 {} N", measured(before), measured(after)),
                   fmt::format("{}{}",
                               heldout ? "of the series that no fit has seen"
                                       : "of every condition when predicted from the others alone",
                               tone == Tone::bad ? "; the effect makes it worse" : ""),
                   tone};
}

/// Good: an engineer may rely on it; bad: not; plain: within what is said.
Tone tone_of(const Trace& trace) {
  using identification::VerdictKind;
  if (trace.kind == VerdictKind::partly_explained || trace.kind == VerdictKind::cannot_tell)
    return Tone::plain;
  return trace.explained ? Tone::good : Tone::bad;
}

void add_summary(ReportPage& page, const Trace& trace) {
  page.heading("Summary");
  page.callout(verdict(trace), tone_of(trace));
  if (trace.interrupted) {
    page.callout("Interrupted: the page shows what was known by then; a complete run may find more.",
                 Tone::bad);
  }
  const std::size_t fitted = trace.base.numbers.size();
  page.key_figures({error_figure(trace, trace.declared, "Error as declared", "nothing fitted"),
                    error_figure(trace, trace.base, "Error of the base model",
                                 fmt::format("{} number{} fitted", fitted, fitted == 1 ? "" : "s")),
                    error_figure(trace, trace.final, "Error of the final model",
                                 unchanged(trace) ? "the base model, nothing added"
                                                  : "with " + spaced(joined(trace.selected)))});
  std::vector<KeyFigure> others;
  if (const auto sigma = known(reading_noise(trace))) {
    others.push_back(
        {"Noise of a reading (\u03c3)", measured(sigma, " N"), noise_source(trace), Tone::plain});
  }
  others.push_back(effect_figure(trace));
  if (const auto prediction = prediction_figure(trace)) others.push_back(*prediction);
  page.key_figures(others);
  page.paragraph(
      "The declared model is the wire as its file describes it. The base model is the same with its "
      "uncertain numbers "
      "fitted. The final model has in addition the effects, if any, that the readings ask for. Errors are "
      "root mean "
      "squares over the fitted readings.");
}

PlotSpecification series_plot(const Trace& trace, std::size_t k) {
  const Series& series = trace.series[k];
  PlotSpecification plot{
      .title = fmt::format("{}, pushed at {} mm", series.name, shown(1e3 * series.test.contact_position)),
      .x = {"travel of the pusher", "mm"},
      .y = {"force", "N"}};
  if (trace.heldout[k]) plot.title += " (held out)";
  const auto add = [&](const char* name, const Values& force, CurveStyle style, int colour) {
    Curve curve = make_curve(name, travel_mm(series), force, style, colour);
    if (!curve.x.empty()) plot.curves.push_back(std::move(curve));
  };
  add("measured", series.readings->force, CurveStyle::points, black);
  add(unchanged(trace) ? "base model, also final" : "base model", forces(trace.base_predictions, k),
      CurveStyle::line, blue);
  if (!unchanged(trace)) add("final model", forces(trace.final_predictions, k), CurveStyle::line, vermillion);
  const Range reference = extent(plot.curves);
  add("declared model", forces(trace.declared_predictions, k), CurveStyle::dashes, green);
  const Range all = extent(plot.curves);
  if (size_of(reference) > 0.0 && size_of(all) > dwarfing_ratio * size_of(reference)) {
    const double far = all.upper > reference.upper ? all.upper : all.lower;
    close_up(plot, reference, {0.1, 0.1},
             fmt::format("Close-up; the declared model reaches {} N.", measured(far)));
  }
  return plot;
}

/// Distances of the models from the published laws, for series whose readings were drawn about one.
void add_laws(ReportPage& page, const Trace& trace) {
  Table table{"Distance of the models from the published fits themselves [N rms]; green: within the scatter.",
              {"Series"_text, "R\u00b2"_number, "Scatter [N]"_number, "Declared model"_number,
               "Base model"_number, "Final model"_number}};
  Words drawn;
  for (std::size_t k = 0; k < trace.series.size(); ++k) {
    const Series& series = trace.series[k];
    if (!series.law) continue;
    drawn.push_back(series.name);
    const double scatter = series.law->scatter();
    std::vector<Cell> row{series.name, shown(series.law->r_squared), measured(scatter)};
    for (const auto* model :
         {&trace.declared_predictions, &trace.base_predictions, &trace.final_predictions.get()}) {
      const auto rms = known(law_distance(trace, k, *model));
      row.emplace_back(measured(rms), rms && *rms <= scatter ? Tone::good : Tone::plain);
    }
    table.rows.push_back(std::move(row));
  }
  if (drawn.empty()) return;
  page.paragraph(fmt::format(
      "The points of {} are no readings. Only a fit F = A d\u00b2 + B d + C to readings was published, and "
      "only its three coefficients and R\u00b2 count: a curve may leave the parabola as the lost readings "
      "did.",
      joined(drawn)));
  page.table(table);
}

void add_before_and_after(ReportPage& page, const Trace& trace) {
  if (trace.series.empty()) return;
  page.heading("Before and after");
  Words heldout;
  for (std::size_t k = 0; k < trace.series.size(); ++k) {
    if (trace.heldout[k]) heldout.push_back(trace.series[k].name);
  }
  page.paragraph(heldout.empty()
                     ? "Every series took part in the fit; none was held out."
                     : fmt::format("Held out, never shown to a fit: {}. There the curves are predictions.",
                                   joined(heldout)));
  for (std::size_t k = 0; k < trace.series.size(); ++k) page.line_plot(series_plot(trace, k));
  add_laws(page, trace);
}

/// What a residual is drawn against: the model's force in place of the reading's, since a reading's noise is
/// in its residual, too.
enum class Abscissa { travel, model_force, time };

const Axis axes[] = {{"travel", "mm"}, {"force of the model", "N"}, {"time", "s"}};  // of Abscissa

PlotSpecification residual_plot(const Trace& trace, const std::string& name,
                                const std::vector<Prediction>& model, Abscissa abscissa) {
  const Axis& axis = axes[static_cast<std::size_t>(abscissa)];
  PlotSpecification plot{.title = fmt::format("Measured minus {} model, against {}", name, axis.label),
                         .x = axis,
                         .y = {"residual", "N"}};
  Values all;
  for (std::size_t k = 0; k < trace.series.size(); ++k) {
    const Series& series = trace.series[k];
    const Values& force = series.readings->force;
    const Values computed = forces(model, k);
    Values residual;
    for (std::size_t i = 0; i < std::min(force.size(), computed.size()); ++i) {
      residual.push_back(force[i] - computed[i]);
    }
    const Values x = abscissa == Abscissa::model_force ? computed
                     : abscissa == Abscissa::time      ? series.readings->time
                                                       : travel_mm(series);
    if (x.empty() || residual.empty()) continue;
    const int colour = blue + static_cast<int>(plot.curves.size());
    plot.curves.push_back(make_curve(series.name, x, residual, CurveStyle::points, colour));
    all.insert(all.end(), x.begin(), x.end());
  }
  const auto sigma = known(reading_noise(trace));
  if (all.empty() || !sigma) return plot;
  Curve noise =
      make_curve(fmt::format("noise \u00b1 {} \u03c3", band_sigmas),
                 {std::ranges::min(all), std::ranges::max(all)}, {0.0, 0.0}, CurveStyle::line, black);
  noise.band = band_around(noise.y, {*sigma, *sigma});
  plot.curves.push_back(std::move(noise));
  return plot;
}

void add_tests(ReportPage& page, const Trace& trace) {
  Table table{
      "p: how often pure noise would look at least this bad. Small, below about 0.01: the model misses "
      "something.",
      {"Test of what is left"_text, "Base model"_number, "Final model"_number}};
  const auto add = [&](const char* name, double base, double final) {
    if (known(base) || known(final)) table.rows.push_back({name, shown(base, 2), shown(final, 2)});
  };
  const identification::ResidualTests& base = trace.base_tests;
  const identification::ResidualTests& final = trace.final_tests;
  add("Runs, p: does the residual keep its sign longer than by chance?", base.runs, final.runs);
  add("Ljung-Box, p: does a residual resemble those just before it?", base.ljung_box, final.ljung_box);
  add("Lack of fit, p: is the residual larger than the noise of a reading?", base.lack_of_fit,
      final.lack_of_fit);
  add("\u03c7\u00b2/dof: squared residual over squared noise; near 1 when only noise is left",
      trace.base.chi2_dof, trace.final.chi2_dof);
  page.table(table);
  if (trace.noise.source == "replicates") {
    page.paragraph(
        "The noise is that of repeated series, whose specimens differ smoothly: runs and resemblance are "
        "then no sign "
        "of a missing effect, and only the lack of fit counts.");
  }
}

void add_residuals(ReportPage& page, const Trace& trace) {
  page.heading("Residuals");
  const char* left = trace.significant                 ? "is more than noise"
                     : trace.base_tests.within_noise() ? "cannot be told from noise"
                                                       : "is not worth a name";
  page.paragraph(
      fmt::format("What a model leaves unexplained: a good one leaves points without pattern, 95 % of them "
                  "inside the band. What the base model leaves {}.",
                  left));
  for (const Abscissa abscissa : {Abscissa::travel, Abscissa::model_force, Abscissa::time}) {
    const PlotSpecification before = residual_plot(trace, "base", trace.base_predictions, abscissa);
    page.line_plot(before);
    if (unchanged(trace)) continue;
    PlotSpecification after = residual_plot(trace, "final", trace.final_predictions, abscissa);
    const Range frame = extent(before.curves);  // beside it on the same scale
    if (size_of(extent(after.curves)) < 0.9 * size_of(frame)) close_up(after, frame, {0.06, 0.06});
    page.line_plot(after);
  }
  add_tests(page, trace);
}

void add_parameters(ReportPage& page, const Trace& trace) {
  const auto by_key = [](const ModelError& model) {
    std::map<std::string, FittedNumber> numbers;
    for (const FittedNumber& n : model.numbers) numbers[n.key] = n;
    return numbers;
  };
  const auto base = by_key(trace.base);
  const auto final = by_key(trace.final);
  auto latest = final;
  latest.insert(base.begin(), base.end());  // what the final model has not, if anything
  if (latest.empty()) return;
  Table table{"",
              {"Number"_code, "Unit"_text, "Declared"_number, "Base model"_number, "95 % interval"_number,
               "Final model"_number, "95 % interval"_number, "Found by"_text}};
  for (const auto& [key, number] : latest) {
    std::vector<Cell> row{key, number.unit.empty() ? "" : name_and_unit(key).second, shown(number.declared)};
    for (const auto* model : {&base, &final}) {
      const auto fitted = model->find(key);
      const auto cells = fitted == model->end() ? value_cells({}, {}, {}) : value_cells(fitted->second);
      row.insert(row.end(), cells.begin(), cells.end());
    }
    row.emplace_back(number.profiled ? "profile" : number.averaged ? "average" : "curvature");
    table.rows.push_back(std::move(row));
  }
  page.heading("The model now");
  page.paragraph(
      "Fitted numbers with the interval that holds the true value in 95 of 100 such tests, if the model is "
      "right. "
      "Average: the same whichever effect is right of those that these data cannot tell apart or cannot rule "
      "out, each "
      "by its likelihood. "
      "Profile: the number was moved and all others refitted until the misfit grew too much (profile "
      "likelihood). "
      "Curvature: 1.96 standard errors, from how sharply the misfit rises about its least; rougher when the "
      "interval "
      "is wide.");
  page.table(table);
}

void add_places(ReportPage& page, const Trace& trace) {
  if (trace.places.empty()) return;
  Table table{"",
              {"Series"_text, "Declared: \u00b1 [mm]"_number, "Found: from the declared place [mm]"_number,
               "\u00b1 [mm]"_number}};
  for (const identification::PlaceEstimate& p : trace.places) {
    table.rows.push_back(
        {joined(p.series), shown(1e3 * p.sigma), shown(1e3 * p.shift, 2), shown(1e3 * p.standard_error, 2)});
  }
  page.heading("Where the pusher stood");
  page.paragraph(
      "The file says how exactly the places are known. No effect is named for what such an error explains; "
      "the curves "
      "are computed at the places that the readings make likeliest (standard deviations).");
  page.table(table);
}

/// {"recorded travel", "mm"} of "recorded travel [mm]".
Axis axis_of(const std::string& label) {
  const auto open = label.rfind(" [");
  if (open == std::string::npos || !label.ends_with(']')) return {label, ""};
  return {label.substr(0, open), label.substr(open + 2, label.size() - open - 3)};
}

PlotSpecification function_plot(const ChannelFunction& function) {
  PlotSpecification plot{
      .title = fmt::format("Function found in the channel: {}", to_string(function.channel)),
      .x = axis_of(function.argument),
      .y = axis_of(function.effect),
      .width = PlotWidth::full};
  plot.curves = {
      make_curve("what these readings ask for", function.at, function.value, CurveStyle::line, blue)};
  const Range values = extent(plot.curves);
  Curve& curve = plot.curves.front();
  if (!curve.y.empty() && function.deviation.size() >= curve.y.size()) {
    curve.band = band_around(curve.y, function.deviation);
    plot.note = fmt::format(
        "Band: \u00b1 {} standard deviations; where it encloses zero, the readings need nothing added.",
        band_sigmas);
  }
  if (size_of(values) > 0.0 && size_of(extent(plot.curves)) > dwarfing_band_ratio * size_of(values)) {
    close_up(plot, values, {1.0, 1.0},
             "Close-up: the band goes far beyond, the readings hardly determine this function.");
  }
  return plot;
}

void add_functions(ReportPage& page, const Trace& trace) {
  if (trace.functions.empty()) return;
  page.heading("Where the residual comes from");
  page.paragraph(
      "Each part of the test, a channel, is given a free function in place of a known effect. A true cause "
      "acts alike "
      "in every series: what is found in some has to explain the others. Carried over: the share of the "
      "residual "
      "beyond noise that it explains there. Explained: the same when all series are used to find it.");
  Table table{"",
              {"Channel"_text, "What it would do, as a function of what"_text, "Carried over"_number,
               "Explained"_number, "Accepted"_text}};
  for (const ChannelFunction& f : trace.functions) {
    table.rows.push_back({to_string(f.channel), f.effect, percent(f.carried_over), percent(f.explained),
                          yes_no(f.accepted, Tone::good, Tone::plain)});
    table.rows.push_back({"", fmt::format("of {}: {}", f.argument, f.shape), "", "", ""});
  }
  page.table(table);
  if (!trace.functions.front().accepted) {
    page.paragraph(
        "None carries over well enough to be accepted. The nearest is drawn; take it as a hint, no more.");
  }
  page.line_plot(function_plot(trace.functions.front()));
}

void add_alternatives(ReportPage& page, const Trace& trace) {
  if (trace.alternatives.empty()) return;
  page.heading("Causes outside the catalogue that would do as well");
  page.paragraph(
      "A free function in another part of the test, found in some series, explains the others too. These "
      "readings "
      "cannot tell it from the effect above, which is the simpler answer.");
  Table table{"",
              {"Channel"_text, "What it would do"_text, "As a function of"_text, "Shape"_text,
               "Carried over"_number}};
  for (const ChannelFunction& f : trace.alternatives) {
    table.rows.push_back({to_string(f.channel), f.effect, f.argument, f.shape, percent(f.carried_over)});
  }
  page.table(table);
}

/// What a hypothesis says, for a test engineer.
std::string hypothesis_words(const identification::CauseHypothesis& h) {
  static const std::map<std::string, std::string> functions{
      {"force", "something unknown that hangs on the force"},
      {"travel", "something unknown that hangs on the travel"},
      {"time", "something unknown that hangs on the time"},
      {"place", "a wire that differs from place to place"},
      {"leg", "something unknown that loading and unloading differ in"},
      {"series", "a factor that differs from series to series"},
      {"other", "something unknown that differs from series to series"}};
  Words parts;
  for (const std::string& effect : h.effects) parts.push_back(spaced(effect));
  if (!h.discrepancy.empty()) parts.push_back(functions.at(h.discrepancy));
  return parts.empty() ? "nothing is missing" : joined(parts, " and ");
}

/// The likeliest hypotheses as bars.
void add_hypotheses(ReportPage& page, const Trace& trace) {
  constexpr double least = 0.005;
  constexpr std::size_t most = 8;
  constexpr double width = 24.0;  // characters of a bar
  if (trace.hypotheses.empty()) return;
  page.heading("Probabilities of causes");
  page.paragraph(
      "Each cause was fitted and weighed by how well it predicts the readings, with what is assumed before "
      "any "
      "reading: one in "
      "five that nothing is missing, and one in three that the cause is in no catalogue. They do not say "
      "that the "
      "right cause "
      "is among them.");
  Table table{"", {"Cause"_text, "Probability"_number, ""_text}};
  for (const identification::CauseHypothesis& h : trace.hypotheses) {
    if (table.rows.size() >= most || h.probability < least) break;
    std::string bar;
    for (int k = 0; k < static_cast<int>(std::lround(width * h.probability)); ++k) bar += "\u2588";
    table.rows.push_back({hypothesis_words(h), percent(h.probability), bar});
  }
  page.table(table);
}

void add_next(ReportPage& page, const Trace& trace) {
  if (!trace.next || trace.next->what.empty()) return;
  const identification::NextExperiment& next = *trace.next;
  page.heading("What to measure next");
  page.callout(next.what, Tone::plain);
  if (!next.separates.empty()) page.paragraph(fmt::format("It separates {}.", joined(next.separates)));
  if (!known(next.difference) || !known(next.sigmas)) return;
  page.paragraph(
      fmt::format("There the forces of the two models differ by {} N rms, {} times the noise of a reading.",
                  measured(next.difference), shown(next.sigmas, 2)));
}

std::string small_print(const Trace& trace, const std::string& version) {
  std::string print = written_by(version, "trace.json and curves.csv");
  if (const auto mesh = known(trace.mesh_error)) {
    const auto sigma = known(reading_noise(trace));
    print += fmt::format(" Dividing the wire into finite pieces costs at most {} N", measured(mesh));
    print += sigma && *sigma > 0.0
                 ? fmt::format(", {} % of the noise of a reading.", format_number(100.0 * *mesh / *sigma, 2))
                 : ".";
  }
  std::map<std::string, double> seconds;
  for (const auto& [stage, time] : trace.seconds) seconds[stage] = time;
  Words stages;
  double total = 0.0;
  for (const auto& [stage, time] : seconds) {
    total += time;
    if (time >= least_stage_seconds)
      stages.push_back(fmt::format("{} {} s", stage, format_significant(time, 2)));
  }
  if (!stages.empty()) {
    print += fmt::format(" Computed in {} s: {}.", format_significant(total, 2), fmt::join(stages, ", "));
  }
  return print + plot_help;
}

}  // namespace

std::string trace_report_html(const identification::Experiment& experiment, const Trace& trace,
                              const std::string& version, const std::vector<std::string>& warnings) {
  ReportPage page(experiment.title, experiment.source);
  page.doubts(warnings, false);  // the summary says whether it was interrupted
  add_summary(page, trace);
  add_before_and_after(page, trace);
  add_residuals(page, trace);
  add_rounds(page, trace);
  add_parameters(page, trace);
  add_places(page, trace);
  add_functions(page, trace);
  add_alternatives(page, trace);
  add_hypotheses(page, trace);
  add_next(page, trace);
  page.footer(small_print(trace, version));
  return page.html();
}

}  // namespace snare::app
