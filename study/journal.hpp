#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snare::study {

/// What is finished of a study, in a file to which one line a case is appended.
/// docs/decisions/sweeps.md#cases-journal-and-ranks
///
/// A line has the case's number, its result, and a checksum. After a kill at any moment the lines that are
/// whole count; a torn or damaged one is taken out or passed over, and its case is run again. A file to which
/// no case was appended is removed with the object. 8 bytes a case are held in memory.
class Journal {
 public:
  enum class Use {
    append,  ///< one at a time holds the file, by a lock that goes with the process
    look     ///< what is there, while another may be appending; nothing is written
  };
  /// Opens the file; to append it is made where it is missing. identity: one line of text, equal for equal
  /// studies. count: cases there are; 0: not known. Throws base::InputError when the file belongs to another
  /// study, is held by another run or is no regular file, std::system_error when the system refuses.
  Journal(std::filesystem::path file, const std::string& identity, std::uint64_t count,
          Use use = Use::append);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Appends the result of a case: a text without line breaks. Thread-safe; a case that is there already is
  /// passed over. On failure (std::system_error: a full disk) the file ends with its last whole line.
  void append(std::uint64_t index, std::string_view result);
  /// As `append`, in the handler of a signal that ends the process: allocates nothing, throws nothing.
  /// result: of at most `longest_last_words` bytes. Not for the thread that is in another call of this
  /// journal.
  void append_at_the_end(std::uint64_t index, std::string_view result) noexcept;
  static constexpr std::size_t longest_last_words = 4096;  ///< [byte]
  /// Waits until what was appended is on the disk.
  void flush();

  [[nodiscard]] bool has(std::uint64_t index) const;  ///< the case is finished
  /// Result of a case; nothing where there is none. Throws std::system_error.
  [[nodiscard]] std::optional<std::string> result(std::uint64_t index) const;
  [[nodiscard]] std::uint64_t finished() const;
  /// One past the last case that is there: of a thousand million cases that are asked for few may be.
  [[nodiscard]] std::uint64_t end() const;
  /// Lines that were damaged when the file was opened.
  [[nodiscard]] std::uint64_t damaged() const noexcept { return damaged_; }
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

 private:
  void load(const std::string& identity, Use use);
  void note(std::uint64_t index, std::uint64_t offset);
  void write(std::string_view text);
  void sync();
  [[nodiscard]] int try_write(std::string_view text) noexcept;

  std::filesystem::path file_;
  bool appends_ = true;
  int descriptor_ = -1;
  mutable std::mutex mutex_;
  std::vector<std::uint64_t> offsets_;  // 1 + where a case's line begins; 0: none
  std::uint64_t limit_ = 0;             // cases there may be; 0: any
  std::uint64_t begin_ = 0;             // of the first case [byte]
  std::uint64_t size_ = 0;              // of the file's whole lines [byte]
  std::uint64_t finished_ = 0;
  std::uint64_t end_ = 0;
  std::uint64_t damaged_ = 0;
  double flushed_ = 0.0;  // when [s]
};

}  // namespace snare::study
