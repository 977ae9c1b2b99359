#pragma once

#include "coupling/dynamics/body_contact.hpp"
#include "coupling/dynamics/press_part.hpp"

#include <vector>

namespace snare::coupling {

/// Contact of two carriers in a DAE.                                                                    theory.md (M.28)
class BodyContactPart final : public PressPart {
 public:
  /// Frames of the shape and of the points.
  BodyContactPart(const BodyContact& contact, MovingFrame shape, MovingFrame points);

  [[nodiscard]] std::vector<multibody::Wrench> wrenches(const numerics::VectorView& y) const override;
  [[nodiscard]] Power power(const numerics::VectorView& y) const override;
  [[nodiscard]] double depth(const numerics::VectorView& y) const override;
  [[nodiscard]] bool jumps() const override { return jumps_at_touch(contact_.law); }
  [[nodiscard]] ContactSample sample(const numerics::VectorView& y) const override;

 private:
  [[nodiscard]] Eigen::MatrixXd derivatives(const numerics::VectorView& y) const override;

  BodyContact contact_;
};

}  // namespace snare::coupling
