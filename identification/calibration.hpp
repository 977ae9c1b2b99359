#pragma once

#include "identification/experiment.hpp"
#include "identification/prediction.hpp"
#include "numerics/report.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// One number that a calibration may change, by its key in the experiment file.
struct FreeParameter {
  std::string key;   ///< dotted, with its unit: "wire.length_mm"
  std::string unit;  ///< as printed: "mm"; empty for a pure number
  double value = 0.0;  ///< in that unit
  double lower = 0.0;  ///< admissible range, in that unit
  double upper = 0.0;
  std::optional<double> standard_error;  ///< from the curvature of the misfit at the optimum, in that unit
};

/// Description of a key at its declared value: unit and admissible range. Throws InputError for a key that no
/// calibration can change.
[[nodiscard]] FreeParameter declared_parameter(const Experiment& experiment, const std::string& key);

/// Puts a value (in the key's unit) into the series' models or into the reading model.
void apply_parameter(const std::string& key, double value, std::vector<Series>& series, ReadingModel& reading);

struct Calibration {
  std::vector<FreeParameter> parameters;
  std::vector<Prediction> predictions;  ///< of every series at the optimum
  ReadingModel reading;
  Misfit misfit;           ///< over all fitted series together
  int evaluations = 0;     ///< predictions of the whole experiment
  numerics::SolveReport report;
};

struct CalibrationOptions {
  int max_iterations = 100;
  std::function<bool(int iteration, double rmse)> progress;  ///< false stops the fit
};

/// Least squares of the measured forces of all series together (unweighted, bounded Levenberg-Marquardt of Ceres,
/// central differences), started from the declared values and from a nearly straight wire, the better kept.
/// `keys` default to the experiment's own. Every series must have readings or a law.   theory.md (I.1)
[[nodiscard]] Calibration calibrate(const Experiment& experiment, const std::vector<std::string>& keys,
                                    const CalibrationOptions& options = {});

}  // namespace snare::identification
