// Preloaded into the command: one call of the system fails, once. SNARE_FAIL_CALL names it, SNARE_FAIL_AT
// counts it from 1; when it fails the file SNARE_FAIL_NOTE is made. Standard streams and files that are read
// are left alone.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

/// Whether this call is the one that fails.
bool fails(const char* call) {
  static std::atomic<long> count{0};
  static const char* const wanted = std::getenv("SNARE_FAIL_CALL");
  static const char* const at = std::getenv("SNARE_FAIL_AT");
  if (wanted == nullptr || at == nullptr || std::strcmp(wanted, call) != 0) return false;
  if (++count != std::atol(at)) return false;
  if (const char* const note = std::getenv("SNARE_FAIL_NOTE"))
    ::close(::open(note, O_WRONLY | O_CREAT, 0600));
  errno = ENOSPC;
  return true;
}

bool is_file(std::FILE* stream) {
  const int descriptor = stream != nullptr ? ::fileno(stream) : -1;
  return descriptor > STDERR_FILENO && (::fcntl(descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY;
}

bool is_regular(int descriptor) {
  struct stat status {};
  return descriptor > STDERR_FILENO && ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

/// LLVM's thread library begins with shared memory of a page.
bool is_shared_memory(int descriptor) {
  char name[64], path[9]{};
  std::snprintf(name, sizeof name, "/proc/self/fd/%d", descriptor);
  return ::readlink(name, path, sizeof path) == sizeof path &&
         std::memcmp(path, "/dev/shm/", sizeof path) == 0;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

std::size_t fwrite(const void* from, std::size_t size, std::size_t count, std::FILE* stream) {
  static auto* const original =
      next<std::size_t(const void*, std::size_t, std::size_t, std::FILE*)>("fwrite");
  return is_file(stream) && fails("fwrite") ? 0 : original(from, size, count, stream);
}

int fflush(std::FILE* stream) {
  static auto* const original = next<int(std::FILE*)>("fflush");
  return is_file(stream) && fails("fflush") ? EOF : original(stream);
}

int fclose(std::FILE* stream) {
  static auto* const original = next<int(std::FILE*)>("fclose");
  const bool failing = is_file(stream) && fails("fclose");
  const int result = original(stream);
  if (!failing) return result;
  errno = ENOSPC;
  return EOF;
}

std::FILE* fopen(const char* path, const char* mode) {
  static auto* const original = next<std::FILE*(const char*, const char*)>("fopen");
  return std::strpbrk(mode, "wa+") != nullptr && fails("fopen") ? nullptr : original(path, mode);
}

int fsync(int descriptor) {
  static auto* const original = next<int(int)>("fsync");
  return fails("fsync") ? -1 : original(descriptor);
}

int fdatasync(int descriptor) {
  static auto* const original = next<int(int)>("fdatasync");
  return fails("fdatasync") ? -1 : original(descriptor);
}

int ftruncate(int descriptor, off_t size) {
  static auto* const original = next<int(int, off_t)>("ftruncate");
  return !is_shared_memory(descriptor) && fails("ftruncate") ? -1 : original(descriptor, size);
}

ssize_t write(int descriptor, const void* from, std::size_t size) {
  static auto* const original = next<ssize_t(int, const void*, std::size_t)>("write");
  return is_regular(descriptor) && fails("write") ? -1 : original(descriptor, from, size);
}

ssize_t pwrite(int descriptor, const void* from, std::size_t size, off_t at) {
  static auto* const original = next<ssize_t(int, const void*, std::size_t, off_t)>("pwrite");
  return is_regular(descriptor) && fails("pwrite") ? -1 : original(descriptor, from, size, at);
}

ssize_t pwrite64(int descriptor, const void* from, std::size_t size, off64_t at) {
  static auto* const original = next<ssize_t(int, const void*, std::size_t, off64_t)>("pwrite64");
  return is_regular(descriptor) && fails("pwrite") ? -1 : original(descriptor, from, size, at);
}

int rename(const char* from, const char* to) {
  static auto* const original = next<int(const char*, const char*)>("rename");
  return fails("rename") ? -1 : original(from, to);
}

int mkdir(const char* path, unsigned mode) {
  static auto* const original = next<int(const char*, unsigned)>("mkdir");
  return fails("mkdir") ? -1 : original(path, mode);
}
}
