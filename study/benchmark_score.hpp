#pragma once

#include <optional>
#include <vector>

namespace snare::study {

/// A quantity of a history: x grows (a time [s], a travel [mm]), q over it, both in the units of the history.
struct Track {
  std::vector<double> x, q;
};

/// How a track differs from another one, the reference.                                       theory.md (S.6)
struct TrackScore {
  double peak = 0.0;      ///< largest |q|, relative to that of the reference less one [-]
  double integral = 0.0;  ///< of q over x, less that of the reference, over the reference's of |q| [-]
  double rms = 0.0;       ///< of the difference, over that of the reference [-]
  /// where |q| first reaches a threshold, less the reference's, in the unit of x; none: one of them does not
  std::optional<double> touch;
  bool same_touch = true;  ///< both reach the threshold, or neither
  /// Share of the reference's range of x that the track has [-]; the others are of this share.
  double covered = 1.0;
};

/// Against a reference of at least two rows. `threshold`: of |q|, in its unit; none: touches are not looked
/// for. Throws std::invalid_argument where x falls, where a track has fewer than two rows or where they have
/// no range of x in common.
[[nodiscard]] TrackScore score_of(const Track& track, const Track& reference,
                                  std::optional<double> threshold);

/// First x at which |q| reaches a threshold [unit of q], straight between rows [unit of x]; none where it
/// does not.
[[nodiscard]] std::optional<double> first_reach(const Track& track, double threshold);

}  // namespace snare::study
