#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace snare::app {

enum class CurveStyle { line, dashes, points };

enum class AxesScale {
  independent,  ///< each axis fills the frame
  equal         ///< one unit is equally long on both axes: shapes drawn to scale
};

enum class Palette {
  categorical,  ///< unrelated curves: black, blue, vermillion, ... (Okabe and Ito 2008, safe for colour-blind readers)
  sequential  ///< a family in order, e.g. shapes along a push: dark to light, from lowest to highest colour index
};

enum class PlotWidth { half, full };

/// Scatter or uncertainty around a curve, in the unit of its y; both as long as the curve.
struct Band {
  std::vector<double> lower;
  std::vector<double> upper;
};

/// One curve of a plot. x need not be sorted: load and unload, closed outlines.
struct Curve {
  std::string
      name;  ///< in the legend; empty: belongs to the named curve before it (its pusher, its other half)
  std::vector<double> x;
  std::vector<double> y;  ///< as long as x
  CurveStyle style = CurveStyle::line;
  int colour = 0;  ///< index into the palette, >= 0
  std::optional<Band> band = std::nullopt;
};

struct Axis {
  std::string label;
  std::string unit;  ///< e.g. "mm"; empty for a pure number
};

struct Range {
  double lower = 0.0;
  double upper = 0.0;
};

struct PlotSpecification {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Curve> curves = {};
  AxesScale scale = AxesScale::independent;
  Palette palette = Palette::categorical;
  PlotWidth width = PlotWidth::half;
  std::optional<Range> y_window =
      std::nullopt;       ///< shown first, when some curve dwarfs the rest; a button shows all
  std::string note = {};  ///< printed under the plot; may be empty
};

/// Outlines that move, drawn to scale: one for every name in every frame.
struct AnimationFrame {
  using Line = std::vector<double>;       ///< x0, y0, x1, y1, ... in the unit of the plot
  std::string label;                      ///< "t = 0.120 s"
  std::vector<std::vector<Line>> outlines;  ///< each of any number of lines
};
struct AnimationSpecification {
  std::string title;
  std::vector<std::string> names;  ///< in the legend; one an outline
  std::vector<AnimationFrame> frames;
  std::string note = {};
};

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

struct Table {
  std::string caption;  ///< may be empty
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  ///< each as long as columns
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
/// see docs/decisions/0003-report-plots.md; half plots added one after the other share rows.
class ReportPage {
 public:
  /// Curves of more points than this are thinned, keeping the extremes of every stretch.
  static constexpr std::size_t max_points_per_curve = 4000;

  ReportPage(std::string title, std::string subtitle);

  /// Starts a section; it is listed in the page's contents.
  void heading(std::string_view text);
  void subheading(std::string_view text);
  void paragraph(std::string_view text);
  void list(const std::vector<std::string>& items);

  /// A remark in a box: something stopped, a verdict.
  void callout(std::string_view text, Tone tone);

  void key_figures(const std::vector<KeyFigure>& figures);

  /// Throws std::invalid_argument when a row and the columns differ in length.
  void table(const Table& table);

  /// Throws std::invalid_argument, naming plot, curve and index, when a value is not finite or lengths differ.
  /// A plot without any point is left out.
  void line_plot(const PlotSpecification& plot);

  /// Throws std::invalid_argument when a coordinate is not finite or a frame has another number of outlines than names.
  /// Without frames it is left out.
  void animation(const AnimationSpecification& animation);

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
  bool animated_ = false;
};

/// At most `digits` significant digits, no trailing zeros: 1.5, 719880, 2.3e-07.
/// Throws std::invalid_argument when the value is not finite.
std::string format_number(double value, int digits = 6);

/// At least `digits` significant digits, trailing zeros kept: 0.150, 85.2, 12345.
/// Throws std::invalid_argument when the value is not finite.
std::string format_significant(double value, int digits = 3);

/// Text made safe for the body and the attributes of an HTML page. Bytes that are not UTF-8 become U+FFFD.
std::string escape_html(std::string_view text);

}  // namespace snare::app
