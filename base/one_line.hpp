#pragma once

#include <string>
#include <string_view>

namespace snare::base {

// Text of a user's file in places where some characters would act: comments of generated sources, XML,
// messages on a terminal. What would
// act: control characters (U+0000-U+001F, U+007F-U+009F), line and paragraph separators, marks that turn the
// direction of text, non-characters (U+FFFE, ...) and bytes that are not UTF-8.

/// The text with a space for each of these characters, U+FFFD for a byte that is not UTF-8: one line that
/// every language and XML accept.
[[nodiscard]] std::string one_line(std::string_view text);

/// The text with an escape for each of these characters ("\x1b", "\u2028"), for messages.
[[nodiscard]] std::string visible(std::string_view text);

/// The same line by line: line feeds stay.
[[nodiscard]] std::string visible_lines(std::string_view text);

/// The text as one word of a POSIX shell, which stands for exactly these bytes: in quotes where it needs
/// them.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace snare::base
