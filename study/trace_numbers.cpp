#include "study/trace_numbers.hpp"

#include "base/errors.hpp"
#include "base/files.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace snare::study {

namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::filesystem::path& file, std::string key, std::string requirement) {
  throw base::InputError({file.string(), 0, std::move(key), "", std::move(requirement)});
}

}  // namespace

double TraceNumbers::correlation_of(const std::string& one, const std::string& other) const {
  const auto i = std::ranges::find(keys, one) - keys.begin();
  const auto j = std::ranges::find(keys, other) - keys.begin();
  return i < correlation.rows() && j < correlation.rows() ? correlation(i, j) : 0.0;
}

TraceNumbers read_trace_numbers(const std::filesystem::path& file) {
  const json whole = json::parse(base::read_text(file, std::size_t{64} << 20u), nullptr, false);
  if (!whole.is_object())
    refuse(file, "", "is no JSON object; must be what snare trace or snare fit has written");
  const std::string schema =
      whole.contains("schema") && whole["schema"].is_string() ? whole["schema"].get<std::string>() : "";
  const char* const part = schema == "snare-trace/1" ? "final" : schema == "snare-fit/1" ? "fit" : nullptr;
  if (part == nullptr) refuse(file, "schema", "must be \"snare-trace/1\" or \"snare-fit/1\"");
  if (!whole.contains(part) || !whole[part].is_object() || !whole[part].contains("parameters") ||
      !whole[part]["parameters"].is_object())
    refuse(file, std::string(part) + ".parameters", "is missing");
  TraceNumbers numbers;
  std::vector<double> errors;
  for (const auto& [key, number] : whole[part]["parameters"].items()) {
    if (!number.is_object() || !number.contains("value") || !number["value"].is_number()) continue;
    if (!number.contains("stderr") || !number["stderr"].is_number() ||
        !(number["stderr"].get<double>() > 0.0))
      continue;
    numbers.keys.push_back(key);
    numbers.values.push_back(number["value"].get<double>());
    numbers.errors.push_back(number["stderr"].get<double>());
  }
  if (!whole[part].contains("correlation") || !whole[part]["correlation"].is_object()) return numbers;
  const json& table = whole[part]["correlation"];  // KEY: {KEY: r}
  const auto n = static_cast<Eigen::Index>(numbers.keys.size());
  numbers.correlation = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const std::string& one = numbers.keys[static_cast<std::size_t>(i)];
      const std::string& other = numbers.keys[static_cast<std::size_t>(j)];
      if (i == j || !table.contains(one) || !table[one].is_object() || !table[one].contains(other)) continue;
      const json& r = table[one][other];
      if (!r.is_number() || !(std::abs(r.get<double>()) < 1.0))
        refuse(file, std::string(part) + ".correlation", "must be between -1 and 1");
      numbers.correlation(i, j) = r.get<double>();
    }
  }
  return numbers;
}

}  // namespace snare::study
