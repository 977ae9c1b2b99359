#pragma once

#include "coupling/dynamics/body_part.hpp"
#include "coupling/dynamics/constraint_set.hpp"
#include "coupling/dynamics/contact_part.hpp"
#include "coupling/dynamics/contact_points.hpp"
#include "coupling/dynamics/law_part.hpp"
#include "coupling/dynamics/model.hpp"
#include "coupling/dynamics/options.hpp"
#include "coupling/dynamics/result.hpp"
#include "numerics/ida.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace snare::coupling {

/// Where the integrals along the run stand: powers [W], sums of all outer forces [N] and moments about the origin [N m] on
/// wires and free bodies, and the force of every contact on its wire and of every body on its spring [N].
namespace integral {
constexpr Eigen::Index dissipated = 0;
constexpr Eigen::Index work = 1;
constexpr Eigen::Index outer = 2;
constexpr Eigen::Index outer_moment = 5;
constexpr Eigen::Index contacts = 8;
}  // namespace integral

/// Times that differ by less are the same: the integrator cannot step from one to the other.
[[nodiscard]] inline bool reached(double time, double limit) {
  constexpr double round_off = 1e-13;
  return time >= limit - round_off * std::max(1.0, limit);
}

/// A point of a contact.
struct ContactHandle {
  std::size_t contact = 0, point = 0;
  ContactPart* part = nullptr;
};

/// One leg of a motion, from its start or from a state: parts, integrator, what happens at events, balances.
class MotionRun {
 public:
  MotionRun(const Motion& motion, const MotionOptions& options, const MotionObserver& observer);
  void begin();
  void resume(const MotionState& from);
  /// Goes on to `limit` [s].
  MotionResult go(double limit);

 private:
  [[nodiscard]] std::vector<numerics::DaePart*> parts();
  void require_apart();
  [[nodiscard]] bool write_until(double time);
  [[nodiscard]] MotionResult result(numerics::IdaReport report);

  // Events (events.cpp).
  [[nodiscard]] std::vector<ContactHandle> points();
  [[nodiscard]] std::vector<ContactHandle> constraints();
  [[nodiscard]] Eigen::MatrixXd flexibility(const std::vector<ContactHandle>& constraints, bool with_friction) const;
  void note(const ContactHandle& point, MotionEvent::Kind kind, double speed);
  void open(const ContactHandle& point);
  void make_rates();
  [[nodiscard]] std::optional<double> first_touch(double from, const numerics::Ida& ida);
  [[nodiscard]] Eigen::VectorXd allowed_tension(const std::vector<ContactHandle>& constraints,
                                                const Eigen::VectorXd& flexibility) const;
  [[nodiscard]] std::optional<std::string> close_touching();
  void switch_friction(const ContactHandle& point);
  [[nodiscard]] bool leave_broken_modes(bool at_event);
  [[nodiscard]] bool rest_lost_minima();
  void settle();

  // Balances (balance.cpp).
  [[nodiscard]] EnergyBalance stored(const numerics::DaePoint& at, MotionSample* into);
  void add_reactions(const ContactHandle& point, const Eigen::Vector3d& force, const numerics::DaePoint& at,
                     Eigen::Ref<Eigen::VectorXd> rates) const;
  void integrands(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rates);
  void watch();
  [[nodiscard]] MotionSample sample(const numerics::DaePoint& at, const Eigen::VectorXd& integrals);

  const Motion& motion_;
  MotionOptions options_;
  const MotionObserver& observer_;
  std::deque<wire::RodPart> rods_;
  std::deque<BodyPart> bodies_;
  std::deque<ContactPoints> contacts_;
  std::deque<LawPart> springs_;
  std::deque<FrictionEvent> friction_events_;  // behind all other events
  std::optional<ConstraintSet> constraints_;
  std::unique_ptr<numerics::DaeSystem> system_;
  std::unique_ptr<numerics::Ida> ida_;
  Eigen::VectorXd y_, rate_;
  Eigen::VectorXd integrals_;
  double time_ = 0.0;
  double rested_ = -std::numeric_limits<double>::infinity();  // when points were last made to rest on the wire [s]
  int trials_ = 0;                                            // of that, one soon after the other
  MotionSums sums_;
  std::optional<std::string> refused_;  // a touch that cannot be taken
};

}  // namespace snare::coupling
