#pragma once

#include "coupling/statics/push_problem.hpp"
#include "numerics/cubic_spline.hpp"
#include "numerics/report.hpp"
#include "wire/motion/rod_in_motion.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace snare::reduction {

/// Impacts of which the damping of a law is distilled: a body on a slide along the push meets the full wire.
struct ImpactSettings {
  double mass = 0.0;           ///< of the body [kg], > 0
  std::vector<double> speeds;  ///< of approach [m/s], > 0
  wire::RodDamping damping;    ///< of the full wire
  int elements = 60;           ///< of the full wire, >= 8
};

/// One impact on the full wire, and the dashpot that lets a law lose as much.                theory.md (R.11)
struct ImpactDamping {
  double speed = 0.0;        ///< of approach [m/s]
  double restitution = 0.0;  ///< speed of leaving over that of approach [-]
  double integrator_loss =
      0.0;                  ///< of energy, over that of the impact: to be small beside 1 - restitution^2 [-]
  double peak_force = 0.0;  ///< of the full wire [N]
  double largest_travel = 0.0;  ///< [m]
  double duration = 0.0;        ///< from first touch to the last parting [s]
  /// c of F = L(d) + c d' with the same restitution [N s/m]; empty where the impact goes beyond the law's
  /// range, or does not come back in its time.
  std::optional<double> damping;
  double law_peak_force = 0.0;  ///< of the law with that c [N]
};

/// How a mass leaves a spring-dashpot.
struct LawRebound {
  double restitution = 0.0;     ///< [-]
  double peak_force = 0.0;      ///< [N]
  double largest_travel = 0.0;  ///< [m]
};

/// m d'' = -max(0, L(d) + c d') from d = 0 at the given speed until d = 0 again. Classical Runge-Kutta, some
/// thousand steps. mass > 0 [kg], speed > 0 [m/s], damping >= 0 [N s/m]. Beyond its last knot L continues as
/// there.
[[nodiscard]] LawRebound rebound(const numerics::HermiteCurve& law, double damping, double mass,
                                 double speed);

/// The c [N s/m] of which `rebound` has the restitution asked [-], by bisection to 1e-10 of itself; 0 where
/// no c loses as little.
[[nodiscard]] double damping_of_restitution(const numerics::HermiteCurve& law, double restitution,
                                            double mass, double speed);

/// Simulates the impact at one speed [m/s] and finds the dashpot of it for the law `loading` of the same
/// position. `test`: wire, mounts, pusher and position; its friction acts. The wire must be elastic and
/// naturally straight between rigid clamps or pins. A failure of the integration is in `report`.
[[nodiscard]] ImpactDamping distil_impact(const coupling::PushProblem& test, const ImpactSettings& settings,
                                          double speed, const numerics::HermiteCurve& loading,
                                          numerics::SolveReport& report);

}  // namespace snare::reduction
