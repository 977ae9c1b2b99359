#include "study/journal.hpp"

#include "base/archive.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "study/clock.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <system_error>
#include <utility>

namespace snare::study {

namespace {

constexpr std::string_view schema = "snare-journal/1 ";
constexpr std::size_t sum_size = 16;         // hexadecimal digits
constexpr double flush_every = 1.0;          // what a loss of power may take [s]
constexpr std::size_t chunk_size = 1 << 18;  // read at a time [byte]

std::string sum_of(std::string_view text) {
  return fmt::format("{:016x}", base::fingerprint(text));
}

/// "137 RESULT CHECKSUM" -> number and result, or nothing where the line is damaged.
std::optional<std::pair<std::uint64_t, std::string_view>> parsed(std::string_view line) {
  if (line.size() < sum_size + 4 || line[line.size() - sum_size - 1] != ' ') return std::nullopt;
  const std::string_view body = line.substr(0, line.size() - sum_size - 1);
  if (line.substr(line.size() - sum_size) != sum_of(body)) return std::nullopt;
  std::uint64_t index = 0;
  const auto [stop, error] = std::from_chars(body.data(), body.data() + body.size(), index);
  if (error != std::errc() || stop == body.data() + body.size() || *stop != ' ') return std::nullopt;
  return std::pair{index, body.substr(static_cast<std::size_t>(stop - body.data()) + 1)};
}

}  // namespace

Journal::Journal(std::filesystem::path file, const std::string& identity, std::uint64_t count, Use use)
    : file_(std::move(file)), appends_(use == Use::append), limit_(count) {
  assert(identity.find('\n') == std::string::npos);
  if (count > 0) offsets_.resize(count);
  descriptor_ = ::open(file_.c_str(), (use == Use::append ? O_RDWR | O_CREAT : O_RDONLY) | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw std::system_error(errno, std::generic_category(), file_.string() + ": cannot be written");
  try {
    struct stat status {};
    if (::fstat(descriptor_, &status) == 0 && !S_ISREG(status.st_mode))  // a device may have no end
      throw base::InputError(
          {file_.string(), 0, "", "", "is a device, a pipe or a socket, must be a regular file"});
    if (use == Use::append && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw base::InputError(
          {file_.string(), 0, "", "", "another run is writing into this folder, must be its own"});
    load(identity, use);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
  flushed_ = now();
}

Journal::~Journal() {
  if (appends_ && size_ == begin_) ::unlink(file_.c_str());
  ::close(descriptor_);
}

void Journal::load(const std::string& identity, Use use) {
  const std::string head = std::string(schema) + identity;
  begin_ = head.size() + 1;
  std::string rest;  // of the chunks so far: a line that has not ended
  std::uint64_t line_begin = 0;
  bool first = true;
  bool torn_head = false;
  std::array<char, chunk_size> chunk{};
  std::uint64_t at = 0;
  const auto take = [&](std::string_view line) {
    if (first) {
      first = false;
      if (line != head) {
        throw base::InputError(
            {file_.string(), 0, "", "",
             "belongs to another study, or to this one before its sweep file, its case, a file that these "
             "name, or the "
             "program was changed; take another --out, or delete this file to begin again"});
      }
      return;
    }
    const auto entry = parsed(line);
    if (!entry || (limit_ > 0 && entry->first >= limit_)) {
      ++damaged_;
      return;
    }
    note(entry->first, line_begin);
  };
  for (;;) {
    const ssize_t n = ::pread(descriptor_, chunk.data(), chunk.size(), static_cast<off_t>(at));
    if (n < 0) throw std::system_error(errno, std::generic_category(), file_.string() + ": cannot be read");
    if (n == 0) break;
    const std::string_view text(chunk.data(), static_cast<std::size_t>(n));
    std::size_t begin = 0;
    for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', begin)) {
      rest += text.substr(begin, end - begin);
      take(rest);
      rest.clear();
      begin = end + 1;
      line_begin = at + begin;
    }
    rest += text.substr(begin);
    at += static_cast<std::uint64_t>(n);
  }
  torn_head = first && !rest.empty();
  if (torn_head && !head.starts_with(rest)) take(rest);  // some other file
  if (!rest.empty()) {                                   // a line that was being written
    if (!torn_head) ++damaged_;
    if (use == Use::append && ::ftruncate(descriptor_, static_cast<off_t>(line_begin)) != 0)
      throw std::system_error(errno, std::generic_category(), file_.string() + ": cannot be written");
  }
  size_ = line_begin;
  if (first && use == Use::append) write(head + "\n");
}

void Journal::note(std::uint64_t index, std::uint64_t offset) {
  if (index >= offsets_.size()) offsets_.resize(index + 1);
  if (offsets_[index] == 0) ++finished_;
  offsets_[index] = offset + 1;
  end_ = std::max(end_, index + 1);
}

void Journal::write(std::string_view text) {
  if (const int error = try_write(text); error != 0)
    throw std::system_error(error, std::generic_category(), file_.string() + ": cannot be written");
}

/// Error of the system; 0: written.
int Journal::try_write(std::string_view text) noexcept {
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t n = ::pwrite(descriptor_, text.data() + written, text.size() - written,
                               static_cast<off_t>(size_ + written));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const int error = n < 0 ? errno : ENOSPC;
      [[maybe_unused]] const int ignored = ::ftruncate(descriptor_, static_cast<off_t>(size_));
      return error;
    }
    written += static_cast<std::size_t>(n);
  }
  size_ += text.size();
  return 0;
}

void Journal::append(std::uint64_t index, std::string_view result) {
  assert(result.find('\n') == std::string_view::npos);
  const std::string body = fmt::format("{} {}", index, result);
  const std::string line = fmt::format("{} {}\n", body, sum_of(body));
  const std::scoped_lock lock(mutex_);
  if (index < offsets_.size() && offsets_[index] != 0) return;
  const std::uint64_t offset = size_;
  write(line);
  note(index, offset);
  if (now() - flushed_ < flush_every) return;
  flushed_ = now();
  sync();
}

void Journal::append_at_the_end(std::uint64_t index, std::string_view result) noexcept {
  constexpr std::size_t number_size = 20;  // digits of the largest
  std::array<char, longest_last_words + number_size + sum_size + 3> line;
  if (result.size() > longest_last_words) return;
  char* end = std::to_chars(line.data(), line.data() + number_size, index).ptr;
  *end++ = ' ';
  end = std::ranges::copy(result, end).out;
  const std::uint64_t sum = base::fingerprint({line.data(), static_cast<std::size_t>(end - line.data())});
  *end++ = ' ';
  constexpr unsigned bits = 4;
  for (std::size_t k = sum_size; k-- > 0;) *end++ = "0123456789abcdef"[(sum >> (bits * k)) & 0xfU];
  *end++ = '\n';
  const std::scoped_lock lock(mutex_);  // others may be appending; they do not wait for this thread
  if (index < offsets_.size() && offsets_[index] != 0) return;
  if (try_write({line.data(), static_cast<std::size_t>(end - line.data())}) == 0) ::fdatasync(descriptor_);
}

void Journal::flush() {
  const std::scoped_lock lock(mutex_);
  sync();
}

// What the system could not write it says once: who looks only at the end is told that all is well.
void Journal::sync() {
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP)
    throw std::system_error(errno, std::generic_category(), file_.string() + ": cannot be written");
}

bool Journal::has(std::uint64_t index) const {
  const std::scoped_lock lock(mutex_);
  return index < offsets_.size() && offsets_[index] != 0;
}

std::uint64_t Journal::finished() const {
  const std::scoped_lock lock(mutex_);
  return finished_;
}

std::uint64_t Journal::end() const {
  const std::scoped_lock lock(mutex_);
  return end_;
}

std::optional<std::string> Journal::result(std::uint64_t index) const {
  std::uint64_t at = 0;
  {
    const std::scoped_lock lock(mutex_);
    if (index >= offsets_.size() || offsets_[index] == 0) return std::nullopt;
    at = offsets_[index] - 1;
  }
  std::string line;
  std::array<char, 4096> chunk{};
  for (;;) {
    const ssize_t n = ::pread(descriptor_, chunk.data(), chunk.size(), static_cast<off_t>(at + line.size()));
    if (n < 0) throw std::system_error(errno, std::generic_category(), file_.string() + ": cannot be read");
    if (n == 0) return std::nullopt;
    line.append(chunk.data(), static_cast<std::size_t>(n));
    const std::size_t end = line.find('\n');
    if (end == std::string::npos) continue;
    line.resize(end);
    const auto entry = parsed(line);
    if (!entry) return std::nullopt;
    return std::string(entry->second);
  }
}

}  // namespace snare::study
