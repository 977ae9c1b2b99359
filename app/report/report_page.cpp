#include "app/report/report_page.hpp"

#include "app/report/plot_data.hpp"
#include "app/report/report_assets.hpp"
#include "base/one_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::app {
namespace {

using nlohmann::json;

double rounded(double value, int digits) {
  return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
}

void require_finite(double value) {
  if (!std::isfinite(value))
    throw std::invalid_argument(fmt::format("a report cannot print the value {}", value));
}

/// JSON that cannot end the script element it stands in; bytes that are not UTF-8 become U+FFFD.
std::string embedded_json(const json& data) {
  std::string text;
  for (const char c : data.dump(-1, ' ', false, json::error_handler_t::replace)) {
    text += c == '<' ? "\\u003c" : std::string(1, c);
  }
  return text;
}

const char* tone_class(Tone tone) {
  static constexpr const char* names[] = {"", "good", "bad"};
  return names[static_cast<std::size_t>(tone)];
}

const char* column_class(ColumnKind kind) {
  return kind == ColumnKind::number ? "number" : "";
}

std::string heading_id(std::size_t number) {
  return fmt::format("section-{}", number);
}

}  // namespace

ReportPage::ReportPage(std::string title, std::string subtitle)
    : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

void ReportPage::heading(std::string_view text) {
  close_plots();
  headings_.emplace_back(text);
  body_ += fmt::format("<h2 id=\"{}\">{}</h2>\n", heading_id(headings_.size()), escape_html(text));
}

void ReportPage::subheading(std::string_view text) {
  close_plots();
  body_ += fmt::format("<h3>{}</h3>\n", escape_html(text));
}

void ReportPage::paragraph(std::string_view text) {
  close_plots();
  body_ += fmt::format("<p>{}</p>\n", escape_html(text));
}

void ReportPage::list(const std::vector<std::string>& items) {
  close_plots();
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += fmt::format("<li>{}</li>\n", escape_html(item));
  body_ += "</ul>\n";
}

void ReportPage::callout(std::string_view text, Tone tone) {
  close_plots();
  body_ += fmt::format("<p class=\"callout {}\">{}</p>\n", tone_class(tone), escape_html(text));
}

void ReportPage::doubts(const std::vector<std::string>& warnings, bool interrupted) {
  if (interrupted)
    callout("This run was interrupted: what is shown is a part of what was asked for.", Tone::bad);
  for (const std::string& warning : warnings) callout("Warning: " + warning, Tone::bad);
}

void ReportPage::key_figures(const std::vector<KeyFigure>& figures) {
  close_plots();
  body_ += "<div class=\"figures\">\n";
  for (const KeyFigure& figure : figures) {
    body_ += fmt::format(
        "<div class=\"{}\"><div class=\"label\">{}</div><div class=\"value\">{}</div>"
        "<div class=\"remark\">{}</div></div>\n",
        tone_class(figure.tone), escape_html(figure.label), escape_html(figure.value),
        escape_html(figure.remark));
  }
  body_ += "</div>\n";
}

void ReportPage::drawing(std::string_view svg) {
  close_plots();
  body_ += svg;
}

void ReportPage::table(const Table& table) {
  for (const auto& row : table.rows) {
    if (row.size() != table.columns.size()) {
      throw std::invalid_argument(fmt::format("table '{}': a row has {} cells, the table has {} columns",
                                              table.caption, row.size(), table.columns.size()));
    }
  }
  close_plots();
  if (!table.caption.empty())
    body_ += fmt::format("<p class=\"caption\">{}</p>\n", escape_html(table.caption));
  body_ += "<div class=\"table\"><table>\n<thead><tr>";
  for (const Column& column : table.columns) {
    body_ += fmt::format("<th scope=\"col\" class=\"{}\">{}</th>", column_class(column.kind),
                         escape_html(column.heading));
  }
  body_ += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    body_ += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const ColumnKind kind = table.columns[i].kind;
      const std::string text = escape_html(row[i].text);
      body_ += fmt::format("<td class=\"{} {}\">{}</td>", column_class(kind), tone_class(row[i].tone),
                           kind == ColumnKind::code ? "<code>" + text + "</code>" : text);
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void ReportPage::line_plot(const PlotSpecification& plot) {
  const json data = plot_data(plot);
  const auto points = [](const Curve& curve) { return curve.x.size(); };
  if (std::ranges::all_of(plot.curves, [&](const Curve& curve) { return points(curve) == 0; })) return;

  if (plots_open_ != plot.width) {
    close_plots();
    body_ += "<div class=\"plots\">\n";
    plots_open_ = plot.width;
  }
  body_ += fmt::format(
      "<figure class=\"plot {}\" id=\"plot-{}\"><figcaption><span>{}</span>"
      "<span class=\"tools\"></span></figcaption><div class=\"legend\"></div><div class=\"canvas\"></div>",
      plot.width == PlotWidth::full ? "full" : "half", ++plot_count_, escape_html(plot.title));
  std::string note = plot.note;
  const auto longest = std::ranges::max(plot.curves, {}, points).x.size();
  if (longest > max_points_per_curve) {
    note += fmt::format("{}Of {} points the extremes of every stretch are drawn.", note.empty() ? "" : " ",
                        longest);
  }
  if (!note.empty()) body_ += fmt::format("<p class=\"note\">{}</p>", escape_html(note));
  body_ += "<script type=\"application/json\">" + embedded_json(data) + "</script></figure>\n";
}

void ReportPage::scene(const SceneSpecification& scene) {
  if (scene.frames.empty()) return;
  close_plots();
  spatial_ = true;
  body_ += fmt::format(
      "<figure class=\"scene\"><figcaption>{}</figcaption><div class=\"stage\"></div><div "
      "class=\"marks\"></div>"
      "<p><button type=\"button\" class=\"play\">play</button> <input type=\"range\" min=\"0\" value=\"0\" "
      "style=\"width:60%\"> <output></output></p>"
      "<p><button type=\"button\" class=\"near\">to the wires</button> <button type=\"button\" "
      "class=\"far\">show "
      "all</button> <label><input type=\"checkbox\" checked> follow the wires</label></p>"
      "<p class=\"note\">Drag to turn, with the right button to shift; wheel or two fingers to come nearer. "
      "A mark on "
      "the "
      "time line leads to its moment.</p><script type=\"application/json\">{}</script></figure>\n",
      escape_html(scene.title), embedded_json(scene_data(scene)));
}

void ReportPage::footer(std::string_view text) {
  footer_ = text;
}

void ReportPage::close_plots() {
  if (plots_open_) body_ += "</div>\n";
  plots_open_.reset();
}

std::string ReportPage::html() const {
  std::string contents;
  for (std::size_t i = 0; i < headings_.size(); ++i) {
    contents += fmt::format("<a href=\"#{}\">{}</a>", heading_id(i + 1), escape_html(headings_[i]));
  }
  // The policy makes the browser refuse any request that might slip in; data: is the empty icon.
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>{0}</title>\n<style>\n{1}</style>\n</head>\n<body>\n"
      "<header><h1>{0}</h1><p class=\"subtitle\">{2}</p><nav "
      "aria-label=\"Contents\">{3}</nav></header>\n<main>\n"
      "<noscript><p class=\"callout\">The plots need JavaScript; texts and tables do not.</p></noscript>\n",
      escape_html(title_), report_assets::style_sheet, escape_html(subtitle_), contents);
  page += body_;
  if (plots_open_) page += "</div>\n";
  page += fmt::format("</main>\n<footer>{}</footer>\n", escape_html(footer_));
  if (plot_count_ > 0) {
    page += fmt::format("<script>\n/*\n{}*/\n{}\n</script>\n<script>\n{}</script>\n",
                        report_assets::d3_notice, report_assets::d3_script, report_assets::plot_script);
  }
  if (spatial_) {
    page += fmt::format("<script>\n/*\n{}*/\n{}\n{}\n</script>\n<script>\n{}</script>\n",
                        report_assets::three_notice, report_assets::three_script, report_assets::orbit_script,
                        report_assets::scene_script);
  }
  page += "</body>\n</html>\n";
  return page;
}

std::string written_by(std::string_view version, std::string_view files) {
  return fmt::format("Written by snare {}. The numbers are in {} beside this page.", version, files);
}

std::string format_number(double value, int digits) {
  require_finite(value);
  const double shown = rounded(value, digits);
  const double size = std::abs(shown);
  if (size != 0.0 && (size < 1e-4 || size >= 1e7)) return fmt::format("{:.{}g}", shown, digits);
  return fmt::format("{}", shown == 0.0 ? 0.0 : shown);
}

std::string format_significant(double value, int digits) {
  require_finite(value);
  const double size = std::abs(rounded(value, digits));
  if (size == 0.0) return "0";
  if (size < 1e-4 || size >= 1e7) return fmt::format("{:.{}e}", value, digits - 1);
  const int decimals = digits - 1 - static_cast<int>(std::floor(std::log10(size)));
  return fmt::format("{:.{}f}", value, std::max(0, decimals));
}

std::string escape_html(std::string_view text) {
  static const std::map<char, std::string> entities{
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string safe;
  for (const char c : base::one_line(text)) {
    const auto entity = entities.find(c);
    safe += entity == entities.end() ? std::string(1, c) : entity->second;
  }
  return safe;
}

}  // namespace snare::app
