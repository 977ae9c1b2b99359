#include "base/units.hpp"
#include "identification/fitting/parameter.hpp"

#include <array>

namespace snare::identification {

bool stiffnesses_declared(const PushProblem& p) {
  return p.wire.bending_stiffness_override && p.wire.axial_stiffness_override && !p.wire.yielding;
}

bool weightless(const PushProblem& p) {
  return p.gravity == std::array<double, 3>{};
}

namespace {

const char* modulus_unseen(const PushProblem& p) {
  return stiffnesses_declared(p) ? "both stiffnesses are declared: they do not follow from the modulus" : "";
}

const char* density_unseen(const PushProblem& p) {
  return weightless(p) ? "the wire has no weight: declare [gravity] vector_m_s2" : "";
}

const char* supports_unseen(const PushProblem& p) {
  return p.mount.kind == wire::MountKind::supports ? "" : "only a wire on supports touches them";
}

const char* knife_edge(const PushProblem& p) {
  return p.pusher.radius > 0.0 ? "" : "a knife edge has none: declare a radius > 0 to start from";
}

}  // namespace

const std::vector<Parameter>& construction_numbers() {
  using base::GPa;
  using base::mm;
  static const std::vector<Parameter> all{
      {.key = "wire.youngs_modulus_GPa",
       .unit = "GPa",
       .unit_size = GPa,
       .parametrisation = Parametrisation::ratio,
       .number = member([](auto& p, auto&) -> auto& { return p.wire.youngs_modulus; }),
       .limits =
           [](const PushProblem& p) {
             return between(0.01 * p.wire.youngs_modulus, 3.0 * p.wire.youngs_modulus);
           },
       .step = 1e-3,
       .unseen = modulus_unseen},
      {.key = "wire.density_kg_m3",
       .unit = "kg/m^3",
       .parametrisation = Parametrisation::ratio,
       .number = member([](auto& p, auto&) -> auto& { return p.wire.density; }),
       .limits = [](const PushProblem& p) { return between(0.2 * p.wire.density, 5.0 * p.wire.density); },
       .step = 1e-3,
       .unseen = density_unseen},
      {.key = "mount.support_radius_mm",
       .unit = "mm",
       .unit_size = mm,
       .number = member([](auto& p, auto&) -> auto& { return p.mount.support_radius; }),
       .limits = [](const PushProblem& p) { return between(0.0, 0.2 * p.mount.span); },
       .step = 1e-7,
       .unseen = supports_unseen},
      {.key = "pusher.radius_mm",
       .unit = "mm",
       .unit_size = mm,
       .number = member([](auto& p, auto&) -> auto& { return p.pusher.radius; }),
       .limits = [](const PushProblem& p) { return between(0.1 * p.pusher.radius, 10.0 * p.pusher.radius); },
       .step = 1e-7,
       .unseen = knife_edge}};
  return all;
}

}  // namespace snare::identification
