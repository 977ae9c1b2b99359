#pragma once

#include "identification/tracing/channels.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// An unknown function put into one channel to see whether it would explain what the catalogue does not.
struct ChannelFunction {
  Channel channel{};
  std::string argument;           ///< what it is a function of, with unit: "travel [mm]"
  std::string effect;             ///< what it does: "adds to the recorded force [N]"
  std::string constant;           ///< key of the number that it is without slope; empty: none
  std::vector<double> at;         ///< stations of the argument, in its unit
  std::vector<double> value;      ///< of the function there, in the unit of `effect`
  std::vector<double> deviation;  ///< standard deviation of the values
  /// Share of the excess of chi2 that functions found without a group of series explain.
  double carried_over = 0.0;
  ///< in that group (cross-validation by position and by slack); <= 1, may be
  ///< negative; 0 where there is one of each: then channels cannot be told
  double explained = 0.0;  ///< share of the excess of chi2 that the function explains in all series
  double chi2 = 0.0;       ///< with the function, all series, to first order
  double chi2_dof = 0.0;   ///< the same over its degrees of freedom
  bool accepted = false;   ///< carries over: more than 70 % of the excess
  std::string shape;       ///< in words
};

/// Where a residual comes from: every channel's function by regularised least squares on the derivatives of
/// the model (second differences penalised, weight by cross-validation, numbers of the fit free), best first.
///                                                                                            theory.md (I.6)
[[nodiscard]] std::vector<ChannelFunction> attribute(const Model& model, const Data& data,
                                                     const Fit& current);

}  // namespace snare::identification
