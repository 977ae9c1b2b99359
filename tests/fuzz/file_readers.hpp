#pragma once

#include "app/motion_checkpoint.hpp"
#include "base/archive.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
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
#include <vector>

namespace snare::fuzz {

/// A folder with what files name beside themselves, for this process; the arms and records of the tests of ranges.
inline const std::filesystem::path& folder_of_files() {
  static const struct Folder {
    Folder() : path(std::filesystem::temp_directory_path() / ("snare_fuzz_" + std::to_string(::getpid()))) {
      namespace fs = std::filesystem;
      const fs::path source = SNARE_SOURCE_DIR;
      fs::create_directories(path);
      for (const char* name : {"tests/ranges/swing.toml", "tests/ranges/swing.csv", "tests/ranges/readings.toml",
                               "tests/ranges/readings.csv", "data/records/pendulum.urdf", "data/arms/jemrms_like.toml",
                               "data/arms/jemrms_like.urdf", "data/experiments/ringdown.csv"})
        fs::copy_file(source / name, path / fs::path(name).filename(), fs::copy_options::overwrite_existing);
      // The scenario of the swing names its arm in another folder.
      std::string swing = base::read_text(path / "swing.toml");
      const std::string far = "../../data/records/pendulum_arm.toml";
      swing.replace(swing.find(far), far.size(), "pendulum_arm.toml");
      base::write_text(path / "swing.toml", swing);
      fs::copy_file(source / "data/records/pendulum_arm.toml", path / "pendulum_arm.toml",
                    fs::copy_options::overwrite_existing);
    }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
    std::filesystem::path path;
  } folder;
  return folder.path;
}

/// Gives arbitrary bytes, as a file beside those of folder_of_files(), to `read`, which must return or throw InputError; whatever else
/// leaves here is a defect. Whether it was accepted.
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
  return read_bytes_as_file(bytes, "scenario.toml",
                            [](const auto& f) { static_cast<void>(scenario::read_scenario(f)); });
}

inline bool read_bytes_as_record(std::string_view bytes) {
  return read_bytes_as_file(bytes, "record.toml",
                            [](const auto& f) { static_cast<void>(identification::read_records(f)); });
}

inline bool read_bytes_as_sweep(std::string_view bytes) {
  return read_bytes_as_file(bytes, "sweep.toml", [](const auto& f) { static_cast<void>(study::read_sweep_file(f)); });
}

inline bool read_bytes_as_ring_down(std::string_view bytes) {
  return read_bytes_as_file(bytes, "ringdown.toml",
                            [](const auto& f) { static_cast<void>(identification::read_ring_down_file(f)); });
}

inline bool read_bytes_as_wire(std::string_view bytes) {
  return read_bytes_as_file(bytes, "wire.toml", [](const auto& f) { static_cast<void>(reduction::read_wire_file(f)); });
}

inline bool read_bytes_as_arm(std::string_view bytes) {
  return read_bytes_as_file(bytes, "arm.toml", [](const auto& f) { static_cast<void>(multibody::read_arm(f)); });
}

inline bool read_bytes_as_law(std::string_view bytes) {
  return read_bytes_as_file(bytes, "law.json", [](const auto& f) { static_cast<void>(scenario::read_law_file(f)); });
}

/// A journal of a sweep of which every line that counts must read back as what was written.
inline bool read_bytes_as_journal(std::string_view bytes) {
  return read_bytes_as_file(bytes, "cases.journal", [](const auto& f) {
    constexpr std::uint64_t cases = 50;
    const study::Journal journal(f, "identity", cases);
    for (std::uint64_t k = 0; k < cases; ++k) {
      if (journal.has(k) != journal.result(k).has_value()) throw std::logic_error("a case is there and is not");
      if (const auto line = journal.result(k)) static_cast<void>(study::record_of(*line));
    }
  });
}

/// What a checkpoint holds, behind a head that is right: the checksum keeps all else out. It must be read or refused.
inline bool read_bytes_as_checkpoint(std::string_view bytes) {
  const std::filesystem::path file = folder_of_files() / "checkpoint.bin";
  static const std::string head = [&file] {
    app::MotionProgress nothing;
    app::write_motion_checkpoint(file, "input", nothing);
    std::string text = base::read_text(file);
    text.resize(text.find('\n') + 1 + sizeof(std::uint64_t));
    return text;
  }();
  const std::uint64_t sum = base::fingerprint(bytes);
  std::ofstream(file, std::ios::binary) << head << std::string_view(reinterpret_cast<const char*>(&sum), sizeof sum)
                                        << bytes;
  return app::read_motion_checkpoint(file, "input").progress.has_value();
}

}  // namespace snare::fuzz
