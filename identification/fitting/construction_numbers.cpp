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
       .get = [](const PushProblem& p, const ReadingModel&) { return p.wire.diameter; },
       .set = [](PushProblem& p, ReadingModel&, double v) { p.wire.diameter = v; },
       .lower = [](const PushProblem& p) { return 0.5 * p.wire.diameter; },
       .upper = [](const PushProblem& p) { return 1.5 * p.wire.diameter; },
       .step = 1e-8},
      {.key = "wire.youngs_modulus_GPa",
       .unit = "GPa",
       .unit_size = GPa,
       .parametrisation = Parametrisation::ratio,
       .get = [](const PushProblem& p, const ReadingModel&) { return p.wire.youngs_modulus; },
       .set = [](PushProblem& p, ReadingModel&, double v) { p.wire.youngs_modulus = v; },
       .lower = [](const PushProblem& p) { return 0.01 * p.wire.youngs_modulus; },
       .upper = [](const PushProblem& p) { return 3.0 * p.wire.youngs_modulus; },
       .step = 1e-3},
      {.key = "wire.density_kg_m3",
       .unit = "kg/m^3",
       .parametrisation = Parametrisation::ratio,
       .get = [](const PushProblem& p, const ReadingModel&) { return p.wire.density; },
       .set = [](PushProblem& p, ReadingModel&, double v) { p.wire.density = v; },
       .lower = [](const PushProblem& p) { return 0.2 * p.wire.density; },
       .upper = [](const PushProblem& p) { return 5.0 * p.wire.density; },
       .step = 1e-3},
      {.key = "mount.support_radius_mm",
       .unit = "mm",
       .unit_size = mm,
       .get = [](const PushProblem& p, const ReadingModel&) { return p.mount.support_radius; },
       .set = [](PushProblem& p, ReadingModel&, double v) { p.mount.support_radius = v; },
       .lower = [](const PushProblem&) { return 0.0; },
       .upper = [](const PushProblem& p) { return 0.2 * p.mount.span; },
       .step = 1e-7},
      {.key = "pusher.radius_mm",
       .unit = "mm",
       .unit_size = mm,
       .get = [](const PushProblem& p, const ReadingModel&) { return p.pusher.radius; },
       .set = [](PushProblem& p, ReadingModel&, double v) { p.pusher.radius = v; },
       .lower = [](const PushProblem& p) { return 0.1 * p.pusher.radius; },
       .upper = [](const PushProblem& p) { return 10.0 * p.pusher.radius; },
       .step = 1e-7}};
  return all;
}

}  // namespace snare::identification
