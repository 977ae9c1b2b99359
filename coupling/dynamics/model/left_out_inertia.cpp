#include "coupling/dynamics/model/left_out_inertia.hpp"

#include <algorithm>

namespace snare::coupling {

void LeftOutMomentum::add(double time, double kinetic, const Eigen::Vector3d& momentum,
                          LeftOutInertia& largest) {
  largest.kinetic = std::max(largest.kinetic, kinetic);
  record_.add(time, momentum);
  const WindowRecord::Record& from = record_.records().front();
  if (record_.records().size() < 2 || from.time > time - record_.window()) return;
  largest.force = std::max(largest.force, (momentum - from.values).norm() / (time - from.time));
}

}  // namespace snare::coupling
