#pragma once

#include <string>
#include <vector>

namespace snare::app {

/// Coloured cells over two axes.
struct HeatMap {
  std::string title;
  std::string x, y;                      ///< labels of the axes
  std::vector<double> x_edges, y_edges;  ///< of the cells, ascending
  struct Cell {
    bool known = false;
    double value = 0.0;
    std::string hint;   ///< shown where one points at it
    bool pale = false;  ///< half its colour, for what is known at second hand
  };
  std::vector<Cell> cells;       ///< x fastest; (x_edges - 1) times (y_edges - 1)
  double low = 0.0, high = 1.0;  ///< values of the ends of the colours
};

/// As an SVG drawing: dark to light from low to high (viridis: van der Walt, Smith 2015), nothing where a
/// cell is not known.
/// Throws std::invalid_argument where numbers are not finite or do not fit together.
[[nodiscard]] std::string heat_map(const HeatMap& map);

}  // namespace snare::app
