#include "identification/tracing/attribution.hpp"

#include "identification/tracing/model_error.hpp"

#include <Eigen/Cholesky>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace snare::identification {

namespace {

/// The function's values v and the fit's numbers c that together leave least, v smooth:       theory.md (I.6)
///   min |r - J c - H v|^2 + weight sum_i (v_{i-1} - 2 v_i + v_{i+1})^2,  columns scaled to one
struct Smooth {
  Eigen::VectorXd values;      // of the function
  Eigen::MatrixXd covariance;  // of them
  Eigen::VectorXd free;        // of the fit's numbers
};

Smooth solve(const Eigen::MatrixXd& free, const Eigen::MatrixXd& columns, const Eigen::VectorXd& r,
             double weight) {
  const Eigen::Index p = free.cols();
  const Eigen::Index m = columns.cols();
  // [J H], every column of J scaled by its own length, those of H by the longest of theirs.
  Eigen::MatrixXd all(free.rows(), p + m);
  all << free, columns;
  Eigen::VectorXd scale(p + m);
  const double size = std::max(columns.colwise().norm().maxCoeff(), 1e-300);
  for (Eigen::Index k = 0; k < p; ++k) scale[k] = 1.0 / std::max(free.col(k).norm(), 1e-300);
  scale.tail(m).setConstant(1.0 / size);
  all = all * scale.asDiagonal();
  // Normal equations with the penalty; ridges that keep directions without any data finite.
  Eigen::MatrixXd normal = all.transpose() * all;
  normal.diagonal().head(p).array() += 1e-12;
  for (Eigen::Index i = 1; i + 1 < m; ++i) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(p + m);
    d[p + i - 1] = d[p + i + 1] = 1.0;
    d[p + i] = -2.0;
    normal += weight * d * d.transpose();
  }
  normal.diagonal().tail(m).array() += 1e-6 * weight + 1e-9;
  const Eigen::LDLT<Eigen::MatrixXd> factor(normal);
  const Eigen::VectorXd x = scale.asDiagonal() * factor.solve(all.transpose() * r);
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(p + m, p + m));
  return {x.tail(m), inverse.bottomRightCorner(m, m) / (size * size), x.head(p)};
}

std::string describe(const ChannelFunction& f) {
  // Stretches in which the function stands out by more than three deviations and a quarter of its largest
  // value.
  double largest = 0.0;
  for (const double v : f.value) largest = std::max(largest, std::abs(v));
  std::string text;
  std::size_t i = 0;
  while (i < f.value.size()) {
    const auto stands_out = [&](std::size_t k) {
      return std::abs(f.value[k]) > 3.0 * f.deviation[k] && std::abs(f.value[k]) > 0.25 * largest;
    };
    if (!stands_out(i)) {
      ++i;
      continue;
    }
    const std::size_t from = i;
    const bool high = f.value[i] > 0.0;
    while (i < f.value.size() && stands_out(i) && (f.value[i] > 0.0) == high) ++i;
    text += fmt::format("{}{} between {:.3g} and {:.3g}", text.empty() ? "" : ", ", high ? "high" : "low",
                        f.at[from], f.at[i - 1]);
  }
  return text.empty() ? "nowhere beyond three standard deviations" : text;
}

/// A position or a slack left out: the rows that stay, the rows that go, and what the numbers of the fit
/// alone leave there.
struct Fold {
  std::vector<Eigen::Index> in, out;
  Eigen::MatrixXd free_in, free_out;
  Eigen::VectorXd residual_in, residual_out;
  double excess = 0.0;  // of chi2 in the rows left out, predicted without any function
};

std::vector<Fold> folds_of(const Model& model, const Data& data, const Fit& current) {
  const Eigen::VectorXd& r = current.residual;
  std::vector<Fold> result;
  LeftOut conditions = left_out_conditions(model, data);
  if (!conditions.several) return result;
  for (std::vector<Eigen::Index>& out : conditions.rows) {
    Fold fold;
    fold.out = std::move(out);
    std::vector<bool> goes(static_cast<std::size_t>(r.size()), false);
    for (const Eigen::Index i : fold.out) goes[static_cast<std::size_t>(i)] = true;
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      if (!goes[static_cast<std::size_t>(i)]) fold.in.push_back(i);
    }
    fold.free_in = current.jacobian(fold.in, Eigen::all);
    fold.free_out = current.jacobian(fold.out, Eigen::all);
    fold.residual_in = r(fold.in);
    fold.residual_out = r(fold.out);
    const Smooth plain =
        solve(fold.free_in, Eigen::MatrixXd::Zero(fold.free_in.rows(), 1), fold.residual_in, 1.0);
    fold.excess =
        (fold.residual_out - fold.free_out * plain.free).squaredNorm() - static_cast<double>(fold.out.size());
    result.push_back(std::move(fold));
  }
  return result;
}

/// Share of the excess in the rows left out that a function found in the others explains.
double carried_over(const std::vector<Fold>& folds, const Eigen::MatrixXd& columns, double weight) {
  double without = 0.0;
  double with = 0.0;
  for (const Fold& fold : folds) {
    const Smooth s = solve(fold.free_in, columns(fold.in, Eigen::all), fold.residual_in, weight);
    const Eigen::VectorXd left =
        fold.residual_out - fold.free_out * s.free - columns(fold.out, Eigen::all) * s.values;
    with += left.squaredNorm() - static_cast<double>(fold.out.size());
    without += fold.excess;
  }
  return without > 0.0 ? 1.0 - with / without : 0.0;
}

/// The largest share that is carried over, and the weight of smoothness that does it.
std::pair<double, double> best_of_weights(const std::vector<Fold>& folds, const Eigen::MatrixXd& columns) {
  std::pair<double, double> best{std::numeric_limits<double>::lowest(), 1.0};
  if (folds.empty()) return {0.0, 1.0};  // of one condition nothing carries over
  for (const double weight : {1e-4, 1e-2, 1.0, 1e2}) {
    const double share = carried_over(folds, columns, weight);
    if (share > best.first) best = {share, weight};
  }
  return best;
}

}  // namespace

std::vector<ChannelFunction> attribute(const Model& model, const Data& data, const Fit& current) {
  const Eigen::VectorXd& r = current.residual;
  const double excess = r.squaredNorm() - current.dof();
  const std::vector<Fold> folds = folds_of(model, data, current);
  std::vector<ChannelFunction> result;
  for (const ChannelColumns& channel : channel_columns(model, data, current)) {
    const auto [best, best_weight] = best_of_weights(folds, channel.columns);
    // The function of all series, with the weight that carries over best.
    ChannelFunction f;
    f.channel = channel.channel;
    f.argument = channel.argument;
    f.effect = channel.effect;
    f.constant = channel.constant;
    f.at = channel.at;
    const Smooth s = solve(current.jacobian, channel.columns, r, best_weight);
    const double left = (r - current.jacobian * s.free - channel.columns * s.values).squaredNorm();
    f.carried_over = std::min(best, 1.0);
    f.explained = excess > 0.0 ? std::min(1.0, 1.0 - (left - current.dof()) / excess) : 0.0;
    f.chi2 = left;
    f.chi2_dof = left / std::max(1.0, current.dof() - ChannelColumns::stations / 2.0);
    for (Eigen::Index k = 0; k < s.values.size(); ++k) {
      f.value.push_back(s.values[k] / channel.unit);
      f.deviation.push_back(std::sqrt(std::max(s.covariance(k, k), 0.0)) / channel.unit);
    }
    f.shape = describe(f);
    f.accepted = f.carried_over > 0.7;
    result.push_back(std::move(f));
  }
  std::stable_sort(result.begin(), result.end(), [](const ChannelFunction& a, const ChannelFunction& b) {
    if (a.carried_over != b.carried_over) return a.carried_over > b.carried_over;
    return a.explained > b.explained;
  });
  return result;
}

}  // namespace snare::identification
