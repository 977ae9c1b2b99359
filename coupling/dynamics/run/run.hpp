#pragma once

#include "coupling/dynamics/contact/interaction.hpp"
#include "coupling/dynamics/joints/body_part.hpp"
#include "coupling/dynamics/joints/constraint_set.hpp"
#include "coupling/dynamics/joints/load_part.hpp"
#include "coupling/dynamics/joints/robot_loop.hpp"
#include "coupling/dynamics/laws/law_wire_part.hpp"
#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/modes.hpp"
#include "coupling/dynamics/model/options.hpp"
#include "coupling/dynamics/model/result.hpp"
#include "coupling/dynamics/run/force_record.hpp"
#include "coupling/dynamics/run/loss_sum.hpp"
#include "coupling/dynamics/run/peak_force.hpp"
#include "coupling/dynamics/run/phase_watch.hpp"
#include "coupling/dynamics/run/sensed_readings.hpp"
#include "numerics/ida.hpp"
#include "numerics/progress.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace snare::coupling {

/// Times that differ by less are the same: the integrator cannot step from one to the other [s].
[[nodiscard]] inline double time_resolution(double time) {
  constexpr double round_off = 1e-13;
  return round_off * std::max(1.0, time);
}

/// Whether a time is the limit or behind it, round-off aside [s].
[[nodiscard]] inline bool reached(double time, double limit) {
  return time >= limit - time_resolution(limit);
}

/// One leg of a motion, from its start or from a state: parts, integrator, what happens at events, balances.
class MotionRun {
 public:
  MotionRun(const Motion& motion, const MotionOptions& options, const MotionObserver& observer);
  /// Finds what touches at the start, books energy and momentum there, makes the rates consistent; once, in
  /// place of `resume`.
  void begin();
  /// Goes on from a state that a leg of the same motion has left. Throws base::InputError when the sizes are
  /// not of this motion.
  void resume(const MotionState& from);
  /// Goes on to `limit` [s].
  MotionResult run_until(double limit);
  /// See small_motions_at, about the present state (run_modes.cpp). Frequencies in Hz.
  [[nodiscard]] SmallMotions small_motions();

 private:
  void add_interactions();
  [[nodiscard]] std::vector<numerics::DaePart*> parts();
  [[nodiscard]] int default_order()
      const;  // of the integrator                                       theory.md (M.2)
  void require_apart();
  void stay_in_plane();
  void leave_plane();
  [[nodiscard]] bool write_until(double time);
  /// Gives a sample to the observer; true: the run ends. One with a value that is not a number is not given
  /// and ends the run; the first one throws base::InputError.
  [[nodiscard]] bool emit(const MotionSample& sample);
  void cross_break(double time);
  /// Why the run has ended here, where the integrator does not say so.
  void end(numerics::IdaReport& report, bool stopped) const;
  [[nodiscard]] MotionResult result(numerics::IdaReport report);

  // Starts (start_rates.cpp).
  void make_rates();
  void restart();

  // Phases (run_phases.cpp).
  [[nodiscard]] double signal(const MotionSignal& signal);
  [[nodiscard]] PhaseWatch::Signals signals();
  [[nodiscard]] PhaseWatch::Kept kept() const;
  /// What sensors see and read now, for the phases that ask for it.
  void sense();
  /// See end_tension, now [N].
  [[nodiscard]] double tension(int wire);
  /// After a step: goes back to where a phase begins within it. Whether one does.
  [[nodiscard]] bool look_for_phase();
  /// The pending phase begins now, and those that begin with it. Whether the run is over.
  [[nodiscard]] bool begin_phases();
  void restore_phases(std::span<const double>& memory);

  /// Of the kinetic energy, of a vector of all unknowns.
  [[nodiscard]] std::vector<std::pair<std::string, double>> shares_of(const Eigen::VectorXcd& x);
  [[nodiscard]] ModeShape shape_of(const Eigen::VectorXcd& x);

  // Balances (balance.cpp).
  [[nodiscard]] EnergyBalance stored(const numerics::DaePoint& at, MotionSample* into);
  void integrands(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rates);
  void observe_interactions(double time_before, const Eigen::VectorXd& before);
  void record_extremes(double time_before, const Eigen::VectorXd& before);
  void watch_law_wire(std::size_t k, double tension);
  /// Updates the total dissipation, and removes and counts its decreases.
  void count_losses();
  /// Energy that wires of laws held when the shaft slid off them [J]: dissipated.
  [[nodiscard]] double let_go() const;
  /// Power that laws between bodies and in place of wires lose [W], >= 0.
  [[nodiscard]] double law_loss(const numerics::DaePoint& at) const;
  /// Books what has happened to an interaction.
  void book(std::size_t interaction, MotionEvent event);
  /// What events of interactions ask for.
  struct Crossed {
    bool any = false, jump = false;  // a jump needs a restart
  };
  /// Books touches, lift-offs, and what else the interactions tell of the step from a time [s]. found: events
  /// of the integrator.
  Crossed cross_events(double time_before, std::span<const int> found);
  /// The first time, up to a limit, at which what acts has a break that is known ahead [s].
  [[nodiscard]] double next_break(double limit) const;
  [[nodiscard]] double longest_step() const;
  /// Tells the robots' loops what presses on their bodies, in the step from a time [s] on or, without one,
  /// now.
  void sense_forces(double from);
  /// At the last state, or within the step before it.
  [[nodiscard]] MotionSample sample(const numerics::DaePoint& at, const Eigen::VectorXd& integrals);
  /// The sample of an interaction, with the forces that are recorded where it has touched for some steps.
  [[nodiscard]] ContactSample recorded(std::size_t interaction, const numerics::DaePoint& at) const;

  const Motion& motion_;
  MotionOptions options_;
  const MotionObserver& observer_;
  std::deque<wire::RodPart> rods_;
  std::deque<RobotLoop> loops_;  // of bodies that robots move: before these
  std::deque<BodyPart> bodies_;
  std::optional<ConstraintSet> constraints_;
  std::vector<std::unique_ptr<Interaction>> interactions_;  // in the order of Motion::contact_names
  std::vector<LawWirePart*> law_wires_;                     // those of them that stand for wires
  std::deque<LoadPart> loads_;
  PhaseWatch phases_;
  SensedReadings sensed_;
  std::unique_ptr<numerics::DaeSystem> system_;
  std::unique_ptr<numerics::Ida> ida_;
  Eigen::VectorXd y_, rate_;
  Eigen::VectorXd before_;  // y of the step before
  Eigen::VectorXd integrals_;
  LossSum law_losses_;
  double lost_ = 0.0,
         lost_before_ = 0.0;  // all that is dissipated, and that up to the step or sample before [J]
  double corrected_ = 0.0;    // sum of the decreases that were removed from it [J]
  PeakForce peak_;
  ForceRecord forces_;                     // rates of the integrals that belong to contacts
  std::vector<LeftOutMomentum> left_out_;  // of every wire
  double time_ = 0.0;
  MotionSums sums_;
  numerics::Progress progress_;
  std::optional<std::string> broken_;  // a wire at its strength, a body that is too fast
  bool not_finite_ = false;            // a sample was not given
  bool over_ = false;                  // a phase has ended the run
};

}  // namespace snare::coupling
