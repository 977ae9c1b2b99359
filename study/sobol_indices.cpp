#include "study/sobol_indices.hpp"

#include <boost/math/distributions/students_t.hpp>

#include <array>
#include <cmath>

namespace snare::study {

namespace {

/// Sums of one quantity over the rows of each replicate.
using Sums = std::array<double, sobol_replicates>;

double sum(const Sums& sums) {
  double total = 0.0;
  for (const double one : sums) total += one;
  return total;
}

/// Half of the 95 % interval of r = sum(v) / sum(w), by linear propagation: the replicates' v - r w are
/// independent.
double half_interval(const Sums& v, const Sums& w, const Sums& rows) {
  const double r = sum(v) / sum(w);
  double squares = 0.0;
  double replicates = 0.0;
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (rows[k] == 0.0) continue;
    replicates += 1.0;
    squares += std::pow(v[k] - r * w[k], 2);
  }
  constexpr double tail = 0.025;
  const double t =
      boost::math::quantile(boost::math::complement(boost::math::students_t(replicates - 1.0), tail));
  return t * std::sqrt(replicates / (replicates - 1.0) * squares) / sum(w);
}

}  // namespace

SobolIndices sobol_indices(std::size_t variables, std::uint64_t rows,
                           const std::function<std::optional<double>(std::uint64_t)>& result) {
  SobolIndices indices;
  std::vector<double> y(variables + 2);
  const auto for_rows = [&](const auto& use) {
    indices.dropped = 0;
    for (std::uint64_t row = 0; row < rows; ++row) {
      bool whole = true;
      for (std::size_t k = 0; k < y.size(); ++k) {
        const std::optional<double> one = result(row * y.size() + k);
        whole = whole && one;
        y[k] = one.value_or(0.0);
      }
      if (whole)
        use(row % sobol_replicates);
      else
        ++indices.dropped;
    }
  };
  Sums whole{};
  for_rows([&](std::uint64_t replicate) {
    ++indices.rows;
    whole[replicate] += 1.0;
    indices.mean += 0.5 * (y[0] + y[1]);
  });
  std::size_t replicates = 0;
  for (const double count : whole) replicates += count > 0.0 ? 1 : 0;
  constexpr std::size_t least = 2;
  if (replicates < least) return indices;
  indices.mean /= static_cast<double>(indices.rows);

  // V = E[(f_A - m)^2 + (f_B - m)^2] / 2, T_j = E[(f_A - f_ABj)^2] / 2; V_j by products, E[(f_B - m) (f_ABj -
  // f_A)], or by differences, V - E[(f_B - f_ABj)^2] / 2.
  Sums variance{};
  double squares = 0.0;
  std::vector<Sums> by_products(variables), by_differences(variables), total(variables);
  for_rows([&](std::uint64_t k) {
    const double square = 0.5 * (std::pow(y[0] - indices.mean, 2) + std::pow(y[1] - indices.mean, 2));
    variance[k] += square;
    squares += square * square;
    for (std::size_t j = 0; j < variables; ++j) {
      by_products[j][k] += (y[1] - indices.mean) * (y[j + 2] - y[0]);
      by_differences[j][k] += square - 0.5 * std::pow(y[1] - y[j + 2], 2);
      total[j][k] += 0.5 * std::pow(y[0] - y[j + 2], 2);
    }
  });
  const double w = sum(variance);
  indices.variance = w / static_cast<double>(indices.rows);
  if (!(indices.variance > 0.0)) return indices;
  indices.effective_rows = w * w / squares;
  if (indices.effective_rows < least_effective_rows) return indices;
  // Where most rows contribute, products scatter less; of a rare outcome few rows or none have one.
  constexpr double even = 1.0 / 3.0;
  const bool products = indices.effective_rows >= even * static_cast<double>(indices.rows);
  const std::vector<Sums>& first = products ? by_products : by_differences;
  for (std::size_t j = 0; j < variables; ++j) {
    indices.of.push_back({sum(first[j]) / w, sum(total[j]) / w, half_interval(first[j], variance, whole),
                          half_interval(total[j], variance, whole)});
  }
  return indices;
}

}  // namespace snare::study
