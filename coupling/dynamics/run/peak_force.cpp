#include "coupling/dynamics/run/peak_force.hpp"

#include <algorithm>

namespace snare::coupling {

using Eigen::VectorXd;

void PeakForce::add(double before, double time, const VectorXd& forces, const VectorXd& impulses,
                    std::vector<double>& peaks) {
  const double window = record_.window();
  const double begin = time - window;
  record_.add(time, impulses);
  VectorXd mean = forces;
  if (time - before < window) {
    mean.setZero();
    if (record_.records().front().time <= begin) {
      const WindowRecord::Record &a = record_.records()[0], &b = record_.records()[1];
      const double share = (begin - a.time) / (b.time - a.time);
      mean = (impulses - (1.0 - share) * a.values - share * b.values) / window;
    }
  }
  for (std::size_t k = 0; k < peaks.size(); ++k)
    peaks[k] = std::max(peaks[k], mean[static_cast<Eigen::Index>(k)]);
}

}  // namespace snare::coupling
