#include "app/report/heat_map.hpp"

#include "app/report/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace snare::app {

namespace {

constexpr double width = 560.0, height = 420.0;  // of the drawing [px]
constexpr double left = 80.0, right = 90.0, top = 36.0, bottom = 56.0;

std::string colour(double share) {
  constexpr std::array<std::array<double, 3>, 6> stops{
      {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};
  const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  std::array<int, 3> rgb{};
  for (std::size_t c = 0; c < rgb.size(); ++c)
    rgb[c] = static_cast<int>(
        std::lround(stops[k][c] + (at - static_cast<double>(k)) * (stops[k + 1][c] - stops[k][c])));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

std::string text(double x, double y, const char* anchor, const std::string& words, const char* more = "") {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"12\" "
      "fill=\"currentColor\"{}>{}</text>\n",
      x, y, anchor, more, escape_html(words));
}

void check(const HeatMap& map) {
  const auto ascending = [](const std::vector<double>& edges) {
    return edges.size() > 1 && std::ranges::all_of(edges, [](double e) { return std::isfinite(e); }) &&
           std::ranges::is_sorted(edges) && edges.front() < edges.back();
  };
  if (!ascending(map.x_edges) || !ascending(map.y_edges) || !std::isfinite(map.low) ||
      !std::isfinite(map.high) || map.cells.size() != (map.x_edges.size() - 1) * (map.y_edges.size() - 1))
    throw std::invalid_argument("heat map " + map.title + ": edges or cells do not fit together");
}

}  // namespace

std::string heat_map(const HeatMap& map) {
  check(map);
  const double w = width - left - right, h = height - top - bottom;
  const auto px = [&](double x) {
    return left + w * (x - map.x_edges.front()) / (map.x_edges.back() - map.x_edges.front());
  };
  const auto py = [&](double y) {
    return top + h * (1.0 - (y - map.y_edges.front()) / (map.y_edges.back() - map.y_edges.front()));
  };
  const double size = map.high > map.low ? map.high - map.low : 1.0;
  std::string svg = fmt::format(
      "<figure class=\"map\" style=\"display:inline-block;width:47%;min-width:340px;margin:0 1% 14px\"><svg "
      "xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" "
      "style=\"width:100%;"
      "max-width:{0}px;font-family:sans-serif\" role=\"img\">\n",
      width, height);
  svg += text(left + 0.5 * w, 20.0, "middle", map.title, " font-weight=\"bold\"");
  const std::size_t columns = map.x_edges.size() - 1;
  for (std::size_t k = 0; k < map.cells.size(); ++k) {
    const HeatMap::Cell& cell = map.cells[k];
    if (!cell.known) continue;
    const std::size_t i = k % columns, j = k / columns;
    const double x = px(map.x_edges[i]), y = py(map.y_edges[j + 1]);
    svg += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
        "fill=\"{}\"{}><title>{}</title></rect>\n",
        x, y, px(map.x_edges[i + 1]) - x, py(map.y_edges[j]) - y, colour((cell.value - map.low) / size),
        cell.pale ? " fill-opacity=\"0.5\"" : "", escape_html(cell.hint));
  }
  svg += fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"currentColor\"/>\n", left,
      top, w, h);
  constexpr int ticks = 4;
  for (int t = 0; t <= ticks; ++t) {
    const double share = static_cast<double>(t) / ticks;
    const double x = map.x_edges.front() + share * (map.x_edges.back() - map.x_edges.front());
    const double y = map.y_edges.front() + share * (map.y_edges.back() - map.y_edges.front());
    svg += text(px(x), top + h + 18.0, "middle", format_number(x, 4));
    svg += text(left - 6.0, py(y) + 4.0, "end", format_number(y, 4));
    const double at = top + h * (1.0 - share);
    svg += text(width - right + 36.0, at + 4.0, "start", format_number(map.low + share * size, 3));
  }
  constexpr int steps = 32;
  for (int s = 0; s < steps; ++s) {
    svg += fmt::format("<rect x=\"{}\" y=\"{:.2f}\" width=\"14\" height=\"{:.2f}\" fill=\"{}\"/>\n",
                       width - right + 16.0, top + h * (1.0 - static_cast<double>(s + 1) / steps),
                       h / steps + 0.5, colour((s + 0.5) / steps));
  }
  svg += text(left + 0.5 * w, height - 14.0, "middle", map.x);
  svg += text(16.0, top + 0.5 * h, "middle", map.y,
              fmt::format(" transform=\"rotate(-90 16 {:.1f})\"", top + 0.5 * h).c_str());
  return svg + "</svg></figure>\n";
}

}  // namespace snare::app
