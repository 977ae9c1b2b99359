#include "coupling/dynamics/model/result.hpp"

#include <algorithm>

namespace snare::coupling {

std::string to_string(MotionEvent::Kind kind) {
  switch (kind) {
    case MotionEvent::Kind::touch:
      return "touch";
    case MotionEvent::Kind::lift_off:
      return "lift_off";
    case MotionEvent::Kind::stick:
      return "stick";
    case MotionEvent::Kind::slip:
      return "slip";
  }
  return "";
}

double end_tension(const Eigen::Matrix3Xd& x, const Eigen::Vector3d& left, const Eigen::Vector3d& right) {
  const Eigen::Index n = x.cols() - 1;
  const double at_left = -left.dot((x.col(1) - x.col(0)).normalized());
  const double at_right = right.dot((x.col(n) - x.col(n - 1)).normalized());
  // A free end has no mount: no force at all.
  if (left.isZero(0.0)) return at_right;
  if (right.isZero(0.0)) return at_left;
  return std::min(at_left, at_right);
}

double end_tension(const MotionSample& sample, std::size_t wire) {
  const std::size_t rods = sample.wires.size() - sample.law_tensions.size();
  if (wire >= rods) return sample.law_tensions[wire - rods];
  return end_tension(sample.wires[wire], sample.mount_forces[2 * wire], sample.mount_forces[2 * wire + 1]);
}

}  // namespace snare::coupling
