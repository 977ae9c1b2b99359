#pragma once

#include "scenario/composition.hpp"
#include "scenario/outcome.hpp"

#include <optional>

namespace snare::scenario {

/// `[capture]`: none where the file has none.
[[nodiscard]] std::optional<CaptureTest> read_capture(const Composition& composition);

}  // namespace snare::scenario
