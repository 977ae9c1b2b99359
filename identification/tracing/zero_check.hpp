#pragma once

#include "identification/fitting/least_squares.hpp"

#include <optional>
#include <string>

namespace snare::identification {

/// What a zero of the travel, fitted beside a model that has none, would be and do.
struct ZeroCheck {
  double offset = 0.0;  ///< recorded displacement at the first touch [mm]
  double lower = 0.0;   ///< of its 95 % interval [mm]
  double upper = 0.0;   ///< [mm]
  double p = 1.0;       ///< that readings without one ask for as large a one
  std::string key;      ///< the fitted number that it moves most, as a share of it; empty: none has a size
  std::string unit;
  double without = 0.0;   ///< that number as the model has it, in its unit
  double with = 0.0;      ///< and beside a fitted zero
  bool doubtful = false;  ///< the readings ask for it, and it moves that number by more than a twentieth
};

/// Asks for a zero of the travel beside a fit that has none. Where the touch is cannot be seen in a first
/// reading: a force of nothing may be one of before it. The error that a wrong zero leaves may be far smaller
/// than what is worth a name, since the stiffnesses take it up; they are then wrong.         theory.md (I.12)
/// None where the fit has a zero, of published fits, and where one number more would leave no degree of
/// freedom.
[[nodiscard]] std::optional<ZeroCheck> check_zero(const Model& model, const Data& data, const Fit& fit);

}  // namespace snare::identification
