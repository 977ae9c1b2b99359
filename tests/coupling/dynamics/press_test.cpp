// Where Newton's method begins with a contact: the start of a touch, the accepted state, or the predicted
// one.

#include "coupling/dynamics/model/press.hpp"
#include "coupling/dynamics/model/input_memo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace snare::coupling {
namespace {

constexpr double tolerance = 3e-7;  // of places [m]

numerics::IterationStart start(const Press& accepted, const Press& predicted, double gap = 1e-6) {
  // What flies straight: the depth grows from none to that of the prediction.
  const auto depth = [=](double share) { return std::max(0.0, share * (predicted.depth + gap) - gap); };
  return start_with_contact(
      accepted, predicted, tolerance, [=] { return gap; }, depth);
}

TEST(StartWithContact, IsThePredictionWhereNothingTouchesOrTheLoadIsSteady) {
  EXPECT_EQ(start({}, {}).share, 1.0);
  EXPECT_EQ(start({1e-8, 2.0}, {1e-8, 3.0}).share, 1.0);
  EXPECT_EQ(start({1e-8, 2.0}, {1e-8, 0.3}).share, 1.0);
  EXPECT_EQ(start({1e-8, 2.0}, {}).share, 1.0);  // lets go
  EXPECT_FALSE(start({1e-8, 2.0}, {1e-4, 3.0}).out_of_reach);
}

TEST(StartWithContact, IsTheAcceptedStateWhereTheLoadIsNot) {
  EXPECT_EQ(start({1e-8, 2.0}, {1e-6, 2e4}).share, 0.0);
  EXPECT_EQ(start({1e-8, 2.0}, {1e-8, 0.0}).share, 0.0);  // goes apart so fast that nothing presses
}

TEST(StartWithContact, IsWhereATouchBegins) {
  for (const double gap : {1e-9, 1e-6, 1e-3}) {
    for (const double depth : {1e-8, 3e-8, 8e-8}) {
      const numerics::IterationStart s = start({}, {depth, 1.0}, gap);
      EXPECT_FALSE(s.out_of_reach);
      const double reached = s.share * (gap + depth) - gap;
      EXPECT_GT(reached, 0.003 * tolerance / 4.0) << gap << ", " << depth;
      EXPECT_LT(reached, 0.003 * tolerance * 4.0) << gap << ", " << depth;
    }
  }
  EXPECT_EQ(start({}, {0.002 * tolerance, 1.0}).share, 1.0);  // as shallow as that
}

// What has been touched to less than that begins there, too, whatever it presses with.
TEST(StartWithContact, IsThereFromATouchOfRoundOff) {
  for (const Press& accepted : {Press{}, Press{1e-17, 0.0}, Press{1e-13, 1e-9}}) {
    const numerics::IterationStart s = start_with_contact(
        accepted, {5e-8, 1e3}, tolerance, [] { return -1e-17; }, [](double share) { return share * 5e-8; });
    EXPECT_FALSE(s.out_of_reach);
    EXPECT_GT(s.share * 5e-8, 0.003 * tolerance / 4.0) << accepted.depth;
    EXPECT_LT(s.share * 5e-8, 0.003 * tolerance * 4.0) << accepted.depth;
  }
}

TEST(StartWithContact, RefusesStepsFarBehindATouch) {
  EXPECT_FALSE(start({}, {0.29 * tolerance, 1.0}).out_of_reach);
  EXPECT_TRUE(start({}, {0.31 * tolerance, 1.0}).out_of_reach);
}

// The depth of a touch is known only where there is one, and it may grow in any way.
TEST(ShareToTouch, FindsItWhateverTheDepthGrowsBy) {
  constexpr double wanted = 1e-3, gap = 0.2;
  for (const double power : {0.5, 1.0, 2.0, 4.0}) {
    for (const double begin : {0.05, 0.5, 0.95}) {
      const auto depth = [=](double share) {
        return share <= begin ? 0.0 : std::pow((share - begin) / (1.0 - begin), power);
      };
      const double found = depth(share_to_touch(-gap, 1.0, wanted, depth));
      EXPECT_GT(found, wanted / 4.0) << power << ", " << begin;
      EXPECT_LT(found, wanted * 4.0) << power << ", " << begin;
    }
  }
}

TEST(InputMemo, KnowsTheUnknownsThatItDependsOn) {
  InputMemo memo;
  EXPECT_FALSE(memo.depends());
  memo.depend_on(1, 2);
  memo.depend_on(4, 1);
  Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(6, 0.0, 5.0);
  EXPECT_FALSE(memo.holds(y));  // nothing was taken
  memo.take(y);
  EXPECT_TRUE(memo.holds(y));
  y[0] = y[3] = y[5] = -1.0;
  EXPECT_TRUE(memo.holds(y));
  y[4] = 0.0;
  EXPECT_FALSE(memo.holds(y));
  memo.take(y);
  EXPECT_TRUE(memo.holds(y));
  memo.forget();
  EXPECT_FALSE(memo.holds(y));
}

}  // namespace
}  // namespace snare::coupling
