#include "base/own_file.hpp"

#include "base/files.hpp"
#include "base/inputs.hpp"

namespace snare::base {

std::string read_own(const std::filesystem::path& path, std::size_t limit) {
  const InputScope none(nullptr);
  return read_text(path, limit);
}

}  // namespace snare::base
