#pragma once

#include "identification/fitting/experiment.hpp"
#include "validation/blind_wire.hpp"

#include <string>
#include <vector>

namespace snare::validation {

/// A set of readings with one effect inside that its declared model lacks. Made with the continuous wire of
/// blind_wire.hpp: nothing of the solver under test is in it but the form of the experiment.
struct BlindSet {
  identification::Experiment experiment;
  std::string effect;   ///< what is inside: a name of the catalogue, "none", "damage" or "drift"; several
                        ///< with "+" between them
  double amount = 0.0;  ///< of the (first) effect, in its own measure
  double size = 0.0;    ///< of its change of the forces over the noise of one reading, after the best fit of the base
      ///< model's numbers: sqrt(sum (projected change / sigma)^2); of several, each alone, the smallest
  double bending_stiffness = 0.0;  ///< true [N m^2]
  double axial_stiffness = 0.0;    ///< true [N]
};

/// Effects that can be put in; the last two are in no catalogue: a stretch of the wire that is softer in
/// bending, and a reading of the force that drifts with time.
[[nodiscard]] const std::vector<std::string>& blind_effects();

/// The names in "a+b".
[[nodiscard]] std::vector<std::string> effects_in(const std::string& name);

/// Three positions, two slacks, load and unload at two speeds, normal noise; EI and EA of the wire off the
/// declared ones by about 10 %. effect: one, or several joined by "+", each alone of that size. The same seed gives the same wire for
/// every effect and size. size: wanted, > 0, in standard deviations of the noise (see BlindSet); effects with a largest size (a slipping
/// mount) stay below it where they must. "none" ignores it.
[[nodiscard]] BlindSet make_blind_set(const std::string& effect, double size, unsigned seed);

}  // namespace snare::validation
