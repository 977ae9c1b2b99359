#pragma once

#include "identification/fitting/parameter.hpp"

#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace snare::identification {

/// The numbers that a fit may change, by their keys. Who fits gives the set (the catalogue's is
/// parameters()). A number is known by its address: the set keeps every address for its own life.
class ParameterSet {
 public:
  /// Numbers with different keys, in the order in which messages list them; they must outlive the set.
  explicit ParameterSet(std::vector<const Parameter*> all);

  /// Keys of the numbers of all series.
  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }

  /// Null when there is none of this key. "series[NAME].KEY" is the number KEY of one series alone.
  [[nodiscard]] const Parameter* find(std::string_view key) const;

  /// Throws base::InputError, as for fit.free, when there is none.
  [[nodiscard]] const Parameter& at(const std::string& key) const;

 private:
  [[nodiscard]] const Parameter* find_common(std::string_view key) const;

  std::vector<const Parameter*> all_;
  std::vector<std::string> keys_;
  mutable std::mutex guard_;
  mutable std::deque<Parameter> own_;  // numbers of single series, made when first asked for
};

}  // namespace snare::identification
