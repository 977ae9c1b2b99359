// A body meets a taut wire at mid-span, is slowed down, and thrown back.
//
// The body of 50 kg moves as on a spring, since the wire's waves run to and fro 140 times meanwhile: k is
// that of a clamped wire under tension, the contact lasts pi sqrt(m/k), m being the body's mass and a third
// of the wire's, and the speed is reversed.
#include <snare/coupling/contact/tensioned_wire.hpp>
#include <snare/coupling/dynamics/model/start.hpp>
#include <snare/coupling/dynamics/run/simulate.hpp>
#include <snare/wire/motion/rod_in_motion.hpp>

#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

int main() {
  namespace coupling = snare::coupling;
  constexpr double span = 1.0, speed = 0.002, mass = 50.0;  // m, m/s, kg
  snare::wire::WireSpecification steel;
  steel.diameter = 1e-3;
  steel.length = 0.999;  // stretched by 0.1 %
  steel.youngs_modulus = 193e9;
  steel.density = 7930.0;

  coupling::Motion motion;
  snare::wire::RodInMotion rod = snare::wire::rod_in_motion(steel, span, 40);
  // it bends within 8 mm of mounts and ball, elements have 25 mm
  rod.formulation = snare::wire::Formulation::higher_order;
  motion.wires.push_back({"wire", rod, coupling::straight_wire(rod, {0, 0, 0}, {span, 0, 0}), {}});
  coupling::MotionBody body;
  body.properties.mass = mass;
  body.start.position = {0.5 * span, -7e-3, 0.0};  // a ball of 6 mm, 0.5 mm below the wire's surface
  body.start.velocity = {0.0, speed, 0.0};
  motion.bodies.push_back(body);
  coupling::MotionContact contact;
  contact.shape = std::make_shared<coupling::Ball>(6e-3);
  contact.wire_radius = 0.5 * steel.diameter;
  motion.contacts.push_back(contact);

  coupling::MotionOptions options;
  options.duration = 1.3;
  // The body leaves when the wire's vibration, 6 ms a period, lets it go: it is followed, 0.3 um of 0.6 mm
  // would not do.
  options.position_tolerance = 1e-8;  // m
  options.velocity_tolerance = 1e-4;  // m/s
  const coupling::MotionResult result = coupling::simulate(motion, options);
  if (!result.report.usable()) {
    std::cerr << result.report.message << '\n';
    return 1;
  }
  const double tension = steel.axial_stiffness() * (span / steel.length - 1.0);
  const double k = coupling::tensioned_stiffness(steel.bending_stiffness(), tension, span, 0.5 * span).value;
  const double m = mass + steel.mass_per_length() * span / 3.0;
  const double lasted = result.events.back().time - result.events.front().time;
  std::cout << "contact over half a period of mass and spring: "
            << lasted / (std::numbers::pi * std::sqrt(m / k)) << '\n'
            << "impulse over twice the momentum of the body: " << result.impulse[0].y() / (2.0 * mass * speed)
            << '\n'
            << "energy that the integrator lost: " << -result.energy.integrator << " J\n";
}
