#include "coupling/contact/union_shape.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace snare::coupling {

UnionShape::UnionShape(std::vector<std::shared_ptr<const ContactShape>> shapes) : shapes_(std::move(shapes)) {
  assert(!shapes_.empty());
}

std::vector<std::shared_ptr<const ContactShape>> UnionShape::pieces(double wire_radius) const {
  std::vector<std::shared_ptr<const ContactShape>> pieces;
  for (const std::shared_ptr<const ContactShape>& shape : shapes_) {
    for (std::shared_ptr<const ContactShape>& piece : pieces_of(shape, wire_radius))
      pieces.push_back(std::move(piece));
  }
  return pieces;
}

DistanceField UnionShape::at(const Eigen::Vector3d& p) const {
  DistanceField least = shapes_.front()->at(p);
  for (std::size_t k = 1; k < shapes_.size(); ++k) {
    const DistanceField field = shapes_[k]->at(p);
    if (field.distance < least.distance) least = field;
  }
  return least;
}

double UnionShape::distance(const Eigen::Vector3d& p) const {
  double least = std::numeric_limits<double>::infinity();
  for (const std::shared_ptr<const ContactShape>& shape : shapes_)
    least = std::min(least, shape->distance(p));
  return least;
}

double UnionShape::smallest_radius() const {
  double least = std::numeric_limits<double>::infinity();
  for (const std::shared_ptr<const ContactShape>& shape : shapes_)
    least = std::min(least, shape->smallest_radius());
  return least;
}

std::vector<Eigen::Matrix3Xd> UnionShape::drawing() const {
  std::vector<Eigen::Matrix3Xd> lines;
  for (const std::shared_ptr<const ContactShape>& shape : shapes_) {
    for (Eigen::Matrix3Xd& line : shape->drawing()) lines.push_back(std::move(line));
  }
  return lines;
}

bool UnionShape::is_mirrored(const Eigen::Vector3d& n, double offset) const {
  return std::ranges::all_of(shapes_, [&](const auto& s) { return s->is_mirrored(n, offset); });
}

}  // namespace snare::coupling
