#pragma once

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace snare::identification {

/// Points of the unit cube and their weights, for integrals over it: integral f du = sum_s weight_s f(u_s).
struct WeightedPoints {
  std::vector<Eigen::VectorXd> points;
  std::vector<double> log_weight;  ///< [-]
};

/// Adaptive multiple importance sampling (Cornuet, Marin, Mira and Robert 2012): a first batch fills the cube evenly, every other one
/// is drawn from Student's t of four degrees of freedom about the integrand as all points so far show it; all points count with the
/// mixture of all proposals. The same bits for the same input.
/// dimensions >= 1; log_integrand: of a batch of points, one value each, minus infinity where it vanishes; batches >= 1 of `size` points.
[[nodiscard]] WeightedPoints sample_by_importance(
    Eigen::Index dimensions, int first, int size, int batches,
    const std::function<std::vector<double>(const std::vector<Eigen::VectorXd>&)>& log_integrand);

/// log sum exp(values) [-], minus infinity for none.
[[nodiscard]] double log_sum(const std::vector<double>& values);

}  // namespace snare::identification
