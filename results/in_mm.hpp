#pragma once

#include <vector>

namespace snare::results {

/// A length [m] as results name it [mm]: the decimal number of at most 15 digits that is this length to the last bit, so that
/// 1.3 mm of a file does not come back as 1.2999999999999998.
[[nodiscard]] double in_mm(double metres);
[[nodiscard]] std::vector<double> in_mm(std::vector<double> metres);

}  // namespace snare::results
