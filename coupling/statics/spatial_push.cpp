#include "coupling/statics/spatial_push.hpp"

#include "coupling/statics/contact_forces.hpp"
#include "coupling/statics/out_of_plane.hpp"
#include "coupling/statics/push_path.hpp"
#include "coupling/statics/spatial_contact.hpp"
#include "wire/end_tangents.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace snare::coupling {

namespace {

using Eigen::Vector3d;

constexpr int start_iterations = 30;  // Newton's, where no predictor helps

Vector3d axis_of(double tilt) {
  return {std::sin(tilt), 0.0, std::cos(tilt)};
}

/// A push in space.
class SpatialPush final : public PushPath {
 public:
  SpatialPush(const PushProblem& test, const PushOptions& options, int coarsening)
      : PushPath(options, StepMeasure::planned), test_(test), coarsening_(coarsening) {}

  [[nodiscard]] StepOutcome step_to(double travel) override;
  [[nodiscard]] numerics::SolveReport without_steps(double /*target*/, const numerics::SolveReport& last) override {
    return ended(last.termination, last.message);
  }

 private:
  [[nodiscard]] numerics::SolveReport start() override;
  void record(double travel) override;
  [[nodiscard]] bool record_touch() override;
  [[nodiscard]] numerics::SolveReport interrupted() const override;

  // The parts of start(), each a report that is usable or says why the push ends.
  [[nodiscard]] numerics::SolveReport seat_in_plane(double seat);
  [[nodiscard]] numerics::SolveReport turn_pin();
  [[nodiscard]] numerics::SolveReport find_first_touch(double seat);

  [[nodiscard]] numerics::SolveReport solve(numerics::PathPoint& trial);
  [[nodiscard]] numerics::PathPoint predict(double travel) const;
  void accept(const numerics::PathPoint& point);
  void forget_before() { has_before_ = false; }
  [[nodiscard]] double force_along(const numerics::PathPoint& at) const {
    return SpatialPushSystem::force(at).dot(contact_->pin().motion);
  }
  void put_mounts(PushPoint& p) const;

  const PushProblem& test_;
  int coarsening_;
  std::optional<SpatialContact> contact_;
  numerics::PathPoint before_;  // accepted one before, for the predictor
  bool has_before_ = false;
};

numerics::SolveReport SpatialPush::interrupted() const {
  return numerics::SolveReport().end(numerics::Termination::interrupted, "interrupted");
}

numerics::SolveReport SpatialPush::solve(numerics::PathPoint& trial) {
  numerics::SolveReport report = contact_->solve(trial, start_iterations);
  iterations_ += report.iterations;
  return report;
}

void SpatialPush::accept(const numerics::PathPoint& point) {
  const bool slid = contact_->slides();
  contact_->accept(point);
  if (contact_->slides() != slid) {
    curve_.events.push_back({slid ? PushEvent::Kind::slip_ends : PushEvent::Kind::slip_begins, point.parameter});
  }
  before_ = point_;
  has_before_ = point_.band.size() > 0 && point.parameter != point_.parameter;
  point_ = point;
}

// The planar push without friction to a small travel, taken into space.
numerics::SolveReport SpatialPush::seat_in_plane(double seat) {
  PushProblem planar = test_;
  planar.gravity[2] = 0.0;
  planar.pusher.friction = 0.0;
  PushSetup setup = prepare_push(planar, options_.elements, options_.grading, coarsening_);
  iterations_ += setup.iterations;
  if (!setup.report.usable()) return setup.report;
  curve_.natural_height = setup.natural_height;
  SlidingContact& flat = setup.system->sliding[0];
  curve_.touch_height = flat.centre.y();
  flat.status = ContactStatus::slip;
  numerics::PathPoint at = setup.start;
  at.parameter = seat;
  numerics::PathWorkspace workspace;
  const numerics::SolveReport report = numerics::correct(*setup.system, at, workspace, start_iterations);
  iterations_ += report.iterations;
  if (!report.usable()) return ended(report.termination, "the push does not start");

  SpatialPin pin;
  pin.centre = {flat.centre.x(), flat.centre.y(), 0.0};
  pin.motion = {flat.motion.x(), flat.motion.y(), 0.0};
  const double weight_across = test_.wire.mass_per_length() * test_.gravity[2];
  contact_.emplace(setup, at, spatial_rod(*setup.rod, test_.wire.torsional_stiffness(), weight_across), pin,
                   SlidingLength::material);
  point_ = contact_->start();
  point_.parameter = seat;
  return {};
}

// Turns the pin into its tilt with the travel held; a step that fails is halved.
numerics::SolveReport SpatialPush::turn_pin() {
  double tilt = 0.0;
  double step = test_.pusher.tilt;
  while (tilt != test_.pusher.tilt) {
    const double next = std::abs(test_.pusher.tilt - tilt) <= std::abs(step) ? test_.pusher.tilt : tilt + step;
    contact_->pin().axis = axis_of(next);
    numerics::PathPoint trial = point_;
    const numerics::SolveReport report = solve(trial);
    if (!report.usable()) {
      step *= 0.5;
      if (std::abs(step) < 1e-5) return ended(report.termination, "the tilted pusher finds no equilibrium");
      continue;
    }
    tilt = next;
    accept(trial);
  }
  const numerics::SolveReport report = solve(point_);
  if (!report.usable()) return ended(report.termination, "the weight across the plane finds no equilibrium");
  accept(point_);
  return {};
}

// Travel counts from where the force vanishes: the swung wire meets a tilted pin at another height. Goes down
// to a hundredth of the seat, extrapolates the force to zero, and shifts the pin so that travel 0 is there.
numerics::SolveReport SpatialPush::find_first_touch(double seat) {
  const auto failed = [this](const numerics::SolveReport& report) {
    return ended(report.termination, "the tilted pusher does not come to its first touch");
  };
  double travel = seat;
  for (int k = 0; k < 3; ++k) {
    const double force = force_along(point_);
    numerics::PathPoint lower = point_;
    lower.parameter = travel - 0.5 * std::min(seat, std::abs(travel));
    if (const numerics::SolveReport report = solve(lower); !report.usable()) return failed(report);
    const double slope = (force - force_along(lower)) / (travel - lower.parameter);
    const double zero = travel - force / slope;
    numerics::PathPoint near = point_;
    near.parameter = zero + 0.02 * (travel - zero);
    near.band += (near.parameter - travel) / (lower.parameter - travel) * (lower.band - point_.band);
    near.border += (near.parameter - travel) / (lower.parameter - travel) * (lower.border - point_.border);
    if (const numerics::SolveReport report = solve(near); !report.usable()) return failed(report);
    accept(near);
    travel = near.parameter;
    if (std::abs(force_along(near)) < 1e-4 * std::abs(force)) break;
  }
  // The last bit by the local stiffness; its iterations are not counted.
  numerics::PathPoint next = point_;
  next.parameter = travel + 0.01 * seat;
  if (const numerics::SolveReport report = contact_->solve(next, start_iterations); !report.usable()) {
    return failed(report);
  }
  const double f0 = force_along(point_);
  const double f1 = force_along(next);
  const double touch = travel - f0 * (next.parameter - travel) / (f1 - f0);
  SpatialPin& pin = contact_->pin();
  pin.centre += touch * pin.motion;
  curve_.touch_height = pin.centre.y();
  point_.parameter = travel - touch;
  return {};
}

numerics::SolveReport SpatialPush::start() {
  double first = 0.0;
  for (const double t : test_.travel) first = first == 0.0 ? t : first;
  const double seat = std::min(first > 0.0 ? first : 1e-4, 1e-4);
  if (numerics::SolveReport report = seat_in_plane(seat); !report.usable()) return report;
  if (numerics::SolveReport report = turn_pin(); !report.usable()) return report;
  if (numerics::SolveReport report = find_first_touch(seat); !report.usable()) return report;
  forget_before();
  contact_->pin().friction = test_.pusher.friction;
  accept(point_);
  forget_before();
  curve_.events.clear();
  contact_->forget_dissipation();
  return {};
}

// A straight line through the last two accepted points, unless it reaches far beyond them.
numerics::PathPoint SpatialPush::predict(double travel) const {
  numerics::PathPoint guess = point_;
  guess.parameter = travel;
  if (!has_before_) return guess;
  const double ratio = (travel - point_.parameter) / (point_.parameter - before_.parameter);
  if (ratio > 0.0 && ratio < 20.0) {
    guess.band += ratio * (point_.band - before_.band);
    guess.border += ratio * (point_.border - before_.border);
  }
  return guess;
}

StepOutcome SpatialPush::step_to(double travel) {
  const SpatialPin saved = contact_->pin();
  numerics::PathPoint trial = predict(travel);
  const SpatialContact::Settled settled = contact_->settle(trial, 2 * options_.max_iterations);
  iterations_ += settled.iterations;
  if (!settled.report.usable()) {
    contact_->pin() = saved;
    return {StepOutcome::Kind::failed, settled.report};
  }
  if (contact_->wraps(trial)) {
    return {StepOutcome::Kind::stopped,
            ended(settled.report.termination,
                  "the wire begins to wrap the tilted pusher, which is computed for an upright one only,")};
  }
  accept(trial);
  if (settled.event) curve_.events.push_back({*settled.event, travel});
  return {StepOutcome::Kind::taken, settled.report};
}

void SpatialPush::put_mounts(PushPoint& p) const {
  const SpatialPushSystem& system = contact_->system();
  const wire::SpatialState s = system.state(point_);
  put_end_forces(system.mount_reactions(), wire::end_tangents(contact_->rod(), s), contact_->rod().tensions(s), p);
}

// No force at first touch; the rest of the row is that of the unloaded wire.
bool SpatialPush::record_touch() {
  PushPoint p;
  put_mounts(p);
  p.contact_coordinate = point_.border[SpatialPushSystem::Rows::coordinate];
  p.energy = contact_->energy(point_);
  curve_.points.push_back(p);
  return true;
}

void SpatialPush::record(double travel) {
  const SpatialPushSystem& system = contact_->system();
  const wire::SpatialState s = system.state(point_);
  const SpatialPin& pin = system.pin;
  const Vector3d force = SpatialPushSystem::force(point_);
  const SpatialPushSystem::Geometry g = system.geometry(point_, s);
  PushPoint p;
  p.travel = travel;
  p.force = force.dot(pin.motion);
  p.transverse_force = pin.motion.y() * force.x() - pin.motion.x() * force.y();
  p.normal_force = g.normal_force;
  p.friction_force = g.friction.norm();
  p.axial_force = force.z();
  put_mounts(p);
  const std::array<Vector3d, 2>& reaction = system.mount_reactions();
  const Vector3d weight = (s.controls[2] - s.controls[0]) * contact_->rod().properties().weight;
  p.imbalance = (reaction[0] + reaction[1] + force + weight).norm();
  p.contact_coordinate = s.controls[1];
  p.energy = contact_->energy(point_);
  p.dissipated = contact_->dissipated();
  p.unstable_modes = contact_->negative_pivots();
  p.in_contact = pin.pressed;
  p.slipping = contact_->slides();
  add(p);
}

PushCurve refused(const char* message) {
  PushCurve curve;
  curve.report.end(numerics::Termination::step_too_small, message);
  return curve;
}

}  // namespace

bool needs_space(const PushProblem& test) {
  return test.pusher.tilt != 0.0 || test.gravity[2] != 0.0;
}

PushCurve solve_spatial_push(const PushProblem& test, const PushOptions& options, int coarsening) {
  const bool remembers = test.wire.yielding || test.wire.strand_friction;
  if (remembers || test.pusher.compliance > 0.0) {
    return refused("a tilted pusher is computed for elastic wires and a rigid machine");
  }
  if (test.mount.kind == wire::MountKind::supports || test.mount.slip_tension) {
    return refused("a tilted pusher is computed for wires between clamps or pins that do not slip");
  }
  return SpatialPush(test, options, coarsening).run(test.travel);
}

}  // namespace snare::coupling
