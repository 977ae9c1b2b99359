#pragma once

#include <Eigen/Core>

#include <memory>

namespace snare::coupling {

/// A signed distance with its derivatives at a point, in the shape's own frame.
struct DistanceField {
  double distance = 0.0;                              ///< [m], negative inside
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< its gradient: unit, outward
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  ///< of the distance [1/m]
};

/// A rigid surface that a wire can touch, as a signed distance.
class ContactShape {
 public:
  ContactShape() = default;
  virtual ~ContactShape() = default;
  ContactShape(const ContactShape&) = delete;
  ContactShape& operator=(const ContactShape&) = delete;
  /// p: a point in the shape's frame [m]. Must be twice differentiable wherever a wire's centreline can come.
  [[nodiscard]] virtual DistanceField at(const Eigen::Vector3d& p) const = 0;
};

/// A ball about the origin; radius 0 is a point.
class Ball final : public ContactShape {
 public:
  explicit Ball(double radius) : radius_(radius) {}  ///< [m], >= 0
  [[nodiscard]] DistanceField at(const Eigen::Vector3d& p) const override;

 private:
  double radius_;
};

/// An endless round cylinder about the z axis; radius 0 is a line (a knife edge that never bends).
class EndlessCylinder final : public ContactShape {
 public:
  explicit EndlessCylinder(double radius) : radius_(radius) {}  ///< [m], >= 0
  [[nodiscard]] DistanceField at(const Eigen::Vector3d& p) const override;

 private:
  double radius_;
};

}  // namespace snare::coupling
