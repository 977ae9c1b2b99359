#pragma once

#include <Eigen/Core>

#include <functional>
#include <random>
#include <vector>

namespace snare::identification {

/// Points of the unit cube and their weights, for integrals over it: integral f du = sum_s weight_s f(u_s).
struct WeightedPoints {
  std::vector<Eigen::VectorXd> points;
  std::vector<double> log_weight;  ///< [-]
};

/// Adaptive multiple importance sampling (Cornuet, Marin, Mira and Robert 2012): a first batch fills the cube
/// evenly, every other one is drawn from Student's t of four degrees of freedom about the integrand as all
/// points so far show it; all points count with the mixture of all proposals. The same bits for the same
/// input.
class ImportanceSampler {
 public:
  /// Of a batch of points, one value each, minus infinity where the integrand vanishes.
  using LogIntegrand = std::function<std::vector<double>(const std::vector<Eigen::VectorXd>&)>;
  /// dimensions >= 0: without a dimension there is one point; first >= 1: points of the first batch.
  ImportanceSampler(Eigen::Index dimensions, int first, LogIntegrand log_integrand);
  /// size >= 1. Nothing is added where the integrand has vanished everywhere.
  void add_batch(int size);

  /// All points so far.
  [[nodiscard]] const WeightedPoints& points() const { return points_; }
  /// log of the integral [-].
  [[nodiscard]] double log_integral() const;
  /// Number of points that count, (sum w f)^2 / sum (w f)^2 [-]: the integral is known to one part in its
  /// root. Infinite without a dimension.
  [[nodiscard]] double effective() const;

 private:
  /// Student's t of four degrees of freedom.
  struct Student {
    Eigen::VectorXd mean;
    Eigen::MatrixXd root;   ///< lower triangle of the scale
    double log_size = 0.0;  ///< of the points drawn from it
    [[nodiscard]] double log_density(const Eigen::VectorXd& u) const;
  };
  [[nodiscard]] Student proposal() const;
  [[nodiscard]] double uniform();
  [[nodiscard]] double normal();
  void weigh();

  Eigen::Index dimensions_;
  double log_first_;
  LogIntegrand log_integrand_;
  WeightedPoints points_;
  std::vector<double> values_;
  std::vector<Student> proposals_;
  std::mt19937_64 random_{1};
};

/// log sum exp(values) [-], minus infinity for none.
[[nodiscard]] double log_sum(const std::vector<double>& values);

}  // namespace snare::identification
