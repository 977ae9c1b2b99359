#include "app/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

namespace snare::app {

void tell(std::string_view text) noexcept {
  [[maybe_unused]] const std::size_t ignored = std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void open_standard_streams() noexcept {
  // The lowest free descriptor is given out: in ascending order each is its own. What is written to the
  // second fails, as it would.
  for (const auto& [stream, mode] :
       {std::pair{STDIN_FILENO, O_RDWR}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_RDWR}}) {
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) [[maybe_unused]]
      const int opened = ::open("/dev/null", mode);
  }
}

}  // namespace snare::app
