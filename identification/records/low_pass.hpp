#pragma once

#include <Eigen/Core>

namespace snare::identification {

/// A low-pass filter without delay: Butterworth's of the fourth order forward and backward in time, so that
/// the share of an amplitude that passes is 1/(1 + (f/f_c)^8); for evenly spaced values, continued oddly at
/// both ends.                                                                                theory.md (I.25)
/// interval > 0 [s]; cutoff f_c in (0, 0.5/interval) [Hz]. Fewer than two values stay as they are.
[[nodiscard]] Eigen::VectorXd low_passed(const Eigen::VectorXd& values, double interval, double cutoff);

}  // namespace snare::identification
