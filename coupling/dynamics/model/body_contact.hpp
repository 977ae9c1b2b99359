#pragma once

#include "coupling/contact/contact_law.hpp"
#include "coupling/contact/friction.hpp"
#include "coupling/contact/shape.hpp"
#include "coupling/dynamics/model/arm.hpp"
#include "multibody/spatial.hpp"

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace snare::coupling {

/// Points of one carrier that touch a shape of another: a plate on a housing, a cam in a guide.
///                                                                                           theory.md (M.28)
///
/// Each point is a ball of `radius` (0: a point) and bears the law on its own, F(d, d') of its depth in the
/// shape along the shape's normal. Edges that cross between the points are not seen.
struct BodyContact {
  std::string name = "contact";
  MotionCarrier carrier;                      ///< of the shape
  multibody::Pose X_WS;                       ///< of the shape at the start
  std::shared_ptr<const ContactShape> shape;  ///< signed distance
  MotionCarrier other;                        ///< of the points
  multibody::Pose X_WP;                       ///< of their frame at the start
  std::vector<Eigen::Vector3d> points;        ///< in that frame [m]
  double radius = 0.0;                        ///< [m], >= 0
  ContactLaw law;
  MotionFriction friction;
};

}  // namespace snare::coupling
