#pragma once

#include "coupling/contact/law_form.hpp"

#include <vector>

namespace snare::coupling {

/// Travels between which a spring law is negative [m].
struct PullingRange {
  double from = 0.0, to = 0.0;
};

/// A spring law that does not pull.                                                         theory.md (M.28)
///   F = max(0, S(d))
class PressingLaw final : public SpringLaw {
 public:
  /// pulls: all ranges of d > 0 where S is negative.
  PressingLaw(SpringLawPointer law, std::vector<PullingRange> pulls);

  double force(double d) const override;
  double stiffness(double d) const override;
  double curvature(double d) const override;
  double energy(double d) const override;

 private:
  SpringLawPointer law_;
  std::vector<PullingRange> pulls_;
};

/// A spring law with the travels for which it was fitted, from 0 to `end`: never negative, and linear beyond
/// them.
///                                                                                            theory.md (R.7)
///   F = max(0, S(d)) for d <= end,   F = max(0, S(end)) + max(0, S'(end)) (d - end) beyond
class RangedLaw final : public SpringLaw {
 public:
  /// end: > 0 [m].
  RangedLaw(const SpringLawPointer& law, double end);

  double force(double d) const override;
  double stiffness(double d) const override;
  double curvature(double d) const override;
  double energy(double d) const override;

  [[nodiscard]] double end() const noexcept { return end_; }              ///< last travel of the range [m]
  [[nodiscard]] double end_force() const noexcept { return end_force_; }  ///< [N]
  /// Of the continuation [N/m].
  [[nodiscard]] double end_stiffness() const noexcept { return end_stiffness_; }

 private:
  PressingLaw law_;  // within the range
  double end_;
  double end_force_;
  double end_stiffness_;
};

}  // namespace snare::coupling
