#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace snare::base {

/// Content of a file that the program itself has written to continue from: no input, and read again whenever
/// it is asked for. Throws InputError as read_text.
[[nodiscard]] std::string read_own(const std::filesystem::path& path, std::size_t limit);

}  // namespace snare::base
