#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// A direction in which fitted numbers move while no reading changes.                       theory.md (I.32)
struct NullDirection {
  std::size_t held = 0;  ///< index of the number that moves most; with it held the others are known
  std::vector<std::size_t>
      others;              ///< indices of the numbers that move with it; empty: no reading depends on `held`
  Eigen::VectorXd change;  ///< of every number, over that of `held`: in the units of the Jacobian's columns
};

/// Which fitted numbers, and which combinations of them, the readings determine.             theory.md (I.32)
struct Identifiability {
  std::vector<NullDirection> directions;  ///< a basis of the null space in which few numbers move
  std::vector<bool> known;                ///< one a number: none of the directions moves it
  /// Covariance of the numbers in the units of the Jacobian's columns, with the `held` ones held; zero in
  /// their rows.
  Eigen::MatrixXd covariance;

  /// Whether number k is determined; true where the rank was not asked.
  [[nodiscard]] bool is_known(std::size_t k) const { return k >= known.size() || known[k]; }
  /// Makes number k the held one of another null direction: `others` move with it, and what is correlated
  /// with it by 0.3 and more, by `change` over it, in the units of the columns. jacobian: the one that was
  /// asked.
  void add_direction(std::size_t k, const std::vector<std::size_t>& others, const Eigen::VectorXd& change,
                     const Eigen::MatrixXd& jacobian);
};

/// Decides about a direction d (in the units of the Jacobian's columns) that the errors of the derivatives
/// leave in doubt: whether chi2 stays where it is along it, as stays_along() has it for a step that should
/// change the residual by `doubtful_change`; none where the check is not conclusive.
using NullCheck = std::function<std::optional<bool>(const Eigen::VectorXd& direction)>;

/// Change of the residual [-] that a direction in doubt promises with the step of its check, five standard
/// errors.
inline constexpr double doubtful_change = 5.0;

/// Whether a rise of chi2 [-] by a step that should change the residual by `change` [-] is that of a null
/// direction: below 1 + change^2 / 5.
[[nodiscard]] constexpr bool is_no_rise(double rise, double change) {
  return rise < 1.0 + change * change / 5.0;
}

/// Rank of the scaled Jacobian at the answer of a fit.                                       theory.md (I.32)
///   J v, |columns of J| = 1: a singular direction v is null where |J v| <= 3 |E v| + floor
/// jacobian: of the whitened residual [-], a column a number; error: of its entries, as the difference of the
/// derivatives by two step sizes (same shape; empty: exact derivatives). check: asked where |E v| > 0.001
/// (without a check such directions are null) and where 3 |E v| < |J v| <= 300 |E v|, |J v| < 0.1 (without
/// one these are seen). A column below its own error is a direction of its own, of which `check` is asked,
/// too.
[[nodiscard]] Identifiability identifiability_of(const Eigen::MatrixXd& jacobian,
                                                 const Eigen::MatrixXd& error, const NullCheck& check = {});

/// How a number moves along a null direction, for a sentence.
struct NamedChange {
  std::string key, unit;
  double change = 0.0;    ///< relative: power by which it scales; else of its value, in its unit
  bool relative = false;  ///< it scales
};

/// "a, b and c scale together, in the powers 1, 1 and -1: no reading changes". changes: not empty.
[[nodiscard]] std::string null_words(const std::vector<NamedChange>& changes);

}  // namespace snare::identification
