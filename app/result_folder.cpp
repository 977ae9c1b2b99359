#include "app/result_folder.hpp"

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
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

namespace snare::app {

namespace {

namespace fs = std::filesystem;

/// The one folder that this process holds. What ends the process in a hurry must find it.
struct Held {
  std::mutex mutex;
  int descriptor = -1;
  fs::path lock;
  std::vector<fs::path> made;  // the innermost first
};
Held& held() {
  static auto* one = new Held;  // outlives every thread
  return *one;
}

[[noreturn]] void fail(int code, const fs::path& path, const char* what) {
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
std::optional<int> locked(const fs::path& file) {
  constexpr int attempts = 100;  // a run that has just ended may take its file away under ours
  for (int i = 0; i < attempts; ++i) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) fail(errno, file.parent_path(), "cannot be written into");
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      const std::string who = holder(descriptor);
      ::close(descriptor);
      if (error != EWOULDBLOCK) {
        ::unlink(file.c_str());
        return std::nullopt;
      }
      throw base::InputError({"", 0, "--out", file.parent_path().string(),
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

void release(Held& h) {
  if (!h.lock.empty()) ::unlink(h.lock.c_str());
  if (h.descriptor >= 0) ::close(h.descriptor);
  for (const fs::path& folder : h.made) {
    if (::rmdir(folder.c_str()) != 0) break;  // something is in it
  }
  h.descriptor = -1;
  h.lock.clear();
  h.made.clear();
}

}  // namespace

void require_folder(const fs::path& out) {
  std::error_code code;
  for (fs::path at = out; !at.empty(); at = at.parent_path()) {
    if (fs::exists(at, code)) {
      if (fs::is_directory(at, code)) return;
      throw base::InputError({"", 0, "--out", out.string(), "must be a folder: " + at.string() + " is a file"});
    }
    if (at == at.parent_path()) return;
  }
}

ResultFolder::ResultFolder(const CommonOptions& options, std::initializer_list<const char*> files) {
  const fs::path& out = options.out;
  if (out.empty()) throw base::InputError({"", 0, "--out", "''", "must name a folder; \".\" is the current one"});
  require_folder(out);
  if (const std::shared_ptr<base::Inputs> inputs = base::current_inputs()) {
    for (const char* file : files) inputs->protect(out / file);
  }
  Held& h = held();
  const std::scoped_lock guard(h.mutex);
  std::vector<fs::path> made;
  std::error_code code;
  for (fs::path at = out.has_filename() ? out : out.parent_path(); !at.empty() && !fs::exists(at, code);
       at = at.parent_path()) {
    if (made.empty() || made.back() != at) made.push_back(at);
    if (at == at.parent_path()) break;
  }
  fs::create_directories(out, code);
  if (code) fail(code.value(), out, "cannot create the folder");
  h.made = std::move(made);
  try {
    for (const char* file : files) {
      if (fs::is_directory(out / file, code)) fail(EISDIR, out / file, "cannot be written");
    }
    const fs::path lock = out / ".snare.lock";
    if (const std::optional<int> descriptor = locked(lock)) {
      h.descriptor = *descriptor;
      h.lock = lock;
      const std::string who = fmt::format("{} (process {})\n", options.command, ::getpid());
      if (::ftruncate(h.descriptor, 0) != 0 || ::pwrite(h.descriptor, who.data(), who.size(), 0) < 0)
        fail(errno, out, "cannot be written into");
    }
  } catch (...) {
    release(h);
    throw;
  }
}

ResultFolder::~ResultFolder() {
  release_result_folder();
}

void release_result_folder() noexcept {
  const std::unique_lock guard(held().mutex, std::try_to_lock);
  if (guard) release(held());
}

}  // namespace snare::app
