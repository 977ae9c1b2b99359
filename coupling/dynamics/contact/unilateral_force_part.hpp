#pragma once

#include "coupling/contact/contact_law.hpp"
#include "coupling/dynamics/contact/interaction.hpp"
#include "coupling/dynamics/joints/frame_forces.hpp"
#include "coupling/dynamics/model/result.hpp"

#include <span>

namespace snare::coupling {

/// Forces between frames that press: an event where they begin and end.
class UnilateralForcePart : public FrameForces, public Interaction {
 public:
  using FrameForces::FrameForces;

  /// DaePart: one event, the zero of `depth`.
  [[nodiscard]] int event_count() const final { return 1; }
  void events(const numerics::DaePoint& at, std::span<double> values) final { values[0] = touches(at.y); }
  /// How deep they press on each other [m]; grows through zero where it begins. y in SI units.
  [[nodiscard]] virtual double depth(const numerics::VectorView& y) const = 0;
  /// A number with the sign of the depth [m].
  [[nodiscard]] virtual double touches(const numerics::VectorView& y) const { return depth(y); }
  /// What can be said of it at one place, from y in SI units.
  struct Pressing {
    /// But for the gap; its force is that on the first of those that press on each other.
    ContactSample sample;
    Work work;
    double tension = 0.0;  ///< of a wire [N]
  };
  /// At unknowns y in SI units.
  [[nodiscard]] virtual Pressing pressing(const numerics::VectorView& y) const = 0;
  [[nodiscard]] Work work(const numerics::VectorView& y) const final { return pressing(y).work; }

  void append(std::vector<numerics::DaePart*>& parts) final { parts.push_back(this); }
  [[nodiscard]] double energy(const numerics::DaePoint& at) const final { return work(at.y).power.energy; }
  [[nodiscard]] double law_loss(const numerics::DaePoint& at) const final { return work(at.y).power.lost; }
  void add_rates(const numerics::DaePoint& at, const IntegralRates& rates) const final {
    const auto [s, work, tension] = pressing(at.y);
    Eigen::Ref<Eigen::VectorXd> all = rates.all;
    all.segment<3>(rates.force) = s.force;
    all[rates.normal] = s.normal_force;
    all[integral::laws] += work.power.lost;
    rates.constraints.add_forces(*this, work.wrenches, at, rates.held);
  }
  [[nodiscard]] Load load(const numerics::DaePoint& at) const final {
    const ContactSample s = pressing(at.y).sample;
    return {s.force, s.normal_force};
  }
  [[nodiscard]] ContactSample sample(const numerics::DaePoint& at) const final {
    ContactSample s = pressing(at.y).sample;
    s.gap = -depth(at.y);
    return s;
  }
  [[nodiscard]] Observed observe(const numerics::DaePoint& now, double /*time_before*/,
                                 const Eigen::VectorXd& /*before*/) final {
    const Pressing p = pressing(now.y);
    return {.normal = p.sample.normal_force, .tension = p.tension, .events = {}};
  }
};

/// Whether a law's force jumps at a touch: at 1e-12 m of depth a rate of one [m/s] more than doubles it.
[[nodiscard]] inline bool jumps_at_touch(const ContactLaw& law) {
  constexpr double shallow = 1e-12, speed = 1.0;  // [m], [m/s]
  return law(shallow, speed).x() > 2.0 * law(shallow, 0.0).x() + 1e-9;
}

}  // namespace snare::coupling
