#pragma once

#include "identification/records/record_data.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::identification {

/// Residuals of a simulation hang together in time. Of every channel an autoregression, by Burg's method over
/// its records together, its order (0 to 30) by the Bayesian criterion:                      theory.md (I.21)
///   e_t = sum_k a_k e_(t-k) + w_t,   w white of variance s^2.
struct Autoregression {
  Eigen::VectorXd coefficients;
  double innovation = 0.0;  ///< s, over the channel's scale [-]
};
/// One autoregression a piece.
struct ColouredNoise {
  std::vector<Autoregression> pieces;  ///< of every piece of the data
};
/// The noise of a residual [-]: one autoregression a channel, by its pieces together, told piece by piece.
/// `taken`: numbers that were fitted to the residual; what they took of its power is given back, n/(n -
/// taken).
[[nodiscard]] ColouredNoise coloured_noise(const RecordData& data, const Eigen::VectorXd& residual,
                                           Eigen::Index taken = 0);

/// White residuals [-], e_t - sum a_k e_(t-k), over their s; the first ones of a piece, with fewer before
/// them, too.
[[nodiscard]] Eigen::VectorXd whitened(const RecordData& data, const ColouredNoise& noise,
                                       const Eigen::VectorXd& residual);

/// Sigma^(1/2)' g [-]: |that|^2 is the variance of g'e. Columns filtered by s / (1 - sum a_k q^k) from their
/// ends to their beginnings.
[[nodiscard]] Eigen::MatrixXd coloured(const RecordData& data, const ColouredNoise& noise,
                                       const Eigen::MatrixXd& columns);

/// Covariance of least squares under that noise, in the units of the jacobian's columns: (J'J)^+ J' Sigma J
/// (J'J)^+, directions below 1e-9 of the largest left out (columns scaled to one).
[[nodiscard]] Eigen::MatrixXd sandwich(const RecordData& data, const ColouredNoise& noise,
                                       const Eigen::MatrixXd& jacobian);

}  // namespace snare::identification
