#pragma once

#include "multibody/arm/arm_run.hpp"

#include <Eigen/Core>

namespace snare::validation {

/// A uniform link of the plane.
struct PlanarLink {
  double mass = 10.0;    ///< [kg]
  double length = 1.0;   ///< to the next joint [m]
  double centre = 0.5;   ///< of mass, from its joint [m]
  double inertia = 0.9;  ///< about the centre of mass [kg m^2]
};

/// The double pendulum in the plane as textbooks write it (relative angles): H(q) and the velocity terms c(q,
/// q'). Shares nothing with the recursions of multibody/.
[[nodiscard]] Eigen::Matrix2d planar_mass(const PlanarLink& first, const PlanarLink& second, double q2);
[[nodiscard]] Eigen::Vector2d planar_bias(const PlanarLink& first, const PlanarLink& second, double q2,
                                          const Eigen::Vector2d& rate);

/// The same two links as an elastic arm about z, both joints with the same motor inertia [kg m^2] and spring.
[[nodiscard]] multibody::ElasticArm planar_arm(const PlanarLink& first, const PlanarLink& second,
                                               double motor_inertia, const multibody::DeflectionLaw& law);

/// One link with the given moment of inertia about its joint [kg m^2].
[[nodiscard]] multibody::ElasticArm one_joint_arm(double link_inertia, double motor_inertia,
                                                  const multibody::DeflectionLaw& law);

/// `arm` at rest in its zero pose, all drives alike, both tolerances the same [-]. end [s].
[[nodiscard]] multibody::ArmScenario at_rest(const multibody::ElasticArm& arm, const multibody::Drive& drive,
                                             double end, double tolerance);

/// Table 2 of Abiko et al. with the constants as printed; damping times a factor [-]. jump_width [rad].
[[nodiscard]] multibody::DeflectionLaw table2_law(double damping_factor, multibody::StiffnessReading reading,
                                                  double jump_width = 0.0);

/// Torque [N m] and damping [N m s/deg] of Table 2 at a deflection in degrees, written down once more.
/// literal: K times the deflection; else the slope.
[[nodiscard]] double table2_torque(double degrees, bool literal);
[[nodiscard]] double table2_damping(double degrees);

/// One swing of an inertia on Table 2.
struct PlainSwing {
  double begin = 0.0, end = 0.0, peak = 0.0;  ///< [s], [s], [deg]
};
struct PlainRun {
  std::vector<PlainSwing> swings;
  int passages = 0;  ///< of 0.04 and 0.06 deg, either way
};
/// An inertia [kg m^2] let go at `start` [deg] on Table 2, by Runge and Kutta with 2e-5 s.
[[nodiscard]] PlainRun swing_on_table2(double inertia, double start, double end, bool literal);

/// Integral by Gauss and Legendre's five points on each of n intervals; f and its argument of any unit.
template <class Function>
double integral(const Function& f, double from, double to, int n) {
  constexpr double node[] = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr double weight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double half = 0.5 * (to - from) / n;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double middle = from + (2 * i + 1) * half;
    sum += weight[0] * f(middle);
    for (int k = 1; k < 3; ++k) sum += weight[k] * (f(middle - half * node[k]) + f(middle + half * node[k]));
  }
  return half * sum;
}

}  // namespace snare::validation
