#include "identification/fitting/parameter_set.hpp"

#include "base/errors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace snare::identification {

ParameterSet::ParameterSet(std::vector<const Parameter*> all) : all_(std::move(all)) {
  for (const Parameter* p : all_) keys_.push_back(p->key);
}

const Parameter* ParameterSet::find_common(std::string_view key) const {
  const auto found =
      std::find_if(all_.begin(), all_.end(), [key](const Parameter* p) { return p->key == key; });
  return found == all_.end() ? nullptr : *found;
}

const Parameter* ParameterSet::find(std::string_view key) const {
  if (const Parameter* common = find_common(key)) return common;
  constexpr std::string_view prefix = "series[";
  const std::size_t end = key.find("].");
  if (!key.starts_with(prefix) || end == std::string_view::npos) return nullptr;
  const std::lock_guard lock(guard_);
  const auto known =
      std::find_if(own_.begin(), own_.end(), [key](const Parameter& p) { return p.key == key; });
  if (known != own_.end()) return &*known;
  const Parameter* of_all = find_common(key.substr(end + 2));
  if (of_all == nullptr) return nullptr;
  Parameter& own = own_.emplace_back(*of_all);
  own.key = key;
  own.only = key.substr(prefix.size(), end - prefix.size());
  return &own;
}

const Parameter& ParameterSet::at(const std::string& key) const {
  if (const Parameter* found = find(key)) return *found;
  throw base::InputError({"", 0, "fit.free", fmt::format("\"{}\"", key),
                          fmt::format("must be one of {}", fmt::join(keys_, ", "))});
}

}  // namespace snare::identification
