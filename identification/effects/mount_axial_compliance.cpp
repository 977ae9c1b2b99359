#include "identification/effects/mount_compliance.hpp"

namespace snare::identification {

namespace {

/// Those that are rigid.
std::array<double, 2> rigid_mounts(const PushProblem& p) {
  std::array<double, 2> result{};
  for (const std::size_t k : {0, 1}) {
    result[k] = std::isinf(p.mount.translational_stiffness_of(k)) ? 1.0 : 0.0;
  }
  return result;
}

/// Of each mount along the chord.
Parameter axial_compliance() {
  return {.key = "mount_axial_compliance.compliance_m_N",
          .unit = "m/N",
          .number = {[](const PushProblem& p, const ReadingModel&) {
                       return compliance(p.mount.translational_stiffness);
                     },
                     [](PushProblem& p, ReadingModel&, double v) {
                       set_compliance(p.mount.translational_stiffness, v);
                     }},
          .limits = limits_along_chord,
          .step = 1e-12,
          .mounts_give = rigid_mounts};
}

}  // namespace

/// Both mounts give along the chord like springs.
Effect mount_axial_compliance_effect() {
  return {.name = "mount_axial_compliance",
          .channel = Channel::mount,
          .meaning = "the mounts give way along the wire",
          .numbers = {{axial_compliance(), 0.0, 1e-4}},
          .one_sided = true,
          .sizes = sizes_beside_stretching,
          .unobservable = needs_mounts,
          .independent_check = "put a dial gauge between the mounts and read their approach under tension"};
}

}  // namespace snare::identification
