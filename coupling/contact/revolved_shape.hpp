#pragma once

#include "coupling/contact/profile.hpp"
#include "coupling/contact/shape.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace snare::coupling {

/// A solid of revolution about the z axis, or one of its pieces.                      theory.md (G.3), (G.11)
///
/// Of the solid the distance is exact on both sides of its surface. A piece is the surface between two
/// concave corners of the
/// profile: outside the solid the distance to that part of it; inside the sign is that of the part's own
/// side, and the least over the pieces has the right one.
class RevolvedShape final : public ContactShape {
 public:
  explicit RevolvedShape(Profile profile);

  [[nodiscard]] DistanceField at(const Eigen::Vector3d& p) const override;
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const override;
  [[nodiscard]] std::vector<std::shared_ptr<const ContactShape>> pieces(double wire_radius) const override;
  [[nodiscard]] bool is_mirrored(const Eigen::Vector3d& n, double offset) const override;
  [[nodiscard]] std::vector<Eigen::Matrix3Xd> drawing() const override;

 private:
  RevolvedShape(std::shared_ptr<const Profile> profile, Profile::Chain chain);
  [[nodiscard]] Profile::Near nearest(const Eigen::Vector2d& p) const;

  std::shared_ptr<const Profile> profile_;
  Profile::Chain chain_;
};

}  // namespace snare::coupling
