#include "study/design.hpp"

#include "base/index.hpp"
#include "study/random_access.hpp"
#include "study/sobol_indices.hpp"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <boost/random/sobol.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace snare::study {

/// Sobol's sequence with the numbers of Joe and Kuo, each dimension of each replicate shifted by bits of its
/// own drawn at random.
struct Design::Sequence {
  Sequence(std::size_t dimensions, std::uint64_t seed, std::uint64_t replicates) : engine(dimensions) {
    for (std::uint64_t r = 0; r < replicates; ++r) {
      shifts.emplace_back(dimensions);
      for (std::size_t d = 0; d < dimensions; ++d)
        shifts[r][d] =
            static_cast<std::uint64_t>(hashed_uniform(seed, r * dimensions + d, ~std::uint64_t{0}) * 0x1p64);
    }
  }

  /// Point `index` of all replicates, in turn.
  [[nodiscard]] std::vector<double> point(std::uint64_t index) const {
    const std::vector<std::uint64_t>& shift = shifts[index % shifts.size()];
    boost::random::sobol at = engine;
    at.discard(index / shifts.size() * shift.size());
    std::vector<double> u(shift.size());
    for (std::size_t d = 0; d < u.size(); ++d) {
      const std::uint64_t bits = (static_cast<std::uint64_t>(at()) ^ shift[d]) >> 11u;
      u[d] = (static_cast<double>(bits) + 0.5) * 0x1p-53;
    }
    return u;
  }

  boost::random::sobol engine;
  std::vector<std::vector<std::uint64_t>> shifts;
};

Design::Design(std::vector<Variable> variables, DesignSettings settings)
    : variables_(std::move(variables)), settings_(std::move(settings)) {
  const std::size_t n = variables_.size();
  switch (settings_.kind) {
    case DesignKind::grid:
      count_ = 1;
      for (const Variable& v : variables_) count_ *= v.levels.size();
      break;
    case DesignKind::latin_hypercube:
    case DesignKind::subset:
      count_ = settings_.cases;
      break;
    case DesignKind::sobol:
      count_ = settings_.cases;
      sequence_ = std::make_unique<Sequence>(n, settings_.seed, 1);
      break;
    case DesignKind::sensitivity:
      count_ = settings_.cases * (n + 2);
      sequence_ = std::make_unique<Sequence>(2 * n, settings_.seed, sobol_replicates);
      break;
    case DesignKind::file:
      count_ = settings_.table.front().size();
      break;
  }
  if (settings_.correlation.rows() > 0) factor_ = settings_.correlation.llt().matrixL();
}

Design::~Design() = default;
Design::Design(Design&&) noexcept = default;
Design& Design::operator=(Design&&) noexcept = default;

std::vector<double> Design::values(std::uint64_t index) const {
  assert(index < count_);
  const std::size_t n = variables_.size();
  std::vector<double> row(n);
  switch (settings_.kind) {
    case DesignKind::grid:
      for (std::size_t j = n; j-- > 0;) {
        const std::uint64_t levels = variables_[j].levels.size();
        row[j] = static_cast<double>(index % levels);
        index /= levels;
      }
      return row;
    case DesignKind::file:
      for (std::size_t j = 0; j < n; ++j) row[j] = settings_.table[j][index];
      return row;
    case DesignKind::sensitivity: {
      // Case i (n + 2) + k: k = 0 is row i of A, 1 that of B, 2 + j that of A with column j of B.
      const std::uint64_t k = index % (n + 2);
      const std::vector<double> u = sequence_->point(index / (n + 2));
      for (std::size_t j = 0; j < n; ++j) row[j] = k == 1 || k == 2 + j ? u[n + j] : u[j];
      return values_of_uniforms(std::move(row));
    }
    case DesignKind::sobol:
      return values_of_uniforms(sequence_->point(index));
    case DesignKind::latin_hypercube:
    case DesignKind::subset:
      for (std::size_t j = 0; j < n; ++j) row[j] = uniform(index, j);
      return values_of_uniforms(std::move(row));
  }
  return row;
}

double Design::uniform(std::uint64_t index, std::size_t dimension) const {
  const double inside = hashed_uniform(settings_.seed, dimension, index);
  if (settings_.kind != DesignKind::latin_hypercube) return inside;
  const KeyedPermutation slice(settings_.seed, dimension, count_);
  return (static_cast<double>(slice(index)) + inside) / static_cast<double>(count_);
}

std::vector<double> Design::values_of_uniforms(std::vector<double> u) const {
  if (factor_.rows() > 0) {
    std::vector<double> scores(u.size());
    std::ranges::transform(u, scores.begin(), normal_quantile);
    return values_of_scores(scores);
  }
  for (std::size_t j = 0; j < u.size(); ++j) {
    const Variable& v = variables_[j];
    const auto levels = static_cast<double>(v.levels.size());
    u[j] =
        v.levels.empty() ? quantile(v.distribution, u[j]) : std::min(std::floor(u[j] * levels), levels - 1.0);
  }
  return u;
}

std::vector<double> Design::values_of_scores(const std::vector<double>& scores) const {
  std::vector<double> x(scores.size());
  for (std::size_t j = 0; j < scores.size(); ++j) {
    double z = scores[j];
    if (factor_.rows() > 0) {
      z = 0.0;
      for (std::size_t k = 0; k <= j; ++k)
        z += factor_(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) * scores[k];
    }
    const Variable& v = variables_[j];
    const auto levels = static_cast<double>(v.levels.size());
    const double p = normal_probability(z);
    x[j] = v.levels.empty() ? quantile(v.distribution, p) : std::min(std::floor(p * levels), levels - 1.0);
  }
  return x;
}

std::string literal(const Variable& variable, double value) {
  if (!variable.levels.empty()) return variable.levels[static_cast<std::size_t>(value)];
  return fmt::format("{}", value);
}

bool is_correlation(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() != matrix.cols() || !matrix.allFinite()) return false;
  if (matrix.size() == 0) return true;  // of no variables, of which the file is told elsewhere
  if (matrix != matrix.transpose() || (matrix.diagonal().array() != 1.0).any()) return false;
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  constexpr double least = 1e-12;  // of a pivot: below it the variables are one
  return factor.info() == Eigen::Success &&
         Eigen::MatrixXd(factor.matrixL()).diagonal().minCoeff() > std::sqrt(least);
}

}  // namespace snare::study
