#include "app/report/version.hpp"

namespace snare::app {

std::string version() {
  return SNARE_VERSION;
}

}  // namespace snare::app
