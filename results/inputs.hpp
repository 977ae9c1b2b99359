#pragma once

#include <nlohmann/json_fwd.hpp>

namespace snare::results {

/// A document with `inputs`: the files that this work has read, each with the SHA-256 of what was read.
[[nodiscard]] nlohmann::json with_inputs(nlohmann::json document);

}  // namespace snare::results
