#pragma once

#include "identification/fitting/data.hpp"
#include "identification/fitting/experiment.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace snare::identification {

/// Replaces readings that were never published by the law itself at its travels. Only its four numbers count
/// (Noise::published), so that a curve may leave the parabola as the readings did. Returns whether there was
/// any.
[[nodiscard]] bool replace_laws(std::vector<Series>& series);

/// Refuses series that cannot be traced: without readings, with the same force throughout, with forces that
/// do not follow the travel. Throws base::InputError naming them all. heldout: one a series; these need only
/// readings.
void check_readings(const std::filesystem::path& file, const std::vector<Series>& series,
                    const std::vector<bool>& heldout);

/// What is traced: the experiment with laws replaced by readings, divided into fitted and held-out series.
/// Refuses what check_readings() refuses.
struct Division {
  explicit Division(const Experiment& experiment);

  bool from_laws = false;
  std::vector<Series> all;
  std::vector<bool> is_heldout;  ///< one a series of `all`
  std::vector<Series> fitted, heldout;
};

/// The readings of the fitted series with their declared noise.
[[nodiscard]] Data data_of(const std::vector<Series>& fitted, PublishedScatter scatter);

/// Numbers that are fitted when the experiment names none: the two stiffnesses, on supports that of bending.
[[nodiscard]] std::vector<std::string> default_free(const Experiment& experiment);

}  // namespace snare::identification
