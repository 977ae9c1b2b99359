// The rates at a start, and after what changes them at once.

#include "coupling/dynamics/run/run.hpp"

#include <utility>

namespace snare::coupling {

using Eigen::VectorXd;

// With all accelerations and constraint forces zero the rows are minus the forces; what the constraints then
// miss gives their forces.                                                                   theory.md (M.10)
// Angles of edges have no inertia: their rates are continuous, as are the velocities that determine them.
void MotionRun::make_rates() {
  const VectorXd before = std::exchange(rate_, VectorXd::Zero(y_.size()));
  for (const wire::RodPart& r : rods_) {
    for (int i = 0; i < r.vertices(); ++i)
      rate_.segment<3>(r.position_of(i)) = y_.segment<3>(r.velocity_of(i));
    for (int e = 0; e + 1 < r.vertices(); ++e) rate_[r.angle_of(e)] = before[r.angle_of(e)];
  }
  for (const BodyPart& b : bodies_) {
    rate_.segment<3>(b.position()) = y_.segment<3>(b.velocity());
    rate_.segment<4>(b.quaternion()) =
        multibody::quaternion_rates(y_.segment<4>(b.quaternion())) * y_.segment<3>(b.spin());
  }
  constraints_->zero_multipliers(y_);
  VectorXd rows(system_->size());
  system_->residual({time_, y_, rate_}, rows);
  for (const wire::RodPart& r : rods_) {
    for (int i = 0; i < r.vertices(); ++i) {
      for (int k = 0; k < 3; ++k) {
        if (!r.is_held(i, k))
          rate_[r.velocity_of(i) + k] = -rows[r.velocity_of(i) + k] / r.model().inertia_of(i);
      }
      if (r.constants().strands.act()) rate_.segment<2>(r.strand_of(i)) = -rows.segment<2>(r.strand_of(i));
    }
  }
  for (const BodyPart& b : bodies_) {
    if (!b.moves_freely()) {
      rate_.segment<3>(b.velocity()) = b.course_acceleration(time_);
      continue;
    }
    rate_.segment<3>(b.velocity()) = -rows.segment<3>(b.velocity()) / b.body().properties.mass;
    rate_.segment<3>(b.spin()) = -b.inverse_inertia() * rows.segment<3>(b.spin());
  }
  constraints_->solve_rates(time_, y_, rows, rate_);
  constraints_->set_multipliers(constraints_->hold_rates(y_, rate_), y_);
  for (const auto& i : interactions_) i->set_bristle_rates(y_, rate_);
}

void MotionRun::restart() {
  make_rates();
  count_losses();
  law_losses_.begin(time_, law_loss({time_, y_, rate_}));
  ida_->set_integrals(integrals_);
  ida_->start(time_, y_, rate_);
}

}  // namespace snare::coupling
