#pragma once

#include "validation/suite.hpp"

#include <filesystem>
#include <vector>

namespace snare::validation {

/// The ring of a snare by a joint and by mounts that run its course; the bench with hardware in the loop; a
/// shaft that wires hold for two minutes; the constraint test at half and at full scale.
[[nodiscard]] std::vector<Check> snare_checks(const std::filesystem::path& data);

/// Rows of `snare_checks`. model: "stretched" or "quasi_static".
[[nodiscard]] std::vector<Row> ring_two_ways_rows(const std::filesystem::path& data,
                                                  const std::string& model);
[[nodiscard]] std::vector<Row> held_shaft_rows(const std::filesystem::path& data);
[[nodiscard]] std::vector<Row> constraint_test_rows(const std::filesystem::path& data);
[[nodiscard]] std::vector<Row> bench_rows(const std::filesystem::path& data);

}  // namespace snare::validation
