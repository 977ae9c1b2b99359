#pragma once

#include "base/errors.hpp"
#include "identification/records/record_file.hpp"
#include "identification/ring_down/ring_down_file.hpp"
#include "multibody/arm/arm_file.hpp"
#include "reduction/wire_file.hpp"
#include "scenario/distilled_law.hpp"
#include "scenario/scenario.hpp"
#include "study/case_record.hpp"
#include "study/journal.hpp"
#include "study/sweep_file.hpp"

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace snare::fuzz {

/// A folder for this process, with what the files of tests/ranges and data/scenarios name beside and above
/// themselves.
inline const std::filesystem::path& folder_of_files() {
  static const struct Folder {
    Folder() {
      namespace fs = std::filesystem;
      const fs::path source = SNARE_SOURCE_DIR;
      const auto copy = [&](const fs::path& from, const fs::path& to) {
        fs::create_directories(top / to);
        fs::copy(source / from, top / to, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
      };
      copy("tests/ranges", "tests/ranges");
      for (const char* arms : {"data/arms", "tests/arms", "tests/ranges"}) copy("data/arms", arms);
      copy("data/records", "data/records");
      copy("data/experiments", "tests/experiments");
      fs::copy(source / "data/experiments/ringdown.csv", path, fs::copy_options::overwrite_existing);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(top, ignored);
    }
    std::filesystem::path top =
        std::filesystem::temp_directory_path() / ("snare_fuzz_" + std::to_string(::getpid()));
    std::filesystem::path path = top / "tests/ranges";
  } folder;
  return folder.path;
}

/// Gives arbitrary bytes, as a file beside those of folder_of_files(), to `read`, which must return or throw
/// InputError; whatever else leaves here is a defect. Whether it was accepted.
template <class Read>
bool read_bytes_as_file(std::string_view bytes, const char* name, const Read& read) {
  const std::filesystem::path file = folder_of_files() / name;
  std::ofstream(file, std::ios::binary) << bytes;
  try {
    read(file);
    return true;
  } catch (const base::InputError& error) {
    if (error.problems().empty()) throw std::logic_error("an error without a problem");
    return false;
  }
}

inline bool read_bytes_as_scenario(std::string_view bytes) {
  return read_bytes_as_file(bytes, "fuzz_scenario.toml",
                            [](const auto& f) { static_cast<void>(scenario::read_scenario(f)); });
}

inline bool read_bytes_as_record(std::string_view bytes) {
  return read_bytes_as_file(bytes, "fuzz_record.toml",
                            [](const auto& f) { static_cast<void>(identification::read_records(f)); });
}

inline bool read_bytes_as_sweep(std::string_view bytes) {
  return read_bytes_as_file(bytes, "fuzz_sweep.toml",
                            [](const auto& f) { static_cast<void>(study::read_sweep_file(f)); });
}

inline bool read_bytes_as_ring_down(std::string_view bytes) {
  return read_bytes_as_file(bytes, "fuzz_ringdown.toml",
                            [](const auto& f) { static_cast<void>(identification::read_ring_down_file(f)); });
}

inline bool read_bytes_as_wire(std::string_view bytes) {
  return read_bytes_as_file(bytes, "fuzz_wire.toml",
                            [](const auto& f) { static_cast<void>(reduction::read_wire_file(f)); });
}

inline bool read_bytes_as_arm(std::string_view bytes) {
  return read_bytes_as_file(bytes, "fuzz_arm.toml",
                            [](const auto& f) { static_cast<void>(multibody::read_arm(f)); });
}

inline bool read_bytes_as_law(std::string_view bytes) {
  return read_bytes_as_file(bytes, "law.json",
                            [](const auto& f) { static_cast<void>(scenario::read_law_file(f)); });
}

/// A journal of a sweep of which every line that counts must read back as what was written.
inline bool read_bytes_as_journal(std::string_view bytes) {
  return read_bytes_as_file(bytes, "cases.journal", [](const auto& f) {
    constexpr std::uint64_t cases = 50;
    const study::Journal journal(f, "identity", cases);
    for (std::uint64_t k = 0; k < cases; ++k) {
      if (journal.has(k) != journal.result(k).has_value())
        throw std::logic_error("a case is there and is not");
      if (const auto line = journal.result(k)) static_cast<void>(study::record_of(*line));
    }
  });
}

}  // namespace snare::fuzz
