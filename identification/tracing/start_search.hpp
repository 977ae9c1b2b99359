#pragma once

#include "identification/effects/effect.hpp"
#include "identification/tracing/progress.hpp"

#include <vector>

namespace snare::identification {

/// A start of a refit with an effect, and the chi2 that a few steps from it reached.
struct SearchedStart {
  std::vector<Setting> settings;  ///< the fitted numbers, then those of the effect
  double chi2 = 0.0;              ///< [-], on a coarse mesh, close to that of the model itself
};

/// Starts of refits that do not depend on the fit that precedes them. A score measures the change of the
/// curves at null, at numbers that a missing effect may have distorted. Here every effect starts from finite
/// sizes, with the fitted numbers of the fit, as declared and of the section, and takes a few steps on a
/// coarse mesh whose error at the fit is subtracted.
///                                                                                           theory.md (I.34)
class StartSearch {
 public:
  StartSearch(const Model& model, const Data& data, const Fit& current);

  /// The best start of an effect; none where it could not be computed from any. rival: chi2 [-] to come near
  /// to, 0: none.
  [[nodiscard]] std::optional<SearchedStart> best(const Effect& effect, double rival,
                                                  Progress& progress) const;

 private:
  /// Values of the fitted numbers, with the derivatives of the residual there.
  struct Beside {
    std::vector<Setting> settings;
    double chi2 = 0.0;  // without an effect
    Eigen::MatrixXd jacobian, covariance;
  };

  /// kept: which readings of every series are used.
  StartSearch(const Model& model, const Data& data, const Fit& current,
              const std::vector<std::vector<std::size_t>>& kept);

  [[nodiscard]] std::vector<std::vector<double>> sizes(const Effect& effect) const;
  [[nodiscard]] std::optional<SearchedStart> stepped(const Beside& beside, const Effect& effect,
                                                     const std::vector<double>& size) const;

  Model coarse_;
  Data data_;  // less the error of the coarse mesh
  TrialContext context_;
  std::vector<Beside> beside_;
  double readings_ = 1.0;  // for one of those that are used
};

/// The settings of a fit at their declared values.
[[nodiscard]] std::vector<Setting> as_declared(std::vector<Setting> settings);

/// The settings with EI and EA of the declared section; empty where they have these values already, where
/// neither is among them, or where no modulus is declared.
[[nodiscard]] std::vector<Setting> as_the_section_has(const Model& model, std::vector<Setting> settings);

}  // namespace snare::identification
