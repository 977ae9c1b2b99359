#include "coupling/dynamics/model/start.hpp"

#include "base/units.hpp"
#include "validation/declared_wire.hpp"
#include "wire/motion/rod_in_motion.hpp"
#include "wire/motion/rod_rest.hpp"

#include <gtest/gtest.h>

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/tools/roots.hpp>

namespace snare::coupling {
namespace {

using base::mm;
using Kind = wire::SpatialEnd::Kind;

constexpr double mounts_apart = 175.0 * mm;

/// Thrust of an inextensible elastica between pins, (2 K(k))^2 EI/L^2 with l/L = 2 E(k)/K(k) - 1, l between
/// the pins [N].
double thrust_between_pins(double stiffness, double length) {
  const auto excess = [length](double k) {
    return 2.0 * boost::math::ellint_2(k) / boost::math::ellint_1(k) - 1.0 - mounts_apart / length;
  };
  const auto [low, high] =
      boost::math::tools::bisect(excess, 0.0, 0.9, boost::math::tools::eps_tolerance<double>(40));
  const double K = boost::math::ellint_1(0.5 * (low + high));
  return 4.0 * K * K * stiffness / (length * length);
}

// Between its inflections a clamped wire is one between pins, half as long: four times the thrust.
TEST(RestingWire, IsThatOfItsMounts) {
  for (const auto& [kind, factor] : {std::pair(Kind::clamp, 4.0), std::pair(Kind::twisting_pin, 1.0)}) {
    for (const auto formulation : {wire::Formulation::vertices, wire::Formulation::higher_order}) {
      wire::RodInMotion rod = wire::rod_in_motion(validation::declared_specification(), mounts_apart, 60);
      rod.properties.left.kind = rod.properties.right.kind = kind;
      rod.formulation = formulation;
      const Eigen::Matrix3Xd start = resting_wire(rod);
      const wire::RodRest rest = wire::find_rest(rod, start);
      ASSERT_TRUE(rest.report.usable()) << rest.report.message;
      EXPECT_LT((rest.positions - start).cwiseAbs().maxCoeff(), 1e-7) << factor;  // m
      const double thrust = factor * thrust_between_pins(rod.properties.bending_stiffness, rod.length);
      EXPECT_NEAR(rest.energies.mount_forces[0].norm(), thrust, 2e-3 * thrust) << factor;
    }
  }
}

// Of few edges that turn far, and stiff along themselves: what begins from these places is at rest.
TEST(RestingWire, OfFewEdgesRests) {
  wire::WireSpecification steel;
  steel.diameter = 1.0 * mm;
  steel.length = 182.0 * mm;
  steel.youngs_modulus = 200e9;
  steel.density = 8000.0;
  for (const int elements : {8, 12, 16}) {
    wire::RodInMotion rod = wire::rod_in_motion(steel, mounts_apart, elements);
    rod.formulation = wire::Formulation::higher_order;
    const wire::RodRest rest = wire::find_rest(rod, resting_wire(rod));
    ASSERT_TRUE(rest.report.usable()) << rest.report.message;
    EXPECT_LE(rest.report.iterations, 1) << elements;
    const double thrust = 4.0 * thrust_between_pins(rod.properties.bending_stiffness, rod.length);
    EXPECT_NEAR(rest.energies.mount_forces[0].norm(), thrust, 0.03 * thrust) << elements;
  }
}

}  // namespace
}  // namespace snare::coupling
