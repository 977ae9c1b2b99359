#include "app/report/reproduce_plots.hpp"

#include "app/report/report_words.hpp"
#include "results/in_mm.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace snare::app {

using namespace results;

namespace {

using identification::Prediction;
using identification::Series;

constexpr int published_colour = 0;
constexpr int first_model_colour = 1;

/// A curve that reaches this many times beyond the published and the best computed one gets a close-up.
constexpr double close_up_ratio = 1.5;

constexpr const char* scatter_note = "Band: published curve \u00b1 {} \u03c3.";

/// How a model is drawn everywhere.
CurveStyle style_of(const ReproducedModel& model) {
  return model.free > 0 ? CurveStyle::line : CurveStyle::dashes;
}

Values displacement_mm(const Series& series) {
  return in_mm(identification::measured_displacement(series));
}

Values computed_force(const Prediction* prediction) {
  return prediction ? prediction->force : Values{};
}

Values computed_stiffness(const Series& series, const Prediction* prediction) {
  if (!prediction) return {};
  return tangent_stiffness(identification::measured_displacement(series), prediction->force);
}

Curve published_curve(const Series& series, const std::string& name, int colour) {
  Curve curve = make_curve(name, displacement_mm(series), identification::measured_force(series),
                           CurveStyle::line, colour);
  if (const auto sigma = known(published_scatter(series))) {
    curve.band = band_around(curve.y, Values(curve.y.size(), *sigma));
  }
  return curve;
}

/// Shows first what the reference curves need, if the others reach far beyond.
void add_close_up(PlotSpecification& plot, const Words& reference_names) {
  std::optional<Range> reference;
  const auto is_reference = [&](const Curve& curve) {
    return std::ranges::find(reference_names, curve.name) != reference_names.end();
  };
  for (const Curve& curve : plot.curves) {
    if (curve.y.empty() || !is_reference(curve)) continue;
    const Range range = extent({curve});
    if (!reference) reference = range;
    reference = Range{std::min(reference->lower, range.lower), std::max(reference->upper, range.upper)};
  }
  if (!reference || !(reference->lower < reference->upper)) return;
  Words outside;
  for (const Curve& curve : plot.curves) {
    if (curve.y.empty() || is_reference(curve)) continue;
    const Range range = extent({curve});
    const double beyond = std::max(reference->lower - range.lower, range.upper - reference->upper);
    if (beyond < (close_up_ratio - 1.0) * size_of(*reference)) continue;
    const double far = std::abs(range.lower) > std::abs(range.upper) ? range.lower : range.upper;
    outside.push_back(fmt::format("{} (to {} {})", curve.name, format_significant(far), plot.y.unit));
  }
  if (outside.empty()) return;
  close_up(plot, *reference, {0.15, 0.3}, fmt::format("Close-up; beyond it: {}.", fmt::join(outside, ", ")));
}

std::string published_law(const Series& series) {
  if (!series.law) return "";
  const identification::QuadraticLaw& law = *series.law;
  return fmt::format(
      "Published: F = A d\u00b2 + B d + C with A = {} N/m\u00b2, B = {} N/m, C = {} N, R\u00b2 = {}; "
      "scatter \u03c3 = {} N.",
      format_number(law.a), format_number(law.b), format_number(law.c), format_number(law.r_squared),
      measured(law.scatter()));
}

void add_force_plots(ReportPage& page, const Reproduction& result, std::size_t k) {
  const Series& series = result.experiment.series[k];
  const ReproducedModel* best = result.best_model();
  const std::string best_label = best ? best->label : "";
  const Values d = displacement_mm(series);
  const Values published = identification::measured_force(series);
  const char* published_slope = "published, 2 A d + B";
  PlotSpecification force{.title = "Force",
                          .x = {"displacement d", "mm"},
                          .y = {"force F", "N"},
                          .curves = {published_curve(series, "published", published_colour)},
                          .note = fmt::format(scatter_note, format_number(band_sigmas))};
  PlotSpecification residual{.title = "Residual: computed minus published force",
                             .x = {"displacement d", "mm"},
                             .y = {"residual", "N"}};
  PlotSpecification stiffness{.title = "Tangent stiffness",
                              .x = {"displacement d", "mm"},
                              .y = {"stiffness dF/dd", "N/mm"},
                              .curves = {make_curve(published_slope, d, published_stiffness(series),
                                                    CurveStyle::line, published_colour)}};
  if (const auto sigma = known(published_scatter(series))) {
    Curve scatter = make_curve(fmt::format("published scatter \u00b1 {} \u03c3", format_number(band_sigmas)),
                               d, Values(published.size(), 0.0), CurveStyle::line, published_colour);
    scatter.band = band_around(scatter.y, Values(scatter.y.size(), *sigma));
    residual.curves.push_back(std::move(scatter));
  }
  int colour = first_model_colour;
  for (const ReproducedModel& model : result.models) {
    const auto add = [&](PlotSpecification& plot, const Values& y) {
      plot.curves.push_back(make_curve(model.label, d, y, style_of(model), colour));
    };
    const Values computed = computed_force(model.at(k));
    Values difference;
    for (std::size_t i = 0; i < std::min(computed.size(), published.size()); ++i) {
      difference.push_back(computed[i] - published[i]);
    }
    add(force, computed);
    add(stiffness, computed_stiffness(series, model.at(k)));
    add(residual, difference);
    ++colour;
  }

  PlotSpecification force_close_up = force;
  add_close_up(force_close_up, {"published", best_label});
  add_close_up(residual, {residual.curves.empty() ? "" : residual.curves.front().name, best_label});
  add_close_up(stiffness, {published_slope, best_label});
  page.line_plot(force_close_up);
  if (force_close_up.y_window) {
    force.title = "Force, all models at full scale";
    page.line_plot(force);
  }
  page.line_plot(residual);
  page.line_plot(stiffness);
}

/// The outline of the pusher, to scale; the point itself when it is a knife edge.
Curve pusher_outline(const coupling::PushShape& shape, double radius_mm, int colour) {
  Curve outline;
  outline.colour = colour;
  constexpr int segments = 48;
  for (int i = 0; i <= (radius_mm > 0.0 ? segments : 0); ++i) {
    const double angle = 2.0 * std::numbers::pi * i / segments;
    outline.x.push_back(1e3 * shape.pusher_centre.x() + radius_mm * std::cos(angle));
    outline.y.push_back(1e3 * shape.pusher_centre.y() + radius_mm * std::sin(angle));
  }
  return outline;
}

void add_wire_plots(ReportPage& page, const Series& series, const Prediction& prediction,
                    const std::string& label) {
  const std::vector<coupling::PushShape>& shapes = prediction.curve.curve.shapes;
  if (shapes.empty()) return;
  PlotSpecification shape_plot{.title = fmt::format("Shapes of the wire, {}", label),
                               .x = {"along the chord x", "mm"},
                               .y = {"off the chord y", "mm"},
                               .scale = AxesScale::equal,
                               .palette = Palette::sequential,
                               .width = PlotWidth::full,
                               .note = "Drawn to scale, with the outline of the pusher."};
  PlotSpecification tension{.title = fmt::format("Tension along the wire, {}", label),
                            .x = {"arc length from the left mount", "mm"},
                            .y = {"tension T", "N"},
                            .palette = Palette::sequential};
  PlotSpecification moment{.title = fmt::format("Bending moment along the wire, {}", label),
                           .x = {"arc length from the left mount", "mm"},
                           .y = {"bending moment M", "N m"},
                           .palette = Palette::sequential};
  int colour = 0;
  for (const coupling::PushShape& shape : shapes) {
    const double displacement = shape.travel + prediction.reading.displacement_offset;
    const std::string name = fmt::format("d = {} mm", shown(1e3 * displacement));
    const auto add = [&](PlotSpecification& plot, const Values& x, const Values& y) {
      plot.curves.push_back(make_curve(name, x, y, CurveStyle::line, colour));
    };
    add(shape_plot, in_mm(shape.x), in_mm(shape.y));
    shape_plot.curves.push_back(pusher_outline(shape, 1e3 * series.test.pusher.radius, colour));
    add(tension, in_mm(shape.arc), shape.tension);
    add(moment, in_mm(shape.arc), shape.moment);
    ++colour;
  }
  page.line_plot(shape_plot);
  page.line_plot(tension);
  page.line_plot(moment);
}

}  // namespace

std::string series_title(const Series& series) {
  return fmt::format("s\u00a0=\u00a0{}\u00a0mm", format_number(1e3 * series.test.contact_position));
}

void add_overview(ReportPage& page, const Reproduction& result) {
  const ReproducedModel* best = result.best_model();
  PlotSpecification force{
      .title = "Force at all positions",
      .x = {"displacement d", "mm"},
      .y = {"force F", "N"},
      .note = "Solid: published. " + fmt::format(scatter_note, format_number(band_sigmas))};
  PlotSpecification stiffness{.title = "Tangent stiffness at all positions",
                              .x = {"displacement d", "mm"},
                              .y = {"stiffness dF/dd", "N/mm"},
                              .note = "Solid: published, 2 A d + B."};
  int colour = first_model_colour;
  for (std::size_t k = 0; k < result.experiment.series.size(); ++k) {
    const Series& series = result.experiment.series[k];
    const Values d = displacement_mm(series);
    const std::string position = series_title(series);
    force.curves.push_back(published_curve(series, position + " published", colour));
    stiffness.curves.push_back(
        make_curve(position + " published", d, published_stiffness(series), CurveStyle::line, colour));
    if (best) {
      const Prediction* prediction = best->at(k);
      const std::string name = position + " " + best->label;
      force.curves.push_back(make_curve(name, d, computed_force(prediction), CurveStyle::dashes, colour));
      stiffness.curves.push_back(
          make_curve(name, d, computed_stiffness(series, prediction), CurveStyle::dashes, colour));
    }
    ++colour;
  }
  if (best) {
    force.note += " Dashed: " + best->label + ".";
    stiffness.note += " Dashed: " + best->label + ".";
  }
  page.line_plot(force);
  page.line_plot(stiffness);
}

void add_series(ReportPage& page, const Reproduction& result, std::size_t k) {
  const Series& series = result.experiment.series[k];
  page.heading(series_title(series));
  const double range = 1e3 * std::ranges::max(identification::measured_displacement(series));
  page.paragraph(published_law(series) +
                 fmt::format(" Pushed from first touch to {} mm.", format_number(range)));
  for (const ReproducedModel& model : result.models) {
    const Prediction* prediction = model.at(k);
    const std::string reason = prediction ? reason_stopped(*prediction) : "";
    if (!prediction) page.callout(fmt::format("The {} was not computed here.", model.label), Tone::bad);
    if (!reason.empty()) {
      page.callout(fmt::format("The {} stopped early: {}", model.label, reason), Tone::bad);
    }
  }
  add_force_plots(page, result, k);
  for (const ReproducedModel& model : result.models) {
    if (model.at(k)) add_wire_plots(page, series, *model.at(k), model.label);
  }
}

}  // namespace snare::app
