#include "study/sobol_indices.hpp"

#include <cmath>

namespace snare::study {

namespace {

/// Sums of a numerator over rows, and of its products, for a ratio of means and its error.
struct Ratio {
  double v = 0.0, vv = 0.0, vw = 0.0;

  void add(double value, double w) {
    v += value;
    vv += value * value;
    vw += value * w;
  }
  /// Standard error of v / w: the scatter of (v - r w) over rows, divided by the mean of w and by sqrt(n).
  [[nodiscard]] double error(double r, double w, double ww, double n) const {
    const double mean_w = w / n;
    const double mean = (v - r * w) / n;
    const double square = (vv - 2.0 * r * vw + r * r * ww) / n - mean * mean;
    return std::sqrt(std::max(0.0, square) / (n - 1.0)) / mean_w;
  }
};

}  // namespace

SobolIndices sobol_indices(std::size_t variables, std::uint64_t rows,
                           const std::function<std::optional<double>(std::uint64_t)>& result) {
  SobolIndices indices;
  std::vector<double> y(variables + 2);
  const auto for_rows = [&](const auto& use) {
    for (std::uint64_t row = 0; row < rows; ++row) {
      bool whole = true;
      for (std::size_t k = 0; k < y.size(); ++k) {
        const std::optional<double> one = result(row * y.size() + k);
        whole = whole && one;
        y[k] = one.value_or(0.0);
      }
      if (whole)
        use();
      else
        ++indices.dropped;
    }
  };
  for_rows([&] {
    ++indices.rows;
    indices.mean += 0.5 * (y[0] + y[1]);
  });
  constexpr std::uint64_t least = 2;
  if (indices.rows < least) return indices;
  const auto n = static_cast<double>(indices.rows);
  indices.mean /= n;
  indices.dropped = 0;

  // With f_A and f_B about the mean: V_j = E[f_B (f_ABj - f_A)], T_j = E[(f_A - f_ABj)^2] / 2, V = E[f_A^2 + f_B^2] / 2.
  double w = 0.0;
  double ww = 0.0;
  std::vector<Ratio> first(variables), total(variables);
  for_rows([&] {
    const double a = y[0] - indices.mean;
    const double b = y[1] - indices.mean;
    const double square = 0.5 * (a * a + b * b);
    w += square;
    ww += square * square;
    for (std::size_t j = 0; j < variables; ++j) {
      const double difference = y[j + 2] - y[0];
      first[j].add(b * difference, square);
      total[j].add(0.5 * difference * difference, square);
    }
  });
  indices.variance = w / n;
  if (!(indices.variance > 0.0)) return indices;
  for (std::size_t j = 0; j < variables; ++j) {
    const double s = first[j].v / w;
    const double t = total[j].v / w;
    indices.of.push_back({s, t, first[j].error(s, w, ww, n), total[j].error(t, w, ww, n)});
  }
  return indices;
}

}  // namespace snare::study
