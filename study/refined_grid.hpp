#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace snare::study {

/// What a case says of the quantity by which a grid is refined.
struct Seen {
  double number = 0.0;  ///< in the unit of the quantity
  /// What stands in place of a number: "true", a text, why there is no result. Empty: it is the number.
  std::string word;
};

/// A grid of which those cases are run that tell where a quantity changes.                    theory.md (S.7)
///
/// The first cells are 2^levels steps of the grid wide along every refined axis, and all their corners are
/// run. Halved again and again, a case in the middle of an edge, a face or a cell is run where the corners of
/// that differ, and else inferred from them. Of two neighbours that differ both are run. A change that lies
/// within a first cell, none of its corners on the other side, is not seen.
class RefinedGrid {
 public:
  struct Axis {
    std::uint64_t points = 1;  ///< of the grid; where it is refined a multiple of 2^levels, and one
    bool refined = true;       ///< else all its points are run: a list of things that have no order
  };
  struct Settings {
    /// The last one fastest; 1 to most_axes of them refined, at most most_points points in all.
    std::vector<Axis> axes;
    int levels = 1;           ///< halvings, >= 1
    double differs_by = 0.0;  ///< numbers that are no farther apart agree, in the quantity's unit
  };
  static constexpr std::size_t most_axes = 6;
  static constexpr std::uint64_t most_points = 1000000;

  explicit RefinedGrid(Settings settings);

  /// Numbers of the next cases in the grid, ascending, which may run at a time; none: it is finished.
  [[nodiscard]] const std::vector<std::uint64_t>& next() const noexcept { return asked_; }
  /// What the cases of next() came to, in their order.
  void tell(std::vector<Seen> seen);

  [[nodiscard]] bool finished() const noexcept { return asked_.empty(); }  ///< no case is to be run any more
  [[nodiscard]] std::uint64_t told() const noexcept { return told_; }      ///< cases so far
  /// What a case that was not run would say: the mean of the corners between which it lies; nothing where it
  /// was run or is not known yet.
  [[nodiscard]] std::optional<Seen> inferred(std::uint64_t index) const;
  [[nodiscard]] std::uint64_t points() const noexcept { return points_.size(); }  ///< of the grid

 private:
  enum class State : char { unknown, asked, run, inferred };
  struct Point {
    State state = State::unknown;
    Seen seen;
  };

  /// Calls use(index) for every corner of a cell of the width at hand.
  template <class Use>
  void for_each_corner(const Use& use);
  [[nodiscard]] bool agree(const std::vector<std::uint64_t>& points) const;
  void ask_neighbours();
  void halve();
  void collect_asked();
  [[nodiscard]] std::uint64_t place(std::uint64_t index, std::size_t axis) const;  // along an axis

  Settings settings_;
  std::vector<std::uint64_t> strides_;  // of the axes
  std::vector<std::size_t> refined_;    // axes
  std::vector<Point> points_;
  std::uint64_t width_ = 1;  // of the cells at hand
  std::vector<std::uint64_t> asked_;
  std::uint64_t told_ = 0;
};

}  // namespace snare::study
