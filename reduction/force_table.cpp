#include "reduction/force_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace snare::reduction {

namespace {

using Basis = std::array<double, 4>;

constexpr std::size_t guide_steps = 8;  // of the cell search, a knot

/// Cubic Hermite basis on a cell of width h at t in [0, 1]: value and slope below, value and slope above.
Basis hermite(double t, double h) {
  const double u = 1.0 - t;
  return {u * u * (1.0 + 2.0 * t), h * t * u * u, t * t * (1.0 + 2.0 * u), -h * u * t * t};
}

Basis hermite_slope(double t, double h) {
  const double u = 1.0 - t;
  return {-6.0 * t * u / h, u * (u - 2.0 * t), 6.0 * t * u / h, t * (t - 2.0 * u)};
}

/// Knots above a cell's lower one; an axis of one knot has none.
std::size_t upper(const std::vector<double>& axis, std::size_t lower) {
  return axis.size() > 1 ? lower + 1 : lower;
}

/// Bernstein coefficients of a cubic given by value and slope at both ends of a cell of width h.
std::array<double, 4> bernstein(const double* v, double h) {
  return {v[0], v[0] + h / 3.0 * v[1], v[2] - h / 3.0 * v[3], v[2]};
}

}  // namespace

ForceTable::ForceTable(Axes axes, const std::vector<double>& values, const std::vector<double>& slopes,
                       double span, double bending_stiffness, bool mirrored)
    : axes_(std::move(axes)),
      span_(span),
      force_scale_(bending_stiffness / (span * span)),
      mirrored_(mirrored) {
  const std::size_t nd = axes_[0].size();
  const std::size_t ns = axes_[1].size();
  const std::size_t ne = axes_[2].size();
  assert(nd >= 2 && values.size() == nd * ns * ne && slopes.size() == values.size());
  nodes_.assign(numbers_a_node * values.size(), 0.0);
  for (std::size_t n = 0; n < values.size(); ++n) {
    nodes_[numbers_a_node * n] = values[n] / force_scale_;
    nodes_[numbers_a_node * n + 1] = slopes[n] * span_ / force_scale_;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    const std::vector<double>& knots = axes_[a];
    if (knots.size() < 2) continue;
    Lookup& lookup = lookup_[a];
    const std::size_t steps = guide_steps * knots.size();
    lookup.low = knots.front();
    lookup.steps_per_unit = static_cast<double>(steps) / (knots.back() - knots.front());
    for (std::size_t i = 0; i <= steps; ++i) {
      lookup.guide.push_back(static_cast<unsigned>(numerics::find_cell(
          knots.data(), knots.size(), lookup.low + static_cast<double>(i) / lookup.steps_per_unit)));
    }
    for (std::size_t i = 0; i + 1 < knots.size(); ++i)
      lookup.inverse_widths.push_back(1.0 / (knots[i + 1] - knots[i]));
  }
  // Along the position, then along the slack: every number gets its slope.
  const bool level = mirrored_ && std::abs(axes_[1].back() - 0.5) < 1e-12;
  const Eigen::MatrixXd by_s = numerics::spline_slopes(axes_[1], level ? numerics::SplineEnd::level : numerics::SplineEnd::not_a_knot);
  const Eigen::MatrixXd by_e = numerics::spline_slopes(axes_[2]);
  const auto index = [&](std::size_t k, std::size_t i, std::size_t j) {
    return numbers_a_node * (k + nd * (i + ns * j));
  };
  for (std::size_t k = 0; k < nd; ++k) {
    for (std::size_t j = 0; j < ne; ++j) {
      for (std::size_t i = 0; i < ns; ++i) {
        for (std::size_t m = 0; m < ns; ++m) {
          const double w = by_s(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(m));
          for (std::size_t c = 0; c < 2; ++c)
            nodes_[index(k, i, j) + 2 + c] += w * nodes_[index(k, m, j) + c];
        }
      }
    }
    for (std::size_t i = 0; i < ns; ++i) {
      for (std::size_t j = 0; j < ne; ++j) {
        for (std::size_t m = 0; m < ne; ++m) {
          const double w = by_e(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(m));
          for (std::size_t c = 0; c < 4; ++c)
            nodes_[index(k, i, j) + 4 + c] += w * nodes_[index(k, i, m) + c];
        }
      }
    }
  }
}

std::array<double, 3> ForceTable::reduced(double travel, double position, double slack) const noexcept {
  double s = position / span_;
  if (mirrored_ && s > 0.5) s = 1.0 - s;
  return {travel / span_, s, slack / span_};
}

std::size_t ForceTable::Lookup::cell(const std::vector<double>& knots, double x) const noexcept {
  const double step = (x - low) * steps_per_unit;
  const auto last = static_cast<double>(guide.size() - 1);
  std::size_t i = guide[static_cast<std::size_t>(step > 0.0 ? std::min(step, last) : 0.0)];
  // Round-off may put a step's beginning on either side of a knot.
  while (i > 0 && x < knots[i]) --i;
  while (i + 2 < knots.size() && x >= knots[i + 1]) ++i;
  return i;
}

ForceTable::Cell ForceTable::locate(const std::array<double, 3>& x) const noexcept {
  Cell cell;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::vector<double>& axis = axes_[a];
    if (axis.size() == 1) {
      cell.basis[a] = {1.0, 0.0, 0.0, 0.0};
      continue;
    }
    const std::size_t i = lookup_[a].cell(axis, x[a]);
    cell.index[a] = i;
    cell.basis[a] = hermite((x[a] - axis[i]) * lookup_[a].inverse_widths[i], axis[i + 1] - axis[i]);
  }
  return cell;
}

double ForceTable::sum(const Cell& cell) const noexcept {
  const std::size_t nd = axes_[0].size();
  const std::size_t ns = axes_[1].size();
  const Basis& bd = cell.basis[0];
  double total = 0.0;
  for (std::size_t c = 0; c < 2; ++c) {
    const std::size_t j = c == 0 ? cell.index[2] : upper(axes_[2], cell.index[2]);
    for (std::size_t b = 0; b < 2; ++b) {
      const std::size_t i = b == 0 ? cell.index[1] : upper(axes_[1], cell.index[1]);
      const double* low = &nodes_[numbers_a_node * (cell.index[0] + nd * (i + ns * j))];
      const double* high = low + numbers_a_node;
      const auto along = [&](std::size_t pair) {
        return bd[0] * low[pair] + bd[1] * low[pair + 1] + bd[2] * high[pair] + bd[3] * high[pair + 1];
      };
      const double vs = cell.basis[1][2 * b];
      const double ms = cell.basis[1][2 * b + 1];
      total += cell.basis[2][2 * c] * (vs * along(0) + ms * along(2)) +
               cell.basis[2][2 * c + 1] * (vs * along(4) + ms * along(6));
    }
  }
  return total;
}

double ForceTable::derivative(const std::array<double, 3>& x, std::size_t axis) const noexcept {
  if (axes_[axis].size() == 1) return 0.0;
  Cell cell = locate(x);
  const double low = axes_[axis][cell.index[axis]];
  const double h = axes_[axis][cell.index[axis] + 1] - low;
  cell.basis[axis] = hermite_slope((x[axis] - low) / h, h);
  return sum(cell);
}

double ForceTable::force(double travel, double position, double slack) const noexcept {
  if (travel < 0.0) return 0.0;
  return force_scale_ * sum(locate(reduced(travel, position, slack)));
}

LawValue ForceTable::at(double travel, double position, double slack, Outside outside) const {
  LawValue result;
  if (travel < 0.0) return result;
  const std::array<double, 3> x = reduced(travel, position, slack);
  std::array<double, 3> inside = x;
  for (std::size_t a = 0; a < 3; ++a) {
    // A fixed value may be met to the last digits only.
    const double margin = 1e-9 * std::max(1.0, std::abs(axes_[a].back()));
    inside[a] = std::clamp(x[a], axes_[a].front(), axes_[a].back());
    if (std::abs(inside[a] - x[a]) <= margin) continue;
    if (outside == Outside::refuse) {
      constexpr std::array<const char*, 3> names{"travel", "position", "slack"};
      throw std::domain_error(
          fmt::format("{} of {:.6g} mm is outside the range of the table, {:.6g} to {:.6g} mm", names[a],
                      1e3 * x[a] * span_, 1e3 * axes_[a].front() * span_, 1e3 * axes_[a].back() * span_));
    }
    result.extrapolated = true;
  }
  result.force = sum(locate(inside));
  result.stiffness = derivative(inside, 0);
  if (result.extrapolated) {
    for (std::size_t a = 0; a < 3; ++a) result.force += derivative(inside, a) * (x[a] - inside[a]);
  }
  result.force *= force_scale_;
  result.stiffness *= force_scale_ / span_;
  return result;
}

numerics::HermiteCurve ForceTable::curve(double position, double slack) const {
  const std::size_t nd = axes_[0].size();
  std::vector<double> travel, value, slope;
  for (std::size_t k = 0; k < nd; ++k) {
    std::array<double, 3> x = reduced(axes_[0][k] * span_, position, slack);
    x[0] = axes_[0][k];
    travel.push_back(x[0] * span_);
    value.push_back(force_scale_ * sum(locate(x)));
    slope.push_back(force_scale_ / span_ * derivative(x, 0));
  }
  return {travel, value, slope};
}

bool ForceTable::proven_monotone() const {
  const std::size_t nd = axes_[0].size();
  const std::size_t ns = axes_[1].size();
  const auto width = [&](std::size_t a, std::size_t i) {
    return axes_[a].size() > 1 ? axes_[a][i + 1] - axes_[a][i] : 1.0;
  };
  // Differences of neighbouring Bernstein coefficients along the travel are those of dF/dd.
  for (std::size_t j = 0; j < std::max<std::size_t>(1, axes_[2].size() - 1); ++j) {
    for (std::size_t i = 0; i < std::max<std::size_t>(1, ns - 1); ++i) {
      for (std::size_t k = 0; k + 1 < nd; ++k) {
        // numbers[c][b] hold (value, slope) below and above along each direction in turn: 4 x 4 x 4 coefficients.
        std::array<std::array<std::array<double, 4>, 4>, 4> t{};
        for (std::size_t c = 0; c < 4; ++c) {
          for (std::size_t b = 0; b < 4; ++b) {
            const std::size_t jj = c < 2 ? j : upper(axes_[2], j);
            const std::size_t ii = b < 2 ? i : upper(axes_[1], i);
            const std::size_t offset = 4 * (c % 2) + 2 * (b % 2);
            const double* low = &nodes_[numbers_a_node * (k + nd * (ii + ns * jj)) + offset];
            const std::array<double, 4> v{low[0], low[1], low[numbers_a_node], low[numbers_a_node + 1]};
            t[c][b] = bernstein(v.data(), width(0, k));
          }
        }
        for (std::size_t a = 0; a < 4; ++a) {
          for (std::size_t c = 0; c < 4; ++c) {
            const std::array<double, 4> v{t[c][0][a], t[c][1][a], t[c][2][a], t[c][3][a]};
            const std::array<double, 4> w = bernstein(v.data(), width(1, i));
            for (std::size_t b = 0; b < 4; ++b) t[c][b][a] = w[b];
          }
          for (std::size_t b = 0; b < 4; ++b) {
            const std::array<double, 4> v{t[0][b][a], t[1][b][a], t[2][b][a], t[3][b][a]};
            const std::array<double, 4> w = bernstein(v.data(), width(2, j));
            for (std::size_t c = 0; c < 4; ++c) t[c][b][a] = w[c];
          }
        }
        for (std::size_t a = 0; a + 1 < 4; ++a) {
          for (std::size_t b = 0; b < 4; ++b) {
            for (std::size_t c = 0; c < 4; ++c) {
              if (t[c][b][a + 1] < t[c][b][a]) return false;
            }
          }
        }
      }
    }
  }
  return true;
}

double ForceTable::least_stiffness(int refinement) const {
  const auto lattice = [&](const std::vector<double>& axis) {
    std::vector<double> x{axis.front()};
    for (std::size_t i = 0; i + 1 < axis.size(); ++i) {
      for (int r = 1; r <= refinement; ++r) x.push_back(axis[i] + (axis[i + 1] - axis[i]) * r / refinement);
    }
    return x;
  };
  double least = derivative({axes_[0].front(), axes_[1].front(), axes_[2].front()}, 0);
  for (const double e : lattice(axes_[2])) {
    for (const double s : lattice(axes_[1])) {
      for (const double d : lattice(axes_[0])) least = std::min(least, derivative({d, s, e}, 0));
    }
  }
  return least * force_scale_ / span_;
}

}  // namespace snare::reduction
