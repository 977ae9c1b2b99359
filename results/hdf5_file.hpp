#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace snare::results {

/// Attributes of an object of an HDF5 file: texts (UTF-8, of variable length), whole numbers, numbers, lists
/// of texts.
using Hdf5Value = std::variant<std::string, std::int64_t, double, std::vector<std::string>>;
using Hdf5Attributes = std::vector<std::pair<std::string, Hdf5Value>>;

/// Opens the HDF5 library, which is not loaded before (docs/decisions/sweeps.md#histories-in-one-file).
/// Throws std::runtime_error that says what to install where there is none.
void require_hdf5();

/// Writes an HDF5 file. The same calls write the same bytes: no times are kept.
///
/// Paths lead through groups, "/group/name"; those that do not exist are made. Every failure of the library
/// or of the disk throws std::runtime_error with the name that messages have, after which nothing but the end
/// of the object is allowed. One object of a process at a time holds the library, which is not made for
/// threads: others wait.
class Hdf5Writer {
 public:
  /// file: is there; it is emptied and written in its place. shown: its name in messages.
  Hdf5Writer(const std::filesystem::path& file, std::filesystem::path shown);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// Of the file itself.
  void attributes(const Hdf5Attributes& attributes);
  /// A group with its attributes.
  void group(const std::string& path, const Hdf5Attributes& attributes);
  /// Numbers in doubles, or texts, along one axis, compressed in chunks. numbers: in whatever unit the
  /// attributes say.
  void dataset(const std::string& path, const std::vector<double>& numbers, const Hdf5Attributes& attributes);
  void dataset(const std::string& path, const std::vector<std::string>& texts,
               const Hdf5Attributes& attributes);
  /// The file is whole, closed and sealed: its first bytes, which readers of HDF5 pass over, have a checksum
  /// of the others. To be called once, nothing after it.
  void close();

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

/// Whether a file is as Hdf5Writer has closed it, byte by byte.
[[nodiscard]] bool is_whole_hdf5(const std::filesystem::path& file);

/// A text attribute of the file itself; nothing where there is no such file, it is no HDF5 file, or has no
/// such attribute.
[[nodiscard]] std::optional<std::string> text_attribute(const std::filesystem::path& file,
                                                        const std::string& name);

}  // namespace snare::results
