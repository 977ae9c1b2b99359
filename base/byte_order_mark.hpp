#pragma once

#include <string_view>

namespace snare::base {

/// What some programs put before a text in UTF-8.
inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

}  // namespace snare::base
