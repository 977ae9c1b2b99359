#pragma once

#include "identification/records/record_fit.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// Where a number is held, and how much worse the others, fitted again, leave it.
struct ProfilePoint {
  double value = 0.0;  ///< in the unit of its key
  /// Of the sum of squares over its variance by noise alone: of one degree of freedom, >= 0 [-].
  double rise = 0.0;
};

/// What a profile ended at on one side.
enum class ProfileEnd {
  crossed,       ///< the rise of 95 %: the interval ends there
  bound,         ///< the number's own bound, before that
  open,          ///< no end was found within `most_points`: the records do not close the interval
  not_simulated  ///< beyond it the scenario cannot be simulated
};

/// One side of a profile.
struct ProfileSide {
  /// Of 95 %, in the unit of the key; absent unless it was crossed or is a bound.
  std::optional<double> limit;
  ProfileEnd end = ProfileEnd::open;
};

/// Profile likelihood of one fitted number.                                                  theory.md (I.27)
struct Profile {
  std::string key, unit;
  double value = 0.0;  ///< of the fit, in the unit of the key
  ProfileSide lower, upper;
  std::vector<ProfilePoint> points;  ///< ascending in their values, that of the fit among them
  /// Largest below the fit that was met on the way, as `rise`: > 0, the fit was not the minimum.
  double fall = 0.0;
  long simulations = 0;
};

/// Rise at which 95 % are reached, of one degree of freedom.
inline constexpr double profile_rise_95 = 3.841458820694124;

/// Along one number of a fit, outward to both sides: it is held and all others are fitted again, from where
/// they were at the point before. The rise is told in units of g' Sigma g / g' g, the variance that residuals
/// that hang together give it (g: the number's column, those of the others taken out). In a linear model the
/// interval is that of the covariance. number: index in fit.settings. The fit must have its jacobian.
[[nodiscard]] Profile profile_of(const RecordModel& model, const RecordData& data, const RecordFit& fit,
                                 std::size_t number, const RecordFitOptions& options = {});

}  // namespace snare::identification
