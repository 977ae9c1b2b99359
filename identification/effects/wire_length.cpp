#include "identification/effects/effect.hpp"

#include "base/units.hpp"

namespace snare::identification {

namespace {

/// Unstressed length between the mounts.
Parameter length() {
  return {.key = "wire.length_mm",
          .unit = "mm",
          .unit_size = base::mm,
          .number = member([](auto& p, auto&) -> auto& { return p.wire.length; }),
          .limits = [](const PushProblem& p) { return between(0.99 * p.mount.span, 1.2 * p.mount.span); },
          .step = 1e-7};
}

}  // namespace

/// More or less wire between the mounts than declared.
Effect wire_length_effect() {
  return {.name = "wire_length",
          .channel = Channel::geometry,
          .meaning = "the length of wire between the mounts is not as declared",
          .numbers = {{length(), 0.0, 1e6}},
          .unobservable = needs_mounts,
          .independent_check = "mark the wire at the mounts, take it out and measure the marks' distance"};
}

}  // namespace snare::identification
