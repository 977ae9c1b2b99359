#include "base/units.hpp"
#include "identification/fitting/parameter.hpp"

namespace snare::identification {

const std::vector<Parameter>& construction_numbers() {
  using base::GPa;
  using base::mm;
  static const std::vector<Parameter> all{
      {.key = "wire.diameter_mm",
       .unit = "mm",
       .unit_size = mm,
       .number = member([](auto& p, auto&) -> auto& { return p.wire.diameter; }),
       .limits = [](const PushProblem& p) { return between(0.5 * p.wire.diameter, 1.5 * p.wire.diameter); },
       .step = 1e-8},
      {.key = "wire.youngs_modulus_GPa",
       .unit = "GPa",
       .unit_size = GPa,
       .parametrisation = Parametrisation::ratio,
       .number = member([](auto& p, auto&) -> auto& { return p.wire.youngs_modulus; }),
       .limits =
           [](const PushProblem& p) { return between(0.01 * p.wire.youngs_modulus, 3.0 * p.wire.youngs_modulus); },
       .step = 1e-3},
      {.key = "wire.density_kg_m3",
       .unit = "kg/m^3",
       .parametrisation = Parametrisation::ratio,
       .number = member([](auto& p, auto&) -> auto& { return p.wire.density; }),
       .limits = [](const PushProblem& p) { return between(0.2 * p.wire.density, 5.0 * p.wire.density); },
       .step = 1e-3},
      {.key = "mount.support_radius_mm",
       .unit = "mm",
       .unit_size = mm,
       .number = member([](auto& p, auto&) -> auto& { return p.mount.support_radius; }),
       .limits = [](const PushProblem& p) { return between(0.0, 0.2 * p.mount.span); },
       .step = 1e-7},
      {.key = "pusher.radius_mm",
       .unit = "mm",
       .unit_size = mm,
       .number = member([](auto& p, auto&) -> auto& { return p.pusher.radius; }),
       .limits = [](const PushProblem& p) { return between(0.1 * p.pusher.radius, 10.0 * p.pusher.radius); },
       .step = 1e-7}};
  return all;
}

}  // namespace snare::identification
