#include "app/commands.hpp"

#include <system_error>

namespace snare::app {

std::filesystem::path data_directory() {
  std::filesystem::path source = SNARE_SOURCE_DATA_DIR;
  if (std::filesystem::exists(source)) return source;
  std::error_code error;
  const std::filesystem::path command = std::filesystem::read_symlink("/proc/self/exe", error);
  return command.parent_path() / SNARE_INSTALLED_DATA_DIR;
}

}  // namespace snare::app
