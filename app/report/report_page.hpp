#pragma once

#include "app/report/plot.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace snare::app {

enum class Tone { plain, good, bad };

struct Cell {
  Cell(std::string text_, Tone tone_ = Tone::plain) : text(std::move(text_)), tone(tone_) {}
  Cell(const char* text_) : text(text_) {}

  std::string text;
  Tone tone = Tone::plain;
};

enum class ColumnKind {
  text,
  number,  ///< right-aligned
  code     ///< keys and file names
};

struct Column {
  std::string heading;
  ColumnKind kind = ColumnKind::text;
};

/// Columns by their headings: "Model"_code, "Peak force [N]"_number.
[[nodiscard]] inline Column operator""_text(const char* heading, std::size_t) {
  return {heading, ColumnKind::text};
}
[[nodiscard]] inline Column operator""_number(const char* heading, std::size_t) {
  return {heading, ColumnKind::number};
}
[[nodiscard]] inline Column operator""_code(const char* heading, std::size_t) {
  return {heading, ColumnKind::code};
}

struct Table {
  std::string caption;  ///< may be empty
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows = {};  ///< each as long as columns
};

/// One number of the summary, printed large.
struct KeyFigure {
  std::string label;
  std::string value;
  std::string remark;
  Tone tone = Tone::plain;
};

/// A report of one self-contained HTML page: no request leaves it, so it opens offline and can be mailed.
///
/// Every text is plain text and is escaped. Plots are drawn in the reader's browser by D3, which is inlined,
/// see docs/decisions/license-and-libraries.md#plots-of-report-pages; half plots added one after the other
/// share rows.
class ReportPage {
 public:
  ReportPage(std::string title, std::string subtitle);

  /// Starts a section; it is listed in the page's contents.
  void heading(std::string_view text);
  void subheading(std::string_view text);
  void paragraph(std::string_view text);
  void list(const std::vector<std::string>& items);

  /// A remark in a box: something stopped, a verdict.
  void callout(std::string_view text, Tone tone);

  /// What stands before everything else: that the results are a part of what was asked for, and what is
  /// doubtful about them.
  void doubts(const std::vector<std::string>& warnings, bool interrupted);

  void key_figures(const std::vector<KeyFigure>& figures);

  /// Throws std::invalid_argument when a row and the columns differ in length.
  void table(const Table& table);

  /// Throws std::invalid_argument, naming plot, curve and index, when a value is not finite or lengths
  /// differ. A plot without any point is left out.
  void line_plot(const PlotSpecification& plot);

  /// A scene, drawn by three.js, or flat where the browser has no WebGL.
  void scene(const SceneSpecification& scene);

  /// A drawing that is whole as it stands, e.g. of heat_map(); not escaped.
  void drawing(std::string_view svg);

  /// The small print at the end, e.g. which version wrote the page.
  void footer(std::string_view text);

  [[nodiscard]] std::string html() const;

 private:
  void close_plots();

  std::string title_;
  std::string subtitle_;
  std::string footer_;
  std::string body_;
  std::vector<std::string> headings_;
  std::optional<PlotWidth> plots_open_;  ///< width of the plots of the row being filled
  int plot_count_ = 0;
  bool spatial_ = false;
};

/// First sentences of the small print of a page beside `files`, e.g. "trace.json and curves.csv".
[[nodiscard]] std::string written_by(std::string_view version, std::string_view files);
/// Last sentence of it, on pages with plots to read closely.
inline constexpr const char* plot_help =
    " In a plot: hover for values, drag to zoom, double-click to return, click the legend to hide a curve.";

/// At most `digits` significant digits, no trailing zeros: 1.5, 719880, 2.3e-07.
/// Throws std::invalid_argument when the value is not finite.
std::string format_number(double value, int digits = 6);

/// At least `digits` significant digits, trailing zeros kept: 0.150, 85.2, 12345.
/// Throws std::invalid_argument when the value is not finite.
std::string format_significant(double value, int digits = 3);

/// Text made safe for the body and the attributes of an HTML page. Bytes that are not UTF-8 become U+FFFD.
std::string escape_html(std::string_view text);

}  // namespace snare::app
