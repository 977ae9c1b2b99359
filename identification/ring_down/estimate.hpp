#pragma once

namespace snare::identification {

/// A number with its standard error; the 95 % interval is value -+ 1.96 error.
struct Estimate {
  double value = 0.0;
  double error = 0.0;  ///< standard error, >= 0; infinite where the readings do not determine the number
  [[nodiscard]] double lower() const { return value - 1.959963984540054 * error; }
  [[nodiscard]] double upper() const { return value + 1.959963984540054 * error; }
};

}  // namespace snare::identification
