#pragma once

#include <string>
#include <string_view>

namespace snare::base {

/// SHA-256 (FIPS 180-4) of a text, as 64 hexadecimal digits: what `sha256sum` prints of a file with this
/// content.
[[nodiscard]] std::string sha256(std::string_view text);

}  // namespace snare::base
