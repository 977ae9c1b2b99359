#include "app/trace_report.hpp"

#include "app/report_page.hpp"

#include <nlohmann/json.hpp>

namespace snare::app {

std::string trace_report_html(const nlohmann::json& result) {
  ReportPage page("What the model lacks", result.value("title", std::string()));
  page.paragraph(result.value("verdict", std::string()));
  return page.html();
}

}  // namespace snare::app
