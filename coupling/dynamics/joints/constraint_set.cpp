#include "coupling/dynamics/joints/constraint_set.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;
using multibody::Pose;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

constexpr auto& at_index = base::at;  // points of the DAE are called `at` here

Pose pose_of(const multibody::RigidBodyState& s) {
  return {s.orientation.toRotationMatrix(), s.position};
}

Pose mount_pose(const wire::SpatialEnd& end) {
  Pose X;
  X.R << end.direction, end.director, end.direction.cross(end.director);
  X.p = end.position;
  return X;
}

}  // namespace

void ConstraintSet::check_carrier(const Motion& motion, const std::string& name, const MotionCarrier& carrier,
                                  Complaints& c) {
  if (carrier.kind == MotionCarrier::Kind::body) {
    c.require(carrier.index >= 0 && carrier.index < static_cast<int>(motion.bodies.size()), name + ".carrier",
              carrier.index, "must be the index of a body");
  } else if (carrier.kind == MotionCarrier::Kind::arm) {
    if (!c.require(carrier.index >= 0 && carrier.index < static_cast<int>(motion.arms.size()),
                   name + ".carrier", carrier.index, "must be the index of an arm"))
      return;
    const auto frames = motion.arms[at_index(carrier.index)].arm.tree.frames().size();
    c.require(carrier.frame >= 0 && at_index(carrier.frame) < frames, name + ".carrier.frame", carrier.frame,
              "must be the index of a frame of the arm");
  }
}

void ConstraintSet::check(const Motion& motion, Complaints& c) {
  // Arms: sizes, and frames of their loads.
  for (const MotionArm& a : motion.arms) {
    const int n = a.arm.motors();
    const auto fits = [n](const std::vector<multibody::Drive>& drives) {
      return static_cast<int>(drives.size()) == n;
    };
    bool fit = fits(a.drives) && a.start.motor.size() == n && a.start.motor_rate.size() == n &&
               a.start.q.size() == a.arm.tree.coordinates() && a.start.v.size() == a.arm.tree.velocities();
    for (const multibody::DriveSwitch& s : a.switches) fit = fit && fits(s.drives) && s.joint < n;
    c.require(fit, a.name + ".joints", n, "must have one drive, angle and rate for each joint");
    for (const multibody::TimedLoad& load : a.loads) {
      c.require(load.frame >= 0 && at_index(load.frame) < a.arm.tree.frames().size(), a.name + ".loads",
                load.frame, "must act on a frame of the arm");
    }
  }
  // Welds: each body on one, and a carrier on an earlier one, so that `place` meets carriers before what they
  // hold.
  std::vector<bool> held(motion.bodies.size(), false), later(motion.bodies.size(), false);
  for (const MotionWeld& w : motion.welds) {
    if (w.body >= 0 && at_index(w.body) < later.size()) later[at_index(w.body)] = true;
  }
  for (const MotionWeld& w : motion.welds) {
    check_carrier(motion, w.name, w.carrier, c);
    if (!c.require(w.body >= 0 && at_index(w.body) < motion.bodies.size(), w.name + ".body", w.body,
                   "must be the index of a body"))
      continue;
    c.require(!motion.bodies[at_index(w.body)].driven, w.name + ".body", w.body, "must not be driven");
    c.require(!held[at_index(w.body)], w.name + ".body", w.body, "must not be held by two welds");
    held[at_index(w.body)] = true;
    if (w.carrier.kind == MotionCarrier::Kind::body && at_index(w.carrier.index) < held.size()) {
      const std::size_t k = at_index(w.carrier.index);
      c.require(w.carrier.index != w.body && (held[k] || !later[k]), w.name + ".carrier", w.carrier.index,
                "must be held, if at all, by an earlier weld");
    }
  }
  for (const MotionBushing& b : motion.bushings) {
    check_carrier(motion, b.name, b.first, c);
    check_carrier(motion, b.name, b.second, c);
    const double least = std::min({b.translational_stiffness.minCoeff(), b.translational_damping.minCoeff(),
                                   b.rotational_stiffness.minCoeff(), b.rotational_damping.minCoeff()});
    c.require(least >= 0.0, b.name, least, "must have stiffnesses and dampings >= 0");
  }
  // Mounts: rigid ones, each end once.
  std::vector<bool> taken(2 * motion.wires.size(), false);
  for (const MotionMount& m : motion.mounts) {
    check_carrier(motion, m.name, m.carrier, c);
    if (!c.require(m.wire >= 0 && at_index(m.wire) < motion.wires.size(), m.name + ".wire", m.wire,
                   "must be the index of a wire"))
      continue;
    const wire::SpatialRodProperties& p = motion.wires[at_index(m.wire)].rod.properties;
    const wire::SpatialEnd& end = p.end(m.end);
    c.require(end.kind != wire::SpatialEnd::Kind::free && std::isinf(end.translational_stiffness),
              m.name + ".wire", m.wire, "must have a rigid mount there");
    c.require(
        !motion.wires[at_index(m.wire)].rod.strands.act(), m.name + ".wire", m.wire,
        "must not be of strands that slide: their moment on a mount that moves or gives is not computed");
    const std::size_t k = 2 * at_index(m.wire) + index_of(m.end);
    c.require(!taken[k], m.name + ".wire", m.wire, "must not be held twice at one end");
    taken[k] = true;
  }
}

ConstraintSet::ConstraintSet(const Motion& motion, std::deque<wire::RodPart>& rods,
                             const std::deque<BodyPart>& bodies, const MotionOptions& options)
    : motion_(motion), end_(options.duration) {
  for (const MotionArm& a : motion.arms) {
    Arm& arm = arms_.emplace_back();
    arm.model = a.arm;
    arm.model.tree.gravity = motion.gravity;
    arm.floats = arm.model.tree.size() > 0;
    for (const multibody::TreeBody& b : arm.model.tree.bodies())
      arm.floats = arm.floats && (b.parent >= 0 || b.joint == multibody::JointKind::free);
    // Coordinates and rates are lengths and angles of the links and of a floating base.
    const multibody::ArmTolerances tolerances{
        std::min(options.body_position_tolerance, options.angle_tolerance),
        std::min(options.body_velocity_tolerance, options.spin_tolerance), 1e-6, false};
    arm.part.emplace(arm.model, a.drives, a.loads, tolerances, multibody::BaseEquations::newton_euler);
    arm.stepper.emplace(*arm.part, a.switches);
  }
  for (const MotionWeld& w : motion.welds) {
    const BodyPart& body = bodies[at_index(w.body)];
    welds_.emplace_back(w.name, frame_of(w.carrier, bodies, pose_of(body.body().start)), body, Pose{},
                        options);
    held_.push_back(&body);
  }
  for (const MotionMount& m : motion.mounts) {
    const wire::SpatialRodProperties& p = motion.wires[at_index(m.wire)].rod.properties;
    mounts_.emplace_back(m, frame_of(m.carrier, bodies, mount_pose(p.end(m.end))), rods[at_index(m.wire)],
                         options);
  }
  for (const MotionBushing& b : motion.bushings)
    bushings_.emplace_back(b, frame_of(b.first, bodies, b.X_WF),
                           frame_of(b.second, bodies, b.X_WG.value_or(b.X_WF)));
  for (const WeldPart& w : welds_) constraints_.push_back(&w);
  for (const MountPart& m : mounts_) constraints_.push_back(&m);
}

// The frame that a carrier holds where it is wanted at the start: X_CF = X_WC^-1 X_WF.
MovingFrame ConstraintSet::frame_of(const MotionCarrier& carrier, const std::deque<BodyPart>& bodies,
                                    const Pose& X_WF) const {
  switch (carrier.kind) {
    case MotionCarrier::Kind::world:
      break;
    case MotionCarrier::Kind::body: {
      const BodyPart& body = bodies[at_index(carrier.index)];
      return {body, pose_of(body.body().start).inverse() * X_WF};
    }
    case MotionCarrier::Kind::arm: {
      const Arm& arm = arms_[at_index(carrier.index)];
      const multibody::Tree& tree = arm.model.tree;
      const int body = tree.frame(carrier.frame).body;
      if (body < 0) break;
      multibody::Kinematics kinematics(tree);
      multibody::place(tree, motion_.arms[at_index(carrier.index)].start.q, kinematics);
      return {*arm.part, body, kinematics.X_WB[at_index(body)].inverse() * X_WF};
    }
  }
  return MovingFrame(X_WF);
}

void ConstraintSet::append(std::vector<numerics::DaePart*>& parts) {
  for (Arm& a : arms_) parts.push_back(&*a.part);
  for (WeldPart& w : welds_) parts.push_back(&w);
  for (MountPart& m : mounts_) parts.push_back(&m);
  for (BushingPart& b : bushings_) parts.push_back(&b);
}

int ConstraintSet::event_count() const {
  int count = 0;
  for (const Arm& a : arms_) count += a.part->event_count();
  return count;
}

void ConstraintSet::place(VectorXd& y) {
  for (std::size_t k = 0; k < arms_.size(); ++k) {
    arms_[k].part->write_state(motion_.arms[k].start, y);
    arms_[k].part->settle(0.0, y);
  }
  // What is held moves with its carrier, v = v_F and w_B = R_WF^T w_F: X_BH of a weld is the identity here.
  for (std::size_t k = 0; k < welds_.size(); ++k) {
    const MovingFrame::State s = welds_[k].carrier().state(y);
    y.segment<3>(held_[k]->velocity()) = s.linear;
    y.segment<3>(held_[k]->spin()) = s.X_WF.R.transpose() * s.angular;
  }
  for (const MountPart& m : mounts_) m.place(y);
  for (const CarriedWire& w : carried_wires(y)) {
    for (int i = 0; i < w.rod->vertices(); ++i) y.segment<3>(w.rod->velocity_of(i)) = w.velocity(i, y);
  }
  begin_interval(0.0);
}

void ConstraintSet::place_twist_rates(const VectorXd& y, VectorXd& rate) const {
  for (const CarriedWire& w : carried_wires(y)) {
    for (int e = 0; e + 1 < w.rod->vertices(); ++e) rate[w.rod->angle_of(e)] = w.twist_rate(e, y);
  }
}

std::vector<CarriedWire> ConstraintSet::carried_wires(const VectorXd& y) const {
  std::vector<CarriedWire> wires;
  for (std::size_t k = 0; k < mounts_.size(); ++k) {
    const int wire = motion_.mounts[k].wire;
    if (motion_.wires[at_index(wire)].velocities.cols() > 0) continue;
    auto found = std::ranges::find(wires, wire, &CarriedWire::wire);
    if (found == wires.end()) found = wires.insert(wires.end(), CarriedWire{&mounts_[k].rod(), wire, {}});
    const wire::End end = mounts_[k].end(),
                    other = end == wire::End::left ? wire::End::right : wire::End::left;
    const MovingFrame::State carrier = mounts_[k].carrier().state(y);
    found->carriers[index_of(end)] = carrier;
    const wire::SpatialEnd& opposite = motion_.wires[at_index(wire)].rod.properties.end(other);
    if (opposite.kind == wire::SpatialEnd::Kind::free) found->carriers[index_of(other)] = carrier;
  }
  return wires;
}

void ConstraintSet::zero_multipliers(VectorXd& y) const {
  // Multipliers and the stabilisers behind them.
  for (const Constraint* c : constraints_) y.segment(c->multipliers(), 2 * c->constraints()).setZero();
}

void ConstraintSet::solve_rates(double time, const VectorXd& y, const VectorXd& rows, VectorXd& rate) {
  for (Arm& a : arms_) a.part->solve_rates(time, y, rows, rate);
}

void ConstraintSet::project(const VectorXd& y, VectorXd& dv) const {
  static_cast<void>(coupling::project(constraints_, y, {}, dv));
}

// d(G v)/dt = G v' + (dG/dt) v = 0: the bias is the second term.
VectorXd ConstraintSet::hold_rates(const VectorXd& y, VectorXd& rate) const {
  Eigen::Index n = 0;
  for (const Constraint* c : constraints_) n += c->constraints();
  VectorXd bias(n);
  n = 0;
  for (const Constraint* c : constraints_) {
    bias.segment(n, c->constraints()) = c->acceleration_bias(y, rate);
    n += c->constraints();
  }
  return coupling::project(constraints_, y, bias, rate);
}

void ConstraintSet::set_multipliers(const VectorXd& multipliers, VectorXd& y) const {
  Eigen::Index first = 0;
  for (const Constraint* c : constraints_) {
    y.segment(c->multipliers(), c->constraints()) = multipliers.segment(first, c->constraints());
    first += c->constraints();
  }
}

void ConstraintSet::begin_interval(double time) {
  limit_ = end_;
  for (Arm& a : arms_) limit_ = a.stepper->next_break(time, limit_);
  for (Arm& a : arms_) a.part->enter_interval(time, limit_);
}

bool ConstraintSet::process_events(const DaePoint& at, std::span<const int> found, VectorXd& y) {
  if (arms_.empty()) return false;
  const double time = at.time;  // `at` may view y, which changes
  bool anew = false, drives_anew = false;
  std::size_t first = 0;
  for (std::size_t k = 0; k < arms_.size(); ++k) {
    Arm& arm = arms_[k];
    const auto count = at_index(arm.part->event_count());
    const std::vector<int> ended_modes =
        arm.stepper->ended_modes(at, found.empty() ? found : found.subspan(first, count));
    first += count;
    if (const auto stuck = arm.stepper->crowding(ended_modes, time))
      stuck_ = motion_.arms[k].name + ": " + *stuck;
    if (!ended_modes.empty()) {
      arm.part->leave_modes(time, y, ended_modes);
      anew = true;
    }
    drives_anew = arm.stepper->change_drives(time, y) || drives_anew;
  }
  if (drives_anew || (time >= limit_ && time < end_)) {
    begin_interval(time);
    for (Arm& a : arms_) a.part->settle(time, y);
    anew = true;
  }
  return anew;
}

void ConstraintSet::change_drive(int arm, int joint, const multibody::Drive& drive, double time,
                                 VectorXd& y) {
  restore_drive(arm, joint, drive);
  arms_[at_index(arm)].part->stop_ruled_motors(y);
  begin_interval(time);
  for (Arm& a : arms_) a.part->settle(time, y);
}

void ConstraintSet::restore_drive(int arm, int joint, const multibody::Drive& drive) {
  multibody::ElasticArmPart& part = *arms_[at_index(arm)].part;
  std::vector<multibody::Drive> drives = part.drives();
  drives[at_index(joint)] = drive;
  part.set_drives(std::move(drives));
}

void ConstraintSet::save_state(std::vector<double>& memory) const {
  for (const Arm& a : arms_) a.stepper->save_state(memory);
}

void ConstraintSet::restore_state(double time, std::span<const double>& memory) {
  for (Arm& a : arms_) a.stepper->restore_state(memory);
  begin_interval(time);
}

double ConstraintSet::lost(const VectorView& y) const {
  double sum = 0.0;
  for (const Arm& a : arms_) sum += a.part->work(y).lost;
  return sum;
}

void ConstraintSet::add_energy(const VectorView& y, EnergyBalance& energy, MotionSample* sample) const {
  for (const BushingPart& b : bushings_) energy.strain += b.state(y).energy;
  for (const MountPart& m : mounts_) energy.strain += m.spring_energy(y);
  for (const Arm& a : arms_) {
    const multibody::ArmState state = a.part->state(y);
    multibody::Kinematics kinematics(a.model.tree);
    multibody::place(a.model.tree, state.q, kinematics);
    multibody::set_moving(a.model.tree, state.v, kinematics);
    // Kinetic energy of the tree and of the motors (Im qm'^2/2); what is left of the total is that of the
    // springs.
    const double links = multibody::kinetic_energy(a.model.tree, kinematics);
    const double potential = multibody::potential_energy(a.model.tree, kinematics);
    double motors = 0.0;
    for (int k = 0; k < a.model.motors(); ++k)
      motors += 0.5 * a.model.joints[at_index(k)].motor_inertia * state.motor_rate[k] * state.motor_rate[k];
    const multibody::ArmWork work = a.part->work(y);
    energy.kinetic += links + motors;
    energy.potential += potential;
    energy.strain += multibody::total_energy(a.model, state) - links - motors - potential;
    energy.work += work.motors + work.loads;
    if (sample == nullptr || !a.floats) continue;
    const multibody::Wrench h = multibody::momentum(a.model.tree, kinematics);
    sample->momentum += h.force;
    sample->angular_momentum += h.moment;
  }
}

// Whether the momentum of what carries the frame is counted.
bool ConstraintSet::in_momentum_balance(const MovingFrame& frame) const {
  if (frame.body() != nullptr) return frame.moves_freely();
  for (const Arm& a : arms_) {
    if (&*a.part == frame.arm()) return a.floats;
  }
  return false;
}

// Of forces between what is counted and what is not.
void ConstraintSet::add_forces(const FrameForces& forces, const std::vector<multibody::Wrench>& wrenches,
                               const DaePoint& at, Outer& sum) const {
  for (std::size_t k = 0; k < wrenches.size(); ++k) {
    const MovingFrame& frame = forces.frames()[k];
    const MovingFrame::State carrier = frame.state(at.y);
    if (in_momentum_balance(frame)) {
      sum.force += wrenches[k].force;
      sum.moment += wrenches[k].moment + carrier.X_WF.p.cross(wrenches[k].force);
    }
    // What moves as told works against the wrench on it.
    if (!frame.moves_freely())
      sum.power -= wrenches[k].force.dot(carrier.linear) + wrenches[k].moment.dot(carrier.angular);
  }
}

void ConstraintSet::add_load(const LoadPart& load, const DaePoint& at, Outer& sum) const {
  const multibody::Wrench w = load.wrench(at);
  const MovingFrame::State s = load.frame().state(at.y);
  if (!load.frame().moves_freely()) return;
  sum.power += w.force.dot(s.linear) + w.moment.dot(s.angular);
  if (!in_momentum_balance(load.frame())) return;
  sum.force += w.force;
  sum.moment += w.moment + s.X_WF.p.cross(w.force);
}

// Forces and moments about the origin on everything whose momentum is counted: what carriers give whose own
// is not, and weight and loads of floating arms. A carrier that nothing moves freely works: P = F.v + M.w.
ConstraintSet::Outer ConstraintSet::outer(const DaePoint& at) const {
  Outer sum;
  const auto add = [&](const Constraint& constraint, const Vector3d& moment) {
    const MovingFrame& carrier = constraint.carrier();
    if (in_momentum_balance(carrier)) return;
    const multibody::Wrench w = constraint.wrench(at.y);
    const MovingFrame::State s = carrier.state(at.y);
    sum.force += w.force;
    sum.moment += moment + s.X_WF.p.cross(w.force);
    if (carrier.moves_freely()) return;
    sum.power += w.force.dot(s.linear) + moment.dot(s.angular);
  };
  for (const WeldPart& w : welds_) add(w, w.wrench(at.y).moment);
  for (const MountPart& m : mounts_) {
    add(m, m.wrench(at.y).moment - m.moment(at));
    sum.lost += m.lost_power(at.y);
  }
  for (const BushingPart& b : bushings_) {
    const FrameForces::Work work = b.work(at.y);
    add_forces(b, work.wrenches, at, sum);
    sum.lost += work.power.lost;
  }
  for (std::size_t k = 0; k < arms_.size(); ++k) {
    if (!arms_[k].floats) continue;
    const multibody::Tree& tree = arms_[k].model.tree;
    multibody::Kinematics kinematics(tree);
    multibody::place(tree, arms_[k].part->state(at.y).q, kinematics);
    const Vector3d weight = tree.mass() * motion_.gravity;
    sum.force += weight;
    sum.moment += multibody::centre_of_mass(tree, kinematics).cross(weight);
    for (const multibody::TimedLoad& load : motion_.arms[k].loads) {
      const double share = load.share(at.time);
      const Vector3d point = multibody::frame_pose(tree, kinematics, load.frame).p;
      sum.force += share * load.peak.force;
      sum.moment += share * (load.peak.moment + point.cross(load.peak.force));
    }
  }
  return sum;
}

std::optional<Vector3d> ConstraintSet::mount_force(int wire, wire::End end, const VectorView& y) const {
  for (std::size_t k = 0; k < mounts_.size(); ++k) {
    if (motion_.mounts[k].wire == wire && mounts_[k].end() == end) return mounts_[k].wrench(y).force;
  }
  return std::nullopt;
}

void ConstraintSet::fill(double time, const VectorView& y, MotionSample& sample) const {
  for (std::size_t k = 0; k < mounts_.size(); ++k) {
    const auto i = 2 * at_index(motion_.mounts[k].wire) + index_of(mounts_[k].end());
    sample.mount_forces[i] = mounts_[k].wrench(y).force;
  }
  for (const Arm& a : arms_) {
    MotionSample::Arm s;
    s.state = a.part->state(y);
    s.work = a.part->work(y);
    s.joint_torque.resize(a.model.motors());
    s.drive_torque.resize(a.model.motors());
    for (int k = 0; k < a.model.motors(); ++k) {
      s.joint_torque[k] = a.part->joint_torque(y, k);
      s.drive_torque[k] = a.part->drive_torque(time, y, k);
    }
    sample.arms.push_back(std::move(s));
  }
  for (const WeldPart& w : welds_) sample.welds.push_back(w.wrench(y));
  for (const BushingPart& b : bushings_) {
    const BushingPart::State s = b.state(y);
    sample.bushings.push_back({s.shift, s.turn, s.on_second});
  }
}

double ConstraintSet::largest_gap(const VectorView& y) const {
  double gap = 0.0;
  for (const Constraint* c : constraints_) gap = std::max(gap, c->gap(y));
  return gap;
}

}  // namespace snare::coupling
