#include "coupling/statics/spatial_push.hpp"

#include "numerics/band_matrix.hpp"
#include "wire/loose_wire.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

wire::SpatialEnd spatial_end(const wire::PlanarEnd& end) {
  wire::SpatialEnd result;
  // A pin of the plane holds the twist: nothing in the plane would.
  result.kind = end.kind == wire::PlanarEnd::Kind::clamp ? wire::SpatialEnd::Kind::clamp
                                                         : wire::SpatialEnd::Kind::twisting_pin;
  result.position = {end.position.x(), end.position.y(), 0.0};
  result.rotational_stiffness = end.rotational_stiffness;
  result.translational_stiffness = end.translational_stiffness;
  return result;
}

}  // namespace

wire::SpatialRod spatial_rod(const wire::PlanarRod& planar, double torsional_stiffness, double weight_across) {
  const wire::PlanarRodProperties& p = planar.properties();
  wire::SpatialRodProperties properties;
  properties.bending_stiffness = p.bending_stiffness;
  properties.second_bending_stiffness = p.bending_stiffness;
  properties.torsional_stiffness = torsional_stiffness;
  properties.axial_stiffness = p.axial_stiffness;
  // With the clamps' director along y and no twist, kappa_1 is the curvature in the plane, up to its sign.
  properties.natural_curvature = {p.natural_curvature, 0.0};
  properties.weight = {p.weight.x(), p.weight.y(), weight_across};
  properties.left = spatial_end(p.left);
  properties.right = spatial_end(p.right);
  return {planar.mesh(), properties};
}

namespace {

Vector3d axis_of(double tilt) { return {std::sin(tilt), 0.0, std::cos(tilt)}; }

/// Follows a push in space.
class SpatialFollower {
 public:
  SpatialFollower(const PushProblem& test, const PushOptions& options, int coarsening)
      : test_(test), options_(options), coarsening_(coarsening) {}
  PushCurve run();

 private:
  [[nodiscard]] bool start();
  [[nodiscard]] bool advance(double target);
  void accept(const numerics::PathPoint& point);
  void record();
  [[nodiscard]] bool fail(const numerics::SolveReport& report, const std::string& message);

  const PushProblem& test_;
  const PushOptions& options_;
  int coarsening_;
  std::unique_ptr<wire::SpatialRod> rod_;
  std::unique_ptr<SpatialPushSystem> system_;
  numerics::PathWorkspace workspace_;
  numerics::PathPoint point_;
  numerics::PathPoint before_;  // accepted one before, for the predictor
  bool has_before_ = false;
  PushCurve curve_;
  int iterations_ = 0;
  double dissipated_ = 0.0;
  Vector2d last_friction_ = Vector2d::Zero();  // on the wire in (c, a) [N]
  bool slides_ = false;
};

bool SpatialFollower::fail(const numerics::SolveReport& report, const std::string& message) {
  curve_.report.termination = report.termination == numerics::Termination::converged
                                  ? numerics::Termination::step_too_small
                                  : report.termination;
  curve_.report.message = fmt::format("{} at a travel of {:.6g} mm", message, 1e3 * point_.parameter);
  return false;
}

void SpatialFollower::accept(const numerics::PathPoint& point) {
  const wire::SpatialState s = system_->state(point);
  const SpatialPushSystem::Geometry g = system_->geometry(point, s);
  SpatialPin& pin = system_->pin;
  const bool slides = pin.pressed && pin.friction > 0.0 && system_->slides(g);
  // Trapezoidal in the force; where the slip has turned round, the force it ends with.
  const bool turned = g.friction.dot(last_friction_) <= 0.0;
  if (slides) dissipated_ += (turned ? g.friction : Vector2d(0.5 * (g.friction + last_friction_))).norm() * g.slip.norm();
  if (slides != slides_) {
    curve_.events.push_back({slides ? PushEvent::Kind::slip_begins : PushEvent::Kind::slip_ends, point.parameter});
    slides_ = slides;
  }
  last_friction_ = g.friction;
  before_ = point_;
  has_before_ = point_.band.size() > 0 && point.parameter != point_.parameter;
  point_ = point;
  system_->accept(point);
  pin.last_coordinate = point.border[3];
  pin.last_normal = g.normal;
  pin.last_zeta = g.zeta;
}

// The planar push to a small travel, then the pin turned into its tilt with the travel held.
bool SpatialFollower::start() {
  PushProblem planar = test_;
  planar.gravity[2] = 0.0;
  planar.pusher.friction = 0.0;
  PushSetup setup = prepare_push(planar, options_.elements, options_.grading, coarsening_);
  iterations_ += setup.iterations;
  if (!setup.report.usable()) {
    curve_.report = setup.report;
    return false;
  }
  curve_.natural_height = setup.natural_height;
  curve_.touch_height = setup.system->guided[0].centre.y();
  SlidingContact& flat = setup.system->guided[0];
  flat.status = ContactStatus::slip;
  double first = 0.0;
  for (const double t : test_.travel) first = first == 0.0 ? t : first;
  const double seat = std::min(first > 0.0 ? first : 1e-4, 1e-4);
  numerics::PathPoint at = setup.start;
  at.parameter = seat;
  numerics::SolveReport report = numerics::correct(*setup.system, at, workspace_, 30);
  iterations_ += report.iterations;
  if (!report.usable()) return fail(report, "the push does not start");

  rod_ = std::make_unique<wire::SpatialRod>(
      spatial_rod(*setup.rod, test_.wire.torsional_stiffness(), test_.wire.mass_per_length() * test_.gravity[2]));
  const wire::PlanarState planar_state = setup.system->state(at);
  SpatialPin pin;
  pin.centre = {flat.centre.x(), flat.centre.y(), 0.0};
  pin.motion = {flat.motion.x(), flat.motion.y(), 0.0};
  pin.side = flat.side;
  pin.radius = flat.radius;
  pin.last_coordinate = planar_state.controls[1];
  wire::SpatialState state = wire::in_space(*rod_, planar_state);
  system_ = std::make_unique<SpatialPushSystem>(*rod_, state, pin);
  point_.band = state.q;
  point_.border.setZero(SpatialPushSystem::border_unknowns);
  point_.border.head<2>() = at.border.head<2>();
  point_.border[3] = at.border[2];
  point_.parameter = seat;

  // Turn the pin in steps; where one fails, halve it.
  double tilt = 0.0;
  double step = test_.pusher.tilt;
  while (tilt != test_.pusher.tilt) {
    const double next = std::abs(test_.pusher.tilt - tilt) <= std::abs(step) ? test_.pusher.tilt : tilt + step;
    system_->pin.axis = axis_of(next);
    numerics::PathPoint trial = point_;
    report = numerics::correct(*system_, trial, workspace_, 30);
    iterations_ += report.iterations;
    if (!report.usable()) {
      step *= 0.5;
      if (std::abs(step) < 1e-5) return fail(report, "the tilted pusher finds no equilibrium");
      continue;
    }
    tilt = next;
    accept(trial);
  }
  report = numerics::correct(*system_, point_, workspace_, 30);
  iterations_ += report.iterations;
  if (!report.usable()) return fail(report, "the weight across the plane finds no equilibrium");
  accept(point_);
  // Travel counts from where the force vanishes: the swung wire meets a tilted pin at another height. Go
  // down to a hundredth of the seat and extrapolate the force to zero.
  double travel = seat;
  for (int k = 0; k < 3; ++k) {
    const double force = point_.border.head<3>().dot(system_->pin.motion);
    numerics::PathPoint lower = point_;
    lower.parameter = travel - 0.5 * std::min(seat, std::abs(travel));
    report = numerics::correct(*system_, lower, workspace_, 30);
    iterations_ += report.iterations;
    if (!report.usable()) return fail(report, "the tilted pusher does not come to its first touch");
    const double slope = (force - lower.border.head<3>().dot(system_->pin.motion)) / (travel - lower.parameter);
    const double zero = travel - force / slope;
    numerics::PathPoint near = point_;
    near.parameter = zero + 0.02 * (travel - zero);
    near.band += (near.parameter - travel) / (lower.parameter - travel) * (lower.band - point_.band);
    near.border += (near.parameter - travel) / (lower.parameter - travel) * (lower.border - point_.border);
    report = numerics::correct(*system_, near, workspace_, 30);
    iterations_ += report.iterations;
    if (!report.usable()) return fail(report, "the tilted pusher does not come to its first touch");
    accept(near);
    travel = near.parameter;
    if (std::abs(near.border.head<3>().dot(system_->pin.motion)) < 1e-4 * std::abs(force)) break;
  }
  {
    // The last bit by the local stiffness; then shift the pin so that travel 0 is first touch.
    numerics::PathPoint next = point_;
    next.parameter = travel + 0.01 * seat;
    report = numerics::correct(*system_, next, workspace_, 30);
    if (!report.usable()) return fail(report, "the tilted pusher does not come to its first touch");
    const double f0 = point_.border.head<3>().dot(system_->pin.motion);
    const double f1 = next.border.head<3>().dot(system_->pin.motion);
    const double touch = travel - f0 * (next.parameter - travel) / (f1 - f0);
    system_->pin.centre += touch * system_->pin.motion;
    curve_.touch_height = system_->pin.centre.y();
    point_.parameter = travel - touch;
  }
  has_before_ = false;
  system_->pin.friction = test_.pusher.friction;
  accept(point_);
  has_before_ = false;
  curve_.events.clear();
  dissipated_ = 0.0;
  return true;
}

bool SpatialFollower::advance(double target) {
  double step = target - point_.parameter;
  while (point_.parameter != target) {
    const double rest = target - point_.parameter;
    if (std::abs(step) > std::abs(rest) || step * rest <= 0.0) step = rest;
    const double travel = 1.1 * std::abs(step) >= std::abs(rest) ? target : point_.parameter + step;
    const SpatialPin saved = system_->pin;
    numerics::PathPoint trial = point_;
    trial.parameter = travel;
    if (has_before_) {
      const double ratio = (travel - point_.parameter) / (point_.parameter - before_.parameter);
      if (ratio > 0.0 && ratio < 20.0) {
        trial.band += ratio * (point_.band - before_.band);
        trial.border += ratio * (point_.border - before_.border);
      }
    }
    numerics::SolveReport report;
    bool settled = false;
    std::optional<PushEvent::Kind> event;
    for (int round = 0; round < 3 && !settled; ++round) {
      report = numerics::correct(*system_, trial, workspace_, 2 * options_.max_iterations);
      iterations_ += report.iterations;
      if (!report.usable()) break;
      SpatialPin& pin = system_->pin;
      const SpatialPushSystem::Geometry g = system_->geometry(trial, system_->state(trial));
      const double floor = 1e-9 * (system_->mount_reactions()[0].norm() + system_->mount_reactions()[1].norm());
      settled = true;
      if (!pin.pressed && trial.border[4] < -1e-9 * system_->length_scale()) {
        pin.pressed = true;
        trial.border[4] = 0.0;
        settled = false;
        event = PushEvent::Kind::touch;
      } else if (pin.pressed && g.normal_force < -floor) {
        pin.pressed = false;
        trial.border.head<3>().setZero();
        settled = false;
        event = PushEvent::Kind::lift_off;
      }
    }
    if (!report.usable() || !settled) {
      system_->pin = saved;
      step *= 0.5;
      if (std::abs(step) < options_.smallest_step) {
        return fail(report, report.usable() ? "the contact does not settle" : report.message);
      }
      continue;
    }
    // A wire bent sharper than the pin would lie on it over an arc.
    const int i = rod_->mesh().contact_vertex();
    const wire::SpatialState s = system_->state(trial);
    const Vector3d centre = system_->pin.centre + travel * system_->pin.motion;
    for (const int j : {i - 1, i + 1}) {
      const Vector3d arm = wire::vertex(s, j) - centre;
      const double distance = (arm - arm.dot(system_->pin.axis) * system_->pin.axis).norm();
      if (system_->pin.radius > 0.0 && distance < system_->pin.radius - 1e-9 * system_->length_scale()) {
        return fail({}, "the wire begins to wrap the tilted pusher, which is computed for an upright one only,");
      }
    }
    accept(trial);
    if (event) curve_.events.push_back({*event, travel});
    step *= 2.0;
  }
  return true;
}

void SpatialFollower::record() {
  const wire::SpatialState s = system_->state(point_);
  const SpatialPin& pin = system_->pin;
  const Vector3d force = point_.border.head<3>();
  PushPoint p;
  p.travel = point_.parameter;
  p.force = force.dot(pin.motion);
  p.transverse_force = pin.motion.y() * force.x() - pin.motion.x() * force.y();
  const SpatialPushSystem::Geometry g = system_->geometry(point_, s);
  p.normal_force = g.normal_force;
  p.friction_force = g.friction.norm();
  p.axial_force = force.z();
  const std::array<Vector3d, 2>& reaction = system_->mount_reactions();
  p.tension_left = -reaction[0].dot(rod_->properties().left.direction);
  p.tension_right = reaction[1].dot(rod_->properties().right.direction);
  p.imbalance = (reaction[0] + reaction[1] + force + (s.controls[2] - s.controls[0]) * rod_->properties().weight).norm();
  p.contact_coordinate = s.controls[1];
  p.energy = rod_->energy(s);
  p.dissipated = dissipated_;
  p.unstable_modes = workspace_.solver.negative_pivots();
  p.in_contact = pin.pressed;
  p.slipping = slides_;
  p.iterations = iterations_;
  curve_.newton_iterations += iterations_;
  iterations_ = 0;
  curve_.points.push_back(p);
}

PushCurve SpatialFollower::run() {
  if (!start()) {
    curve_.newton_iterations = iterations_;
    return std::move(curve_);
  }
  curve_.events.push_back({PushEvent::Kind::first_touch, 0.0});
  for (const double target : test_.travel) {
    if (target == 0.0 && curve_.points.empty()) {
      PushPoint p;  // first touch: no force; the rest of the row is that of the unloaded wire
      const std::array<Vector3d, 2>& reaction = system_->mount_reactions();
      p.tension_left = -reaction[0].dot(rod_->properties().left.direction);
      p.tension_right = reaction[1].dot(rod_->properties().right.direction);
      p.contact_coordinate = point_.border[3];
      p.energy = rod_->energy(system_->state(point_));
      curve_.points.push_back(p);
      continue;
    }
    if (!advance(target)) break;
    record();
    if (options_.progress && !options_.progress(target)) {
      curve_.report.termination = numerics::Termination::interrupted;
      curve_.report.message = "interrupted";
      break;
    }
  }
  curve_.report.iterations = curve_.newton_iterations;
  return std::move(curve_);
}

}  // namespace

bool needs_space(const PushProblem& test) { return test.pusher.tilt != 0.0 || test.gravity[2] != 0.0; }

PushCurve solve_spatial_push(const PushProblem& test, const PushOptions& options, int coarsening) {
  const bool remembers = test.wire.yielding || test.wire.strand_friction;
  if (remembers || test.pusher.compliance > 0.0) {
    PushCurve curve;
    curve.report.termination = numerics::Termination::step_too_small;
    curve.report.message = "a tilted pusher is computed for elastic wires and a rigid machine";
    return curve;
  }
  if (test.mount.kind == wire::MountKind::supports || test.mount.slip_tension) {
    PushCurve curve;
    curve.report.termination = numerics::Termination::step_too_small;
    curve.report.message = "a tilted pusher is computed for wires between clamps or pins that do not slip";
    return curve;
  }
  return SpatialFollower(test, options, coarsening).run();
}

int out_of_plane_modes(const wire::PlanarRod& planar, const wire::PlanarState& state, double torsional_stiffness) {
  const wire::SpatialRod rod = spatial_rod(planar, torsional_stiffness, 0.0);
  const wire::SpatialState s = wire::in_space(rod, state);
  wire::RodAssembly assembly;
  rod.assemble(s, {false, false, false}, assembly);
  rod.hold_mounts(assembly);
  // In a planar state z and theta do not couple with x and y: their block alone.
  constexpr int out = 2;
  const int n = out * rod.mesh().vertices();
  constexpr int block = wire::SpatialRod::block;
  numerics::SymmetricBandMatrix across(n, 5);
  for (int i = 0; i < n; ++i) {
    const int row = block * (i / out) + 2 + i % out;
    for (int j = std::max(0, i - 5); j <= i; ++j) {
      const int column = block * (j / out) + 2 + j % out;
      if (row - column <= wire::SpatialRod::half_bandwidth) across.lower(i, j) = assembly.hessian.lower(row, column);
    }
  }
  // The swing about the chord of an unloaded wire is neutral: shift the lateral stiffness by far less than any
  // real mode has.
  const double length = state.controls[2] - state.controls[0];
  const double neutral = 1e-6 * planar.properties().bending_stiffness / (length * length * length);
  for (int i = 0; i < n; i += out) across.lower(i, i) += neutral;
  numerics::BandLdlt factor;
  return factor.factorize(across) ? factor.negative_pivots() : 0;
}

}  // namespace snare::coupling
