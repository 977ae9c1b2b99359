#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace snare::base {

/// Closes a C stream when its handle goes; what fclose says is not looked at: AtomicFile closes by itself.
struct FileCloser {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, FileCloser>;

/// A regular file that is open for reading.
struct InputFile {
  FileHandle handle;
  std::uintmax_t size = 0;  ///< [byte]
};

/// Opens a regular file for reading. Throws InputError when it is missing, a directory, a device or a pipe
/// (which could be endless), or unreadable.
[[nodiscard]] InputFile open_input(const std::filesystem::path& path);

/// The next bytes of an open file: `size` of them, fewer at its end only. Throws InputError, naming `path`,
/// when the system cannot read on.
[[nodiscard]] std::size_t read_bytes(std::FILE* file, char* to, std::size_t size,
                                     const std::filesystem::path& path);

/// The whole content of a regular file of at most `limit` bytes. Throws InputError as open_input, and when
/// the file is longer.
[[nodiscard]] std::string read_text(const std::filesystem::path& path, std::size_t limit = 16u << 20u);

/// Offset of the first byte that does not belong to well-formed UTF-8 (Unicode 15, table 3-7), or npos.
[[nodiscard]] std::size_t find_invalid_utf8(std::string_view text) noexcept;

/// A file that appears under its name when it is complete and not before.
///
/// Writes go to a temporary name in the same folder; `commit()` waits until they are on the disk and renames
/// it. Destroyed without a commit, it leaves nothing behind and what stood under the name before stays.
/// Missing parent folders are created. Every failure of the system throws std::system_error that names the
/// path.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends bytes to the temporary file.
  void write(std::string_view text);
  /// Where it is until then, for a library that opens files by name. It may empty this one and write it, must
  /// not put another in its place, and must have closed it before the commit.
  [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return temporary_; }
  /// To be called once; no write after it.
  void commit();

 private:
  void forget();

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  FileHandle handle_;
  bool committed_ = false;
};

/// Removes the temporary files of AtomicFiles that are not committed: for a process that is about to end
/// without leaving its functions. What they hold must not be written on.
void remove_unfinished_files() noexcept;

/// Writes `text` under `path` by way of AtomicFile.
void write_text(const std::filesystem::path& path, std::string_view text);

}  // namespace snare::base
