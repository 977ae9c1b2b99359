#include "coupling/statics/spatial_push.hpp"

#include "coupling/statics/contact_forces.hpp"
#include "coupling/statics/out_of_plane.hpp"
#include "coupling/statics/push_path.hpp"
#include "coupling/statics/spatial_contact.hpp"
#include "wire/end_tangents.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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
      : PushPath(test, options, StepMeasure::planned), test_(test), coarsening_(coarsening) {}

  [[nodiscard]] StepOutcome step_to(double travel) override;
  [[nodiscard]] numerics::SolveReport without_steps(double /*target*/,
                                                    const numerics::SolveReport& last) override {
    return ended(last.termination, last.message);
  }
  [[nodiscard]] std::function<void()> checkpoint() override;
  [[nodiscard]] Measures measures() override;

 private:
  [[nodiscard]] numerics::SolveReport start() override;
  void record(double travel) override;
  [[nodiscard]] bool record_touch() override;
  [[nodiscard]] numerics::SolveReport interrupted() const override;

  // The parts of start(), each a report that is usable or says why the push ends.
  [[nodiscard]] numerics::SolveReport seat_in_plane(double seat);
  [[nodiscard]] numerics::SolveReport leave_plane();
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
  bool assembled_ = true;  // the last assembly was at the accepted point
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
  assembled_ = true;
  if (contact_->slides() != slid) {
    curve_.events.push_back(
        {slid ? PushEvent::Kind::slip_ends : PushEvent::Kind::slip_begins, point.parameter});
  }
  before_ = point_;
  has_before_ = point_.band.size() > 0 && point.parameter != point_.parameter;
  point_ = point;
}

std::function<void()> SpatialPush::checkpoint() {
  return [this, memory = contact_->memory(), point = point_, before = before_, has_before = has_before_,
          events = curve_.events.size()] {
    contact_->restore(memory);
    point_ = point;
    before_ = before;
    has_before_ = has_before;
    curve_.events.resize(events);
    assembled_ = false;
  };
}

RememberingPath::Measures SpatialPush::measures() {
  const double bending = contact_->rod().properties().bending_stiffness;
  const std::array<Vector3d, 2>& reaction = contact_->system().mount_reactions();
  const double force = bending / (span_ * span_) + reaction[0].norm() + reaction[1].norm();
  Measures m{Eigen::Vector4d(), Eigen::Vector4d::Constant(options_.path_tolerance * force)};
  m.values << SpatialPushSystem::force(point_), point_.border[SpatialPushSystem::Rows::coordinate];
  m.allowed[3] = 0.01 * options_.path_tolerance * span_;
  return m;
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
  contact_.emplace(setup, at, spatial_rod(*setup.rod, test_.wire.torsional_stiffness()), pin,
                   SlidingLength::material);
  point_ = contact_->start();
  point_.parameter = seat;
  return {};
}

// Turns the pin into its tilt, then lets the weight act across the plane, the travel held; a step that fails
// is halved.
numerics::SolveReport SpatialPush::leave_plane() {
  constexpr double smallest_share = 1e-4;
  const auto in_steps = [&](const auto& set, const char* message) {
    double share = 0.0;
    double step = 1.0;
    while (share < 1.0) {
      const double next = std::min(1.0, share + step);
      set(next);
      numerics::PathPoint trial = point_;
      numerics::SolveReport report = solve(trial);
      if (!report.usable()) {
        step *= 0.5;
        if (step < smallest_share) return ended(report.termination, message);
        continue;
      }
      share = next;
      accept(trial);
    }
    return numerics::SolveReport();
  };
  const auto tilt = [&](double share) { contact_->pin().axis = axis_of(share * test_.pusher.tilt); };
  numerics::SolveReport report = in_steps(tilt, "the tilted pusher finds no equilibrium");
  if (!report.usable() || test_.gravity[2] == 0.0) return report;
  const double weight = test_.wire.mass_per_length() * test_.gravity[2];
  return in_steps([&](double share) { contact_->set_weight_across(share * weight); },
                  "the weight across the plane finds no equilibrium");
}

// Travel counts from where the force vanishes: the swung wire meets a tilted pin at another height, and a
// wire that its weight pulls across the plane hangs there. Follows the path down by secants of the force,
// none of them much longer than the last, and shifts the pin so that travel 0 is where the force is zero.
numerics::SolveReport SpatialPush::find_first_touch(double seat) {
  // share of a secant that is not gone: without force a loose wire swings freely
  constexpr double left = 0.02;
  const double finest = 1e-5 * seat;
  double upper_force = force_along(point_);
  double upper = point_.parameter;
  double step = -0.5 * seat;
  numerics::SolveReport last;
  for (int count = 0; count < 400 && point_.parameter > -4.0 * span_; ++count) {
    numerics::PathPoint trial = predict(point_.parameter + step);
    last = solve(trial);
    if (!last.usable()) {
      step *= 0.5;
      if (std::abs(step) < finest) break;
      continue;
    }
    accept(trial);
    const double force = force_along(point_);
    const double slope = (upper_force - force) / (upper - point_.parameter);
    const double to_zero = -force / slope;  // by the secant
    upper = point_.parameter;
    upper_force = force;
    if (std::abs(to_zero) < finest) {
      SpatialPin& pin = contact_->pin();
      pin.centre += (point_.parameter + to_zero) * pin.motion;
      curve_.touch_height = pin.centre.y();
      point_.parameter = -to_zero;
      return {};
    }
    // Where the force falls slower than the secant says, towards it in longer and longer steps.
    const double longest = 2.0 * std::abs(step);
    step = slope > 0.0 ? std::clamp((1.0 - left) * to_zero, -longest, longest) : -longest;
  }
  return ended(last.termination, "the pusher does not come to its first touch");
}

numerics::SolveReport SpatialPush::start() {
  const double seat = 5e-4 * span_;
  if (numerics::SolveReport report = seat_in_plane(seat); !report.usable()) return report;
  if (numerics::SolveReport report = leave_plane(); !report.usable()) return report;
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
  put_end_forces(system.mount_reactions(), wire::end_tangents(contact_->rod(), s),
                 contact_->rod().tensions(s), p);
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
  if (!assembled_) contact_->assemble(point_);
  assembled_ = true;
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
  if (test.wire.yielding || test.wire.strand_friction || test.pusher.compliance > 0.0) {
    return refused("a tilted pusher is computed for elastic wires and a rigid machine");
  }
  if (test.mount.kind == wire::MountKind::supports || test.mount.slip_tension) {
    return refused("a tilted pusher is computed for wires between clamps or pins that do not slip");
  }
  return SpatialPush(test, options, coarsening).run(test.travel);
}

}  // namespace snare::coupling
