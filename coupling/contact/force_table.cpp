#include "coupling/contact/force_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace snare::coupling {

namespace {

using Basis = std::array<double, 4>;

/// The numbers of a node: the value, and its derivatives by travel d, position s and slack e. A pair (x, x_d)
/// follows a cubic along the travel.
enum Slot : std::size_t {
  value = 0,
  by_d = 1,
  by_s = 2,
  by_ds = 3,
  by_e = 4,
  by_de = 5,
  by_se = 6,
  by_dse = 7
};

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

using Index = std::array<std::size_t, 3>;
using Bases = std::array<Basis, 3>;

/// Value and slope along the travel at the knots k and k + 1, at the position and slack of a cell. Each is a
/// sum over the corners (b, c),
///   V_e (V_s f + M_s f_s) + M_e (V_s f_e + M_s f_se);   V and M weigh the value and the slope at a corner.
std::array<double, 4> ends(const ForceTable::Axes& axes, const std::vector<double>& nodes, std::size_t k,
                           const Index& index, const Bases& basis) noexcept {
  std::array<double, 4> total{};
  for (std::size_t c = 0; c < 2; ++c) {
    const std::size_t j = c == 0 ? index[2] : upper(axes[2], index[2]);
    for (std::size_t b = 0; b < 2; ++b) {
      const std::size_t i = b == 0 ? index[1] : upper(axes[1], index[1]);
      const double vs = basis[1][2 * b];
      const double ms = basis[1][2 * b + 1];
      const double ve = basis[2][2 * c];
      const double me = basis[2][2 * c + 1];
      const double* at = &nodes[ForceTable::numbers_a_node * (k + axes[0].size() * (i + axes[1].size() * j))];
      for (std::size_t n = 0; n < 4; ++n) {
        const double* x = at + ForceTable::numbers_a_node * (n / 2) + n % 2;
        total[n] += ve * (vs * x[value] + ms * x[by_s]) + me * (vs * x[by_e] + ms * x[by_se]);
      }
    }
  }
  return total;
}

/// The continuation beyond the positions or slacks, at the travel x, in the dimensionless groups. A cubic
/// whose Bernstein coefficients do not fall does not fall. Those of the linear continuation are therefore
/// raised to the largest one before them, from 0 at first touch; where the continuation rises by itself
/// nothing changes.
LawValue rising(const ForceTable::Axes& axes, const std::vector<double>& nodes, double x, const Index& index,
                const Bases& basis) noexcept {
  const std::vector<double>& knots = axes[0];
  std::array<double, 4> c{};
  double top = 0.0;
  std::size_t k = 0;
  for (;; ++k) {
    c = bernstein(ends(axes, nodes, k, index, basis).data(), knots[k + 1] - knots[k]);
    for (double& one : c) one = top = std::max(top, one);
    if (x < knots[k + 1] || k + 2 == knots.size()) break;
  }
  const double h = knots[k + 1] - knots[k];
  const double t = (x - knots[k]) / h;
  if (t > 1.0) {
    const double stiffness = 3.0 * (c[3] - c[2]) / h;
    return {c[3] + stiffness * (x - knots[k + 1]), stiffness, true};
  }
  const double u = 1.0 - t;
  return {u * u * u * c[0] + 3.0 * u * u * t * c[1] + 3.0 * u * t * t * c[2] + t * t * t * c[3],
          3.0 * (u * u * (c[1] - c[0]) + 2.0 * u * t * (c[2] - c[1]) + t * t * (c[3] - c[2])) / h, true};
}

}  // namespace

ForceTable::ForceTable(Axes axes, double span, double force_scale, bool mirrored)
    : axes_(std::move(axes)), span_(span), force_scale_(force_scale), mirrored_(mirrored) {
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
}

ForceTable::ForceTable(Axes axes, const std::vector<double>& values, const std::vector<double>& slopes,
                       double span, double bending_stiffness, bool mirrored)
    : ForceTable(std::move(axes), span, bending_stiffness / (span * span), mirrored) {
  const std::size_t nd = axes_[0].size();
  const std::size_t ns = axes_[1].size();
  const std::size_t ne = axes_[2].size();
  assert(nd >= 2 && values.size() == nd * ns * ne && slopes.size() == values.size());
  nodes_.assign(numbers_a_node * values.size(), 0.0);
  for (std::size_t n = 0; n < values.size(); ++n) {
    nodes_[numbers_a_node * n + value] = values[n] / force_scale_;
    nodes_[numbers_a_node * n + by_d] = slopes[n] * span_ / force_scale_;
  }
  // Slopes of the C2 spline along the position, D_s of (value, d), then along the slack, D_e of all four.
  const bool level = mirrored_ && std::abs(axes_[1].back() - 0.5) < 1e-12;
  const Eigen::MatrixXd slope_s =
      numerics::spline_slopes(axes_[1], level ? numerics::SplineEnd::level : numerics::SplineEnd::not_a_knot);
  const Eigen::MatrixXd slope_e = numerics::spline_slopes(axes_[2]);
  for (std::size_t k = 0; k < nd; ++k) {
    for (std::size_t j = 0; j < ne; ++j) {
      for (std::size_t i = 0; i < ns; ++i) {
        for (std::size_t m = 0; m < ns; ++m) {
          const double w = slope_s(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(m));
          for (const Slot from : {value, by_d})
            nodes_[node(k, i, j) + by_s + from] += w * nodes_[node(k, m, j) + from];
        }
      }
    }
    for (std::size_t i = 0; i < ns; ++i) {
      for (std::size_t j = 0; j < ne; ++j) {
        for (std::size_t m = 0; m < ne; ++m) {
          const double w = slope_e(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(m));
          for (const Slot from : {value, by_d, by_s, by_ds})
            nodes_[node(k, i, j) + by_e + from] += w * nodes_[node(k, i, m) + from];
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
  const std::array<double, 4> end = ends(axes_, nodes_, cell.index[0], cell.index, cell.basis);
  const Basis& bd = cell.basis[0];
  return bd[0] * end[0] + bd[1] * end[1] + bd[2] * end[2] + bd[3] * end[3];
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
  return std::max(0.0, force_scale_ * sum(locate(reduced(travel, position, slack))));
}

// Outside the range the force continues linearly in each of the three: along the travel with the stiffness of
// its end, along the position up to the mounts and constant beyond them. A continued force is never negative
// and never falls along the travel: where it would, it keeps its largest value so far.       theory.md (R.12)
LawValue ForceTable::at(double travel, double position, double slack, Outside outside) const {
  if (travel < 0.0) return {};
  std::array<double, 3> x = reduced(travel, position, slack);
  std::array<double, 3> nearest = x;
  std::array<bool, 3> beyond{};
  for (std::size_t a = 0; a < 3; ++a) {
    // A fixed value may be met to the last digits only.
    const double margin = 1e-9 * std::max(1.0, std::abs(axes_[a].back()));
    nearest[a] = std::clamp(x[a], axes_[a].front(), axes_[a].back());
    beyond[a] = !(std::abs(nearest[a] - x[a]) <= margin);
    if (!beyond[a]) x[a] = nearest[a];
    if (beyond[a] && outside == Outside::refuse) {
      constexpr std::array<const char*, 3> names{"travel", "position", "slack"};
      throw std::domain_error(
          fmt::format("{} of {:.6g} mm is outside the range of the table, {:.6g} to {:.6g} mm{}", names[a],
                      1e3 * std::array{travel, position, slack}[a], 1e3 * axes_[a].front() * span_,
                      1e3 * axes_[a].back() * span_, a == 1 && mirrored_ ? " and its mirror image" : ""));
    }
  }
  x[1] = std::clamp(x[1], std::min(0.0, nearest[1]), std::max(1.0, nearest[1]));  // between the mounts
  Cell cell = locate(nearest);
  for (std::size_t a = 0; a < 3; ++a) {
    if (x[a] == nearest[a] || axes_[a].size() == 1) continue;
    const double low = axes_[a][cell.index[a]];
    const double h = axes_[a][cell.index[a] + 1] - low;
    const Basis slope = hermite_slope((nearest[a] - low) / h, h);
    for (std::size_t n = 0; n < 4; ++n) cell.basis[a][n] += (x[a] - nearest[a]) * slope[n];
  }
  LawValue result;
  if (beyond[1] || beyond[2]) {
    result = rising(axes_, nodes_, x[0], cell.index, cell.basis);
  } else {
    result.force = sum(cell);
    result.stiffness = derivative(nearest, 0);
    result.extrapolated = beyond[0];
    if (beyond[0] && result.stiffness < 0.0) result = {sum(locate(nearest)), 0.0, true};
    if (result.force < 0.0) result = {0.0, 0.0, beyond[0]};
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

bool ForceTable::rises_in_cell(std::size_t k, std::size_t i, std::size_t j) const {
  const auto width = [&](std::size_t axis, std::size_t low) {
    return axes_[axis].size() > 1 ? axes_[axis][low + 1] - axes_[axis][low] : 1.0;
  };
  // t[c][b][a]: along each direction first (value, slope) below and (value, slope) above, then, one direction
  // after the other, its four Bernstein coefficients; a along the travel, b the position, c the slack.
  std::array<std::array<std::array<double, 4>, 4>, 4> t{};
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t b = 0; b < 4; ++b) {
      const std::size_t jj = c < 2 ? j : upper(axes_[2], j);
      const std::size_t ii = b < 2 ? i : upper(axes_[1], i);
      const std::size_t x = (c % 2 == 0 ? value : by_e) + (b % 2 == 0 ? value : by_s);
      const double* low = &nodes_[node(k, ii, jj) + x];
      const double* high = low + numbers_a_node;
      const std::array<double, 4> v{low[value], low[by_d], high[value], high[by_d]};
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
  // Differences of neighbouring coefficients along the travel are those of dF/dd, but for a positive factor.
  for (std::size_t a = 0; a + 1 < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      for (std::size_t c = 0; c < 4; ++c) {
        if (t[c][b][a + 1] < t[c][b][a]) return false;
      }
    }
  }
  return true;
}

bool ForceTable::proven_monotone() const {
  // An axis of one knot is one cell.
  const auto cells = [&](std::size_t axis) { return std::max<std::size_t>(1, axes_[axis].size() - 1); };
  for (std::size_t j = 0; j < cells(2); ++j) {
    for (std::size_t i = 0; i < cells(1); ++i) {
      for (std::size_t k = 0; k < cells(0); ++k) {
        if (!rises_in_cell(k, i, j)) return false;
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

}  // namespace snare::coupling
