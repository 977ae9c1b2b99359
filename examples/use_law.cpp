// Distils a wire into a table of its force and uses the table in a simulator of ten lines.
//
// A body of 8.9 kg hits the wire of a wire file at mid-span. The simulator knows the wire by its table
// alone. How deep the body gets is known beforehand: to where the table's work, the integral of the force,
// is the body's kinetic energy.
#include <snare/reduction/distil.hpp>

#include <algorithm>
#include <exception>
#include <iostream>

int main(int count, char** arguments) try {
  if (count != 2) {
    std::cerr << "usage: example_use_law WIRE.toml\n";
    return 2;
  }
  namespace reduction = snare::reduction;
  reduction::WireFile file = reduction::read_wire_file(arguments[1]);
  file.impacts.reset();                                           // no runs in motion
  file.settings.points = file.settings.most_points = {12, 4, 3};  // a coarse table: travel, position, slack
  const reduction::Distillation distilled = reduction::distil(file);
  if (!distilled.report.usable()) {
    std::cerr << distilled.report.message << '\n';
    return 3;
  }
  const reduction::DistilledCase& wire = distilled.cases.front();
  std::cout << "stated error of the table: " << wire.table.loading_error.bound << " N\n";
  const auto force = wire.table.loading->curve(0.5 * wire.wire.test.mount.span, wire.wire.nominal_slack());

  constexpr double mass = 8.9, speed = 0.05, step = 1e-5;  // kg, m/s, s
  double travel = 0.0, velocity = speed, deepest = 0.0;
  while (travel >= 0.0) {  // the leapfrog method; beyond the wire there is no force
    velocity -= 0.5 * step * force.value(travel) / mass;
    travel += step * velocity;
    velocity -= 0.5 * step * force.value(std::max(travel, 0.0)) / mass;
    deepest = std::max(deepest, travel);
  }
  std::cout << "deepest travel: " << 1e3 * deepest << " mm\n"
            << "work of the wire to there over the kinetic energy: "
            << force.integral(deepest) / (0.5 * mass * speed * speed) << '\n'
            << "speed of return over that of approach: " << -velocity / speed << '\n';
} catch (const std::exception& problem) {
  std::cerr << problem.what() << '\n';
  return 2;
}
