#pragma once

#include "coupling/contact/law_form.hpp"

#include <Eigen/Core>

#include <functional>
#include <utility>

namespace snare::coupling {

/// What damping adds to a spring at penetration d > 0: (D, dD/dd, dD/dd'), with D d' >= 0.
/// Forces in N, derivatives in N/m and N s/m; its arguments are penetration [m] and rate [m/s].
using Damping = std::function<Eigen::Vector3d(double penetration, double rate)>;

/// A contact force as a function of penetration d [m] and its rate d' [m/s]:                theory.md (M.28)
///
///   F = max(0, S+(d) + D(d, d')) for d > 0, else 0;   S+ = max(0, S)
/// S is a spring of law_form.hpp, D its damping. The force never pulls. The spring stores the integral of S+;
/// the rest of the power, (F - S+) d', is lost and never negative: d' D >= 0, and where F is cut off, S+ + D
/// < 0, so that d' < 0.
class ContactLaw {
 public:
  ContactLaw() = default;
  /// The spring must not pull at any d > 0. No damping when empty.
  explicit ContactLaw(SpringLawPointer spring, Damping damping = {})
      : spring_(std::move(spring)), damping_(std::move(damping)) {}

  /// Whether there is a law.
  explicit operator bool() const { return spring_ != nullptr; }
  /// (F, dF/dd, dF/dd') [N, N/m, N s/m].
  [[nodiscard]] Eigen::Vector3d operator()(double penetration, double rate) const;
  /// The spring's force and its derivatives (S+, dS+/dd, d2S+/dd2) [N, N/m, N/m^2]; zero without penetration.
  [[nodiscard]] Eigen::Vector3d elastic(double penetration) const;
  /// What the spring stores [J].
  [[nodiscard]] double energy(double penetration) const {
    return penetration > 0.0 ? spring_->energy(penetration) : 0.0;
  }

 private:
  SpringLawPointer spring_;
  Damping damping_;
};

/// D = c d'.                                                            c >= 0 [N s/m]
[[nodiscard]] Damping linear_damping(double c);
/// D = c d^n |d'|^q sgn d'. n = 0 (a force jump at the touch) or n >= 1; q >= 1; c >= 0 [N s^q/m^(n+q)].
[[nodiscard]] Damping power_damping(double c, double q, double n);
/// D = c G(d) d', G the cubic step from 0 at d = 0 to 1 at d = depth.  c >= 0 [N s/m], depth > 0 [m].
[[nodiscard]] Damping step_damping(double c, double depth);

// Each of the following is the law of the same name in law_form.hpp with these numbers.

/// F = k d + c d'.                                                      theory.md (L.1); Abiko et al., eq. 4
/// k >= 0 [N/m], c >= 0 [N s/m].
[[nodiscard]] ContactLaw spring_dashpot(double k, double c);

/// F = k d^p + c d^p |d'|^q sgn d'.                                     theory.md (L.2); Abiko et al., eq. 3,
/// G(d) = d^p q = 1: Hunt and Crossley 1975. k >= 0 [N/m^p], p >= 1, c >= 0 [N s^q/m^(p+q)], q >= 1.
[[nodiscard]] ContactLaw power_law(double k, double p, double c, double q);

/// The same with another depth in the damping: F = k d^p + c d^n |d'|^q sgn d'. n = 0 or n >= 1. Units as
/// above.
[[nodiscard]] ContactLaw power_law(double k, double p, double c, double q, double n);

/// F = k d^p + c G(d) d', G the cubic step from 0 at d = 0 to 1 at d = depth.  theory.md (L.2); Abiko et al.,
/// eq. 3 The form of ADAMS' IMPACT. k >= 0 [N/m^p], p >= 1, c >= 0 [N s/m], depth > 0 [m].
[[nodiscard]] ContactLaw step_damped_law(double k, double p, double c, double depth);

/// F = A d^2 + B d + C, zero where this is negative.                    theory.md (L.3); Abiko et al., Table
/// 4
/// a: A [N/m^2], b: B [N/m], c: C [N].
[[nodiscard]] ContactLaw quadratic_law(double a, double b, double c);

/// Stretched wire, pushed at its middle from where it is taut:          theory.md (L.4); Honda et al. 2014,
/// eq. 1
///   F = 2 K (1 - l/sqrt(l^2 + 2 h d + d^2)) (h + d),  h = sqrt(l^2 - L^2)
/// which is (R.8) at mid-span with the axial stiffness K l and no free travel.
/// K: stiffness of one half [N/m], > 0; l: half its length, L: half the distance of its ends [m], l >= L > 0.
[[nodiscard]] ContactLaw stretched_wire_law(double stiffness, double half_length, double half_span,
                                            Damping damping = {});

/// Its tangent at d = 0: F = 2 K (l^2 - L^2)/l^2 d [N], arguments as above.    Honda et al. 2014, eq. 2
[[nodiscard]] ContactLaw stretched_wire_tangent(double stiffness, double half_length, double half_span,
                                                Damping damping = {});

}  // namespace snare::coupling
