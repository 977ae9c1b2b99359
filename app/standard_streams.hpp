#pragma once

#include <string_view>

namespace snare::app {

/// Text on standard error; what that does not take (a full disk, a reader that is gone) is lost, and the work
/// continues.
void tell(std::string_view text) noexcept;

/// Gives closed standard streams a descriptor, so that no file that is opened later takes their place.
/// Standard output stays without a taker: to write to it is a failure. To be called first of all.
void open_standard_streams() noexcept;

}  // namespace snare::app
