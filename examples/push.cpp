// Pushes a loose wire at three places and prints the force after 1.5 mm of travel.
//
// The wire is that of the published static tests: solid steel, 1.5 mm thick, 180 mm long between clamps 175
// mm apart. A knife edge pushes it outward, with its bulge. At mid-span the extensible elastica has the
// same answer, 232.983 N.
#include <snare/coupling/statics/push_solver.hpp>

#include <iostream>

int main() {
  snare::coupling::PushProblem push;  // SI units: lengths in m, moduli in Pa
  push.wire.diameter = 1.5e-3;
  push.wire.length = 0.180;
  push.wire.youngs_modulus = 193e9;
  push.wire.poisson_ratio = 0.29;
  push.wire.density = 7930.0;
  push.mount.kind = snare::wire::MountKind::clamped;
  push.mount.span = 0.175;
  for (int i = 1; i <= 5; ++i) push.travel.push_back(0.3e-3 * i);

  for (const double position : {0.040, 0.065, 0.0875}) {
    push.contact_position = position;  // along the chord, from the left mount
    const snare::coupling::ExtrapolatedCurve result = snare::coupling::solve_push_extrapolated(push, {});
    if (!result.curve.report.usable()) {  // a solve that does not converge is no exception
      std::cerr << result.curve.report.message << '\n';
      return 1;
    }
    std::cout << "force at " << 1e3 * position << " mm: " << result.curve.points.back().force << " N, to "
              << result.discretisation_error.back() << " N\n";
  }
}
