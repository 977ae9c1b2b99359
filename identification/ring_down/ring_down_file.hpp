#pragma once

#include "coupling/statics/push_problem.hpp"
#include "identification/ring_down/ring_down.hpp"
#include "base/toml_tree.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// One recorded ring-down with what is known of its modes.
struct RingDownSeries {
  RingDown data;
  std::vector<double> bending_share;  ///< of its modes by frequency; empty: computed from the wire, or 1
};

/// Free vibrations of one wire.                                                    docs/ringdown_file.md
struct RingDownFile {
  std::string title, source;
  std::filesystem::path file;
  /// The wire and its mounts, where declared: the shares of its modes are then computed.
  std::optional<coupling::PushProblem> wire;
  std::vector<RingDownSeries> series;
};

/// Reads and checks a file and the CSV files that it names. Throws InputError with everything that is wrong.
[[nodiscard]] RingDownFile read_ring_down_file(const std::filesystem::path& file,
                                               const std::vector<base::Override>& overrides = {});

/// A mode of a record beside the nearest one of the declared wire.
struct MatchedMode {
  std::size_t series = 0, mode = 0;  ///< indices
  DecayOfMode decay;                 ///< its bending_share: bending and axial together, one time for both
  double computed = 0.0;  ///< natural angular frequency of the wire's mode [rad/s]; 0: no wire declared
};

/// The significant modes of all series, for split_damping. fits: one a series. Throws InputError when the declared wire
/// has no rest.
[[nodiscard]] std::vector<MatchedMode> match_modes(const RingDownFile& file,
                                                   const std::vector<RingDownFit>& fits);

/// split_damping of these, with a word where a frequency is more than a fifth off the wire's.
[[nodiscard]] DampingSplit split_damping(const std::vector<MatchedMode>& modes);

}  // namespace snare::identification
