// Phases of a motion, and the signals they wait for.

#include "base/index.hpp"
#include "coupling/dynamics/run/run.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

using base::at;
using Eigen::Vector3d;

double MotionRun::tension(int wire) {
  if (at(wire) >= rods_.size()) return law_wires_[at(wire) - rods_.size()]->pressing(y_).tension;
  const wire::RodPart& rod = rods_[at(wire)];
  std::optional<std::array<Vector3d, 2>> at_start;
  std::array<Vector3d, 2> forces;
  for (const wire::End end : wire::ends) {
    const std::optional<Vector3d> moving = constraints_->mount_force(wire, end, y_);
    if (!moving && !at_start) at_start = rods_[at(wire)].energies({time_, y_, rate_}).mount_forces;
    forces[index_of(end)] = moving ? *moving : (*at_start)[index_of(end)];
  }
  const auto vertex = [&](int i) { return y_.segment<3>(rod.position_of(i)); };
  const int n = rod.vertices() - 1;
  Eigen::Matrix3Xd ends(3, 4);
  ends << vertex(0), vertex(1), vertex(n - 1), vertex(n);
  return end_tension(ends, forces[0], forces[1]);
}

double MotionRun::signal(const MotionSignal& s) {
  switch (s.kind) {
    case MotionSignal::Kind::contact_force:
      return interactions_[at(s.index)]->load({time_, y_, rate_}).normal;
    case MotionSignal::Kind::wire_tension:
      return tension(s.index);
    case MotionSignal::Kind::joint_torque:
      return std::abs(constraints_->arm(s.index).joint_torque(y_, s.joint));
    case MotionSignal::Kind::joint_angle: {
      const multibody::ElasticArmPart& part = constraints_->arm(s.index);
      return part.state(y_).q[part.arm().tree.body(part.arm().joints[at(s.joint)].body).q_index];
    }
    case MotionSignal::Kind::distance:
    case MotionSignal::Kind::speed: {
      const MovingFrame::State a = constraints_->frame_of(s.carriers[0], bodies_, s.poses[0]).state(y_);
      const MovingFrame::State b = constraints_->frame_of(s.carriers[1], bodies_, s.poses[1]).state(y_);
      return s.kind == MotionSignal::Kind::distance ? (b.X_WF.p - a.X_WF.p).norm()
                                                    : (b.linear - a.linear).norm();
    }
  }
  return 0.0;
}

PhaseWatch::Signals MotionRun::signals() {
  return [this](const MotionSignal& s) { return signal(s); };
}

PhaseWatch::Kept MotionRun::kept() const {
  return [this](const SensedBound& b) { return b.kept_by(sensed_.last(b.sensed)); };
}

void MotionRun::sense() {
  if (phases_.asks_for_readings())
    sensed_.cross_break(time_, [this] { return sample({time_, y_, rate_}, integrals_); });
}

// The integrator has gone on behind the beginning of the phase: its polynomial gives the state there. It has
// not gone on behind a reading.
bool MotionRun::look_for_phase() {
  const std::optional<double> begins = phases_.look(time_, signals(), kept());
  if (begins && *begins < time_) {
    time_ = *begins;
    y_ = ida_->interpolate(time_);
    rate_ = ida_->interpolate(time_, 1);
    integrals_ = ida_->interpolate_integrals(time_);
    return true;
  }
  sense();
  return begins || phases_.read(time_, kept());
}

bool MotionRun::begin_phases() {
  for (bool another = true; another;) {
    const MotionPhase& phase = *phases_.pending();
    PhaseBeginning begun{static_cast<int>(&phase - motion_.phases.data()), time_, {}};
    for (const PhaseDrive& d : phase.drives) {
      begun.angles.push_back(constraints_->arm(d.arm).state(y_).motor[d.joint]);
      constraints_->change_drive(d.arm, d.joint, d.make(time_, begun.angles.back()), time_, y_);
    }
    sums_.phases.push_back(std::move(begun));
    if (phase.ends_run) return true;
    phases_.begin(time_, signals(), kept());
    another = phases_.look(time_, signals(), kept()).has_value();
  }
  restart();
  return false;
}

void MotionRun::restore_phases(std::span<const double>& memory) {
  phases_.restore_state(memory);
  sensed_.restore_state(memory);
  for (const PhaseBeginning& begun : sums_.phases) {
    const std::vector<PhaseDrive>& drives = motion_.phases[at(begun.phase)].drives;
    for (std::size_t k = 0; k < drives.size(); ++k)
      constraints_->restore_drive(drives[k].arm, drives[k].joint,
                                  drives[k].make(begun.time, begun.angles[k]));
  }
}

}  // namespace snare::coupling
