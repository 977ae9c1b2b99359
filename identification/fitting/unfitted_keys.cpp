#include "identification/fitting/unfitted_keys.hpp"

#include <algorithm>
#include <iterator>

namespace snare::identification {

namespace {

constexpr const char* in_torsion = "it acts in torsion, which a push in the plane of the wire does not cause";
constexpr const char* of_errors = "it describes errors of the readings: no computed force depends on it";
constexpr const char* of_places =
    "it says where forces are computed: no force at a given travel depends on it";
constexpr const char* of_fit = "it is what the model is fitted to";
constexpr const char* of_method = "it is a setting of the computation, not of the test";

struct Reason {
  std::string_view key;
  const char* why;
};

constexpr Reason reasons[] = {
    {"contact_position_mm", "fit contact_position.shift_mm in its place"},
    {"contact_position_sigma_mm", of_errors},
    {"force_sigma_N", of_errors},
    {"points", of_places},
    {"travel_mm", of_places},
    {"path_mm", of_places},
    {"law.A_N_m2", of_fit},
    {"law.B_N_m", of_fit},
    {"law.C_N", of_fit},
    {"law.R2", of_fit},
    {"law.to_mm", of_places},
    {"wire.poisson_ratio", in_torsion},
    {"wire.torsional_stiffness_Nm2", in_torsion},
    {"wire.strand_extra_stiffness_Nm2", "fit strand_hysteresis.extra_stiffness_Nm2 in its place"},
    {"wire.strand_slip_curvature_1_m", "fit strand_hysteresis.slip_curvature_1_m in its place"},
    {"wire.strand_slip_breadth", "fit strand_hysteresis.slip_breadth in its place"},
    {"wire.yield_stress_MPa", "fit plasticity.yield_stress_MPa in its place"},
    {"wire.hardening_ratio", "fit plasticity.hardening_ratio in its place"},
    {"mount.translational_stiffness_N_m", "fit mount_axial_compliance.compliance_m_N in its place"},
    {"mount.rotational_stiffness_Nm_rad", "fit mount_rotational_compliance.compliance_rad_Nm in its place"},
    {"mount.translational_stiffness_left_N_m", "fit mount_axial_compliance_left.compliance_m_N in its place"},
    {"mount.translational_stiffness_right_N_m",
     "fit mount_axial_compliance_right.compliance_m_N in its place"},
    {"mount.rotational_stiffness_left_Nm_rad",
     "fit mount_rotational_compliance_left.compliance_rad_Nm in its place"},
    {"mount.rotational_stiffness_right_Nm_rad",
     "fit mount_rotational_compliance_right.compliance_rad_Nm in its place"},
    {"mount.slip_tension_N", "fit mount_slip.tension_N in its place"},
    {"pusher.tilt_deg",
     "forces depend on it to second order only: it has no derivative where the pusher stands upright"},
    {"bulge.mode", "it is a whole number that chooses a shape"},
    {"bulge.plane_deg", "an unloaded wire swings into the plane of the push: no force depends on it"},
    {"gravity.vector_m_s2", "fit gravity.along_bulge_m_s2 in its place"},
    {"solver.elements", of_method},
    {"fit.model_tolerance", of_method}};

}  // namespace

std::string why_not_fitted(std::string_view key) {
  if (key.starts_with("series[")) {
    const std::size_t end = key.find("].");
    if (end != std::string_view::npos) key.remove_prefix(end + 2);
  }
  if (const std::size_t element = key.find('['); element != std::string_view::npos)
    key = key.substr(0, element);
  const auto found = std::ranges::find_if(reasons, [key](const Reason& r) { return r.key == key; });
  return found == std::end(reasons) ? "" : found->why;
}

}  // namespace snare::identification
