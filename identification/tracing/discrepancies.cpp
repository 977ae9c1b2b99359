#include "identification/tracing/discrepancies.hpp"

#include "identification/tracing/channels.hpp"
#include "numerics/dense_solvers.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Matern 5/2 between `count` even stations, as a covariance, for a length in shares of the range.
MatrixXd matern(Index count, double length) {
  MatrixXd k(count, count);
  for (Index i = 0; i < count; ++i) {
    for (Index j = 0; j < count; ++j) {
      const double x =
          std::sqrt(5.0) * std::abs(static_cast<double>(i - j)) / static_cast<double>(count - 1) / length;
      k(i, j) = (1.0 + x + x * x / 3.0) * std::exp(-x);
    }
  }
  return k;
}

/// P K P with the constant, and the straight line where `straight`, taken out of the values at the stations.
MatrixXd without_plain_parts(const MatrixXd& k, bool straight) {
  const Index m = k.rows();
  MatrixXd plain = MatrixXd::Ones(m, straight ? 2 : 1);
  if (straight) plain.col(1) = Eigen::VectorXd::LinSpaced(m, -1.0, 1.0);  // orthogonal to the first
  plain.colwise().normalize();
  const MatrixXd left = MatrixXd::Identity(m, m) - plain * plain.transpose();
  return left * k * left;
}

MatrixXd square_root(const MatrixXd& covariance) {
  const numerics::SymmetricEigen e = numerics::symmetric_eigen(covariance);
  return e.vectors * e.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

MatrixXd of_unit_size(const MatrixXd& columns) {
  const double size =
      std::sqrt(columns.squaredNorm() / static_cast<double>(std::max<Index>(1, columns.rows())));
  return size > 0.0 ? MatrixXd(columns / size) : MatrixXd();
}

constexpr double lengths[] = {0.15, 0.3, 0.6};

void add(std::vector<Discrepancy>& all, const std::string& variable, const MatrixXd& hats) {
  Discrepancy d{variable, {}};
  for (const double length : lengths) {
    MatrixXd columns =
        of_unit_size(hats * square_root(without_plain_parts(matern(hats.cols(), length), true)));
    if (columns.size() > 0 && columns.allFinite()) d.columns.push_back(std::move(columns));
  }
  if (!d.columns.empty()) all.push_back(std::move(d));
}

/// The variable of a function in a channel.
std::string variable_of(const ChannelColumns& c) {
  switch (c.channel) {
    case Channel::wire:
      return "place";
    case Channel::contact:
      return "leg";
    case Channel::mount:
    case Channel::pusher:
      return "force";
    default:
      return c.argument.starts_with("recorded travel") ? "travel" : "time";
  }
}

/// Whether the record of some series turns back, so that its legs can differ.
bool turns_back(const Model& model, const Data& data) {
  return std::ranges::any_of(data.series, [&](std::size_t k) {
    const std::vector<double>& d = measured_displacement(model.series()[k]);
    return !std::ranges::is_sorted(d) && !std::ranges::is_sorted(d, std::greater<>());
  });
}

/// A function of the recorded travel for each series by itself.
Discrepancy other(const Model& model, const Data& data) {
  constexpr Index stations = 8;
  const auto count = static_cast<Index>(data.series.size()) * stations;
  const auto hats = [&](std::size_t k) {
    const std::vector<double>& d = measured_displacement(model.series()[k]);
    const auto [low, high] = std::ranges::minmax(d);
    MatrixXd own = MatrixXd::Zero(static_cast<Index>(d.size()), count);
    const Index first = (std::ranges::find(data.series, k) - data.series.begin()) * stations;
    for (std::size_t i = 0; i < d.size(); ++i)
      add_hats(high > low ? (d[i] - low) / (high - low) : 0.0, 1.0, stations, first,
               own.row(static_cast<Index>(i)));
    return own;
  };
  const MatrixXd columns = data.whiten(hats, count);
  Discrepancy d{"other", {}};
  for (const double length : lengths) {
    const MatrixXd root = square_root(matern(stations, length));
    MatrixXd all(columns.rows(), count);
    for (Index first = 0; first < count; first += stations)
      all.middleCols(first, stations) = columns.middleCols(first, stations) * root;
    d.columns.push_back(of_unit_size(all));
  }
  return d;
}

/// A factor of the forces for each series by itself, less one that is common.
Discrepancy factors(const Data& data, const Fit& fit) {
  const auto count = static_cast<Index>(data.series.size());
  const auto own = [&](std::size_t k) {
    MatrixXd f = MatrixXd::Zero(fit.evaluation.force[k].size(), count);
    f.col(std::ranges::find(data.series, k) - data.series.begin()) = fit.evaluation.force[k];
    return f;
  };
  const MatrixXd root = square_root(without_plain_parts(MatrixXd::Identity(count, count), false));
  return {"series", {of_unit_size(data.whiten(own, count) * root)}};
}

}  // namespace

std::vector<Discrepancy> discrepancies(const Model& model, const Data& data, const Fit& fit) {
  std::vector<Discrepancy> all;
  if (data.series.size() > 1) {
    const bool both_legs = turns_back(model, data);
    for (const ChannelColumns& c : channel_columns(model, data, fit)) {
      if (c.channel != Channel::contact || both_legs) add(all, variable_of(c), c.columns);
    }
    const auto force = [&](std::size_t k, Index i) { return fit.evaluation.force[k][i]; };
    const auto one = [](std::size_t, Index) { return 1.0; };
    add(all, "force", function_columns(data, force, one, 1.0).columns);
    if (data.series.size() > 2) all.push_back(factors(data, fit));
  }
  all.push_back(other(model, data));
  return all;
}

}  // namespace snare::identification
