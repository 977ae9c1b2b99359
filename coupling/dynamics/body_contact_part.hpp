#pragma once

#include "coupling/contact/shape.hpp"
#include "coupling/dynamics/body_contact.hpp"
#include "coupling/dynamics/point_tree.hpp"
#include "coupling/dynamics/press_part.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace snare::coupling {

template <class S>
struct FrameMotion;

/// Contact of two carriers in a DAE.                                                                    theory.md (M.28)
class BodyContactPart final : public PressPart {
 public:
  /// Frames of the shape and of the points.
  BodyContactPart(const BodyContact& contact, MovingFrame shape, MovingFrame points);

  [[nodiscard]] std::vector<multibody::Wrench> wrenches(const numerics::VectorView& y) const override;
  [[nodiscard]] double depth(const numerics::VectorView& y) const override;
  [[nodiscard]] double touches(const numerics::VectorView& y) const override;
  [[nodiscard]] bool jumps() const override { return jumps_at_touch(contact_.law); }
  [[nodiscard]] Pressing pressing(const numerics::VectorView& y) const override;

 private:
  using Frames = std::array<FrameMotion<double>, 2>;
  [[nodiscard]] Eigen::MatrixXd derivatives(const numerics::VectorView& y) const override;
  /// A point of the other's frame in the frame of the shape.
  [[nodiscard]] static Eigen::Vector3d in_shape(const Frames& now, const Eigen::Vector3d& point);
  /// The points that are in the shape, in their order, with its field there.
  [[nodiscard]] std::vector<std::pair<std::size_t, DistanceField>> points_inside(const Frames& now) const;

  BodyContact contact_;
  PointTree tree_;
};

}  // namespace snare::coupling
