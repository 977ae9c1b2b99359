#pragma once

#include "identification/ring_down/estimate.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// One decay rate for the split: 2 s = mass_rate + bending_time share w^2.                    theory.md (M.4)
struct DecayOfMode {
  double natural = 0.0;        ///< w [rad/s], > 0
  double bending_share = 1.0;  ///< of the mode's stiffness that bends material: 1 for a straight wire without tension
  Estimate decay;              ///< s [1/s]
};

/// Material and mass-proportional damping from decay rates.
struct DampingSplit {
  bool separated = false;    ///< two frequencies far enough apart
  Estimate bending_time;     ///< [s]; not separated: the value if all were material
  Estimate mass_rate;        ///< [1/s]; not separated: the value if all were mass-proportional
  double correlation = 0.0;  ///< of the two estimates [-]
  double misfit_p = 1.0;     ///< P(chi2 beyond what is left) where there are more modes than numbers [-]
  std::string statement;     ///< in words: what is known and what is not
};
[[nodiscard]] DampingSplit split_damping(const std::vector<DecayOfMode>& decays);

}  // namespace snare::identification
