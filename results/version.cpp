#include "results/version.hpp"

namespace snare::results {

std::string version() {
  return SNARE_VERSION;
}

}  // namespace snare::results
