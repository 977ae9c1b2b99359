#include "coupling/contact/revolved_shape.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <utility>

namespace snare::coupling {

using Eigen::Vector2d;
using Eigen::Vector3d;

RevolvedShape::RevolvedShape(Profile profile)
    : profile_(std::make_shared<const Profile>(std::move(profile))), chain_(profile_->whole()) {}

RevolvedShape::RevolvedShape(std::shared_ptr<const Profile> profile, Profile::Chain chain)
    : profile_(std::move(profile)), chain_(chain) {}

std::vector<std::shared_ptr<const ContactShape>> RevolvedShape::pieces(double wire_radius) const {
  std::vector<std::shared_ptr<const ContactShape>> pieces;
  const int whole = profile_->whole().count;
  if (chain_.count < whole) return pieces;
  const std::vector<Profile::Chain> chains = profile_->chains(wire_radius);
  if (chains.front().count == whole) return pieces;
  for (const Profile::Chain& chain : chains)
    pieces.push_back(std::shared_ptr<const ContactShape>(new RevolvedShape(profile_, chain)));
  return pieces;
}

// The cut along two planes through the axis, and the circles of the corners.
std::vector<Eigen::Matrix3Xd> RevolvedShape::drawing() const {
  constexpr int arc_chords = 8;
  constexpr int circle_chords = 36;
  const std::vector<Vector2d> outline = profile_->outline(chain_, arc_chords);
  std::vector<Eigen::Matrix3Xd> lines;
  for (const int plane : {0, 1}) {
    for (const double side : {1.0, -1.0}) {
      Eigen::Matrix3Xd line = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(outline.size()));
      for (Eigen::Index k = 0; k < line.cols(); ++k) {
        line(plane, k) = side * outline[static_cast<std::size_t>(k)].x();
        line(2, k) = outline[static_cast<std::size_t>(k)].y();
      }
      lines.push_back(std::move(line));
    }
  }
  for (const Vector2d& corner : profile_->outline(chain_, 1)) {
    if (corner.x() > 0.0) lines.push_back(circle_drawing(corner.x(), corner.y(), circle_chords));
  }
  return lines;
}

Profile::Near RevolvedShape::nearest(const Vector2d& p) const {
  Profile::Near near = profile_->nearest(p, chain_);
  // Behind a piece may be the outside again, beyond another: there the distance is that to the piece's back.
  if (near.distance < 0.0 && chain_.count < profile_->whole().count &&
      profile_->nearest(p, profile_->whole()).distance > 0.0)
    near = {-near.distance, -near.normal, -near.bending};
  return near;
}

double RevolvedShape::distance(const Vector3d& p) const {
  return nearest({std::hypot(p.x(), p.y()), p.z()}).distance;
}

// phi(x, y, z) = d(rho, z): the Hessian is that of d in the plane through the axis, and d_rho/rho along the
// parallel circle.
DistanceField RevolvedShape::at(const Vector3d& p) const {
  const double rho = std::hypot(p.x(), p.y());
  const Profile::Near near = nearest({rho, p.z()});
  const Vector3d out = rho > 0.0 ? Vector3d(p.x() / rho, p.y() / rho, 0.0) : Vector3d::UnitX();
  const Vector3d around = Vector3d::UnitZ().cross(out);
  const Vector3d tangent = -near.normal.y() * out + near.normal.x() * Vector3d::UnitZ();
  DistanceField field;
  field.distance = near.distance;
  field.normal = near.normal.x() * out + near.normal.y() * Vector3d::UnitZ();
  // On the axis d_rho vanishes where phi is smooth, and d_rho/rho becomes d_rho_rho; beside it the quotient
  // is round-off.
  constexpr double close = 1e-6;  // d_rho/rho - d_rho_rho is of second order in rho
  const bool on_axis =
      rho * std::abs(near.bending) < close && std::abs(near.normal.x()) < close && rho < close;
  const double hoop = on_axis     ? near.bending * near.normal.y() * near.normal.y()
                      : rho > 0.0 ? near.normal.x() / rho
                                  : 0.0;
  field.hessian = near.bending * tangent * tangent.transpose() + hoop * around * around.transpose();
  return field;
}

bool RevolvedShape::is_mirrored(const Eigen::Vector3d& n, double offset) const {
  return has_axis(n, offset);
}

}  // namespace snare::coupling
