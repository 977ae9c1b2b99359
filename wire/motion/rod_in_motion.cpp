#include "wire/motion/rod_in_motion.hpp"

namespace snare::wire {

RodInMotion rod_in_motion(const WireSpecification& wire, double span, int elements) {
  RodInMotion rod;
  rod.properties.bending_stiffness = rod.properties.second_bending_stiffness = wire.bending_stiffness();
  rod.properties.torsional_stiffness = wire.torsional_stiffness();
  rod.properties.axial_stiffness = wire.axial_stiffness();
  rod.properties.right.position = {span, 0.0, 0.0};
  rod.mass_per_length = wire.mass_per_length();
  if (wire.strand_friction) {
    rod.strands.extra_stiffness = wire.strand_friction->extra_stiffness;
    rod.strands.slip_curvature = wire.strand_friction->slip_curvature;
  }
  rod.length = wire.length;
  rod.elements = elements;
  return rod;
}

}  // namespace snare::wire
