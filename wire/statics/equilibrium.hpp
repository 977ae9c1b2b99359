#pragma once

#include "numerics/report.hpp"
#include "wire/planar_rod.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace snare::wire {

/// Which equilibrium is wanted.
enum class Branch {
  stable,  ///< a minimum of the energy: the iteration descends and ends with no negative pivot
  nearest  ///< the one that Newton's method reaches from the start, stable or not
};

/// Which equilibrium is sought, and when the search ends.
struct EquilibriumOptions {
  Branch branch = Branch::stable;
  int max_iterations = 200;
  double tolerance = 1e-10;  ///< of the largest force residual over the force scale of the rod [-]
};

/// How the search ended, and whether what it found is stable.
struct EquilibriumReport : numerics::SolveReport {
  int negative_pivots = 0;   ///< of the tangent at the end: 0 means stable
  double pivot_ratio = 0.0;  ///< smallest over largest |pivot|: near 0 means a neutral direction
};

/// EA [N] and EI [N m^2] of a section none of whose sliders slides: what round-off and the first tangent have
/// to do with.
struct StickingStiffness {
  double axial = 0.0, bending = 0.0;
};
template <class Properties>
StickingStiffness sticking_stiffness(const Properties& p) {
  StickingStiffness all{p.axial_stiffness, p.bending_stiffness};
  if constexpr (requires { p.axial_sliders; }) {
    for (const SliderElement& slider : p.axial_sliders) all.axial += slider.stiffness;
    for (const SliderElement& slider : p.bending_sliders) all.bending += slider.stiffness;
  }
  return all;
}

/// Force below which a residual of the rod is round-off or of no account [N].
///
/// tolerance * (EI/L^2 + largest tension) and the force that the last places of the coordinates make in the
/// shortest edge, eps L (EA/2h + 2 EI/h^3): an iteration may stall at some times that.
inline double force_tolerance(double tolerance, double bending_stiffness, double axial_stiffness,
                              double length, double shortest_edge, double largest_force) {
  const double scale = bending_stiffness / (length * length) + largest_force;
  const double h = shortest_edge;
  const double round_off = std::numeric_limits<double>::epsilon() * length *
                           (0.5 * axial_stiffness / h + 2.0 * bending_stiffness / (h * h * h));
  return std::max(tolerance * scale, round_off);
}

/// Force that the last places of a coordinate of about `length` [m] make in the spring of a mount that gives
/// [N]: what a residual of its row cannot fall below. The mount's place is then known to some 1e-16 of the
/// length, as it is of a rigid one. stiffness [N/m]; infinite, or of a free end: 0.
inline double mount_round_off(double stiffness, double length) {
  return std::isinf(stiffness) ? 0.0 : 4.0 * std::numeric_limits<double>::epsilon() * length * stiffness;
}

/// Newton's method with halved steps for find_equilibrium().                          theory.md (W.9)
template <class Rod, class State>
class EquilibriumSearch {
 public:
  EquilibriumSearch(const Rod& rod, State& state, const EquilibriumOptions& options)
      : rod_(rod), state_(state), options_(options), length_(state.controls.length()), shortest_(length_) {
    for (int e = 0; e < rod.mesh().edges(); ++e)
      shortest_ = std::min(shortest_, rod.mesh().rest_length(e, state.controls));
    const StickingStiffness stiffness = sticking_stiffness(rod.properties());
    ea_ = stiffness.axial;
    ei_ = stiffness.bending;
    mounts_ = {mount_round_off(rod.properties().left.translational_stiffness, length_),
               mount_round_off(rod.properties().right.translational_stiffness, length_)};
  }

  /// Iterates to the end; leaves the result in the state.
  EquilibriumReport run() {
    evaluate();
    double previous = std::numeric_limits<double>::max();
    for (report_.iterations = 0; report_.iterations <= options_.max_iterations; ++report_.iterations) {
      report_.residual_norm = residual_;
      if (!std::isfinite(residual_) || !std::isfinite(assembly_.energy))
        return ended(numerics::Termination::not_finite, "the energy or a force of the rod is not finite");
      const double largest = rod_.tensions(state_).template lpNorm<Eigen::Infinity>();
      const double allowed = force_tolerance(options_.tolerance, ei_, ea_, length_, shortest_, largest);
      factored_ = factor_.factorize(assembly_.hessian);
      report_.negative_pivots = factored_ ? factor_.negative_pivots() : -1;
      report_.pivot_ratio = factored_ ? factor_.pivot_ratio() : 0.0;
      // Round-off may hold the residual at some times its tolerance.
      const bool stalled = residual_ <= 16.0 * allowed && residual_ >= 0.5 * previous;
      previous = residual_;
      if ((residual_ <= allowed || stalled) && right_branch())
        return ended(numerics::Termination::converged, "");
      if (report_.iterations == options_.max_iterations) break;
      if (options_.branch == Branch::stable) make_positive();
      if (!factored_)
        return ended(numerics::Termination::singular_matrix, "the tangent stiffness of the rod is singular");
      if (descend(newton_step())) continue;
      report_.residual_norm = residual_;
      if (residual_ <= 100.0 * allowed && right_branch())  // stalled on round-off
        return ended(numerics::Termination::converged, "");
      return ended(numerics::Termination::step_too_small, "no step lowers the energy of the rod");
    }
    return ended(numerics::Termination::iteration_limit,
                 "the equilibrium of the rod was not reached in the allowed iterations");
  }

 private:
  /// Unknowns behind the coordinates of a vertex are angles: their residuals are moments, about a force times
  /// an edge.
  static bool is_angle(Eigen::Index i) { return i % Rod::block >= Rod::dimension; }
  [[nodiscard]] bool right_branch() const {
    return options_.branch == Branch::nearest || report_.negative_pivots <= 0;
  }
  EquilibriumReport ended(numerics::Termination termination, const char* message) {
    report_.termination = termination;
    report_.message = message;
    return report_;
  }

  void evaluate() {
    constexpr std::array<bool, 3> no_controls{false, false, false};
    rod_.assemble(state_, no_controls, assembly_);
    rod_.hold_mounts(assembly_);
    const Eigen::Index right_row = Rod::block * rod_.mesh().edges();
    residual_ = 0.0;
    for (Eigen::Index i = 0; i < assembly_.gradient.size(); ++i) {
      const double round_off = i == 0 ? mounts_[0] : (i == right_row ? mounts_[1] : 0.0);
      const double force = std::abs(assembly_.gradient[i]) - round_off;
      const double residual = force / (is_angle(i) ? shortest_ : 1.0);
      residual_ = residual <= residual_ ? residual_ : residual;  // keeps a NaN
    }
  }

  /// Shifts the Hessian until it is positive definite, from the last shift on, so that a long descent does
  /// not search again.
  void make_positive() {
    double trial = (factored_ && factor_.negative_pivots() == 0)
                       ? 0.0
                       : std::max(shift_, 1e-3 * ei_ / std::pow(length_, 3));
    while (trial > 0.0) {
      numerics::SymmetricBandMatrix shifted = assembly_.hessian;
      for (int i = 0; i < shifted.order(); ++i) shifted.lower(i, i) += trial;
      factored_ = factor_.factorize(shifted);
      if (factored_ && factor_.negative_pivots() == 0) break;
      trial *= 4.0;
    }
    shift_ = 0.25 * trial;
  }

  /// No vertex moves more than a tenth of the length at once, no edge turns more than 0.1 rad.
  Eigen::VectorXd newton_step() {
    Eigen::VectorXd step = -assembly_.gradient;
    factor_.solve(step);
    double far = 0.0;
    for (Eigen::Index i = 0; i < step.size(); ++i)
      far = std::max(far, std::abs(step[i]) / (is_angle(i) ? 0.1 : 0.1 * length_));
    if (far > 1.0) step /= far;
    return step;
  }

  /// Halves the step until it is accepted; else restores the state and returns false.
  bool descend(const Eigen::VectorXd& step) {
    const double old_energy = assembly_.energy, old_residual = residual_;
    const double slope = assembly_.gradient.dot(step);
    const bool nearest = options_.branch == Branch::nearest;
    const State start = state_;
    double fraction = 1.0;
    for (int k = 0; k < 30; ++k, fraction *= 0.5) {
      state_ = start;
      advance(state_, fraction * step);
      evaluate();
      if (!std::isfinite(residual_)) continue;
      const bool falls = nearest ? residual_ < (1.0 - 1e-4 * fraction) * old_residual
                                 : assembly_.energy <= old_energy + 1e-4 * fraction * slope;
      // Near the end energies differ by round-off only: a falling residual then is enough.
      const bool at_the_end =
          std::abs(fraction * slope) < 1e-12 * std::abs(old_energy) && residual_ < old_residual;
      if (falls || at_the_end) return true;
    }
    state_ = start;
    evaluate();
    return false;
  }

  const Rod& rod_;
  State& state_;
  const EquilibriumOptions& options_;
  double length_, shortest_;  // of the wire, of an edge at rest [m]
  double ea_ = 0.0, ei_ = 0.0;
  std::array<double, 2> mounts_{};  // round-off in their springs [N]
  EquilibriumReport report_;
  RodAssembly assembly_;
  numerics::BandLdlt factor_;
  bool factored_ = false;
  double shift_ = 0.0, residual_ = 0.0;
};

/// Finds an equilibrium of a rod that only its mounts and its weight hold.            theory.md (W.9)
///
/// Damped Newton: the Hessian is shifted until all its pivots are positive (Branch::stable), the step is
/// halved until the energy falls (stable) or the residual does (nearest). `state` holds the start and the
/// result; on failure the last state with a lower energy (residual).
template <class Rod, class State>
EquilibriumReport find_equilibrium(const Rod& rod, State& state, const EquilibriumOptions& options = {}) {
  return EquilibriumSearch<Rod, State>(rod, state, options).run();
}

}  // namespace snare::wire
