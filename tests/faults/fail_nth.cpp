// Preloaded into the command: one call of the system fails, once. SNARE_FAIL_CALL names it, SNARE_FAIL_AT counts it from 1.
// Standard streams are left alone.

#include <dlfcn.h>
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
  errno = ENOSPC;
  return true;
}

bool is_file(std::FILE* stream) {
  return stream != nullptr && ::fileno(stream) > STDERR_FILENO;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

std::size_t fwrite(const void* from, std::size_t size, std::size_t count, std::FILE* stream) {
  static auto* const original = next<std::size_t(const void*, std::size_t, std::size_t, std::FILE*)>("fwrite");
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

int fsync(int descriptor) {
  static auto* const original = next<int(int)>("fsync");
  return fails("fsync") ? -1 : original(descriptor);
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
