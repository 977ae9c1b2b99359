#include "coupling/dynamics/contact/element_boxes.hpp"

#include "base/index.hpp"

namespace snare::coupling {

ElementBoxes::ElementBoxes(int elements) {
  while (leaves_ < base::at(elements)) leaves_ *= 2;
  boxes_.resize(2 * leaves_);
}

void ElementBoxes::place(const BezierWire& curve, const numerics::VectorView& y) {
  for (int e = 0; e < curve.elements(); ++e) {
    const BezierWire::Control c = curve.control(e, y);
    boxes_[leaves_ + base::at(e)] = Eigen::AlignedBox3d(c.rowwise().minCoeff(), c.rowwise().maxCoeff());
  }
  for (std::size_t k = leaves_ - 1; k >= root; --k) boxes_[k] = boxes_[2 * k].merged(boxes_[2 * k + 1]);
}

}  // namespace snare::coupling
