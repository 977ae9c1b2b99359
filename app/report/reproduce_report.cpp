#include "app/report/reproduce_report.hpp"

#include "base/json_fields.hpp"
#include "app/report/report_page.hpp"
#include "app/report/reproduce_verdicts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::app {
namespace {

using base::json_fields::array;
using base::json_fields::member;
using base::json_fields::number;
using base::json_fields::numbers;
using base::json_fields::text;
using base::json_fields::texts;
using nlohmann::json;
using Values = std::vector<double>;

constexpr const char* absent = "\u2013";
constexpr int published_colour = 0;
constexpr int first_model_colour = 1;

/// The published scatter is drawn as this many standard deviations: 95 % of normal scatter.
constexpr double band_sigmas = 2.0;

/// A curve that reaches this many times beyond the published and the best computed one gets a close-up.
constexpr double dwarfing_ratio = 1.5;

// ---- Words ------------------------------------------------------------------------------------------------------

std::string shown(std::optional<double> value) {
  return value ? format_number(*value) : absent;
}

std::string measured(std::optional<double> value) {
  return value ? format_significant(*value) : absent;
}

/// 3.5 %, or 6.3 \u00d7 from one on.
std::string share(std::optional<double> ratio) {
  if (!ratio) return absent;
  return *ratio < 1.0 ? format_significant(100.0 * *ratio) + " %" : format_significant(*ratio) + " \u00d7";
}

/// The same as words: 3.5 % of the whole, 6.3 times the whole.
std::string share_of(double ratio, const std::string& whole) {
  return ratio < 1.0 ? share(ratio) + " of " + whole : format_significant(ratio) + " times " + whole;
}

/// {"bending stiffness", "N m\u00b2"} of bending_stiffness_Nm2.
std::pair<std::string, std::string> name_and_unit(const std::string& key) {
  static const std::vector<std::pair<std::string, std::string>> units = {
      {"_Nm2", "N m\u00b2"}, {"_N_m2", "N/m\u00b2"},   {"_N_m", "N/m"}, {"_Nm", "N m"}, {"_mm", "mm"},
      {"_GPa", "GPa"},       {"_kg_m3", "kg/m\u00b3"}, {"_1_m", "1/m"}, {"_N", "N"}};
  std::string name = key;
  std::string unit;
  for (const auto& [suffix, symbol] : units) {
    if (key.ends_with(suffix)) {
      name = key.substr(0, key.size() - suffix.size());
      unit = symbol;
      break;
    }
  }
  std::ranges::replace(name, '_', ' ');
  return {name, unit};
}

std::string series_title(const json& series) {
  const auto position = number(series, "contact_position_mm");
  if (position) return fmt::format("s\u00a0=\u00a0{}\u00a0mm", format_number(*position));
  return text(series, "name", "unnamed position");
}

std::string model_name(const json& model) {
  return text(model, "name", "unnamed");
}

std::string model_label(const json& model) {
  return text(model, "label", model_name(model));
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

// ---- Models and their curves ------------------------------------------------------------------------------------

/// How one model is drawn everywhere.
struct ModelStyle {
  std::string name;
  std::string label;
  CurveStyle style;
  int colour;
};

std::vector<ModelStyle> model_styles(const json& result) {
  std::vector<ModelStyle> styles;
  for (const json& model : array(result, "models")) {
    const bool fitted = number(model, "free").value_or(0.0) > 0.0;
    styles.push_back({model_name(model), model_label(model), fitted ? CurveStyle::line : CurveStyle::dashes,
                      first_model_colour + static_cast<int>(styles.size())});
  }
  return styles;
}

const json& computed(const json& series, const std::string& model) {
  return member(member(series, "models"), model);
}

bool stopped_early(const json& curve) {
  return curve.is_null() || !text(curve, "stopped").empty();
}

/// Computed at every position to the end of the push.
bool is_complete(const json& result, const json& model) {
  return std::ranges::none_of(array(result, "series"), [&](const json& series) {
    return stopped_early(computed(series, model_name(model)));
  });
}

/// The model of least overall error, complete ones first, since an error over less is no smaller error;
/// nullptr when no model has one.
const json* best_model(const json& result) {
  const auto rank = [&](const json& model) {
    return std::pair{!is_complete(result, model), *number(model, "rmse_N")};
  };
  const json* best = nullptr;
  for (const json& model : array(result, "models")) {
    if (number(model, "rmse_N") && (!best || rank(model) < rank(*best))) best = &model;
  }
  return best;
}

/// A curve of pairs; the shorter array ends it.
Curve make_curve(std::string name, Values x, Values y, CurveStyle style, int colour) {
  const std::size_t size = std::min(x.size(), y.size());
  x.resize(size);
  y.resize(size);
  return {std::move(name), std::move(x), std::move(y), style, colour, std::nullopt};
}

Band band_around(const Values& y, double half_width) {
  Band band{y, y};
  for (double& value : band.lower) value -= half_width;
  for (double& value : band.upper) value += half_width;
  return band;
}

Curve published_curve(const json& series, const std::string& name, int colour) {
  Curve curve = make_curve(name, numbers(series, "displacement_mm"), numbers(series, "published_N"),
                           CurveStyle::line, colour);
  const auto sigma = number(member(series, "published"), "sigma_N");
  if (sigma) curve.band = band_around(curve.y, band_sigmas * *sigma);
  return curve;
}

Range extent(const Curve& curve) {
  const Values& lower = curve.band ? curve.band->lower : curve.y;
  const Values& upper = curve.band ? curve.band->upper : curve.y;
  return {std::ranges::min(lower), std::ranges::max(upper)};
}

/// Shows first what the reference curves need, if the others reach far beyond.
void add_close_up(PlotSpecification& plot, const std::vector<std::string>& reference_names) {
  std::optional<Range> reference;
  std::vector<std::string> outside;
  const auto is_reference = [&](const Curve& curve) {
    return std::ranges::find(reference_names, curve.name) != reference_names.end();
  };
  for (const Curve& curve : plot.curves) {
    if (curve.y.empty() || !is_reference(curve)) continue;
    const Range range = extent(curve);
    if (!reference) reference = range;
    reference = Range{std::min(reference->lower, range.lower), std::max(reference->upper, range.upper)};
  }
  if (!reference || !(reference->lower < reference->upper)) return;
  const double size = reference->upper - reference->lower;
  for (const Curve& curve : plot.curves) {
    if (curve.y.empty() || is_reference(curve)) continue;
    const Range range = extent(curve);
    const double beyond = std::max(reference->lower - range.lower, range.upper - reference->upper);
    if (beyond < (dwarfing_ratio - 1.0) * size) continue;
    const double far = std::abs(range.lower) > std::abs(range.upper) ? range.lower : range.upper;
    outside.push_back(fmt::format("{} (to {} {})", curve.name, format_significant(far), plot.y.unit));
  }
  if (outside.empty()) return;
  plot.y_window = Range{reference->lower - 0.15 * size, reference->upper + 0.3 * size};
  plot.note += fmt::format("{}Close-up; beyond it: {}.", plot.note.empty() ? "" : " ", joined(outside));
}

std::string scatter_note() {
  return fmt::format("Band: published curve \u00b1 {} \u03c3.", format_number(band_sigmas));
}

// ---- Sections -----------------------------------------------------------------------------------------------------

/// Root mean square of the published scatter over the positions.
std::optional<double> overall_sigma(const json& result) {
  double sum = 0.0;
  int count = 0;
  for (const json& series : array(result, "series")) {
    const auto sigma = number(member(series, "published"), "sigma_N");
    if (!sigma) continue;
    sum += *sigma * *sigma;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / count);
}

/// Whether the best model agrees with the published curves, in one sentence.
void add_verdict(ReportPage& page, const json& result) {
  const json* best = best_model(result);
  const auto sigma = overall_sigma(result);
  if (!best || !sigma || *sigma <= 0.0) return;
  const std::string label = model_label(*best);
  const double ratio = *number(*best, "rmse_N") / *sigma;
  if (!is_complete(result, *best)) {
    page.callout(
        fmt::format("No verdict: the {} was not computed to the end of the push at every position.", label),
        Tone::bad);
  } else if (ratio > 1.0) {
    page.callout(
        fmt::format(
            "The published curves are not explained: even the {} stays {} times the published scatter "
            "away from them.",
            label, format_significant(ratio, 2)),
        Tone::bad);
  } else {
    page.callout(
        fmt::format("Over all positions together the {} agrees with the published curves to within their "
                    "scatter.",
                    label),
        Tone::good);
  }
}

void add_summary(ReportPage& page, const json& result) {
  page.heading("Summary");
  std::vector<KeyFigure> figures;
  for (const json& model : array(result, "models")) {
    const auto rmse = number(model, "rmse_N");
    const auto nrmse = number(model, "nrmse");
    figures.push_back({"Error of the " + model_label(model),
                       rmse ? measured(rmse) + " N rms" : "not computed",
                       nrmse ? share_of(*nrmse, "the range of the published force") : ""});
  }
  const auto sigma = overall_sigma(result);
  if (sigma) {
    figures.push_back({"Scatter of the published curves", measured(sigma) + " N rms",
                       "\u03c3 from the published R\u00b2: no model can be judged below it"});
  }
  if (figures.empty()) page.callout("No model was computed.", Tone::bad);
  page.key_figures(figures);

  for (const json& model : array(result, "models")) {
    const auto rmse = number(model, "rmse_N");
    const auto nrmse = number(model, "nrmse");
    const auto free = number(model, "free");
    std::string sentence = text(model, "description");
    if (!sentence.empty() && !sentence.ends_with('.')) sentence += '.';
    if (!rmse) {
      page.paragraph(fmt::format("The {} was not computed. {}", model_label(model), sentence));
      continue;
    }
    std::string freedom;
    if (free && *free == 0.0) freedom = " with nothing fitted";
    if (free && *free > 0.0)
      freedom = fmt::format(" with {} fitted number{}", format_number(*free), *free == 1.0 ? "" : "s");
    page.paragraph(fmt::format(
        "The {}{} differs from the published force by {} N rms over {}{}{}. {}", model_label(model), freedom,
        measured(rmse), is_complete(result, model) ? "all positions" : "what was computed",
        nrmse ? ", " + share_of(*nrmse, "its range") : "",
        sigma && *sigma > 0.0
            ? fmt::format(" and {} times the published scatter", format_significant(*rmse / *sigma, 2))
            : "",
        sentence));
  }
  add_verdict(page, result);
}

void add_overview(ReportPage& page, const json& result) {
  const json* best = best_model(result);
  PlotSpecification force{.title = "Force at all positions",
                          .x = {"displacement d", "mm"},
                          .y = {"force F", "N"},
                          .note = "Solid: published. " + scatter_note()};
  PlotSpecification stiffness{.title = "Tangent stiffness at all positions",
                              .x = {"displacement d", "mm"},
                              .y = {"stiffness dF/dd", "N/mm"},
                              .note = "Solid: published, 2 A d + B."};
  int colour = first_model_colour;
  for (const json& series : array(result, "series")) {
    const std::string position = series_title(series);
    force.curves.push_back(published_curve(series, position + " published", colour));
    stiffness.curves.push_back(make_curve(position + " published", numbers(series, "displacement_mm"),
                                          numbers(series, "published_stiffness_N_mm"), CurveStyle::line,
                                          colour));
    if (best) {
      const json& model = computed(series, model_name(*best));
      const Values d = numbers(series, "displacement_mm");
      const std::string name = position + " " + model_label(*best);
      force.curves.push_back(make_curve(name, d, numbers(model, "force_N"), CurveStyle::dashes, colour));
      stiffness.curves.push_back(
          make_curve(name, d, numbers(model, "stiffness_N_mm"), CurveStyle::dashes, colour));
    }
    ++colour;
  }
  if (best) {
    force.note += " Dashed: " + model_label(*best) + ".";
    stiffness.note += " Dashed: " + model_label(*best) + ".";
  }
  page.line_plot(force);
  page.line_plot(stiffness);
}

std::string scatter_ratio(std::optional<double> rmse, std::optional<double> sigma) {
  if (!rmse || !sigma || *sigma <= 0.0) return absent;
  return format_significant(*rmse / *sigma, 2);
}

void add_error_table(ReportPage& page, const json& result) {
  page.heading("Errors");
  Table table{
      "rmse: root mean square of computed minus published force. Range: of the published force. \u03c3: "
      "published scatter.",
      {{"Position"},
       {"Model"},
       {"rmse [N]", ColumnKind::number},
       {"rmse / range", ColumnKind::number},
       {"rmse / \u03c3", ColumnKind::number},
       {"Largest force computed [N]", ColumnKind::number},
       {"Largest force published [N]", ColumnKind::number},
       {"Pushed to [mm]", ColumnKind::number}},
      {}};
  for (const json& series : array(result, "series")) {
    const Values published = numbers(series, "published_N");
    const auto sigma = number(member(series, "published"), "sigma_N");
    for (const json& model : array(result, "models")) {
      const json& curve = computed(series, model_name(model));
      const auto rmse = number(curve, "rmse_N");
      table.rows.push_back({series_title(series),
                            model_label(model) + (stopped_early(curve) ? " (incomplete)" : ""),
                            measured(rmse), share(number(curve, "nrmse")), scatter_ratio(rmse, sigma),
                            measured(number(curve, "max_N")),
                            published.empty() ? absent : format_significant(std::ranges::max(published)),
                            shown(number(series, "range_mm"))});
    }
  }
  const auto sigma = overall_sigma(result);
  for (const json& model : array(result, "models")) {
    const auto rmse = number(model, "rmse_N");
    table.rows.push_back({"all", model_label(model), measured(rmse), share(number(model, "nrmse")),
                          scatter_ratio(rmse, sigma), "", "", ""});
  }
  page.table(table);
}

/// Value with the digits that its standard error leaves meaningful.
std::string parameter_text(const json& parameter) {
  const auto value = number(parameter, "value");
  const auto error = number(parameter, "stderr");
  if (!value) return absent;
  if (!error) return format_number(*value);
  if (*error <= 0.0 || *value == 0.0) return fmt::format("{} \u00b1 {}", shown(value), shown(error));
  const int digits =
      static_cast<int>(std::floor(std::log10(std::abs(*value))) - std::floor(std::log10(*error))) + 2;
  return fmt::format("{} \u00b1 {}", format_significant(*value, std::clamp(digits, 2, 9)),
                     format_significant(*error, 2));
}

void add_parameters(ReportPage& page, const json& result) {
  std::vector<std::string> keys;
  Table table{"\u00b1: one standard error of a fitted number; a number without it was declared or held.",
              {{"Parameter", ColumnKind::code}, {"Unit"}},
              {}};
  for (const json& model : array(result, "models")) {
    const std::string label = model_label(model);
    table.columns.push_back({label, ColumnKind::number});
    for (const auto& [key, parameter] : member(model, "parameters").items()) {
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    }
  }
  for (const std::string& key : keys) {
    std::vector<Cell> row{key, ""};
    for (const json& model : array(result, "models")) {
      const json& parameter = member(member(model, "parameters"), key);
      row.emplace_back(parameter_text(parameter));
      if (row[1].text.empty()) row[1].text = text(parameter, "unit");
    }
    table.rows.push_back(row);
  }
  if (keys.empty()) return;
  page.heading("Parameters");
  page.table(table);
}

void add_wire(ReportPage& page, const json& result) {
  const json& wire = member(result, "wire");
  if (!wire.is_object() || wire.empty()) return;
  page.subheading("The wire as declared");
  Table table{"", {{"Quantity"}, {"Value", ColumnKind::number}, {"Unit"}}, {}};
  std::vector<std::string> keys = {"diameter_mm", "length_mm", "span_mm", "bending_stiffness_Nm2",
                                   "axial_stiffness_N"};
  for (const auto& [key, value] : wire.items()) {
    if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  }
  for (const std::string& key : keys) {
    const json& value = member(wire, key);
    if (value.is_null()) continue;
    const auto [name, unit] = name_and_unit(key);
    table.rows.push_back(
        {name, value.is_string() ? value.get<std::string>() : shown(number(wire, key)), unit});
  }
  page.table(table);
}

std::string published_law(const json& published) {
  const auto a = number(published, "A_N_m2");
  const auto b = number(published, "B_N_m");
  const auto c = number(published, "C_N");
  if (!a || !b || !c) return "";
  std::string law =
      fmt::format("Published: F = A d\u00b2 + B d + C with A = {} N/m\u00b2, B = {} N/m, C = {} N",
                  format_number(*a), format_number(*b), format_number(*c));
  if (const auto r2 = number(published, "R2")) law += fmt::format(", R\u00b2 = {}", format_number(*r2));
  if (const auto sigma = number(published, "sigma_N"))
    law += fmt::format("; scatter \u03c3 = {} N", measured(sigma));
  return law + ".";
}

void add_force_plots(ReportPage& page, const json& series, const std::vector<ModelStyle>& styles,
                     const std::string& best_label) {
  const Values d = numbers(series, "displacement_mm");
  const Values published = numbers(series, "published_N");
  PlotSpecification force{.title = "Force",
                          .x = {"displacement d", "mm"},
                          .y = {"force F", "N"},
                          .curves = {published_curve(series, "published", published_colour)},
                          .note = scatter_note()};
  PlotSpecification residual{.title = "Residual: computed minus published force",
                             .x = {"displacement d", "mm"},
                             .y = {"residual", "N"}};
  PlotSpecification stiffness{
      .title = "Tangent stiffness",
      .x = {"displacement d", "mm"},
      .y = {"stiffness dF/dd", "N/mm"},
      .curves = {make_curve("published, 2 A d + B", d, numbers(series, "published_stiffness_N_mm"),
                            CurveStyle::line, published_colour)}};
  if (const auto sigma = number(member(series, "published"), "sigma_N")) {
    Curve scatter = make_curve(fmt::format("published scatter \u00b1 {} \u03c3", format_number(band_sigmas)),
                               d, Values(published.size(), 0.0), CurveStyle::line, published_colour);
    scatter.band = band_around(scatter.y, band_sigmas * *sigma);
    residual.curves.push_back(std::move(scatter));
  }
  for (const ModelStyle& style : styles) {
    const json& model = computed(series, style.name);
    const Values computed_force = numbers(model, "force_N");
    force.curves.push_back(make_curve(style.label, d, computed_force, style.style, style.colour));
    stiffness.curves.push_back(
        make_curve(style.label, d, numbers(model, "stiffness_N_mm"), style.style, style.colour));
    Values difference;
    for (std::size_t i = 0; i < std::min(computed_force.size(), published.size()); ++i) {
      difference.push_back(computed_force[i] - published[i]);
    }
    residual.curves.push_back(make_curve(style.label, d, difference, style.style, style.colour));
  }

  PlotSpecification close_up = force;
  add_close_up(close_up, {"published", best_label});
  add_close_up(residual, {residual.curves.empty() ? "" : residual.curves.front().name, best_label});
  add_close_up(stiffness, {"published, 2 A d + B", best_label});
  page.line_plot(close_up);
  if (close_up.y_window) {
    force.title = "Force, all models at full scale";
    page.line_plot(force);
  }
  page.line_plot(residual);
  page.line_plot(stiffness);
}

/// The outline of the pusher, to scale; the point itself when it is a knife edge.
Curve pusher_outline(const json& shape, int colour) {
  const auto x = number(shape, "pusher_x_mm");
  const auto y = number(shape, "pusher_y_mm");
  const double radius = number(shape, "pusher_radius_mm").value_or(0.0);
  Curve outline;
  outline.colour = colour;
  if (!x || !y) return outline;
  constexpr int segments = 48;
  for (int i = 0; i <= (radius > 0.0 ? segments : 0); ++i) {
    const double angle = 2.0 * std::numbers::pi * i / segments;
    outline.x.push_back(*x + radius * std::cos(angle));
    outline.y.push_back(*y + radius * std::sin(angle));
  }
  return outline;
}

void add_wire_plots(ReportPage& page, const json& series, const ModelStyle& style) {
  const json& shapes = array(computed(series, style.name), "shapes");
  if (shapes.empty()) return;
  PlotSpecification shape_plot{.title = fmt::format("Shapes of the wire, {}", style.label),
                               .x = {"along the chord x", "mm"},
                               .y = {"off the chord y", "mm"},
                               .scale = AxesScale::equal,
                               .palette = Palette::sequential,
                               .width = PlotWidth::full,
                               .note = "Drawn to scale, with the outline of the pusher."};
  PlotSpecification tension{.title = fmt::format("Tension along the wire, {}", style.label),
                            .x = {"arc length from the left mount", "mm"},
                            .y = {"tension T", "N"},
                            .palette = Palette::sequential};
  PlotSpecification moment{.title = fmt::format("Bending moment along the wire, {}", style.label),
                           .x = {"arc length from the left mount", "mm"},
                           .y = {"bending moment M", "N m"},
                           .palette = Palette::sequential};
  int colour = 0;
  for (const json& shape : shapes) {
    const std::string name = fmt::format("d = {} mm", shown(number(shape, "displacement_mm")));
    const Values arc = numbers(shape, "arc_mm");
    shape_plot.curves.push_back(
        make_curve(name, numbers(shape, "x_mm"), numbers(shape, "y_mm"), CurveStyle::line, colour));
    shape_plot.curves.push_back(pusher_outline(shape, colour));
    tension.curves.push_back(make_curve(name, arc, numbers(shape, "tension_N"), CurveStyle::line, colour));
    moment.curves.push_back(make_curve(name, arc, numbers(shape, "moment_Nm"), CurveStyle::line, colour));
    ++colour;
  }
  page.line_plot(shape_plot);
  page.line_plot(tension);
  page.line_plot(moment);
}

void add_series(ReportPage& page, const json& result, const json& series) {
  const auto styles = model_styles(result);
  const json* best = best_model(result);
  page.heading(series_title(series));
  const std::string law = published_law(member(series, "published"));
  const auto range = number(series, "range_mm");
  page.paragraph(law +
                 (range ? fmt::format(" Pushed from first touch to {} mm.", format_number(*range)) : ""));
  for (const ModelStyle& style : styles) {
    const json& model = computed(series, style.name);
    const std::string reason = text(model, "stopped");
    if (model.is_null()) page.callout(fmt::format("The {} was not computed here.", style.label), Tone::bad);
    if (!reason.empty())
      page.callout(fmt::format("The {} stopped early: {}", style.label, reason), Tone::bad);
  }
  add_force_plots(page, series, styles, best ? model_label(*best) : "");
  for (const ModelStyle& style : styles) add_wire_plots(page, series, style);
}

}  // namespace

std::string reproduce_report_html(const json& result) {
  ReportPage page(text(result, "title", "Static push on a loose wire"), text(result, "source"));
  add_summary(page, result);
  add_overview(page, result);
  add_error_table(page, result);
  add_parameters(page, result);
  add_verdicts(page, result);
  add_wire(page, result);
  for (const json& series : array(result, "series")) add_series(page, result, series);

  const auto assumptions = texts(result, "assumptions");
  if (!assumptions.empty()) {
    page.heading("Assumptions");
    page.list(assumptions);
  }
  const std::string version = text(result, "version");
  page.footer(
      fmt::format("Written by snare{}. The numbers are in reproduce.json and curves.csv beside this page. "
                  "In a plot: hover for values, drag to zoom, double-click to return, "
                  "click the legend to hide a curve.",
                  version.empty() ? "" : " " + version));
  return page.html();
}

}  // namespace snare::app
