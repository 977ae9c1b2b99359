#include "coupling/dynamics/model/start.hpp"

#include "base/errors.hpp"
#include "wire/motion/rod_rest.hpp"
#include "wire/statics/loose_wire.hpp"

namespace snare::coupling {

using Eigen::Vector3d;

Eigen::Matrix3Xd straight_wire(const wire::RodInMotion& rod, const Vector3d& from, const Vector3d& to) {
  const wire::MaterialMesh mesh = rod.mesh();
  const wire::Controls controls = rod.controls();
  Eigen::Matrix3Xd x(3, mesh.vertices());
  for (int i = 0; i < mesh.vertices(); ++i)
    x.col(i) = from + mesh.coordinate(i, controls) / rod.length * (to - from);
  return x;
}

Eigen::Matrix3Xd resting_wire(const wire::RodInMotion& rod) {
  const Vector3d from = rod.properties.left.position;
  const Vector3d to = rod.properties.right.position;
  const Vector3d along = (to - from).normalized();
  const double span = (to - from).norm();
  // A wire that is pulled straight stretches its mounts as well.
  if (rod.length <= span) {
    const double left = 1.0 / rod.properties.left.translational_stiffness;
    const double right = 1.0 / rod.properties.right.translational_stiffness;
    const double tension = (span - rod.length) / (rod.length / rod.properties.axial_stiffness + left + right);
    return straight_wire(rod, from + tension * left * along, to - tension * right * along);
  }
  wire::PlanarRodProperties plane;
  plane.bending_stiffness = rod.properties.bending_stiffness;
  plane.axial_stiffness = rod.properties.axial_stiffness;
  const auto in_plane = [](const wire::SpatialEnd& end) {
    using Kind = wire::SpatialEnd::Kind;
    const bool turns = end.kind == Kind::pin || end.kind == Kind::twisting_pin;
    return turns ? wire::PlanarEnd::Kind::pin : wire::PlanarEnd::Kind::clamp;
  };
  plane.left.kind = in_plane(rod.properties.left);
  plane.right.kind = in_plane(rod.properties.right);
  for (auto [planar, spatial] :
       {std::pair{&plane.left, &rod.properties.left}, std::pair{&plane.right, &rod.properties.right}}) {
    planar->rotational_stiffness = spatial->rotational_stiffness;
    planar->translational_stiffness = spatial->translational_stiffness;
  }
  plane.right.position = {span, 0.0};
  const wire::PlanarRod planar(rod.mesh(), plane);
  const wire::Controls controls = rod.controls();
  const wire::LooseWire loose = wire::find_loose_wire(planar, controls, 1);
  if (!loose.report.usable()) throw base::InputError({"", 0, "wire", "", loose.report.message});
  Vector3d up = Vector3d::UnitY() - along.y() * along;
  if (up.norm() < 1e-6) up = Vector3d::UnitX() - along.x() * along;
  up.normalize();
  Eigen::Matrix3Xd x(3, rod.elements + 1);
  for (int i = 0; i <= rod.elements; ++i) {
    const Eigen::Vector2d p = wire::vertex(loose.state, i);
    x.col(i) = from + p.x() * along + p.y() * up;
  }
  if (rod.formulation == wire::Formulation::vertices) return x;
  // From there to the equilibrium of the rod of higher order, in its plane.
  const wire::RodRest rest = wire::find_rest(rod, x);
  if (!rest.report.usable()) throw base::InputError({"", 0, "wire", "", rest.report.message});
  return rest.positions;
}

}  // namespace snare::coupling
