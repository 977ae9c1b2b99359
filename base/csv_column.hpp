#pragma once

#include "base/range.hpp"

#include <string>

namespace snare::base {

/// A column that is looked for in a CSV file, and what its cells may be.
struct CsvColumn {
  enum class Presence { required, optional };
  enum class Order { any, non_decreasing };

  std::string name;  ///< as in the header
  Presence presence = Presence::required;
  Range range = Range::finite();  ///< in the file's unit
  double unit = 1.0;              ///< SI units in one unit of the file, 1e-3 for mm
  Order order = Order::any;
  /// Name with a unit that the data have where they are used, "force_N", of a column that the file which
  /// names this one may rename by `columns = {...}` and scale by `scale = {...}`: messages then say how.
  /// Empty: it cannot be renamed.
  std::string meaning = {};
  /// a scale is declared: units that the file gives are not compared with that of the meaning.
  bool scaled = false;
};

}  // namespace snare::base
