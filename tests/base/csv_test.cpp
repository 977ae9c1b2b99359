#include "base/csv.hpp"

#include "base/errors.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace snare::base {
namespace {

const std::vector<CsvColumn> columns{
    {"displacement_mm", CsvColumn::Presence::required, Range::from(-1000.0, 1000.0), 1e-3},
    {"force_N"},
    {"time_s", CsvColumn::Presence::optional, Range::finite(), 1.0, CsvColumn::Order::non_decreasing}};

// A record may give one column to two sensors, or choose its rows by a column that it reads.
TEST(Csv, AColumnMayBeAskedForSeveralTimes) {
  const CsvTable table =
      parse_csv("m.csv", "b,a\n1,2\n3,4\n",
                {{"a"}, {"b"}, {"a", CsvColumn::Presence::required, Range::finite(), 1e-3}, {"a"}});
  EXPECT_EQ(table.columns[0], (std::vector<double>{2.0, 4.0}));
  EXPECT_EQ(table.columns[1], (std::vector<double>{1.0, 3.0}));
  EXPECT_EQ(table.columns[2], (std::vector<double>{0.002, 0.004}));
  EXPECT_EQ(table.columns[3], table.columns[0]);
  EXPECT_EQ(test::refusal([] {
              static_cast<void>(parse_csv("m.csv", "a\n-1\n",
                                          {{"a"}, {"a", CsvColumn::Presence::required, Range::above(0.0)}}));
            }),
            "m.csv:2: a = -1, must be > 0");
}

class CsvFiles : public test::FolderFixture {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return FolderFixture::path(name).string(); }
  [[nodiscard]] std::string message_of(const std::string& name) const {
    return test::refusal([&] { return read_csv(path(name), columns); });
  }
};

std::string message_of_text(const std::string& text) {
  return test::refusal([&] { return parse_csv("m.csv", text, columns); });
}

struct Accepted {
  const char* what;
  std::string text;
};

class AcceptedCsv : public testing::TestWithParam<Accepted> {};

TEST_P(AcceptedCsv, HasTheSameTwoRows) {
  const CsvTable table = parse_csv("m.csv", GetParam().text, columns);
  ASSERT_EQ(table.rows, 2u);
  // Exact: a millimetre value is divided by 1000, which rounds to the double nearest to the decimal value.
  EXPECT_EQ(table.columns[0], (std::vector<double>{0.0001, 0.18}));
  EXPECT_EQ(table.columns[1], (std::vector<double>{-0.5, 2500.0}));
}

INSTANTIATE_TEST_SUITE_P(
    Forms, AcceptedCsv,
    testing::Values(
        Accepted{"plain", "displacement_mm,force_N\n0.1,-0.5\n180,2500\n"},
        Accepted{"no line feed at the end", "displacement_mm,force_N\n0.1,-0.5\n180,2500"},
        Accepted{"CRLF", "displacement_mm,force_N\r\n0.1,-0.5\r\n180,2500\r\n"},
        Accepted{"byte order mark",
                 "\xEF\xBB\xBF"
                 "displacement_mm,force_N\n0.1,-0.5\n180,2500\n"},
        Accepted{"byte order mark, CRLF",
                 "\xEF\xBB\xBF# a\r\ndisplacement_mm,force_N\r\n0.1,-0.5\r\n180,2500\r\n"},
        Accepted{"comments anywhere",
                 "# a\n  # b, c\ndisplacement_mm,force_N # d\n#\n0.1,-0.5#e\n180,2500\n# f"},
        Accepted{
            "a comment in UTF-8",
            "# 0,1 \xC2\xB5m \xE5\x8A\x9B \xF0\x9F\x94\xA9\ndisplacement_mm,force_N\n0.1,-0.5\n180,2500\n"},
        Accepted{"blank lines", "\n\ndisplacement_mm,force_N\n\n0.1,-0.5\n   \n180,2500\n\n"},
        Accepted{"blanks around cells", " displacement_mm ,\tforce_N\n 0.1 , -0.5\n180 ,2500  \n"},
        Accepted{"other order", "force_N,displacement_mm\n-0.5,0.1\n2500,180\n"},
        Accepted{"other columns", "id,displacement_mm,note,force_N\na,0.1,nan,-0.5\n,180,,2500\n"},
        Accepted{"quotes",
                 "\"displacement_mm\",\"force_N\",\"a, # b\"\n0.1,-0.5,\"c, d\"\n\"180\",2500,# e\n"},
        Accepted{"semicolons and decimal commas", "displacement_mm;force_N\n0,1;-0,5\n180;2500,0\n"},
        Accepted{"decimal commas in quotes", "displacement_mm,force_N\n\"0,1\",\"-0,5\"\n\"180\",\"2500\"\n"},
        Accepted{"tabs", "displacement_mm\tforce_N\n0.1\t-0.5\n180\t2500\n"},
        Accepted{"blanks", "displacement_mm  force_N\n 0.1 -0.5\n180\t2500 \n"},
        Accepted{"a declared separator", "sep=;\r\nforce_N;displacement_mm\r\n-0.5;0.1\r\n2500;180\r\n"},
        Accepted{"line ends of CR", "displacement_mm,force_N\r0.1,-0.5\r180,2500\r"},
        Accepted{"mixed line ends", "displacement_mm,force_N\r0.1,-0.5\r\n180,2500\n"},
        Accepted{"titles above the header",
                 "Test 7\n\"Operator\",\"N. N.\"\ndisplacement_mm,force_N\n0.1,-0.5\n180,2500\n"},
        Accepted{"units below the header", "displacement_mm,force_N\n(mm),[N]\n0.1,-0.5\n180,2500\n"},
        Accepted{"empty cells at the end", "displacement_mm,force_N\n0.1,-0.5,\n180,2500,,\n,\n,,\n"},
        Accepted{"an empty name at the end", "displacement_mm,force_N,\n0.1,-0.5\n180,2500,\n"},
        Accepted{"the end of a file of DOS", "displacement_mm,force_N\r\n0.1,-0.5\r\n180,2500\r\n\x1A"},
        Accepted{"forms of numbers", "displacement_mm,force_N\n1e-1,-.5\n+1.8E+2,2500.\n"}));

TEST(Csv, OptionalColumnIsEmptyWhenAbsentAndReadWhenPresent) {
  EXPECT_TRUE(parse_csv("m.csv", "displacement_mm,force_N\n1,2\n", columns).columns[2].empty());
  const CsvTable table =
      parse_csv("m.csv", "time_s,displacement_mm,force_N\n0,1,2\n0,2,3\n0.5,1,2\n", columns);
  EXPECT_EQ(table.columns[2], (std::vector<double>{0.0, 0.0, 0.5}));
}

struct Wrong {
  std::string text;
  const char* message;
};

class WrongCsv : public testing::TestWithParam<Wrong> {};

TEST_P(WrongCsv, HasItsMessage) {
  EXPECT_EQ(message_of_text(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Table, WrongCsv,
    testing::Values(
        Wrong{"", "m.csv: is empty, must have a header that names the columns"},
        Wrong{"\xEF\xBB\xBF\n# only a comment\n\n",
              "m.csv: is empty, must have a header that names the columns"},
        Wrong{"displacement_mm,force_N\n", "m.csv: has a header but no rows"},
        Wrong{"# a\ndisplacement_mm,force\n1,2\n",
              "m.csv:2: force_N, no such column; the file has \"displacement_mm\", \"force\"; the nearest is "
              "\"force\""},
        Wrong{"1.0,2.0\n3.0,4.0\n",
              "m.csv:1: displacement_mm, no such column; the first line that is not a comment must name the "
              "columns\n"
              "m.csv:1: force_N, no such column; the first line that is not a comment must name the columns"},
        Wrong{"displacement_mm,force_N,force_N\n1,2,3\n", "m.csv:1: force_N, the column is there twice"},
        Wrong{"displacement_mm,force_N\n1,2\n1,two\n", "m.csv:3: force_N = two, must be a number"},
        Wrong{"displacement_mm,force_N\n1,0x10\n", "m.csv:2: force_N = 0x10, must be a number"},
        Wrong{"displacement_mm,force_N\n1,2 N\n", "m.csv:2: force_N = 2 N, must be a number"},
        Wrong{"displacement_mm,force_N\n1,+-2\n", "m.csv:2: force_N = +-2, must be a number"},
        Wrong{"displacement_mm,force_N\n1,a\tb\x01\n", "m.csv:2: force_N = a\\x09b\\x01, must be a number"},
        Wrong{"displacement_mm,force_N\n1,\n", "m.csv:2: force_N, the cell is empty, must be a number"},
        Wrong{"displacement_mm,force_N\n1,nan\n", "m.csv:2: force_N = nan, must be a finite number"},
        Wrong{"displacement_mm,force_N\n1,-inf\n", "m.csv:2: force_N = -inf, must be a finite number"},
        Wrong{"displacement_mm,force_N\n1,1e999\n", "m.csv:2: force_N = 1e999, must be a finite number"},
        Wrong{"displacement_mm,force_N\n1000.5,1\n",
              "m.csv:2: displacement_mm = 1000.5, must be >= -1000 and <= 1000"},
        Wrong{"displacement_mm,force_N\n1,2\n1\n", "m.csv:3: the row has 1 cells, must have 2 as the header"},
        Wrong{"displacement_mm,force_N\n0,1,2,3\n",
              "m.csv:2: the row has 4 cells, must have 2 as the header"},
        Wrong{"displacement_mm,force_N\n0,1,two\n",
              "m.csv:2: the row has 3 cells, must have 2 as the header"},
        Wrong{"displacement_mm;force_N\n1,234;2,500\n9,123;7,100\n",
              "m.csv:2: displacement_mm = 1,234, may have its comma before decimals or between thousands: "
              "must have a "
              "decimal "
              "point"},
        Wrong{"displacement_mm;force_N\n0,5;2.5\n",
              "m.csv:2: force_N = 2.5, has a point, numbers before it a decimal comma: must have a comma"},
        Wrong{"displacement_mm,force_N\n0.5,\"2,5\"\n",
              "m.csv:2: force_N = 2,5, has a comma, numbers before it a decimal point: must have a decimal "
              "point and no "
              "other separator"},
        Wrong{"displacement_mm,force_N\n0.5,\"2,410.0\"\n",
              "m.csv:2: force_N = 2,410.0, must be a number without separators between thousands"},
        Wrong{"displacement_mm,force_N,time_s\n1,2,0.5\n1,2,0.4\n",
              "m.csv:3: time_s = 0.4, must be >= 0.5, the value of the row before"},
        Wrong{"displacement_mm,force_N\n1,\xFF\n", "m.csv:2: byte 0xff is not UTF-8: save the file as UTF-8"},
        Wrong{"displacement_mm,force_N\n1,2 # \xC3(\n",
              "m.csv:2: byte 0xc3 is not UTF-8: save the file as UTF-8"},
        Wrong{std::string("\xFF\xFE"
                          "d\0i\0s\0\n\0",
                          10),
              "m.csv:1: is UTF-16, must be UTF-8: save it as CSV UTF-8"},
        Wrong{"displacement_mm,force_N\n\none,two\n1,2\n3,nan\n",
              "m.csv:3: displacement_mm = one, must be a number\n"
              "m.csv:3: force_N = two, must be a number\n"
              "m.csv:5: force_N = nan, must be a finite number"},
        Wrong{"displacement_mm,force_N\n1,xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\n",
              "m.csv:2: force_N = xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx..., must be a number"},
        Wrong{std::string(csv_line_limit + 1, ' '), "m.csv:1: the line has more than 1048576 bytes"}));

/// Columns that the file which names this one may rename and scale.
std::vector<CsvColumn> renamed(const std::string& displacement, const std::string& force, double scale) {
  std::vector<CsvColumn> asked{{displacement}, {force}};
  asked[0].meaning = "displacement_mm";
  asked[1].meaning = "force_N";
  asked[1].unit = scale;
  asked[1].scaled = scale != 1.0;
  return asked;
}

TEST(Csv, ExportsOfMachinesAreReadByTheirNames) {
  const std::string bluehill =
      "\"Results Table "
      "1\"\n\"Time\",\"Extension\",\"Load\"\n\"(s)\",\"(mm)\",\"(kN)\"\n\"0.0\",\"0.3\",\"0.0241\"\n";
  const CsvTable table = parse_csv("m.csv", bluehill, renamed("Extension", "Load", 1000.0));
  EXPECT_EQ(table.columns[0], std::vector<double>{0.3});
  EXPECT_DOUBLE_EQ(table.columns[1][0], 24.1);
  // Without the scale the unit below the header is not that of a force in N.
  EXPECT_EQ(test::refusal([&] { return parse_csv("m.csv", bluehill, renamed("Extension", "Load", 1.0)); }),
            "m.csv:3: Load, is in kN, not in that of force_N: write scale = { \"Load\" = 1000 }");
  EXPECT_EQ(test::refusal([&] { return parse_csv("m.csv", bluehill, renamed("Load", "Extension", 1.0)); }),
            "m.csv:3: Extension, is in mm, must be in a unit like that of force_N\n"
            "m.csv:3: Load, is in kN, must be in a unit like that of displacement_mm");
  EXPECT_EQ(
      test::refusal([&] { return parse_csv("m.csv", bluehill, renamed("displacement_mm", "force_N", 1.0)); }),
      "m.csv:2: displacement_mm, no such column; the file has \"Time\", \"Extension\", \"Load\"; the nearest "
      "is "
      "\"Extension\"\n"
      "m.csv:2: force_N, no such column; the file has \"Time\", \"Extension\", \"Load\"; the nearest is "
      "\"Load\"; "
      "if so, write columns = { \"Extension\" = \"displacement_mm\", \"Load\" = \"force_N\" } and "
      "scale = { \"Load\" = 1000 }");
  EXPECT_EQ(test::refusal([&] {
              return parse_csv("m.csv", "displacement_m,Force_N\n1,2\n",
                               renamed("displacement_mm", "force_N", 1.0));
            }),
            "m.csv:1: displacement_mm, no such column; the file has \"displacement_m\", \"Force_N\"; the "
            "nearest is "
            "\"displacement_m\"\n"
            "m.csv:1: force_N, no such column; the file has \"displacement_m\", \"Force_N\"; the nearest is "
            "\"Force_N\"; if so, write columns = { \"displacement_m\" = \"displacement_mm\", "
            "\"Force_N\" = \"force_N\" } and scale = { \"displacement_m\" = 1000 }");
}

TEST(Csv, ListsTheFirstProblemsOnly) {
  std::string text = "displacement_mm,force_N\n";
  for (int i = 0; i < 1000; ++i) text += "1,x\n";
  try {
    static_cast<void>(parse_csv("m.csv", text, columns));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), csv_problem_limit + 1);
    EXPECT_EQ(error.problems().back().message(), "m.csv:22: and more: only the first problems are listed");
  }
}

TEST_F(CsvFiles, FileThatCannotBeReadHasItsMessage) {
  EXPECT_EQ(message_of("none.csv"), path("none.csv") + ": no such file");
  std::filesystem::create_directory(path("folder.csv"));
  EXPECT_EQ(message_of("folder.csv"), path("folder.csv") + ": is a directory, must be a file");
  EXPECT_EQ(message_of("none/a.csv"), path("none/a.csv") + ": no such file");
  ASSERT_EQ(::mkfifo(path("pipe.csv").c_str(), 0600), 0);
  EXPECT_EQ(message_of("pipe.csv"),
            path("pipe.csv") + ": is a device, a pipe or a socket, must be a regular file");
}

TEST_F(CsvFiles, UnreadableFileHasItsMessage) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser reads every file";
  write("a.csv", "displacement_mm,force_N\n1,2\n");
  std::filesystem::permissions(path("a.csv"), std::filesystem::perms::none);
  EXPECT_EQ(message_of("a.csv"), path("a.csv") + ": cannot be read (Permission denied)");
}

/// Rows cross the borders of the reader's buffer at every offset; a parser that loses or doubles a byte there
/// returns other numbers.
TEST_F(CsvFiles, RowsAcrossBuffersAreKept) {
  std::mt19937_64 random(20240611);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  std::vector<double> expected;
  std::string text = "time_s,displacement_mm,force_N\n";
  for (int i = 0; i < 200'000; ++i) {  // about 8 MB
    const double displacement = value(random);
    const double force = 1e3 * value(random);
    expected.push_back(force);
    char row[128];
    std::snprintf(row, sizeof row, "%d,%.17g,%.17g%s", i, displacement, force, i % 3 == 0 ? "\r\n" : "\n");
    text += row;
    if (i % 1000 == 0) text += "# " + std::string(static_cast<std::size_t>(i % 97), '-') + " \xC2\xB5\n";
  }
  write("a.csv", text);
  EXPECT_EQ(read_csv(path("a.csv"), columns).columns[1], expected);  // 17 digits identify a double
}

TEST_F(CsvFiles, LineWithoutEndIsRefusedAndNotHeldInMemory) {
  write("a.csv", "displacement_mm,force_N\n" + std::string(3 * csv_line_limit, '1'));
  EXPECT_EQ(message_of("a.csv"), path("a.csv") + ":2: the line has more than 1048576 bytes");
}

TEST_F(CsvFiles, WriterRoundTripsExactly) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  std::vector<double> values{0.0,
                             -0.0,
                             0.1,
                             1.0 / 3.0,
                             std::numeric_limits<double>::denorm_min(),
                             std::numeric_limits<double>::max(),
                             -1e22};
  for (int i = 0; i < 1000; ++i) values.push_back(std::pow(10.0, exponent(random)));
  CsvWriter writer(path("a.csv"), {"series", "force_N", "iterations", "measured_N"}, {"unit: N"});
  for (const double value : values) writer.row({"s,4\"0", value, 3LL, std::monostate{}});
  EXPECT_FALSE(std::filesystem::exists(path("a.csv")));
  writer.commit();
  EXPECT_EQ(contents("a.csv").substr(0, 76),
            "# unit: N\nseries,force_N,iterations,measured_N\n\"s,4\"\"0\",0,3,\n\"s,4\"\"0\",-0,3,\n");
  // The smallest subnormal reads back too: it is in the range of a double.
  EXPECT_EQ(read_csv(path("a.csv"), {{"force_N"}}).columns[0], values);
}

TEST_F(CsvFiles, WriterRefusesWhatIsNotFiniteAndLeavesNothingBehind) {
  write("a.csv", "before");
  {
    CsvWriter writer(path("a.csv"), {"x", "force_N"});
    writer.row({1.0, 2.0});
    try {
      writer.row({1.0, std::nan("")});
      FAIL() << "written";
    } catch (const std::domain_error& error) {
      EXPECT_EQ(error.what(), path("a.csv") + ": row 2, force_N = nan: not finite, not written");
    }
    EXPECT_THROW(writer.row({std::numeric_limits<double>::infinity(), 2.0}), std::domain_error);
  }
  EXPECT_EQ(contents("a.csv"), "before");
  const std::filesystem::path folder = std::filesystem::path(path("a.csv")).parent_path();
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

using SlowCsvFiles = CsvFiles;

TEST_F(SlowCsvFiles, TenMillionRows) {
  constexpr std::size_t rows = 10'000'000;
  {
    std::ofstream file(path("a.csv"), std::ios::binary);
    file << "time_s,displacement_mm,force_N\n";
    std::string block;
    for (std::size_t i = 0; i < rows; ++i) {
      char row[64];
      const int size = std::snprintf(row, sizeof row, "%zu.%02zu,%.5f,%zu.125\n", i / 100, i % 100,
                                     static_cast<double>(i % 4000) * 1e-3, i % 1000);
      block.append(row, static_cast<std::size_t>(size));
      if (block.size() > 1u << 20u) {
        file << block;
        block.clear();
      }
    }
    file << block;
  }
  const auto start = std::chrono::steady_clock::now();
  const CsvTable table = read_csv(path("a.csv"), columns);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  RecordProperty("seconds", std::to_string(elapsed.count()));
  ASSERT_EQ(table.rows, rows);
  EXPECT_EQ(table.columns[1][rows - 1], 999.125);
  EXPECT_EQ(table.columns[0][3999], 3.999 / 1000.0);
  EXPECT_EQ(table.columns[2][rows - 1], 99999.99);
  // 2 to 4 s in an optimised build; sanitisers and a busy machine may cost a factor of ten.
  EXPECT_LT(elapsed.count(), 60.0);
}

}  // namespace
}  // namespace snare::base
