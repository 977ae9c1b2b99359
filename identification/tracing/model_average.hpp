#pragma once

#include "identification/tracing/round.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace snare::identification {

/// A normal distribution of one number with its weight among others.
struct NormalPart {
  double weight = 0.0;     ///< > 0 [-]; the parts' need not add up to one
  double mean = 0.0;       ///< in the number's unit
  double deviation = 0.0;  ///< > 0, in the number's unit
};

/// Where the distribution function of a mixture is p, in (0, 1), in the unit of its parts, of which there is
/// at least one; to 1e-9 of their breadth.
[[nodiscard]] double mixture_quantile(const std::vector<NormalPart>& parts, double p);

/// Ends of an interval of a number, in its coordinate.
using Interval = std::pair<double, double>;

/// The 95 % interval of a fitted number whichever effect of a class is the right one: quantiles of the
/// mixture of the normal distributions that the rivals of every round give it.               theory.md (I.13)
/// final: the model that is told; which: of its fitted settings, from 0. rounds: in which its effects were
/// added.
/// inflation: chi2 that it leaves over that of noise, >= 1 [-]. Absent where the readings do not tell the
/// number or no rival has it.
[[nodiscard]] std::optional<Interval> interval_over_rivals(const Fit& final, std::size_t which,
                                                           const std::vector<RoundFits>& rounds,
                                                           double inflation);

/// Likewise of a model beside which no effect was named, whether one is missing or not: its own distribution
/// and, to first order, those with every effect that was asked for.                          theory.md (I.13)
[[nodiscard]] std::optional<Interval> interval_over_candidates(const Fit& final, std::size_t which,
                                                               const std::vector<Candidate>& candidates);

}  // namespace snare::identification
