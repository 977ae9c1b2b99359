#include "app/crash_note.hpp"

#include "study/case_record.hpp"
#include "tests/support/folder_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>

namespace snare::app {
namespace {

using testing::HasSubstr;

class CrashNoteTest : public test::FolderFixture {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder_ / "cases.journal"; }

  /// A process of its own in which case 3 is run by a second thread after case 5 has ended; the signal by
  /// which it ends.
  [[nodiscard]] int ending(const std::function<void()>& one_case) const {
    const pid_t child = ::fork();
    if (child == 0) {
      ::dup2(::open((folder_ / "err.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
      study::Journal journal(file(), "a study", 10);
      std::thread([&] {
        {
          const CrashNote note(journal, 5, {});
          journal.append(5, study::line_of({"done", "", 1.0, {}, {}}));
        }
        const CrashNote note(journal, 3, {0.25, -1.0});
        one_case();
      }).join();
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

  void expect_note(const std::string& signal) const {
    const study::Journal journal(file(), "a study", 10);
    EXPECT_EQ(journal.damaged(), 0U);
    EXPECT_EQ(journal.finished(), 2U);
    EXPECT_TRUE(journal.has(5));
    const auto record = study::record_of(journal.result(3).value_or(""));
    ASSERT_TRUE(record.has_value());
    EXPECT_EQ(record->status, "crashed");
    EXPECT_EQ(record->reason, "the process ended in this case by " + signal);
    EXPECT_THAT(record->values, testing::ElementsAre(0.25, -1.0));
    EXPECT_THAT(contents("err.txt"), HasSubstr("case 4 ended the process by " + signal));
  }
};

TEST_F(CrashNoteTest, NamesTheCaseThatTouchesForeignMemory) {
  EXPECT_EQ(ending([] {
              const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
              void* const forbidden = ::mmap(nullptr, page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
              *static_cast<volatile char*>(forbidden) = 1;
            }),
            SIGSEGV);
  expect_note("SIGSEGV");
}

TEST_F(CrashNoteTest, NamesTheCaseThatAborts) {
  EXPECT_EQ(ending([] { std::abort(); }), SIGABRT);
  expect_note("SIGABRT");
}

// The name of the signal is shorter than the room for it.
TEST_F(CrashNoteTest, NamesTheCaseOfAnyFatalSignal) {
  EXPECT_EQ(ending([] { std::raise(SIGFPE); }), SIGFPE);
  expect_note("SIGFPE");
}

// NOLINTNEXTLINE(misc-no-recursion)
int deeper(volatile int* above) {
  volatile int here[256] = {*above};
  return *above < 0 ? 0 : deeper(here) + here[0];
}

TEST_F(CrashNoteTest, NamesTheCaseThatUsesUpItsStack) {
  EXPECT_EQ(ending([] {
              volatile int first = 0;
              std::exit(deeper(&first));
            }),
            SIGSEGV);
  expect_note("SIGSEGV");
}

}  // namespace
}  // namespace snare::app
