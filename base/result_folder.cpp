#include "base/result_folder.hpp"

#include "base/errors.hpp"
#include "base/inputs.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

namespace snare::base {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void system_refuses(int code, const fs::path& path, const char* what) {
  throw std::system_error(code, std::generic_category(), fmt::format("{}: {}", path.string(), what));
}

/// Who holds a lock, as its file says: "snare push x.toml (process 12)".
std::string holder(int descriptor) {
  std::array<char, 512> text{};
  const ssize_t count = ::pread(descriptor, text.data(), text.size() - 1, 0);
  std::string who(text.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  who.resize(std::min(who.find('\n'), who.size()));
  return who.empty() ? "another run" : who;
}

/// The lock's file, open and locked. Nothing where the file system knows no locks.
std::optional<int> locked(const fs::path& file, const std::string& key) {
  constexpr int attempts = 100;  // a run that has just ended may take its file away under ours
  for (int i = 0; i < attempts; ++i) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) system_refuses(errno, file.parent_path(), "cannot be written into");
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      const std::string who = holder(descriptor);
      ::close(descriptor);
      if (error != EWOULDBLOCK) {
        ::unlink(file.c_str());
        return std::nullopt;
      }
      throw InputError({"", 0, key, file.parent_path().string(),
                        "must be a folder of its own: " + who + " is writing into this one"});
    }
    struct stat ours {};
    struct stat named {};
    if (::fstat(descriptor, &ours) == 0 && ::stat(file.c_str(), &named) == 0 && ours.st_ino == named.st_ino &&
        ours.st_dev == named.st_dev)
      return descriptor;
    ::close(descriptor);
  }
  return std::nullopt;
}

/// Throws InputError where this folder, or one above it, is a file.
void require_folder(const fs::path& folder, const std::string& key) {
  std::error_code code;
  for (fs::path at = folder; !at.empty(); at = at.parent_path()) {
    if (fs::exists(at, code)) {
      if (fs::is_directory(at, code)) return;
      throw InputError({"", 0, key, folder.string(), "must be a folder: " + at.string() + " is a file"});
    }
    if (at == at.parent_path()) return;
  }
}

}  // namespace

void ResultFolder::Held::release() noexcept {
  if (!lock.empty()) ::unlink(lock.c_str());
  if (descriptor >= 0) ::close(descriptor);
  for (const fs::path& folder : made) {
    if (::rmdir(folder.c_str()) != 0) break;  // something is in it
  }
  *this = {};
}

/// The folders that this process holds. What ends the process in a hurry must find them.
struct ResultFolder::All {
  std::mutex mutex;
  std::list<Held> held;
};
ResultFolder::All& ResultFolder::all() {
  static auto* one = new All;  // outlives every thread
  return *one;
}

ResultFolder::ResultFolder(fs::path given, const std::vector<std::string>& files, const Asker& asker)
    : folder_(std::move(given)) {
  const fs::path& folder = folder_;
  if (folder.empty())
    throw InputError({"", 0, asker.key, "''", "must name a folder; \".\" is the current one"});
  require_folder(folder, asker.key);
  if (const std::shared_ptr<Inputs> inputs = current_inputs()) {
    for (const std::string& file : files) inputs->protect(folder / file, asker.key);
  }
  const std::scoped_lock guard(all().mutex);
  Held held;
  std::error_code code;
  for (fs::path at = folder.has_filename() ? folder : folder.parent_path();
       !at.empty() && !fs::exists(at, code); at = at.parent_path()) {
    if (held.made.empty() || held.made.back() != at) held.made.push_back(at);
    if (at == at.parent_path()) break;
  }
  fs::create_directories(folder, code);
  if (code) system_refuses(code.value(), folder, "cannot create the folder");
  try {
    for (const std::string& file : files) {
      if (fs::is_directory(folder / file, code)) system_refuses(EISDIR, folder / file, "cannot be written");
    }
    const fs::path lock = folder / ".snare.lock";
    if (const std::optional<int> descriptor = locked(lock, asker.key)) {
      held.descriptor = *descriptor;
      held.lock = lock;
      const std::string who = fmt::format("{} (process {})\n", asker.work, ::getpid());
      if (::ftruncate(held.descriptor, 0) != 0 || ::pwrite(held.descriptor, who.data(), who.size(), 0) < 0)
        system_refuses(errno, folder, "cannot be written into");
    }
    all().held.push_back(held);
  } catch (...) {
    held.release();
    throw;
  }
  held_ = std::prev(all().held.end());
}

ResultFolder::~ResultFolder() {
  const std::scoped_lock guard(all().mutex);
  held_->release();
  all().held.erase(held_);
}

void release_result_folders() noexcept {
  const std::unique_lock guard(ResultFolder::all().mutex, std::try_to_lock);
  if (!guard) return;
  for (ResultFolder::Held& held : ResultFolder::all().held) held.release();
}

}  // namespace snare::base
