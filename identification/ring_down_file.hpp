#pragma once

#include "identification/ring_down.hpp"
#include "numerics/toml_tree.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace snare::identification {

/// One recorded ring-down with what is known of its modes.
struct RingDownSeries {
  RingDown data;
  std::vector<double> bending_share;  ///< of its modes by frequency; missing ones are 1
};

/// Free vibrations of one wire.                                                    docs/ringdown_file.md
struct RingDownFile {
  std::string title, source;
  std::filesystem::path file;
  std::vector<RingDownSeries> series;
};

/// Reads and checks a file and the CSV files that it names. Throws InputError with everything that is wrong.
[[nodiscard]] RingDownFile read_ring_down_file(const std::filesystem::path& file,
                                               const std::vector<numerics::Override>& overrides = {});

/// The decay rates of all significant modes of all series, for split_damping. fits: one a series.
[[nodiscard]] std::vector<DecayOfMode> decays_of(const RingDownFile& file, const std::vector<RingDownFit>& fits);

}  // namespace snare::identification
