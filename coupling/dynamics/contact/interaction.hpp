#pragma once

#include "base/errors.hpp"
#include "coupling/dynamics/joints/constraint_set.hpp"
#include "coupling/dynamics/model/result.hpp"
#include "numerics/dae.hpp"
#include "wire/motion/rod_part.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace snare::coupling {

/// Where the integrals along a run stand: powers [W], sums of all outer forces [N] and moments about the
/// origin [N m] on wires and free bodies, the force of every interaction on the wire or the first of two [N],
/// and behind them the normal force of each. The dissipation of laws has kinks, which the integrator's
/// formula does not see: that sum is LossSum's.
namespace integral {
constexpr Eigen::Index dissipated = 0;
constexpr Eigen::Index work = 1;
constexpr Eigen::Index outer = 2;
constexpr Eigen::Index outer_moment = 5;
/// Dissipation of laws between bodies and in place of wires, no part of `dissipated`
constexpr Eigen::Index laws = 8;
constexpr Eigen::Index contacts = 9;
}  // namespace integral

/// Where an interaction adds to the rates of the integrals.
struct IntegralRates {
  Eigen::Ref<Eigen::VectorXd> all;  ///< at the places of `integral`
  Eigen::Index force;               ///< first of the three of the interaction's own force
  Eigen::Index normal;              ///< of its own normal force
  const ConstraintSet& constraints;
  ConstraintSet::Outer& held;  ///< what acts on carriers
};

/// Parts of a motion that press on each other: an entry of the contacts in results. A run holds one list of
/// interactions, in the order of `Motion::contact_names`. Unknowns y of the run are in SI units.
class Interaction {
 public:
  Interaction() = default;
  virtual ~Interaction() = default;
  Interaction(const Interaction&) = delete;
  Interaction& operator=(const Interaction&) = delete;

  /// Appends its parts of the DAE.
  virtual void append(std::vector<numerics::DaePart*>& parts) = 0;
  /// Whether it has unknowns for the deflections of friction between bodies.
  [[nodiscard]] virtual bool has_body_bristles() const { return false; }

  /// Why a start is refused: the two sides are inside each other. tolerance: of places [m].
  [[nodiscard]] virtual std::optional<base::InputProblem> overlap(const numerics::VectorView& /*y*/,
                                                                  double /*tolerance*/) const {
    return {};
  }
  /// Finds the candidates for contact at the start.
  virtual void update_candidates(const numerics::VectorView& /*y*/) {}
  /// dz/dt [m/s] of bristles into their places of `rate`.
  virtual void set_bristle_rates(const Eigen::VectorXd& /*y*/, Eigen::VectorXd& /*rate*/) const {}
  /// See ContactPart::restrict_to_plane.
  [[nodiscard]] virtual std::vector<int> restrict_to_plane(int /*normal*/) { return {}; }
  virtual void leave_plane() {}
  /// The longest step that the integrator may take from the accepted state [s].
  [[nodiscard]] virtual double longest_step() const { return std::numeric_limits<double>::infinity(); }

  /// Stored energy [J].
  [[nodiscard]] virtual double energy(const numerics::DaePoint& at) const = 0;
  /// Power that a law dissipates, no part of the integral `dissipated` [W], >= 0.
  [[nodiscard]] virtual double law_loss(const numerics::DaePoint& /*at*/) const { return 0.0; }
  /// Energy that it held when it let go at once of what pressed on it, of all times [J], >= 0.
  [[nodiscard]] virtual double let_go() const { return 0.0; }
  /// Adds to the rates of the integrals.
  virtual void add_rates(const numerics::DaePoint& at, const IntegralRates& rates) const = 0;
  /// Force on the wire, or on the first of two, and the sum of its normal forces [N].
  struct Load {
    Eigen::Vector3d force;
    double normal;
  };
  [[nodiscard]] virtual Load load(const numerics::DaePoint& at) const = 0;

  /// Its line of the history.
  [[nodiscard]] virtual ContactSample sample(const numerics::DaePoint& at) const = 0;
  /// How many of the accepted states told last have touched without a break; nothing of a law.
  [[nodiscard]] virtual std::optional<int> held_states() const { return {}; }
  /// Takes what falls on rigidly held ends from the forces of the mounts, left and right of every wire [N].
  virtual void take_from_mounts(const numerics::VectorView& /*y*/,
                                std::vector<Eigen::Vector3d>& /*mount_forces*/) const {}

  /// Results of an accepted step.
  struct Observed {
    double normal = 0.0;              ///< [N]
    double penetration = 0.0;         ///< the deepest of a foundation [m], >= 0
    double tension = 0.0;             ///< of a wire that a law stands for [N]
    std::vector<MotionEvent> events;  ///< their `contact` is 0
  };
  /// Called for every accepted step, from unknowns `before` at `time_before` [s].
  [[nodiscard]] virtual Observed observe(const numerics::DaePoint& now, double time_before,
                                         const Eigen::VectorXd& before) = 0;
  /// Whether its force is that of a law, which takes no mass of a wire along at once.
  [[nodiscard]] virtual bool is_law() const { return true; }
  /// Whether the integrator has an event of it, where it begins and ends to press.
  [[nodiscard]] virtual bool has_event() const { return is_law(); }
  /// Whether its force jumps there, so that the integration starts again.
  [[nodiscard]] virtual bool jumps() const { return true; }
  /// Events of the step to `now` in addition to the integrator's, if there was one. Their `contact` is 0.
  [[nodiscard]] virtual std::vector<MotionEvent> changes(const numerics::DaePoint& /*now*/,
                                                         double /*time_before*/, bool /*event*/) {
    return {};
  }

  /// Memory of accepted states in addition to that of its parts: see DaePart.
  virtual void save_touches(std::vector<double>& /*memory*/) const {}
  virtual void restore_touches(std::span<const double>& /*memory*/) {}
};

/// Forces of contact on rigidly held components of a wire's ends, which are no part of the rod's own
/// reaction: taken from the outer forces and moments. on_ends: of the first and the last vertex [N].
inline void take_held(const wire::RodPart& rod, const std::array<Eigen::Vector3d, 2>& on_ends,
                      const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rates) {
  const std::array<int, 2> ends{rod.position_of(0), rod.position_of(rod.vertices() - 1)};
  for (std::size_t k = 0; k < 2; ++k) {
    rates.segment<3>(integral::outer) -= on_ends[k];
    rates.segment<3>(integral::outer_moment) -= Eigen::Vector3d(at.y.segment<3>(ends[k])).cross(on_ends[k]);
  }
}

/// Results of an accepted step with closed stretches, which are the points of their sum.
[[nodiscard]] inline Interaction::Observed observed(const ContactSample& sum,
                                                    std::vector<MotionEvent> events) {
  Interaction::Observed seen{.normal = sum.normal_force, .events = std::move(events)};
  for (const ContactSample& s : sum.points) seen.penetration = std::max(seen.penetration, -s.gap);
  return seen;
}

}  // namespace snare::coupling
