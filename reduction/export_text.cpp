#include "reduction/export_text.hpp"

#include "base/one_line.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace snare::reduction {

std::string filled(std::string_view source, const Replacements& replacements) {
  std::string text;
  while (!source.empty()) {
    const std::size_t mark = std::min(source.find('@'), source.size());
    text += source.substr(0, mark);
    source.remove_prefix(mark);
    if (source.empty()) break;
    const std::size_t end = source.find('@', 1);
    const auto found =
        std::ranges::find(replacements, source.substr(1, end - 1), [](const auto& r) { return r.first; });
    text += found->second;
    source.remove_prefix(end + 1);
  }
  return text;
}

std::string number_list(const std::vector<double>& values, std::size_t per_line,
                        std::string_view line_break) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : i % per_line == 0 ? line_break : ", ", values[i]);
  return text;
}

std::string position_name(double position) {
  std::string text = fmt::format("s{:.6g}", 1e3 * position);
  std::ranges::replace(text, '.', '_');
  return text;
}

std::vector<Interval> covered_positions(const coupling::ForceTable& table) {
  const double span = table.span();
  const double low = table.axes()[1].front() * span;
  const double high = table.axes()[1].back() * span;
  if (!table.mirrored()) return {{low, high}};
  if (high >= 0.5 * span * (1.0 - 1e-9)) return {{low, span - low}};
  return {{low, high}, {span - high, span - low}};
}

std::vector<std::string> head_lines(const DistilledCase& one, const std::string& title) {
  const TableError& e = one.table.loading_error;
  const coupling::ForceTable& table = *one.table.loading;
  const auto range = [](double low, double high) { return fmt::format("{:.6g} to {:.6g} m", low, high); };
  std::string positions;
  for (const Interval& part : covered_positions(table))
    positions += (positions.empty() ? "" : " and ") + range(part.low, part.high);
  const double span = table.span();
  std::vector<std::string> lines{
      base::one_line(title),
      "Force of a snare wire on a pusher, distilled from the full wire by snare. SI units: m, N.",
      "travel d from first touch: " + range(table.axes()[0].front() * span, table.axes()[0].back() * span),
      "position s along the chord: " + positions,
      "slack: " + range(table.axes()[2].front() * span, table.axes()[2].back() * span),
      fmt::format("table within {:.4g} N of the full wire ({:.3g} % of the range of the force)", e.bound,
                  e.force_range > 0.0 ? 100.0 * e.bound / e.force_range : 0.0),
      "Outside these ranges forces continue linearly: never negative, never falling along the travel."};
  if (one.wire.dissipates())
    lines.emplace_back("force: loading; force_unloading: the way back from the end of the travel");
  return lines;
}

Replacements table_numbers(const coupling::ForceTable& table) {
  const auto& axes = table.axes();
  return {{"span", fmt::format("{}", table.span())},  {"scale", fmt::format("{}", table.force_scale())},
          {"mirror", table.mirrored() ? "1" : "0"},   {"nd", fmt::format("{}", axes[0].size())},
          {"ns", fmt::format("{}", axes[1].size())},  {"ne", fmt::format("{}", axes[2].size())},
          {"last", fmt::format("{}", axes[0].back())}};
}

std::vector<ExportedLaw> exported_laws(const DistilledPlace& place, const std::string& prefix) {
  std::vector<ExportedLaw> all;
  for (const FittedLaw& law : place.laws) {
    const coupling::RangedLaw ranged = law.ranged();
    all.push_back({law.form->name() + "_" + position_name(place.position),
                   fmt::format("{}, largest error {:.3g} N of {:.3g} N", law.form->formula(),
                               law.error.largest_force, law.error.force_range),
                   {{"end", fmt::format("{}", ranged.end())},
                    {"end_force", fmt::format("{}", ranged.end_force())},
                    {"end_stiffness", fmt::format("{}", ranged.end_stiffness())},
                    {"expression", law.form->expression(law.values, prefix)}}});
  }
  return all;
}

Replacements load_unload_numbers(const DistilledCase& one, const DistilledPlace& place) {
  const LoadUnloadLaw& law = place.load_unload->law;
  return {{"turn", fmt::format("{}", law.turn())},
          {"position", fmt::format("{}", place.position)},
          {"slack", fmt::format("{}", one.wire.nominal_slack())},
          {"sum", fmt::format("{}", 0.5 * (1.0 + law.returned()))},
          {"difference", fmt::format("{}", 0.5 * (1.0 - law.returned()))}};
}

}  // namespace snare::reduction
