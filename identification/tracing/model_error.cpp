#include "identification/tracing/model_error.hpp"

#include "identification/fitting/statistics.hpp"
#include "identification/tracing/projection.hpp"
#include "numerics/dense_solvers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

namespace snare::identification {

namespace {

/// A fitted number without an interval.
FittedNumber number_of(const Model& model, const Setting& s) {
  const Parameter& p = *s.parameter;
  FittedNumber n;
  n.key = p.key;
  n.unit = p.unit;
  n.declared = p.shown(model.declared(p), 0.0);
  if (p.parametrisation == Parametrisation::magnitude) n.declared = std::numeric_limits<double>::infinity();
  n.value = model.shown(s);
  n.bound = at_bound(s.coordinate, model.lower(p), model.upper(p));
  return n;
}

/// Its standard error and 95 % either way, by Student's t of the noise's degrees of freedom, as far as that
/// is admissible.
void give_interval(const Model& model, const Setting& s, double deviation, double noise_dof,
                   FittedNumber& n) {
  const Parameter& p = *s.parameter;
  const double reach = student_quantile(0.025, noise_dof) * deviation;
  const double lower = s.coordinate - reach, upper = s.coordinate + reach;
  if (n.bound != AtBound::lower && lower >= model.lower(p)) n.lower = model.shown({&p, lower});
  if (n.bound != AtBound::upper && upper <= model.upper(p)) n.upper = model.shown({&p, upper});
  if (n.bound == AtBound::none && !n.lower && !n.upper) return;
  // A shift's coordinate is the value itself, a ratio's or a magnitude's its logarithm.
  n.standard_error =
      p.parametrisation == Parametrisation::shift ? deviation / p.unit_size : std::abs(n.value) * deviation;
}

double deviation_of(const Fit& fit, std::size_t k) {
  const auto i = static_cast<Eigen::Index>(k);
  return std::sqrt(std::max(0.0, fit.covariance(i, i)));
}

}  // namespace

std::vector<FittedNumber> numbers_of(const Model& model, const Fit& fit) {
  std::vector<FittedNumber> result;
  for (std::size_t k = 0; k < fit.free; ++k) {
    FittedNumber n = number_of(model, fit.settings[k]);
    const auto i = static_cast<Eigen::Index>(k);
    n.identified = fit.rank.is_known(k) && fit.covariance.rows() > i && fit.jacobian.col(i).norm() > 0.0;
    if (n.identified) give_interval(model, fit.settings[k], deviation_of(fit, k), fit.noise_dof, n);
    result.push_back(n);
  }
  for (std::size_t k = 0; k < result.size(); ++k) {
    if (!result[k].standard_error) continue;
    for (std::size_t j = 0; j < result.size(); ++j) {
      const auto a = static_cast<Eigen::Index>(k), b = static_cast<Eigen::Index>(j);
      const double scale = std::sqrt(fit.covariance(a, a) * fit.covariance(b, b));
      const bool known = result[j].standard_error && scale > 0.0;
      // A negative ratio falls where its coordinate, a logarithm, grows.
      const auto falls = [&](std::size_t i) {
        return fit.settings[i].parameter->parametrisation != Parametrisation::shift && result[i].value < 0.0;
      };
      const double sign = falls(k) == falls(j) ? 1.0 : -1.0;
      result[k].correlation.push_back(j == k ? 1.0 : known ? sign * fit.covariance(a, b) / scale : 0.0);
    }
  }
  return result;
}

std::vector<OpenDirection> open_directions(const Model& model, const Fit& fit) {
  std::vector<OpenDirection> open;
  for (const NullDirection& direction : fit.rank.directions) {
    OpenDirection one;
    one.held = model.shown(fit.settings[direction.held]);
    std::vector<std::size_t> numbers{direction.held};
    numbers.insert(numbers.end(), direction.others.begin(), direction.others.end());
    double largest = 0.0;  // power; what shifts is counted to 1 % of what scales
    for (const std::size_t k : numbers) {
      const Parameter& p = *fit.settings[k].parameter;
      const bool relative = p.parametrisation != Parametrisation::shift;
      const double change = direction.change[static_cast<Eigen::Index>(k)];
      one.changes.push_back({p.key, p.unit, relative ? change : change / p.unit_size, relative});
      if (relative) largest = std::max(largest, std::abs(change));
      if (k == direction.held) continue;
      one.known.push_back(number_of(model, fit.settings[k]));
      give_interval(model, fit.settings[k], deviation_of(fit, k), fit.noise_dof, one.known.back());
    }
    const double unit = largest > 0.0 ? largest : std::abs(one.changes.front().change);
    for (NamedChange& c : one.changes) c.change /= unit;
    open.push_back(std::move(one));
  }
  return open;
}

std::vector<Finding> number_findings(const Model& model, const Fit& fit) {
  std::vector<Finding> findings;
  for (const OpenDirection& open : open_directions(model, fit)) {
    Finding f{.kind = FindingKind::not_identifiable, .key = open.changes.front().key, .sure = true};
    f.what = fmt::format("{}; {} left open", null_words(open.changes),
                         open.changes.size() > 1 ? "their values are" : "its value is");
    findings.push_back(std::move(f));
  }
  for (const FittedNumber& n : numbers_of(model, fit)) {
    if (n.bound == AtBound::none) {
      if (!n.identified || n.standard_error) continue;
      Finding f{.kind = FindingKind::not_identifiable, .key = n.key, .unit = n.unit, .value = n.value};
      f.what = fmt::format("{} is left open: every admissible value is within its 95 % interval", n.key);
      findings.push_back(std::move(f));
      continue;
    }
    const bool lower = n.bound == AtBound::lower;
    Finding f{
        .kind = FindingKind::on_bound, .key = n.key, .unit = n.unit, .value = n.value, .limit = n.value};
    f.what = fmt::format("{} = {:.4g}{}{} stands on its {} bound: the readings ask for {} than is admissible",
                         n.key, n.value, n.unit.empty() ? "" : " ", n.unit, lower ? "lower" : "upper",
                         lower ? "less" : "more");
    findings.push_back(std::move(f));
  }
  return findings;
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
  error.open = open_directions(model, fit);
  return error;
}

double fitted_rmse(const Data& data, const Evaluation& evaluation) {
  double squares = 0.0;
  double count = 0.0;
  for (const Eigen::MatrixXd& left :
       data.placed([&](std::size_t k) { return data.measured[k] - evaluation.force[k]; }, 1)) {
    squares += left.squaredNorm();
    count += static_cast<double>(left.rows());
  }
  return std::sqrt(squares / std::max(1.0, count));
}

namespace {

/// Rows of the data by a key of their series.
std::map<double, std::vector<Eigen::Index>> rows_by(const Model& model, const Data& data,
                                                    const std::function<double(const Series&)>& key) {
  std::map<double, std::vector<Eigen::Index>> groups;
  Eigen::Index row = 0;
  for (const std::size_t k : data.series) {
    std::vector<Eigen::Index>& rows = groups[key(model.series()[k])];
    for (Eigen::Index i = 0; i < data.rows_of(k); ++i) rows.push_back(row++);
  }
  return groups;
}

/// Rows by the leg of the path, as far as all series have it; with one leg those of the last third of the
/// travel.
std::vector<std::vector<Eigen::Index>> rows_of_legs(const Model& model, const Data& data) {
  std::vector<std::vector<Eigen::Index>> legs;
  std::vector<Eigen::Index> last;
  Eigen::Index row = 0;
  for (const std::size_t k : data.series) {
    const std::vector<double>& d = measured_displacement(model.series()[k]);
    if (data.noise.summarised(k)) {
      if (legs.empty()) legs.emplace_back();
      for (Eigen::Index i = 0; i < data.rows_of(k); ++i) legs.front().push_back(row + i);
      row += data.rows_of(k);
      continue;
    }
    const std::vector<Leg> own = legs_of(d);
    for (std::size_t j = 0; j < own.size(); ++j) {
      if (j == legs.size()) legs.emplace_back();
      for (std::size_t i = own[j].begin; i < own[j].end; ++i) {
        legs[j].push_back(row + static_cast<Eigen::Index>(i));
        if (d[i] > own[j].low + 2.0 / 3.0 * (own[j].high - own[j].low))
          last.push_back(row + static_cast<Eigen::Index>(i));
      }
    }
    row += data.measured[k].size();
  }
  if (legs.size() > 1) return legs;
  return {last};
}

/// What a fit leaves, and its derivatives.
struct Left {
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
};

// As forces.
Left in_forces(const Data& data, const Fit& fit) {
  Left forces{Eigen::VectorXd(data.rows()), Eigen::MatrixXd(data.rows(), fit.jacobian.cols())};
  const auto left = data.placed([&](std::size_t k) { return data.measured[k] - fit.evaluation.force[k]; }, 1);
  const auto by = fit.jacobian.cols() > 0
                      ? data.placed([&](std::size_t k) { return fit.evaluation.by[k]; }, fit.jacobian.cols())
                      : std::vector<Eigen::MatrixXd>();
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < data.series.size(); ++i) {
    const std::size_t k = data.series[i];
    const Eigen::Index n = data.rows_of(k);
    // Of a published fit its four numbers, times the scatter.
    const auto seen = [&](const Eigen::MatrixXd& forces_of_it) -> Eigen::MatrixXd {
      return data.noise.summarised(k) ? data.noise.sigma[k] * data.noise.whiten(k, forces_of_it)
                                      : forces_of_it;
    };
    forces.residual.segment(row, n) = seen(left[i]);
    if (!by.empty()) forces.jacobian.middleRows(row, n) = seen(by[i]);
    row += n;
    if (!data.noise.summarised(k)) continue;
    forces.residual[row - 1] = data.noise.sigma[k] * fit.residual[row - 1];
    forces.jacobian.row(row - 1) = data.noise.sigma[k] * fit.jacobian.row(row - 1);
  }
  return forces;
}

}  // namespace

LeftOut left_out_conditions(const Model& model, const Data& data) {
  LeftOut result;
  const auto position = [](const Series& s) { return s.test.contact_position / s.test.mount.span; };
  const auto slack = [](const Series& s) { return s.test.wire.length - s.test.mount.span; };
  for (const auto& groups : {rows_by(model, data, position), rows_by(model, data, slack)}) {
    if (groups.size() < 2) continue;
    for (const auto& [value, rows] : groups) result.rows.push_back(rows);
  }
  result.several = !result.rows.empty();
  if (!result.several) result.rows = rows_of_legs(model, data);
  return result;
}

namespace {

/// Squares of what a fit to the others leaves in every condition that is left out, and how many there are.
/// left: by the fit to all; by: its derivatives; both whitened, or of forces.                 theory.md (I.5)
struct Squares {
  double sum = 0.0;
  double count = 0.0;
};

Squares left_out(const Model& model, const Data& data, const Fit& fit, const Left& all) {
  // share of what all readings tell of a direction, below which the others do not predict it
  constexpr double least_told = 0.01;
  const Eigen::MatrixXd directions = unit_directions(fit.jacobian);
  Squares squares;
  for (const std::vector<Eigen::Index>& out : left_out_conditions(model, data).rows) {
    std::vector<bool> goes(static_cast<std::size_t>(data.rows()), false);
    for (const Eigen::Index i : out) goes[static_cast<std::size_t>(i)] = true;
    std::vector<Eigen::Index> in;
    for (Eigen::Index i = 0; i < data.rows(); ++i) {
      if (!goes[static_cast<std::size_t>(i)]) in.push_back(i);
    }
    if (in.empty() || out.empty()) continue;
    Eigen::VectorXd left = all.residual(out);
    if (fit.free > 0) {
      // Without these readings the numbers move by (J^T J)^-1 J^T r of the rows that stay, but for directions
      // that only the readings left out can tell (the zero of a series, a yield stress that nothing else
      // reaches).
      const Eigen::MatrixXd rest = fit.jacobian(in, Eigen::all) * directions;
      const Eigen::MatrixXd columns = all.jacobian(out, Eigen::all) * directions;
      const numerics::SymmetricEigen told = numerics::symmetric_eigen(rest.transpose() * rest);
      const Eigen::VectorXd score =
          told.vectors.transpose() * (rest.transpose() * Eigen::VectorXd(fit.residual(in)));
      const Eigen::Index own = (told.values.array() < least_told).count();
      const Eigen::Index others = score.size() - own;
      left -= columns *
              (told.vectors.rightCols(others) * score.tail(others).cwiseQuotient(told.values.tail(others)));
      if (own > 0) left = Projection(columns * told.vectors.leftCols(own)).without(left);
    }
    squares.sum += left.squaredNorm();
    squares.count += static_cast<double>(left.size());
  }
  return squares;
}

}  // namespace

double left_out_rmse(const Model& model, const Data& data, const Fit& fit) {
  const Squares squares = left_out(model, data, fit, in_forces(data, fit));
  return squares.count > 0.0 ? std::sqrt(squares.sum / squares.count) : 0.0;
}

double left_out_excess(const Model& model, const Data& data, const Fit& fit) {
  const Squares squares = left_out(model, data, fit, {fit.residual, fit.jacobian});
  return squares.sum - squares.count;
}

std::vector<Prediction> forces_only(const std::vector<Prediction>& predictions) {
  std::vector<Prediction> result;
  for (const Prediction& p : predictions) {
    result.emplace_back();
    result.back().force = p.force;
    result.back().reading = p.reading;
    result.back().before_touch = p.before_touch;
  }
  return result;
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
