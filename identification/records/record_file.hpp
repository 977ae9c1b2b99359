#pragma once

#include "identification/records/record_set.hpp"

#include <filesystem>
#include <vector>

namespace snare::identification {

inline constexpr const char* record_schema = "snare-record/1";

/// Whether a file says that it is one of records.
[[nodiscard]] bool is_record_file(const std::filesystem::path& file,
                                  const std::vector<base::Override>& overrides);

/// Reads a record file and its CSV files. Throws InputError with everything that is wrong: keys, columns,
/// times that do not ascend, gaps, values that are not numbers, records that are constant, saturated or too
/// short.
[[nodiscard]] RecordSet read_records(const std::filesystem::path& file,
                                     const std::vector<base::Override>& overrides = {});

}  // namespace snare::identification
