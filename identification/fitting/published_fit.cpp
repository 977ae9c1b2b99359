#include "identification/fitting/published_fit.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace snare::identification {

namespace {

using Eigen::Index;
using Point = PublishedDeviance::Point;

std::vector<PublishedSeries> published_of(const Model& model, const std::vector<std::size_t>& series) {
  std::vector<PublishedSeries> result = published_series(model.series());
  std::erase_if(result,
                [&](const PublishedSeries& s) { return std::ranges::find(series, s.index) == series.end(); });
  return result;
}

/// A model with some of its numbers fitted to published fits.
class PublishedModel {
 public:
  PublishedModel(const Model& model, std::vector<PublishedSeries> series,
                 const std::vector<Setting>& settings, std::size_t free, PublishedScatter scatter)
      : model_(model), series_(std::move(series)), settings_(settings), free_(free), scatter_(scatter) {
    for (std::size_t k = 0; k < free_; ++k) by_.push_back(settings_[k].parameter);
  }

  /// Maximises the likelihood; whether the model could be computed.
  [[nodiscard]] bool fit();
  /// With the steps that no bound of a number forbids.
  [[nodiscard]] PublishedDeviance deviance() const;
  [[nodiscard]] Point best() const;
  [[nodiscard]] const std::vector<Setting>& settings() const { return settings_; }
  [[nodiscard]] const Evaluation& evaluation() const { return evaluation_; }

 private:
  [[nodiscard]] PublishedDeviance linear(const Evaluation& evaluation,
                                         const std::vector<Index>& columns) const;
  [[nodiscard]] std::vector<Index> all_columns() const;
  [[nodiscard]] bool on_bound(std::size_t k) const;
  [[nodiscard]] std::vector<Setting> moved(const Eigen::VectorXd& step, double share) const;
  /// Best standard deviations with the numbers held.
  [[nodiscard]] Point held(const Evaluation& evaluation, const Point& start) const;

  const Model& model_;
  std::vector<PublishedSeries> series_;
  std::vector<Setting> settings_;
  std::size_t free_;
  PublishedScatter scatter_;
  std::vector<const Parameter*> by_;
  Evaluation evaluation_;
  Point at_;  // no steps
};

PublishedDeviance PublishedModel::linear(const Evaluation& evaluation,
                                         const std::vector<Index>& columns) const {
  std::vector<LinearCurve> curves;
  for (const PublishedSeries& s : series_) {
    const Eigen::VectorXd& force = evaluation.force[s.index];
    Eigen::MatrixXd by(force.size(), static_cast<Index>(columns.size()));
    for (Index j = 0; j < by.cols(); ++j)
      by.col(j) = evaluation.by[s.index].col(columns[static_cast<std::size_t>(j)]);
    curves.push_back(linear_curve(s, force, by));
  }
  return {series_, std::move(curves), scatter_};
}

std::vector<Index> PublishedModel::all_columns() const {
  std::vector<Index> columns;
  for (std::size_t k = 0; k < free_; ++k) columns.push_back(static_cast<Index>(k));
  return columns;
}

bool PublishedModel::on_bound(std::size_t k) const {
  const Setting& s = settings_[k];
  const double lower = model_.lower(*s.parameter);
  const double upper = model_.upper(*s.parameter);
  return s.coordinate <= lower || s.coordinate >= upper;
}

std::vector<Setting> PublishedModel::moved(const Eigen::VectorXd& step, double share) const {
  std::vector<Setting> settings = settings_;
  for (std::size_t k = 0; k < free_; ++k) {
    Setting& s = settings[k];
    s.coordinate = std::clamp(s.coordinate + share * step[static_cast<Index>(k)], model_.lower(*s.parameter),
                              model_.upper(*s.parameter));
  }
  return settings;
}

Point PublishedModel::held(const Evaluation& evaluation, const Point& start) const {
  Point from = start;
  from.step.resize(0);
  return linear(evaluation, {}).minimise(from);
}

PublishedDeviance PublishedModel::deviance() const {
  std::vector<Index> columns = all_columns();
  std::erase_if(columns, [this](Index k) { return on_bound(static_cast<std::size_t>(k)); });
  return linear(evaluation_, columns);
}

Point PublishedModel::best() const {
  Point point = at_;
  point.step = Eigen::VectorXd::Zero(deviance().steps());
  return point;
}

// Gauss-Newton steps: the curves are linear about the current numbers, the likelihood is exact. A step that
// does not lower the deviance is halved.
bool PublishedModel::fit() {
  constexpr int most_iterations = 30;
  constexpr int most_halvings = 8;
  constexpr double enough = 1e-4;  // of the deviance
  evaluation_ = model_.evaluate(settings_, by_);
  if (!evaluation_.complete) return false;
  if (by_.empty()) evaluation_.by.assign(evaluation_.force.size(), {});
  at_ = held(evaluation_, linear(evaluation_, {}).start());
  for (int k = 0; k < most_iterations && free_ > 0; ++k) {
    Point from = at_;
    from.step = Eigen::VectorXd::Zero(static_cast<Index>(free_));
    const Point wanted = linear(evaluation_, all_columns()).minimise(from);
    if (at_.deviance - wanted.deviance < enough) break;
    double gain = 0.0;
    double share = 1.0;
    for (int halving = 0; halving < most_halvings && !(gain > 0.0); ++halving, share *= 0.5) {
      const std::vector<Setting> next = moved(wanted.step, share);
      Evaluation there = model_.evaluate(next, by_);
      if (!there.complete) continue;
      const Point point = held(there, wanted);
      gain = at_.deviance - point.deviance;
      if (!(gain > 0.0)) continue;
      settings_ = next;
      evaluation_ = std::move(there);
      at_ = point;
    }
    if (gain < enough) break;
  }
  return true;
}

/// (X^T X)^-1 of A, B, C and the projection of forces on them, as (A, B, C) = M Q^T F.
Eigen::Matrix3d coefficients_of_basis(const PublishedSeries& series, const std::vector<double>& travel) {
  Eigen::Matrix3d in_basis;  // Q^T of d^2, d, 1
  const auto n = static_cast<Index>(travel.size());
  const Eigen::Map<const Eigen::VectorXd> d(travel.data(), n);
  in_basis.col(0) = series.basis * d.cwiseAbs2();
  in_basis.col(1) = series.basis * d;
  in_basis.col(2) = series.basis * Eigen::VectorXd::Ones(n);
  return in_basis.inverse();
}

FitComparison compare(const PublishedSeries& one, const Series& series, const Eigen::VectorXd& force,
                      double sigma) {
  FitComparison c;
  const Eigen::Matrix3d to_abc = coefficients_of_basis(one, measured_displacement(series));
  const Eigen::Vector3d fitted = one.basis * force;
  const Eigen::Vector3d computed = to_abc * fitted;
  const Eigen::Matrix3d covariance = sigma * sigma * to_abc * to_abc.transpose();
  c.published = {series.law->a, series.law->b, series.law->c};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Index>(k);
    c.computed[k] = computed[i];
    c.deviation[k] = std::sqrt(covariance(i, i));
  }
  c.chi2 = (one.numbers.coefficients - fitted).squaredNorm() / (sigma * sigma);
  c.published_r2 = series.law->r_squared;
  const double about_mean = one.about_mean(fitted);
  const double curved = std::max(0.0, force.squaredNorm() - fitted.squaredNorm());
  c.computed_r2 = about_mean / (about_mean + curved + (one.count - 3.0) * sigma * sigma);
  c.scatter = sigma;
  return c;
}

}  // namespace

SummaryStatistics summary_statistics(const Model& model, const std::vector<std::size_t>& series,
                                     const std::vector<Setting>& settings, std::size_t free,
                                     const SummaryOptions& options) {
  SummaryStatistics result;
  result.numbers = free;
  result.settings = settings;
  const std::vector<PublishedSeries> published = published_of(model, series);
  if (published.empty()) return result;
  PublishedModel fitted(model, published, settings, free, options.scatter);
  result.dof = 4.0 * static_cast<double>(published.size()) - static_cast<double>(free) -
               estimated_scatters(published, options.scatter);
  if (!fitted.fit()) {
    result.p = 0.0;
    return result;
  }
  result.settings = fitted.settings();
  const Point best = fitted.best();
  result.chi2 = best.deviance;
  double bias = 1.0;
  if (options.bootstrap) {
    const BootstrapResult bootstrap = published_bootstrap(fitted.deviance(), best, options.replicates);
    result.p = bootstrap.p;
    bias = bootstrap.bias;
  }
  double squares = 0.0;
  for (std::size_t k = 0; k < published.size(); ++k) {
    const PublishedSeries& one = published[k];
    const double sigma = best.sigma(one, static_cast<Index>(k)) / (one.sigma ? 1.0 : std::sqrt(bias));
    result.series.push_back(
        compare(one, model.series()[one.index], fitted.evaluation().force[one.index], sigma));
    result.coefficients += result.series.back().chi2;
    squares += sigma * sigma;
  }
  result.scatter = std::sqrt(squares / static_cast<double>(published.size()));
  return result;
}

}  // namespace snare::identification
