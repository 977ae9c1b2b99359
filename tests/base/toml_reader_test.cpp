#include "base/toml_reader.hpp"

#include "base/errors.hpp"
#include "base/files.hpp"
#include "base/plain_name.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace snare::base {
namespace {

enum class Colour { red, green };
constexpr Choice<Colour> colours[] = {{"red", Colour::red}, {"green", Colour::green}};

using Read = std::function<void(TomlDocument&)>;

/// What finish() says after `read` has asked its questions.
std::string message_of(const std::string& text, const Read& read,
                       const std::vector<Override>& overrides = {}) {
  try {
    TomlDocument document("a.toml", text, overrides);
    read(document);
    document.finish();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TomlReader, ReadsEveryKindInSi) {
  TomlDocument document("a.toml",
                        "\xEF\xBB\xBF"
                        "whole = 180\r\nreal = 1.5\r\nangle = 90.0\r\ntext = 'a \xC2\xB5'\r\n"
                        "flag = true\r\ncolour = \"green\"\r\nlist = [1, 2.5]\r\nnames = ['x', \"y\"]\r\n"
                        "[sub.table]\r\ncount = 0x10\r\n[[item]]\r\nname = 'p'\r\n[[item]]\r\n");
  const TomlTable root = document.root();
  // A length in mm is divided by 1000, which rounds to the double nearest to the decimal value.
  EXPECT_EQ(root.number("whole", Range::above(0.0), 1e-3), 0.18);
  EXPECT_EQ(root.number("real", Range::finite(), 1e9), 1.5e9);
  EXPECT_NEAR(root.number("angle", Range::finite(), std::numbers::pi / 180.0), std::numbers::pi / 2.0,
              1e-15);  // a few roundings of a number of order one
  EXPECT_EQ(root.text("text"), "a \xC2\xB5");
  EXPECT_TRUE(root.boolean_or("flag", false));
  EXPECT_EQ(root.choice("colour", colours), Colour::green);
  EXPECT_EQ(root.numbers("list", 1, 3, Range::finite(), 1e-3), (std::vector<double>{0.001, 0.0025}));
  EXPECT_EQ(root.texts_or_none("names"), (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(root.table("sub").table("table").integer("count", 0, 20), 16);
  const std::vector<TomlTable> items = root.tables("item");
  ASSERT_EQ(items.size(), 2u);
  EXPECT_EQ(items[0].address(), "item[p]");
  EXPECT_EQ(items[1].address(), "item[2]");
  EXPECT_EQ(items[0].text("name"), "p");
  EXPECT_NO_THROW(document.finish());
}

TEST(TomlReader, AbsentKeysGiveTheirDefaults) {
  TomlDocument document("a.toml", "");
  const TomlTable root = document.root();
  EXPECT_EQ(root.number_or("a", 0.25, Range::above(0.0), 1e-3), 0.25);  // the default is in SI already
  EXPECT_EQ(root.optional_number("b", Range::finite()), std::nullopt);
  EXPECT_EQ(root.integer_or("c", 7, 1, 9), 7);
  EXPECT_TRUE(root.boolean_or("d", true));
  EXPECT_EQ(root.text_or("e", "none"), "none");
  EXPECT_TRUE(root.texts_or_none("f").empty());
  EXPECT_TRUE(root.tables("g").empty());
  EXPECT_EQ(root.table("h").table("i").integer_or("j", 3, 1, 9), 3);
  EXPECT_FALSE(root.has("k"));
  EXPECT_NO_THROW(document.finish());
}

TEST(TomlReader, EveryProblemIsListedByLine) {
  const Read read = [](TomlDocument& document) {
    const TomlTable root = document.root();
    EXPECT_TRUE(std::isnan(root.table("b").number("x", Range::above(0.0, 2.0))));
    EXPECT_TRUE(root.text("t").empty());
    EXPECT_EQ(root.integer("n", 1, 9), 1);
    EXPECT_EQ(root.choice("c", colours), std::nullopt);
    EXPECT_TRUE(std::isnan(root.number("missing", Range::from(-1.0))));
    EXPECT_TRUE(root.numbers("list", 2, 2, Range::finite()).empty());
    document.add({"other.csv", 3, "", "", "is odd"});
    document.add({"other.csv", 3, "", "", "is odd"});
  };
  EXPECT_EQ(
      message_of("t = 1\nn = 10\nc = \"blue\"\nlist = [1, '2']\nodd = {a = 1}\n[b]\nx = -5_0\n[table.more]\n",
                 read, {{"extra", "1"}}),
      "a.toml: missing, missing, must be a number >= -1\n"
      "a.toml:1: t = 1, must be a text in quotes\n"
      "a.toml:2: n = 10, must be an integer >= 1 and <= 9\n"
      "a.toml:3: c = \"blue\", must be \"red\" or \"green\"\n"
      "a.toml:4: list[2] = '2', must be a number\n"
      "a.toml:5: odd = {a = 1}, unknown key; known here: b, c, list, missing, n, t\n"
      "a.toml:7: b.x = -5_0, must be > 0 and <= 2\n"
      "a.toml:8: table, unknown key; known here: b, c, list, missing, n, t\n"
      "--set: extra = 1, unknown key; known here: b, c, list, missing, n, t\n"
      "other.csv:3: is odd");
}

TEST(TomlReader, NumbersThatAreNotFiniteAreRefused) {
  const Read read = [](TomlDocument& document) {
    for (const char* key : {"a", "b", "c"}) static_cast<void>(document.root().number(key, Range::finite()));
  };
  EXPECT_EQ(message_of("a = nan\nb = -inf\nc = +inf\n", read),
            "a.toml:1: a = nan, must be a finite number\n"
            "a.toml:2: b = -inf, must be a finite number\n"
            "a.toml:3: c = +inf, must be a finite number");
}

TEST(TomlReader, LongAndMultiLineValuesAreShortened) {
  const Read read = [](TomlDocument& document) {
    static_cast<void>(document.root().number("a", Range::finite()));
    static_cast<void>(document.root().number("b", Range::finite()));
  };
  EXPECT_EQ(message_of("a = '" + std::string(100, '.') + "'\nb = [1,\n2]\n", read),
            "a.toml:1: a = '" + std::string(59, '.') +
                "..., must be a number\na.toml:2: b = [1,..., must be a number");
}

TEST(TomlReader, UnknownKeysNameTheNearestKnownOne) {
  const Read read = [](TomlDocument& document) {
    static_cast<void>(document.root().table("wire").number_or("length_mm", 0.0, Range::finite()));
    static_cast<void>(document.root().table("mount").number_or("span_mm", 0.0, Range::finite()));
  };
  EXPECT_EQ(message_of("[wire]\nlenght_mm = 1\nspan_mm = 1\nqqqqqqq = 1\n[mount]\n", read),
            "a.toml:2: wire.lenght_mm = 1, unknown key; did you mean length_mm?\n"
            "a.toml:3: wire.span_mm = 1, unknown key; did you mean mount.span_mm?\n"
            "a.toml:4: wire.qqqqqqq = 1, unknown key; known here: length_mm");
}

TEST(TomlReader, FileFullOfProblemsIsRefusedAtOnce) {
  std::string text;
  while (text.size() < TomlDocument::size_limit - 100) text += "[[series]]\nq = 1\n";
  const std::string message = message_of(text, [](TomlDocument& document) {
    for (const TomlTable& series : document.root().tables("series")) static_cast<void>(series.text("name"));
  });
  // As many lines as problems, and one that says that there are more. A search for suggestions per problem
  // over all tables would take minutes.
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), TomlDocument::problem_limit);
  EXPECT_TRUE(message.ends_with("\na.toml: and more: only 100 problems are listed"));
}

TEST(TomlReader, NearestWordNeedsToBeNear) {
  const std::vector<std::string> words{"length_mm", "span_mm", "kind"};
  EXPECT_EQ(nearest_word("lenght_mm", words), "length_mm");
  EXPECT_EQ(nearest_word("lengthmm", words), "length_mm");
  EXPECT_EQ(nearest_word("knd", words), "kind");
  EXPECT_EQ(nearest_word("spam_m", words), "span_mm");
  EXPECT_EQ(nearest_word("colour", words), "");
  EXPECT_EQ(nearest_word("", words), "");
  EXPECT_EQ(nearest_word(std::string(100000, 'x'), words), "");
}

TEST(TomlReader, LayersFallBackAndReportWhereTheValueStands) {
  const std::string text = "[wire]\na = 1\nb = 2\n[[series]]\nname = 's'\nwire.b = 3\n";
  const auto layered = [](TomlDocument& document) {
    const TomlTable root = document.root();
    const TomlTable series = root.tables("series").at(0);
    static_cast<void>(series.text("name"));
    return series.table("wire").over(root.table("wire"));
  };
  TomlDocument document("a.toml", text);
  EXPECT_EQ(layered(document).number("a", Range::finite()), 1.0);
  EXPECT_EQ(layered(document).number("b", Range::finite()), 3.0);
  EXPECT_NO_THROW(document.finish());
  const Read read = [&](TomlDocument& other) {
    for (const char* key : {"a", "b", "c"}) static_cast<void>(layered(other).number(key, Range::above(9.0)));
    for (const char* key : {"a", "b", "c"}) layered(other).fail(key, "is odd");
  };
  EXPECT_EQ(message_of(text, read),
            "a.toml:1: wire.c, missing, must be a number > 9\n"
            "a.toml:2: wire.a = 1, must be > 9\n"
            "a.toml:2: wire.a = 1, is odd\n"
            "a.toml:6: series[s].wire.b = 3, must be > 9\n"
            "a.toml:6: series[s].wire.b = 3, is odd\n"
            "a.toml:6: series[s].wire.c, is odd");
}

TEST(TomlReader, MissingTablesAreReportedOnce) {
  const Read read = [](TomlDocument& document) {
    const TomlTable root = document.root();
    static_cast<void>(root.table("wire").number("a", Range::finite()));
    static_cast<void>(root.table("wire").number("b", Range::finite()));
    static_cast<void>(root.table("optional").number_or("c", 0.0, Range::finite()));
    static_cast<void>(root.table("mount").number("d", Range::finite()));
  };
  EXPECT_EQ(message_of("mount = 3\n", read),
            "a.toml: wire, missing, must be a table\na.toml:1: mount = 3, must be a table");
}

TEST(TomlOverride, ReplacesAndAddsValues) {
  const std::string text = "[wire]\na = 1\n[[series]]\nname = 's.40'\n[[series]]\nx = 2\n";
  TomlDocument document("a.toml", text,
                        {{"wire.a", "5"},
                         {"wire.word", "green"},
                         {"wire.quoted", "\"1\""},
                         {"wire.file", "40.csv"},
                         {"series[s.40].x", "3"},
                         {"series[2].x", "4.5"},
                         {"series[s.40].law.to", "[1, 2]"},
                         {"new.table.flag", "true"},
                         {"wire.inline", "{b = 1}"},
                         {"wire.equals", "a=b"}});
  const TomlTable root = document.root();
  const TomlTable wire = root.table("wire");
  EXPECT_EQ(wire.number("a", Range::finite()), 5.0);
  EXPECT_EQ(wire.choice("word", colours), Colour::green);
  EXPECT_EQ(wire.text("quoted"), "1");
  EXPECT_EQ(wire.text("file"), "40.csv");
  EXPECT_EQ(wire.text("equals"), "a=b");
  EXPECT_EQ(wire.table("inline").integer("b", 0, 9), 1);
  EXPECT_EQ(root.tables("series")[0].text("name"), "s.40");
  EXPECT_EQ(root.tables("series")[0].number("x", Range::finite()), 3.0);
  EXPECT_EQ(root.tables("series")[1].number("x", Range::finite()), 4.5);
  EXPECT_EQ(root.tables("series")[0].table("law").numbers("to", 2, 2, Range::finite()),
            (std::vector<double>{1.0, 2.0}));
  EXPECT_TRUE(root.table("new").table("table").boolean_or("flag", false));
  EXPECT_NO_THROW(document.finish());
}

TEST(TomlOverride, WhatCannotBeDoneIsReported) {
  const std::string text = "a = 1\n[[series]]\nname = 's40'\n[[series]]\n";
  const Read read = [](TomlDocument& document) {
    static_cast<void>(document.root().number("a", Range::above(0.0)));
    for (const TomlTable& series : document.root().tables("series"))
      static_cast<void>(series.text_or("name", ""));
  };
  const auto message = [&](const char* key, const std::string& value) {
    return message_of(text, read, {{key, value}});
  };
  EXPECT_EQ(message("a", "5"), "accepted");
  EXPECT_EQ(message("a", "-5"), "--set: a = -5, must be > 0");
  EXPECT_EQ(message("a", "nan"), "--set: a = nan, must be a finite number > 0");
  EXPECT_EQ(message("a", "5 mm"), "--set: a = 5 mm, must be a number > 0");
  EXPECT_EQ(message("a", "[1"), "--set: a = [1, the value must be a TOML literal or a bare word");
  EXPECT_EQ(message("a", "\"x"), "--set: a = \"x, the value must be a TOML literal or a bare word");
  EXPECT_EQ(message("a", "1\nb = 2"),
            R"(--set: a = 1\x0ab = 2, must be a number > 0)");  // no second key comes in
  EXPECT_EQ(message("a", "x\xFF"), R"(--set: a = x\xff, the value must be a TOML literal or a bare word)");
  EXPECT_EQ(message("a.b", "1"), "--set: a.b = 1, a is not a table");
  EXPECT_EQ(message("a[1]", "1"), "--set: a[1] = 1, a has no elements");
  EXPECT_EQ(message("b", "1"), "--set: b = 1, unknown key; known here: a, series");
  EXPECT_EQ(message("series[s41].name", "x"),
            "--set: series[s41].name = x, no such series; there are: s40, 2");
  EXPECT_EQ(message("series[0].name", "x"), "--set: series[0].name = x, no such series; there are: s40, 2");
  EXPECT_EQ(message("rows[1].name", "x"), "--set: rows[1].name = x, there is no [[rows]] in the file");
  EXPECT_EQ(message("series.name", "x"), "--set: series.name = x, series is not a table");
  for (const char* key :
       {"", ".", "a.", ".a", "a..b", "series[", "series[]", "series[s40", "series[s40]x", "a b", "]"})
    EXPECT_EQ(message(key, "1"),
              (*key != '\0' ? std::string("--set: ") + key + " = 1, " : std::string("--set: ")) +
                  "the key must be like wire.length_mm or series[s40].points");
}

TEST(TomlOverride, ArgumentIsSplitAtTheFirstEqualsSign) {
  const Override change = parse_override("wire.file=a=b");
  EXPECT_EQ(change.key, "wire.file");
  EXPECT_EQ(change.value, "a=b");
  for (const char* wrong : {"wire", "=3", "wire="}) {
    EXPECT_EQ(test::refusal([&] { return parse_override(wrong); }),
              std::string("--set: ") + wrong + ", must be key=value");
  }
}

TEST(TomlReader, TextThatIsNotTomlHasItsLine) {
  const Read nothing = [](TomlDocument&) {};
  EXPECT_EQ(message_of("a = 1\nb = \n", nothing),
            "a.toml:2: not TOML: Error while parsing key-value pair: expected value, saw '\\n'");
  EXPECT_EQ(message_of("a = 1\nb = 180 \xC2\xB5m\n", nothing),
            "a.toml:2: \xC2\xB5 must stand in quotes or in a comment");
  EXPECT_EQ(message_of("a = 'x\nb = \"\"\"y\n\"\"\"\"\xE5\x8A\x9B\n", nothing),
            "a.toml:3: \xE5\x8A\x9B must stand in quotes or in a comment");
  EXPECT_EQ(message_of("a = 1\n# \xE5\x8A\x9B\n# \xC3(\n", nothing), "a.toml:3: byte 0xc3 is not UTF-8");
}

TEST(TomlReader, CharactersThatTheLibraryCannotBearNeverReachIt) {
  const Read nothing = [](TomlDocument&) {};
  const std::string word = "\xC9\x9A";
  EXPECT_EQ(message_of("a = 7\"x" + word + "\"\n", nothing), "a.toml:1: not TOML: \" inside a word");
  EXPECT_EQ(message_of("a = 7='" + word + "'\n", nothing), "a.toml:1: not TOML: a second = after a key");
  EXPECT_EQ(message_of("\na = 7['" + word + "'\n", nothing), "a.toml:2: not TOML: [ inside a word");
  EXPECT_EQ(message_of("a = 7.'" + word + "'\n", nothing), "a.toml:1: not TOML: ' inside a word");
  EXPECT_EQ(message_of(
                "a=\"b\"\nc={d='e',f=[[1],[{g=2}]]}\n[h]\n'i'=1\n[[j]]\n\"k\".l=\"\"\"\n" + word + "\"\"\"\n",
                [](TomlDocument& document) {
                  for (const char* key : {"a", "c", "h", "j"}) EXPECT_TRUE(document.root().has(key));
                }),
            "accepted");
}

TEST(TomlReader, DeepNestingIsRefusedBeforeItExhaustsTheStack) {
  const Read nothing = [](TomlDocument&) {};
  std::string dots = "a";
  for (int i = 0; i < 100'000; ++i) dots += ".a";
  EXPECT_EQ(message_of("x = 1\n" + dots + " = 1\n", nothing), "a.toml:2: a key has more than 32 dots");
  EXPECT_EQ(message_of("[" + dots + "]\n", nothing), "a.toml:1: a key has more than 32 dots");
  const std::string brackets = "a = " + std::string(100'000, '[');
  EXPECT_TRUE(message_of(brackets, nothing).starts_with("a.toml:1: not TOML: "))
      << message_of(brackets, nothing);
  // Dots in texts and comments are no keys.
  const std::string many(200, '.');
  EXPECT_EQ(message_of("# " + many + "\n#" + many, nothing), "accepted");
  EXPECT_EQ(message_of("a = \"" + many + "\" # " + many + "\nb = '''\n" + many + "\\'''\n",
                       [](TomlDocument& document) {
                         static_cast<void>(document.root().text("a"));
                         static_cast<void>(document.root().text("b"));
                       }),
            "accepted");
}

TEST(TomlReader, FilesThatCannotBeReadHaveTheirMessage) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("snare_toml_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto message = [](const std::filesystem::path& path) -> std::string {
    try {
      TomlDocument document(path);
      document.finish();
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(folder), folder.string() + ": is a directory, must be a file");
  EXPECT_EQ(message(folder / "none.toml"), (folder / "none.toml").string() + ": no such file");
  write_text(folder / "long.toml", std::string(TomlDocument::size_limit + 1, '\n'));
  EXPECT_EQ(message(folder / "long.toml"),
            (folder / "long.toml").string() + ": has 1048577 bytes, must have at most 1048576");
  write_text(folder / "a.toml", "# nothing\n");
  EXPECT_EQ(message(folder / "a.toml"), "accepted");
  if (::geteuid() != 0) {  // the superuser reads every file
    std::filesystem::permissions(folder / "a.toml", std::filesystem::perms::none);
    EXPECT_EQ(message(folder / "a.toml"),
              (folder / "a.toml").string() + ": cannot be read (Permission denied)");
  }
  std::filesystem::remove_all(folder);
}

// What makes no difference to results makes none to a checkpoint's input, nor does the table that it would
// stand in.
TEST(TomlReader, ACanonicalTextWithoutAKey) {
  const auto canonical = [](const char* text) {
    return TomlDocument("a.toml", text).canonical("solver.least_advance_s");
  };
  EXPECT_EQ(canonical("a = 1\n[solver]\nleast_advance_s = 2.0\n"), canonical("a = 1\n"));
  EXPECT_EQ(canonical("[solver]\nleast_advance_s = 2.0\nb = 1\n"), canonical("[solver]\nb = 1\n"));
  EXPECT_NE(canonical("[solver]\nb = 2\n"), canonical("[solver]\nb = 1\n"));
}

// Names stand in pages, tables, addresses of keys and names of files.
TEST(TomlReader, PlainNames) {
  const auto problems = [](const std::string& name) {
    TomlDocument document("a.toml", "name = '''" + name + "'''\n");
    require_plain_name(document.root(), "name", document.root().text("name"));
    try {
      document.finish();
      return std::string();
    } catch (const InputError& error) {
      return error.problems().front().message();
    }
  };
  for (const char* good : {"a", "ball joint", "_x", "8.9 kg (slow)", "L\xc3\xa4ngs"})
    EXPECT_EQ(problems(good), "") << good;
  for (const char* bad :
       {"<b>", "a&b", "../x", "a/b", "a\\b", "a,b", "a[b]", "-a", " a", "a\tb", "a\"b", "a::b", ""})
    EXPECT_THAT(problems(bad), testing::HasSubstr("must be 1 to 64 letters")) << bad;
  EXPECT_NE(problems(std::string(65, 'a')), "");
}

}  // namespace
}  // namespace snare::base
