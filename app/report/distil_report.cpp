#include "app/report/distil_report.hpp"

#include "app/report/report_page.hpp"
#include "results/in_mm.hpp"
#include "results/version.hpp"

#include <fmt/format.h>

namespace snare::app {

using namespace results;

namespace {

using reduction::DistilledCase;
using reduction::DistilledPlace;
using reduction::FittedLaw;

std::string at(const DistilledPlace& place) {
  return fmt::format("s = {:.4g} mm", 1e3 * place.position);
}

void add_stiffness(ReportPage& page, const DistilledCase& one) {
  PlotSpecification secant{
      "Spring of the linear spring-dashpot law", {"travel", "mm"}, {"stiffness F/d", "N/m"}};
  PlotSpecification tangent{"Tangent stiffness", {"travel", "mm"}, {"stiffness dF/dd", "N/m"}};
  secant.note = "Larger penetration, larger stiffness; compare Abiko et al., Fig. 11.";
  int colour = 0;
  for (const DistilledPlace& place : one.places) {
    secant.curves.push_back(
        {at(place), in_mm(place.stiffness.travel), place.stiffness.secant, CurveStyle::line, colour});
    tangent.curves.push_back(
        {at(place), in_mm(place.stiffness.travel), place.stiffness.tangent, CurveStyle::line, colour++});
  }
  page.line_plot(secant);
  PlotSpecification recorded{
      "The same over the recorded displacement", {"recorded displacement", "mm"}, {"stiffness F/d", "N/m"}};
  recorded.note =
      "With the displacement that the machine had recorded at first touch, as in Abiko et al., Fig. 11.";
  colour = 0;
  for (const DistilledPlace& place : one.places) {
    if (place.recorded) {
      const reduction::StiffnessCurve& k = place.recorded->stiffness;
      recorded.curves.push_back({at(place), in_mm(k.travel), k.secant, CurveStyle::line, colour});
    }
    ++colour;
  }
  if (!recorded.curves.empty()) page.line_plot(recorded);
  page.line_plot(tangent);
}

void add_laws(ReportPage& page, const DistilledPlace& place) {
  PlotSpecification force{"Laws at " + at(place), {"travel", "mm"}, {"force", "N"}};
  PlotSpecification error{"Errors at " + at(place), {"travel", "mm"}, {"law less full wire", "N"}};
  const std::vector<double>& d = place.full.knots();
  std::vector<double> full;
  full.reserve(d.size());
  for (const double x : d) full.push_back(place.full.value(x));
  force.curves.push_back({"full wire", in_mm(d), full, CurveStyle::line, 0});
  Table forms;
  forms.columns = {"law"_text, "form"_text, "numbers"_text};
  Table table;
  table.columns = {"law"_text,
                   "largest error, N"_number,
                   "rms, N"_number,
                   "of the force"_number,
                   "stiffness, largest"_number,
                   "energy, largest"_number};
  int colour = 1;
  for (const FittedLaw& law : place.laws) {
    std::vector<double> values, off;
    for (std::size_t i = 0; i < d.size(); ++i) {
      values.push_back(law.form->force(law.values, d[i]));
      off.push_back(values.back() - full[i]);
    }
    force.curves.push_back({law.form->name(), in_mm(d), values, CurveStyle::dashes, colour});
    error.curves.push_back({law.form->name(), in_mm(d), off, CurveStyle::line, colour++});
    std::string numbers;
    const auto names = law.form->parameters();
    for (std::size_t i = 0; i < names.size(); ++i) {
      numbers += fmt::format("{}{} = {:.5g} {}", i == 0 ? "" : ", ", names[i].name,
                             law.values[static_cast<Eigen::Index>(i)], names[i].unit);
    }
    const auto share = [](double x, double of) {
      return of > 0.0 ? format_significant(100.0 * x / of, 2) + " %" : std::string("-");
    };
    const reduction::LawError& e = law.error;
    forms.rows.push_back({law.form->name(), law.form->formula(), numbers});
    table.rows.push_back({law.form->name(), format_significant(e.largest_force),
                          format_significant(e.rms_force), share(e.largest_force, e.force_range),
                          share(e.largest_stiffness, e.stiffness_range),
                          share(e.largest_energy, e.energy_range)});
  }
  page.subheading(at(place));
  page.table(forms);
  page.table(table);
  page.line_plot(force);
  page.line_plot(error);
}

void add_map(ReportPage& page, const DistilledCase& one) {
  PlotSpecification plot{
      "Where the closed forms are within 5 % of the full wire", {"slack", "mm"}, {"travel", "mm"}};
  plot.note = fmt::format(
      "Nothing fitted; at mid-span, travel up to {:.4g} mm. Between the points of one slack the law is "
      "within 5 %. "
      "Negative slack is pretension.",
      1e3 * one.map.travel.back());
  Curve stretched{"stretched wire", {}, {}, CurveStyle::points, 1};
  Curve tensioned{"tensioned wire", {}, {}, CurveStyle::points, 2};
  Curve computed{"slacks looked at", {}, {}, CurveStyle::points, 0};
  for (const reduction::LawMapRow& row : one.map.rows) {
    computed.x.push_back(1e3 * row.slack);
    computed.y.push_back(0.0);
    for (const auto& [curve, law] : {std::pair{&stretched, &reduction::LawMapRow::stretched},
                                     std::pair{&tensioned, &reduction::LawMapRow::tensioned}}) {
      const auto range = one.map.within(row, law, 0.05);
      if (!range) continue;
      for (const double d : one.map.travel) {
        if (!range->contains(d)) continue;
        curve->x.push_back(1e3 * row.slack);
        curve->y.push_back(1e3 * d);
      }
    }
  }
  plot.curves = {computed};
  for (const Curve* curve : {&stretched, &tensioned}) {
    if (curve->x.empty())
      plot.note += " The " + curve->name + " law is nowhere.";
    else
      plot.curves.push_back(*curve);
  }
  page.line_plot(plot);
}

void add_damping(ReportPage& page, const DistilledCase& one) {
  page.heading("Damping");
  if (one.wire.dissipates())
    page.paragraph(
        "Friction and strands lose the same at any rate: their loop and the load/unload law are in law.json, "
        "no c.");
  if (one.places.front().impacts.empty()) {
    page.paragraph("No impacts were asked, so no dashpot is given: see [damping] of the wire file.");
    return;
  }
  page.paragraph(
      "A body on a slide along the push meets the full wire in motion. The dashpot c makes the law L(d) + c "
      "d' return "
      "the body with the same "
      "speed; it stands for all that the body loses, to the material and to the vibration that stays in the "
      "wire.");
  Table table{"",
              {"Position"_text, "Speed [m/s]"_number, "Restitution"_number, "c [N s/m]"_number,
               "Peak, full wire [N]"_number, "Peak, law [N]"_number, "Largest travel [mm]"_number}};
  for (const DistilledPlace& place : one.places) {
    for (const reduction::ImpactDamping& i : place.impacts) {
      table.rows.push_back({at(place), format_significant(i.speed), format_significant(i.restitution),
                            i.damping ? format_significant(*i.damping) : "-",
                            format_significant(i.peak_force),
                            i.damping ? format_significant(i.law_peak_force) : "-",
                            format_significant(1e3 * i.largest_travel)});
    }
  }
  page.table(table);
}

}  // namespace

std::string distil_report_html(const reduction::WireFile& file, const reduction::Distillation& distillation,
                               const std::vector<std::string>& warnings) {
  ReportPage page(file.title.empty() ? "Distilled laws of a snare wire" : file.title, file.source);
  page.doubts(warnings, false);
  for (std::size_t c = 0; c < distillation.cases.size(); ++c) {
    const DistilledCase& one = distillation.cases[c];
    const reduction::TableError& e = one.table.loading_error;
    const auto& axes = one.table.loading->axes();
    page.heading(distillation.cases.size() == 1 ? "The exact table"
                                                : fmt::format("Case {}: the exact table", c + 1));
    page.key_figures({{"Knots", fmt::format("{} x {} x {}", axes[0].size(), axes[1].size(), axes[2].size()),
                       "travel, position, slack"},
                      {"Stated bound", format_significant(100.0 * e.bound / e.force_range, 2) + " %",
                       fmt::format("{:.3g} N of {:.4g} N", e.bound, e.force_range),
                       e.bound <= file.settings.tolerance * e.force_range ? Tone::good : Tone::bad},
                      {"Largest error found", fmt::format("{:.3g} N", e.largest),
                       fmt::format("at {} points off the knots", e.points)},
                      {"Full wire solved", fmt::format("{} curves", one.table.curves), ""}});
    page.heading("Stiffness");
    add_stiffness(page, one);
    page.heading("Simple laws");
    for (const DistilledPlace& place : one.places) add_laws(page, place);
    add_damping(page, one);
    page.heading("Map of the closed forms");
    add_map(page, one);
  }
  page.footer("snare " + version());
  return page.html();
}

}  // namespace snare::app
