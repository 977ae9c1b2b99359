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

/// Finds an equilibrium of a rod that only its mounts and its weight hold.            theory.md (W.9)
///
/// Damped Newton: the Hessian is shifted until all its pivots are positive (Branch::stable), the step is
/// halved until the energy falls (stable) or the residual does (nearest). `state` holds the start and the
/// result; on failure the last state with a lower energy (residual).
template <class Rod, class State>
EquilibriumReport find_equilibrium(const Rod& rod, State& state, const EquilibriumOptions& options = {}) {
  constexpr std::array<bool, 3> no_controls{false, false, false};
  EquilibriumReport report;
  RodAssembly assembly;
  numerics::BandLdlt factor;
  const double length = state.controls.length();
  double shortest = length;
  for (int e = 0; e < rod.mesh().edges(); ++e) {
    shortest = std::min(shortest, rod.mesh().rest_length(e, state.controls));
  }
  const auto [ea, ei] = sticking_stiffness(rod.properties());
  double shift = 0.0;
  double previous = std::numeric_limits<double>::max();

  // Unknowns behind the coordinates of a vertex are angles: their residuals are moments, about a force times
  // an edge.
  const auto is_angle = [](Eigen::Index i) { return i % Rod::block >= Rod::dimension; };
  const std::array<double, 2> mounts{mount_round_off(rod.properties().left.translational_stiffness, length),
                                     mount_round_off(rod.properties().right.translational_stiffness, length)};
  const Eigen::Index right_row = Rod::block * rod.mesh().edges();
  const auto evaluate = [&](const State& at) {
    rod.assemble(at, no_controls, assembly);
    rod.hold_mounts(assembly);
    double largest = 0.0;
    for (Eigen::Index i = 0; i < assembly.gradient.size(); ++i) {
      const double round_off = i == 0 ? mounts[0] : (i == right_row ? mounts[1] : 0.0);
      const double force = std::abs(assembly.gradient[i]) - round_off;
      const double residual = force / (is_angle(i) ? shortest : 1.0);
      largest = residual <= largest ? largest : residual;  // keeps a NaN
    }
    return largest;
  };
  double residual = evaluate(state);
  for (report.iterations = 0; report.iterations <= options.max_iterations; ++report.iterations) {
    report.residual_norm = residual;
    if (!std::isfinite(residual) || !std::isfinite(assembly.energy)) {
      report.termination = numerics::Termination::not_finite;
      report.message = "the energy or a force of the rod is not finite";
      return report;
    }
    const double largest = rod.tensions(state).template lpNorm<Eigen::Infinity>();
    const double allowed = force_tolerance(options.tolerance, ei, ea, length, shortest, largest);
    bool factored = factor.factorize(assembly.hessian);
    report.negative_pivots = factored ? factor.negative_pivots() : -1;
    report.pivot_ratio = factored ? factor.pivot_ratio() : 0.0;
    // Round-off may hold the residual at some times its tolerance.
    const bool stalled = residual <= 16.0 * allowed && residual >= 0.5 * previous;
    previous = residual;
    if ((residual <= allowed || stalled) &&
        (options.branch == Branch::nearest || report.negative_pivots <= 0)) {
      report.termination = numerics::Termination::converged;
      return report;
    }
    if (report.iterations == options.max_iterations) break;

    if (options.branch == Branch::stable) {
      // Shift until positive definite; start from the last shift, so that a long descent does not search
      // anew.
      double trial = (factored && factor.negative_pivots() == 0)
                         ? 0.0
                         : std::max(shift, 1e-3 * ei / std::pow(length, 3));
      while (trial > 0.0) {
        numerics::SymmetricBandMatrix shifted = assembly.hessian;
        for (int i = 0; i < shifted.order(); ++i) shifted.lower(i, i) += trial;
        factored = factor.factorize(shifted);
        if (factored && factor.negative_pivots() == 0) break;
        trial *= 4.0;
      }
      shift = 0.25 * trial;
    }
    if (!factored) {
      report.termination = numerics::Termination::singular_matrix;
      report.message = "the tangent stiffness of the rod is singular";
      return report;
    }
    Eigen::VectorXd step = -assembly.gradient;
    factor.solve(step);
    // No vertex moves more than a tenth of the length at once, no edge turns more than 0.1 rad.
    double far = 0.0;
    for (Eigen::Index i = 0; i < step.size(); ++i) {
      far = std::max(far, std::abs(step[i]) / (is_angle(i) ? 0.1 : 0.1 * length));
    }
    if (far > 1.0) step /= far;

    const double old_energy = assembly.energy;
    const double old_residual = residual;
    const double slope = assembly.gradient.dot(step);
    const State start = state;
    double fraction = 1.0;
    bool accepted = false;
    for (int k = 0; k < 30; ++k, fraction *= 0.5) {
      state = start;
      advance(state, fraction * step);
      residual = evaluate(state);
      if (!std::isfinite(residual)) continue;
      // Near the end energies differ by round-off only: a falling residual then is enough.
      accepted = residual <= 0.5 * old_residual && options.branch == Branch::nearest;
      accepted = accepted || (options.branch == Branch::stable &&
                              assembly.energy <= old_energy + 1e-4 * fraction * slope);
      accepted =
          accepted || (std::abs(fraction * slope) < 1e-12 * std::abs(old_energy) && residual < old_residual);
      accepted = accepted ||
                 (options.branch == Branch::nearest && residual < (1.0 - 1e-4 * fraction) * old_residual);
      if (accepted) break;
    }
    if (!accepted) {
      state = start;
      residual = evaluate(state);
      report.residual_norm = residual;
      if (residual <= 100.0 * allowed && (options.branch == Branch::nearest || report.negative_pivots <= 0)) {
        report.termination = numerics::Termination::converged;  // stalled on round-off
        return report;
      }
      report.termination = numerics::Termination::step_too_small;
      report.message = "no step lowers the energy of the rod";
      return report;
    }
  }
  report.termination = numerics::Termination::iteration_limit;
  report.message = "the equilibrium of the rod was not reached in the allowed iterations";
  return report;
}

}  // namespace snare::wire
