#pragma once

#include "coupling/statics/push_curve.hpp"
#include "coupling/statics/push_setup.hpp"
#include "coupling/statics/spatial_push_system.hpp"

#include <optional>

namespace snare::coupling {

/// Which length of wire slides over the pin when friction's work is counted.
enum class SlidingLength {
  material,  ///< dS, that of the condition of sticking                   theory.md (C.5)
  stretched  ///< |X'| dS, what passes the pin
};

/// A wire in space and the pin that presses it, from one accepted equilibrium to the next: what a push by a
/// tilted pin and a snared shaft share.  theory.md (C.10), (C.11)
class SpatialContact {
 public:
  /// Of a wire that is in equilibrium in the plane at `at`, its pusher pressed. pin: axis, centre, motion and
  /// friction; the rest follows from the plane.
  SpatialContact(const PushSetup& planar, const numerics::PathPoint& at, const wire::SpatialRod& rod,
                 const SpatialPin& pin, SlidingLength sliding_length);
  ~SpatialContact() = default;
  SpatialContact(const SpatialContact&) = delete;
  SpatialContact& operator=(const SpatialContact&) = delete;

  /// The wire, the equations at one equilibrium, and the pin as it stands; moving the pin is what makes the
  /// next equilibrium another.
  [[nodiscard]] const wire::SpatialRod& rod() const { return rod_; }
  [[nodiscard]] const SpatialPushSystem& system() const { return system_; }
  [[nodiscard]] SpatialPin& pin() { return system_.pin; }
  [[nodiscard]] const SpatialPin& pin() const { return system_.pin; }
  /// Sets the weight per length across the plane [N/m].
  void set_weight_across(double weight);
  /// The planar equilibrium in space, at parameter 0: to begin with, not accepted yet.
  [[nodiscard]] const numerics::PathPoint& start() const { return start_; }

  /// Newton's method with the pin as it stands, pressed or open.
  [[nodiscard]] numerics::SolveReport solve(numerics::PathPoint& trial, int max_iterations);

  struct Settled {
    numerics::SolveReport report;          ///< of the last solution
    int iterations = 0;                    ///< of all
    std::optional<PushEvent::Kind> event;  ///< the last change of the contact, touch or lift-off
  };
  /// Newton's method with the contact settled: it opens where it would pull, closes where it would be
  /// entered.
  [[nodiscard]] Settled settle(numerics::PathPoint& trial, int max_iterations);

  /// Whether a vertex beside the contact is inside the pin: a wire bent sharper than the pin would lie on it
  /// over an arc.
  [[nodiscard]] bool wraps(const numerics::PathPoint& trial) const;

  /// Makes a solved point the one from which slip, frames and friction's work go on.
  void accept(const numerics::PathPoint& point);

  /// What the next equilibrium depends on, to be put aside and given to `restore` where steps are taken back.
  struct Memory {
    SpatialPin pin;
    wire::SpatialState accepted;
    double dissipated = 0.0;                                  ///< [J]
    Eigen::Vector2d last_friction = Eigen::Vector2d::Zero();  ///< on the wire in (c, a) [N]
    SlipWork slip_work{};
    bool slides = false;
  };
  [[nodiscard]] Memory memory() const {
    return {system_.pin, system_.accepted(), dissipated_, last_friction_, slip_work_, slides_};
  }
  void restore(const Memory& memory);
  /// Assembles and factorises at a point, where reactions and pivots are wanted and the last solution was
  /// elsewhere.
  void assemble(const numerics::PathPoint& at) {
    static_cast<void>(numerics::tangent(system_, at, workspace_, nullptr));
  }

  /// Whether the wire slides over the pin at the accepted point.
  [[nodiscard]] bool slides() const { return slides_; }
  /// By friction so far [J], never decreasing.
  [[nodiscard]] double dissipated() const { return dissipated_; }
  void forget_dissipation() { dissipated_ = 0.0; }
  /// Negative pivots of the last factorisation: unstable modes.
  [[nodiscard]] int negative_pivots() const { return workspace_.solver.negative_pivots(); }
  /// Elastic energy of the wire and potential of its weight at a point [J].
  [[nodiscard]] double energy(const numerics::PathPoint& at) const { return rod_.energy(system_.state(at)); }

 private:
  [[nodiscard]] std::optional<PushEvent::Kind> change_state(numerics::PathPoint& trial);

  wire::SpatialRod rod_;
  SpatialPushSystem system_;
  SlidingLength sliding_length_;
  numerics::PathPoint start_;
  numerics::PathWorkspace workspace_;
  double dissipated_ = 0.0;
  Eigen::Vector2d last_friction_ = Eigen::Vector2d::Zero();  // on the wire in (c, a) [N]
  SlipWork slip_work_;
  bool slides_ = false;
};

}  // namespace snare::coupling
