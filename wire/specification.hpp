#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace snare::wire {

enum class Construction { solid, strand };

/// Friction between the strands of a rope in bending: beside EI, the bending stiffness with slipping strands,
/// a stiffness that acts until the curvature has changed by slip_curvature and slides then; or whose shares
/// slide one after the other, the logarithms of their curvatures evenly spread over 2 breadth.
///                                                                                           theory.md (W.13)
struct StrandFriction {
  double extra_stiffness = 0.0;  ///< of all while they stick [N m^2], > 0
  double slip_curvature = 0.0;   ///< the middle one, in logarithms [1/m], > 0
  double breadth = 0.0;  ///< from slip_curvature exp(-breadth) to slip_curvature exp(breadth) [-], >= 0
};

/// Metal that yields: elastic up to the yield stress, then with hardening_ratio of the stiffness; fibre by
/// fibre in bending, all at once in tension, the two without regard to each other; strains are stresses over
/// the moduli that give EI and EA with the round section.                                    theory.md (W.13)
struct Yielding {
  double yield_stress = 0.0;                       ///< [Pa], > 0
  double hardening_ratio = usual_hardening;        ///< tangent over elastic modulus beyond it, in (0, 1)
  static constexpr double usual_hardening = 0.02;  ///< cold-drawn wire: 1 to 4 % (assumed)
};

/// A uniform round wire as it is declared. SI units.
struct WireSpecification {
  Construction construction = Construction::solid;
  double diameter = 0.0;                               ///< outer diameter [m], > 0
  double length = 0.0;                                 ///< unstretched length between the mounts [m], > 0
  double youngs_modulus = 0.0;                         ///< [Pa], > 0
  double poisson_ratio = 0.3;                          ///< [-], in (-1, 0.5]
  double density = 0.0;                                ///< of the metal [kg/m^3], > 0
  std::optional<double> bending_stiffness_override;    ///< EI [N m^2], > 0
  std::optional<double> axial_stiffness_override;      ///< EA [N], > 0
  std::optional<double> torsional_stiffness_override;  ///< GJ [N m^2], > 0
  double natural_curvature = 0.0;  ///< in the plane of the bulge, positive with the bulge [1/m]
  std::optional<StrandFriction> strand_friction;
  std::optional<Yielding> yielding;
  /// Factor of EI at stations evenly spread over the wire between the mounts, each > 0; empty: uniform.
  std::vector<double> bending_profile;

  /// EI [N m^2]: as declared, else of the solid round section, E pi d^4 / 64.
  [[nodiscard]] double bending_stiffness() const;
  /// EA [N]: as declared, else of the solid round section, E pi d^2 / 4.
  [[nodiscard]] double axial_stiffness() const;
  /// GJ [N m^2]: as declared, else 2 EI G / E with G = E / (2 (1 + nu)), that is EI / (1 + nu).
  [[nodiscard]] double torsional_stiffness() const;
  /// Mass per unit length of the solid round section, rho pi d^2 / 4 [kg/m].
  [[nodiscard]] double mass_per_length() const;
};

/// How both ends are held.
enum class MountKind {
  clamped,  ///< position and direction held
  pinned,   ///< position held, free to turn
  supports  ///< the wire rests on two round supports and slides over them (three-point bending)
};

/// What gives way where a mount slips.
enum class MountSlip {
  feeds,  ///< the wire feeds through the mount, which stands still
  slides  ///< the mount slides along the chord, the wire fast in it
};
/// Which mounts slip; of both each by itself.
enum class SlipPlace { left, right, both };

/// The two mounts; the chord runs along +x from the left mount at the origin, the bulge towards +y.
struct MountSpecification {
  MountKind kind = MountKind::clamped;
  double span = 0.0;            ///< distance of the mounts (or of the supports' centres) [m], > 0
  double support_radius = 0.0;  ///< supports only [m], >= 0
  std::optional<double> translational_stiffness;  ///< each mount, along the chord [N/m]; rigid when absent
  std::optional<double> rotational_stiffness;     ///< each clamp, all axes [N m/rad]; rigid when absent
  /// Of the left and the right mount by itself, in series with the stiffness of both [m/N], [rad/(N m)].
  std::array<double, 2> own_translational_compliance{}, own_rotational_compliance{};
  std::optional<double> slip_tension;  ///< force on a mount beyond which it slips [N], > 0: theory.md (C.8)
  MountSlip slip = MountSlip::feeds;
  SlipPlace slip_at = SlipPlace::left;

  /// What holds the left (0) or the right (1) mount along the chord [N/m]; infinite where it is rigid.
  [[nodiscard]] double translational_stiffness_of(std::size_t mount) const {
    return in_series(translational_stiffness, own_translational_compliance[mount]);
  }
  /// What holds the direction of its clamp [N m/rad], likewise.
  [[nodiscard]] double rotational_stiffness_of(std::size_t mount) const {
    return in_series(rotational_stiffness, own_rotational_compliance[mount]);
  }

 private:
  static double in_series(const std::optional<double>& each, double own) {
    // 1e-11 m/N moves a mount by 10 nm under 1 kN: rigid, and a stiffer spring would only spoil the
    // equations.
    const bool rigid = own < 1e-11 && own > -1e-11;
    if (rigid) return each.value_or(std::numeric_limits<double>::infinity());
    return 1.0 / (own + (each ? 1.0 / *each : 0.0));
  }
};

}  // namespace snare::wire
