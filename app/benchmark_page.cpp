#include "app/benchmark_page.hpp"

#include "app/report/report_page.hpp"
#include "results/history_table.hpp"
#include "results/version.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

namespace snare::app {

using namespace results;

namespace {

std::string touch_words(const study::TrackScore& score, const study::TrackScore& bar) {
  if (!score.same_touch) return "only one touches";
  if (!score.touch) return "-";
  return fmt::format("{:+.2g} ({:.1g})", *score.touch, std::abs(bar.touch.value_or(0.0)));
}

std::string outcome_words(const BenchmarkRow& row, const BenchmarkReference& reference) {
  std::string words;
  for (const auto& [name, value] : row.outcome) {
    words += (words.empty() ? "" : ", ") + name + " " + value.dump();
    const nlohmann::json& expected = reference.outcome.at(name);
    if (value != expected) words += " instead of " + expected.dump();
  }
  return words.empty() ? "-" : words;
}

std::string known(const std::optional<double>& value) {
  return value ? format_significant(*value, 2) : "-";
}

void add_scores(ReportPage& page, const BenchmarkAnswer& answer) {
  Table table{
      "Differences from the archived history, in brackets those of its last refinement but one",
      {"model"_code, "quantity"_code, "peak"_number, "integral"_number, "rms"_number, "first touch"_number,
       "outcome"_text, "energy error"_number, "explicit step [s]"_number, "wall time [s]"_number}};
  for (const BenchmarkRow& row : answer.rows) {
    const std::string seconds = row.seconds > 0.0 ? format_significant(row.seconds) : "-";
    if (row.scores.empty())
      table.rows.push_back(
          {row.model, "-", "-", "-", "-", "-", {row.end.reason, Tone::bad}, "-", "-", seconds});
    for (const auto& [name, s] : row.scores) {
      const study::TrackScore& bar = answer.reference.bars.at(name);
      std::string outcome = outcome_words(row, answer.reference);
      if (s.covered < 1.0) outcome += fmt::format("; covers {:.0f} %", 100.0 * s.covered);
      table.rows.push_back({row.model, name, score_words(s.peak, bar.peak),
                            score_words(s.integral, bar.integral), score_words(s.rms, bar.rms),
                            touch_words(s, bar), std::move(outcome), known(row.energy_error),
                            known(row.largest_step), seconds});
    }
  }
  page.table(table);
}

void add_plots(ReportPage& page, const BenchmarkAnswer& answer) {
  for (const auto& [name, track] : answer.reference.tracks) {
    PlotSpecification plot{
        name, {answer.asked->x, unit_of_column(answer.asked->x)}, {name, unit_of_column(name)}};
    plot.width = PlotWidth::half;
    plot.curves.push_back({"archived", track.x, track.q, CurveStyle::line, 0});
    int colour = 0;
    for (const BenchmarkRow& row : answer.rows) {
      const auto own = row.tracks.find(name);
      ++colour;
      if (own != row.tracks.end())
        plot.curves.push_back({row.model, own->second.x, own->second.q, CurveStyle::dashes, colour});
    }
    page.line_plot(plot);
  }
}

}  // namespace

std::string score_words(double score, double bar) {
  return fmt::format("{:+.3g} % ({:.1g})", 100.0 * score, std::abs(100.0 * bar));
}

std::string benchmark_page(const study::BenchmarkFile& benchmark, const std::vector<BenchmarkAnswer>& answers,
                           bool interrupted) {
  ReportPage page(benchmark.title, benchmark.source);
  std::vector<std::string> doubts;
  for (const BenchmarkAnswer& answer : answers)
    if (answer.reference.stale)
      doubts.push_back(answer.asked->name + ": the archived history was made from other input");
  page.doubts(doubts, interrupted);
  for (const BenchmarkAnswer& answer : answers) {
    page.heading(answer.asked->title);
    add_scores(page, answer);
    add_plots(page, answer);
  }
  page.footer(written_by(version(), "benchmark.json and scores.csv") + plot_help);
  return page.html();
}

}  // namespace snare::app
