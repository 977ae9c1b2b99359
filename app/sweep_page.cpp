#include "app/sweep_page.hpp"

#include "app/commands.hpp"
#include "app/report/heat_map.hpp"
#include "app/report/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace snare::app {

namespace {

std::string percent(double share) {
  return format_significant(100.0 * share, 3) + " %";
}

std::string interval_of(std::uint64_t hits, std::uint64_t count) {
  const study::ProbabilityInterval i = study::proportion_interval(hits, count);
  return fmt::format("{} to {}", percent(i.low), percent(i.high));
}

double share_of(std::uint64_t hits, std::uint64_t count) {
  return count > 0 ? static_cast<double>(hits) / static_cast<double>(count) : 0.0;
}

void shares(ReportPage& page, const SweepAnswers& answers) {
  Table table{
      "Shares of the cases, with intervals that at least 95 of 100 studies of independent cases would have "
      "right",
      {"what"_text, "cases"_number, "hits"_number, "share"_number, "95 %"_number}};
  const auto add = [&](const std::string& name, std::uint64_t hits, std::uint64_t count) {
    if (count == 0) return;
    table.rows.push_back({name, std::to_string(count), std::to_string(hits), percent(share_of(hits, count)),
                          interval_of(hits, count)});
  };
  for (const FieldAnswer& field : answers.fields)
    if (field.yes_or_no) add(field.name, field.hits, field.count);
  if (!answers.subset)
    for (const LimitAnswer& limit : answers.limits) add(limit.name, limit.hits, limit.count);
  if (table.rows.empty()) return;
  page.heading("How often");
  page.table(table);
}

void numbers(ReportPage& page, const SweepAnswers& answers) {
  Table table{"",
              {"field"_code, "cases"_number, "mean"_number, "deviation"_number, "least"_number, "5 %"_number,
               "median"_number, "95 %"_number, "most"_number}};
  for (const FieldAnswer& f : answers.fields) {
    if (f.yes_or_no || f.count == 0 || f.sample.empty()) continue;
    table.rows.push_back({f.name, std::to_string(f.count), format_number(f.mean),
                          format_number(f.deviation, 3), format_number(f.least),
                          format_number(f.quantile(0.05)), format_number(f.quantile(0.5)),
                          format_number(f.quantile(0.95)), format_number(f.most)});
  }
  if (table.rows.empty()) return;
  page.heading("What the cases came to");
  if (answers.subset)
    page.paragraph(
        "Most of these cases were drawn near the event: their shares are not those of the distribution.");
  page.table(table);
}

/// Distribution functions, with the bounds.
void distributions(ReportPage& page, const SweepStudy& study, const SweepAnswers& answers) {
  const study::SweepFile& sweep = study.sweep();
  for (std::size_t f = 0; f < answers.fields.size(); ++f) {
    const FieldAnswer& field = answers.fields[f];
    if (field.yes_or_no || field.sample.size() < 2 || field.least == field.most) continue;
    PlotSpecification plot{
        "Distribution of " + field.name, {field.name, ""}, {"share of the cases below", ""}};
    Values at, share;
    const std::size_t n = field.sample.size();
    for (std::size_t k = 0; k < n; ++k) {
      at.push_back(field.sample[k]);
      share.push_back((static_cast<double>(k) + 0.5) / static_cast<double>(n));
    }
    plot.curves.push_back({field.name, at, share, CurveStyle::line, 1});
    for (const study::Limit& limit : sweep.limits)
      if (limit.field == f)
        plot.curves.push_back({limit.name, {limit.bound, limit.bound}, {0.0, 1.0}, CurveStyle::dashes, 2});
    page.line_plot(plot);
  }
}

void sensitivities(ReportPage& page, const SweepStudy& study, const SweepAnswers& answers) {
  const auto& variables = study.sweep().design.variables();
  bool any = false;
  for (const FieldAnswer& field : answers.fields) {
    if (!field.indices) continue;
    if (field.indices->of.empty()) {
      page.paragraph(
          fmt::format("{}: no Sobol indices, since few rows differ ({:.3g} effective rows, must be 10)",
                      field.name, field.indices->effective_rows));
      continue;
    }
    if (!any) {
      page.heading("Which numbers matter");
      page.paragraph(
          "Sobol indices: the share of the variance that a variable causes by itself (first order), and with "
          "all others (total). Intervals of 95 %, from replicates of the design.");
    }
    any = true;
    Table table{field.name,
                {"variable"_code, "first order"_number, "+-"_number, "total"_number, "+-"_number}};
    for (std::size_t j = 0; j < field.indices->of.size(); ++j) {
      const study::SobolIndex& s = field.indices->of[j];
      table.rows.push_back({variables[j].name, format_number(s.first, 3), format_number(s.first_half, 2),
                            format_number(s.total, 3), format_number(s.total_half, 2)});
    }
    page.table(table);
  }
}

void maps(ReportPage& page, const SweepStudy& study, const SweepAnswers& answers) {
  if (answers.maps.empty()) return;
  page.heading("Maps");
  page.paragraph(
      "A cell holds all cases there, whatever the other variables are; point at one for its numbers.");
  if (answers.inferred() > 0) {
    page.paragraph(
        fmt::format("The grid is refined where {} changes: {} cases (pale) lie between others that agree, "
                    "were not run, and are "
                    "taken to agree with these. A change that no corner of a first cell shows is not seen.",
                    study.sweep().collect[study.sweep().refine->field].name, answers.inferred()));
  }
  for (const MapAnswer& m : answers.maps) {
    HeatMap map{m.share ? "share of cases with " + m.title : "mean of " + m.title,
                m.x,
                m.y,
                m.x_edges,
                m.y_edges,
                {}};
    bool first = true;
    for (std::size_t k = 0; k < m.count.size(); ++k) {
      HeatMap::Cell cell;
      cell.known = m.count[k] > 0;
      if (cell.known) {
        cell.value = m.share ? share_of(m.hits[k], m.count[k]) : m.sum[k] / static_cast<double>(m.count[k]);
        cell.hint =
            m.share ? fmt::format("{} of {}: {}", m.hits[k], m.count[k], interval_of(m.hits[k], m.count[k]))
                    : fmt::format("{} over {} cases", format_number(cell.value), m.count[k]);
        cell.pale = m.inferred[k] == m.count[k];
        if (m.inferred[k] > 0) cell.hint += fmt::format(", {} inferred", m.inferred[k]);
        if (!m.share) {
          map.low = first ? cell.value : std::min(map.low, cell.value);
          map.high = first ? cell.value : std::max(map.high, cell.value);
          first = false;
        }
      }
      map.cells.push_back(cell);
    }
    page.drawing(heat_map(map));
  }
}

void subset(ReportPage& page, const SweepAnswers& answers) {
  if (!answers.subset) return;
  const SubsetAnswer& s = *answers.subset;
  page.heading("A rare event");
  page.callout(
      s.reached
          ? fmt::format(
                "Probability {:.3g}, 95 % interval {:.3g} to {:.3g}, coefficient of variation {:.2g}.",
                s.probability, s.interval.low, s.interval.high, s.variation)
          : fmt::format("The event was not reached: its probability is below {:.3g} (in at least 95 of 100 "
                        "studies), or the levels were too few.",
                        s.interval.high),
      s.reached ? Tone::plain : Tone::bad);
  Table table{"",
              {"level"_number, "from a margin of"_number, "share that goes on"_number, "variation"_number}};
  for (std::size_t k = 0; k < s.levels.size(); ++k) {
    table.rows.push_back(
        {std::to_string(k), std::isfinite(s.levels[k].threshold) ? format_number(s.levels[k].threshold) : "-",
         format_number(s.levels[k].probability, 4), format_number(s.levels[k].variation, 2)});
  }
  page.table(table);
}

void cases(ReportPage& page, const SweepStudy& study, const SweepAnswers& answers) {
  if (!answers.worst.empty()) {
    page.heading("The worst cases");
    Table table{"Each runs alone with its command, or with snare sweep " + study.sweep().file.string() +
                    " --case NUMBER",
                {"case"_number, "why"_text, "command"_code}};
    for (const CaseAnswer& one : answers.worst)
      table.rows.push_back({std::to_string(one.number), one.why, one.command});
    page.table(table);
  }
  if (answers.reasons.empty()) return;
  page.heading("Cases without a result");
  Table table{"", {"reason"_text, "cases"_number}};
  for (const auto& [reason, count] : answers.reasons) table.rows.push_back({reason, std::to_string(count)});
  page.table(table);
}

}  // namespace

std::string sweep_page(const SweepStudy& study, const SweepAnswers& answers) {
  const study::SweepFile& sweep = study.sweep();
  ReportPage page(sweep.title.empty() ? "A sweep of " + sweep.case_file.filename().string() : sweep.title,
                  fmt::format("{} cases of {}", answers.finished, sweep.case_file.string()));
  page.doubts({}, answers.interrupted);
  const auto done = answers.statuses.find("done");
  const std::uint64_t well = done == answers.statuses.end() ? 0 : done->second;
  page.key_figures(
      {{"cases", std::to_string(answers.finished),
        answers.cases > 0 ? fmt::format("of {}", answers.cases) : ""},
       {"with a result", std::to_string(well), "", well == answers.finished ? Tone::good : Tone::bad},
       {"a case",
        format_significant(
            answers.seconds / static_cast<double>(std::max<std::uint64_t>(1, answers.finished)), 3) +
            " s",
        "on one thread"}});
  shares(page, answers);
  subset(page, answers);
  numbers(page, answers);
  distributions(page, study, answers);
  sensitivities(page, study, answers);
  maps(page, study, answers);
  if (!answers.scatters.empty()) page.heading("Field by variable");
  for (const ScatterAnswer& s : answers.scatters) {
    PlotSpecification plot{s.y + " over " + s.x, {s.x, ""}, {s.y, ""}};
    plot.curves.push_back({s.y, s.at, s.value, CurveStyle::points, 1});
    page.line_plot(plot);
  }
  cases(page, study, answers);
  page.footer(written_by(version(), "cases.csv and summary.json") + plot_help);
  return page.html();
}

}  // namespace snare::app
