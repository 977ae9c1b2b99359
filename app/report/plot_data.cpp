#include "app/report/plot_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::app {
namespace {

using nlohmann::json;

/// Digits of a value in the page: finer than any screen or printer shows.
constexpr int plotted_digits = 6;

double rounded(double value) {
  return std::strtod(fmt::format("{:.{}g}", value, plotted_digits).c_str(), nullptr);
}

/// All values have to be finite, those that are thinned out as well.
json plotted_values(const std::vector<double>& values, const std::vector<std::size_t>& picked,
                    const std::string& what) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw std::invalid_argument(fmt::format("{}[{}] = {}, must be finite", what, i, values[i]));
    }
  }
  json result = json::array();
  for (const std::size_t i : picked) result.push_back(rounded(values[i]));
  return result;
}

void require_length(std::size_t actual, std::size_t expected, const std::string& what) {
  if (actual != expected) {
    throw std::invalid_argument(fmt::format("{} has {} values, x has {}", what, actual, expected));
  }
}

/// Indices to draw: all, or of each of max/2 equal stretches the lowest and the highest point.
std::vector<std::size_t> thinned_indices(const std::vector<double>& values, std::size_t max_points) {
  std::vector<std::size_t> indices;
  if (values.size() <= max_points) {
    for (std::size_t i = 0; i < values.size(); ++i) indices.push_back(i);
    return indices;
  }
  const std::size_t stretches = max_points / 2;
  for (std::size_t k = 0; k < stretches; ++k) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(k * values.size() / stretches);
    const auto last = values.begin() + static_cast<std::ptrdiff_t>((k + 1) * values.size() / stretches);
    const auto [low, high] = std::minmax_element(first, last);
    const auto ordered = std::minmax(low, high);
    indices.push_back(static_cast<std::size_t>(ordered.first - values.begin()));
    if (ordered.first != ordered.second)
      indices.push_back(static_cast<std::size_t>(ordered.second - values.begin()));
  }
  return indices;
}

constexpr const char* style_names[] = {"line", "dashes", "points"};  // of CurveStyle

json curve_data(const Curve& curve, const std::string& plot_title) {
  const std::string what = fmt::format("plot '{}', curve '{}': ", plot_title, curve.name);
  if (curve.colour < 0)
    throw std::invalid_argument(fmt::format("{}colour = {}, must be >= 0", what, curve.colour));
  require_length(curve.y.size(), curve.x.size(), what + "y");
  const auto picked = thinned_indices(curve.y, max_points_per_curve);
  json data = {{"name", curve.name},
               {"style", style_names[static_cast<std::size_t>(curve.style)]},
               {"colour", curve.colour},
               {"x", plotted_values(curve.x, picked, what + "x")},
               {"y", plotted_values(curve.y, picked, what + "y")}};
  if (curve.band) {
    require_length(curve.band->lower.size(), curve.x.size(), what + "lower");
    require_length(curve.band->upper.size(), curve.x.size(), what + "upper");
    data["lower"] = plotted_values(curve.band->lower, picked, what + "lower");
    data["upper"] = plotted_values(curve.band->upper, picked, what + "upper");
  }
  return data;
}

}  // namespace

json plot_data(const PlotSpecification& plot) {
  const auto axis = [](const Axis& a) { return json{{"label", a.label}, {"unit", a.unit}}; };
  json data = {{"x", axis(plot.x)},
               {"y", axis(plot.y)},
               {"equal", plot.scale == AxesScale::equal},
               {"palette", plot.palette == Palette::sequential ? "sequential" : "categorical"},
               {"curves", json::array()}};
  for (const Curve& curve : plot.curves) data["curves"].push_back(curve_data(curve, plot.title));
  if (plot.y_window) {
    const auto [lower, upper] = *plot.y_window;
    data["window"] = plotted_values({lower, upper}, {0, 1}, fmt::format("plot '{}': y_window", plot.title));
    if (lower >= upper) {
      throw std::invalid_argument(
          fmt::format("plot '{}': y_window [{}, {}] is empty", plot.title, lower, upper));
    }
  }
  return data;
}

namespace {

/// Numbers of a scene, of so many steps to one.
json scene_numbers(const std::vector<double>& values, double steps, const std::string& title) {
  json shortened = json::array();
  for (const double value : values) {
    if (!std::isfinite(value))
      throw std::invalid_argument(fmt::format("scene \"{}\": a coordinate is {}", title, value));
    shortened.push_back(std::round(value * steps) / steps);
  }
  return shortened;
}

}  // namespace

json scene_data(const SceneSpecification& scene) {
  constexpr double per_mm = 100.0, per_one = 1e6;  // of lengths; of poses, for their quaternions
  static constexpr const char* kinds[] = {"wire", "arm", "solid"};  // of SceneItem::Kind
  const auto lines_of = [&](const std::vector<std::vector<double>>& lines) {
    json all = json::array();
    for (const std::vector<double>& line : lines) all.push_back(scene_numbers(line, per_mm, scene.title));
    return all;
  };
  const auto items_of = [&](const std::vector<SceneItem>& items) {
    json all = json::array();
    for (const SceneItem& item : items)
      all.push_back({{"name", item.name},
                     {"kind", kinds[static_cast<std::size_t>(item.kind)]},
                     {"lines", lines_of(item.lines)}});
    return all;
  };
  json data = {{"moving", items_of(scene.moving)},
               {"carried", items_of(scene.carried)},
               {"marks", json::array()},
               {"frames", json::array()}};
  for (const SceneMark& mark : scene.marks)
    data["marks"].push_back({{"time", mark.time}, {"text", mark.text}});
  for (const SceneFrame& frame : scene.frames) {
    require_length(frame.moving.size(), scene.moving.size(), "scene '" + scene.title + "': lines");
    require_length(frame.poses.size(), scene.carried.size(), "scene '" + scene.title + "': poses");
    json moving = json::array(), poses = json::array();
    for (const auto& lines : frame.moving) moving.push_back(lines_of(lines));
    for (const std::vector<double>& pose : frame.poses) {
      require_length(pose.size(), 7, "scene '" + scene.title + "': a pose");
      poses.push_back(scene_numbers(pose, per_one, scene.title));
    }
    data["frames"].push_back(
        {{"time", frame.time}, {"label", frame.label}, {"moving", moving}, {"poses", poses}});
  }
  return data;
}

}  // namespace snare::app
