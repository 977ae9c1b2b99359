#pragma once

#include "base/errors.hpp"
#include "base/toml_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace snare::test {

/// What the InputError says that f() throws; "accepted" where it throws none.
template <class F>
[[nodiscard]] std::string refusal(const F& f) {
  try {
    (void)f();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// A wrong setting, and words that the message about it must have.
using WrongSetting = std::pair<const char*, const char*>;

/// read(setting) refuses every one of them.
template <class Read>
void expect_refused(std::span<const WrongSetting> wrong, const Read& read) {
  for (const WrongSetting& w : wrong) {
    EXPECT_THAT(refusal([&] { return read(w.first); }), testing::HasSubstr(w.second)) << w.first;
  }
}

/// As --set gives them.
[[nodiscard]] inline std::vector<base::Override> overrides(const std::vector<std::string>& settings) {
  std::vector<base::Override> all;
  all.reserve(settings.size());
  for (const std::string& s : settings) all.push_back(base::parse_override(s));
  return all;
}

}  // namespace snare::test
