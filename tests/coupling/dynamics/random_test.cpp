// Bodies of every shape that meet a loose steel wire anyhow.

#include "base/units.hpp"
#include "coupling/contact/mesh_shape.hpp"
#include "coupling/contact/revolved_solids.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/mesh_files.hpp"
#include "wire/motion/rod_in_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;

using base::mm;
constexpr double wire_radius = 0.75 * mm;

std::shared_ptr<const ContactShape> random_shape(int kind,
                                                 const std::function<double(double, double)>& between) {
  switch (kind) {
    case 0:
      return std::make_shared<Ball>(between(2.0, 15.0) * mm);
    case 1:
      return std::make_shared<Capsule>(between(1.0, 8.0) * mm, between(10.0, 60.0) * mm);
    case 2:
      return finite_cylinder(between(2.0, 10.0) * mm, between(10.0, 60.0) * mm);
    case 3:
      return truncated_cone(between(1.0, 10.0) * mm, between(3.0, 12.0) * mm, between(10.0, 40.0) * mm);
    case 4:
      return grapple_shaft({});
    case 5:
      return std::make_shared<Capsule>(0.0, between(10.0, 60.0) * mm);
    default:
      return std::make_shared<MeshShape>(
          test::cuboid(between(5.0, 40.0) * mm, between(5.0, 40.0) * mm, 10.0 * mm));
  }
}

TEST(SlowRandomMotions, EndWithTheirBalancesClosed) {
  std::mt19937 random(2);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto one_of = [&](const std::vector<double>& list) {
    return list[static_cast<std::size_t>(between(0.0, 0.999) * static_cast<double>(list.size()))];
  };
  wire::WireSpecification specification;
  specification.diameter = 2.0 * wire_radius;
  specification.youngs_modulus = 193e9;
  specification.poisson_ratio = 0.29;
  specification.density = 7930.0;
  int touched = 0;
  for (int k = 0; k < 14; ++k) {
    SCOPED_TRACE(k);
    specification.length = between(175.5, 182.0) * mm;
    wire::RodInMotion rod =
        wire::rod_in_motion(specification, 175.0 * mm, static_cast<int>(one_of({30, 47, 60})));
    rod.damping.bending_time = one_of({1e-6, 1e-5, 1e-4});
    rod.damping.axial_time = 1e-5;
    Motion motion;
    motion.wires.push_back({"wire", rod, resting_wire(rod), {}});
    MotionBody body;
    body.properties.mass = one_of({0.2, 2.0, 9.0});
    body.properties.inertia = Vector3d(0.01, 0.012, 0.009).asDiagonal();
    const double speed = one_of({0.02, 0.1, 0.5});
    body.start.position = Vector3d(between(40.0, 135.0), -between(70.0, 90.0), between(-5.0, 5.0)) * mm;
    body.start.orientation = Eigen::Quaterniond(
        Eigen::AngleAxisd(between(-3.0, 3.0), Vector3d(between(-1, 1), between(-1, 1), 1.0).normalized()));
    body.start.velocity = speed * Vector3d(between(-0.3, 0.3), 1.0, between(-0.1, 0.1));
    body.start.spin = 5.0 * speed * Vector3d(between(-1, 1), between(-1, 1), between(-1, 1));
    motion.bodies.push_back(body);
    MotionContact contact;
    contact.shape = random_shape(k % 7, between);
    contact.wire_radius = wire_radius;
    const double friction = one_of({0.0, 0.1, 0.3});
    contact.friction = {friction, friction, 0.01, 1.0};
    motion.contacts.push_back(contact);
    MotionOptions options;
    options.duration = (std::abs(body.start.position.y()) + 0.05) / speed;
    options.output_interval = options.duration / 400.0;
    double deepest = 0.0;
    const MotionResult r = simulate(motion, options, [&](const MotionSample& s) {
      for (const auto& x : s.wires[0].colwise()) {
        const Vector3d in_body = s.bodies[0].orientation.conjugate() * (x - s.bodies[0].position);
        deepest = std::max(deepest, wire_radius - contact.shape->distance(in_body));
      }
      return false;
    });
    ASSERT_TRUE(r.report.usable()) << r.report.message;
    touched += r.events.empty() ? 0 : 1;
    // Where it crosses an edge of the shape, d = (F/(4/3 k sqrt(2 (R + r))))^(2/3) (M.8).
    const wire::SpatialRodProperties& p = rod.properties;
    const double modulus = default_modulus(p.axial_stiffness, p.bending_stiffness, 2.0 * wire_radius);
    const double edge = std::sqrt(2.0 * (contact.shape->smallest_radius() + wire_radius));
    const double give = std::pow(r.peak_force[0] / (4.0 / 3.0 * modulus * edge), 2.0 / 3.0);
    EXPECT_LT(deepest, std::max(1e-6, 1.3 * give));
    EXPECT_LT(r.largest_penetration, std::max(1e-6, 1.3 * give));
    EXPECT_LT(r.events.size(), 2000u);
    // Of the body's energy, and of 0.05 J: bending the loose wire takes 0.03 to 0.4 J.
    const double energy = 0.5 * body.properties.mass * speed * speed + 0.05;
    EXPECT_LT(std::abs(r.energy.integrator), 1e-3 * energy);
  }
  EXPECT_GE(touched, 7);
}

}  // namespace
}  // namespace snare::coupling
