// Entry point for libFuzzer. Not part of the build, which uses GCC: fuzz.py builds and runs it with clang.

#include "tests/fuzz/model_readers.hpp"
#include "tests/fuzz/readers.hpp"

#include <cstddef>
#include <cstdint>

/// The first byte chooses the reader.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace snare::fuzz;
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0]) {
    case 'c':
      return static_cast<void>(read_bytes_as_csv(bytes)), 0;
    case 'e':
      return static_cast<void>(read_bytes_as_experiment(bytes)), 0;
    case 'u':
      return static_cast<void>(read_bytes_as_urdf(bytes)), 0;
    case 's':
      return static_cast<void>(read_bytes_as_mesh(bytes, ".stl")), 0;
    case 'b':
      return static_cast<void>(read_bytes_as_mesh(bytes, ".obj")), 0;
    case 'f':
      return static_cast<void>(read_bytes_as_mesh(bytes, ".off")), 0;
    case 'a':
      return static_cast<void>(read_bytes_as_archive(bytes)), 0;
    default:
      return -1;  // not kept
  }
}
