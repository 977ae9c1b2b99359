#include "base/files.hpp"

#include "base/errors.hpp"
#include "base/inputs.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

namespace snare::base {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, std::string requirement) {
  throw InputError(InputProblem{path.string(), 0, "", "", std::move(requirement)});
}

[[noreturn]] void fail(int code, const std::filesystem::path& path, const char* what) {
  throw std::system_error(code, std::generic_category(), fmt::format("{}: {}", path.string(), what));
}

std::string reason(int code) {
  return std::generic_category().message(code);
}

/// Bytes of the UTF-8 sequence that starts at text[at], or 0 when it is not well-formed.
std::size_t utf8_length(std::string_view text, std::size_t at) noexcept {
  const auto byte = [&](std::size_t offset) -> unsigned {
    return at + offset < text.size() ? static_cast<unsigned char>(text[at + offset]) : 0u;
  };
  const auto continues = [&](std::size_t offset) { return (byte(offset) & 0xC0u) == 0x80u; };
  const unsigned lead = byte(0);
  const unsigned second = byte(1);
  if (lead < 0x80u) return 1;
  if (lead >= 0xC2u && lead <= 0xDFu) return continues(1) ? 2 : 0;
  if (lead >= 0xE0u && lead <= 0xEFu) {
    if (lead == 0xE0u && second < 0xA0u) return 0;  // overlong
    if (lead == 0xEDu && second > 0x9Fu) return 0;  // surrogate
    return continues(1) && continues(2) ? 3 : 0;
  }
  if (lead >= 0xF0u && lead <= 0xF4u) {
    if (lead == 0xF0u && second < 0x90u) return 0;  // overlong
    if (lead == 0xF4u && second > 0x8Fu) return 0;  // beyond U+10FFFF
    return continues(1) && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

/// Temporary names of the files that are being written, for a process that ends without leaving its
/// functions.
struct Unfinished {
  std::mutex mutex;
  std::set<std::string> names;
};
Unfinished& unfinished() {
  static auto* all = new Unfinished;  // outlives every thread
  return *all;
}

/// Process of a temporary name ".NAME.PROCESS-NUMBER.tmp"; 0: it is none.
pid_t process_of(std::string_view name) {
  constexpr std::string_view ending = ".tmp";
  if (!name.starts_with('.') || !name.ends_with(ending)) return 0;
  name.remove_suffix(ending.size());
  const std::size_t dot = name.rfind('.');
  const std::size_t dash = name.rfind('-');
  if (dot == 0 || dash == std::string_view::npos || dash < dot) return 0;
  pid_t process = 0;
  const char* const end = name.data() + dash;
  return std::from_chars(name.data() + dot + 1, end, process).ptr == end ? process : 0;
}

/// Removes what killed processes have left unfinished in a folder: their process is gone and nobody holds the
/// file. Once a process and folder.
void remove_abandoned_files(const std::filesystem::path& folder) {
  static std::mutex mutex;
  static std::set<std::filesystem::path> seen;
  {
    const std::scoped_lock lock(mutex);
    if (!seen.insert(folder).second) return;
  }
  std::error_code code;
  std::vector<std::filesystem::path> abandoned;
  for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, code)) {
    const pid_t process = process_of(entry.path().filename().string());
    if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH) abandoned.push_back(entry.path());
  }
  for (const std::filesystem::path& path : abandoned) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (descriptor < 0) continue;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
    ::close(descriptor);
  }
}

}  // namespace

InputFile open_input(const std::filesystem::path& path) {
  // The system would cut a name at a zero byte and open another file than the one that was named.
  if (path.empty()) refuse(path, "the name of the file is empty");
  if (path.native().find('\0') != std::string::npos)
    refuse(path.c_str(), "a zero byte in the name of the file");
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (status.type() == std::filesystem::file_type::not_found) refuse(path, "no such file");
  if (status.type() == std::filesystem::file_type::none)
    refuse(path, fmt::format("cannot be read ({})", code.message()));
  if (status.type() == std::filesystem::file_type::directory) refuse(path, "is a directory, must be a file");
  if (status.type() != std::filesystem::file_type::regular)
    refuse(path, "is a device, a pipe or a socket, must be a regular file");
  InputFile file{FileHandle(std::fopen(path.c_str(), "rb")), 0};
  if (!file.handle) refuse(path, fmt::format("cannot be read ({})", reason(errno)));
  file.size = std::filesystem::file_size(path, code);
  if (code) refuse(path, fmt::format("cannot be read ({})", code.message()));
  return file;
}

std::size_t read_bytes(std::FILE* file, char* to, std::size_t size, const std::filesystem::path& path) {
  const std::size_t count = std::fread(to, 1, size, file);
  if (count < size && std::ferror(file) != 0) refuse(path, fmt::format("cannot be read ({})", reason(errno)));
  return count;
}

std::string read_text(const std::filesystem::path& path, std::size_t limit) {
  const auto read = [&] {
    const InputFile file = open_input(path);
    if (file.size > limit) refuse(path, fmt::format("has {} bytes, must have at most {}", file.size, limit));
    std::string text(static_cast<std::size_t>(file.size), '\0');
    text.resize(read_bytes(file.handle.get(), text.data(), text.size(), path));
    return text;
  };
  const std::shared_ptr<Inputs> inputs = current_inputs();
  return inputs ? *inputs->text(path, limit, read) : read();
}

std::size_t find_invalid_utf8(std::string_view text) noexcept {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0) return at;
    at += length;
  }
  return std::string_view::npos;
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  static std::atomic<unsigned> counter{0};  // two files of one process never share a temporary name
  if (const std::shared_ptr<Inputs> inputs = current_inputs()) inputs->protect(path_);
  std::error_code code;
  const std::filesystem::path folder = path_.parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder, code);
  if (code) fail(code.value(), folder, "cannot create the folder");
  remove_abandoned_files(folder);
  temporary_ = folder / fmt::format(".{}.{}-{}.tmp", path_.filename().string(), ::getpid(), counter++);
  {
    const std::scoped_lock lock(unfinished().mutex);
    unfinished().names.insert(temporary_.string());
  }
  handle_.reset(std::fopen(temporary_.c_str(), "wbx"));
  if (handle_) {
    ::flock(::fileno(handle_.get()), LOCK_SH | LOCK_NB);  // says that somebody is writing it
    return;
  }
  const int error = errno;
  forget();
  fail(error, path_, "cannot be written");
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  handle_.reset();
  std::error_code ignored;  // nothing better can be done while leaving
  std::filesystem::remove(temporary_, ignored);
  forget();
}

void AtomicFile::forget() {
  const std::scoped_lock lock(unfinished().mutex);
  unfinished().names.erase(temporary_.string());
}

void AtomicFile::write(std::string_view text) {
  assert(handle_ && "write after commit");
  if (std::fwrite(text.data(), 1, text.size(), handle_.get()) != text.size())
    fail(errno, path_, "cannot be written");
}

// Its content is on the disk before its name is: after a loss of power, too, the name stands for a whole
// file. Where a file system cannot say so (EINVAL, ENOTSUP) there is nothing to wait for.
void AtomicFile::commit() {
  assert(handle_ && "commit twice");
  if (std::fflush(handle_.get()) != 0) fail(errno, path_, "cannot be written");
  if (::fsync(::fileno(handle_.get())) != 0 && errno != EINVAL && errno != ENOTSUP)
    fail(errno, path_, "cannot be written");
  if (std::fclose(handle_.release()) != 0) fail(errno, path_, "cannot be written");
  std::error_code code;
  std::filesystem::rename(temporary_, path_, code);
  if (code) fail(code.value(), path_, "cannot be written");  // the destructor removes the temporary file
  committed_ = true;
  forget();
}

void remove_unfinished_files() noexcept {
  const std::unique_lock lock(unfinished().mutex, std::try_to_lock);
  if (!lock) return;  // a thread that holds it will not be waited for
  for (const std::string& name : unfinished().names) ::unlink(name.c_str());
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace snare::base
