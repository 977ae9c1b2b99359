#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace snare::base {

/// The input files of one piece of work. Each is read once: whoever asks again gets what was read first.
class Inputs {
 public:
  struct File {
    std::filesystem::path path;  ///< as it was first asked for
    std::string sha256;
  };
  /// All that were read, by absolute path.
  [[nodiscard]] std::vector<File> files() const;
  /// Content of a file, by `read` where it is asked for first. Throws InputError where it has more than
  /// `limit` bytes, and what `read` throws.
  [[nodiscard]] std::shared_ptr<const std::string> text(const std::filesystem::path& path, std::size_t limit,
                                                        const std::function<std::string()>& read);
  /// Throws InputError where a file of this name would take the place of one that was read. key: argument
  /// that names the folder, for the message.
  void protect(const std::filesystem::path& output, const std::string& key = "--out") const;

 private:
  struct Entry {
    std::filesystem::path path, resolved;
    std::shared_ptr<const std::string> text;
  };
  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;  // by absolute path, links of the file itself not followed
};

/// The inputs of this thread's work; none outside of every InputScope.
[[nodiscard]] std::shared_ptr<Inputs> current_inputs() noexcept;

/// For as long as it lives this thread's work reads these inputs. Threads that share work take the inputs of
/// the one that began it.
class InputScope {
 public:
  explicit InputScope(std::shared_ptr<Inputs> inputs);
  ~InputScope();
  InputScope(const InputScope&) = delete;
  InputScope& operator=(const InputScope&) = delete;

 private:
  std::shared_ptr<Inputs> before_;
};

}  // namespace snare::base
