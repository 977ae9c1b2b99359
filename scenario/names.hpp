#pragma once

#include "base/plain_name.hpp"
#include "base/toml_reader.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace snare::scenario {

/// Names of one kind of things in a file, each once, with their indices.
class Names {
 public:
  explicit Names(std::string what) : what_(std::move(what)) {}

  /// The next index under the name of a table; a name that is taken is reported.
  std::string take(const base::TomlTable& table) {
    std::string name = table.text("name");
    const std::string scope = table.scope();
    const std::size_t own = scope.empty() || name.empty() ? 0 : scope.size() + 2;
    if (name.find("::", own) != std::string::npos)
      table.fail("name", "must not have \"::\", which parts names of what belongs together");
    else
      base::require_plain_name(table, "name", std::string_view(name).substr(own));
    if (!add(name)) table.fail("name", fmt::format("is taken by another {}", what_));
    return name;
  }
  /// The same of a name that something brings with it; false: it is taken.
  bool add(const std::string& name) {
    if (!index_.try_emplace(name, static_cast<int>(index_.size())).second) return false;
    list_ += fmt::format("{}\"{}\"", list_.empty() ? "" : ", ", name);
    return true;
  }
  [[nodiscard]] std::optional<int> find(const std::string& name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? std::nullopt : std::optional(found->second);
  }
  [[nodiscard]] std::string requirement() const {
    if (list_.empty()) return fmt::format("must be the name of a {}; there is none", what_);
    return fmt::format("must be the name of a {}: {}", what_, list_);
  }

 private:
  std::string what_, list_;
  std::map<std::string, int> index_;
};

}  // namespace snare::scenario
