#include "identification/effects/effect.hpp"

namespace snare::identification {

/// The mounts (or the supports) stand at another distance than declared.
Effect span_effect() {
  Effect e;
  e.name = "span";
  e.channel = Channel::geometry;
  e.meaning = "the distance of the mounts is not as declared";
  e.numbers = {{"mount.span_mm", 0.0, 1e6}};
  e.independent_check = "measure the distance of the mounts with a calliper under no load";
  return e;
}

}  // namespace snare::identification
