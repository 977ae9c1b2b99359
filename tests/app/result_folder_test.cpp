// What can be checked before computing is checked before, and nothing that fails is silent.

#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <csignal>
#include <filesystem>
#include <string>

namespace snare::app {
namespace {

namespace fs = std::filesystem;

std::string experiment(int elements) {
  return "schema = \"snare-experiment/1\"\ntitle = \"test\"\nsource = \"none\"\n" +
         test::wire_tables("180.0") + "[solver]\nelements = " + std::to_string(elements) +
         "\n[[series]]\nname = \"s\"\ncontact_position_mm = 60.0\ntravel_mm = 3.0\npoints = 21\n";
}

class Refusals : public CommandFixture {
 protected:
  void SetUp() override {
    write("x.toml", experiment(32));
    write("long.toml", experiment(20000));  // ten seconds, as built for tests
  }
  /// Status of a command that would compute for long and must not begin.
  [[nodiscard]] int refused(const std::string& arguments) const {
    return shell("timeout 20 '" SNARE_COMMAND "' " + arguments + " >out.txt 2>err.txt");
  }
};

TEST_F(Refusals, FoldersThatCannotBeWrittenAreFoundBeforeComputing) {
  write("file", "in the way");
  fs::create_directories(folder_ / "taken/curves.csv");
  for (const std::string verb : {"push long.toml", "reproduce", "validate"}) {
    EXPECT_EQ(refused(verb + " --out file"), 2) << verb;
    EXPECT_NE(contents("err.txt").find("file"), std::string::npos) << contents("err.txt");
    EXPECT_EQ(refused(verb + " --out file/below"), 2) << verb;
    EXPECT_EQ(refused(verb + " --out /proc/nowhere"), 1) << verb;
    EXPECT_EQ(refused(verb + " --out ''"), 2) << verb;
    EXPECT_NE(contents("err.txt").find("--out = '', must name a folder"), std::string::npos)
        << contents("err.txt");
  }
  EXPECT_EQ(refused("push long.toml --out taken"), 1);
  EXPECT_NE(contents("err.txt").find("taken/curves.csv"), std::string::npos) << contents("err.txt");
  EXPECT_EQ(contents("file"), "in the way");
}

TEST_F(Refusals, WhatIsRefusedLeavesNoFolder) {
  EXPECT_EQ(refused("push x.toml --out new/folder --set wire.length_mm=-1"), 2);
  EXPECT_FALSE(fs::exists(folder_ / "new"));
  fs::create_directories(folder_ / "other");
  EXPECT_EQ(refused("validate --out new/folder --set foo.bar=1"), 2);
  EXPECT_NE(contents("err.txt").find("--set: foo.bar=1, validate reads no file"), std::string::npos)
      << contents("err.txt");
  EXPECT_FALSE(fs::exists(folder_ / "new"));
}

TEST_F(Refusals, AFolderOfAnotherRunIsNamedWithThatRun) {
  const pid_t child = start({"push", "long.toml", "--out", "here"});
  for (int i = 0; i < 500 && !fs::exists(folder_ / "here/.snare.lock"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(shell("timeout 20 '" SNARE_COMMAND "' push x.toml --out here >out2.txt 2>err2.txt"), 2);
  EXPECT_NE(contents("err2.txt").find("snare push long.toml (process " + std::to_string(child) + ")"),
            std::string::npos)
      << contents("err2.txt");
  EXPECT_EQ(interrupt(child, 0.0, SIGKILL).status, -SIGKILL);
  // The lock of a run that was killed holds nobody.
  EXPECT_EQ(CommandFixture::run("push x.toml --out here"), 0) << contents("err.txt");
  EXPECT_TRUE(fs::exists(folder_ / "here/curves.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "here/.snare.lock"));
}

TEST_F(Refusals, AFullStandardOutputIsAFailure) {
  const std::string chain = SNARE_SOURCE_DIR "/data/arms/jemrms_like.toml";
  for (const std::string& arguments :
       {std::string("push x.toml --json"), "arm show " + chain, "arm show --json " + chain,
        std::string("--help"), std::string("--version")}) {
    EXPECT_EQ(shell("'" SNARE_COMMAND "' " + arguments + " >/dev/full 2>err.txt"), 1) << arguments;
    EXPECT_NE(contents("err.txt").find("standard output: cannot be written: No space left on device"),
              std::string::npos)
        << contents("err.txt");
  }
  // Nobody reads on.
  EXPECT_EQ(shell("sh -c \"'" SNARE_COMMAND "' push x.toml --json; echo \\$? >status.txt\" 2>err.txt | true"),
            0);
  EXPECT_EQ(contents("status.txt"), "1\n");
}

TEST_F(Refusals, AFileSizeLimitIsAFailureAndLeavesNothing) {
  // 8 kB: the thread library may ask for a page of its own, and the first of the results is larger.
  EXPECT_EQ(shell("ulimit -f 16; '" SNARE_COMMAND "' push '" SNARE_SOURCE_DIR
                  "/data/experiments/published_static.toml' --out here >out.txt 2>err.txt"),
            1);
  EXPECT_NE(contents("err.txt").find("File too large"), std::string::npos) << contents("err.txt");
  EXPECT_FALSE(fs::exists(folder_ / "here"));
}

}  // namespace
}  // namespace snare::app
