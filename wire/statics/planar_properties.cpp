#include "wire/statics/planar_properties.hpp"

#include <numbers>

namespace snare::wire {

namespace {

PlanarEnd planar_end(const MountSpecification& mount, SlipPlace place) {
  PlanarEnd end;
  switch (mount.kind) {
    case MountKind::clamped:
      end.kind = PlanarEnd::Kind::clamp;
      break;
    case MountKind::pinned:
      end.kind = PlanarEnd::Kind::pin;
      break;
    case MountKind::supports:
      end.kind = PlanarEnd::Kind::free;
      break;
  }
  end.position = {place == SlipPlace::left ? 0.0 : mount.span, 0.0};
  const std::size_t which = place == SlipPlace::left ? 0 : 1;
  end.rotational_stiffness = mount.rotational_stiffness_of(which);
  end.translational_stiffness = mount.translational_stiffness_of(which);
  // A mount that slides is no spring of the wire: what holds it is an unknown force (theory.md, C.8).
  const bool here = mount.slip_at == SlipPlace::both || mount.slip_at == place;
  if (mount.slip_tension && mount.slip == MountSlip::slides && here) end.translational_stiffness = 0.0;
  return end;
}

}  // namespace

PlanarRodProperties planar_rod_properties(const WireSpecification& wire, const MountSpecification& mount,
                                          const Eigen::Vector2d& gravity) {
  PlanarRodProperties properties;
  properties.bending_stiffness = wire.bending_stiffness();
  properties.axial_stiffness = wire.axial_stiffness();
  // The bulge goes to +y, where a wire running along +x turns right at its top.
  properties.natural_curvature = -wire.natural_curvature;
  properties.weight = wire.mass_per_length() * gravity;
  properties.left = planar_end(mount, SlipPlace::left);
  properties.right = planar_end(mount, SlipPlace::right);
  properties.bending_profile = wire.bending_profile;
  if (wire.yielding) {
    const double hardening = wire.yielding->hardening_ratio;
    // The moduli that give the stiffnesses: E of a solid wire, less for a strand.
    const double area = 0.25 * std::numbers::pi * wire.diameter * wire.diameter;
    const double second_moment = area * wire.diameter * wire.diameter / 16.0;
    const double stress = wire.yielding->yield_stress;
    properties.bending_sliders =
        yielding_section(properties.bending_stiffness, wire.diameter,
                         stress * second_moment / properties.bending_stiffness, hardening);
    properties.axial_sliders = {
        {(1.0 - hardening) * properties.axial_stiffness, stress * area / properties.axial_stiffness}};
    properties.bending_stiffness *= hardening;
    properties.axial_stiffness *= hardening;
  }
  if (wire.strand_friction) {
    const std::vector<SliderElement> strands = strand_sliders(*wire.strand_friction);
    properties.bending_sliders.insert(properties.bending_sliders.end(), strands.begin(), strands.end());
  }
  return properties;
}

}  // namespace snare::wire
