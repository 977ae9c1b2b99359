#pragma once

#include "identification/ring_down/damping_split.hpp"
#include "identification/ring_down/ring_down_file.hpp"

#include <optional>
#include <vector>

namespace snare::identification {

/// A mode of a record beside the nearest one of the declared wire.
struct MatchedMode {
  std::size_t series = 0, mode = 0;  ///< indices
  DecayOfMode decay;                 ///< its bending_share: bending and axial together, one time for both
  double computed = 0.0;  ///< natural angular frequency of the wire's mode [rad/s]; 0: no wire declared
  /// What the mesh does to the frequency of that mode, see coupling::add_mesh_errors [Hz]; none: no wire, or
  /// not known.
  std::optional<double> computed_error;
  Eigen::VectorXd covariance;  ///< of its decay with those of all modes of its record [1/s^2]
};

/// The significant modes of all series, for split_damping. fits: one a series. Throws InputError when the
/// declared wire has no rest.
[[nodiscard]] std::vector<MatchedMode> match_modes(const RingDownFile& file,
                                                   const std::vector<RingDownFit>& fits);

/// split_damping of these, with a warning where a frequency is more than a fifth off the wire's.
[[nodiscard]] DampingSplit split_damping(const std::vector<MatchedMode>& modes);

}  // namespace snare::identification
