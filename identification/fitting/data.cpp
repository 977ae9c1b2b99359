#include "identification/fitting/data.hpp"

#include "identification/fitting/conditions.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

/// sigma L^-1 g in the rows of the data, zero elsewhere.
struct Data::Direction {
  const Placing* placing = nullptr;
  Eigen::VectorXd white;
  double square = 0.0;  // of it
};

Eigen::Index Data::rows() const {
  Eigen::Index n = 0;
  for (const std::size_t k : series) n += rows_of(k);
  return n;
}

bool Data::published() const {
  return !series.empty() &&
         std::ranges::all_of(series, [this](std::size_t k) { return noise.summarised(k); });
}

std::vector<Data::Direction> Data::directions() const {
  std::vector<Direction> result;
  for (const Placing& placing : placings) {
    Direction d{.placing = &placing, .white = Eigen::VectorXd::Zero(rows())};
    Eigen::Index row = 0;
    for (const std::size_t k : series) {
      const auto at = std::find(placing.series.begin(), placing.series.end(), k);
      if (at != placing.series.end()) {
        const Eigen::VectorXd& by = placing.by[static_cast<std::size_t>(at - placing.series.begin())];
        d.white.segment(row, rows_of(k)) = placing.sigma * noise.whiten(k, by);
      }
      row += rows_of(k);
    }
    d.square = d.white.squaredNorm();
    if (d.square > 0.0) result.push_back(std::move(d));
  }
  return result;
}

namespace {

Eigen::MatrixXd whiten_noise(const Data& data, const Data::Forces& forces, Eigen::Index columns) {
  Eigen::MatrixXd result(data.rows(), columns);
  Eigen::Index row = 0;
  for (const std::size_t k : data.series) {
    const Eigen::Index n = data.rows_of(k);
    result.middleRows(row, n) = data.noise.whiten(k, forces(k));
    row += n;
  }
  return result;
}

}  // namespace

// With u = sigma L^-1 g, (1 + u u^T)^(-1/2) = 1 - u u^T (1 - 1 / sqrt(1 + |u|^2)) / |u|^2: placings have no
// rows in common.
Eigen::MatrixXd Data::whiten(const Forces& forces, Eigen::Index columns) const {
  Eigen::MatrixXd result = whiten_noise(*this, forces, columns);
  for (const Direction& d : directions()) {
    const double share = (1.0 - 1.0 / std::sqrt(1.0 + d.square)) / d.square;
    const Eigen::RowVectorXd along = share * (d.white.transpose() * result);
    result -= d.white * along;
  }
  return result;
}

// The R2 of a published fit has a residual that is not linear in the force.
Eigen::VectorXd Data::residual(const Evaluation& evaluation) const {
  Eigen::VectorXd result = whiten([&](std::size_t k) { return measured[k] - evaluation.force[k]; }, 1);
  for_published([&](std::size_t k, Eigen::Index row) {
    result[row] = noise.published[k]->r_squared_residual(evaluation.force[k]);
  });
  return result;
}

Eigen::MatrixXd Data::jacobian(const Evaluation& evaluation) const {
  if (evaluation.by.empty()) return Eigen::MatrixXd::Zero(rows(), 0);
  Eigen::MatrixXd result =
      whiten([&](std::size_t k) { return evaluation.by[k]; }, evaluation.by.front().cols());
  for_published([&](std::size_t k, Eigen::Index row) {
    result.row(row) = noise.published[k]->r_squared_slope(evaluation.force[k], evaluation.by[k]);
  });
  return result;
}

void Data::for_published(const std::function<void(std::size_t series, Eigen::Index row)>& visit) const {
  Eigen::Index row = 0;
  for (const std::size_t k : series) {
    row += rows_of(k);
    if (noise.summarised(k)) visit(k, row - 1);
  }
}

// f - g sigma (u . L^-1 f) / (1 + |u|^2)
std::vector<Eigen::MatrixXd> Data::placed(const Forces& forces, Eigen::Index columns) const {
  std::vector<Eigen::MatrixXd> result;
  for (const std::size_t k : series) result.push_back(forces(k));
  if (placings.empty()) return result;
  const Eigen::MatrixXd white = whiten_noise(*this, forces, columns);
  for (const Direction& d : directions()) {
    const Eigen::RowVectorXd shift = d.placing->sigma / (1.0 + d.square) * (d.white.transpose() * white);
    for (std::size_t i = 0; i < d.placing->series.size(); ++i) {
      const auto at = std::find(series.begin(), series.end(), d.placing->series[i]);
      if (at != series.end())
        result[static_cast<std::size_t>(at - series.begin())] -= d.placing->by[i] * shift;
    }
  }
  return result;
}

// shift = sigma u . L^-1 (y - F) / (1 + |u|^2), and numbers p move F.
std::vector<PlaceEstimate> Data::places(const Model& model, const Evaluation& optimum,
                                        const Eigen::MatrixXd& covariance) const {
  std::vector<PlaceEstimate> result;
  if (placings.empty()) return result;
  const Eigen::MatrixXd left = whiten_noise(
      *this, [&](std::size_t k) { return measured[k] - optimum.force[k]; }, 1);
  const Eigen::Index numbers = covariance.cols();
  const Eigen::MatrixXd by = numbers > 0 ? whiten_noise(
                                               *this, [&](std::size_t k) { return optimum.by[k]; }, numbers)
                                         : Eigen::MatrixXd();
  for (const Direction& d : directions()) {
    PlaceEstimate place;
    for (const std::size_t k : d.placing->series) place.series.push_back(model.series()[k].name);
    place.sigma = d.placing->sigma;
    place.shift = place.sigma / (1.0 + d.square) * d.white.dot(left.col(0));
    double variance = place.sigma * place.sigma / (1.0 + d.square);
    if (numbers > 0) {
      const Eigen::VectorXd moved = place.sigma / (1.0 + d.square) * (by.transpose() * d.white);
      variance += moved.dot(covariance * moved);
    }
    place.standard_error = std::sqrt(variance);
    result.push_back(std::move(place));
  }
  return result;
}

std::vector<Placing> find_placings(const Model& model, const std::vector<Setting>& settings,
                                   const Parameter& place) {
  const std::vector<Series>& series = model.series();
  std::vector<Placing> result;
  const Evaluation at = model.evaluate(settings, {&place});
  if (!at.complete) return result;
  for (const std::vector<std::size_t>& group : tests(series)) {
    Placing placing;
    for (const std::size_t k : group) {
      placing.series.push_back(k);
      placing.sigma = std::max(placing.sigma, series[k].position_sigma);
      placing.by.emplace_back(at.by[k].col(0));
    }
    if (placing.sigma > 0.0) result.push_back(std::move(placing));
  }
  return result;
}

}  // namespace snare::identification
