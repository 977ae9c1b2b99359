#pragma once

#include "coupling/dynamics/joints/moving_frame.hpp"
#include "coupling/dynamics/model/options.hpp"

#include <Eigen/Core>

#include <string>
#include <utility>
#include <vector>

namespace snare::coupling {

/// What a carrier's frame holds at all times.                                        theory.md (M.15)-(M.17)
///
///   g(q) = 0,   dg/dt = G(q) v = 0
/// In the DAE its multipliers, with the rows g = 0, are followed by as many that stabilise it (Gear, Gupta
/// and Unknowns y, velocities v and their changes in SI units; rows of translation in m and m/s, of rotation
/// in rad and rad/s, multipliers in N and N m. Leimkuhler 1985), with the rows G v = 0. The start and the
/// impulses see G alone.
class Constraint : public numerics::DaePart {
 public:
  Constraint(std::string name, MovingFrame carrier, const MotionOptions& options)
      : name_(std::move(name)), carrier_(std::move(carrier)), options_(options) {}

  /// Keeps the pattern, whose slots the Jacobian fills.
  void attach_pattern(const numerics::SparseMatrix& pattern) final { slots_.attach(pattern); }

  /// Rows of G.
  [[nodiscard]] virtual int constraints() const = 0;
  /// G dv of changes of the velocities (or of accelerations). dv and G dv in SI units; (constraints).
  [[nodiscard]] virtual Eigen::VectorXd velocity_error(const numerics::VectorView& y,
                                                       const Eigen::VectorXd& dv) const = 0;
  /// d(G v)/dt along the rates of the coordinates, with the velocities as they are. In m/s^2 and rad/s^2;
  /// (constraints).
  [[nodiscard]] virtual Eigen::VectorXd acceleration_bias(const numerics::VectorView& y,
                                                          const Eigen::VectorXd& rate) const = 0;
  /// Adds M^-1 G^T times the multipliers (impulses [N s] and [N m s]) to changes dv of the velocities, in SI
  /// units.
  virtual void apply_impulse(const numerics::VectorView& y, const Eigen::VectorXd& multipliers,
                             Eigen::VectorXd& dv) const = 0;
  /// Wrench on what is held, about its held frame's origin, in the axes of the world [N m, N].
  [[nodiscard]] virtual multibody::Wrench wrench(const numerics::VectorView& y) const = 0;
  /// By how far g misses zero: distance [m] and, if larger, angle [rad].
  [[nodiscard]] virtual double gap(const numerics::VectorView& y) const = 0;

  /// First of the multipliers among the unknowns.
  [[nodiscard]] int multipliers() const { return multipliers_; }
  /// What holds it.
  [[nodiscard]] const MovingFrame& carrier() const { return carrier_; }

 protected:
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const MotionOptions& options() const { return options_; }
  [[nodiscard]] numerics::PatternSlots& slots() { return slots_; }
  /// Told by `declare`.
  void set_multipliers(int first) { multipliers_ = first; }

 private:
  std::string name_;
  MovingFrame carrier_;
  MotionOptions options_;
  int multipliers_ = 0;
  numerics::PatternSlots slots_;
};

/// Adds to dv what the constraints' forces do, so that G dv + extra = 0 for all of them; returns their
/// multipliers, one constraint behind another. extra: empty for zero.                        theory.md (M.16)
/// All in SI units.
Eigen::VectorXd project(const std::vector<const Constraint*>& constraints, const numerics::VectorView& y,
                        const Eigen::VectorXd& extra, Eigen::VectorXd& dv);

}  // namespace snare::coupling
