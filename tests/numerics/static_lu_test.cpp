// Factorisation without pivoting on patterns of all kinds, against dense Eigen: the DAE solver would mend
// what is wrong here.

#include "numerics/static_lu.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <random>
#include <vector>

namespace snare::numerics {
namespace {

/// Chains of vertices with one to six unknowns each, coupled with the next two, all with a few unknowns in
/// common; some unknowns stand alone. Rows are dominated by their diagonal.
SparseMatrix chains(std::mt19937& random) {
  const auto integer = [&](int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
  };
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Triplet> list;
  const int common = integer(0, 7);
  int n = common;
  const auto couple = [&](int row, int column) { list.push_back({row, column, uniform(random)}); };
  for (int i = 0; i < common; ++i) {
    for (int j = 0; j < common; ++j) couple(i, j);
  }
  const int count = integer(1, 4);
  for (int chain = 0; chain < count; ++chain) {
    std::vector<std::vector<int>> vertices(static_cast<std::size_t>(integer(1, 12)));
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const int size = integer(1, 6);
      for (int k = 0; k < size; ++k) vertices[v].push_back(n++);
      for (std::size_t w = v < 2 ? 0 : v - 2; w <= v; ++w) {
        for (const int i : vertices[v]) {
          for (const int j : vertices[w]) {
            couple(i, j);
            if (w != v && integer(0, 3) > 0) couple(j, i);  // the pattern need not be symmetric
          }
        }
      }
      for (int i = 0; i < common && integer(0, 2) == 0; ++i) {
        couple(vertices[v].front(), i);
        couple(i, vertices[v].back());
      }
    }
    n += integer(0, 2);
  }
  for (int i = 0; i < n; ++i) list.push_back({i, i, 40.0});
  return from_triplets(n, list);
}

TEST(StaticLu, GivesTheDenseSolutionOnAnyPattern) {
  std::mt19937 random(7);
  for (int k = 0; k < 200; ++k) {
    SparseMatrix a = chains(random);
    StaticLu lu(a);
    for (const double change : {1.0, 0.5}) {
      for (double& value : a.value) value *= change;
      const Eigen::VectorXd b = Eigen::VectorXd::Random(a.order);
      Eigen::VectorXd x = b;
      ASSERT_TRUE(lu.factorize(a));
      lu.solve(x);
      // Round-off times a condition of some tens.
      EXPECT_LT((x - dense(a).lu().solve(b)).norm(), 1e-12 * x.norm())
          << "matrix " << k << " of order " << a.order;
    }
  }
}

}  // namespace
}  // namespace snare::numerics
