#include "base/result_folder.hpp"

#include "base/files.hpp"
#include "base/inputs.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace snare::base {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ResultFolderTest : public test::FolderFixture {
 protected:
  const std::vector<std::string> files_{"a.csv", "b.json"};
  const ResultFolder::Asker asker_{"out", "the first"};
};

TEST_F(ResultFolderTest, IsHeldByOneAtATimeAndNamesTheHolder) {
  {
    const ResultFolder one(path("one"), files_, asker_);
    const ResultFolder other(path("other"), files_, asker_);  // a process may hold several
    EXPECT_THAT(test::refusal([&] {
                  return ResultFolder(path("one"), files_, {"out", "the second"});
                }),
                HasSubstr("must be a folder of its own: the first (process"));
    write("one/a.csv", "a result");
  }
  EXPECT_EQ(contents("one/a.csv"), "a result");
  EXPECT_FALSE(fs::exists(path("one/.snare.lock")));
  EXPECT_FALSE(fs::exists(path("other")));  // it was made, and nothing was written into it
}

TEST_F(ResultFolderTest, RejectsWhatCannotBeWritten) {
  write("file", "in the way");
  const auto refusal = [&](const fs::path& folder) {
    return test::refusal([&] { return ResultFolder(folder, files_, asker_); });
  };
  EXPECT_THAT(refusal(""), HasSubstr("out = '', must name a folder"));
  EXPECT_THAT(refusal(path("file")), HasSubstr("file is a file"));
  EXPECT_THAT(refusal(path("file/below/it")), HasSubstr("file is a file"));
  fs::create_directories(path("taken/b.json"));
  EXPECT_THROW(ResultFolder(path("taken"), files_, asker_), std::system_error);
  EXPECT_FALSE(fs::exists(path("taken/.snare.lock")));
}

TEST_F(ResultFolderTest, RejectsTheFolderOfAnInputThatAResultWouldReplace) {
  const InputScope scope(std::make_shared<Inputs>());
  static_cast<void>(read_text(write("a.csv", "an input")));
  EXPECT_THAT(test::refusal([&] { return ResultFolder(folder_, files_, asker_); }),
              HasSubstr("a.csv would overwrite this input"));
  EXPECT_EQ(contents("a.csv"), "an input");
}

}  // namespace
}  // namespace snare::base
