// Step control on paths of which every answer is known.

#include "coupling/statics/path_follower.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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
  [[nodiscard]] numerics::SolveReport without_steps(double /*target*/,
                                                    const numerics::SolveReport& last) override {
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

/// y' = rate(t, y) by the implicit method of first order, with a linear rate: y follows cos t, behind by what
/// has been.
class LaggingPath final : public RememberingPath {
 public:
  [[nodiscard]] double parameter() const override { return at; }
  [[nodiscard]] StepOutcome step_to(double to) override {
    const double h = to - at;
    value = (value + h * lag * std::cos(to)) / (1.0 + h * lag);
    at = to;
    ++count;
    return {};
  }
  [[nodiscard]] numerics::SolveReport without_steps(double /*target*/,
                                                    const numerics::SolveReport& last) override {
    return last;
  }
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, now = at, y = value] {
      at = now;
      value = y;
    };
  }
  [[nodiscard]] Measures measures() override {
    return {Eigen::VectorXd::Constant(1, value), Eigen::VectorXd::Constant(1, tolerance)};
  }

  static constexpr double lag = 5.0;
  double at = 0.0;
  double value = 0.0;
  double tolerance = 1e-4;
  int count = 0;
};

// Of y' = k (cos t - y), y(0) = 0:  y = k/(k^2 + 1) (k cos t + sin t - k exp(-k t)).
double lagging(double t) {
  constexpr double k = LaggingPath::lag;
  return k / (k * k + 1.0) * (k * std::cos(t) + std::sin(t) - k * std::exp(-k * t));
}

double error_of_own_steps(double tolerance, std::vector<double>* ends = nullptr) {
  LaggingPath path;
  path.tolerance = tolerance;
  OwnSteps steps({1e-3, 1e-6, 1e-9, 1.0});
  const auto keep = [&](double from, double to, const std::function<void()>& back) {
    const double at = path.at;
    const double value = path.value;
    back();
    EXPECT_EQ(path.at, from);
    EXPECT_LT(from, to);
    path.at = at;
    path.value = value;
    if (ends != nullptr) ends->push_back(to);
    return numerics::SolveReport();
  };
  while (path.at < 3.0) EXPECT_TRUE(steps.advance(path, 3.0, keep).usable());
  return std::abs(path.value - lagging(3.0));
}

TEST(OwnSteps, FollowTheirErrorEstimate) {
  std::vector<double> ends;
  const double coarse = error_of_own_steps(1e-4, &ends);
  EXPECT_EQ(ends.back(), 3.0);
  EXPECT_TRUE(std::is_sorted(ends.begin(), ends.end()));
  EXPECT_LT(coarse, 1e-3);  // a handful of errors of 1e-4 that decay
  // The error of a step goes with the square of its length, that of the path with the length: a tenth for a
  // hundredth.
  EXPECT_NEAR(error_of_own_steps(1e-6) / coarse, 0.1, 0.05);
}

TEST(OwnSteps, EndAtAnEventAndGoOnAsBefore) {
  // Whatever passes 0.7 is an event there.
  class WithEvent final : public RememberingPath {
   public:
    [[nodiscard]] double parameter() const override { return at; }
    [[nodiscard]] StepOutcome step_to(double to) override {
      if (at < 0.7 - 1e-9 && to > 0.7 + 1e-9) return {Kind::event, {}, (0.7 - at) / (to - at)};
      at = to;
      return {};
    }
    [[nodiscard]] numerics::SolveReport without_steps(double /*target*/,
                                                      const numerics::SolveReport& last) override {
      return last;
    }
    [[nodiscard]] std::function<void()> checkpoint() override {
      return [this, now = at] { at = now; };
    }
    [[nodiscard]] Measures measures() override {
      return {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)};
    }
    double at = 0.0;
  } path;
  OwnSteps steps({0.01, 1e-6, 1e-9, 0.2});
  std::vector<double> ends;
  const auto keep = [&](double /*from*/, double to, const std::function<void()>& /*back*/) {
    ends.push_back(to);
    return numerics::SolveReport();
  };
  while (path.at < 1.0) ASSERT_TRUE(steps.advance(path, 1.0, keep).usable());
  EXPECT_TRUE(std::any_of(ends.begin(), ends.end(), [](double end) { return std::abs(end - 0.7) < 1e-9; }));
  EXPECT_LT(ends.size(),
            40u);  // doubled from 0.01 to 0.2, and again from a quarter of the step before the event
}

TEST(PathFollower, TakesNoStepBeyondTheLargest) {
  ScriptedPath path([](double, double) { return StepOutcome{}; });
  EXPECT_TRUE(follow(path, 1.0, {1e-9, StepMeasure::attempted, {}, 0.25}).usable());
  EXPECT_EQ(path.asked, (std::vector<double>{0.25, 0.5, 0.75, 1.0}));
}

}  // namespace
}  // namespace snare::coupling
