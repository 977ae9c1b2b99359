#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace snare::validation {

/// Value of a row whose computation did not arrive: out of every limit.
inline constexpr double not_computed = std::numeric_limits<double>::quiet_NaN();

enum class ErrorKind { relative, absolute };

/// One comparison with a reference that was not computed by the code under test.
struct Row {
  std::string group;
  std::string name;
  std::string unit;    ///< of reference and value; empty for a pure number
  std::string source;  ///< of the reference
  double reference = 0.0;
  double value = 0.0;  ///< in the unit
  ErrorKind kind = ErrorKind::relative;
  double limit = 0.0;  ///< of the error, > 0, in the unit or, of a relative error, [-]

  /// |value - reference|, over |reference| for a relative error. A value that is not finite is out of every limit.
  [[nodiscard]] double error() const;
  [[nodiscard]] bool within() const { return error() <= limit; }
};

/// A named piece of work that yields rows.
struct Check {
  std::string name;
  std::function<std::vector<Row>()> run;
  std::string skipped = {};  ///< why it cannot be run here; empty when it can
};

}  // namespace snare::validation
