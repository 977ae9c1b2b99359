#include "base/one_line.hpp"

#include "base/errors.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <string_view>

namespace snare::base {
namespace {

using namespace std::string_view_literals;

TEST(OneLine, LeavesTextAndReplacesWhatActs) {
  EXPECT_EQ(one_line("wire \u00e9\u4e2d \U0001F600 a\\b*/"), "wire \u00e9\u4e2d \U0001F600 a\\b*/");
  EXPECT_EQ(one_line("a\nb\rc\0d\x1b[31m\x7f."sv), "a b c d [31m .");
  // U+0085, U+2028, U+202E (text to the left), U+FFFE, U+1FFFF
  EXPECT_EQ(one_line("a\xC2\x85"
                     "b\xE2\x80\xA8"
                     "c\xE2\x80\xAE"
                     "d\xEF\xBF\xBE"
                     "e\xF0\x9F\xBF\xBF"
                     "f"),
            "a b c d e f");
  EXPECT_EQ(one_line("a\xff\xc3"), "a\uFFFD\uFFFD");
}

TEST(OneLine, MakesWhatActsVisible) {
  EXPECT_EQ(visible("a\x1b]0;b\x07"), "a\\x1b]0;b\\x07");
  EXPECT_EQ(visible("\xC2\x9B"
                    "31m \xE2\x80\xAE"),
            "\\x9b31m \\u202e");
  EXPECT_EQ(visible_lines("a\nb\x1b\n"), "a\nb\\x1b\n");
}

// What a shell makes of the word, for every byte but 0 that a file name can have.
TEST(OneLine, AShellReadsTheWordBack) {
  for (const std::string text : {"wire.toml", "", "it's", "a b;rm -rf $HOME `x` \"y\" \\ * ? ~ #", "-n",
                                 "a\nb\tc", "set[s40].x=\"1\""}) {
    const std::string command = "printf %s. " + shell_word(text);
    std::FILE* pipe = popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string answer;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) answer += static_cast<char>(c);
    pclose(pipe);
    EXPECT_EQ(answer, text + ".");
  }
  EXPECT_EQ(shell_word("out/wire-1.toml"), "out/wire-1.toml");
}

// A key with an escape sequence does not reach the terminal.
TEST(OneLine, MessagesShowWhatActs) {
  const InputProblem problem{"x\x1b.toml", 3, "wire.\x1b[31mred", "\r9", "is no key"};
  EXPECT_EQ(problem.message(), "x\\x1b.toml:3: wire.\\x1b[31mred = \\x0d9, is no key");
}

}  // namespace
}  // namespace snare::base
