#include "app/trace_report.hpp"

#include "app/json_fields.hpp"
#include "app/report_page.hpp"

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
namespace {

using json_fields::array;
using json_fields::member;
using json_fields::text;
using json_fields::texts;
using nlohmann::json;
using Values = std::vector<double>;

constexpr const char* absent = "\u2013";

// Colours of the report's palette: black, blue, vermillion, green.
constexpr int measured_colour = 0;
constexpr int base_colour = 1;
constexpr int final_colour = 2;
constexpr int declared_colour = 3;
constexpr int first_series_colour = 1;

/// Bands are this many standard deviations wide: 95 % of normal scatter.
constexpr double band_sigmas = 2.0;

/// A curve or band that makes the frame this many times higher than the rest gets a close-up.
constexpr double dwarfing_ratio = 1.5;

/// Stages of the run shorter than this are not listed [s].
constexpr double least_stage_seconds = 0.01;

// ---- Fields -----------------------------------------------------------------------------------------------------

double require_finite(double value, const std::string& key) {
  if (!std::isfinite(value)) throw std::invalid_argument(fmt::format("{} = {}, must be finite", key, value));
  return value;
}

std::optional<double> number(const json& parent, const std::string& key) {
  const auto value = json_fields::number(parent, key);
  if (value) require_finite(*value, key);
  return value;
}

Values numbers(const json& parent, const std::string& key) {
  Values values = json_fields::numbers(parent, key);
  for (const double value : values) require_finite(value, key);
  return values;
}

[[noreturn]] void wrong_type(const std::string& key, const char* expected, const json& value) {
  throw std::invalid_argument(fmt::format("{} is {}, must be {}", key, value.type_name(), expected));
}

const json& object(const json& parent, const std::string& key) {
  const json& value = member(parent, key);
  if (!value.is_null() && !value.is_object()) wrong_type(key, "an object", value);
  return value;
}

std::optional<bool> flag(const json& parent, const std::string& key) {
  const json& value = member(parent, key);
  if (value.is_null()) return std::nullopt;
  if (!value.is_boolean()) wrong_type(key, "true or false", value);
  return value.get<bool>();
}

/// The objects of an array without its nulls.
std::vector<json> objects(const json& parent, const std::string& key) {
  std::vector<json> result;
  for (const json& value : array(parent, key)) {
    if (value.is_null()) continue;
    if (!value.is_object()) wrong_type(key, "an array of objects", value);
    result.push_back(value);
  }
  return result;
}

/// The lists of texts of an array without its nulls.
std::vector<std::vector<std::string>> text_lists(const json& parent, const std::string& key) {
  std::vector<std::vector<std::string>> result;
  for (const json& value : array(parent, key)) result.push_back(texts({{key, value}}, key));
  return result;
}

// ---- Words ------------------------------------------------------------------------------------------------------

std::string measured(std::optional<double> value, const std::string& unit = "") {
  return value ? format_significant(*value) + unit : absent;
}

std::string probability(std::optional<double> p) {
  return p ? format_number(*p, 2) : absent;
}

std::string yes_no(std::optional<bool> value) {
  if (!value) return absent;
  return *value ? "yes" : "no";
}

Cell judged(std::optional<bool> value) {
  return {yes_no(value), value && !*value ? Tone::bad : Tone::plain};
}

std::string percent(std::optional<double> share) {
  if (!share) return absent;
  return fmt::format("{:.0f} %", std::round(100.0 * *share) + 0.0);
}

std::string fixed(std::optional<double> value, int decimals) {
  if (!value) return absent;
  const double step = std::pow(10.0, decimals);
  return fmt::format("{:.{}f}", std::round(*value * step) / step + 0.0, decimals);
}

std::string joined(const std::vector<std::string>& words, const char* last = " and ") {
  if (words.size() < 2) return words.empty() ? "" : words.front();
  const std::vector<std::string> first(words.begin(), words.end() - 1);
  return fmt::format("{}{}{}", fmt::join(first, ", "), last, words.back());
}

std::string spaced(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// N m² for N m^2.
std::string printed_unit(std::string unit) {
  static const std::vector<std::pair<std::string, std::string>> signs = {{"^2", "\u00b2"}, {"^3", "\u00b3"}, {"deg", "\u00b0"}};
  for (const auto& [plain, sign] : signs) {
    const auto at = unit.find(plain);
    if (at != std::string::npos) unit.replace(at, plain.size(), sign);
  }
  return unit;
}

/// {"yield stress", "MPa"} of plasticity.yield_stress_MPa.
std::pair<std::string, std::string> name_and_unit(const std::string& key) {
  static const std::vector<std::pair<std::string, std::string>> units = {
      {"_rad_Nm", "rad/(N m)"}, {"_kg_m3", "kg/m\u00b3"}, {"_m_s2", "m/s\u00b2"}, {"_Nm2", "N m\u00b2"},
      {"_m_N", "m/N"},          {"_1_m", "1/m"},          {"_GPa", "GPa"},        {"_MPa", "MPa"},
      {"_deg", "\u00b0"},       {"_mm", "mm"},            {"_N", "N"},            {"_s", "s"}};
  std::string name = key.substr(key.rfind('.') + 1);
  for (const auto& [suffix, unit] : units) {
    if (name.ends_with(suffix)) return {spaced(name.substr(0, name.size() - suffix.size())), unit};
  }
  return {spaced(name), ""};
}

/// With two digits beyond the first that `width` reaches.
std::string resolved(double value, double width) {
  if (value == 0.0 || !(width > 0.0)) return format_number(value, 4);
  const double digits = std::floor(std::log10(std::abs(value))) - std::floor(std::log10(width)) + 2.0;
  return format_significant(value, static_cast<int>(std::clamp(digits, 2.0, 9.0)));
}

/// A 95 % interval, perhaps open at an end.
struct Interval {
  std::optional<double> lower;
  std::optional<double> upper;

  [[nodiscard]] double width() const { return lower && upper ? std::abs(*upper - *lower) : 0.0; }
  [[nodiscard]] std::string printed() const {
    if (lower && upper) return resolved(*lower, width()) + " to " + resolved(*upper, width());
    if (lower) return "from " + format_significant(*lower);
    return upper ? "up to " + format_significant(*upper) : absent;
  }
};

/// The interval [lower, upper] of a key, either of them null when there is none.
Interval interval_of(const json& intervals, const std::string& key) {
  const json& ends = array(intervals, key);
  const auto end = [&](std::size_t i) { return ends.size() > i ? number({{key, ends[i]}}, key) : std::nullopt; };
  return {end(0), end(1)};
}

// ---- What the sections share --------------------------------------------------------------------------------------

struct SeriesView {
  std::string name;
  std::string title;
  bool heldout = false;
  Values displacement, force, time, declared, base, final;
};

struct TraceView {
  const json& result;
  std::vector<SeriesView> series;
  bool unchanged = false;       ///< the final model is the base model
  std::optional<double> sigma;  ///< of a reading [N]
};

SeriesView series_view(const json& series, std::size_t index) {
  SeriesView view;
  view.name = text(series, "name", fmt::format("series {}", index + 1));
  view.heldout = flag(series, "heldout").value_or(false);
  const auto position = number(series, "contact_position_mm");
  view.title = view.name + (position ? fmt::format(", pushed at {} mm", format_number(*position)) : "") +
               (view.heldout ? " (held out)" : "");
  view.displacement = numbers(series, "displacement_mm");
  view.force = numbers(series, "measured_N");
  view.time = numbers(series, "time_s");
  view.declared = numbers(series, "declared_N");
  view.base = numbers(series, "base_N");
  view.final = numbers(series, "final_N");
  return view;
}

TraceView trace_view(const json& result) {
  TraceView view{result, {}, true, number(object(result, "noise"), "sigma_N")};
  for (const json& series : objects(result, "series")) view.series.push_back(series_view(series, view.series.size()));
  for (const SeriesView& s : view.series) view.unchanged = view.unchanged && (s.final.empty() || s.final == s.base);
  view.unchanged = view.unchanged && array(result, "selected").empty();
  return view;
}

/// A curve of pairs; the shorter array ends it.
Curve make_curve(std::string name, Values x, Values y, CurveStyle style, int colour) {
  const std::size_t size = std::min(x.size(), y.size());
  x.resize(size);
  y.resize(size);
  return {std::move(name), std::move(x), std::move(y), style, colour, std::nullopt};
}

Band band_around(const Curve& curve, const Values& half_width) {
  Band band{curve.y, curve.y};
  for (std::size_t i = 0; i < curve.y.size(); ++i) {
    band.lower[i] -= half_width[i];
    band.upper[i] += half_width[i];
  }
  return band;
}

void extend(std::optional<Range>& range, const Values& values) {
  if (values.empty()) return;
  const auto [low, high] = std::ranges::minmax(values);
  range = range ? Range{std::min(range->lower, low), std::max(range->upper, high)} : Range{low, high};
}

double size_of(const std::optional<Range>& range) {
  return range ? range->upper - range->lower : 0.0;
}

/// What to show first of values that `range` encloses; none when there is nothing to see.
std::optional<Range> padded(const std::optional<Range>& range) {
  const double size = size_of(range);
  if (!(size > 0.0)) return std::nullopt;
  return Range{range->lower - 0.1 * size, range->upper + 0.15 * size};
}

// ---- Summary ------------------------------------------------------------------------------------------------------

std::string noise_source(const json& noise) {
  const std::string source = text(noise, "source");
  if (flag(noise, "drawn_about_published_laws").value_or(false)) return "the scatter that the published R\u00b2 implies";
  if (source == "declared") return "as declared in the experiment file";
  if (source == "replicates") return "from the spread of repeated series";
  if (source == "residual") return "from the roughness of the residual: none is declared, no series is repeated";
  return source;
}

std::string noise_times(const TraceView& view, std::optional<double> rmse) {
  if (!rmse || !view.sigma || *view.sigma <= 0.0) return "";
  return fmt::format("{} times the noise", format_significant(*rmse / *view.sigma, 2));
}

KeyFigure error_figure(const TraceView& view, const char* label, const char* key, const std::string& remark) {
  const json& error = object(view.result, key);
  const auto rmse = number(error, "rmse_N");
  std::vector<std::string> remarks;
  if (!remark.empty()) remarks.push_back(remark);
  if (rmse && view.sigma) remarks.push_back(noise_times(view, rmse));
  const auto nrmse = number(error, "nrmse");
  if (nrmse) {
    remarks.push_back(*nrmse < 1.0 ? format_significant(100.0 * *nrmse, 2) + " % of the force's range"
                                   : format_significant(*nrmse) + " times the force's range");
  }
  return {label, measured(rmse, " N rms"), fmt::format("{}", fmt::join(remarks, "; ")), Tone::plain};
}

/// Names of the selected effects, those that cannot be told apart as alternatives.
std::string effects_found(const json& result) {
  const auto selected = texts(result, "selected");
  const auto classes = text_lists(result, "selected_classes");
  std::vector<std::string> found;
  for (std::size_t k = 0; k < selected.size(); ++k) {
    std::vector<std::string> members{selected[k]};
    if (k < classes.size() && classes[k].size() > 1) members = classes[k];
    for (std::string& name : members) name = spaced(name);
    found.push_back(members.size() > 3 ? fmt::format("one of {} effects", members.size()) : joined(members, " or "));
  }
  return joined(found);
}

/// What an effect means, from the candidates of the first round that has it.
std::string meaning(const json& result, const std::string& effect) {
  for (const json& round : objects(result, "rounds")) {
    for (const json& candidate : objects(round, "candidates")) {
      if (text(candidate, "effect") == effect) return text(candidate, "meaning");
    }
  }
  return "";
}

KeyFigure effect_figure(const json& result) {
  const bool explained = flag(result, "explained").value_or(false);
  const auto selected = texts(result, "selected");
  if (!explained) {
    const auto partial = texts(object(result, "partial"), "effects");
    const std::string tried = partial.empty() ? "no effect of the catalogue fits" : "not even with " + spaced(joined(partial));
    return {"Effect found", "not explained", tried, Tone::bad};
  }
  if (selected.empty()) return {"Effect found", "none missing", "what is left looks like noise", Tone::good};
  std::vector<std::string> meanings;
  for (const std::string& effect : selected) meanings.push_back(meaning(result, effect));
  return {"Effect found", effects_found(result), joined(meanings), Tone::good};
}

std::optional<KeyFigure> prediction_figure(const json& result) {
  const bool heldout = number(object(result, "heldout"), "rmse_base_N").has_value();
  const json& errors = object(result, heldout ? "heldout" : "left_out");
  const auto before = number(errors, "rmse_base_N");
  const auto after = number(errors, "rmse_final_N");
  if (!before || !after) return std::nullopt;
  const Tone tone = *after < *before ? Tone::good : *after > *before ? Tone::bad : Tone::plain;
  std::string remark = heldout ? "of the series kept out of every fit" : "of every series when it is predicted from the others alone";
  if (tone != Tone::plain) remark += tone == Tone::good ? "; it falls" : "; it does not fall";
  return KeyFigure{heldout ? "Held-out error, before and after" : "Prediction error, before and after",
                   fmt::format("{} \u2192 {} N", measured(before), measured(after)), remark, tone};
}

void add_figures(ReportPage& page, const TraceView& view) {
  std::vector<KeyFigure> figures;
  const json& result = view.result;
  const std::size_t fitted = object(object(result, "base"), "parameters").size();
  if (!object(result, "declared").is_null()) figures.push_back(error_figure(view, "Error as declared", "declared", "nothing fitted"));
  if (!object(result, "base").is_null())
    figures.push_back(error_figure(view, "Error of the base model", "base",
                                   fmt::format("{} number{} fitted", fitted, fitted == 1 ? "" : "s")));
  if (!object(result, "final").is_null())
    figures.push_back(error_figure(view, "Error of the final model", "final",
                                   view.unchanged ? "the base model: nothing was added" : "with " + effects_found(result)));
  if (view.sigma) {
    figures.push_back({"Noise of a reading (\u03c3)", measured(view.sigma, " N"), noise_source(object(result, "noise")), Tone::plain});
  }
  if (flag(result, "explained")) figures.push_back(effect_figure(result));
  if (const auto prediction = prediction_figure(result)) figures.push_back(*prediction);
  if (!figures.empty()) page.key_figures(figures);
}

void add_summary(ReportPage& page, const TraceView& view) {
  const json& result = view.result;
  page.heading("Summary");
  const bool explained = flag(result, "explained").value_or(false);
  page.callout(text(result, "verdict", "No model was traced."), explained ? Tone::good : Tone::bad);
  if (flag(result, "interrupted").value_or(false)) {
    page.callout("Interrupted: the page shows what was known by then; a complete run may find more.", Tone::bad);
  }
  add_figures(page, view);
  if (object(result, "base").is_null()) return;
  page.paragraph(
      "The declared model is the wire as its file describes it. The base model is the same with its uncertain numbers "
      "fitted. The final model adds the effects, if any, without which the readings cannot be explained. "
      "Errors are root mean squares over the fitted readings.");
  const json& noise = object(result, "noise");
  const auto smooth = number(noise, "smooth_share");
  const auto length = number(noise, "correlation_length_mm");
  if (smooth && length && *smooth > 0.0) {
    page.paragraph(fmt::format("{} of the noise's variance is smooth: readings within about {} mm of travel deviate together, as "
                               "specimens that differ do. The tests below allow for that.",
                               percent(smooth), format_significant(*length)));
  }
}

// ---- Before and after -----------------------------------------------------------------------------------------------

PlotSpecification series_plot(const SeriesView& series, bool unchanged) {
  PlotSpecification plot{.title = series.title, .x = {"travel of the pusher", "mm"}, .y = {"force", "N"}};
  const auto add = [&](const char* name, const Values& force, CurveStyle style, int colour) {
    if (!force.empty()) plot.curves.push_back(make_curve(name, series.displacement, force, style, colour));
  };
  add("measured", series.force, CurveStyle::points, measured_colour);
  add("declared model", series.declared, CurveStyle::dashes, declared_colour);
  add(unchanged ? "base model, also final" : "base model", series.base, CurveStyle::line, base_colour);
  if (!unchanged) add("final model", series.final, CurveStyle::line, final_colour);

  std::optional<Range> reference;
  for (const Values* values : {&series.force, &series.base, &series.final}) extend(reference, *values);
  std::optional<Range> all = reference;
  extend(all, series.declared);
  if (size_of(all) > dwarfing_ratio * size_of(reference)) plot.y_window = padded(reference);
  if (plot.y_window) {
    const double far = *std::ranges::max_element(series.declared, {}, [](double f) { return std::abs(f); });
    plot.note = fmt::format("Close-up; the declared model goes on to {} N.", format_significant(far));
  }
  return plot;
}

Cell against_scatter(std::optional<double> rms, std::optional<double> scatter) {
  return {measured(rms), rms && scatter && *rms <= *scatter ? Tone::good : Tone::plain};
}

/// Distances of the models from the published laws, for series whose readings were drawn about one.
void add_law_table(ReportPage& page, const TraceView& view) {
  Table table{"Distance of the models from the published fits themselves; green: within the scatter.",
              {{"Series"}, {"R\u00b2", ColumnKind::number}, {"Scatter [N]", ColumnKind::number}, {"Declared model [N rms]", ColumnKind::number},
               {"Base model [N rms]", ColumnKind::number}, {"Final model [N rms]", ColumnKind::number}},
              {}};
  std::vector<std::string> drawn;
  std::size_t index = 0;
  for (const json& series : objects(view.result, "series")) {
    const std::string& name = view.series[index++].name;
    if (flag(series, "drawn").value_or(false)) drawn.push_back(name);
    const json& law = object(series, "law");
    if (law.is_null()) continue;
    const auto scatter = number(law, "scatter_N");
    const auto r2 = number(law, "R2");
    table.rows.push_back({name, r2 ? format_number(*r2) : absent, measured(scatter), against_scatter(number(law, "declared_rmse_N"), scatter),
                          against_scatter(number(law, "base_rmse_N"), scatter), against_scatter(number(law, "final_rmse_N"), scatter)});
  }
  if (!drawn.empty()) {
    page.paragraph(fmt::format("The points of {} are no readings. Only a fit F = A d\u00b2 + B d + C to readings was published; the points were drawn "
                               "at random about it with the scatter that its R\u00b2 implies.", joined(drawn)));
  }
  if (!table.rows.empty()) page.table(table);
}

void add_before_and_after(ReportPage& page, const TraceView& view) {
  if (view.series.empty()) return;
  page.heading("Before and after");
  std::vector<std::string> heldout;
  for (const SeriesView& series : view.series) {
    if (series.heldout) heldout.push_back(series.name);
  }
  page.paragraph(heldout.empty() ? "Every series took part in the fit; none was held out."
                                 : fmt::format("Held out, so never shown to a fit: {}. There the curves are predictions.", joined(heldout)));
  for (const SeriesView& series : view.series) page.line_plot(series_plot(series, view.unchanged));
  add_law_table(page, view);
}

// ---- Residuals ------------------------------------------------------------------------------------------------------

using ModelCurve = Values SeriesView::*;
using Abscissa = Values SeriesView::*;

PlotSpecification residual_plot(const TraceView& view, const char* model, ModelCurve computed, Abscissa abscissa, const Axis& x) {
  PlotSpecification plot{.title = fmt::format("Measured minus {}, against {}", model, x.label), .x = x, .y = {"residual", "N"}};
  std::optional<Range> extent;
  int colour = first_series_colour;
  for (const SeriesView& series : view.series) {
    Values residual = series.*computed;
    residual.resize(std::min(residual.size(), series.force.size()));
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = series.force[i] - residual[i];
    plot.curves.push_back(make_curve(series.name, series.*abscissa, residual, CurveStyle::points, colour++));
    extend(extent, plot.curves.back().x);
  }
  std::erase_if(plot.curves, [](const Curve& curve) { return curve.x.empty(); });
  if (!extent || !view.sigma) return plot;
  Curve noise = make_curve(fmt::format("noise \u00b1 {} \u03c3", format_number(band_sigmas)), {extent->lower, extent->upper}, {0.0, 0.0},
                           CurveStyle::line, measured_colour);
  noise.band = band_around(noise, Values(2, band_sigmas * *view.sigma));
  plot.curves.push_back(std::move(noise));
  return plot;
}

std::optional<Range> extent(const PlotSpecification& plot) {
  std::optional<Range> range;
  for (const Curve& curve : plot.curves) {
    extend(range, curve.y);
    if (curve.band) extend(range, curve.band->lower);
    if (curve.band) extend(range, curve.band->upper);
  }
  return range;
}

/// Base and final side by side on one scale.
void add_residual_pair(ReportPage& page, const TraceView& view, Abscissa abscissa, const Axis& x) {
  const PlotSpecification before = residual_plot(view, "base model", &SeriesView::base, abscissa, x);
  page.line_plot(before);
  if (view.unchanged) return;
  PlotSpecification after = residual_plot(view, "final model", &SeriesView::final, abscissa, x);
  if (size_of(extent(after)) < 0.9 * size_of(extent(before))) after.y_window = padded(extent(before));
  page.line_plot(after);
}

void add_tests(ReportPage& page, const TraceView& view) {
  const json& residual = object(view.result, "residual");
  const json& before = object(residual, "tests");
  const json& after = object(residual, "tests_after");
  Table table{"p: how often pure noise would look at least this bad. Small, below about 0.01: the model misses something.",
              {{"Test of what is left"}, {"Base model", ColumnKind::number}, {"Final model", ColumnKind::number}},
              {}};
  const auto add = [&](const char* name, const char* key) {
    const auto first = number(before, key);
    const auto second = number(after, key);
    if (first || second) table.rows.push_back({name, probability(first), probability(second)});
  };
  add("Runs: does the residual keep its sign longer than chance would? p", "runs_p");
  add("Ljung-Box: does a residual resemble those just before it? p", "ljung_box_p");
  add("Lack of fit: is the residual larger than the noise of a reading? p", "lack_of_fit_p");
  const auto chi_before = number(object(view.result, "base"), "chi2_dof");
  const auto chi_after = number(object(view.result, "final"), "chi2_dof");
  if (chi_before || chi_after) {
    table.rows.push_back({"Squared residual over squared noise, a reading (\u03c7\u00b2/dof): near 1 when only noise is left", measured(chi_before), measured(chi_after)});
  }
  if (table.rows.empty()) return;
  page.table(table);
  if (text(object(view.result, "noise"), "source") == "replicates") {
    page.paragraph("The noise is that of repeated series, whose specimens differ smoothly: runs and resemblance are then no sign "
                   "of a missing effect, and only the lack of fit counts.");
  }
}

void add_residuals(ReportPage& page, const TraceView& view) {
  const bool tested = !object(view.result, "residual").is_null();
  if (view.series.empty() && !tested) return;
  page.heading("Residuals");
  const auto significant = flag(object(view.result, "residual"), "significant");
  page.paragraph(fmt::format("What a model leaves unexplained. A good model leaves points without pattern, 95 % of them inside the band.{}",
                             !significant   ? ""
                             : *significant ? " What the base model leaves is more than noise."
                                            : " What the base model leaves cannot be told from noise."));
  add_residual_pair(page, view, &SeriesView::displacement, {"travel", "mm"});
  add_residual_pair(page, view, &SeriesView::force, {"force", "N"});
  add_residual_pair(page, view, &SeriesView::time, {"time", "s"});
  add_tests(page, view);
}

// ---- What could be missing ------------------------------------------------------------------------------------------

bool observable(const json& candidate) {
  return flag(candidate, "observable").value_or(true);
}

std::string smallest_size(const json& candidate) {
  const json& detectable = object(candidate, "detectable");
  const auto size = number(detectable, "size");
  const auto [name, unit] = name_and_unit(text(detectable, "key"));
  return measured(size, size && !unit.empty() ? " " + unit : "");
}

void add_scores(ReportPage& page, const json& round) {
  Table table{"Does the residual have the shape that the effect would give it?",
              {{"Effect", ColumnKind::code}, {"What would happen"}, {"Where"}, {"Score z", ColumnKind::number}, {"p (Holm)", ColumnKind::number},
               {"Smallest size these data would show", ColumnKind::number}},
              {}};
  const std::string added = text(round, "added");
  for (const json& candidate : objects(round, "candidates")) {
    if (!observable(candidate)) continue;
    const std::string effect = text(candidate, "effect", absent);
    table.rows.push_back({{effect, effect == added ? Tone::good : Tone::plain}, text(candidate, "meaning"), text(candidate, "channel", absent),
                          fixed(number(candidate, "score_z"), 2), probability(number(candidate, "score_p_holm")), smallest_size(candidate)});
  }
  if (!table.rows.empty()) page.table(table);
}

/// One row a number of the effect; what belongs to the effect stands in the first.
std::vector<std::vector<Cell>> refit_rows(const json& candidate) {
  std::vector<std::vector<Cell>> rows;
  const json& values = object(candidate, "value");
  std::vector<Cell> row{text(candidate, "effect", absent), measured(number(candidate, "rmse_N")), fixed(number(candidate, "delta_bic"), 1),
                        absent, absent, absent, judged(flag(candidate, "plausible")), judged(flag(candidate, "heldout_improves"))};
  for (const auto& item : values.items()) {
    const auto value = number(values, item.key());
    const Interval interval = interval_of(object(candidate, "interval95"), item.key());
    const auto [name, unit] = name_and_unit(item.key());
    row[3] = name + (unit.empty() ? "" : " [" + unit + "]");
    row[4] = !value ? absent : interval.width() > 0.0 ? resolved(*value, interval.width()) : format_number(*value, 4);
    row[5] = interval.printed();
    rows.push_back(row);
    row = std::vector<Cell>(row.size(), "");
  }
  if (values.empty()) rows.push_back(row);
  return rows;
}

void add_refits(ReportPage& page, const json& round) {
  Table table{"The best of them, each added to the model and refitted with all its numbers.",
              {{"Effect", ColumnKind::code}, {"Error [N rms]", ColumnKind::number}, {"Change of BIC", ColumnKind::number}, {"Its number"},
               {"Value", ColumnKind::number}, {"95 % interval", ColumnKind::number}, {"Plausible"}, {"Held-out improves"}},
              {}};
  for (const json& candidate : objects(round, "candidates")) {
    if (!flag(candidate, "refitted").value_or(false)) continue;
    for (auto& row : refit_rows(candidate)) table.rows.push_back(std::move(row));
  }
  if (!table.rows.empty()) page.table(table);
}

/// Why effects were ruled out, and which could not be judged at all.
void add_reasons(ReportPage& page, const json& round) {
  std::vector<std::string> implausible;
  std::vector<std::string> unseen;
  for (const json& candidate : objects(round, "candidates")) {
    const std::string effect = text(candidate, "effect", "unnamed");
    const std::string why = text(candidate, "why_implausible");
    if (!why.empty()) implausible.push_back(fmt::format("{}: {}", effect, why));
    if (observable(candidate)) continue;
    unseen.push_back(fmt::format("{} ({}): {}", effect, text(candidate, "meaning"), text(candidate, "why_unobservable", "no reason given")));
  }
  if (!implausible.empty()) {
    page.paragraph("Not plausible, since a value this large makes no physical sense:");
    page.list(implausible);
  }
  if (!unseen.empty()) {
    page.paragraph("These data cannot show, whether present or not:");
    page.list(unseen);
  }
}

/// Members of a class that are no candidates of its round are numbers of the model already.
void add_classes(ReportPage& page, const json& round) {
  std::vector<std::string> candidates;
  for (const json& candidate : objects(round, "candidates")) candidates.push_back(text(candidate, "effect"));
  std::vector<std::string> items;
  for (const auto& members : text_lists(round, "classes")) {
    if (members.size() < 2) continue;
    std::vector<std::string> fitted;
    std::ranges::copy_if(members, std::back_inserter(fitted), [&](const std::string& name) { return std::ranges::find(candidates, name) == candidates.end(); });
    items.push_back(joined(members) + (fitted.empty() ? "" : fmt::format("; of these the model has {} already", joined(fitted))) + ".");
  }
  if (items.empty()) return;
  page.paragraph("These data cannot tell apart, since the curves would change in the same way:");
  page.list(items);
}

void add_partial(ReportPage& page, const json& result) {
  const json& partial = object(result, "partial");
  const auto effects = texts(partial, "effects");
  if (effects.empty()) return;
  const bool rival = flag(partial, "rival_explanation").value_or(false);
  page.paragraph(fmt::format("Taken together {} would bring the error to {} N rms. {}", joined(effects), measured(number(partial, "rmse_N")),
                             rival ? "But one cause that the catalogue does not have would do the same, and is the simpler explanation: nothing was "
                                     "added to the model."
                                   : "That still leaves more than noise, so nothing was added to the model."));
}

void add_rounds(ReportPage& page, const json& result) {
  const auto rounds = objects(result, "rounds");
  if (rounds.empty()) return;
  page.heading("What could be missing");
  page.paragraph("Every effect of the catalogue is asked in turn. Where: the part of the test in which it sits. Score z: how many standard deviations "
                 "the effect's pattern stands out of the noise; 0 when the residual points the other way. p: how often noise alone would reach "
                 "that score, corrected by Holm's rule for asking so many effects at once.");
  page.paragraph("BIC, the Bayesian information criterion, is the misfit plus a price for every number fitted: an effect that pays for itself lowers it. "
                 "The smallest size would be found nine times in ten.");
  int count = 0;
  for (const json& round : rounds) {
    page.subheading(fmt::format("Round {}", ++count));
    const std::string added = text(round, "added");
    const std::string reason = text(round, "reason");
    page.paragraph((added.empty() ? "Nothing added" : "Added: " + added) + (reason.empty() ? "" : "; " + reason) + ".");
    add_scores(page, round);
    add_refits(page, round);
    add_reasons(page, round);
    add_classes(page, round);
  }
  add_partial(page, result);
}

// ---- The model now --------------------------------------------------------------------------------------------------

std::vector<Cell> value_cells(const json& parameter) {
  const auto value = number(parameter, "value");
  const Interval interval{number(parameter, "lower95"), number(parameter, "upper95")};
  if (!value) return {absent, absent};
  return {interval.width() > 0.0 ? resolved(*value, interval.width()) : format_number(*value), interval.printed()};
}

void add_parameters(ReportPage& page, const TraceView& view) {
  const json& base = object(object(view.result, "base"), "parameters");
  const json& final = object(object(view.result, "final"), "parameters");
  std::vector<std::string> keys;
  for (const json* model : {&final, &base}) {
    for (const auto& item : model->items()) {
      if (std::ranges::find(keys, item.key()) == keys.end()) keys.push_back(item.key());
    }
  }
  if (keys.empty()) return;
  Table table{"", {{"Number", ColumnKind::code}, {"Unit"}, {"Declared", ColumnKind::number}, {"Base model", ColumnKind::number},
                   {"95 % interval", ColumnKind::number}, {"Final model", ColumnKind::number}, {"95 % interval", ColumnKind::number},
                   {"Found by"}}, {}};
  for (const std::string& key : keys) {
    const json& before = object(base, key);
    const json& after = object(final, key);
    const json& either = after.is_null() ? before : after;
    const auto declared = number(either, "declared");
    std::vector<Cell> row{key, printed_unit(text(either, "unit")), declared ? format_number(*declared) : absent};
    for (const json* model : {&before, &after}) std::ranges::move(value_cells(*model), std::back_inserter(row));
    const auto profiled = flag(either, "profiled");
    row.emplace_back(!profiled ? absent : *profiled ? "profile" : "curvature");
    table.rows.push_back(std::move(row));
  }
  page.heading("The model now");
  page.paragraph("Fitted numbers with the interval that holds the true value in 95 of 100 such tests, if the model is right. Profile: found by moving the number "
                 "and refitting all others until the misfit grows too much (profile likelihood), which holds for large intervals too. Curvature: 1.96 "
                 "standard errors, from how sharply the misfit rises around its minimum.");
  page.table(table);
}

// ---- Where the residual comes from ----------------------------------------------------------------------------------

/// {"recorded travel", "mm"} of "recorded travel [mm]".
Axis axis_of(const std::string& label) {
  const auto open = label.rfind(" [");
  if (open == std::string::npos || !label.ends_with(']')) return {label, ""};
  return {label.substr(0, open), printed_unit(label.substr(open + 2, label.size() - open - 3))};
}

PlotSpecification function_plot(const json& function) {
  PlotSpecification plot{.title = fmt::format("Function of the {}", text(function, "channel", "best channel")), .x = axis_of(text(function, "argument")),
                         .y = axis_of(text(function, "effect")), .width = PlotWidth::full};
  Curve curve = make_curve("what would have to be added", numbers(function, "at"), numbers(function, "value"), CurveStyle::line, base_colour);
  std::optional<Range> values;
  extend(values, curve.y);
  extend(values, {0.0});
  Values half_width = numbers(function, "deviation");
  if (!curve.y.empty() && half_width.size() >= curve.y.size()) {
    for (double& width : half_width) width *= band_sigmas;
    curve.band = band_around(curve, half_width);
    plot.note = fmt::format("Band: \u00b1 {} standard deviations. Where it holds zero, the readings do not ask for anything.", format_number(band_sigmas));
  }
  plot.curves.push_back(std::move(curve));
  // A band far wider than the function would press it flat.
  const double limit = 4.0 * dwarfing_ratio * size_of(values);
  if (limit > 0.0 && size_of(extent(plot)) > limit) {
    plot.y_window = Range{values->lower - size_of(values), values->upper + size_of(values)};
    plot.note += " Close-up: the band goes far beyond, so the readings hardly determine the function there.";
  }
  return plot;
}

void add_functions(ReportPage& page, const json& result) {
  const auto functions = objects(result, "functions");
  if (functions.empty()) return;
  page.heading("Where the residual comes from");
  page.paragraph("Each part of the test, a channel, is given a free function instead of a known effect. A true cause acts alike in every series: what is found in some "
                 "series has to explain the residual of the others. Carried over: the share of the residual beyond noise that it explains there. Explained: the same "
                 "when all series are used to find it.");
  Table table{"", {{"Channel"}, {"What it would do"}, {"As a function of"}, {"Carried over", ColumnKind::number}, {"Explained", ColumnKind::number}, {"Shape"}, {"Accepted"}}, {}};
  for (const json& function : functions) {
    const auto accepted = flag(function, "accepted");
    table.rows.push_back({text(function, "channel", absent), text(function, "effect", absent), text(function, "argument", absent), percent(number(function, "carried_over")),
                          percent(number(function, "explained")), text(function, "shape", absent), {yes_no(accepted), accepted.value_or(false) ? Tone::good : Tone::plain}});
  }
  page.table(table);
  if (!flag(functions.front(), "accepted").value_or(false)) {
    page.paragraph("None carries over well enough to be accepted. The function that comes nearest is drawn; take it as a hint, no more.");
  }
  page.line_plot(function_plot(functions.front()));
}

// ---- The end --------------------------------------------------------------------------------------------------------

void add_next(ReportPage& page, const json& result) {
  const json& next = object(result, "next_experiment");
  const std::string what = text(next, "what");
  if (what.empty()) return;
  page.heading("What to measure next");
  page.callout(what, Tone::plain);
  const auto separates = texts(next, "separates");
  const auto difference = number(next, "difference_N");
  const auto sigmas = number(next, "difference_sigma");
  std::string sentence = separates.empty() ? "" : fmt::format("It separates {}.", joined(separates));
  if (difference) {
    sentence += fmt::format(" There the forces of the rival models differ by {} N rms{}.", measured(difference),
                            sigmas ? fmt::format(", {} times the noise of a reading", format_significant(*sigmas, 2)) : "");
  }
  if (!sentence.empty()) page.paragraph(sentence);
}

std::string time_spent(const json& result) {
  const json& seconds = object(result, "seconds");
  std::vector<std::string> stages;
  double total = 0.0;
  for (const auto& item : seconds.items()) {
    const double time = number(seconds, item.key()).value_or(0.0);
    total += time;
    if (time >= least_stage_seconds) stages.push_back(fmt::format("{} {} s", item.key(), format_significant(time, 2)));
  }
  if (stages.empty()) return "";
  return fmt::format(" Computed in {} s: {}.", format_significant(total, 2), fmt::join(stages, ", "));
}

std::string small_print(const TraceView& view) {
  const std::string version = text(view.result, "version");
  std::string print = fmt::format("Written by snare{}. The numbers are in trace.json and curves.csv beside this page.", version.empty() ? "" : " " + version);
  const auto mesh = number(view.result, "mesh_error_N");
  if (mesh) {
    print += fmt::format(" Dividing the wire into finite pieces costs at most {} N", measured(mesh));
    if (view.sigma && *view.sigma > 0.0) print += fmt::format(", {} % of the noise of a reading", format_significant(100.0 * *mesh / *view.sigma, 2));
    print += '.';
  }
  return print + time_spent(view.result) +
         " In a plot: hover for values, drag to zoom, double-click to return, click the legend to hide a curve.";
}

}  // namespace

std::string trace_report_html(const json& result) {
  const TraceView view = trace_view(result);
  ReportPage page(text(result, "title", "What the model lacks"), text(result, "source"));
  add_summary(page, view);
  add_before_and_after(page, view);
  add_residuals(page, view);
  add_rounds(page, result);
  add_parameters(page, view);
  add_functions(page, result);
  add_next(page, result);
  page.footer(small_print(view));
  return page.html();
}

}  // namespace snare::app
