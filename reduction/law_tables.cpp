#include "base/one_line.hpp"
#include "coupling/contact/force_table.hpp"
#include "reduction/export_text.hpp"
#include "reduction/law_simulators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace snare::reduction {

namespace {

constexpr int most_pieces = 16;
constexpr double beyond_travel = 2.0;  // end of the rows over the end of the travel
// of the first cell: distance from the last row without contact to first touch
constexpr double touch_width = 1e-2;
// of the span: columns with the values at the mounts, so that linear readers keep them
constexpr double beyond_mounts = 0.1;
constexpr int columns_to_a_mount = 4;  // from the end of the positions, for each piece

/// The knots of an axis with `pieces` even pieces between them.
std::vector<double> refined(const std::vector<double>& knots, int pieces) {
  std::vector<double> more{knots.front()};
  for (std::size_t i = 1; i < knots.size(); ++i) {
    for (int k = 1; k <= pieces; ++k) more.push_back(knots[i - 1] + (knots[i] - knots[i - 1]) * k / pieces);
  }
  return more;
}

/// Travels with two rows without contact before first touch and two of the linear continuation behind the
/// end.
std::vector<double> with_ends(const std::vector<double>& travel) {
  const double end = travel.back();
  std::vector<double> all{-end, -touch_width * travel[1]};
  all.insert(all.end(), travel.begin(), travel.end());
  all.push_back(end + (end - travel[travel.size() - 2]));
  all.push_back(beyond_travel * end);
  return all;
}

/// Positions over the span: the knots and, where left and right are alike, their mirror image, refined; on
/// either side the continuation up to the mounts.
std::vector<double> position_columns(const coupling::ForceTable& table, int pieces) {
  std::vector<double> knots = table.axes()[1];
  if (table.mirrored()) {
    const std::vector<double> near = knots;
    if (near.back() < 0.5 * (1.0 - 1e-9)) knots.push_back(0.5);
    for (auto k = near.rbegin(); k != near.rend(); ++k) {
      if (1.0 - *k > knots.back() * (1.0 + 1e-9)) knots.push_back(1.0 - *k);
    }
  }
  const std::vector<double> inside = refined(knots, pieces);
  const int steps = columns_to_a_mount * pieces;
  std::vector<double> all{-beyond_mounts};
  for (int i = 0; i < steps; ++i) all.push_back(inside.front() * i / steps);
  all.insert(all.end(), inside.begin(), inside.end());
  for (int i = steps - 1; i >= 0; --i) all.push_back(1.0 - (1.0 - inside.back()) * i / steps);
  all.push_back(1.0 + beyond_mounts);
  return all;
}

/// A grid of travels and positions [m] at one slack, with the continuation of the law around its range.
struct Grid {
  std::vector<double> travel, position;
  std::vector<std::vector<double>> force;  ///< a column of travels for every position [N]
};

double law_force(const coupling::ForceTable& table, double d, double s, double slack) {
  return table.at(d, s, slack, coupling::Outside::extrapolate).force;
}

Grid grid_of(const coupling::ForceTable& table, double slack, int pieces) {
  Grid grid;
  for (const double d : with_ends(refined(table.axes()[0], pieces))) grid.travel.push_back(d * table.span());
  for (const double s : position_columns(table, pieces)) {
    grid.position.push_back(s * table.span());
    std::vector<double>& column = grid.force.emplace_back();
    for (const double d : grid.travel) column.push_back(law_force(table, d, grid.position.back(), slack));
  }
  return grid;
}

/// Interpolation along the travel.
enum class Along { linear, akima };

/// Slopes of Akima's interpolation (Akima 1970): means of the secants on either side, weighted by how little
/// the secants beyond them change; two secants more at either end, in arithmetic progression.
std::vector<double> akima_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> m(n + 3);  // of the cell k at k + 2
  for (std::size_t k = 0; k + 1 < n; ++k) m[k + 2] = (y[k + 1] - y[k]) / (x[k + 1] - x[k]);
  m[1] = 2.0 * m[2] - m[3];
  m[0] = 2.0 * m[1] - m[2];
  m[n + 1] = 2.0 * m[n] - m[n - 1];
  m[n + 2] = 2.0 * m[n + 1] - m[n];
  std::vector<double> slopes;
  for (std::size_t k = 0; k < n; ++k) {
    const double before = std::abs(m[k + 3] - m[k + 2]);
    const double after = std::abs(m[k + 1] - m[k]);
    slopes.push_back(before + after > 0.0 ? (before * m[k + 1] + after * m[k + 2]) / (before + after)
                                          : 0.5 * (m[k + 1] + m[k + 2]));
  }
  return slopes;
}

/// Values of a column at a quarter, half, three quarters and the end of every cell along the travel.
std::vector<double> between(const std::vector<double>& travel, const std::vector<double>& force,
                            Along along) {
  const numerics::HermiteCurve curve(
      travel, force,
      along == Along::akima ? akima_slopes(travel, force) : std::vector<double>(travel.size()));
  std::vector<double> values;
  for (std::size_t i = 0; i + 1 < travel.size(); ++i) {
    for (const double u : {0.25, 0.5, 0.75, 1.0}) {
      values.push_back(along == Along::akima ? curve.value((1.0 - u) * travel[i] + u * travel[i + 1])
                                             : (1.0 - u) * force[i] + u * force[i + 1]);
    }
  }
  return values;
}

/// Largest error of an interpolation of the grid, linear in the position, against the law, at four times four
/// places in every cell [N].
double grid_error(const coupling::ForceTable& table, double slack, const Grid& grid, Along along) {
  double largest = 0.0;
  std::vector<double> left = between(grid.travel, grid.force.front(), along);
  for (std::size_t k = 1; k < grid.position.size(); ++k) {
    const std::vector<double> right = between(grid.travel, grid.force[k], along);
    for (std::size_t p = 0; p < left.size(); ++p) {
      const std::size_t i = p / 4;
      const double u = 0.25 * static_cast<double>(p % 4 + 1);
      const double d = (1.0 - u) * grid.travel[i] + u * grid.travel[i + 1];
      for (const double v : {0.25, 0.5, 0.75, 1.0}) {
        const double s = (1.0 - v) * grid.position[k - 1] + v * grid.position[k];
        largest =
            std::max(largest, std::abs((1.0 - v) * left[p] + v * right[p] - law_force(table, d, s, slack)));
      }
    }
    left = right;
  }
  return largest;
}

struct RefinedGrid {
  Grid grid;
  double error = 0.0;  ///< of the worst interpolation [N]
};

/// The coarsest grid that brings the interpolations within the stated bound of the table, or that with
/// most_pieces.
RefinedGrid refined_grid(const DistilledCase& one, const std::vector<Along>& interpolations) {
  const coupling::ForceTable& table = *one.table.loading;
  const double slack = one.wire.nominal_slack();
  RefinedGrid result;
  for (int pieces = 1; pieces <= most_pieces; pieces *= 2) {
    result = {grid_of(table, slack, pieces), 0.0};
    for (const Along along : interpolations)
      result.error = std::max(result.error, grid_error(table, slack, result.grid, along));
    if (result.error <= one.table.loading_error.bound) break;
  }
  return result;
}

/// "a, b, c" in lines of at most 80 characters, each continued by a leading comma.
std::string adams_numbers(const char* key, const std::vector<double>& values) {
  return fmt::format(", {}={}\n", key, number_list(values, 3, "\n, "));
}

/// One spline of a law position through the full wire's curve, with the continuation around its range.
struct PlaceSpline {
  std::vector<double> travel, force;
  double error = 0.0;  ///< against the full wire, of the worse interpolation [N]
};

PlaceSpline place_spline(const DistilledPlace& place) {
  const numerics::HermiteCurve& full = place.full;
  const double end = full.knots().back();
  const double slope = std::max(0.0, full.slope(end));
  const auto law = [&](double d) {
    if (d < 0.0) return 0.0;
    return d > end ? std::max(0.0, full.value(end)) + slope * (d - end) : std::max(0.0, full.value(d));
  };
  PlaceSpline spline{with_ends(full.knots()), {}, 0.0};
  for (const double d : spline.travel) spline.force.push_back(law(d));
  for (const Along along : {Along::linear, Along::akima}) {
    const std::vector<double> values = between(spline.travel, spline.force, along);
    for (std::size_t p = 0; p < values.size(); ++p) {
      const double u = 0.25 * static_cast<double>(p % 4 + 1);
      const double d = (1.0 - u) * spline.travel[p / 4] + u * spline.travel[p / 4 + 1];
      spline.error = std::max(spline.error, std::abs(values[p] - law(d)));
    }
  }
  return spline;
}

}  // namespace

LookupTable lookup_table(const DistilledCase& one) {
  const auto [grid, error] = refined_grid(one, {Along::linear});
  std::string text;
  for (const double s : grid.position) text += fmt::format(",{}", s);
  text += "\n";
  for (std::size_t i = 0; i < grid.travel.size(); ++i) {
    text += fmt::format("{}", grid.travel[i]);
    for (const std::vector<double>& column : grid.force) text += fmt::format(",{}", column[i]);
    text += "\n";
  }
  return {text, error};
}

AdamsSplines adams_splines(const DistilledCase& one, const std::string& title) {
  AdamsSplines result;
  for (const std::string& line : head_lines(one, title)) result.text += "! " + line + "\n";
  result.text +=
      "! Read by AKISPL. Rows at negative travel have no force; beyond the range LINEAR_EXTRAPOLATION "
      "continues the "
      "last rows.\n";
  const double slack_mm = 1e3 * one.wire.nominal_slack();
  int number = 1;
  for (const DistilledPlace& place : one.places) {
    const PlaceSpline spline = place_spline(place);
    result.place_errors.push_back(spline.error);
    result.text += fmt::format("! s = {:.6g} mm, slack {:.6g} mm\nSPLINE/{}\n, LINEAR_EXTRAPOLATION\n",
                               1e3 * place.position, slack_mm, number++);
    result.text += adams_numbers("X", spline.travel) + adams_numbers("Y", spline.force);
  }
  const auto [grid, error] = refined_grid(one, {Along::linear, Along::akima});
  result.surface_error = error;
  result.text += fmt::format(
      "! travel (X) and position s (Z) at a slack of {:.6g} mm\nSPLINE/{}\n, LINEAR_EXTRAPOLATION\n",
      slack_mm, number);
  result.text += adams_numbers("X", grid.travel);
  for (std::size_t k = 0; k < grid.position.size(); ++k) {
    // The first number of a Y list is its Z.
    std::vector<double> row{grid.position[k]};
    row.insert(row.end(), grid.force[k].begin(), grid.force[k].end());
    result.text += adams_numbers("Y", row);
  }
  return result;
}

}  // namespace snare::reduction
