// Shapes of wires at the start of a motion.

#include "coupling/dynamics/motion.hpp"
#include "base/errors.hpp"
#include "wire/loose_wire.hpp"

namespace snare::coupling {

using Eigen::Vector3d;

wire::RodInMotion rod_in_motion(const wire::WireSpecification& specification, double span, int elements) {
  wire::RodInMotion rod;
  rod.properties.bending_stiffness = rod.properties.second_bending_stiffness = specification.bending_stiffness();
  rod.properties.torsional_stiffness = specification.torsional_stiffness();
  rod.properties.axial_stiffness = specification.axial_stiffness();
  rod.properties.right.position = {span, 0.0, 0.0};
  rod.mass_per_length = specification.mass_per_length();
  if (specification.strand_friction) {
    rod.strands.extra_stiffness = specification.strand_friction->extra_stiffness;
    rod.strands.slip_curvature = specification.strand_friction->slip_curvature;
  }
  rod.length = specification.length;
  rod.elements = elements;
  return rod;
}

Eigen::Matrix3Xd straight_wire(const wire::RodInMotion& rod, const Vector3d& from, const Vector3d& to) {
  const wire::MaterialMesh mesh(rod.elements / 2, rod.elements - rod.elements / 2, rod.grading);
  const wire::Controls controls{0.0, rod.length * (rod.elements / 2) / rod.elements, rod.length};
  Eigen::Matrix3Xd x(3, mesh.vertices());
  for (int i = 0; i < mesh.vertices(); ++i)
    x.col(i) = from + mesh.coordinate(i, controls) / rod.length * (to - from);
  return x;
}

Eigen::Matrix3Xd resting_wire(const wire::RodInMotion& rod) {
  const Vector3d from = rod.properties.left.position;
  const Vector3d to = rod.properties.right.position;
  if (rod.length <= (to - from).norm()) return straight_wire(rod, from, to);
  wire::PlanarRodProperties plane;
  plane.bending_stiffness = rod.properties.bending_stiffness;
  plane.axial_stiffness = rod.properties.axial_stiffness;
  plane.right.position = {(to - from).norm(), 0.0};
  const wire::PlanarRod planar(wire::MaterialMesh(rod.elements / 2, rod.elements - rod.elements / 2, rod.grading), plane);
  const wire::Controls controls{0.0, rod.length * (rod.elements / 2) / rod.elements, rod.length};
  const wire::LooseWire loose = wire::find_loose_wire(planar, controls, 1);
  if (!loose.report.usable()) throw base::InputError({"", 0, "wire", "", loose.report.message});
  const Vector3d along = (to - from).normalized();
  Vector3d up = Vector3d::UnitY() - along.y() * along;
  if (up.norm() < 1e-6) up = Vector3d::UnitX() - along.x() * along;
  up.normalize();
  Eigen::Matrix3Xd x(3, rod.elements + 1);
  for (int i = 0; i <= rod.elements; ++i) {
    const Eigen::Vector2d p = wire::vertex(loose.state, i);
    x.col(i) = from + p.x() * along + p.y() * up;
  }
  return x;
}

}  // namespace snare::coupling
