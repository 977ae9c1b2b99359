#pragma once

#include "coupling/contact/force_table.hpp"
#include "coupling/contact/law_form.hpp"
#include "coupling/contact/ranged_law.hpp"
#include "numerics/cubic_spline.hpp"
#include "reduction/wire_file.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace snare::reduction {

/// How far a law is from the full wire over its range, at travels that the fit did not see.
struct LawError {
  double largest_force = 0.0, rms_force = 0.0;                          ///< [N]
  double largest_stiffness = 0.0, rms_stiffness = 0.0;                  ///< of dF/dd [N/m]
  double largest_energy = 0.0, rms_energy = 0.0;                        ///< absorbed from first touch [J]
  double force_range = 0.0, stiffness_range = 0.0, energy_range = 0.0;  ///< of the full wire, for the share
  std::size_t points = 0;
};

/// A law with its numbers, their covariance, its range and its error.
struct FittedLaw {
  coupling::LawFormPointer form;
  Eigen::VectorXd values;
  /// sigma^2 (J^T J)^-1, sigma the rms misfit over points less numbers: how firmly the curve holds the
  /// numbers of a form that does not fit it exactly; there is no noise in it.
  Eigen::MatrixXd covariance;
  Interval range;  ///< of the travel [m]
  LawError error;
  bool converged = false;

  /// The law with its range: never negative, linear beyond.
  [[nodiscard]] coupling::RangedLaw ranged() const { return {form->with(values), range.high}; }
  /// Force and stiffness at a travel [m]. Without contact (travel < 0) both are 0. Beyond the range it throws
  /// std::domain_error or continues linearly.
  [[nodiscard]] coupling::LawValue at(double travel, coupling::Outside outside) const;
  [[nodiscard]] double energy(double travel) const;  ///< integral of the force from first touch [J]
};

/// Least squares of a form through points (travel ascending, >= 0) by Levenberg and Marquardt from the best
/// guess. The error is taken at all other travels of `curve`, the full wire's.
/// fit_at: indices of the travels to fit.
[[nodiscard]] FittedLaw fit_law(const coupling::LawFormPointer& form, const numerics::HermiteCurve& curve,
                                const std::vector<std::size_t>& fit_at);

/// Error of a law against the full wire at some of its travels.
[[nodiscard]] LawError error_of(const numerics::HermiteCurve& curve, const std::vector<std::size_t>& at,
                                const FittedLaw& law);

/// The spring of the linear spring-dashpot law against the travel it is used over: k(d) = F/d.       Abiko et
/// al., Fig. 11
struct StiffnessCurve {
  std::vector<double> travel;   ///< > 0 [m]
  std::vector<double> secant;   ///< F/d [N/m]
  std::vector<double> tangent;  ///< dF/dd [N/m]
};
[[nodiscard]] StiffnessCurve stiffness_curve(const numerics::HermiteCurve& curve, int points);

}  // namespace snare::reduction
