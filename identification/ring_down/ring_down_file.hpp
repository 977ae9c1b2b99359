#pragma once

#include "base/toml_tree.hpp"
#include "coupling/statics/push_problem.hpp"
#include "identification/ring_down/ring_down.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// One recorded ring-down with what is known of its modes.
struct RingDownSeries {
  RingDown data;
  std::vector<double> bending_share;  ///< of its modes by frequency; empty: computed from the wire, or 1 [-]
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

}  // namespace snare::identification
