#pragma once

#include <filesystem>
#include <list>
#include <string>
#include <vector>

namespace snare::base {

/// A folder for results, checked, made and held before anything is computed: no run ends in a rejection, and
/// no two runs write into one folder.
///
/// It is held by a lock on the file `.snare.lock` in it, which names the holder. The lock goes with the
/// process, however that ends; the file goes with the object. A folder that was made for it and that nothing
/// was written into goes, too.
class ResultFolder {
 public:
  /// Who asks for the folder.
  struct Asker {
    std::string key;   ///< argument that names the folder, as messages name it: "--out"
    std::string work;  ///< what writes into it, as others are told: "snare push x.toml"
  };
  /// files: names of the results. Throws InputError, naming the argument, for an empty name, for a file, for
  /// a folder that another run holds, and where one of `files` is an input that was read; std::system_error
  /// for a folder that cannot be made or written, and where a folder has the name of a file of `files`.
  ResultFolder(std::filesystem::path folder, const std::vector<std::string>& files, const Asker& asker);
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  /// The folder, as it was given.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return folder_; }

 private:
  struct Held {
    int descriptor = -1;
    std::filesystem::path lock;
    std::vector<std::filesystem::path> made;  // the innermost first
    void release() noexcept;
  };
  struct All;
  static All& all();
  friend void release_result_folders() noexcept;

  std::filesystem::path folder_;
  std::list<Held>::iterator held_;
};

/// The same as the end of every ResultFolder of this process, for one that ends without leaving its
/// functions.
void release_result_folders() noexcept;

}  // namespace snare::base
