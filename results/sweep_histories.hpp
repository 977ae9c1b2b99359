#pragma once

#include "results/history_table.hpp"
#include "results/sweep_study.hpp"
#include "study/journal.hpp"

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

namespace snare::results {

/// The histories of the cases of a sweep in its folder: a file a case in `histories/` while it runs, which
/// appears when it is whole, and one HDF5 file `histories.h5` at its end.
/// docs/sweep_file.md, docs/decisions/sweeps.md#histories-in-one-file
///
/// A case has a history when it is done, or when its solver could not finish: then as far as it came. Of a
/// case that the journal has, but whose history is not there, damaged or of another study, the history is
/// made again by running it.
class SweepHistories {
 public:
  /// out: the folder of the sweep; nothing is looked at yet. The study must outlive this.
  SweepHistories(const SweepStudy& study, const std::filesystem::path& out);

  /// Keeps the history of a case, by its number in the journal; on the disk when it returns. For any thread
  /// and any process, a case twice included. Throws std::system_error.
  void keep(std::uint64_t index, History& history) const;

  /// Cases that the journal has and whose history is missing. Throws std::runtime_error where there is no
  /// HDF5 library.
  [[nodiscard]] std::set<std::uint64_t> missing(const study::Journal& journal) const;

  /// Writes histories.h5 of a sweep that is at its end, and removes the files that it was made of. Throws
  /// std::runtime_error where it cannot be written or a history is missing; then the files stay, and the same
  /// sweep continues.
  void join(const study::Journal& journal, std::uint64_t cases) const;

  /// Whether histories.h5 is there and is not as it was written: its cases count as missing.
  [[nodiscard]] bool damaged() const;

  /// histories.h5.
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

 private:
  [[nodiscard]] bool joined() const;
  [[nodiscard]] std::filesystem::path part(std::uint64_t index) const;
  [[nodiscard]] bool has(std::uint64_t index) const;
  [[nodiscard]] History read(std::uint64_t index) const;
  void write(const std::filesystem::path& file, const study::Journal& journal, std::uint64_t cases) const;
  void remove_parts() const;

  const SweepStudy& study_;
  std::filesystem::path folder_, file_;
};

}  // namespace snare::results
