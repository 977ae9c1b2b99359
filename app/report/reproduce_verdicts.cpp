#include "app/report/reproduce_verdicts.hpp"

#include "base/json_fields.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::app {

using base::json_fields::array;
using base::json_fields::member;
using base::json_fields::number;
using base::json_fields::text;
using nlohmann::json;

void add_verdicts(ReportPage& page, const json& result) {
  const json& trace = member(result, "trace");
  const json& verdicts = array(result, "verdicts");
  if (trace.is_null() && verdicts.empty()) return;
  page.heading("What explains the curves");
  if (!trace.is_null()) {
    const json& explained = member(trace, "explained");
    page.callout(text(trace, "verdict"), explained.is_boolean() && explained.get<bool>() ? Tone::good : Tone::bad);
    page.paragraph("Readings were drawn about the published fits with the scatter that the printed R2 implies, since the readings "
                   "themselves are lost. Run `snare trace` on the experiment file for the whole evidence.");
    const json& next = member(trace, "next_experiment");
    if (!text(next, "what").empty()) page.paragraph("To measure next: " + text(next, "what") + ".");
  }
  if (verdicts.empty()) return;
  page.paragraph("The range of travel of the published fits is not printed. What is said depends on it:");
  Table table;
  table.columns = {{"range [mm]", ColumnKind::number}, {"fit within the published scatter"}, {"rms error over scatter by position"}, {"the tracing says"}};
  for (const json& v : verdicts) {
    std::string ratios;
    for (const auto& [name, one] : member(v, "fit").items()) {
      const auto rmse = number(one, "rmse_N");
      const auto scatter = number(one, "scatter_N");
      if (rmse && scatter) ratios += fmt::format("{}{} {:.2f}", ratios.empty() ? "" : ", ", name, *rmse / *scatter);
    }
    const json& within = member(v, "within_scatter");
    const bool good = within.is_boolean() && within.get<bool>();
    table.rows.push_back({{format_number(number(v, "to_mm").value_or(0.0))}, {good ? "yes" : "no", good ? Tone::good : Tone::plain},
                          {ratios}, {text(v, "verdict")}});
  }
  page.table(table);
}

}  // namespace snare::app
