// `snare reproduce` with a paper: arguments, interruption, pages.

#include "papers/papers.hpp"
#include "tests/app/command_fixture.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace snare::app {
namespace {

class PapersCommand : public CommandFixture {};
class SlowPapersCommand : public CommandFixture {};

TEST_F(PapersCommand, UnknownPaperIsRefusedWithTheNamesThereAre) {
  EXPECT_EQ(run("reproduce abikoo --out here"), 2);
  EXPECT_NE(contents("err.txt").find(
                "snare reproduce = abikoo, must be an experiment file or a paper: abiko, na, honda, all"),
            std::string::npos)
      << contents("err.txt");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "here"));
}

TEST_F(PapersCommand, AFileThatIsMissingIsStillCalledMissing) {
  EXPECT_EQ(run("reproduce abiko.toml --out here"), 2);
  EXPECT_NE(contents("err.txt").find("abiko.toml"), std::string::npos);
  EXPECT_EQ(contents("err.txt").find("a paper:"), std::string::npos) << contents("err.txt");
}

TEST_F(PapersCommand, APaperHasNoKeyToSet) {
  EXPECT_EQ(run("reproduce na --out here --set duration_s=1"), 2);
  EXPECT_NE(contents("err.txt").find("no key to set"), std::string::npos) << contents("err.txt");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "here"));
}

// What is finished is kept and marked, and nothing but the paper's page and the JSON is written.
TEST_F(PapersCommand, AnInterruptedPaperIsMarkedAsAPart) {
  const pid_t child = start({"reproduce", "honda", "--out", "here", "--json", "--quiet"});
  EXPECT_EQ(interrupt(child, 0.5).status, 3);
  EXPECT_TRUE(parsed("out.txt")["interrupted"].get<bool>());
  EXPECT_TRUE(parsed("here/figures.json")["interrupted"].get<bool>());
  if (std::filesystem::exists(folder_ / "here/honda.html")) {
    EXPECT_NE(contents("here/honda.html").find("was interrupted"), std::string::npos);
  }
}

TEST_F(SlowPapersCommand, ThePageHoldsEveryFigure) {
  ASSERT_EQ(run("reproduce abiko --out here --quiet"), 0) << contents("err.txt");
  const std::string page = contents("here/abiko.html");
  const nlohmann::json figures = parsed("here/figures.json")["papers"][0]["figures"];
  ASSERT_EQ(figures.size(), papers::abiko().figures.size());
  for (const papers::Figure& figure : papers::abiko().figures)
    EXPECT_NE(page.find(">" + std::string(figure.number) + ": "), std::string::npos) << figure.number;
  EXPECT_NE(page.find("What is lost, and why"), std::string::npos);
  for (const nlohmann::json& figure : figures) {
    EXPECT_EQ(figure["failure"], "") << figure["number"];
    for (const nlohmann::json& row : figure["rows"]) EXPECT_EQ(row["verdict"], "within") << row["name"];
  }
}

}  // namespace
}  // namespace snare::app
