#include "study/refined_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace snare::study {
namespace {

/// Runs a grid to its end on a quantity that is a function of the places along the axes.
class Refinement {
 public:
  using Quantity = std::function<Seen(const std::vector<std::uint64_t>&)>;
  Refinement(const RefinedGrid::Settings& settings, Quantity quantity)
      : axes_(settings.axes), grid_(settings), quantity_(std::move(quantity)) {
    while (!grid_.finished()) {
      std::vector<Seen> seen;
      for (const std::uint64_t index : grid_.next()) {
        EXPECT_EQ(grid_.inferred(index), std::nullopt);
        seen.push_back(truth(index));
      }
      ++rounds_;
      grid_.tell(std::move(seen));
    }
  }
  [[nodiscard]] Seen truth(std::uint64_t index) const {
    std::vector<std::uint64_t> place(axes_.size());
    for (std::size_t j = axes_.size(); j-- > 0;) {
      place[j] = index % axes_[j].points;
      index /= axes_[j].points;
    }
    return quantity_(place);
  }
  /// Cases that were not run and of which the quantity is farther than a bound from what is inferred.
  [[nodiscard]] std::uint64_t wrong(double bound = 0.0) const {
    std::uint64_t count = 0;
    for (std::uint64_t k = 0; k < grid_.points(); ++k) {
      const std::optional<Seen> inferred = grid_.inferred(k);
      const Seen true_one = truth(k);
      count += inferred &&
               (inferred->word != true_one.word || std::abs(inferred->number - true_one.number) > bound);
    }
    return count;
  }
  [[nodiscard]] std::uint64_t inferred() const {
    std::uint64_t count = 0;
    for (std::uint64_t k = 0; k < grid_.points(); ++k) count += grid_.inferred(k).has_value() ? 1 : 0;
    return count;
  }
  [[nodiscard]] const RefinedGrid& grid() const { return grid_; }
  [[nodiscard]] int rounds() const { return rounds_; }

 private:
  std::vector<RefinedGrid::Axis> axes_;
  RefinedGrid grid_;
  Quantity quantity_;
  int rounds_ = 0;
};

double radius(const std::vector<std::uint64_t>& place, double centre) {
  double square = 0.0;
  for (const std::uint64_t x : place)
    square += (static_cast<double>(x) - centre) * (static_cast<double>(x) - centre);
  return std::sqrt(square);
}

Seen yes_or_no(bool yes) {
  return {0.0, yes ? "true" : "false"};
}

// A disc: its edge is followed, and its inside and outside are inferred, with cases in proportion to the
// edge.
TEST(RefinedGrid, FollowsTheEdgeOfADisc) {
  std::uint64_t last = 0;
  for (const int levels : {2, 3, 4, 5}) {
    const std::uint64_t points = (10U << static_cast<unsigned>(levels)) + 1;
    const double steps = static_cast<double>(points - 1);
    const Refinement disc({{{points, true}, {points, true}}, levels, 0.0}, [&](const auto& place) {
      return yes_or_no(radius(place, 0.47 * steps) < 0.33 * steps);
    });
    EXPECT_EQ(disc.wrong(), 0U);
    EXPECT_EQ(disc.grid().told() + disc.inferred(), points * points);
    // A digital circle passes 8 r cells. Of each level two cases a cell were enough, and every level has half
    // of the next one's.
    EXPECT_LT(static_cast<double>(disc.grid().told()), 121.0 + 2.0 * 2.0 * 8.0 * 0.33 * steps);
    if (last > 0) {
      EXPECT_LT(disc.grid().told(), 5 * last / 2);
    }
    last = disc.grid().told();
  }
}

// A tongue that leaves the cells in which it was seen first is followed through cells that seemed to agree.
TEST(RefinedGrid, GoesBackToCellsThatSeemedToAgree) {
  // A strip two steps wide from (0, 0) along a diagonal that misses the corners of the first cells but the
  // first.
  const Refinement strip({{{65, true}, {65, true}}, 4, 0.0}, [](const auto& place) {
    const double x = static_cast<double>(place[0]), y = static_cast<double>(place[1]);
    return yes_or_no(std::abs(y - 0.8 * x) <= 1.0);
  });
  EXPECT_EQ(strip.wrong(), 0U);
  EXPECT_GT(strip.inferred(), 2500U);
}

// What no first corner shows is not seen, as its description says.
TEST(RefinedGrid, DoesNotSeeAnIslandWithinACell) {
  const Refinement island({{{17, true}, {17, true}}, 3, 0.0},
                          [](const auto& place) { return yes_or_no(radius(place, 4.0) < 2.5); });
  EXPECT_EQ(island.grid().told(), 9U);
  EXPECT_GT(island.wrong(), 0U);
}

TEST(RefinedGrid, ThreeAxesAndAListThatHasNoOrder) {
  const Refinement ball({{{17, true}, {2, false}, {17, true}, {17, true}}, 2, 0.0}, [](const auto& place) {
    const std::vector<std::uint64_t> where{place[0], place[2], place[3]};
    return yes_or_no(radius(where, 7.7) < (place[1] == 0 ? 6.2 : 0.0));
  });
  EXPECT_EQ(ball.wrong(), 0U);
  EXPECT_LT(ball.grid().told(), 2U * 17U * 17U * 17U / 3U);
  // Nothing happens in the second half of the list: its first cells are all that was run of it, and 125 cases
  // are their corners.
  std::uint64_t run = 0;
  for (std::uint64_t k = 0; k < ball.grid().points(); ++k)
    run += k / (17U * 17U) % 2 == 1 && !ball.grid().inferred(k) ? 1 : 0;
  EXPECT_EQ(run, 125U);
}

// Numbers: between corners that are close, straight between them. A paraboloid has the error of straight
// interpolation in a cell, an eighth of the second differences over it, twice for two axes.
TEST(RefinedGrid, InterpolatesNumbersThatAreClose) {
  const double by = 0.05;
  const auto bowl = [](const auto& place) {
    const double x = static_cast<double>(place[0]) / 64.0, y = static_cast<double>(place[1]) / 64.0;
    return Seen{x * x + y * y, ""};
  };
  const Refinement all({{{65, true}, {65, true}}, 4, by}, bowl);
  EXPECT_GT(all.inferred(), 1000U);
  EXPECT_EQ(all.wrong(2.0 * by / 8.0), 0U);
  const Refinement flat({{{65, true}, {65, true}}, 4, 3.0}, bowl);
  EXPECT_EQ(flat.grid().told(), 25U);  // nothing is farther apart
  const Refinement plane({{{9, true}, {9, true}}, 3, 1e3}, [](const auto& place) {
    return Seen{3.0 * static_cast<double>(place[0]) - static_cast<double>(place[1]), ""};
  });
  EXPECT_EQ(plane.grid().told(), 4U);
  EXPECT_EQ(plane.wrong(1e-12), 0U);
}

// A case without a result differs from one with a result, and two without differ by why.
TEST(RefinedGrid, WordsInPlaceOfNumbers) {
  const Refinement thirds({{{33, true}}, 3, 10.0}, [](const auto& place) {
    if (place[0] < 7) return Seen{0.0, "refused"};
    if (place[0] < 21) return Seen{0.0, "failed"};
    return Seen{5.0, ""};
  });
  EXPECT_EQ(thirds.wrong(), 0U);
  EXPECT_EQ(thirds.grid().told(), 5U + 2U * 3U);  // the first corners, and three halvings of two cells
  EXPECT_EQ(thirds.rounds(), 4);
}

// Of two neighbours that differ both were run, whatever the quantity: random blobs.
TEST(RefinedGrid, NothingIsInferredBesideWhatDiffers) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Refinement blobs({{{33, true}, {33, true}}, 3, 0.0}, [seed](const auto& place) {
      const double x = 0.2 * static_cast<double>(place[0]), y = 0.2 * static_cast<double>(place[1]);
      const double s = static_cast<double>(seed);
      return yes_or_no(std::sin(x + s) + std::sin(1.7 * y + 2.0 * s) + std::sin(1.3 * (x - y) + 3.0 * s) >
                       0.4);
    });
    const auto said = [&](std::uint64_t k) { return blobs.grid().inferred(k).value_or(blobs.truth(k)).word; };
    for (std::uint64_t k = 0; k < blobs.grid().points(); ++k) {
      for (const std::uint64_t next : {k % 33 < 32 ? k + 1 : k, k / 33 < 32 ? k + 33 : k}) {
        const bool inferred = blobs.grid().inferred(k) || blobs.grid().inferred(next);
        ASSERT_TRUE(said(k) == said(next) || !inferred)
            << "seed " << seed << ", cases " << k << " and " << next;
      }
    }
    EXPECT_LT(blobs.grid().told(), 33U * 33U / 2U);
  }
}

}  // namespace
}  // namespace snare::study
