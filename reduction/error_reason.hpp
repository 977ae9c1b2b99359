#pragma once

#include <string>
#include <vector>

namespace snare::reduction {

/// Why a model of a wire is off, in words: as stiff as so many wires, taut too early or too late, off by a
/// constant force, or of another form, and where. One of the first three is said where it takes away two
/// thirds of the root mean square error. Empty: the largest error is less than 5 % of the wire's range of
/// force.
///
/// travel [m], wire and model [N]: as many, in the order visited.
[[nodiscard]] std::string error_reason(const std::vector<double>& travel, const std::vector<double>& wire,
                                       const std::vector<double>& model);

}  // namespace snare::reduction
