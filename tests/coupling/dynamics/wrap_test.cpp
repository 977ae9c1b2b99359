// Wires that heavy balls drag along until they wrap them.

#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/soft_wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;

struct Drag {
  const char* name;
  double place, radius, speed, duration;  // along the wire [m], of the ball [m], [m/s], [s]
  int elements;
  double mass;
};
void PrintTo(const Drag& drag, std::ostream* out) {
  *out << drag.name;
}

class WrappedBall : public testing::TestWithParam<Drag> {};

TEST_P(WrappedBall, IsTouchedAlongAnArc) {
  const Drag& drag = GetParam();
  constexpr double wire_radius = 0.001;
  const auto ball = std::make_shared<Ball>(drag.radius);
  Motion motion =
      test::body_below(test::soft_wire(drag.elements), ball,
                       {drag.place, -drag.radius - 2.0 * wire_radius, 0.0}, drag.speed, drag.mass);
  MotionOptions options;
  // The wire stores little: balances to 1e-3 of it.
  options.body_velocity_tolerance = 1e-7;
  options.body_position_tolerance = 1e-9;
  options.duration = drag.duration;
  options.output_interval = drag.duration / 100.0;
  std::size_t most_points = 0;
  double deepest = 0.0;
  double strain = 0.0;
  const MotionResult r = simulate(motion, options, [&](const MotionSample& s) {
    most_points = std::max(most_points, s.contacts[0].points.size());
    strain = std::max(strain, s.energy.strain);
    for (const auto& x : s.wires[0].colwise())
      deepest = std::max(deepest, drag.radius + wire_radius - (x - s.bodies[0].position).norm());
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_GE(most_points, 1u);
  EXPECT_LT(r.statistics.restarts, 3);
  // Hundreds of newtons on the foundation of a wire as soft as this: a fiftieth of its radius.
  EXPECT_LT(deepest, 2e-5);
  EXPECT_LT(r.largest_penetration, 2e-5);
  EXPECT_LT(std::abs(r.energy.integrator), 1e-3 * strain);
}

INSTANTIATE_TEST_SUITE_P(Drags, WrappedBall,
                         testing::Values(Drag{"AtTheMiddle", 0.1, 0.01, 1.0, 0.08, 60, 200.0},
                                         Drag{"BesideTheMiddle", 0.17, 0.014, 2.0, 0.03, 60, 200.0},
                                         Drag{"AtTheClamp", 0.19, 0.014, 0.5, 0.05, 40, 1.0}),
                         [](const auto& drag) { return std::string(drag.param.name); });

}  // namespace
}  // namespace snare::coupling
