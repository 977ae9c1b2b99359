#include "study/rank_journal.hpp"

#include "base/errors.hpp"

#include <fmt/format.h>

#include <optional>
#include <system_error>
#include <vector>

namespace snare::study {

namespace fs = std::filesystem;

fs::path rank_journal(const fs::path& journal, int rank) {
  return journal.parent_path() /
         fmt::format("{}.rank{}{}", journal.stem().string(), rank, journal.extension().string());
}

void take_rank_journals(Journal& journal, const std::string& identity, std::uint64_t count) {
  const std::string before = journal.file().stem().string() + ".rank",
                    after = journal.file().extension().string();
  std::vector<fs::path> found;
  std::error_code code;
  const fs::path folder = journal.file().parent_path();
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, code)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(before) && name.ends_with(after)) found.push_back(entry.path());
  }
  for (const fs::path& file : found) {
    try {
      const Journal ended(file, identity, count);
      for (std::uint64_t index = 0; index < ended.end(); ++index) {
        if (const std::optional<std::string> result = ended.result(index)) journal.append(index, *result);
      }
    } catch (const base::InputError&) {
      continue;  // the rank is still there, or the file belongs to another study
    }
    fs::remove(file, code);
  }
}

}  // namespace snare::study
