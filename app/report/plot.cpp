#include "app/report/plot.hpp"

#include <algorithm>
#include <utility>

namespace snare::app {

Curve make_curve(std::string name, Values x, Values y, CurveStyle style, int colour) {
  const std::size_t size = std::min(x.size(), y.size());
  x.resize(size);
  y.resize(size);
  return {std::move(name), std::move(x), std::move(y), style, colour, std::nullopt};
}

Band band_around(const Values& y, const Values& deviation) {
  Band band{y, y};
  for (std::size_t i = 0; i < y.size(); ++i) {
    band.lower[i] -= band_sigmas * deviation[i];
    band.upper[i] += band_sigmas * deviation[i];
  }
  return band;
}

Range extent(const std::vector<Curve>& curves) {
  Values all;
  for (const Curve& curve : curves) {
    const Band band = curve.band.value_or(Band{});
    for (const Values& values : {curve.y, band.lower, band.upper}) {
      all.insert(all.end(), values.begin(), values.end());
    }
  }
  return all.empty() ? Range{} : Range{std::ranges::min(all), std::ranges::max(all)};
}

double size_of(const Range& range) {
  return range.upper - range.lower;
}

void close_up(PlotSpecification& plot, const Range& rest, const Margin& margin, const std::string& note) {
  const double size = size_of(rest);
  plot.y_window = Range{rest.lower - margin.below * size, rest.upper + margin.above * size};
  if (!plot.note.empty() && !note.empty()) plot.note += ' ';
  plot.note += note;
}

}  // namespace snare::app
