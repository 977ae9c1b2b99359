#include "numerics/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace snare::numerics {
namespace {

/// y' = -y.
class Decay final : public DaePart {
 public:
  void declare(DaeLayout& layout) override {
    first_ = layout.add({"warmth", {}, 1, DaeKind::differential, 1e-9, 0});
  }
  void sparsity(std::vector<std::pair<int, int>>& entries) const override {
    entries.emplace_back(first_, first_);
  }
  void attach_pattern(const SparseMatrix& pattern) override { slot_ = pattern.slot(first_, first_); }
  void residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override {
    rows[first_] += at.rate[first_] + at.y[first_];
  }
  void jacobian(const DaePoint&, double c, std::vector<double>& values) override {
    values[static_cast<std::size_t>(slot_)] += c + 1.0;
  }

 private:
  int first_ = 0, slot_ = 0;
};

/// An integration of it to some 1e-3 s; end of the motion: 1 s.
class ProgressOf : public testing::Test {
 protected:
  ProgressOf() {
    ida_.start(0.0, Eigen::VectorXd::Ones(1), -Eigen::VectorXd::Ones(1));
    while (ida_.time() < 1e-3) static_cast<void>(ida_.advance(end));
  }
  static constexpr double end = 1.0;
  Decay decay_;
  DaeSystem system_{{&decay_}};
  Ida ida_{system_, {}};
};

// Of some thousand unknowns and more 40,000 evaluations; of fewer 5e7 rows.
TEST(Progress, WindowsAreOfEqualWork) {
  EXPECT_EQ(Progress::window(100000), 40000);
  EXPECT_EQ(Progress::window(1250), 40000);
  EXPECT_EQ(Progress::window(500), 100000);
  EXPECT_EQ(Progress::window(1), 50000000);
}

TEST_F(ProgressOf, AWindowThatBringsTooLittleEndsIt) {
  Progress progress(0.1);
  Effort effort;
  const long window = Progress::window(1);
  EXPECT_FALSE(progress.add(ida_, window - 1, end, effort));  // not full
  const auto why = progress.add(ida_, 1, end, effort);
  ASSERT_TRUE(why);
  EXPECT_THAT(*why, testing::HasSubstr("stalled at"));
  EXPECT_THAT(*why, testing::HasSubstr("less than the 0.1 s that they must"));
}

TEST_F(ProgressOf, SaysWhatLimitedTheSteps) {
  Progress progress(1e6);
  Effort effort;
  for (int k = 0; k < 16; ++k) {
    static_cast<void>(ida_.advance(1e9));
    ASSERT_FALSE(progress.add(ida_, 1, 1e9, effort));  // one step in sixteen is looked at
  }
  const auto why = progress.add(ida_, Progress::window(1), 1e9, effort);
  ASSERT_TRUE(why);
  EXPECT_THAT(*why, testing::HasSubstr("100 % were chosen for accuracy (most by warmth)"));
}

TEST_F(ProgressOf, WindowsFollowEachOther) {
  Progress progress(1e-4);
  Effort effort;
  EXPECT_FALSE(progress.add(ida_, Progress::window(1), end, effort));
  EXPECT_EQ(effort.evaluations, 0);
  EXPECT_EQ(effort.since, ida_.time());
  EXPECT_TRUE(progress.add(ida_, Progress::window(1), end, effort))
      << "the second window has brought nothing";
}

TEST_F(ProgressOf, WhatIsNearlyOverEnds) {
  Progress progress(0.1);
  Effort effort;
  EXPECT_FALSE(progress.add(ida_, Progress::window(1), 1.9 * ida_.time(), effort));
}

TEST_F(ProgressOf, WithoutALeastItGoesOn) {
  Progress progress;
  Effort effort{0, ida_.time()};
  EXPECT_FALSE(progress.add(ida_, Progress::window(1), end, effort));
}

}  // namespace
}  // namespace snare::numerics
