#pragma once

#include "validation/suite.hpp"

#include <filesystem>
#include <vector>

namespace snare::validation {

/// Captures by snares: the ring's closed form, rigidizing, the shipped capture against finer tolerances and
/// meshes, conservation in all that are shipped. Takes half a minute.
[[nodiscard]] std::vector<Check> capture_checks(const std::filesystem::path& data);

/// Rows of `capture_checks`.
[[nodiscard]] std::vector<Row> tight_ring_rows(const std::filesystem::path& data);
[[nodiscard]] std::vector<Row> rigidizing_rows(const std::filesystem::path& data);
[[nodiscard]] std::vector<Row> snare_capture_rows(const std::filesystem::path& data);
[[nodiscard]] std::vector<Row> refined_capture_rows(const std::filesystem::path& data);
[[nodiscard]] std::vector<Row> payload_rows(const std::filesystem::path& data);
[[nodiscard]] std::vector<Row> visitor_rows(const std::filesystem::path& data);

}  // namespace snare::validation
