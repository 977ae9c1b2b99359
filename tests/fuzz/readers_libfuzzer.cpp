// Entry point for libFuzzer. Not part of the build, which uses GCC; with clang, from the root of the repository (bash):
//   clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined -I. tests/fuzz/readers_libfuzzer.cpp
//     base/{errors,range,files,csv,toml_tree,toml_reader}.cpp wire/specification.cpp scenario/push_reader.cpp
//     identification/{fitting/{experiment,parameter,parameter_set,construction_numbers},effects/*}.cpp
//     -lfmt -o readers_fuzzer
//   ./readers_fuzzer -max_len=65536

#include "tests/fuzz/readers.hpp"

#include <cstddef>
#include <cstdint>

/// The first byte chooses the reader.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 2 == 0)
    static_cast<void>(snare::fuzz::read_bytes_as_csv(bytes));
  else
    static_cast<void>(snare::fuzz::read_bytes_as_experiment(bytes));
  return 0;
}
