#include "coupling/statics/snared_shaft.hpp"

#include "coupling/statics/spatial_push.hpp"
#include "wire/loose_wire.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int newton_iterations = 24;
constexpr double smallest_step = 1e-9;  // [m]

/// One wire of the snare in its own frame: chord along x, outward along y, the shaft along z.
class HeldWire {
 public:
  /// Pushes the wire to its seat and lets the friction act from there.
  [[nodiscard]] numerics::SolveReport seat(const SnareSpecification& snare);
  /// Moves the shaft by a straight way [m].
  [[nodiscard]] numerics::SolveReport move(const Vector3d& by);

  [[nodiscard]] Vector3d force() const { return point_.border.head<3>(); }  ///< of the shaft on the wire
  [[nodiscard]] double energy() const { return rod_->energy(system_->state(point_)); }
  [[nodiscard]] double dissipated() const { return dissipated_; }
  [[nodiscard]] bool slides() const { return slides_; }
  [[nodiscard]] bool touches() const { return system_->pin.pressed; }

 private:
  [[nodiscard]] numerics::SolveReport solve(numerics::PathPoint& trial);
  [[nodiscard]] bool wraps(const numerics::PathPoint& trial) const;
  [[nodiscard]] double stretch(const wire::SpatialState& s) const;
  void accept(const numerics::PathPoint& point);

  std::unique_ptr<wire::SpatialRod> rod_;
  std::unique_ptr<SpatialPushSystem> system_;
  numerics::PathWorkspace workspace_;
  numerics::PathPoint point_;
  double dissipated_ = 0.0;
  Vector2d last_friction_ = Vector2d::Zero();
  bool slides_ = false;
};

numerics::SolveReport HeldWire::seat(const SnareSpecification& snare) {
  PushProblem planar = snare.wire;
  planar.contact_position = 0.5 * planar.mount.span;
  planar.pusher.friction = 0.0;
  PushSetup setup = prepare_push(planar, snare.elements, -1.0, 1);
  if (!setup.report.usable()) return setup.report;
  SlidingContact& pusher = setup.system->guided[0];
  pusher.status = ContactStatus::slip;
  numerics::PathPoint at = setup.start;
  double step = 0.1 * snare.seat;
  while (at.parameter < snare.seat) {
    numerics::PathPoint trial = at;
    trial.parameter = std::min(snare.seat, at.parameter + step);
    const numerics::SolveReport report =
        numerics::correct(*setup.system, trial, workspace_, newton_iterations);
    if (report.usable()) {
      at = trial;
      continue;
    }
    step *= 0.5;
    if (step < smallest_step) return report;
  }
  rod_ =
      std::make_unique<wire::SpatialRod>(spatial_rod(*setup.rod, snare.wire.wire.torsional_stiffness(), 0.0));
  const wire::PlanarState state = setup.system->state(at);
  SpatialPin pin;
  const Vector2d centre = setup.system->pusher_centre(at);
  pin.centre = {centre.x(), centre.y(), 0.0};
  pin.side = pusher.side;
  pin.radius = pusher.radius;
  pin.friction = snare.wire.pusher.friction;
  pin.last_coordinate = state.controls[1];
  const wire::SpatialState spatial = wire::in_space(*rod_, state);
  system_ = std::make_unique<SpatialPushSystem>(*rod_, spatial, pin);
  point_.band = spatial.q;
  point_.border.setZero(SpatialPushSystem::border_unknowns);
  point_.border.head<2>() = at.border.head<2>();
  point_.border[3] = at.border[2];
  point_.parameter = 0.0;
  numerics::SolveReport report = numerics::correct(*system_, point_, workspace_, newton_iterations);
  if (!report.usable()) return report;
  accept(point_);
  dissipated_ = 0.0;
  return report;
}

// |dx/dS| of the parabola through the contact and its neighbours.        theory.md (C.1)
double HeldWire::stretch(const wire::SpatialState& s) const {
  const int i = rod_->mesh().contact_vertex();
  const double before = rod_->mesh().rest_length(i - 1, s.controls);
  const double after = rod_->mesh().rest_length(i, s.controls);
  const Vector3d e0 = wire::vertex(s, i) - wire::vertex(s, i - 1);
  const Vector3d e1 = wire::vertex(s, i + 1) - wire::vertex(s, i);
  return (after / before * e0 + before / after * e1).norm() / (before + after);
}

void HeldWire::accept(const numerics::PathPoint& point) {
  const wire::SpatialState state = system_->state(point);
  const SpatialPushSystem::Geometry g = system_->geometry(point, state);
  SpatialPin& pin = system_->pin;
  slides_ = pin.pressed && pin.friction > 0.0 && system_->slides(g);
  // What slides over the shaft is stretched wire: (1 + e) dS, of which the slip of the stick condition has dS.
  const double fed = point.border[3] - pin.last_coordinate;
  const Vector2d slip =
      g.slip - (stretch(state) - 1.0) * fed * Vector2d(g.tangent.dot(g.across), g.tangent.dot(pin.axis));
  // Trapezoidal in the force; where the slip has turned round, the force it ends with.
  const bool turned = g.friction.dot(last_friction_) <= 0.0;
  if (slides_)
    dissipated_ += (turned ? g.friction : Vector2d(0.5 * (g.friction + last_friction_))).norm() * slip.norm();
  last_friction_ = g.friction;
  point_ = point;
  system_->accept(point);
  pin.last_coordinate = point.border[3];
  pin.last_normal = g.normal;
  pin.last_zeta = g.zeta;
}

// Newton's method with the contact settled: it opens where it would pull, and closes where it would be entered.
numerics::SolveReport HeldWire::solve(numerics::PathPoint& trial) {
  numerics::SolveReport report;
  for (int round = 0; round < 3; ++round) {
    report = numerics::correct(*system_, trial, workspace_, newton_iterations);
    if (!report.usable()) return report;
    SpatialPin& pin = system_->pin;
    const SpatialPushSystem::Geometry g = system_->geometry(trial, system_->state(trial));
    const double floor = 1e-9 * (system_->mount_reactions()[0].norm() + system_->mount_reactions()[1].norm());
    if (!pin.pressed && trial.border[4] < -1e-9 * system_->length_scale()) {
      pin.pressed = true;
      trial.border[4] = 0.0;
    } else if (pin.pressed && g.normal_force < -floor) {
      pin.pressed = false;
      trial.border.head<3>().setZero();
    } else {
      return report;
    }
  }
  report.termination = numerics::Termination::iteration_limit;
  report.message = "the contact does not settle";
  return report;
}

bool HeldWire::wraps(const numerics::PathPoint& trial) const {
  const SpatialPin& pin = system_->pin;
  if (pin.radius <= 0.0 || !pin.pressed) return false;
  const int i = rod_->mesh().contact_vertex();
  const wire::SpatialState s = system_->state(trial);
  const Vector3d centre = pin.centre + trial.parameter * pin.motion;
  for (const int j : {i - 1, i + 1}) {
    const Vector3d arm = wire::vertex(s, j) - centre;
    if ((arm - arm.dot(pin.axis) * pin.axis).norm() < pin.radius - 1e-9 * system_->length_scale())
      return true;
  }
  return false;
}

numerics::SolveReport HeldWire::move(const Vector3d& by) {
  const double length = by.norm();
  numerics::SolveReport report;
  if (length == 0.0) return report;
  SpatialPin& pin = system_->pin;
  pin.motion = by / length;
  point_.parameter = 0.0;
  double step = length;
  while (point_.parameter < length) {
    const SpatialPin saved = pin;
    numerics::PathPoint trial = point_;
    trial.parameter = 1.1 * step >= length - point_.parameter ? length : point_.parameter + step;
    report = solve(trial);
    if (!report.usable()) {
      pin = saved;
      step = 0.5 * std::min(step, length - point_.parameter);
      if (step < smallest_step) return report;
      continue;
    }
    if (wraps(trial)) {
      report.termination = numerics::Termination::step_too_small;
      report.message = "a wire begins to wrap the shaft, which is computed for a push in the plane only";
      return report;
    }
    accept(trial);
    step *= 2.0;
  }
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
