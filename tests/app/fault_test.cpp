// Every write, flush, sync, close and rename of a run fails once: the status says so, and no file is half.

#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace snare::app {
namespace {

namespace fs = std::filesystem;

class Faults : public CommandFixture {
 protected:
  using Files = std::map<std::string, std::string>;

  [[nodiscard]] Files files(const std::string& out) const {
    Files all;
    if (!fs::exists(folder_ / out)) return all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / out)) {
      if (entry.is_regular_file()) all[fs::relative(entry.path(), folder_ / out).string()] = contents(entry.path());
    }
    return all;
  }

  [[nodiscard]] int failing(const std::string& call, int at, const std::string& arguments) const {
    return shell("ASAN_OPTIONS=verify_asan_link_order=0 SNARE_FAIL_CALL=" + call +
                 " SNARE_FAIL_AT=" + std::to_string(at) + " LD_PRELOAD='" SNARE_FAIL_NTH "' '" SNARE_COMMAND "' " +
                 arguments + " --out failed >out.txt 2>err.txt");
  }

  /// `spared`: a file whose failure costs its own use only.
  void expect_promises(const std::string& arguments, const std::string& spared = "") {
    ASSERT_EQ(run(arguments + " --out whole"), 0) << contents("err.txt");
    const Files whole = files("whole");
    int found = 0;
    for (const std::string call : {"fwrite", "fflush", "fsync", "fclose", "rename", "mkdir"}) {
      constexpr int most = 200;  // more calls than any of these runs makes
      int failures = 0;
      for (int at = 1; at <= most; ++at) {
        fs::remove_all(folder_ / "failed");
        const int status = failing(call, at, arguments);
        const std::string said = contents("err.txt");
        const Files left = files("failed");
        for (const auto& [name, text] : left) {
          if (name == spared) continue;
          ASSERT_TRUE(whole.contains(name)) << call << " " << at << " leaves " << name;
          if (name.ends_with(".csv"))
            EXPECT_EQ(text, whole.at(name)) << call << " " << at << ": " << name;
          else if (name.ends_with(".json"))
            EXPECT_TRUE(nlohmann::json::accept(text)) << call << " " << at << ": " << name;
          else
            EXPECT_TRUE(text.ends_with("</html>\n") || !name.ends_with(".html")) << call << " " << at << ": " << name;
        }
        if (status == 0 && said.find("No space left") == std::string::npos) {
          EXPECT_EQ(left.size(), whole.size()) << call << " " << at;
          break;  // there is no such call any more
        }
        ++failures;
        ASSERT_LT(at, most) << call;
        EXPECT_NE(said.find("No space left on device"), std::string::npos) << call << " " << at << ": " << said;
        if (status != 0) {
          EXPECT_EQ(status, 1) << call << " " << at << ": " << said;
        } else {
          EXPECT_FALSE(spared.empty()) << call << " " << at << ": " << said;
          EXPECT_EQ(left.size(), whole.size()) << call << " " << at;
        }
      }
      found += failures;
    }
    EXPECT_GE(found, 4) << "the calls of a run were not met";
  }
};

TEST_F(Faults, Push) {
  write("x.toml", "schema = \"snare-experiment/1\"\ntitle = \"test\"\nsource = \"none\"\n" +
                      test::wire_tables("180.0") +
                      "[solver]\nelements = 16\n[[series]]\nname = \"s\"\ncontact_position_mm = 60.0\ntravel_mm = "
                      "1.0\npoints = 3\n");
  expect_promises("push x.toml --quiet");
}

// A journal of curves that cannot be written costs the way back to them, not the run. Of each kind the call that is the journal's
// first (the wire file is closed before); all calls of all kinds would take minutes.
TEST_F(Faults, DistilGoesOnWithoutAJournal) {
  const std::string distil = "distil '" SNARE_SOURCE_DIR "/tests/ranges/wire.toml' --quiet";
  ASSERT_EQ(run(distil + " --out whole"), 0) << contents("err.txt");
  const Files whole = files("whole");
  const std::map<std::string, int> first{{"fwrite", 1}, {"fflush", 1}, {"fclose", 2}};
  for (const auto& [call, at] : first) {
    fs::remove_all(folder_ / "failed");
    EXPECT_EQ(failing(call, at, distil), 0) << call;
    const std::string said = contents("err.txt");
    EXPECT_NE(said.find("failed/distil.journal: cannot be written: No space left on device; goes on, but a run that is "
                        "interrupted begins anew"),
              std::string::npos)
        << call << ": " << said;
    const Files left = files("failed");
    EXPECT_EQ(left.size(), whole.size()) << call;
    EXPECT_EQ(left.at("table.csv"), whole.at("table.csv")) << call;
    EXPECT_FALSE(left.contains("distil.journal")) << call;
  }
}

class SlowFaults : public Faults {};

TEST_F(SlowFaults, RingDown) {
  expect_promises("ringdown '" SNARE_SOURCE_DIR "/data/experiments/ringdown.toml' --quiet");
}

// A checkpoint that cannot be written costs the way back to it.
TEST_F(SlowFaults, SimulateGoesOnWithoutACheckpoint) {
  expect_promises("simulate '" SNARE_SOURCE_DIR
                  "/data/scenarios/air_table.toml' --quiet --set duration_s=0.004 "
                  "--set solver.elements=8 --set output.checkpoint_interval_s=0.002 "
                  "--set output.checkpoint_wall_time_s=0",
                  "checkpoint.bin");
}

}  // namespace
}  // namespace snare::app
