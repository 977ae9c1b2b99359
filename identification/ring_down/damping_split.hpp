#pragma once

#include "identification/ring_down/estimate.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace snare::identification {

/// One decay rate for the split: 2 s = mass_rate + bending_time share w^2.                    theory.md (M.4)
struct DecayOfMode {
  double natural = 0.0;  ///< w [rad/s], > 0
  double bending_share =
      1.0;         ///< of the mode's stiffness that bends material: 1 for a straight wire without tension
  Estimate decay;  ///< s [1/s]
};

/// Material and mass-proportional damping from decay rates.                                  theory.md (I.10)
struct DampingSplit {
  bool separated = false;    ///< two frequencies far enough apart
  Estimate bending_time;     ///< [s]; not separated: the value if all were material
  Estimate mass_rate;        ///< [1/s]; not separated: the value if all were mass-proportional
  double correlation = 0.0;  ///< of the two estimates [-]
  /// P of a chi-square as large as that of the best line without negative damping, of misfit_dof degrees of
  /// freedom [-].
  double misfit_p = 1.0;
  int misfit_dof = 0;  ///< decays less the numbers that are not zero; 0: nothing to test, and misfit_p is 1
  std::string statement;              ///< in words: what is known and what is not
  std::vector<std::string> warnings;  ///< what must not be relied on
  /// The decays follow the damping law; where they do not, the intervals above contain the scatter about it.
  [[nodiscard]] bool consistent() const { return misfit_p >= 0.01; }
};

/// Weighted least squares of the two numbers. covariance: of the decays s [1/s^2], symmetric, positive; the
/// first form takes them for independent. Decays that contradict the law give intervals widened by their
/// scatter about it, and a warning.
[[nodiscard]] DampingSplit split_damping(const std::vector<DecayOfMode>& decays);
[[nodiscard]] DampingSplit split_damping(const std::vector<DecayOfMode>& decays,
                                         const Eigen::MatrixXd& covariance);

}  // namespace snare::identification
