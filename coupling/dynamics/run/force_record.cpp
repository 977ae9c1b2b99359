#include "coupling/dynamics/run/force_record.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <utility>

namespace snare::coupling {

namespace {

constexpr std::size_t most = 4;  // states

}  // namespace

void ForceRecord::add(double time, Eigen::VectorXd forces) {
  records_.push_back({time, std::move(forces)});
  if (records_.size() > most) records_.pop_front();
}

// Neville's scheme, from the latest state back: entry k becomes the polynomial through states k to k +
// degree.
double ForceRecord::at(double time, Eigen::Index index, int states) const {
  const std::size_t count = std::min(records_.size(), static_cast<std::size_t>(states));
  assert(count >= 2);
  std::array<double, most> force{};
  for (std::size_t k = 0; k < count; ++k) force[k] = records_[records_.size() - 1 - k].forces[index];
  for (std::size_t degree = 1; degree < count; ++degree) {
    for (std::size_t k = 0; k + degree < count; ++k) {
      const double late = records_[records_.size() - 1 - k].time,
                   early = records_[records_.size() - 1 - k - degree].time;
      force[k] += (force[k + 1] - force[k]) * (late - time) / (late - early);
    }
  }
  return force[0];
}

}  // namespace snare::coupling
