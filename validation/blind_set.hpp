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
  /// Of its change of the forces over the errors of reading and placing, after the best fit of the base
  /// model's numbers: the norm of V^(-1/2) (projected change); of several, each alone, the smallest.
  double size = 0.0;
  std::string key;                 ///< of the (first) effect's first number; empty: it is in no catalogue
  double truth = 0.0;              ///< of that number, in its unit
  double bending_stiffness = 0.0;  ///< true [N m^2]
  double axial_stiffness = 0.0;    ///< true [N]
};

/// How the readings of a blind set are taken, and what of them the laboratory does not know.
struct BlindDesign {
  int readings_a_leg = 20;  ///< a divisor of 40, or more; sizes are counted over 20
  /// Standard deviation of the wire's length about the declared one [m]; where it is.
  double length_deviation = 0.0;
  ///< > 0 the length is freed as well
  double position_deviation = 0.0;  ///< of every push's position about the declared one [m]; declared as well
  /// Of three pushes so many records each, every one with a deviation of its own that goes with the force and
  /// is correlated over a quarter of the travel, 1 % of it, beside the noise; nothing of this is declared. 1:
  /// six pushes, one record each, with noise alone.
  int replicates = 1;
};

/// Effects that can be put in; the last two are in no catalogue: a stretch of the wire that is softer in
/// bending, and a reading of the force that drifts with time.
[[nodiscard]] const std::vector<std::string>& blind_effects();

/// The names in "a+b".
[[nodiscard]] std::vector<std::string> effects_in(const std::string& name);

/// Three positions, two slacks, load and unload at two speeds, normal noise; EI and EA of the wire off the
/// declared ones by about 10 %. effect: one, or several joined by "+", each alone of that size. The same seed
/// gives the same wire for every effect and size. size: wanted, > 0, in standard deviations of the noise (see
/// BlindSet); effects with a largest size (a slipping mount) stay below it where they must. "none" ignores
/// it. The design changes neither the wire nor the noise of the readings that two designs share.
[[nodiscard]] BlindSet make_blind_set(const std::string& effect, double size, unsigned seed,
                                      const BlindDesign& design = {});

}  // namespace snare::validation
