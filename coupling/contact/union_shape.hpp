#pragma once

#include "coupling/contact/shape.hpp"

#include <memory>
#include <vector>

namespace snare::coupling {

/// Several solids as one: phi = min phi_i.                                                   theory.md (G.10)
/// Exact outside; the normal jumps where two of them are equally near.
class UnionShape final : public ContactShape {
 public:
  /// One shape or more, none null, in one frame.
  explicit UnionShape(std::vector<std::shared_ptr<const ContactShape>> shapes);
  [[nodiscard]] DistanceField at(const Eigen::Vector3d& p) const override;
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const override;
  /// The least of the shapes' [m].
  [[nodiscard]] double smallest_radius() const override;
  [[nodiscard]] std::vector<std::shared_ptr<const ContactShape>> pieces(double wire_radius) const override;
  [[nodiscard]] bool is_mirrored(const Eigen::Vector3d& n, double offset) const override;
  /// Of all shapes.
  [[nodiscard]] std::vector<Eigen::Matrix3Xd> drawing() const override;

 private:
  std::vector<std::shared_ptr<const ContactShape>> shapes_;
};

}  // namespace snare::coupling
