#pragma once

#include "identification/fitting/experiment.hpp"

#include <cstddef>
#include <vector>

namespace snare::identification {

/// Series of one test (place, wire, mounts, pusher), as indices, at any speed. Every series is in one group.
[[nodiscard]] std::vector<std::vector<std::size_t>> tests(const std::vector<Series>& series);

/// Series of one condition, as indices: the same test, at speeds that differ by less than a half. Every
/// series is in one group.
[[nodiscard]] std::vector<std::vector<std::size_t>> conditions(const std::vector<Series>& series);

}  // namespace snare::identification
