#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace snare::app {

enum class CurveStyle { line, dashes, points };

enum class AxesScale {
  independent,  ///< each axis fills the frame
  equal         ///< one unit is equally long on both axes: shapes drawn to scale
};

enum class Palette {
  /// unrelated curves: black, blue, vermillion, ... (Okabe and Ito 2008, safe for colour-blind readers)
  categorical,
  /// a family in order, e.g. shapes along a push: dark to light, from lowest to highest colour index
  sequential
};

/// First colours of the categorical palette.
inline constexpr int black = 0, blue = 1, vermillion = 2, green = 3;

/// Curves of more points than this are drawn thinned, keeping the extremes of every stretch.
inline constexpr std::size_t max_points_per_curve = 4000;

enum class PlotWidth { half, full };

/// Scatter or uncertainty around a curve, in the unit of its y; both as long as the curve.
struct Band {
  std::vector<double> lower;
  std::vector<double> upper;
};

/// One curve of a plot. x need not be sorted: load and unload, closed outlines.
struct Curve {
  /// In the legend; empty: belongs to the named curve before it (its pusher, its other half).
  std::string name;
  std::vector<double> x;
  std::vector<double> y;  ///< as long as x
  CurveStyle style = CurveStyle::line;
  int colour = 0;  ///< index into the palette, >= 0
  std::optional<Band> band = std::nullopt;
};

using Values = std::vector<double>;

/// A curve of pairs; the shorter array ends it.
[[nodiscard]] Curve make_curve(std::string name, Values x, Values y, CurveStyle style, int colour);

/// Bands are this many standard deviations wide to either side: 95 % of normal scatter.
inline constexpr double band_sigmas = 2.0;
/// y -+ band_sigmas `deviation`, which may be longer than y, not shorter.
[[nodiscard]] Band band_around(const Values& y, const Values& deviation);

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
  std::optional<Range> y_window = std::nullopt;  ///< shown first: see close_up; a button shows all
  std::string note = {};                         ///< printed under the plot; may be empty
};

/// Of all that the curves and their bands show; both 0 without a value.
[[nodiscard]] Range extent(const std::vector<Curve>& curves);
[[nodiscard]] double size_of(const Range& range);

/// How far a close-up goes beyond what it is about, as shares of its size.
struct Margin {
  double below = 0.0;
  double above = 0.0;
};

/// Where one curve dwarfs the rest: the plot shows first what the rest needs, and its note says so.
void close_up(PlotSpecification& plot, const Range& rest, const Margin& margin, const std::string& note = {});

/// A time at which something happened.
struct SceneMark {
  double time = 0.0;  ///< [s]
  std::string text;
};

/// Something that is drawn in three dimensions.
struct SceneItem {
  enum class Kind { wire, arm, solid };
  std::string name;
  Kind kind = Kind::solid;
  std::vector<std::vector<double>> lines =
      {};  ///< of one that is carried, in its own frame: x0, y0, z0, x1, ... [mm]
};

struct SceneFrame {
  double time = 0.0;  ///< [s]
  std::string label;  ///< "t = 0.120 s"
  std::vector<std::vector<std::vector<double>>> moving =
      {};  ///< of each item that changes its shape its lines [mm]
  std::vector<std::vector<double>> poses =
      {};  ///< of each that is carried: place [mm], quaternion x, y, z, w
};

/// A motion in three dimensions, which the reader turns, magnifies and plays.
struct SceneSpecification {
  std::string title;
  std::vector<SceneItem> moving;   ///< change their shape: wires, arms
  std::vector<SceneItem> carried;  ///< keep it
  std::vector<SceneMark> marks;
  std::vector<SceneFrame> frames;
};

}  // namespace snare::app
