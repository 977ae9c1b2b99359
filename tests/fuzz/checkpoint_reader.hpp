#pragma once

#include "app/motion_checkpoint.hpp"
#include "base/archive.hpp"
#include "base/files.hpp"
#include "tests/fuzz/file_readers.hpp"

namespace snare::fuzz {

/// What a checkpoint holds, behind a head that is right: the checksum keeps all else out. It must be read or
/// refused.
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
  std::ofstream(file, std::ios::binary)
      << head << std::string_view(reinterpret_cast<const char*>(&sum), sizeof sum) << bytes;
  return app::read_motion_checkpoint(file, "input").progress.has_value();
}

}  // namespace snare::fuzz
