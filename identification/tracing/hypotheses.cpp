#include "identification/tracing/hypotheses.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/fitting/serial_noise.hpp"
#include "identification/tracing/projection.hpp"
#include "numerics/dense_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace snare::identification {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Shares of the prior.                                                                   theory.md (I.37)
constexpr double of_nothing = 0.2, of_catalogue = 0.45, of_outside = 0.25, of_other = 0.1;
constexpr double of_one_more = 0.1;  // of a second cause beside the first
// Ln of the least size of a cause, in standard deviations of a reading
const double least_size = std::log(0.3);

double log_sum(const std::vector<double>& logs) {
  const double largest = *std::ranges::max_element(logs);
  double sum = 0.0;
  for (const double l : logs) sum += std::exp(l - largest);
  return largest + std::log(sum);
}

/// Correlation of the noise within a series, and the share of the prior that it has.
struct Correlation {
  double smooth = 0.0, length = 1.0;
  double prior = 1.0;
};

std::vector<Correlation> correlations(const Data& data) {
  std::vector<Correlation> all{{}};
  if (!data.noise.filter.empty() || !data.placings.empty())
    return all;  // what is known of it is in the whitening
  constexpr double independent = 0.5;
  all.front().prior = independent;
  const auto smooth = {0.3, 0.6, 0.9};
  const auto length = {1.0, 3.0, 9.0};
  const double each = (1.0 - independent) / static_cast<double>(smooth.size() * length.size());
  for (const double s : smooth)
    for (const double l : length) all.push_back({s, l, each});
  return all;
}

/// Deviation of the flat prior of a coordinate: its range over the square root of 12.
double flat_deviation(const Model& model, const Setting& setting) {
  constexpr double widest = 20.0;  // of a logarithm
  const Parameter& p = *setting.parameter;
  double lower = model.lower(p), upper = model.upper(p);
  const bool logarithm = p.parametrisation != Parametrisation::shift;
  if (logarithm || !std::isfinite(upper - lower)) {
    lower = std::max(lower, -0.5 * widest);
    upper = std::min(upper, 0.5 * widest);
  }
  return std::max(upper - lower, 1e-300) / std::sqrt(12.0);
}

/// Marginal likelihoods of the readings.
class Evidence {
 public:
  Evidence(const Model& model, const Data& data, const Fit& base)
      : model_(model),
        data_(data),
        declared_(data.noise.source == "declared"),
        correlations_(correlations(data)),
        base_(base),
        left_(static_cast<double>(data.rows()) - static_cast<double>(base.free)),
        most_(std::log(std::max(1.0, 0.1 * largest_force() / data.noise.mean_sigma(model.series())))) {}

  /// ln of it for a model, alone.
  [[nodiscard]] double of(const Fit& fit) const {
    std::vector<double> logs;
    const MatrixXd jacobian = scaled(fit);
    for (const Correlation& c : correlations_) {
      const White w = whitened(c, fit.residual, jacobian, MatrixXd(data_.rows(), 0));
      logs.push_back(std::log(c.prior) + likelihood(w.squares, w.logarithm));
    }
    return log_sum(logs);
  }

  /// ln of it for a model and an unknown function, its length and its size marginalised.
  [[nodiscard]] double of(const Fit& fit, const Discrepancy& function) const {
    std::vector<double> logs;
    const MatrixXd jacobian = scaled(fit);
    for (const Correlation& c : correlations_) {
      for (const MatrixXd& columns : function.columns) {
        const double prior = c.prior / static_cast<double>(function.columns.size());
        logs.push_back(std::log(prior) + over_sizes(whitened(c, fit.residual, jacobian, columns)));
      }
    }
    return log_sum(logs);
  }

 private:
  /// Residual and columns of a function, whitened, without what the fitted numbers can do.
  struct White {
    double squares = 0.0;    // of the residual
    double logarithm = 0.0;  // of the determinants of the noise and of the fitted numbers
    MatrixXd normal;         // columns^T columns
    VectorXd along;          // columns^T residual
  };

  [[nodiscard]] double largest_force() const {
    double largest = 0.0;
    for (const std::size_t k : data_.series)
      largest = std::max(largest, data_.measured[k].cwiseAbs().maxCoeff());
    return largest;
  }

  /// ln of the likelihood: -S/2 - ln det / 2, or, with the size of the noise marginalised, -(n - p)/2 ln S in
  /// place of the first.
  [[nodiscard]] double likelihood(double squares, double logarithm) const {
    const double s = std::max(squares, 1e-300);
    return declared_ ? -0.5 * (s + logarithm) : -0.5 * (left_ * std::log(s) + logarithm);
  }

  /// The derivatives times the deviations of normal priors that have, where the fit ended, the density of the
  /// numbers' own priors: flat; of the first number of an effect flat in the logarithm of its size, the norm
  /// of the change of the whitened readings that no number of the base model can make. With s that size, dF
  /// the derivative: 2 s ln(largest/least) / (sqrt(2 pi) |dF|).
  [[nodiscard]] MatrixXd scaled(const Fit& fit) const {
    MatrixXd jacobian = fit.jacobian;
    const auto base = static_cast<Index>(base_.free);
    double effects = 0.0;
    for (Index k = base; k < jacobian.cols(); ++k) effects += is_size(fit, k) ? 1.0 : 0.0;
    const double size = std::sqrt(std::max(1.0, (base_.chi2 - fit.chi2) / std::max(1.0, effects)));
    const Projection others(jacobian.leftCols(base));
    for (Index k = 0; k < jacobian.cols(); ++k) {
      const double own = k < base || !is_size(fit, k) ? 0.0 : others.without(jacobian.col(k)).norm();
      jacobian.col(k) *= own > 0.0
                             ? 2.0 * size * (most_ - least_size) / (std::sqrt(2.0 * std::numbers::pi) * own)
                             : flat_deviation(model_, fit.settings[static_cast<std::size_t>(k)]);
    }
    return jacobian;
  }

  /// Whether a number is the first one of an effect.
  [[nodiscard]] static bool is_size(const Fit& fit, Index k) {
    const std::string& key = fit.settings[static_cast<std::size_t>(k)].parameter->key;
    return std::ranges::any_of(catalogue(),
                               [&](const Effect& e) { return e.numbers.front().parameter.key == key; });
  }

  [[nodiscard]] White whitened(const Correlation& c, const VectorXd& residual, const MatrixXd& jacobian,
                               const MatrixXd& columns) const {
    const Index numbers = jacobian.cols();
    MatrixXd all(residual.size(), 1 + numbers + columns.cols());
    all << residual, jacobian, columns;
    White w;
    if (c.smooth > 0.0) {
      Index row = 0;
      for (const std::size_t k : data_.series) {
        const Index n = data_.rows_of(k);
        const WhitenedRows rows =
            without_correlation(model_.series()[k], c.smooth, c.length, all.middleRows(row, n));
        all.middleRows(row, n) = rows.rows;
        w.logarithm += rows.log_determinant;
        row += n;
      }
    }
    MatrixXd rest(all.rows(), 1 + columns.cols());
    rest << all.col(0), all.rightCols(columns.cols());
    if (numbers > 0) {
      const numerics::ThinSvd svd = numerics::thin_svd(all.middleCols(1, numbers));
      w.logarithm += (1.0 + svd.s.array().square()).log().sum();
      // Directions that the prior holds tighter than the readings do not take anything away.
      const VectorXd share = (svd.s.array().square() / (1.0 + svd.s.array().square())).matrix();
      rest -= svd.U * (share.asDiagonal() * (svd.U.transpose() * rest));
    }
    const auto functions = rest.rightCols(columns.cols());
    w.squares = rest.col(0).squaredNorm();
    w.normal = functions.transpose() * functions;
    w.along = functions.transpose() * rest.col(0);
    return w;
  }

  /// Over sizes of the function from 0.3 standard deviations of a reading to a tenth of the largest force.
  [[nodiscard]] double over_sizes(const White& w) const {
    constexpr int sizes = 13;
    const numerics::SymmetricEigen e = numerics::symmetric_eigen(w.normal);
    const Eigen::ArrayXd along = (e.vectors.transpose() * w.along).array().square();
    const Eigen::ArrayXd values = e.values.cwiseMax(0.0).array();
    std::vector<double> logs;
    for (int i = 0; i < sizes; ++i) {
      const double square = std::exp(2.0 * (least_size + (most_ - least_size) * i / (sizes - 1)));
      const Eigen::ArrayXd grown = 1.0 + square * values;
      const double explained = (square * along / grown).sum();
      logs.push_back(likelihood(w.squares - explained, w.logarithm + grown.log().sum()));
    }
    return log_sum(logs) - std::log(static_cast<double>(sizes));
  }

  const Model& model_;
  const Data& data_;
  bool declared_;
  std::vector<Correlation> correlations_;
  const Fit& base_;
  double left_;  // readings less numbers of the base model
  double most_;  // ln of the largest size of a function
};

/// Share of the catalogue's prior: the same for each channel, and in it for each effect.
double share_of(const std::string& effect) {
  std::map<Channel, double> members;
  for (const Effect& e : catalogue()) members[e.channel] += 1.0;
  const Effect* own = find_effect(effect);
  return own == nullptr ? 0.0 : 1.0 / (static_cast<double>(members.size()) * members.at(own->channel));
}

double prior_of(const std::vector<std::string>& effects) {
  if (effects.empty()) return of_nothing;
  double prior = of_catalogue;
  for (std::size_t k = 0; k < effects.size(); ++k)
    prior *= share_of(effects[k]) * (k > 0 ? of_one_more * static_cast<double>(k + 1) : 1.0);
  return prior;
}

/// Prior of one function added to the base model.
double prior_of(const std::string& variable, const std::vector<Discrepancy>& all) {
  std::map<std::string, double> variables;
  for (const Discrepancy& d : all) variables[d.variable] += 1.0;
  if (variable == "other") return variables.size() == 1 ? of_outside + of_other : of_other;
  return of_outside / static_cast<double>(variables.size() - 1) / variables.at(variable);
}

/// Hypotheses of one model: alone and with every function, those of a variable together.
void add_with_functions(const Model& model, const Data& data, const Evidence& evidence,
                        const FittedModel& one, std::vector<CauseHypothesis>& all) {
  Fit fit = one.fit;
  if (fit.evaluation.force.empty()) fit.evaluation = model.evaluate(fit.settings, fit.parameters());
  if (!fit.evaluation.complete) return;
  const double beside = one.effects.empty() ? 1.0 : of_one_more * prior_of(one.effects);
  const std::vector<Discrepancy> functions = discrepancies(model, data, fit);
  std::map<std::string, std::vector<double>> by_variable;
  for (const Discrepancy& d : functions)
    by_variable[d.variable].push_back(std::log(beside * prior_of(d.variable, functions)) +
                                      evidence.of(fit, d));
  for (const auto& [variable, logs] : by_variable) all.push_back({one.effects, variable, log_sum(logs), 0.0});
}

}  // namespace

std::vector<CauseHypothesis> weigh_hypotheses(const Model& model, const Data& data,
                                              const std::vector<FittedModel>& models) {
  if (models.empty() || data.published() || !data.noise.published.empty()) return {};
  const Evidence evidence(model, data, models.front().fit);
  std::vector<CauseHypothesis> all;
  for (const FittedModel& m : models)
    all.push_back({m.effects, "", std::log(prior_of(m.effects)) + evidence.of(m.fit), 0.0});
  std::vector<std::size_t> order(models.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t k) { return all[k].log_evidence; });
  constexpr std::size_t most = 3;  // models with effects to which functions are added
  std::size_t taken = 0;
  for (const std::size_t k : order) {
    if (models[k].effects.empty() || taken++ < most)
      add_with_functions(model, data, evidence, models[k], all);
  }
  std::vector<double> logs;
  for (const CauseHypothesis& h : all) logs.push_back(h.log_evidence);
  const double sum = log_sum(logs);
  for (CauseHypothesis& h : all) h.probability = std::exp(h.log_evidence - sum);
  std::ranges::stable_sort(all, std::greater<>(), &CauseHypothesis::log_evidence);
  return all;
}

OutsideCause outside_cause(const std::vector<CauseHypothesis>& hypotheses) {
  std::map<std::string, double> by_variable;
  OutsideCause cause;
  for (const CauseHypothesis& h : hypotheses) {
    if (!h.effects.empty() || h.discrepancy.empty()) continue;
    by_variable[h.discrepancy] += h.probability;
    cause.probability += h.probability;
  }
  double most = 0.0;
  for (const auto& [variable, probability] : by_variable) {
    if (probability <= most) continue;
    most = probability;
    cause.variable = variable;
  }
  return cause;
}

}  // namespace snare::identification
