#pragma once

#include "study/distribution.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace snare::study {

/// One thing that differs from case to case.
struct Variable {
  std::string name;  ///< of its column
  /// Keys of the case's file that get the value, at least one.
  std::vector<std::string> keys;
  /// Values as TOML literals, one of which a case gets; empty: numbers of the distribution.
  std::vector<std::string> levels;
  Distribution distribution;
};

/// How the cases of a study are chosen.
enum class DesignKind {
  grid,             ///< every combination of levels, the last variable fastest
  latin_hypercube,  ///< of n slices of equal probability every variable has one case in each
  sobol,            ///< Sobol's sequence, shifted at random
  file,             ///< a table of cases
  /// n times the rows A, B and A with a column of B, in replicates                            theory.md (S.4)
  sensitivity,
  subset  ///< the next cases depend on the last ones: no list beforehand
};

/// What a design depends on beside its variables; equal settings give equal cases.
struct DesignSettings {
  DesignKind kind = DesignKind::grid;
  /// latin_hypercube, sobol: cases; sensitivity: n; subset: cases a level.
  std::uint64_t cases = 0;
  std::uint64_t seed = 0;
  /// Correlation of the normal scores of the variables, (n, n); no rows: none are correlated.
  ///                                                                                          theory.md (S.2)
  Eigen::MatrixXd correlation;
  std::vector<std::vector<double>> table;  ///< file: a column a variable
};

/// Counts up when equal settings give other cases: journals of another version are not continued.
inline constexpr int design_version = 2;

/// The cases of a study. A case is computed from its number alone: nothing is kept per case.
class Design {
 public:
  /// Expects settings that the reader of the file has found right.
  Design(std::vector<Variable> variables, DesignSettings settings);
  ~Design();
  Design(const Design&) = delete;
  Design& operator=(const Design&) = delete;
  Design(Design&&) noexcept;
  Design& operator=(Design&&) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }  ///< of cases
  /// What differs from case to case.
  [[nodiscard]] const std::vector<Variable>& variables() const noexcept { return variables_; }
  [[nodiscard]] const DesignSettings& settings() const noexcept { return settings_; }  ///< as they were given

  /// What the variables are in a case < count(): a number, in the unit of its keys, or the index of a level.
  [[nodiscard]] std::vector<double> values(std::uint64_t index) const;

  /// Of normal scores [-], independent and standard: what a case with them would be.
  [[nodiscard]] std::vector<double> values_of_scores(const std::vector<double>& scores) const;

 private:
  struct Sequence;  // Sobol's
  [[nodiscard]] double uniform(std::uint64_t index, std::size_t dimension) const;
  [[nodiscard]] std::vector<double> values_of_uniforms(std::vector<double> u) const;

  std::vector<Variable> variables_;
  DesignSettings settings_;
  Eigen::MatrixXd factor_;  // L of the correlation, L L^T
  std::uint64_t count_ = 0;
  std::unique_ptr<Sequence> sequence_;
};

/// A value of a variable, in the unit of its keys, as a TOML literal: the level, or the number with the
/// fewest digits that read back to it.
[[nodiscard]] std::string literal(const Variable& variable, double value);

/// Whether a matrix is a correlation: symmetric, 1 on the diagonal, positive definite.
[[nodiscard]] bool is_correlation(const Eigen::MatrixXd& matrix);

/// Most variables of a design.
inline constexpr std::size_t variable_limit = 1000;

}  // namespace snare::study
