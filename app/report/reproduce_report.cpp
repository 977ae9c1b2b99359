#include "app/report/reproduce_report.hpp"

#include "app/report/report_page.hpp"
#include "app/report/report_words.hpp"
#include "app/report/reproduce_evidence.hpp"
#include "app/report/reproduce_plots.hpp"
#include "results/published_map.hpp"
#include "results/trace_findings.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::app {

namespace {

using identification::Misfit;
using identification::Prediction;
using identification::Series;

/// 3.5 %, or 6.3 \u00d7 from one on.
std::string share(double ratio) {
  return ratio < 1.0 ? measured(100.0 * ratio, " %") : measured(ratio, " \u00d7");
}

/// The same as words: 3.5 % of the whole, 6.3 times the whole.
std::string share_of(double ratio, const std::string& whole) {
  return ratio < 1.0 ? share(ratio) + " of " + whole : measured(ratio) + " times " + whole;
}

std::string scatter_ratio(double rmse, std::optional<double> sigma) {
  if (!sigma || *sigma <= 0.0) return absent;
  return format_significant(rmse / *sigma, 2);
}

/// Root mean square of the published scatter over the positions.
std::optional<double> overall_sigma(const Reproduction& result) {
  double sum = 0.0;
  int count = 0;
  for (const Series& series : result.experiment.series) {
    const auto sigma = known(published_scatter(series));
    if (!sigma) continue;
    sum += *sigma * *sigma;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / count);
}

/// The verdict of the tracing where no map of explanations stands above it; until it has ended, the error of
/// the best model over the scatter.
void add_verdict(ReportPage& page, const Reproduction& result) {
  if (result.map) return;
  if (result.trace) {
    page.callout(results::verdict(*result.trace), result.trace->explained ? Tone::good : Tone::bad);
    return;
  }
  const ReproducedModel* best = result.best_model();
  const auto sigma = overall_sigma(result);
  if (!best || !sigma || *sigma <= 0.0) return;
  const double ratio = best->misfit(result.experiment)->rmse / *sigma;
  if (!best->complete(result.experiment)) {
    page.callout(fmt::format("No verdict: the {} was not computed to the end of the push at every position.",
                             best->label),
                 Tone::bad);
  } else {
    page.callout(
        fmt::format(
            "No verdict: the tracing is missing. The {} is {} times the published scatter away from the "
            "published curves.",
            best->label, format_significant(ratio, 2)),
        Tone::plain);
  }
}

/// What a model is, how many numbers were fitted, how far off it is.
std::string model_sentence(const Reproduction& result, const ReproducedModel& model) {
  std::string description = model.description;
  if (!description.empty() && !description.ends_with('.')) description += '.';
  const auto misfit = model.misfit(result.experiment);
  if (!misfit) return fmt::format("The {} was not computed. {}", model.label, description);
  const std::string freedom =
      model.free == 0 ? " with nothing fitted"
                      : fmt::format(" with {} fitted number{}", model.free, model.free == 1 ? "" : "s");
  const auto sigma = overall_sigma(result);
  const std::string over_scatter =
      sigma && *sigma > 0.0
          ? fmt::format(" and {} times the published scatter", format_significant(misfit->rmse / *sigma, 2))
          : "";
  return fmt::format("The {}{} differs from the published force by {} N rms over {}, {}{}. {}", model.label,
                     freedom, measured(misfit->rmse),
                     model.complete(result.experiment) ? "all positions" : "what was computed",
                     share_of(misfit->nrmse, "its range"), over_scatter, description);
}

/// How the published fits may have come about, by falling probability.
void add_map(ReportPage& page, const Reproduction& result) {
  if (!result.map) return;
  using results::PublishedAnswer;
  const results::PublishedVerdict verdict = results::published_verdict(*result.map);
  page.heading("What the published fits show");
  const bool good = verdict.answer == PublishedAnswer::explained;
  page.callout(verdict.headline, good ? Tone::good : Tone::plain);
  std::vector<nlohmann::json> entries = result.map->at("map");
  std::ranges::stable_sort(entries, std::greater(),
                           [](const nlohmann::json& e) { return e["probability"][0].get<double>(); });
  Table table{
      "Probability among all that were weighed, ranges of the fits even in their logarithm and even in "
      "themselves. "
      "Range, readings and "
      "numbers: the likeliest. p: that such a test gives published fits as far from it, ranges and readings "
      "fitted "
      "too.",
      {"What differs from the declared test"_text, "Probability"_number, "ranges even"_number,
       "Range [mm]"_number, "Readings"_number, "p"_number,
       "More compliance along the wire [\u00b5m/N]"_number}};
  constexpr std::size_t shown_rows = 12;
  for (const nlohmann::json& e : entries) {
    if (table.rows.size() == shown_rows) break;
    const auto probability = [&](std::size_t prior) {
      return format_significant(e["probability"][prior].get<double>(), 2);
    };
    table.rows.push_back({e["meaning"].get<std::string>(), probability(0), probability(1),
                          format_significant(e["range_mm"].get<double>(), 3),
                          std::to_string(e["readings"].get<int>()),
                          e["p"].is_null() ? absent : format_significant(e["p"].get<double>(), 2),
                          format_significant(e["more_compliance_um_N"].get<double>(), 2)});
  }
  page.table(table);
}

void add_summary(ReportPage& page, const Reproduction& result) {
  page.heading("Summary");
  std::vector<KeyFigure> figures;
  for (const ReproducedModel& model : result.models) {
    const auto misfit = model.misfit(result.experiment);
    figures.push_back({"Error of the " + model.label,
                       misfit ? measured(misfit->rmse, " N rms") : "not computed",
                       misfit ? share_of(misfit->nrmse, "the range of the published force") : ""});
  }
  if (const auto sigma = overall_sigma(result)) {
    figures.push_back(
        {"Scatter of the published curves", measured(sigma, " N rms"), "\u03c3 from the published R\u00b2"});
  }
  if (figures.empty()) page.callout("No model was computed.", Tone::bad);
  page.key_figures(figures);
  for (const ReproducedModel& model : result.models) page.paragraph(model_sentence(result, model));
  add_verdict(page, result);
}

void add_error_table(ReportPage& page, const Reproduction& result) {
  page.heading("Errors");
  Table table{
      "rmse: root mean square of computed minus published force. Range: of the published force. \u03c3: "
      "published scatter.",
      {"Position"_text, "Model"_text, "rmse [N]"_number, "rmse / range"_number, "rmse / \u03c3"_number,
       "Largest force computed [N]"_number, "Largest force published [N]"_number, "Pushed to [mm]"_number}};
  for (std::size_t k = 0; k < result.experiment.series.size(); ++k) {
    const Series& series = result.experiment.series[k];
    const Values published = identification::measured_force(series);
    for (const ReproducedModel& model : result.models) {
      const Prediction* prediction = model.at(k);
      std::vector<Cell> row{series_title(series), model.label, absent, absent, absent, absent};
      if (!prediction || !reason_stopped(*prediction).empty()) row[1].text += " (incomplete)";
      if (prediction) {
        const Misfit misfit = identification::misfit(published, prediction->force);
        row[2] = measured(misfit.rmse);
        row[3] = share(misfit.nrmse);
        row[4] = scatter_ratio(misfit.rmse, published_scatter(series));
        row[5] = measured(largest_force(*prediction));
      }
      row.emplace_back(published.empty() ? absent : format_significant(std::ranges::max(published)));
      row.emplace_back(shown(1e3 * std::ranges::max(identification::measured_displacement(series))));
      table.rows.push_back(std::move(row));
    }
  }
  for (const ReproducedModel& model : result.models) {
    std::vector<Cell> row{"all", model.label, absent, absent, absent, "", "", ""};
    if (const auto misfit = model.misfit(result.experiment)) {
      row[2] = measured(misfit->rmse);
      row[3] = share(misfit->nrmse);
      row[4] = scatter_ratio(misfit->rmse, overall_sigma(result));
    }
    table.rows.push_back(std::move(row));
  }
  page.table(table);
}

/// Value with the digits that its standard error leaves meaningful.
std::string parameter_text(const ReproducedNumber& number) {
  const auto error = number.standard_error;
  if (!error) return format_number(number.value);
  if (*error <= 0.0 || number.value == 0.0) {
    return fmt::format("{} \u00b1 {}", shown(number.value), shown(error));
  }
  const int digits =
      static_cast<int>(std::floor(std::log10(std::abs(number.value))) - std::floor(std::log10(*error))) + 2;
  return fmt::format("{} \u00b1 {}", format_significant(number.value, std::clamp(digits, 2, 9)),
                     format_significant(*error, 2));
}

void add_parameters(ReportPage& page, const Reproduction& result) {
  Words keys;
  Table table{"\u00b1: one standard error of a fitted number; a number without it was declared or held.",
              {"Parameter"_code, "Unit"_text}};
  for (const ReproducedModel& model : result.models) {
    table.columns.push_back({model.label, ColumnKind::number});
    for (const auto& [key, number] : model.numbers) {
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    }
  }
  if (keys.empty()) return;
  for (const std::string& key : keys) {
    std::vector<Cell> row{key, ""};
    for (const ReproducedModel& model : result.models) {
      const auto number = model.numbers.find(key);
      const bool has = number != model.numbers.end();
      row.emplace_back(has ? parameter_text(number->second) : absent);
      if (has && row[1].text.empty()) row[1].text = number->second.unit;
    }
    table.rows.push_back(std::move(row));
  }
  page.heading("Parameters");
  page.table(table);
}

void add_wire(ReportPage& page, const Reproduction& result) {
  if (result.experiment.series.empty()) return;
  const coupling::PushProblem& test = result.experiment.series.front().test;
  page.subheading("The wire as declared");
  page.table({"",
              {"Quantity"_text, "Value"_number, "Unit"_text},
              {{"diameter", shown(1e3 * test.wire.diameter), "mm"},
               {"length", shown(1e3 * test.wire.length), "mm"},
               {"span", shown(1e3 * test.mount.span), "mm"},
               {"bending stiffness", shown(test.wire.bending_stiffness()), "N m\u00b2"},
               {"axial stiffness", shown(test.wire.axial_stiffness()), "N"}}});
}

}  // namespace

std::string reproduce_report_html(const Reproduction& result, const std::string& version) {
  ReportPage page(result.experiment.title, result.experiment.source);
  page.doubts(result.warnings, result.interrupted);
  add_map(page, result);
  add_summary(page, result);
  add_overview(page, result);
  add_error_table(page, result);
  add_parameters(page, result);
  add_evidence(page, result);
  add_wire(page, result);
  for (std::size_t k = 0; k < result.experiment.series.size(); ++k) add_series(page, result, k);
  if (!result.assumptions.empty()) {
    page.heading("Assumptions");
    page.list(result.assumptions);
  }
  page.footer(written_by(version, "reproduce.json and curves.csv") + plot_help);
  return page.html();
}

}  // namespace snare::app
