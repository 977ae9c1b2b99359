// Entry point for libFuzzer: the readers that need the whole product, linked with the libraries of the
// optimised build. Not part of the build, which uses GCC: fuzz.py builds and runs it with clang.

#include "tests/fuzz/checkpoint_reader.hpp"
#include "tests/fuzz/file_readers.hpp"

#include <cstddef>
#include <cstdint>

/// The first byte chooses the reader.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snare::fuzz;
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0]) {
    case 'S':
      return static_cast<void>(read_bytes_as_scenario(bytes)), 0;
    case 'R':
      return static_cast<void>(read_bytes_as_record(bytes)), 0;
    case 'W':
      return static_cast<void>(read_bytes_as_sweep(bytes)), 0;
    case 'J':
      return static_cast<void>(read_bytes_as_journal(bytes)), 0;
    case 'D':
      return static_cast<void>(read_bytes_as_ring_down(bytes)), 0;
    case 'I':
      return static_cast<void>(read_bytes_as_wire(bytes)), 0;
    case 'A':
      return static_cast<void>(read_bytes_as_arm(bytes)), 0;
    case 'L':
      return static_cast<void>(read_bytes_as_law(bytes)), 0;
    case 'K':
      return static_cast<void>(read_bytes_as_checkpoint(bytes)), 0;
    default:
      return -1;  // not kept
  }
}
