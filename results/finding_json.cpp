#include "results/finding_json.hpp"

#include "results/finite_json.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>

namespace snare::results {

using nlohmann::json;

json findings_json(const std::vector<identification::Finding>& findings) {
  json result = json::array();
  for (const identification::Finding& f : findings) {
    result.push_back({{"kind", to_string(f.kind)},
                      {"key", f.key},
                      {"value", finite(f.value)},
                      {"limit", finite(f.limit)},
                      {"unit", f.unit},
                      {"sure", f.sure},
                      {"what", f.what}});
  }
  return result;
}

json bound_json(identification::AtBound bound) {
  static constexpr const char* names[] = {"none", "lower", "upper"};
  return names[static_cast<std::size_t>(bound)];
}

}  // namespace snare::results
