#pragma once

#include "coupling/contact/law_form.hpp"

#include <vector>

namespace snare::coupling {

/// A spring law with the travels for which it was fitted, from 0 to `end`: never negative, and linear beyond them.  theory.md (R.7)
///   F = max(0, S(d)) for d <= end,   F = max(0, S(end)) + max(0, S'(end)) (d - end) beyond
class RangedLaw final : public SpringLaw {
 public:
  /// end: > 0 [m].
  RangedLaw(SpringLawPointer law, double end);

  double force(double d) const override;
  double stiffness(double d) const override;
  double energy(double d) const override;

  [[nodiscard]] double end() const noexcept { return end_; }                      ///< last travel of the range [m]
  [[nodiscard]] double end_force() const noexcept { return end_force_; }          ///< [N]
  [[nodiscard]] double end_stiffness() const noexcept { return end_stiffness_; }  ///< of the continuation [N/m]

 private:
  /// Travels between which the law is negative [m].
  struct Gap {
    double from, to;
  };

  SpringLawPointer law_;
  double end_;
  double end_force_;
  double end_stiffness_;
  std::vector<Gap> gaps_;
};

}  // namespace snare::coupling
