#pragma once

#include "identification/effects/effect.hpp"
#include "identification/tracing/progress.hpp"

#include <vector>

namespace snare::identification {

/// Where a refit with an effect begins, and how near it comes in a few steps.
struct SearchedStart {
  std::vector<Setting> settings;  ///< the fitted numbers, then those of the effect
  double chi2 = 0.0;              ///< reached in a few steps, about as the model itself has it
};

/// Starts for refits that do not hang on the fit from which they begin. A score asks how the curves change at null, beside numbers
/// that a missing effect may have led far astray; here every effect begins at finite sizes, beside the fitted numbers as they are, as
/// they were declared and as the section has them, and takes a few steps on a coarse mesh, whose own error at the fit is
/// taken off.                                                                                 theory.md (I.34)
class StartSearch {
 public:
  StartSearch(const Model& model, const Data& data, const Fit& current);

  /// The best start of an effect; none where it could not be computed from any. rival: chi2 [-] to come near to, 0: none.
  [[nodiscard]] std::optional<SearchedStart> best(const Effect& effect, double rival, Progress& progress) const;

 private:
  /// Values of the fitted numbers, and how the curves change by them there.
  struct Beside {
    std::vector<Setting> settings;
    Eigen::MatrixXd jacobian, covariance;
  };

  [[nodiscard]] std::vector<std::vector<double>> sizes(const Effect& effect) const;
  [[nodiscard]] std::optional<SearchedStart> stepped(const Beside& beside, const Effect& effect,
                                                     const std::vector<double>& size) const;

  Model coarse_;
  Data data_;  // less the error of the coarse mesh
  TrialContext context_;
  std::vector<Beside> beside_;
  double readings_ = 1.0;  // for one of those that are used
};

/// Numbers of a fit as they were declared, in place of where they are.
[[nodiscard]] std::vector<Setting> as_declared(std::vector<Setting> settings);

/// The stiffnesses among the settings those of the declared section, E I and E A; empty where they are so already, are not
/// among them, or no modulus is declared.
[[nodiscard]] std::vector<Setting> as_the_section_has(const Model& model, std::vector<Setting> settings);

}  // namespace snare::identification
