#include "identification/fitting/identifiability.hpp"

#include "numerics/dense_solvers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double error_margin = 3.0;   // differences by two steps tell the size of an error, not its bound
constexpr double least_margin = 1e-9;  // rounding of the columns, and of the decomposition
// error of a direction, in columns of norm 1, from which a null one is checked
constexpr double in_doubt = 1e-3;
// the same: below so many errors a direction that is seen is checked, too
constexpr double near_margin = 300.0;
constexpr double weakly_seen = 0.1;  // if its numbers nearly go together

/// Singular directions of the columns `live`, scaled to norm 1, parted into those that the readings see and
/// null ones.
struct Parted {
  MatrixXd null;      // columns of norm 1, in scaled numbers
  double leak = 0.0;  // size of the components of `null` that are due to errors of the derivatives
};

Parted part(const MatrixXd& scaled, const MatrixXd& error, const VectorXd& scale, const NullCheck& check) {
  const Index n = scaled.cols();
  // As many rows as columns, so that every direction has its singular value.
  MatrixXd square = MatrixXd::Zero(std::max(scaled.rows(), n), n);
  square.topRows(scaled.rows()) = scaled;
  const numerics::ThinSvd svd = numerics::thin_svd(square);
  Parted parted;
  std::vector<Index> null;
  double largest_error = least_margin, smallest_seen = 1.0;
  for (Index k = 0; k < n; ++k) {
    const VectorXd v = svd.V.col(k);
    const double doubt = error.size() > 0 ? (error * v).norm() : 0.0;
    bool is_null = svd.s[k] <= error_margin * doubt + least_margin;
    const bool ask = is_null ? doubt > in_doubt : svd.s[k] <= near_margin * doubt && svd.s[k] < weakly_seen;
    if (ask && check) is_null = check(v.cwiseProduct(scale)).value_or(is_null);
    if (is_null) {
      null.push_back(k);
      largest_error = std::max(largest_error, doubt);
    } else {
      smallest_seen = std::min(smallest_seen, svd.s[k]);
    }
  }
  parted.null = svd.V(Eigen::all, null);
  parted.leak = std::clamp(error_margin * largest_error / smallest_seen, 1e-6, 0.1);
  return parted;
}

/// Basis of the columns of `null` in which each has a row of its own: Gauss-Jordan elimination with complete
/// pivoting.
/// rows: the pivots, in the order of the columns.
void reduce(MatrixXd& null, std::vector<Index>& rows) {
  const Index d = null.cols();
  for (Index k = 0; k < d; ++k) {
    Index row = 0, column = k;
    null.rightCols(d - k).cwiseAbs().maxCoeff(&row, &column);
    null.col(k).swap(null.col(k + column));
    null.col(k) /= null(row, k);
    for (Index j = 0; j < d; ++j)
      if (j != k) null.col(j) -= null(row, j) * null.col(k);
    rows.push_back(row);
  }
}

/// (J^T J)^-1 of the columns that are not held; zero in the rows of the others.
MatrixXd covariance_beside(const MatrixXd& jacobian, const VectorXd& scale, const std::vector<bool>& held) {
  const Index n = jacobian.cols();
  std::vector<Index> free;
  for (Index k = 0; k < n; ++k)
    if (!held[static_cast<std::size_t>(k)]) free.push_back(k);
  MatrixXd covariance = MatrixXd::Zero(n, n);
  if (free.empty()) return covariance;
  const VectorXd own = scale(free);
  const numerics::ThinSvd svd = numerics::thin_svd(jacobian(Eigen::all, free) * own.asDiagonal());
  Index rank = 0;
  while (rank < svd.s.size() && svd.s[rank] > 0.1 * least_margin * svd.s[0]) ++rank;
  const MatrixXd directions =
      own.asDiagonal() * svd.V.leftCols(rank) * svd.s.head(rank).cwiseInverse().asDiagonal();
  covariance(free, free) = directions * directions.transpose();
  return covariance;
}

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
  return text;
}

}  // namespace

Identifiability identifiability_of(const MatrixXd& jacobian, const MatrixXd& error, const NullCheck& check) {
  const Index n = jacobian.cols();
  const auto count = static_cast<std::size_t>(n);
  Identifiability result;
  result.known.assign(count, true);
  std::vector<bool> held(count, false);
  VectorXd scale = VectorXd::Ones(n);
  std::vector<Index> live;
  for (Index k = 0; k < n; ++k) {
    const double norm = jacobian.col(k).norm();
    bool is_null = norm <= (error.size() > 0 ? error_margin * error.col(k).norm() : 0.0);
    if (is_null && norm > 0.0 && check) is_null = check(VectorXd::Unit(n, k) / norm).value_or(is_null);
    if (!is_null) {
      live.push_back(k);
      scale[k] = 1.0 / norm;
      continue;
    }
    result.known[static_cast<std::size_t>(k)] = false;
    held[static_cast<std::size_t>(k)] = true;
    result.directions.push_back({static_cast<std::size_t>(k), {}, VectorXd::Unit(n, k)});
  }
  if (!live.empty()) {
    const VectorXd own = scale(live);
    const MatrixXd off = error.size() > 0 ? MatrixXd(error(Eigen::all, live) * own.asDiagonal()) : MatrixXd();
    const NullCheck whole = check ? NullCheck([&](const VectorXd& direction) {
      VectorXd all = VectorXd::Zero(n);
      all(live) = direction;
      return check(all);
    })
                                  : NullCheck();
    Parted parted = part(jacobian(Eigen::all, live) * own.asDiagonal(), off, own, whole);
    std::vector<Index> rows;
    reduce(parted.null, rows);
    for (std::size_t j = 0; j < rows.size(); ++j) {
      NullDirection direction{
          static_cast<std::size_t>(live[static_cast<std::size_t>(rows[j])]), {}, VectorXd::Zero(n)};
      for (std::size_t i = 0; i < live.size(); ++i) {
        const double moved = parted.null(static_cast<Index>(i), static_cast<Index>(j));
        const auto number = static_cast<std::size_t>(live[i]);
        if (number != direction.held && std::abs(moved) <= parted.leak) continue;
        direction.change[live[i]] = moved * own[static_cast<Index>(i)] / own[rows[j]];
        if (number != direction.held) direction.others.push_back(number);
        result.known[number] = false;
      }
      held[direction.held] = true;
      result.directions.push_back(std::move(direction));
    }
  }
  result.covariance = covariance_beside(jacobian, scale, held);
  return result;
}

void Identifiability::add_direction(std::size_t k, const std::vector<std::size_t>& others,
                                    const VectorXd& change, const MatrixXd& jacobian) {
  // with k: five standard errors of k move such a number by 1.5 of its own
  constexpr double least_correlation = 0.3;
  const auto held_row = static_cast<Index>(k);
  NullDirection direction{k, {}, VectorXd::Zero(change.size())};
  std::vector<bool> held(known.size(), false);
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto row = static_cast<Index>(i);
    const double deviations = std::sqrt(covariance(row, row) * covariance(held_row, held_row));
    const bool correlated = std::abs(covariance(row, held_row)) > least_correlation * deviations;
    if (i != k && !correlated && std::ranges::find(others, i) == others.end()) continue;
    direction.change[row] = change[row];
    if (i != k) direction.others.push_back(i);
    known[i] = false;
  }
  directions.push_back(std::move(direction));
  for (const NullDirection& d : directions) held[d.held] = true;
  VectorXd scale = VectorXd::Ones(jacobian.cols());
  for (Index i = 0; i < scale.size(); ++i) scale[i] = 1.0 / std::max(jacobian.col(i).norm(), 1e-300);
  covariance = covariance_beside(jacobian, scale, held);
}

std::string null_words(const std::vector<NamedChange>& changes) {
  std::vector<std::string> keys, amounts;
  bool relative = true, shifts = true;
  for (const NamedChange& c : changes) {
    keys.push_back(c.key);
    relative = relative && c.relative;
    shifts = shifts && !c.relative && c.unit == changes.front().unit;
  }
  if (changes.size() == 1) return fmt::format("no reading changes with {}", keys.front());
  for (const NamedChange& c : changes) {
    if (relative || shifts)
      amounts.push_back(fmt::format("{:.3g}", c.change));
    else
      amounts.push_back(c.relative
                            ? fmt::format("{:.3g} %", c.change)
                            : fmt::format("{:.3g}{}{}", 0.01 * c.change, c.unit.empty() ? "" : " ", c.unit));
  }
  if (relative)
    return fmt::format("{} scale together, in the powers {}: no reading changes", list(keys), list(amounts));
  if (shifts)
    return fmt::format("{} shift together, by {}{}{}: no reading changes", list(keys), list(amounts),
                       changes.front().unit.empty() ? "" : " ", changes.front().unit);
  return fmt::format("{} move together, by {}: no reading changes", list(keys), list(amounts));
}

}  // namespace snare::identification
