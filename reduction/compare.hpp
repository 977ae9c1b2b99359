#pragma once

#include "reduction/distil.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace snare::reduction {

/// A law that somebody else gives for a wire, beside the full wire and what is distilled from it.
struct GivenLaw {
  std::string name;
  int parameters = 0;
  Interval range;  ///< of the travel [m]
  std::function<double(double)> force;
};

/// One push on which the models are compared.
struct StaticCase {
  std::string name;
  WireCase wire;  ///< one position (law_positions.front()), the nominal slack, travel to the largest
  std::vector<double> travel;    ///< in the order visited [m]
  std::vector<double> measured;  ///< force at these travels [N]; empty: none
  std::vector<GivenLaw> given;
};

/// How one model does in one case.
struct ModelResult {
  std::string model;
  int parameters = 0;
  Interval range;                      ///< of the travel for which it is made [m]
  double largest_error = 0.0;          ///< against the full wire within the model's range [N]
  double rms_error = 0.0;              ///< [N]
  std::optional<double> measured_rms;  ///< against the measured force [N]
  double seconds = 0.0;                ///< an evaluation: wall clock, one thread [s]
  std::vector<double> force;           ///< at the case's travels [N]
  std::string why;                     ///< it is far off; see error_reason.hpp
};

/// A case with how every model does in it.
struct CaseComparison {
  std::string name;
  std::vector<double> travel, measured;  ///< as given [m, N]
  double force_range = 0.0;              ///< of the full wire [N]
  std::vector<ModelResult> models;       ///< the full wire first
  numerics::SolveReport report;          ///< not usable: the full wire did not reach the end; no models then
};

/// Runs the full wire, the table of its curve and every law fitted to it, and the given laws, over the
/// travels of a case.
[[nodiscard]] CaseComparison compare_static(const StaticCase& one, const DistilSettings& settings);

}  // namespace snare::reduction
