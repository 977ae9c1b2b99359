#include "identification/records/slowest_mode.hpp"

#include "base/index.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::identification {

namespace {

/// 1/m and 1/J of a carrier; none where it does not give way.
struct Mobility {
  double shift = 0.0, turn = 0.0;
};

Mobility mobility(const coupling::Motion& motion, const coupling::MotionCarrier& carrier,
                  const Eigen::Vector3d& place) {
  if (carrier.kind != coupling::MotionCarrier::Kind::body) return {};
  const coupling::MotionBody& body = motion.bodies[base::at(carrier.index)];
  if (body.driven) return {};
  const Eigen::Vector3d arm = body.start.orientation.conjugate() * (place - body.start.position);
  const Eigen::Matrix3d about_place =
      body.properties.inertia +
      body.properties.mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(about_place).eigenvalues()[2];
  return {1.0 / body.properties.mass, 1.0 / largest};
}

/// Smallest spring that is one.
double softest(const Eigen::Vector3d& stiffness) {
  double least = 0.0;
  for (const double k : stiffness)
    if (k > 0.0 && (least == 0.0 || k < least)) least = k;
  return least;
}

}  // namespace

std::optional<SlowMode> slowest_mode(const coupling::Motion& motion) {
  std::optional<SlowMode> slowest;
  const auto found = [&](const std::string& of, double period) {
    if (!slowest || period > slowest->period) slowest = {of, period};
  };
  constexpr double no_spring = 1e-6;  // Hz, of a mode without stiffness by rounding
  for (const coupling::MotionArm& arm : motion.arms) {
    for (const multibody::ArmMode& mode : multibody::natural_modes(arm.arm, arm.start.q, arm.drives)) {
      if (!(mode.frequency > no_spring)) continue;
      found(fmt::format("arm {}", arm.name), 1.0 / mode.frequency);
      break;  // they ascend
    }
  }
  for (const coupling::MotionBushing& bushing : motion.bushings) {
    const Mobility first = mobility(motion, bushing.first, bushing.X_WF.p);
    const Mobility second = mobility(motion, bushing.second, bushing.X_WF.p);
    const double shift = softest(bushing.translational_stiffness) * (first.shift + second.shift);
    const double turn = softest(bushing.rotational_stiffness) * (first.turn + second.turn);
    if (shift > 0.0)
      found(fmt::format("bushing {}, shifting", bushing.name), 2.0 * std::numbers::pi / std::sqrt(shift));
    if (turn > 0.0)
      found(fmt::format("bushing {}, turning", bushing.name), 2.0 * std::numbers::pi / std::sqrt(turn));
  }
  return slowest;
}

}  // namespace snare::identification
