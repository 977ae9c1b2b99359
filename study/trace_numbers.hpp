#pragma once

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <vector>

namespace snare::study {

/// Fitted numbers of a trace with their standard errors, in the units of their keys.
struct TraceNumbers {
  std::vector<std::string> keys;
  std::vector<double> values;
  std::vector<double> errors;   ///< standard deviations, > 0
  Eigen::MatrixXd correlation;  ///< of all of them; no rows where the trace does not say

  /// Correlation coefficient of two numbers [-]; 0 where the trace does not say. Expects known keys.
  [[nodiscard]] double correlation_of(const std::string& one, const std::string& other) const;
};

/// Reads `final` of a trace.json, or `fit` of a fit.json: numbers that have a standard error. Throws
/// base::InputError.
[[nodiscard]] TraceNumbers read_trace_numbers(const std::filesystem::path& file);

}  // namespace snare::study
