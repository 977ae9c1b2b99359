#include "base/files.hpp"

#include "base/errors.hpp"
#include "base/inputs.hpp"
#include "base/sha256.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <system_error>

namespace snare::base {
namespace {

class Files : public test::FolderFixture {
 protected:
  [[nodiscard]] auto entries() const {
    return std::distance(std::filesystem::directory_iterator(folder_), {});
  }
};

TEST_F(Files, TextIsWrittenWithItsFoldersAndReadBack) {
  const std::string text("a\0b\r\n\xC2\xB5", 7);
  write_text(path("new/folder/a.json"), text);
  EXPECT_EQ(read_text(path("new/folder/a.json")), text);
  write_text(path("new/folder/a.json"), "");
  EXPECT_EQ(read_text(path("new/folder/a.json")), "");
}

TEST_F(Files, AppearsWithTheCommitOnly) {
  {
    AtomicFile file(path("a.txt"));
    file.write("one ");
    EXPECT_FALSE(std::filesystem::exists(path("a.txt")));
    AtomicFile other(path("a.txt"));  // a second writer has a temporary name of its own
    other.write("other");
    file.write("two");
    file.commit();
    EXPECT_EQ(read_text(path("a.txt")), "one two");
  }  // `other` was not committed
  EXPECT_EQ(read_text(path("a.txt")), "one two");
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, NameOfAFolderIsRefusedAndNothingIsLeft) {
  write_text(path("folder/kept"), "x");
  try {
    write_text(path("folder"), "text");
    FAIL() << "written";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.what(), path("folder").string() + ": cannot be written: Is a directory");
  }
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, FileInPlaceOfAParentFolderIsRefused) {
  write_text(path("file"), "x");
  try {
    write_text(path("file/a.txt"), "text");
    FAIL() << "written";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.what(), path("file").string() + ": cannot create the folder: Not a directory");
  }
}

TEST_F(Files, LongOrNamelessFilesAreRefused) {
  write_text(path("a.txt"), "12345");
  EXPECT_EQ(read_text(path("a.txt"), 5), "12345");
  const auto message = [](const std::filesystem::path& name, std::size_t limit) -> std::string {
    return test::refusal([&] { return read_text(name, limit); });
  };
  EXPECT_EQ(message(path("a.txt"), 4), path("a.txt").string() + ": has 5 bytes, must have at most 4");
  EXPECT_EQ(message("", 4), "the name of the file is empty");
  EXPECT_EQ(message("/dev/zero", 4), "/dev/zero: is a device, a pipe or a socket, must be a regular file");
  // The system would stop at the zero byte and read a.txt.
  const std::filesystem::path cut(path("a.txt").string() + std::string("\0.csv", 5));
  EXPECT_EQ(message(cut, 9), path("a.txt").string() + ": a zero byte in the name of the file");
}

TEST(Utf8, FindsTheFirstByteThatIsNotWellFormed) {
  constexpr std::size_t none = std::string_view::npos;
  EXPECT_EQ(find_invalid_utf8(""), none);
  EXPECT_EQ(find_invalid_utf8("a\xC2\xB5\xE5\x8A\x9B\xF0\x9F\x94\xA9\x7F"), none);
  EXPECT_EQ(find_invalid_utf8("\xED\x9F\xBF\xEE\x80\x80\xF4\x8F\xBF\xBF"), none);  // ends of the ranges
  EXPECT_EQ(find_invalid_utf8("ab\x80"), 2u);            // continuation without a start
  EXPECT_EQ(find_invalid_utf8("a\xC2"), 1u);             // cut short
  EXPECT_EQ(find_invalid_utf8("\xE5\x8A"), 0u);          //
  EXPECT_EQ(find_invalid_utf8("\xC0\xAF"), 0u);          // overlong
  EXPECT_EQ(find_invalid_utf8("\xE0\x9F\xBF"), 0u);      // overlong
  EXPECT_EQ(find_invalid_utf8("\xF0\x8F\xBF\xBF"), 0u);  // overlong
  EXPECT_EQ(find_invalid_utf8("\xED\xA0\x80"), 0u);      // surrogate
  EXPECT_EQ(find_invalid_utf8("\xF4\x90\x80\x80"), 0u);  // beyond U+10FFFF
  EXPECT_EQ(find_invalid_utf8("\xFF"), 0u);
}

// FIPS 180-4 examples, and lengths about the end of a block, by sha256sum.
TEST(Sha256, KnownDigests) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_F(Files, AreReadOnceInAScope) {
  write_text(path("a.txt"), "first");
  const auto inputs = std::make_shared<Inputs>();
  {
    const InputScope scope(inputs);
    EXPECT_EQ(read_text(path("a.txt")), "first");
    EXPECT_THROW(write_text(path("a.txt"), "second"), InputError);  // an input
    std::filesystem::remove(path("a.txt"));
    EXPECT_EQ(read_text(path("a.txt")), "first");
    EXPECT_THROW(static_cast<void>(read_text(path("a.txt"), 3)), InputError);
  }
  write_text(path("a.txt"), "second");
  EXPECT_EQ(read_text(path("a.txt")), "second");
  ASSERT_EQ(inputs->files().size(), 1U);
  EXPECT_EQ(inputs->files()[0].sha256, sha256("first"));
}

}  // namespace
}  // namespace snare::base
