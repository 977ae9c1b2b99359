#pragma once

#include <string>
#include <string_view>

namespace snare::identification {

/// Why a numeric key of an experiment file cannot stand in fit.free, or which number stands for it there;
/// empty for other keys.
/// key: as in the file, "wire.poisson_ratio", or of a series, "series[NAME].contact_position_mm".
[[nodiscard]] std::string why_not_fitted(std::string_view key);

}  // namespace snare::identification
