#include "identification/tracing/remainder.hpp"

#include "identification/fitting/conditions.hpp"
#include "identification/fitting/statistics.hpp"
#include "identification/tracing/projection.hpp"
#include "numerics/dense_solvers.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::identification {

namespace {

constexpr std::size_t most_hats = 12;      // a leg
constexpr std::size_t readings_a_hat = 2;  // at least
constexpr double least_part = 0.05;        // of a direction, that the fitted numbers do not have

/// One leg of one condition: what its replicates have in common.
struct CommonLeg {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  std::size_t readings = 0;
  Eigen::Index first = 0;  // column
  Eigen::Index hats = 0;
};

/// Columns of hat functions over the legs of all conditions, as forces [N], the data's series one below the
/// other: two entries a row at most.
Eigen::SparseMatrix<double> hats_of(const Model& model, const Data& data) {
  std::vector<Series> fitted;
  std::vector<Eigen::Index> row_of;
  Eigen::Index rows = 0;
  for (const std::size_t k : data.series) {
    fitted.push_back(model.series()[k]);
    row_of.push_back(rows);
    rows += data.measured[k].size();
  }
  struct Place {
    std::size_t series;
    Leg leg;
    std::size_t common;
  };
  std::vector<Place> places;
  std::vector<CommonLeg> commons;
  Eigen::Index columns = 0;
  for (const std::vector<std::size_t>& group : conditions(fitted)) {
    const std::size_t first = commons.size();
    for (const std::size_t k : group) {
      const std::vector<Leg> legs = legs_of(measured_displacement(fitted[k]));
      for (std::size_t j = 0; j < legs.size(); ++j) {
        if (first + j == commons.size()) commons.emplace_back();
        CommonLeg& common = commons[first + j];
        common.low = std::min(common.low, legs[j].low);
        common.high = std::max(common.high, legs[j].high);
        common.readings = std::max(common.readings, legs[j].end - legs[j].begin);
        places.push_back({k, legs[j], first + j});
      }
    }
    for (std::size_t c = first; c < commons.size(); ++c) {
      commons[c].first = columns;
      commons[c].hats = static_cast<Eigen::Index>(
          std::clamp<std::size_t>(commons[c].readings / readings_a_hat, 1, most_hats));
      columns += commons[c].hats;
    }
  }
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * static_cast<std::size_t>(rows));
  for (const Place& place : places) {
    const CommonLeg& common = commons[place.common];
    const std::vector<double>& d = measured_displacement(fitted[place.series]);
    for (std::size_t i = place.leg.begin; i < place.leg.end; ++i) {
      const Eigen::Index row = row_of[place.series] + static_cast<Eigen::Index>(i);
      if (common.hats == 1 || !(common.high > common.low)) {
        entries.emplace_back(row, common.first, 1.0);
        continue;
      }
      const double at = std::clamp((d[i] - common.low) / (common.high - common.low), 0.0, 1.0) *
                        static_cast<double>(common.hats - 1);
      const auto j = std::min(static_cast<Eigen::Index>(at), common.hats - 2);
      const double part = at - static_cast<double>(j);
      entries.emplace_back(row, common.first + j, 1.0 - part);
      entries.emplace_back(row, common.first + j + 1, part);
    }
  }
  Eigen::SparseMatrix<double> result(rows, columns);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// Rows of one series after another.
Eigen::VectorXd rows_of(const Data& data, const std::vector<Eigen::MatrixXd>& forces) {
  Eigen::Index rows = 0;
  for (const std::size_t k : data.series) rows += data.measured[k].size();
  Eigen::VectorXd result(rows);
  Eigen::Index row = 0;
  for (const Eigen::MatrixXd& f : forces) {
    result.segment(row, f.rows()) = f;
    row += f.rows();
  }
  return result;
}

/// The part of a series in a column over all of them.
Data::Forces split(const Data& data, const Eigen::VectorXd& column) {
  return [&data, &column](std::size_t of_series) -> Eigen::MatrixXd {
    Eigen::Index row = 0;
    for (const std::size_t k : data.series) {
      if (k == of_series) return column.segment(row, data.measured[k].size());
      row += data.measured[k].size();
    }
    return {};
  };
}

/// Columns over all series, whitened. One at a time: of a million readings all together are large.
Eigen::MatrixXd whiten(const Data& data, const Eigen::SparseMatrix<double>& columns) {
  Eigen::MatrixXd result(data.rows(), columns.cols());
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    const Eigen::VectorXd column = columns.col(c);
    result.col(c) = data.whiten(split(data, column), 1);
  }
  return result;
}

/// Derivatives of the forces by the fitted numbers, not whitened.
Eigen::MatrixXd plain_jacobian(const Data& data, const Fit& fit, Eigen::Index readings) {
  Eigen::MatrixXd result(readings, fit.jacobian.cols());
  Eigen::Index row = 0;
  for (const std::size_t k : data.series) {
    const Eigen::Index n = data.measured[k].size();
    if (fit.jacobian.cols() > 0) result.middleRows(row, n) = fit.evaluation.by[k];
    row += n;
  }
  return result;
}

}  // namespace

double Remainder::inflation() const {
  constexpr double level = 0.05;
  return p < level ? std::max(1.0, ratio) : 1.0;
}

Remainder remainder(const Model& model, const Data& data, const Fit& fit) {
  Remainder result;
  if (fit.residual.size() != data.rows()) return result;
  const Eigen::SparseMatrix<double> hats = hats_of(model, data);
  Eigen::MatrixXd white = whiten(data, hats);  // scaled to columns of length one
  Eigen::VectorXd scale(white.cols());
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    scale[k] = 1.0 / std::max(white.col(k).norm(), 1e-300);
    white.col(k) *= scale[k];
  }
  // A = (1 - B B^T) W, B the basis of the Jacobian: A^T A = W^T W - (B^T W)^T (B^T W) = V S^2 V^T and U^T r =
  // S^-1 V^T A^T r. As many rows as readings are in W alone. What is asked for is well above the roundings of
  // the squares.
  const Projection fitted(fit.jacobian);
  const Eigen::MatrixXd& basis = fitted.basis();
  const Eigen::MatrixXd inside = basis.transpose() * white;
  const numerics::SymmetricEigen eigen =
      numerics::symmetric_eigen(white.transpose() * white - inside.transpose() * inside);
  const Eigen::Index n = eigen.values.size();
  Eigen::Index rank = 0;
  while (rank < n && eigen.values[n - 1 - rank] > least_part * least_part) ++rank;
  if (rank == 0) return result;
  const Eigen::MatrixXd v = eigen.vectors.rightCols(rank);
  const Eigen::VectorXd s = eigen.values.tail(rank).cwiseSqrt();
  const Eigen::VectorXd along =
      white.transpose() * fit.residual - inside.transpose() * (basis.transpose() * fit.residual);
  const Eigen::VectorXd part = s.cwiseInverse().asDiagonal() * (v.transpose() * along);
  const double q = part.squaredNorm();
  const auto d = static_cast<double>(rank);
  result.directions = d;
  result.ratio = q / d;
  result.p = fisher_tail(result.ratio, d, data.noise.dof);
  if (!(q > 0.0)) return result;
  // The function: values of the hats, and the fitted numbers c moved along so that it has nothing in their
  // directions.
  const Eigen::VectorXd values = v * s.cwiseInverse().asDiagonal() * part;
  Eigen::VectorXd function = hats * (scale.asDiagonal() * values);
  if (fit.jacobian.cols() > 0) {
    function -=
        plain_jacobian(data, fit, hats.rows()) * numerics::least_squares(fit.jacobian, white * values);
  }
  if (!data.placings.empty()) function = rows_of(data, data.placed(split(data, function), 1));
  const double size = std::sqrt(function.squaredNorm() / static_cast<double>(function.size()));
  result.rmse = size * std::sqrt(std::max(0.0, q - d) / q);
  result.upper = size * std::sqrt(noncentrality_upper(result.ratio, d, data.noise.dof, 0.95) / q);
  return result;
}

}  // namespace snare::identification
