#include "identification/fitting/identifiability.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>
#include <random>

namespace snare::identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_columns(Index rows, Index columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  MatrixXd m(rows, columns);
  for (double& v : m.reshaped()) v = normal(engine);
  return m;
}

// Readings g(a E + b A): the derivative by ln g is the sum of those by ln E and ln A, so (-1, 1, 1) changes
// nothing.
TEST(Identifiability, FindsTheGainBesideTwoStiffnesses) {
  MatrixXd j(20, 3);
  j.rightCols(2) = random_columns(20, 2, 1) * Eigen::Vector2d(300.0, 4.0).asDiagonal();
  j.col(0) = j.col(1) + j.col(2);
  const Identifiability found = identifiability_of(j, {});
  ASSERT_EQ(found.directions.size(), 1u);
  EXPECT_EQ(found.known, std::vector<bool>(3, false));
  const NullDirection& d = found.directions.front();
  EXPECT_EQ(d.others.size(), 2u);
  const VectorXd change = d.change / d.change[0];
  EXPECT_NEAR(change[1], -1.0, 1e-9);  // rounding over the smallest column's share
  EXPECT_NEAR(change[2], -1.0, 1e-9);
  // With the one held the others have the covariance of ordinary least squares.
  std::vector<Index> free;
  for (const std::size_t k : d.others) free.push_back(static_cast<Index>(k));
  const MatrixXd rest = j(Eigen::all, free);
  const MatrixXd expected = (rest.transpose() * rest).inverse();
  EXPECT_LT((found.covariance(free, free) - expected).norm(), 1e-9 * expected.norm());
  EXPECT_EQ(found.covariance.row(static_cast<Index>(d.held)).norm(), 0.0);
}

// Two dependences with no number in common come apart, and the number beside them keeps its variance.
TEST(Identifiability, PartsDirectionsAndKeepsWhatIsKnown) {
  const MatrixXd own = random_columns(40, 4, 2);
  MatrixXd j(40, 6);
  j << own.col(0), own.col(1), own.col(0) - 2.0 * own.col(1), own.col(2), -0.5 * own.col(2), own.col(3);
  const Identifiability found = identifiability_of(j, {});
  ASSERT_EQ(found.directions.size(), 2u);
  EXPECT_EQ(found.known, (std::vector<bool>{false, false, false, false, false, true}));
  for (const NullDirection& d : found.directions) {
    const bool first = d.held < 3;
    EXPECT_EQ(d.others.size(), first ? 2u : 1u);
    EXPECT_LT((first ? d.change.tail(3) : d.change.head(3)).norm(), 1e-12);
    EXPECT_LT((j * d.change).norm(), 1e-9 * j.norm());
  }
  const double expected = (own.transpose() * own).inverse()(3, 3);
  EXPECT_NEAR(found.covariance(5, 5), expected, 1e-9 * expected);
}

TEST(Identifiability, AColumnOfNothingIsADirectionByItself) {
  MatrixXd j = random_columns(10, 2, 3);
  j.col(1).setZero();
  const Identifiability found = identifiability_of(j, MatrixXd::Zero(10, 2));
  ASSERT_EQ(found.directions.size(), 1u);
  EXPECT_EQ(found.directions.front().held, 1u);
  EXPECT_TRUE(found.directions.front().others.empty());
  EXPECT_TRUE(found.is_known(0));
  EXPECT_FALSE(found.is_known(1));
  EXPECT_NEAR(found.covariance(0, 0), 1.0 / j.col(0).squaredNorm(), 1e-12);
}

// A dependence that the derivatives hide by their errors is found where the errors are known, and no sooner.
TEST(Identifiability, TheErrorOfTheDerivativesIsTheThreshold) {
  const MatrixXd own = random_columns(50, 2, 4);
  MatrixXd exact(50, 3);
  exact << own, own.col(0) + own.col(1);
  int found = 0, falsely = 0;
  constexpr double size = 1e-4;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const MatrixXd once = exact + size * random_columns(50, 3, 10 + seed);
    const MatrixXd again = exact + size * random_columns(50, 3, 100 + seed);
    found += identifiability_of(once, again - once).directions.size() == 1 ? 1 : 0;
    MatrixXd apart = exact;
    apart.col(2) += 100.0 * size * random_columns(50, 1, 200);
    const MatrixXd error = size * random_columns(50, 3, 300 + seed);
    falsely += identifiability_of(apart + error, error).directions.empty() ? 0 : 1;
    EXPECT_TRUE(identifiability_of(once, {}).directions.empty());
  }
  EXPECT_EQ(found, 50);
  EXPECT_EQ(falsely, 0);
}

TEST(Identifiability, AsksWhereTheErrorsLeaveADirectionInDoubt) {
  const MatrixXd own = random_columns(30, 2, 5);
  MatrixXd j(30, 3);
  j << own, own.col(0) - own.col(1);
  j += 0.05 * random_columns(30, 3, 6);
  const MatrixXd error = 0.05 * random_columns(30, 3, 7);
  VectorXd asked;
  const auto check = [&](bool answer) {
    return [&asked, answer](const VectorXd& direction) {
      asked = direction;
      return answer;
    };
  };
  EXPECT_TRUE(identifiability_of(j, error, check(false)).directions.empty());
  asked /= asked[0];
  EXPECT_NEAR(asked[2], -1.0, 0.2);  // four times the errors of 0.05
  EXPECT_EQ(identifiability_of(j, error, check(true)).directions.size(), 1u);
}

TEST(Identifiability, WhereTheCheckCannotTellTheErrorsDecide) {
  const MatrixXd own = random_columns(30, 2, 5);
  MatrixXd j(30, 3);
  j << own, own.col(0) - own.col(1);
  const MatrixXd error = 0.05 * random_columns(30, 3, 7);
  const NullCheck cannot_tell = [](const VectorXd&) { return std::nullopt; };
  EXPECT_EQ(identifiability_of(j, error, cannot_tell).directions.size(), 1u);
  j.col(2) += 0.5 * random_columns(30, 1, 9);
  EXPECT_TRUE(identifiability_of(j, error, cannot_tell).directions.empty());
}

TEST(Identifiability, ManyMoreNumbersThanReadingsAreOpen) {
  const Identifiability found = identifiability_of(random_columns(2, 5, 8), {});
  EXPECT_EQ(found.directions.size(), 3u);
  EXPECT_EQ(found.known, std::vector<bool>(5, false));
}

TEST(Identifiability, SaysInWordsHowNumbersGoTogether) {
  EXPECT_EQ(null_words({{"g", "", -1.0, true}, {"a", "N", 1.0, true}, {"b", "N", 1.0, true}}),
            "g, a and b scale together, in the powers -1, 1 and 1: no reading changes");
  EXPECT_EQ(null_words({{"x", "mm", 1.0, false}, {"y", "mm", -1.0, false}}),
            "x and y shift together, by 1 and -1 mm: no reading changes");
  EXPECT_EQ(null_words({{"a", "N", 1.0, true}, {"x", "mm", 20.0, false}}),
            "a and x move together, by 1 % and 0.2 mm: no reading changes");
  EXPECT_EQ(null_words({{"a", "N", 1.0, true}}), "no reading changes with a");
}

}  // namespace
}  // namespace snare::identification
