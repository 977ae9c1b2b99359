#include "app/report/trace_report.hpp"

#include "base/json_fields.hpp"
#include "app/report/report_page.hpp"
#include "app/report/trace_page_rounds.hpp"
#include "app/report/trace_page_words.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace snare::app {

using namespace trace_page;

namespace {

using base::json_fields::array;
using base::json_fields::member;
using base::json_fields::number;
using base::json_fields::numbers;
using base::json_fields::text;
using base::json_fields::texts;
using nlohmann::json;
using Values = std::vector<double>;

constexpr int black = 0, blue = 1, vermillion = 2, green = 3;  // of the report's palette
/// Bands are this many standard deviations wide: 95 % of normal scatter.
constexpr double band_sigmas = 2.0;
/// A curve, or a band, that makes the frame this many times higher than the rest gets a close-up.
constexpr double dwarfing_ratio = 1.5, dwarfing_band_ratio = 6.0;
/// Stages of the run shorter than this are not listed [s].
constexpr double least_stage_seconds = 0.01;

// ---- What the sections share --------------------------------------------------------------------------------------

std::string series_name(const json& series) { return text(series, "name", "unnamed series"); }
std::optional<double> noise_sigma(const json& result) { return number(object(result, "noise"), "sigma_N"); }

/// Nothing was added: the final model is the base model.
bool unchanged(const json& result) { return array(result, "selected").empty(); }

/// A curve of pairs; the shorter array ends it.
Curve make_curve(std::string name, Values x, Values y, CurveStyle style, int colour) {
  const std::size_t size = std::min(x.size(), y.size());
  x.resize(size);
  y.resize(size);
  return {std::move(name), std::move(x), std::move(y), style, colour, std::nullopt};
}

/// Two standard deviations to either side; `deviation` may be longer than the curve, not shorter.
Band band_around(const Curve& curve, const Values& deviation) {
  Band band{curve.y, curve.y};
  for (std::size_t i = 0; i < curve.y.size(); ++i) {
    band.lower[i] -= band_sigmas * deviation[i];
    band.upper[i] += band_sigmas * deviation[i];
  }
  return band;
}

/// Of all that the plot shows; both 0 without a value.
Range extent(const PlotSpecification& plot) {
  Values all;
  for (const Curve& curve : plot.curves) {
    const Band band = curve.band.value_or(Band{});
    for (const Values& values : {curve.y, band.lower, band.upper}) all.insert(all.end(), values.begin(), values.end());
  }
  return all.empty() ? Range{} : Range{std::ranges::min(all), std::ranges::max(all)};
}

double size_of(const Range& range) { return range.upper - range.lower; }
Range padded(const Range& r, double share) { return {r.lower - share * size_of(r), r.upper + share * size_of(r)}; }

// ---- Sections ----------------------------------------------------------------------------------------------------

std::string noise_source(const json& noise) {
  const std::string source = text(noise, "source");
  const auto smooth = number(noise, "smooth_share");
  if (source == "replicates" && smooth.value_or(0.0) > 0.0) {
    return fmt::format("from the spread of repeated series; {} of its variance is smooth, over {} mm of travel", percent(smooth),
                       shown(number(noise, "correlation_length_mm"), 2));
  }
  if (flag(noise, "drawn_about_published_laws").value_or(false)) return "the scatter that the published R\u00b2 implies";
  if (source == "declared") return "as declared in the experiment file";
  if (source == "replicates") return "from the spread of repeated series";
  if (source == "residual") return "from the roughness of the residual: none is declared, no series is repeated";
  return source;
}

void add_error(std::vector<KeyFigure>& figures, const json& result, const char* model, const std::string& label, std::string remark) {
  const json& error = object(result, model);
  const auto rmse = number(error, "rmse_N");
  const auto nrmse = number(error, "nrmse");
  const auto sigma = noise_sigma(result);
  if (error.is_null()) return;
  if (rmse && sigma && *sigma > 0.0) remark += fmt::format("; {} times the noise", format_number(*rmse / *sigma, 2));
  if (nrmse) remark += *nrmse < 1.0 ? fmt::format("; {} of the force's range", percent(nrmse)) : fmt::format("; {} times the force's range", shown(nrmse, 3));
  figures.push_back({label, measured(rmse, " N rms"), remark, Tone::plain});
}

/// Names of the selected effects; those that cannot be told apart as alternatives.
std::string effects_found(const json& result) {
  const auto classes = text_lists(result, "selected_classes");
  Words found = texts(result, "selected");
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (k >= classes.size() || classes[k].size() < 2) continue;
    Words members = classes[k];
    for (std::string& m : members) {
      if (m.starts_with("outside:")) m = fmt::format("something in the {} that the catalogue does not have", m.substr(8));
    }
    found[k] = (found.size() > 1 ? "one of " : "") + joined(members, " or ");
  }
  return spaced(joined(found, "; "));
}

void add_effect(std::vector<KeyFigure>& figures, const json& result) {
  const auto explained = flag(result, "explained");
  const std::string partial = spaced(joined(texts(object(result, "partial"), "effects")));
  const std::string failed = partial.empty() ? "no effect of the catalogue fits" : "not settled by " + partial;
  const std::string channel = text(result, "channel");
  if (!explained) return;
  if (!*explained) figures.push_back({"Effect found", "not explained", failed, Tone::bad});
  else if (unchanged(result)) figures.push_back({"Effect found", "none missing", "what the base model leaves looks like noise", Tone::good});
  else if (!objects(result, "alternatives").empty()) figures.push_back({"Effect found", effects_found(result), "these readings cannot tell which", Tone::plain});
  else figures.push_back({"Effect found", effects_found(result), channel.empty() ? "" : "sits in: " + channel, Tone::good});
}

/// How well series that a fit has not seen are predicted.
void add_prediction(std::vector<KeyFigure>& figures, const json& result) {
  const bool heldout = number(object(result, "heldout"), "rmse_base_N").has_value();
  const json& errors = object(result, heldout ? "heldout" : "left_out");
  const auto before = number(errors, "rmse_base_N");
  const auto after = number(errors, "rmse_final_N");
  if (!before || !after) return;
  const Tone tone = *after < *before ? Tone::good : *after > *before ? Tone::bad : Tone::plain;
  figures.push_back({heldout ? "Held-out error, base to final" : "Prediction error, base to final",
                     fmt::format("{} \u2192 {} N", measured(before), measured(after)),
                     fmt::format("{}{}", heldout ? "of the series that no fit has seen" : "of every series when predicted from the others alone",
                                 tone == Tone::bad ? "; the effect makes it worse" : ""), tone});
}

void add_summary(ReportPage& page, const json& result) {
  page.heading("Summary");
  page.callout(text(result, "verdict", "No model was traced."), flag(result, "explained").value_or(false) ? Tone::good : Tone::bad);
  const char* interrupted = "Interrupted: the page shows what was known by then; a complete run may find more.";
  if (flag(result, "interrupted").value_or(false)) page.callout(interrupted, Tone::bad);
  const std::size_t fitted = object(object(result, "base"), "parameters").size();
  std::vector<KeyFigure> errors, others;
  add_error(errors, result, "declared", "Error as declared", "nothing fitted");
  add_error(errors, result, "base", "Error of the base model", fmt::format("{} number{} fitted", fitted, fitted == 1 ? "" : "s"));
  add_error(errors, result, "final", "Error of the final model", unchanged(result) ? "the base model, nothing added" : "with " + spaced(joined(texts(result, "selected"))));
  const auto sigma = noise_sigma(result);
  if (sigma) others.push_back({"Noise of a reading (\u03c3)", measured(sigma, " N"), noise_source(object(result, "noise")), Tone::plain});
  add_effect(others, result);
  add_prediction(others, result);
  if (!errors.empty()) page.key_figures(errors);
  if (!others.empty()) page.key_figures(others);
  if (errors.empty()) return;
  page.paragraph("The declared model is the wire as its file describes it. The base model is the same with its uncertain numbers fitted. The final model "
                 "has in addition the effects, if any, that the readings ask for. Errors are root mean squares over the fitted readings.");
}

PlotSpecification series_plot(const json& series, bool unchanged) {
  const auto position = number(series, "contact_position_mm");
  PlotSpecification plot{.title = series_name(series), .x = {"travel of the pusher", "mm"}, .y = {"force", "N"}};
  if (position) plot.title += fmt::format(", pushed at {} mm", shown(position));
  if (flag(series, "heldout").value_or(false)) plot.title += " (held out)";
  const auto add = [&](const char* name, const char* key, CurveStyle style, int colour) {
    Curve curve = make_curve(name, numbers(series, "displacement_mm"), numbers(series, key), style, colour);
    if (!curve.x.empty()) plot.curves.push_back(std::move(curve));
  };
  add("measured", "measured_N", CurveStyle::points, black);
  add(unchanged ? "base model, also final" : "base model", "base_N", CurveStyle::line, blue);
  if (!unchanged) add("final model", "final_N", CurveStyle::line, vermillion);
  const Range reference = extent(plot);
  add("declared model", "declared_N", CurveStyle::dashes, green);
  const Range all = extent(plot);
  if (size_of(reference) > 0.0 && size_of(all) > dwarfing_ratio * size_of(reference)) {
    plot.y_window = padded(reference, 0.1);
    plot.note = fmt::format("Close-up; the declared model reaches {} N.", measured(all.upper > reference.upper ? all.upper : all.lower));
  }
  return plot;
}

/// Distances of the models from the published laws, for series whose readings were drawn about one.
void add_laws(ReportPage& page, const json& result) {
  Table table{"Distance of the models from the published fits themselves [N rms]; green: within the scatter.",
              {{"Series"}, number_column("R\u00b2"), number_column("Scatter [N]"), number_column("Declared model"), number_column("Base model"), number_column("Final model")}, {}};
  Words drawn;
  for (const json& series : objects(result, "series")) {
    if (flag(series, "drawn").value_or(false)) drawn.push_back(series_name(series));
    const json& law = object(series, "law");
    if (law.is_null()) continue;
    const auto scatter = number(law, "scatter_N");
    std::vector<Cell> row{series_name(series), shown(number(law, "R2")), measured(scatter)};
    for (const char* key : {"declared_rmse_N", "base_rmse_N", "final_rmse_N"}) {
      const auto rms = number(law, key);
      row.emplace_back(measured(rms), rms && scatter && *rms <= *scatter ? Tone::good : Tone::plain);
    }
    table.rows.push_back(std::move(row));
  }
  if (!drawn.empty()) {
    page.paragraph(fmt::format("The points of {} are no readings. Only a fit F = A d\u00b2 + B d + C to readings was published; the points were drawn at "
                               "random about it, with the scatter that its R\u00b2 implies.", joined(drawn)));
  }
  if (!table.rows.empty()) page.table(table);
}

void add_before_and_after(ReportPage& page, const json& result) {
  const json& all = objects(result, "series");
  if (all.empty()) return;
  page.heading("Before and after");
  Words heldout;
  for (const json& series : all) {
    if (flag(series, "heldout").value_or(false)) heldout.push_back(series_name(series));
  }
  page.paragraph(heldout.empty() ? "Every series took part in the fit; none was held out."
                                 : fmt::format("Held out, never shown to a fit: {}. There the curves are predictions.", joined(heldout)));
  for (const json& series : all) page.line_plot(series_plot(series, unchanged(result)));
  add_laws(page, result);
}

/// Key of a series and axis of a residual plot; without a key the model's force, since a reading's noise is in its residual, too.
using Abscissa = std::pair<std::string, Axis>;

PlotSpecification residual_plot(const json& result, const std::string& model, const Abscissa& abscissa) {
  const auto& [key, axis] = abscissa;
  PlotSpecification plot{.title = fmt::format("Measured minus {} model, against {}", model, axis.label), .x = axis, .y = {"residual", "N"}};
  Values all;
  for (const json& series : objects(result, "series")) {
    const Values force = numbers(series, "measured_N");
    const Values computed = numbers(series, model + "_N");
    Values residual;
    for (std::size_t i = 0; i < std::min(force.size(), computed.size()); ++i) residual.push_back(force[i] - computed[i]);
    const Values x = key.empty() ? computed : numbers(series, key);
    if (x.empty() || residual.empty()) continue;
    const int colour = blue + static_cast<int>(plot.curves.size());
    plot.curves.push_back(make_curve(series_name(series), x, residual, CurveStyle::points, colour));
    all.insert(all.end(), x.begin(), x.end());
  }
  const auto sigma = noise_sigma(result);
  if (all.empty() || !sigma) return plot;
  Curve noise = make_curve(fmt::format("noise \u00b1 {} \u03c3", band_sigmas), {std::ranges::min(all), std::ranges::max(all)}, {0.0, 0.0}, CurveStyle::line, black);
  noise.band = band_around(noise, {*sigma, *sigma});
  plot.curves.push_back(std::move(noise));
  return plot;
}

void add_tests(ReportPage& page, const json& result) {
  Table table{"p: how often pure noise would look at least this bad. Small, below about 0.01: the model misses something.",
              {{"Test of what is left"}, number_column("Base model"), number_column("Final model")}, {}};
  const auto add = [&](const char* name, const char* key, const json& before, const json& after) {
    const auto first = number(before, key);
    const auto second = number(after, key);
    if (first || second) table.rows.push_back({name, shown(first, 2), shown(second, 2)});
  };
  const json& before = object(object(result, "residual"), "tests");
  const json& after = object(object(result, "residual"), "tests_after");
  add("Runs, p: does the residual keep its sign longer than by chance?", "runs_p", before, after);
  add("Ljung-Box, p: does a residual resemble those just before it?", "ljung_box_p", before, after);
  add("Lack of fit, p: is the residual larger than the noise of a reading?", "lack_of_fit_p", before, after);
  add("\u03c7\u00b2/dof: squared residual over squared noise; near 1 when only noise is left", "chi2_dof", object(result, "base"), object(result, "final"));
  if (table.rows.empty()) return;
  page.table(table);
  if (text(object(result, "noise"), "source") == "replicates") {
    page.paragraph("The noise is that of repeated series, whose specimens differ smoothly: runs and resemblance are then no sign of a missing "
                   "effect, and only the lack of fit counts.");
  }
}

void add_residuals(ReportPage& page, const json& result) {
  if (objects(result, "series").empty() && object(result, "residual").is_null()) return;
  page.heading("Residuals");
  const auto significant = flag(object(result, "residual"), "significant");
  page.paragraph(fmt::format("What a model leaves unexplained: a good one leaves points without pattern, 95 % of them inside the band.{}",
                             !significant ? "" : *significant ? " What the base model leaves is more than noise." : " What the base model leaves cannot be told from noise."));
  for (const Abscissa& abscissa : {Abscissa{"displacement_mm", {"travel", "mm"}}, {"", {"force of the model", "N"}}, {"time_s", {"time", "s"}}}) {
    const PlotSpecification before = residual_plot(result, "base", abscissa);
    page.line_plot(before);
    if (unchanged(result)) continue;
    PlotSpecification after = residual_plot(result, "final", abscissa);  // beside it on the same scale
    if (size_of(extent(after)) < 0.9 * size_of(extent(before))) after.y_window = padded(extent(before), 0.06);
    page.line_plot(after);
  }
  add_tests(page, result);
}

void add_parameters(ReportPage& page, const json& result) {
  const json& base = object(object(result, "base"), "parameters");
  const json& final = object(object(result, "final"), "parameters");
  Table table{"", {{"Number", ColumnKind::code}, {"Unit"}, number_column("Declared"), number_column("Base model"), number_column("95 % interval"),
                   number_column("Final model"), number_column("95 % interval"), {"Found by"}}, {}};
  json latest = json::object();
  for (const json* model : {&base, &final}) latest.update(model->is_null() ? json::object() : *model);
  for (const auto& [key, parameter] : latest.items()) {
    const auto profiled = flag(parameter, "profiled");
    std::vector<Cell> row{key, text(parameter, "unit").empty() ? "" : name_and_unit(key).second, shown(number(parameter, "declared"))};
    for (const json* model : {&base, &final}) {
      const json& fitted = object(*model, key);
      for (const Cell& cell : value_cells(number(fitted, "value"), number(fitted, "lower95"), number(fitted, "upper95"))) row.push_back(cell);
    }
    row.emplace_back(!profiled ? absent : *profiled ? "profile" : "curvature");
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) return;
  page.heading("The model now");
  page.paragraph("Fitted numbers with the interval that holds the true value in 95 of 100 such tests, if the model is right. Profile: the number was moved and all "
                 "others refitted until the misfit grew too much (profile likelihood). Curvature: 1.96 standard errors, from how sharply the misfit rises "
                 "about its least; rougher when the interval is wide.");
  page.table(table);
}

/// {"recorded travel", "mm"} of "recorded travel [mm]".
Axis axis_of(const std::string& label) {
  const auto open = label.rfind(" [");
  if (open == std::string::npos || !label.ends_with(']')) return {label, ""};
  return {label.substr(0, open), label.substr(open + 2, label.size() - open - 3)};
}

PlotSpecification function_plot(const json& function) {
  PlotSpecification plot{.title = fmt::format("Function found in the channel: {}", text(function, "channel", "unnamed")), .x = axis_of(text(function, "argument")),
                         .y = axis_of(text(function, "effect")), .width = PlotWidth::full};
  plot.curves = {make_curve("what these readings ask for", numbers(function, "at"), numbers(function, "value"), CurveStyle::line, blue)};
  const Range values = extent(plot);
  Curve& curve = plot.curves.front();
  const Values deviation = numbers(function, "deviation");
  if (!curve.y.empty() && deviation.size() >= curve.y.size()) {
    curve.band = band_around(curve, deviation);
    plot.note = fmt::format("Band: \u00b1 {} standard deviations; where it encloses zero, the readings need nothing added.", band_sigmas);
  }
  if (size_of(values) > 0.0 && size_of(extent(plot)) > dwarfing_band_ratio * size_of(values)) {
    plot.y_window = padded(values, 1.0);
    plot.note += " Close-up: the band goes far beyond, the readings hardly determine this function.";
  }
  return plot;
}

void add_functions(ReportPage& page, const json& result) {
  const json& functions = objects(result, "functions");
  if (functions.empty()) return;
  page.heading("Where the residual comes from");
  page.paragraph("Each part of the test, a channel, is given a free function in place of a known effect. A true cause acts alike in every series: what is found in "
                 "some has to explain the others. Carried over: the share of the residual beyond noise that it explains there. Explained: the same when "
                 "all series are used to find it.");
  Table table{"", {{"Channel"}, {"What it would do, as a function of what"}, number_column("Carried over"), number_column("Explained"), {"Accepted"}}, {}};
  for (const json& function : functions) {
    table.rows.push_back({text(function, "channel", absent), text(function, "effect", absent), percent(number(function, "carried_over")),
                          percent(number(function, "explained")), yes_no(flag(function, "accepted"), Tone::good, Tone::plain)});
    table.rows.push_back({"", fmt::format("of {}: {}", text(function, "argument", absent), text(function, "shape", absent)), "", "", ""});
  }
  page.table(table);
  const char* hint = "None carries over well enough to be accepted. The nearest is drawn; take it as a hint, no more.";
  if (!flag(functions.front(), "accepted").value_or(false)) page.paragraph(hint);
  page.line_plot(function_plot(functions.front()));
}

void add_alternatives(ReportPage& page, const json& result) {
  const json& alternatives = objects(result, "alternatives");
  if (alternatives.empty()) return;
  page.heading("Causes outside the catalogue that would do as well");
  page.paragraph("A free function in another part of the test, found in some series, explains the others too. These readings cannot tell it from the "
                 "effect above, which is the simpler answer.");
  Table table{"", {{"Channel"}, {"What it would do"}, {"As a function of"}, {"Shape"}, number_column("Carried over")}, {}};
  for (const json& f : alternatives) {
    table.rows.push_back({text(f, "channel", absent), text(f, "effect", absent), text(f, "argument", absent), text(f, "shape", absent),
                          percent(number(f, "carried_over"))});
  }
  page.table(table);
}

void add_next(ReportPage& page, const json& result) {
  const json& next = object(result, "next_experiment");
  const std::string what = text(next, "what");
  const Words separates = texts(next, "separates");
  const auto difference = number(next, "difference_N");
  const auto sigmas = number(next, "difference_sigma");
  if (what.empty()) return;
  page.heading("What to measure next");
  page.callout(what, Tone::plain);
  if (!separates.empty()) page.paragraph(fmt::format("It separates {}.", joined(separates)));
  if (difference && sigmas) page.paragraph(fmt::format("There the forces of the two models differ by {} N rms, {} times the noise of a reading.", measured(difference), shown(sigmas, 2)));
}

std::string small_print(const json& result) {
  std::string print = fmt::format("Written by snare {}. The numbers are in trace.json and curves.csv beside this page.", text(result, "version"));
  const auto mesh = number(result, "mesh_error_N");
  const auto sigma = noise_sigma(result);
  if (mesh) print += fmt::format(" Dividing the wire into finite pieces costs at most {} N", measured(mesh));
  if (mesh) print += sigma && *sigma > 0.0 ? fmt::format(", {} % of the noise of a reading.", format_number(100.0 * *mesh / *sigma, 2)) : ".";
  const json& seconds = object(result, "seconds");
  Words stages;
  double total = 0.0;
  for (const auto& item : seconds.items()) {
    const double time = number(seconds, item.key()).value_or(0.0);
    total += time;
    if (time >= least_stage_seconds) stages.push_back(fmt::format("{} {} s", item.key(), format_significant(time, 2)));
  }
  if (!stages.empty()) print += fmt::format(" Computed in {} s: {}.", format_significant(total, 2), fmt::join(stages, ", "));
  return print + " In a plot: hover for values, drag to zoom, double-click to return, click the legend to hide a curve.";
}

}  // namespace

std::string trace_report_html(const json& result) {
  require_finite(result, "result");
  ReportPage page(text(result, "title", "What the model lacks"), text(result, "source"));
  add_summary(page, result);
  add_before_and_after(page, result);
  add_residuals(page, result);
  add_rounds(page, result);
  add_parameters(page, result);
  add_functions(page, result);
  add_alternatives(page, result);
  add_next(page, result);
  page.footer(small_print(result));
  return page.html();
}

}  // namespace snare::app
