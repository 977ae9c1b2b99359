#include "identification/tracing/model_error.hpp"

#include "identification/tracing/projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::identification {

std::vector<FittedNumber> numbers_of(const Model& model, const Fit& fit) {
  std::vector<FittedNumber> result;
  for (std::size_t k = 0; k < fit.free; ++k) {
    const Setting& s = fit.settings[k];
    const Parameter& p = *s.parameter;
    FittedNumber n;
    n.key = p.key;
    n.unit = p.unit;
    n.declared = p.shown(model.declared(p), 0.0);
    if (p.parametrisation == Parametrisation::magnitude) n.declared = std::numeric_limits<double>::infinity();
    n.value = model.shown(s);
    const auto i = static_cast<Eigen::Index>(k);
    if (fit.covariance.rows() > i && fit.jacobian.col(i).norm() > 0.0) {
      const double deviation = std::sqrt(std::max(0.0, fit.covariance(i, i)));
      // A shift's coordinate is the value itself, a ratio's or a magnitude's its logarithm.
      n.standard_error =
          p.parametrisation == Parametrisation::shift ? deviation / p.unit_size : std::abs(n.value) * deviation;
      n.lower = model.shown({&p, s.coordinate - 1.96 * deviation});
      n.upper = model.shown({&p, s.coordinate + 1.96 * deviation});
    }
    result.push_back(n);
  }
  return result;
}

ModelError model_error(const std::vector<Series>& all, const std::vector<bool>& heldout,
                       const std::vector<Prediction>& predictions, const Model& model, const Fit& fit) {
  ModelError error;
  double squares = 0.0;
  double count = 0.0;
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::vector<double>& measured = all[k].readings->force;
    const Misfit m = misfit(measured, predictions[k].force);
    error.series_rmse.push_back(m.rmse);
    if (heldout[k]) continue;
    const auto n = static_cast<double>(std::min(measured.size(), predictions[k].force.size()));
    squares += n * m.rmse * m.rmse;
    count += n;
    low = std::min(low, *std::min_element(measured.begin(), measured.end()));
    high = std::max(high, *std::max_element(measured.begin(), measured.end()));
  }
  error.rmse = count > 0.0 ? std::sqrt(squares / count) : 0.0;
  error.nrmse = error.rmse / (high - low);
  error.chi2_dof = fit.chi2 / std::max(1.0, fit.dof());
  error.numbers = numbers_of(model, fit);
  return error;
}

double fitted_rmse(const Data& data, const Evaluation& evaluation) {
  double squares = 0.0;
  for (const std::size_t k : data.series) squares += (data.measured[k] - evaluation.force[k]).squaredNorm();
  return std::sqrt(squares / static_cast<double>(data.rows()));
}

double left_out_rmse(const Model& model, const Data& data, const Fit& fit) {
  double squares = 0.0;
  Eigen::Index row = 0;
  for (const std::size_t k : data.series) {
    const Eigen::Index n = data.measured[k].size();
    Eigen::MatrixXd rest(fit.jacobian.rows() - n, fit.jacobian.cols());
    rest << fit.jacobian.topRows(row), fit.jacobian.bottomRows(fit.jacobian.rows() - row - n);
    Eigen::VectorXd r(rest.rows());
    r << fit.residual.head(row), fit.residual.tail(fit.residual.size() - row - n);
    // Without series k the numbers move by (J^T J)^-1 J^T r of the rows that stay.
    const Eigen::VectorXd step = covariance_of(rest) * (rest.transpose() * r);
    Eigen::VectorXd left = fit.residual.segment(row, n) - fit.jacobian.middleRows(row, n) * step;
    // Numbers of this series alone (its zero) only it can tell.
    std::vector<Eigen::Index> own;
    for (std::size_t j = 0; j < fit.free; ++j) {
      if (fit.settings[j].parameter->only == model.series()[k].name) own.push_back(static_cast<Eigen::Index>(j));
    }
    if (!own.empty()) left = Projection(fit.jacobian(Eigen::all, own).middleRows(row, n)).without(left);
    squares += left.squaredNorm() * data.noise.sigma[k] * data.noise.sigma[k];
    row += n;
  }
  return std::sqrt(squares / static_cast<double>(data.rows()));
}

Eigen::VectorXd forces_of(const Series& series) {
  const std::vector<double>& f = series.readings->force;
  return Eigen::Map<const Eigen::VectorXd>(f.data(), static_cast<Eigen::Index>(f.size()));
}

HeldOut::HeldOut(const std::vector<Series>& series, const SolverSettings& solver) {
  for (const Series& s : series) measured_.push_back(forces_of(s));
  if (!series.empty()) model_.emplace(series, solver);
}

std::optional<double> HeldOut::rmse(const std::vector<Setting>& settings) const {
  if (!model_) return std::nullopt;
  const Evaluation at = model_->evaluate(settings);
  if (!at.complete) return std::nullopt;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < measured_.size(); ++k) {
    squares += (measured_[k] - at.force[k]).squaredNorm();
    count += static_cast<double>(measured_[k].size());
  }
  return std::sqrt(squares / count);
}

}  // namespace snare::identification
