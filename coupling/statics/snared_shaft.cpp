#include "coupling/statics/snared_shaft.hpp"

#include "coupling/statics/out_of_plane.hpp"
#include "coupling/statics/path_follower.hpp"
#include "coupling/statics/spatial_contact.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <numbers>
#include <optional>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int newton_iterations = 24;
constexpr double smallest_step = 1e-9;  // [m]

/// One wire of the snare in its own frame: chord along x, outward along y, the shaft along z.
class HeldWire final : public FollowedPath {
 public:
  /// Pushes the wire to its seat and lets the friction act from there.
  [[nodiscard]] numerics::SolveReport seat(const SnareSpecification& snare);
  /// Moves the shaft by a straight way [m].
  [[nodiscard]] numerics::SolveReport move(const Vector3d& by);

  /// Of the shaft on the wire [N].
  [[nodiscard]] Vector3d force() const { return SpatialPushSystem::force(point_); }
  [[nodiscard]] double energy() const { return contact_->energy(point_); }
  [[nodiscard]] double dissipated() const { return contact_->dissipated(); }
  [[nodiscard]] bool slides() const { return contact_->slides(); }
  [[nodiscard]] bool touches() const { return contact_->pin().pressed; }

  /// Way of the shaft along the present move [m].
  [[nodiscard]] double parameter() const override { return point_.parameter; }
  [[nodiscard]] StepOutcome step_to(double way) override;
  [[nodiscard]] numerics::SolveReport without_steps(double /*target*/,
                                                    const numerics::SolveReport& last) override {
    return last;
  }

 private:
  std::optional<SpatialContact> contact_;
  numerics::PathPoint point_;  // last accepted
};

// In the plane to the travel `seat` in tenths; a step that fails is halved. `at` begins and ends there.
numerics::SolveReport push_to(PushSystem& system, numerics::PathPoint& at, double seat) {
  numerics::PathWorkspace workspace;
  double step = 0.1 * seat;
  while (at.parameter < seat) {
    numerics::PathPoint trial = at;
    trial.parameter = std::min(seat, at.parameter + step);
    numerics::SolveReport report = numerics::correct(system, trial, workspace, newton_iterations);
    if (report.usable()) {
      at = trial;
      continue;
    }
    step *= 0.5;
    if (step < smallest_step) return report;
  }
  return {};
}

numerics::SolveReport HeldWire::seat(const SnareSpecification& snare) {
  PushProblem planar = snare.wire;
  planar.contact_position = 0.5 * planar.mount.span;
  planar.pusher.friction = 0.0;
  PushSetup setup = prepare_push(planar, snare.elements, -1.0, 1);
  if (!setup.report.usable()) return setup.report;
  setup.system->sliding[0].status = ContactStatus::slip;
  numerics::PathPoint at = setup.start;
  if (numerics::SolveReport report = push_to(*setup.system, at, snare.seat); !report.usable()) return report;

  SpatialPin pin;
  const Vector2d centre = setup.system->pusher_centre(at);
  pin.centre = {centre.x(), centre.y(), 0.0};
  pin.friction = snare.wire.pusher.friction;
  contact_.emplace(setup, at, spatial_rod(*setup.rod, snare.wire.wire.torsional_stiffness()), pin,
                   SlidingLength::stretched);
  point_ = contact_->start();
  numerics::SolveReport report = contact_->solve(point_, newton_iterations);
  if (!report.usable()) return report;
  contact_->accept(point_);
  contact_->forget_dissipation();
  return report;
}

StepOutcome HeldWire::step_to(double way) {
  const SpatialPin saved = contact_->pin();
  numerics::PathPoint trial = point_;
  trial.parameter = way;
  numerics::SolveReport report = contact_->settle(trial, newton_iterations).report;
  if (!report.usable()) {
    contact_->pin() = saved;
    return {StepOutcome::Kind::failed, report};
  }
  if (contact_->pin().pressed && contact_->wraps(trial)) {
    report.end(numerics::Termination::step_too_small,
               "a wire begins to wrap the shaft, which is computed for a push in the plane only");
    return {StepOutcome::Kind::stopped, report};
  }
  contact_->accept(trial);
  point_ = trial;
  return {StepOutcome::Kind::taken, report};
}

numerics::SolveReport HeldWire::move(const Vector3d& by) {
  const double length = by.norm();
  if (length == 0.0) return {};
  SpatialPin& pin = contact_->pin();
  pin.motion = by / length;
  point_.parameter = 0.0;
  numerics::SolveReport report = follow(*this, length, {smallest_step, StepMeasure::planned});
  if (!report.usable()) return report;
  // The next move counts from here.
  pin.centre += length * pin.motion;
  point_.parameter = 0.0;
  return report;
}

}  // namespace

ShaftPath move_shaft(const SnareSpecification& snare, const std::vector<Eigen::Vector3d>& way) {
  ShaftPath path;
  std::vector<HeldWire> wires(static_cast<std::size_t>(snare.wires));
  std::vector<Eigen::Matrix3d> from_wire;
  for (std::size_t i = 0; i < wires.size(); ++i) {
    path.report = wires[i].seat(snare);
    if (!path.report.usable()) return path;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / snare.wires;
    from_wire.push_back(Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix());
  }
  Vector3d now = Vector3d::Zero();
  for (const Vector3d& next : way) {
    ShaftPoint point;
    point.displacement = next;
    for (std::size_t i = 0; i < wires.size(); ++i) {
      path.report = wires[i].move(from_wire[i].transpose() * (next - now));
      if (!path.report.usable()) {
        path.report.message =
            fmt::format("wire {} on the way to ({:.4g}, {:.4g}, {:.4g}) mm: {}", i + 1, 1e3 * next.x(),
                        1e3 * next.y(), 1e3 * next.z(), path.report.message);
        return path;
      }
      point.force += from_wire[i] * wires[i].force();
      point.energy += wires[i].energy();
      point.dissipated += wires[i].dissipated();
      point.slipping += wires[i].slides() ? 1 : 0;
      point.touching += wires[i].touches() ? 1 : 0;
    }
    now = next;
    path.points.push_back(point);
  }
  return path;
}

}  // namespace snare::coupling
