#include "papers/figure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace snare::papers {

namespace {

FigureCurve drawn(const HistoryCurve& curve, const Run& run) {
  FigureCurve result{curve.name};
  result.panel = curve.panel;
  const auto [times, unused] = run.columns("time_s", curve.y);
  const auto [x, y] = run.columns(curve.x, curve.y);
  const double zero = curve.zero != nullptr ? curve.zero(run) : 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (times[i] < curve.from || times[i] > curve.to) continue;
    result.x.push_back(x[i] - zero);
    result.y.push_back(curve.factor * y[i]);
  }
  return result;
}

}  // namespace

FigureResult made(const Paper& paper, const Figure& figure, Runs& runs) {
  runs.go_on();
  runs.set_stage(fmt::format("{}, {}: ", paper.name, figure.number));
  FigureResult result;
  if (figure.compute != nullptr) result = figure.compute(runs);
  for (const HistoryCurve& curve : figure.curves) {
    const Run& run = runs.of(curve.run(runs));
    if (!run.result.report.usable())
      result.failure = fmt::format("{}: {}", curve.name, run.result.report.message);
    result.curves.push_back(drawn(curve, run));
  }
  for (validation::Row& row : result.rows) {
    row.group = fmt::format("figures and tables of {}", paper.short_title);
    row.name = fmt::format("{}: {}", figure.number, row.name);
    if (row.source.empty()) row.source = fmt::format("{}, {}", paper.short_title, figure.number);
  }
  return result;
}

validation::Row statement(const std::string& what, validation::Kind kind, bool holds) {
  return {"", what + " (1: yes)", "", "", kind, 1.0, holds ? 1.0 : 0.0, validation::Limit::relative(0.5)};
}

std::string digits(double value, int significant) {
  constexpr double written_out = 1e6;  // 2000 rather than 2e+03
  if (std::abs(value) >= std::pow(10.0, significant) && std::abs(value) < written_out)
    return fmt::format("{:.0f}", value);
  return fmt::format("{:.{}g}", value, significant);
}

FigureResult inputs(const std::vector<Input>& all, validation::Kind kind) {
  FigureResult result;
  result.table.columns = {"quantity", "unit", "printed", "used"};
  for (const Input& i : all) {
    result.table.rows.push_back({i.quantity, i.unit, digits(i.printed, 8), digits(i.used, 6)});
    result.rows.push_back(
        {"", std::string(i.quantity) + " as used", i.unit, "", kind, i.printed, i.used,
         validation::Limit::absolute(0.5 * i.last_digit, "half of the last printed digit")});
  }
  return result;
}

}  // namespace snare::papers
