// Replaces operator new by one that fails when it is told to.

#include "tests/faults/failing_new.hpp"

#include <cstdlib>
#include <new>

namespace snare::test {
thread_local long allocations_left = 0;
}

/// TinyXML itself leaks what it was building; the command ends then.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the sanitizer's name for it
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libtinyxml";
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

namespace {

void* allocate(std::size_t size) {
  if (snare::test::allocations_left > 0 && --snare::test::allocations_left == 0) return nullptr;
  return std::malloc(size > 0 ? size : 1);
}

}  // namespace

void* operator new(std::size_t size) {
  void* const memory = allocate(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new[](std::size_t size) {
  return operator new(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return allocate(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
