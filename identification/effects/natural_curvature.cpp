#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// Curvature of the free wire, positive with the bulge.
Parameter natural_curvature() {
  return {.key = "wire.natural_curvature_1_m",
          .unit = "1/m",
          .number = member([](auto& p, auto&) -> auto& { return p.wire.natural_curvature; }),
          .limits = [](const PushProblem&) { return between(-100.0, 100.0); },
          .step = 1e-3};
}

std::string rigid_clamps(const std::vector<Series>& series) {
  for (const Series& s : series) {
    const bool rigid = s.test.mount.kind == wire::MountKind::clamped && !s.test.mount.rotational_stiffness;
    if (s.test.mount.kind == wire::MountKind::supports)
      return "a naturally curved wire on supports is not computed";
    if (!rigid) return "";
  }
  return "a uniform natural curvature changes nothing between rigid clamps";
}

}  // namespace

/// The wire is naturally curved, uniformly, in the plane of the bulge (as it comes from the reel).
Effect natural_curvature_effect() {
  return {.name = "natural_curvature",
          .channel = Channel::wire,
          .meaning = "the free wire is curved",
          .numbers = {{natural_curvature(), -50.0, 50.0}},
          .unobservable = rigid_clamps,
          .independent_check = "lay the free wire on a table and measure its curvature"};
}

}  // namespace snare::identification
