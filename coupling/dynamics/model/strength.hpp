#pragma once

#include "numerics/dae.hpp"
#include "wire/specification.hpp"

#include <limits>
#include <optional>
#include <string>

namespace snare::wire {
class RodPart;
}

namespace snare::coupling {

/// What a wire bears.                                                                        theory.md (W.34)
struct WireStrength {
  double breaking_tension = std::numeric_limits<double>::infinity();  ///< of the straight wire [N], > 0
  /// Tension that strains it as much as a curvature of one does [N m], >= 0; 0: not counted.
  double bending_force = 0.0;
  bool ends_run = false;  ///< the run ends where it is reached
};

/// Of a wire that breaks at `breaking_tension` [N]. Of a solid one bending counts with E pi d^3/8; the wires
/// of a strand bend each on its own, by what they slide: there the tension alone counts.
[[nodiscard]] WireStrength wire_strength(const wire::WireSpecification& wire, double breaking_tension,
                                         bool ends_run);

/// The largest load on a wire at a time.
struct StrengthUse {
  double share = 0.0;    ///< of the strength that tension and bending take together; 0: has none [-]
  double tension = 0.0;  ///< there [N]
  double bending = 0.0;  ///< as tension [N]
  double arc = 0.0;      ///< where, material coordinate [m]
  double time = 0.0;     ///< [s]
};
/// At a state: the vertex where (T + b |M|/EI)/T_break is largest, T of the edge beside it, M bending, b
/// bending_force.
///                                                                                           theory.md (W.34)
[[nodiscard]] StrengthUse strength_use(const WireStrength& strength, wire::RodPart& rod,
                                       const numerics::DaePoint& at);

/// " reaches its strength of ...": of a use that does.
[[nodiscard]] std::string strength_reached(const WireStrength& strength, const StrengthUse& use);

/// Takes an accepted step into the largest use so far. Where the strength is reached and ends the run, says
/// so: " reaches ...".
[[nodiscard]] std::optional<std::string> watch_strength(const WireStrength& strength, wire::RodPart& rod,
                                                        const numerics::DaePoint& at, StrengthUse& largest);

}  // namespace snare::coupling
