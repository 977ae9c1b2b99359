#include "study/case_record.hpp"

#include <utility>

namespace snare::study {

using nlohmann::json;

std::optional<double> CaseRecord::number(std::size_t field) const {
  if (field >= fields.size()) return std::nullopt;
  const json& one = fields[field];
  if (one.is_boolean()) return one.get<bool>() ? 1.0 : 0.0;
  return one.is_number() ? std::optional(one.get<double>()) : std::nullopt;
}

std::string line_of(const CaseRecord& record) {
  json line = json::array({record.status, record.reason, record.seconds, record.fields});
  if (!record.values.empty()) line.push_back(record.values);
  return line.dump(-1, ' ', true, json::error_handler_t::replace);
}

std::optional<CaseRecord> record_of(std::string_view line) {
  constexpr std::size_t least = 4;
  const json all = json::parse(line, nullptr, false);
  if (!all.is_array() || all.size() < least || !all[0].is_string() || !all[1].is_string() ||
      !all[2].is_number() || !all[3].is_array())
    return std::nullopt;
  CaseRecord record{all[0], all[1], all[2], all[3].get<std::vector<json>>(), {}};
  if (all.size() == least) return record;
  if (!all[least].is_array()) return std::nullopt;
  for (const json& x : all[least]) {
    if (!x.is_number()) return std::nullopt;
    record.values.push_back(x);
  }
  return record;
}

}  // namespace snare::study
