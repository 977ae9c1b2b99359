#pragma once

#include <vector>

namespace snare::results {

/// A length [m] as results name it [mm], an angle [rad] as they name it [deg]: without the tail that the
/// conversion of a decimal number leaves, see base::in_unit.
[[nodiscard]] double in_mm(double metres);
[[nodiscard]] std::vector<double> in_mm(std::vector<double> metres);
[[nodiscard]] double in_degrees(double radians);

}  // namespace snare::results
