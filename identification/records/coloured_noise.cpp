#include "identification/records/coloured_noise.hpp"

#include "numerics/dense_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace snare::identification {

namespace {

constexpr int highest_order = 30;

/// Burg's recursion over several stretches of one process: at every order the reflection that makes the
/// forward and backward errors of all of them least. It is always stable.
Autoregression burg(const std::vector<Eigen::VectorXd>& stretches) {
  double count = 0.0, power = 0.0;
  for (const Eigen::VectorXd& s : stretches) {
    count += static_cast<double>(s.size());
    power += s.squaredNorm();
  }
  power /= std::max(1.0, count);
  Autoregression best{{}, std::sqrt(power)};
  if (!(power > 0.0)) return best;
  std::vector<Eigen::VectorXd> forward = stretches, backward = stretches;
  Eigen::VectorXd a(0);
  double least = count * std::log(power);
  Eigen::Index shortest = stretches.front().size();
  for (const Eigen::VectorXd& s : stretches) shortest = std::min(shortest, s.size());
  const int most = static_cast<int>(std::min<Eigen::Index>(highest_order, shortest / 4));
  for (int m = 1; m <= most; ++m) {
    double product = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < stretches.size(); ++k) {
      const Eigen::Index n = forward[k].size() - 1;
      const auto f = forward[k].tail(n), b = backward[k].head(n);
      product += f.dot(b);
      squares += f.squaredNorm() + b.squaredNorm();
    }
    if (!(squares > 0.0)) break;
    const double reflection = 2.0 * product / squares;
    for (std::size_t k = 0; k < stretches.size(); ++k) {
      const Eigen::Index n = forward[k].size() - 1;
      const Eigen::VectorXd f = forward[k].tail(n), b = backward[k].head(n);
      forward[k] = f - reflection * b;
      backward[k] = b - reflection * f;
    }
    Eigen::VectorXd next(m);
    if (m > 1) next.head(m - 1) = a - reflection * a.reverse();
    next[m - 1] = reflection;
    a = next;
    power *= 1.0 - reflection * reflection;
    if (!(power > 0.0)) break;
    const double criterion = count * std::log(power) + m * std::log(count);
    if (criterion < least) {
      least = criterion;
      best = {a, std::sqrt(power)};
    }
  }
  return best;
}

}  // namespace

ColouredNoise coloured_noise(const RecordData& data, const Eigen::VectorXd& residual, Eigen::Index taken) {
  std::map<std::string, std::vector<Eigen::VectorXd>> by_sensor;
  for (const ResidualPiece& p : data.pieces)
    by_sensor[data.set->records[p.record].channels[p.channel].sensor].emplace_back(
        residual.segment(p.begin, p.size));
  std::map<std::string, Autoregression> fitted;
  const auto n = static_cast<double>(residual.size());
  const double given_back = std::sqrt(n / std::max(1.0, n - static_cast<double>(taken)));
  for (const auto& [sensor, stretches] : by_sensor) {
    fitted[sensor] = burg(stretches);
    fitted[sensor].innovation *= given_back;
  }
  ColouredNoise noise;
  for (const ResidualPiece& p : data.pieces)
    noise.pieces.push_back(fitted[data.set->records[p.record].channels[p.channel].sensor]);
  return noise;
}

Eigen::VectorXd whitened(const RecordData& data, const ColouredNoise& noise,
                         const Eigen::VectorXd& residual) {
  Eigen::VectorXd white(residual.size());
  for (std::size_t k = 0; k < data.pieces.size(); ++k) {
    const ResidualPiece& p = data.pieces[k];
    const Autoregression& ar = noise.pieces[k];
    for (Eigen::Index t = 0; t < p.size; ++t) {
      double value = residual[p.begin + t];
      for (Eigen::Index j = 0; j < std::min<Eigen::Index>(ar.coefficients.size(), t); ++j)
        value -= ar.coefficients[j] * residual[p.begin + t - 1 - j];
      white[p.begin + t] = ar.innovation > 0.0 ? value / ar.innovation : 0.0;
    }
  }
  return white;
}

Eigen::MatrixXd coloured(const RecordData& data, const ColouredNoise& noise, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd result(columns.rows(), columns.cols());
  for (std::size_t k = 0; k < data.pieces.size(); ++k) {
    const ResidualPiece& p = data.pieces[k];
    const Autoregression& ar = noise.pieces[k];
    for (Eigen::Index c = 0; c < columns.cols(); ++c) {
      for (Eigen::Index t = p.size - 1; t >= 0; --t) {
        double value = ar.innovation * columns(p.begin + t, c);
        const Eigen::Index most = std::min<Eigen::Index>(ar.coefficients.size(), p.size - 1 - t);
        for (Eigen::Index j = 0; j < most; ++j) value += ar.coefficients[j] * result(p.begin + t + 1 + j, c);
        result(p.begin + t, c) = value;
      }
    }
  }
  return result;
}

Eigen::MatrixXd sandwich(const RecordData& data, const ColouredNoise& noise,
                         const Eigen::MatrixXd& jacobian) {
  const Eigen::Index n = jacobian.cols();
  if (n == 0) return {};
  Eigen::VectorXd norms = jacobian.colwise().norm().transpose();
  for (double& norm : norms) norm = norm > 0.0 ? norm : 1.0;
  const Eigen::MatrixXd scaled = jacobian * norms.cwiseInverse().asDiagonal();
  const numerics::SymmetricEigen eigen = numerics::symmetric_eigen(scaled.transpose() * scaled);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k)
    if (eigen.values[k] > 1e-18 * eigen.values[n - 1]) inverse[k] = 1.0 / eigen.values[k];
  const Eigen::MatrixXd bread = eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
  const Eigen::MatrixXd through = coloured(data, noise, scaled * bread);
  const Eigen::MatrixXd covariance = through.transpose() * through;
  return norms.cwiseInverse().asDiagonal() * covariance * norms.cwiseInverse().asDiagonal();
}

}  // namespace snare::identification
