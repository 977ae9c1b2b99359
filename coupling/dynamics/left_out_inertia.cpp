#include "coupling/dynamics/left_out_inertia.hpp"

#include "numerics/dae.hpp"

#include <algorithm>

namespace snare::coupling {

void LeftOutMomentum::add(double time, double kinetic, const Eigen::Vector3d& momentum, LeftOutInertia& largest) {
  largest.kinetic = std::max(largest.kinetic, kinetic);
  records_.push_back({time, momentum});
  while (records_.size() > 2 && records_[1].time <= time - window_) records_.pop_front();
  const Record& from = records_.front();
  if (records_.size() < 2 || from.time > time - window_) return;
  largest.force = std::max(largest.force, (momentum - from.momentum).norm() / (time - from.time));
}

void LeftOutMomentum::save_state(std::vector<double>& memory) const {
  memory.push_back(static_cast<double>(records_.size()));
  for (const Record& r : records_)
    memory.insert(memory.end(), {r.time, r.momentum.x(), r.momentum.y(), r.momentum.z()});
}

void LeftOutMomentum::restore_state(std::span<const double>& memory) {
  records_.resize(static_cast<std::size_t>(numerics::take(memory)));
  for (Record& r : records_) {
    r.time = numerics::take(memory);
    for (int k = 0; k < 3; ++k) r.momentum[k] = numerics::take(memory);
  }
}

}  // namespace snare::coupling
