#include "identification/effects/effect.hpp"

#include "base/units.hpp"

namespace snare::identification {

namespace {

/// Distance of the mounts.
Parameter span() {
  return {.key = "mount.span_mm",
          .unit = "mm",
          .unit_size = base::mm,
          .number = member([](auto& p, auto&) -> auto& { return p.mount.span; }),
          .limits = [](const PushProblem& p) { return between(0.8 * p.mount.span, p.wire.length / 0.99); },
          .step = 1e-7};
}

}  // namespace

/// The mounts (or the supports) stand at another distance than declared.
Effect span_effect() {
  return {.name = "span",
          .channel = Channel::geometry,
          .meaning = "the distance of the mounts is not as declared",
          .numbers = {{span(), 0.0, 1e6}},
          .independent_check = "measure the distance of the mounts with a calliper under no load"};
}

}  // namespace snare::identification
