#pragma once

#include <Eigen/Core>

#include <limits>
#include <memory>
#include <vector>

namespace snare::coupling {

/// A signed distance with its derivatives at a point, in the shape's own frame.               theory.md (G.1)
struct DistanceField {
  double distance = 0.0;                              ///< [m], negative inside
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< its gradient: unit, outward
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  ///< of the distance [1/m]
};

/// A rigid surface that a wire can touch, as its signed distance: exact outside, so that |phi(p) - phi(q)| <=
/// |p - q|.
///
/// Outside, phi is once differentiable everywhere but on the shape's outer medial surface, and twice but
/// where the nearest feature changes (face to edge, edge to vertex): there the Hessian jumps between finite
/// values, as the curvature of the surface at the distance of the wire's radius does.         theory.md (G.2)
class ContactShape {
 public:
  ContactShape() = default;
  virtual ~ContactShape() = default;
  ContactShape(const ContactShape&) = delete;
  ContactShape& operator=(const ContactShape&) = delete;
  /// p: a point in the shape's frame [m].
  [[nodiscard]] virtual DistanceField at(const Eigen::Vector3d& p) const = 0;
  /// The distance alone [m].
  [[nodiscard]] virtual double distance(const Eigen::Vector3d& p) const { return at(p).distance; }
  /// Smallest radius of curvature where the surface is convex [m], infinite where it is nowhere: the
  /// Hessian's largest eigenvalue at a distance d outside is at most 1/(d + this). 0 for a shape with edges,
  /// which needs a wire of some radius: on an edge a bare line would have no direction of contact.
  [[nodiscard]] virtual double smallest_radius() const { return 0.0; }
  /// Where phi has a kink outside that a wire of this radius [m] can reach, as in a concave corner: shapes
  /// without, none of which has pieces, that have the least distance in common wherever it is more than the
  /// radius. Empty for any other shape.
  [[nodiscard]] virtual std::vector<std::shared_ptr<const ContactShape>> pieces(
      double /*wire_radius*/) const {
    return {};
  }
  /// Whether it is its own mirror image in the plane n.p = offset [m] of its frame, n unit; false where that
  /// is not known. It needs to be so to round-off alone.
  [[nodiscard]] virtual bool is_mirrored(const Eigen::Vector3d& /*n*/, double /*offset*/) const {
    return false;
  }
  /// Lines that show the shape, in its frame [m]; of an endless one a cut across it.
  [[nodiscard]] virtual std::vector<Eigen::Matrix3Xd> drawing() const = 0;
};

/// The pieces of a shape for a wire of a radius [m], >= 0, or the shape itself. All are in the shape's frame;
/// a wire touches each on its own: in the corner between two it has a gap and a normal to both.
///                                                                                           theory.md (G.10)
[[nodiscard]] std::vector<std::shared_ptr<const ContactShape>> pieces_of(
    const std::shared_ptr<const ContactShape>& shape, double wire_radius = 0.0);

/// A circle about the z axis in `chords` chords, closed [m].
[[nodiscard]] Eigen::Matrix3Xd circle_drawing(double radius, double height, int chords);

/// Whether a plane is across the z axis, or has it in itself, to round-off: what is_mirrored asks of bodies
/// about that axis. Offsets in [m].
[[nodiscard]] bool is_across_axis(const Eigen::Vector3d& n);
[[nodiscard]] bool has_axis(const Eigen::Vector3d& n, double offset);

/// A ball about the origin; radius 0 is a point.
class Ball final : public ContactShape {
 public:
  explicit Ball(double radius) : radius_(radius) {}  ///< [m], >= 0
  [[nodiscard]] DistanceField at(const Eigen::Vector3d& p) const override;
  [[nodiscard]] double smallest_radius() const override { return radius_; }
  [[nodiscard]] bool is_mirrored(const Eigen::Vector3d& n, double offset) const override;
  [[nodiscard]] std::vector<Eigen::Matrix3Xd> drawing() const override;

 private:
  double radius_;
};

/// The half space z < 0 below a plane.
class HalfSpace final : public ContactShape {
 public:
  /// Of the square that is drawn, half its side [m], > 0.
  explicit HalfSpace(double drawn) : drawn_(drawn) {}
  [[nodiscard]] DistanceField at(const Eigen::Vector3d& p) const override;
  [[nodiscard]] double smallest_radius() const override { return std::numeric_limits<double>::infinity(); }
  [[nodiscard]] bool is_mirrored(const Eigen::Vector3d& n, double offset) const override;
  [[nodiscard]] std::vector<Eigen::Matrix3Xd> drawing() const override;

 private:
  double drawn_;
};

/// An endless round cylinder about the z axis; radius 0 is a line (a knife edge that never bends).
class EndlessCylinder final : public ContactShape {
 public:
  explicit EndlessCylinder(double radius) : radius_(radius) {}  ///< [m], >= 0
  [[nodiscard]] DistanceField at(const Eigen::Vector3d& p) const override;
  [[nodiscard]] double smallest_radius() const override { return radius_; }
  [[nodiscard]] bool is_mirrored(const Eigen::Vector3d& n, double offset) const override;
  [[nodiscard]] std::vector<Eigen::Matrix3Xd> drawing() const override;

 private:
  double radius_;
};

/// All points within `radius` of the segment from (0, 0, -length/2) to (0, 0, length/2); radius 0 is a knife
/// edge, a finite line.
class Capsule final : public ContactShape {
 public:
  /// radius >= 0 [m]; length > 0 of the segment, without the round ends [m].
  Capsule(double radius, double length) : radius_(radius), half_length_(0.5 * length) {}
  [[nodiscard]] DistanceField at(const Eigen::Vector3d& p) const override;
  [[nodiscard]] double smallest_radius() const override { return radius_; }
  [[nodiscard]] bool is_mirrored(const Eigen::Vector3d& n, double offset) const override;
  [[nodiscard]] std::vector<Eigen::Matrix3Xd> drawing() const override;

 private:
  double radius_;
  double half_length_;
};

}  // namespace snare::coupling
