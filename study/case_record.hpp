#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snare::study {

/// What is kept of a case that was run.
struct CaseRecord {
  /// "done", or why there are no values: "failed", "refused", "stalled", "broken", "lost".
  std::string status;
  std::string reason;  ///< where it is not done
  double seconds = 0.0;
  /// One a collected field: number, boolean, text or null; none where it is not done.
  std::vector<nlohmann::json> fields;
  std::vector<double> values;  ///< of the variables, where the design does not say them

  [[nodiscard]] bool done() const noexcept { return status == "done"; }  ///< the case has a result
  /// It was not run, but lies between others that agree; in no journal.
  [[nodiscard]] bool inferred() const noexcept { return status == inferred_status; }
  static constexpr const char* inferred_status = "inferred";  ///< the status of such a case
  /// A field as a number, a boolean as 0 or 1; nothing where it is neither.
  [[nodiscard]] std::optional<double> number(std::size_t field) const;
};

/// One line, and back; nothing where it is none of ours.
[[nodiscard]] std::string line_of(const CaseRecord& record);
[[nodiscard]] std::optional<CaseRecord> record_of(std::string_view line);

}  // namespace snare::study
