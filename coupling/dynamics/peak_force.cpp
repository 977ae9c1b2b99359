#include "coupling/dynamics/peak_force.hpp"

#include "numerics/dae.hpp"

#include <algorithm>

namespace snare::coupling {

using Eigen::VectorXd;

void PeakForce::add(double before, double time, const VectorXd& forces, const VectorXd& impulses,
                    std::vector<double>& peaks) {
  const double begin = time - window_;
  records_.push_back({time, impulses});
  while (records_.size() > 2 && records_[1].time <= begin) records_.pop_front();
  VectorXd mean = forces;
  if (time - before < window_) {
    mean.setZero();
    if (records_.front().time <= begin) {
      const Record &a = records_[0], &b = records_[1];
      const double share = (begin - a.time) / (b.time - a.time);
      mean = (impulses - (1.0 - share) * a.impulses - share * b.impulses) / window_;
    }
  }
  for (std::size_t k = 0; k < peaks.size(); ++k) peaks[k] = std::max(peaks[k], mean[static_cast<Eigen::Index>(k)]);
}

void PeakForce::save_state(std::vector<double>& memory) const {
  memory.push_back(static_cast<double>(records_.size()));
  memory.push_back(records_.empty() ? 0.0 : static_cast<double>(records_.front().impulses.size()));
  for (const Record& r : records_) {
    memory.push_back(r.time);
    memory.insert(memory.end(), r.impulses.begin(), r.impulses.end());
  }
}

void PeakForce::restore_state(std::span<const double>& memory) {
  records_.resize(static_cast<std::size_t>(numerics::take(memory)));
  const auto size = static_cast<Eigen::Index>(numerics::take(memory));
  for (Record& r : records_) {
    r.time = numerics::take(memory);
    r.impulses.resize(size);
    for (double& i : r.impulses) i = numerics::take(memory);
  }
}

}  // namespace snare::coupling
