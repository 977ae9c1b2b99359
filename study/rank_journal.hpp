#pragma once

#include "study/journal.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace snare::study {

/// File for the journal of a rank other than the first: "cases.rank1.journal" beside "cases.journal". It gets
/// the cases that end the process of the rank by a fault, of which the first rank cannot be told otherwise.
[[nodiscard]] std::filesystem::path rank_journal(const std::filesystem::path& journal, int rank);

/// Moves the cases of the journals of ranks that have ended into `journal`. identity, count: of the study, as
/// of Journal.
void take_rank_journals(Journal& journal, const std::string& identity, std::uint64_t count);

}  // namespace snare::study
