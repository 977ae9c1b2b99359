#pragma once

#include "coupling/contact/shape.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::coupling {

/// One piece of a profile, from the end of the one before: a straight line or the minor arc of a circle.
struct ProfilePiece {
  Eigen::Vector2d end = Eigen::Vector2d::Zero();  ///< (distance from the axis, height z) [m]
  double curvature = 0.0;  ///< [1/m]; > 0 bulges outward, < 0 inward, 0: straight; at most 2/(length of the chord)
};

/// A solid of revolution about the z axis. Its profile runs from the lower end on the axis, (0, start), upward with the
/// outside on the right hand, to its upper end on the axis.                                        theory.md (G.3)
class RevolvedShape final : public ContactShape {
 public:
  /// start: height of the lower end [m]. Throws InputError: fewer than two pieces, a point left of the axis or where the one
  /// before is, an upper end off the axis, an arc of too small a radius, a profile that crosses itself or has the outside on its
  /// left.
  RevolvedShape(double start, std::vector<ProfilePiece> pieces);

  [[nodiscard]] DistanceField at(const Eigen::Vector3d& p) const override;
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const override;
  [[nodiscard]] std::vector<Eigen::Matrix3Xd> drawing() const override;
  /// Points along the profile, arcs in `divisions` chords: for drawing.
  [[nodiscard]] std::vector<Eigen::Vector2d> outline(int divisions) const;

 private:
  /// A piece with what is needed again and again.
  struct Piece {
    Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();     // of an arc
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();  // of the chord, unit
    double length = 0.0;                                  // of the chord
    double curvature = 0.0;
  };
  /// The nearest point of the profile.
  struct Near {
    double distance = 0.0;                              // signed
    Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // gradient of the distance in the half plane
    double bending = 0.0;                               // its second derivative across the gradient
  };
  [[nodiscard]] Near nearest(const Eigen::Vector2d& p) const;
  [[nodiscard]] Eigen::Vector2d normal_at(const Piece& piece, const Eigen::Vector2d& p) const;

  std::vector<Piece> pieces_;
  std::vector<Eigen::Vector2d>
      corner_normal_;  // sum of the normals on both sides of the start of every piece, and of the end
};

/// A finite cylinder with sharp rims about z, centred at the origin; radius, length > 0 [m].
[[nodiscard]] std::shared_ptr<const ContactShape> finite_cylinder(double radius, double length);

/// A truncated cone with sharp rims about z, centred at the origin: radii at z = -length/2 and length/2, >= 0 and not both 0 [m]; one
/// of 0 is a full cone.
[[nodiscard]] std::shared_ptr<const ContactShape> truncated_cone(double lower_radius, double upper_radius,
                                                                 double length);

/// The shaft of a grapple fixture with its cam-shaped tip: what the closing wires meet. From z = 0, its foot on the target's
/// plate, a cylinder; then a cone (the cam's underside, behind which the wires cannot slip off), an arc that bulges by
/// `bulge`, and a flat end.
///
/// No dimension is published in the sources at hand; the defaults are assumptions: a shaft as thick as the pin of the published
/// static tests is taken to be, a cam of twice its radius.
struct GrappleShaft {
  double shaft_radius = 6e-3;      ///< [m], > 0
  double shaft_length = 60e-3;     ///< up to where the cam begins [m], > 0
  double cam_radius = 12e-3;       ///< largest [m], > shaft_radius
  double underside_length = 6e-3;  ///< height of the cone under the cam's largest radius [m], >= 0
  double cam_length = 18e-3;       ///< from the largest radius to the flat end [m], > 0
  double end_radius = 4e-3;        ///< of the flat end [m], > 0, < cam_radius
  double bulge = 2e-3;             ///< of the arc over its chord [m], >= 0, at most half the chord
};
[[nodiscard]] std::shared_ptr<const RevolvedShape> grapple_shaft(const GrappleShaft& shaft);

}  // namespace snare::coupling
