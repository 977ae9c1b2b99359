// Rates eliminated and factorisation without pivoting, against dense Eigen.

#include "numerics/dae_solver.hpp"
#include "tests/support/sparse_product.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <random>
#include <utility>
#include <vector>

namespace snare::numerics {
namespace {

/// A chain of n places 0 ... n-1 and their rates n ... 2n-1 with rows c x - v and banded balances, and two
/// unknowns that are coupled with the middle of the chain.
SparseMatrix chain(int n, double diagonal, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Triplet> list;
  for (int i = 0; i < n; ++i) {
    list.push_back({i, i, 50.0});
    list.push_back({i, n + i, -1.0});
    for (int j = std::max(0, i - 4); j <= std::min(n - 1, i + 4); ++j) {
      list.push_back({n + i, j, uniform(random) + (i == j ? diagonal : 0.0)});
      list.push_back({n + i, n + j, 0.1 * uniform(random)});
    }
  }
  for (int b = 2 * n; b < 2 * n + 2; ++b) {
    list.push_back({b, b, diagonal});
    for (int i = n / 2; i < n / 2 + 3; ++i) {
      list.push_back({b, i, uniform(random)});
      list.push_back({b, n + i, uniform(random)});
      list.push_back({n + i, b, uniform(random)});
    }
  }
  return from_triplets(2 * n + 2, list);
}

std::vector<std::pair<int, int>> rates_of(int n) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < n; ++i) pairs.emplace_back(i, n + i);
  return pairs;
}

TEST(DaeSolver, GivesTheDenseSolution) {
  constexpr int n = 40;
  DaeSolver solver(chain(n, 20.0, 1), rates_of(n));
  ASSERT_EQ(solver.pairs().size(), 40u);
  for (const unsigned seed : {1u, 2u, 3u}) {
    const SparseMatrix a = chain(n, 20.0, seed);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(a.order, -1.0, 2.0);
    ASSERT_TRUE(solver.factorize(a));
    for (const double factor : {1.0, 3.0}) {
      Eigen::VectorXd x = factor * b;
      ASSERT_TRUE(solver.solve(a, x));
      // Round-off times a condition of some hundreds.
      EXPECT_LT((x - dense(a).lu().solve(factor * b)).norm(), 1e-12 * x.norm());
    }
  }
  EXPECT_EQ(solver.pivoted(), 0);
}

// A tail 0 - 1 on four unknowns that are all coupled is eliminated first. With 1e-10 at its end six digits
// are lost, with 1e-18 all; with a zero the end comes last; and where what is left of 1 behind it is zero
// there is no way without pivots. A place with its rate stands beside, else there would be pivots always.
TEST(DaeSolver, RefinesOrPivotsWhereDigitsWouldBeLost) {
  struct Tail {
    double first, second;
    long pivots;
  };
  for (const Tail& tail : {Tail{1e-10, 3.0, 0}, Tail{1e-18, 3.0, 0}, Tail{0.0, 3.0, 0}, Tail{1.0, 1.0, 1}}) {
    std::vector<Triplet> list{{0, 0, tail.first}, {0, 1, 1.0}, {1, 0, 1.0},  {1, 1, tail.second},
                              {1, 2, 2.0},        {2, 1, 0.5}, {6, 6, 50.0}, {6, 7, -1.0},
                              {7, 6, 2.0},        {7, 7, 0.1}};
    for (int i = 2; i < 6; ++i) {
      for (int j = 2; j < 6; ++j) list.push_back({i, j, i == j ? 3.0 : 1.0 / (i + 2 * j)});
    }
    const SparseMatrix a = from_triplets(8, list);
    DaeSolver solver(a, {{6, 7}});
    ASSERT_TRUE(solver.factorize(a));
    for (const double factor : {1.0, 0.3}) {
      const Eigen::VectorXd b = factor * Eigen::VectorXd::LinSpaced(8, 1.0, 8.0);
      Eigen::VectorXd x = b;
      ASSERT_TRUE(solver.solve(a, x));
      EXPECT_LT((dense(a) * x - b).norm(), 1e-14 * b.norm()) << tail.first;  // round-off
    }
    EXPECT_EQ(solver.pivoted(), tail.pivots) << tail.first;
  }
}

TEST(DaeSolver, SaysWhenAMatrixIsSingular) {
  const SparseMatrix a = from_triplets(2, {{0, 0, 1.0}, {0, 1, 2.0}, {1, 0, 2.0}, {1, 1, 4.0}});
  DaeSolver solver(a, {});
  EXPECT_FALSE(solver.factorize(a));
}

// A row of a place to which others add, a multiplier for one, gives no rate.
TEST(DaeSolver, LeavesRatesThatTheirRowDoesNotGive) {
  const std::vector<Triplet> list{{0, 0, 10.0}, {0, 2, -1.0}, {1, 1, 10.0}, {1, 3, -1.0},
                                  {1, 4, 1.0},  {2, 0, 3.0},  {2, 2, 1.0},  {3, 1, 3.0},
                                  {3, 3, 1.0},  {3, 4, 2.0},  {4, 3, 1.0},  {4, 1, 0.5}};
  const SparseMatrix a = from_triplets(5, list);
  DaeSolver solver(a, {{0, 2}, {1, 3}});
  ASSERT_EQ(solver.pairs(), (std::vector<std::pair<int, int>>{{0, 2}}));
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(5, 1.0, 2.0);
  Eigen::VectorXd x = b;
  ASSERT_TRUE(solver.factorize(a));
  ASSERT_TRUE(solver.solve(a, x));
  EXPECT_LT((dense(a) * x - b).norm(), 1e-13 * b.norm());  // round-off
}

// Unknowns that no other row has, between those of the chain, and one whose row has nothing at all.
TEST(DaeSolver, GivesWhatStandsAloneByItsDiagonal) {
  constexpr int n = 20;
  const SparseMatrix a = chain(n, 20.0, 4);
  std::vector<Triplet> list{{0, 0, 4.0}, {a.order + 1, a.order + 1, -2.0}};
  for (int j = 0; j < a.order; ++j) {
    for (int s = a.column_start[static_cast<std::size_t>(j)];
         s < a.column_start[static_cast<std::size_t>(j) + 1]; ++s)
      list.push_back({a.row[static_cast<std::size_t>(s)] + 1, j + 1, a.value[static_cast<std::size_t>(s)]});
  }
  std::vector<std::pair<int, int>> pairs = rates_of(n);
  for (auto& [p, v] : pairs) {
    ++p;
    ++v;
  }
  SparseMatrix all = from_triplets(a.order + 2, list);
  DaeSolver solver(all, pairs);
  ASSERT_TRUE(solver.factorize(all));
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(all.order, -1.0, 2.0);
  Eigen::VectorXd x = b;
  ASSERT_TRUE(solver.solve(all, x));
  EXPECT_LT((x - dense(all).lu().solve(b)).norm(), 1e-12 * x.norm());
  EXPECT_EQ(x[0], b[0] / 4.0);
  EXPECT_EQ(x[all.order - 1], b[all.order - 1] / -2.0);
  all.value.front() = 0.0;
  EXPECT_FALSE(solver.factorize(all));
}

}  // namespace
}  // namespace snare::numerics
