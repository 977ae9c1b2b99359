#include "study/rank_journal.hpp"

#include "base/errors.hpp"
#include "base/files.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace snare::study {
namespace {

class JournalTest : public test::FolderFixture {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder_ / "cases.journal"; }
};

TEST_F(JournalTest, KeepsResultsOverAnEnd) {
  {
    Journal journal(file(), "study 1", 10);
    journal.append(7, "[1,2]");
    journal.append(2, "x y");
    journal.append(7, "another");  // is there already
  }
  const Journal journal(file(), "study 1", 10);
  EXPECT_EQ(journal.finished(), 2U);
  EXPECT_EQ(journal.end(), 8U);
  EXPECT_EQ(journal.result(7), "[1,2]");
  EXPECT_EQ(journal.result(2), "x y");
  EXPECT_FALSE(journal.has(3));
  EXPECT_EQ(journal.result(3), std::nullopt);
}

// What a handler of signals appends is a line like any other.
TEST_F(JournalTest, LastWordsReadLikeOthers) {
  {
    Journal journal(file(), "s", 0);
    journal.append(4, "as ever");
    journal.append_at_the_end(12345678901234567890U, "[\"crashed\"]");
    journal.append_at_the_end(4, "is there already");
    journal.append_at_the_end(0, std::string(Journal::longest_last_words + 1, 'x'));
  }
  {
    Journal other(folder_ / "other.journal", "s", 0);
    other.append(4, "as ever");
  }
  const std::string by_append = base::read_text(folder_ / "other.journal");
  const std::string both = base::read_text(file());
  EXPECT_EQ(both.substr(0, by_append.size()), by_append);
  EXPECT_THAT(both.substr(by_append.size()), testing::StartsWith("12345678901234567890 [\"crashed\"] "));
  std::ofstream(file(), std::ios::binary | std::ios::trunc) << "snare-journal/1 s\n";
  {
    Journal journal(file(), "s", 10);
    journal.append_at_the_end(7, "last");
  }
  const Journal journal(file(), "s", 10);
  EXPECT_EQ(journal.result(7), "last");
  EXPECT_EQ(journal.damaged(), 0U);
}

TEST_F(JournalTest, RefusesAnotherStudy) {
  { Journal(file(), "study 1", 10).append(3, "three"); }
  EXPECT_THAT(test::refusal([&] { return Journal(file(), "study 2", 10); }),
              testing::HasSubstr("belongs to another study"));
  EXPECT_EQ(Journal(file(), "study 1", 10).finished(), 1U);  // the file is as it was
}

// A sweep whose input is rejected leaves nothing.
TEST_F(JournalTest, AFileWithoutCasesIsRemoved) {
  { const Journal journal(file(), "s", 10); }
  EXPECT_FALSE(std::filesystem::exists(file()));
  { Journal(file(), "s", 10).append_at_the_end(3, "three"); }
  { const Journal look(file(), "s", 10, Journal::Use::look); }
  EXPECT_TRUE(std::filesystem::exists(file()));
}

// The cases that ended other ranks go into the journal; the file of a rank that is still there and one of
// another study stay.
TEST_F(JournalTest, TakesTheCasesOfRanksThatHaveEnded) {
  Journal(rank_journal(file(), 1), "s", 10).append_at_the_end(4, "crashed");
  Journal(rank_journal(file(), 2), "another", 10).append(5, "of another study");
  Journal there(rank_journal(file(), 12), "s", 10);
  there.append(6, "of a rank that is there");
  write("other.rank1.journal", "of another journal");
  Journal journal(file(), "s", 10);
  journal.append(1, "one");
  take_rank_journals(journal, "s", 10);
  EXPECT_EQ(journal.finished(), 2U);
  EXPECT_EQ(journal.result(4), "crashed");
  EXPECT_FALSE(std::filesystem::exists(path("cases.rank1.journal")));
  EXPECT_TRUE(std::filesystem::exists(path("cases.rank2.journal")));
  EXPECT_TRUE(std::filesystem::exists(path("cases.rank12.journal")));
  EXPECT_TRUE(std::filesystem::exists(path("other.rank1.journal")));
}

TEST_F(JournalTest, OneAtATimeAppendsAndOthersMayLook) {
  Journal journal(file(), "s", 10);
  journal.append(3, "three");
  EXPECT_THAT(test::refusal([&] { return Journal(file(), "s", 10); }),
              testing::HasSubstr("another run is writing into this folder"));
  const std::string before = contents("cases.journal") + "4 tor";
  std::ofstream(file(), std::ios::binary | std::ios::app) << "4 tor";  // being written
  EXPECT_EQ(Journal(file(), "s", 10, Journal::Use::look).result(3), "three");
  EXPECT_EQ(contents("cases.journal"), before);
}

// A device that never ends would be read for ever.
TEST_F(JournalTest, RefusesWhatIsNoFile) {
  std::filesystem::create_symlink("/dev/full", file());
  EXPECT_THAT(test::refusal([&] { return Journal(file(), "study 1", 10); }),
              testing::HasSubstr("must be a regular file"));
}

// Whatever the length to which a kill leaves the file, the whole lines count and the journal continues.
TEST_F(JournalTest, AnyTornEndIsTakenOut) {
  {
    Journal journal(file(), "s", 3);
    journal.append(0, "zero");
    journal.append(1, "one");
  }
  const std::string whole = base::read_text(file());
  const std::size_t head = whole.find('\n') + 1;
  const std::size_t first = whole.find('\n', head) + 1;
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    std::ofstream(file(), std::ios::binary | std::ios::trunc) << whole.substr(0, length);
    {
      Journal journal(file(), "s", 3);
      EXPECT_EQ(journal.finished(), length < first ? 0U : length < whole.size() ? 1U : 2U) << length;
      journal.append(2, "two");
    }
    const Journal again(file(), "s", 3);
    EXPECT_EQ(again.result(2), "two") << length;
    EXPECT_EQ(again.damaged(), 0U) << length;
  }
}

// A bit that has changed costs the case whose line it is in, no other.
TEST_F(JournalTest, ADamagedLineIsPassedOver) {
  {
    Journal journal(file(), "s", 3);
    for (std::uint64_t k = 0; k < 3; ++k) journal.append(k, "result " + std::to_string(k));
  }
  std::string text = base::read_text(file());
  text[text.find("result 1") + 7] = '9';
  std::ofstream(file(), std::ios::binary | std::ios::trunc) << text;
  const Journal journal(file(), "s", 3);
  EXPECT_EQ(journal.damaged(), 1U);
  EXPECT_TRUE(journal.has(0));
  EXPECT_FALSE(journal.has(1));
  EXPECT_EQ(journal.result(2), "result 2");
}

TEST_F(JournalTest, AFileOfSomethingElseIsNotTouched) {
  std::ofstream(file(), std::ios::binary) << "my own notes";
  EXPECT_THROW(Journal(file(), "s", 3), base::InputError);
  EXPECT_EQ(base::read_text(file()), "my own notes");
}

}  // namespace
}  // namespace snare::study
