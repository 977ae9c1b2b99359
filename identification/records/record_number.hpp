#pragma once

#include "base/toml_tree.hpp"
#include "identification/records/declared_scenario.hpp"

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// How a sensor's reading differs from what the scenario's sensor tells s:                   theory.md (I.23)
///   y(t) = gain (s * h)(t - delay) + bias + drift t,
///     h the low-pass filter of the first order of time `lag`.
struct SignalChange {
  double gain = 1.0;   ///< [-]
  double bias = 0.0;   ///< in the unit of the channel
  double drift = 0.0;  ///< in the unit of the channel, a second
  double delay = 0.0;  ///< [s], may be negative
  double lag = 0.0;    ///< [s], >= 0
};

/// Changes of all channels, by the sensors' columns; "" stands for all.
using SignalChanges = std::map<std::string, SignalChange>;

/// A number that a fit of records may change, in the unit of its key.
struct RecordNumber {
  std::string key;   ///< as results show it
  std::string unit;  ///< as results show it; empty for a pure number
  double declared = 0.0;
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
  double scale = 1.0;  ///< a change of this size is small and can be seen, > 0
  /// Steps of differences are those of the value where it is larger than declared.
  bool scale_follows = false;
  std::optional<std::size_t> record;  ///< the one to which it belongs; none: all
  /// Keys of the scenario with this value, in a record where numbers stand as `record` says: as it declares
  /// them, or as those before this one set them. Either this or `signal`.
  std::function<std::vector<base::Override>(double value, const StandingNumbers& record)> overrides;
  std::function<void(SignalChanges&, double value)> signal;
  /// key of the number above which the first of `overrides` is counted: that number as it stands is
  /// added; empty: none
  std::string above;
};

/// A number, of any unit, as text that reads back to the same double.
[[nodiscard]] std::string exact_text(double value);

/// The number under a key of the scenario or of an arm's file, the same in all records; `declared` in the
/// unit of the key.
[[nodiscard]] RecordNumber keyed_number(const std::string& key, double declared);

/// "mm", "N m/rad", ... of a key that ends in its unit; empty: a pure number.
[[nodiscard]] std::string unit_of_key(const std::string& key);

}  // namespace snare::identification
