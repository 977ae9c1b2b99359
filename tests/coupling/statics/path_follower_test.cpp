// Step control on paths of which every answer is known.

#include "coupling/statics/path_follower.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <utility>
#include <vector>

namespace snare::coupling {
namespace {

using Kind = StepOutcome::Kind;

/// Answers each step by a rule and keeps the values that were asked for.
class ScriptedPath final : public FollowedPath {
 public:
  explicit ScriptedPath(std::function<StepOutcome(double from, double to)> rule) : rule_(std::move(rule)) {}
  [[nodiscard]] double parameter() const override { return at; }
  [[nodiscard]] StepOutcome step_to(double to) override {
    asked.push_back(to);
    StepOutcome outcome = rule_(at, to);
    if (outcome.kind == Kind::taken) at = to;
    return outcome;
  }
  [[nodiscard]] numerics::SolveReport without_steps(double /*target*/, const numerics::SolveReport& last) override {
    gave_up = true;
    return last;
  }

  double at = 0.0;
  bool gave_up = false;
  std::vector<double> asked;

 private:
  std::function<StepOutcome(double, double)> rule_;
};

StepOutcome failure() {
  StepOutcome outcome{Kind::failed};
  outcome.report.termination = numerics::Termination::iteration_limit;
  outcome.report.message = "no";
  return outcome;
}

TEST(PathFollower, TakesTheWholeWayInOneStep) {
  ScriptedPath path([](double, double) { return StepOutcome{}; });
  EXPECT_TRUE(follow(path, 2.0, {}).usable());
  EXPECT_EQ(path.asked, std::vector<double>{2.0});
}

TEST(PathFollower, HalvesAfterAFailureAndDoublesAfterASuccess) {
  // No step longer than 0.3: 1, 0.5, 0.25, then 0.5 ahead fails, 0.25 ahead, and so on.
  ScriptedPath path([](double from, double to) { return to - from > 0.3 ? failure() : StepOutcome{}; });
  EXPECT_TRUE(follow(path, 1.0, {}).usable());
  const std::vector<double> expected{1.0, 0.5, 0.25, 0.75, 0.5, 1.0, 0.75, 1.0};
  EXPECT_EQ(path.asked, expected);  // powers of two: exact
}

TEST(PathFollower, TakesAShortRemainderWithTheStep) {
  // An event at 0.32; the next step, doubled, would end at 0.96: what is left is less than a tenth of it.
  ScriptedPath path([](double from, double to) {
    return from == 0.0 && to == 1.0 ? StepOutcome{Kind::event, {}, 0.32} : StepOutcome{};
  });
  EXPECT_TRUE(follow(path, 1.0, {}).usable());
  EXPECT_EQ(path.asked, (std::vector<double>{1.0, 0.32, 1.0}));
}

TEST(PathFollower, StopsAtAnEventAndGoesOnFromThere) {
  bool met = false;
  ScriptedPath path([&met](double from, double to) {
    if (met || from >= 0.25 || to <= 0.25) return StepOutcome{};
    met = true;
    return StepOutcome{Kind::event, {}, 0.25};
  });
  EXPECT_TRUE(follow(path, 1.0, {}).usable());
  EXPECT_EQ(path.asked, (std::vector<double>{1.0, 0.25, 0.75, 1.0}));
}

TEST(PathFollower, GoesBackAsWell) {
  ScriptedPath path([](double from, double to) { return from - to > 0.6 ? failure() : StepOutcome{}; });
  EXPECT_TRUE(follow(path, -1.0, {}).usable());
  EXPECT_EQ(path.asked, (std::vector<double>{-1.0, -0.5, -1.0}));
}

TEST(PathFollower, AsksForAnotherWayWhenStepsAreTooSmall) {
  ScriptedPath path([](double, double) { return failure(); });
  const numerics::SolveReport report = follow(path, 1.0, {0.1, StepMeasure::planned});
  EXPECT_TRUE(path.gave_up);
  EXPECT_EQ(report.message, "no");
  EXPECT_EQ(path.asked, (std::vector<double>{1.0, 0.5, 0.25, 0.125}));  // the next, 0.0625, is below 0.1
  EXPECT_EQ(path.at, 0.0);
}

TEST(PathFollower, EndsWhereThePathEnds) {
  ScriptedPath path([](double, double) {
    StepOutcome outcome = failure();
    outcome.kind = Kind::stopped;
    return outcome;
  });
  EXPECT_FALSE(follow(path, 1.0, {}).usable());
  EXPECT_FALSE(path.gave_up);
  EXPECT_EQ(path.asked.size(), 1u);
}

}  // namespace
}  // namespace snare::coupling
