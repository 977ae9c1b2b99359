#include "coupling/statics/push_curve.hpp"

#include <cstddef>

namespace snare::coupling {

std::string to_string(PushEvent::Kind kind) {
  static constexpr const char* names[] = {"first touch", "lift-off",    "touch",       "slip begins",
                                          "slip ends",   "wrap begins", "wrap ends",   "mount slips",
                                          "mount holds", "fold",        "bifurcation", "snap"};
  return names[static_cast<std::size_t>(kind)];
}

}  // namespace snare::coupling
