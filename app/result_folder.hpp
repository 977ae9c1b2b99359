#pragma once

#include "app/console.hpp"

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace snare::app {

/// The folder of the results: looked at, made and held before anything is computed, so that no run ends in a refusal and no two
/// runs write into one folder.
///
/// It is held by a lock on the file `.snare.lock` in it, which says who holds it. The lock goes with the process, however that
/// ends; the file goes with the object. A folder that was made for it and that nothing was written into goes, too.
class ResultFolder {
 public:
  /// files: what will be written. Throws base::InputError, naming --out, for an empty name, for a file, for a folder that another run
  /// holds, and where one of `files` is an input that was read; std::system_error for a folder that cannot be made or written, and
  /// where a folder has the name of a file of `files`.
  ResultFolder(const CommonOptions& options, std::initializer_list<const char*> files);
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;
};

/// Throws base::InputError, naming --out, where this folder, or one above it, is a file.
void require_folder(const std::filesystem::path& out);

/// The same as the end of the ResultFolder, for a process that ends without leaving its functions.
void release_result_folder() noexcept;

}  // namespace snare::app
