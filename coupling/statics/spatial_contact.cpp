#include "coupling/statics/spatial_contact.hpp"

#include "wire/statics/loose_wire.hpp"

namespace snare::coupling {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Rows = SpatialPushSystem::Rows;

SpatialPin complete(SpatialPin pin, const PushSetup& planar, const numerics::PathPoint& at) {
  const SlidingContact& pusher = planar.system->sliding[0];
  pin.side = pusher.side;
  pin.radius = pusher.radius;
  pin.last_coordinate = at.border[planar.system->pusher_rows().coordinate];
  return pin;
}

}  // namespace

SpatialContact::SpatialContact(const PushSetup& planar, const numerics::PathPoint& at,
                               const wire::SpatialRod& rod, const SpatialPin& pin,
                               SlidingLength sliding_length)
    : rod_(rod),
      system_(rod_, wire::in_space(rod_, planar.system->state(at)), complete(pin, planar, at)),
      sliding_length_(sliding_length) {
  const SlidingRows rows = planar.system->pusher_rows();
  start_.band = wire::in_space(rod_, planar.system->state(at)).q;
  start_.border.setZero(SpatialPushSystem::border_unknowns);
  start_.border.segment<2>(Rows::force) = at.border.segment<2>(rows.force);
  start_.border[Rows::coordinate] = at.border[rows.coordinate];
}

void SpatialContact::set_weight_across(double weight) {
  wire::SpatialRodProperties properties = rod_.properties();
  properties.weight.z() = weight;
  rod_ = wire::SpatialRod(rod_.mesh(), properties);
}

numerics::SolveReport SpatialContact::solve(numerics::PathPoint& trial, int max_iterations) {
  return numerics::correct(system_, trial, workspace_, max_iterations);
}

std::optional<PushEvent::Kind> SpatialContact::change_state(numerics::PathPoint& trial) {
  SpatialPin& pin = system_.pin;
  const SpatialPushSystem::Geometry g = system_.geometry(trial, system_.state(trial));
  const double floor = 1e-9 * (system_.mount_reactions()[0].norm() + system_.mount_reactions()[1].norm());
  if (!pin.pressed && trial.border[Rows::gap] < -1e-9 * system_.length_scale()) {
    pin.pressed = true;
    trial.border[Rows::gap] = 0.0;
    return PushEvent::Kind::touch;
  }
  if (pin.pressed && g.normal_force < -floor) {
    pin.pressed = false;
    trial.border.segment<3>(Rows::force).setZero();
    return PushEvent::Kind::lift_off;
  }
  return std::nullopt;
}

SpatialContact::Settled SpatialContact::settle(numerics::PathPoint& trial, int max_iterations) {
  Settled settled;
  for (int round = 0; round < 3; ++round) {
    settled.report = solve(trial, max_iterations);
    settled.iterations += settled.report.iterations;
    if (!settled.report.usable()) return settled;
    const std::optional<PushEvent::Kind> event = change_state(trial);
    if (!event) return settled;
    settled.event = event;
  }
  settled.report.end(numerics::Termination::iteration_limit, "the contact does not settle");
  return settled;
}

bool SpatialContact::wraps(const numerics::PathPoint& trial) const {
  const SpatialPin& pin = system_.pin;
  if (pin.radius <= 0.0) return false;
  const int i = rod_.mesh().contact_vertex();
  const wire::SpatialState s = system_.state(trial);
  const Vector3d centre = pin.centre + trial.parameter * pin.motion;
  for (const int j : {i - 1, i + 1}) {
    const Vector3d arm = wire::vertex(s, j) - centre;
    const double distance = (arm - arm.dot(pin.axis) * pin.axis).norm();
    if (distance < pin.radius - 1e-9 * system_.length_scale()) return true;
  }
  return false;
}

void SpatialContact::accept(const numerics::PathPoint& point) {
  const wire::SpatialState state = system_.state(point);
  const SpatialPushSystem::Geometry g = system_.geometry(point, state);
  SpatialPin& pin = system_.pin;
  slides_ = pin.pressed && pin.friction > 0.0 && system_.slides(g);
  Vector2d slip = g.slip;
  if (sliding_length_ == SlidingLength::stretched) {
    // g.slip has dS along t for the wire that was fed; the rest of |X'| dS.
    const double fed = point.border[Rows::coordinate] - pin.last_coordinate;
    slip -= (system_.slope(state).u.norm() - 1.0) * fed *
            Vector2d(g.tangent.dot(g.across), g.tangent.dot(pin.axis));
  }
  // Where the friction has turned round, that at the end of the slip.
  const bool turned = g.friction.dot(last_friction_) <= 0.0;
  const double from = turned ? g.friction.norm() : last_friction_.norm();
  if (slides_) dissipated_ += slip_work_.over(slip.norm(), point.parameter, from, g.friction.norm());
  slip_work_ = slip_work_.after(turned ? 0.0 : slip.norm(), point.parameter, from);
  last_friction_ = g.friction;
  system_.accept(point);
  pin.last_coordinate = point.border[Rows::coordinate];
  pin.last_normal = g.normal;
  pin.last_zeta = g.zeta;
}

void SpatialContact::restore(const Memory& memory) {
  system_.pin = memory.pin;
  system_.restore(memory.accepted);
  dissipated_ = memory.dissipated;
  last_friction_ = memory.last_friction;
  slip_work_ = memory.slip_work;
  slides_ = memory.slides;
}

}  // namespace snare::coupling
