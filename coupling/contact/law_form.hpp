#pragma once

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace snare::coupling {

/// The wire that a law stands for, at one place.
struct LawPlace {
  double span = 0.0;               ///< [m]
  double position = 0.0;           ///< s [m]
  double length = 0.0;             ///< unstretched, between the mounts [m]
  double bending_stiffness = 0.0;  ///< EI [N m^2]
};

/// One of the numbers of a law form, as law.json names it.
struct LawParameter {
  std::string name;
  std::string unit;  ///< SI; empty for a pure number
};

/// A contact force F of the travel alone, its numbers given: what a form becomes with numbers, and what a law
/// of a motion (contact_law.hpp) adds its damping to. Travel d >= 0 from first touch [m]; without contact (d
/// < 0) the force is none and these functions are not asked.
class SpringLaw {
 public:
  virtual ~SpringLaw() = default;
  SpringLaw(const SpringLaw&) = delete;
  SpringLaw& operator=(const SpringLaw&) = delete;

  [[nodiscard]] virtual double force(double d) const = 0;      ///< F [N]
  [[nodiscard]] virtual double stiffness(double d) const = 0;  ///< dF/dd [N/m]
  [[nodiscard]] virtual double curvature(double d) const = 0;  ///< d2F/dd2 [N/m^2]
  [[nodiscard]] virtual double energy(double d) const = 0;     ///< integral of F from 0 [J]

 protected:
  SpringLaw() = default;
};

using SpringLawPointer = std::shared_ptr<const SpringLaw>;

/// One way to write force against travel with a few numbers p, which can be fitted.
class LawForm {
 public:
  virtual ~LawForm() = default;
  LawForm(const LawForm&) = delete;
  LawForm& operator=(const LawForm&) = delete;

  [[nodiscard]] virtual std::string name() const = 0;     ///< as in law.json
  [[nodiscard]] virtual std::string formula() const = 0;  ///< for people
  [[nodiscard]] virtual std::vector<LawParameter> parameters() const = 0;
  /// Body of a function `double force(double d)` with the numbers written in, in the language that C, C++ and
  /// Python share but for a prefix of the mathematical functions ("" in C, "std::" in C++, "math." in
  /// Python); all in SI units.
  [[nodiscard]] virtual std::string expression(const Eigen::VectorXd& p, const std::string& prefix) const = 0;

  /// The law with these numbers, in the units of `parameters`; all that depends on them alone is done here,
  /// for many evaluations.
  [[nodiscard]] virtual SpringLawPointer with(const Eigen::VectorXd& p) const = 0;
  /// The law's force [N], stiffness [N/m] and energy [J] at a travel d >= 0 [m], with the numbers p. For one
  /// evaluation; for many: `with`.
  [[nodiscard]] virtual double force(const Eigen::VectorXd& p, double d) const { return with(p)->force(d); }
  [[nodiscard]] double stiffness(const Eigen::VectorXd& p, double d) const { return with(p)->stiffness(d); }
  [[nodiscard]] double energy(const Eigen::VectorXd& p, double d) const { return with(p)->energy(d); }
  /// dF/dp at d >= 0 [m], (numbers): N over the unit of each number.
  [[nodiscard]] virtual Eigen::VectorXd by_parameters(const Eigen::VectorXd& p, double d) const = 0;

  /// Where a least-squares search may begin, several guesses; the best of them is used. force_scale [N] and
  /// travel_scale [m]: largest force and travel of the points.
  [[nodiscard]] virtual std::vector<Eigen::VectorXd> guesses(double force_scale,
                                                             double travel_scale) const = 0;
  /// Whether numbers, in their units, make sense (a positive power); a search does not leave them.
  [[nodiscard]] virtual bool admissible(const Eigen::VectorXd& /*p*/) const { return true; }

 protected:
  LawForm() = default;
};

using LawFormPointer = std::shared_ptr<const LawForm>;

/// F = A d^2 + B d + C, and without C.                       Abiko et al., Table 4; theory.md (R.7)
[[nodiscard]] LawFormPointer quadratic_law();
[[nodiscard]] LawFormPointer quadratic_through_origin();
/// F = k d, the spring of the spring-dashpot law.             Abiko et al., eq. 4
[[nodiscard]] LawFormPointer linear_law();
/// F = k d^p, p >= 1.                                         Abiko et al., eq. 3 (Gilardi and Sharf 2002)
[[nodiscard]] LawFormPointer power_law();
/// Two straight pieces of an elastic wire, taut after a free travel d0; at mid-span Honda et al., eq. 1.
///   F = K (l1 + l2 - L)/L (y/l1 + y/l2),  y = q + d - d0,  q the height at which the wire is just taut
///                                                                                                      (R.8)
[[nodiscard]] LawFormPointer stretched_wire_law(const LawPlace& place);
/// Its tangent where the wire becomes taut; at mid-span Honda et al., eq. 2.
[[nodiscard]] LawFormPointer stretched_wire_linearised(const LawPlace& place);
/// F = k(EI, T, s) d, T fitted, EI the wire's.                Uyama et al. 2011; theory.md (R.6)
[[nodiscard]] LawFormPointer tensioned_wire_law(const LawPlace& place);

/// All of them.
[[nodiscard]] std::vector<LawFormPointer> law_forms(const LawPlace& place);

}  // namespace snare::coupling
