#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

/// Reading report pages as a person and a browser do.
namespace snare::app {

inline bool contains(const std::string& html, const std::string& part) {
  return html.find(part) != std::string::npos;
}

inline void expect_all(const std::string& html, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_TRUE(contains(html, part)) << part;
}

/// The page without the plot library, whose source has words such as NaN.
inline std::string own_part(const std::string& html) {
  return html.substr(0, html.find("</footer>"));
}

/// What the browser reads from the first plot of this title after the first occurrence of `section`; null
/// without one.
inline nlohmann::json plot_of(const std::string& html, const std::string& title,
                              const std::string& section = "") {
  const std::size_t begin = html.find(section);
  std::size_t at = begin == std::string::npos ? begin : html.find("<span>" + title + "</span>", begin);
  if (at == std::string::npos) return nullptr;
  const std::string open = "<script type=\"application/json\">";
  at = html.find(open, at) + open.size();
  return nlohmann::json::parse(html.substr(at, html.find("</script>", at) - at));
}

/// The curve of this name; throws where there is none.
inline nlohmann::json curve_of(const nlohmann::json& plot, const std::string& name) {
  for (const nlohmann::json& curve : plot.at("curves")) {
    if (curve.at("name") == name) return curve;
  }
  throw std::out_of_range("no curve \"" + name + "\" in " + plot.dump());
}

/// Cells of the first table row that begins with these cells; empty without one.
inline std::vector<std::string> row_of(const std::string& html, const std::vector<std::string>& begin) {
  for (std::size_t at = html.find("<tr><td"); at != std::string::npos; at = html.find("<tr><td", at + 1)) {
    const std::string row = html.substr(at, html.find("</tr>", at) - at);
    std::vector<std::string> cells;
    for (std::size_t cell = row.find("<td"); cell != std::string::npos; cell = row.find("<td", cell + 1)) {
      const std::size_t open = row.find('>', cell) + 1;
      std::string text = row.substr(open, row.find("</td>", open) - open);
      if (text.starts_with("<code>")) text = text.substr(6, text.size() - 13);
      cells.push_back(text);
    }
    if (cells.size() >= begin.size() && std::equal(begin.begin(), begin.end(), cells.begin())) return cells;
  }
  return {};
}

}  // namespace snare::app
