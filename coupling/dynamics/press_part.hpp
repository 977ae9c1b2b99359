#pragma once

#include "coupling/contact/contact_law.hpp"
#include "coupling/dynamics/frame_forces.hpp"
#include "coupling/dynamics/result.hpp"

#include <span>

namespace snare::coupling {

/// Forces between frames that press: an event where they begin and end.
class PressPart : public FrameForces {
 public:
  using FrameForces::FrameForces;

  /// DaePart: one event, the zero of `depth`.
  [[nodiscard]] int event_count() const final { return 1; }
  void events(const numerics::DaePoint& at, std::span<double> values) final { values[0] = depth(at.y); }
  /// How deep they press on each other [m]; grows through zero where it begins. y in SI units.
  [[nodiscard]] virtual double depth(const numerics::VectorView& y) const = 0;
  /// Whether the force jumps there, as a dashpot's does: the integration begins anew.
  [[nodiscard]] virtual bool jumps() const = 0;
  /// `force` on the first of those that press on each other. y in SI units.
  [[nodiscard]] virtual ContactSample sample(const numerics::VectorView& y) const = 0;
};

/// Whether a law's force jumps at a touch: at 1e-12 m of depth a rate of one [m/s] more than doubles it.
[[nodiscard]] inline bool jumps_at_touch(const ContactLaw& law) {
  constexpr double shallow = 1e-12, speed = 1.0;  // [m], [m/s]
  return law(shallow, speed).x() > 2.0 * law(shallow, 0.0).x() + 1e-9;
}

}  // namespace snare::coupling
