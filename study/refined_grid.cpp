#include "study/refined_grid.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace snare::study {

RefinedGrid::RefinedGrid(Settings settings)
    : settings_(std::move(settings)), strides_(settings_.axes.size()) {
  std::uint64_t count = 1;
  for (std::size_t j = settings_.axes.size(); j-- > 0;) {
    strides_[j] = count;
    count *= settings_.axes[j].points;
  }
  width_ = std::uint64_t{1} << static_cast<unsigned>(settings_.levels);
  for (std::size_t j = 0; j < settings_.axes.size(); ++j) {
    if (!settings_.axes[j].refined) continue;
    assert((settings_.axes[j].points - 1) % width_ == 0 && settings_.axes[j].points > 1);
    refined_.push_back(j);
  }
  assert(!refined_.empty() && refined_.size() <= most_axes && count <= most_points);
  points_.resize(count);
  for_each_corner([this](std::uint64_t index) { points_[index].state = State::asked; });
  collect_asked();
}

template <class Use>
void RefinedGrid::for_each_corner(const Use& use) {
  for (std::uint64_t index = 0; index < points_.size(); ++index)
    if (std::ranges::all_of(refined_, [&](std::size_t j) { return place(index, j) % width_ == 0; }))
      use(index);
}

bool RefinedGrid::agree(const std::vector<std::uint64_t>& points) const {
  const Seen& first = points_[points.front()].seen;
  double low = first.number, high = first.number;
  for (const std::uint64_t index : points) {
    const Seen& one = points_[index].seen;
    if (one.word != first.word) return false;
    low = std::min(low, one.number);
    high = std::max(high, one.number);
  }
  return high - low <= settings_.differs_by;
}

void RefinedGrid::tell(std::vector<Seen> seen) {
  assert(seen.size() == asked_.size() && !finished());
  told_ += seen.size();
  for (std::size_t k = 0; k < seen.size(); ++k) points_[asked_[k]] = {State::run, std::move(seen[k])};
  ask_neighbours();
  collect_asked();
  while (asked_.empty() && width_ > 1) {
    halve();
    collect_asked();
  }
}

/// A case that was run may differ from what is inferred beside it: then that is run as well.
void RefinedGrid::ask_neighbours() {
  for_each_corner([this](std::uint64_t index) {
    for (const std::size_t j : refined_) {
      if (place(index, j) + width_ >= settings_.axes[j].points) continue;
      const std::uint64_t next = index + width_ * strides_[j];
      if (agree({index, next})) continue;
      for (const std::uint64_t one : {index, next})
        if (points_[one].state == State::inferred) points_[one].state = State::asked;
    }
  });
}

/// A case in the middle of an edge, a face or a cell is inferred where its corners agree, and asked where
/// they differ.
void RefinedGrid::halve() {
  const std::uint64_t before = width_;
  width_ /= 2;
  for_each_corner([&](std::uint64_t index) {
    if (points_[index].state != State::unknown) return;
    std::vector<std::uint64_t> corners{index};
    for (const std::size_t j : refined_) {
      if (place(index, j) % before == 0) continue;
      const std::size_t n = corners.size();
      for (std::size_t k = 0; k < n; ++k) {
        corners.push_back(corners[k] + width_ * strides_[j]);
        corners[k] -= width_ * strides_[j];
      }
    }
    if (!agree(corners)) {
      points_[index].state = State::asked;
      return;
    }
    double sum = 0.0;
    for (const std::uint64_t corner : corners) sum += points_[corner].seen.number;
    points_[index] = {State::inferred,
                      {sum / static_cast<double>(corners.size()), points_[corners.front()].seen.word}};
  });
}

void RefinedGrid::collect_asked() {
  asked_.clear();
  for (std::uint64_t index = 0; index < points_.size(); ++index)
    if (points_[index].state == State::asked) asked_.push_back(index);
}

std::uint64_t RefinedGrid::place(std::uint64_t index, std::size_t axis) const {
  return index / strides_[axis] % settings_.axes[axis].points;
}

std::optional<Seen> RefinedGrid::inferred(std::uint64_t index) const {
  const Point& point = points_[index];
  return point.state == State::inferred ? std::optional(point.seen) : std::nullopt;
}

}  // namespace snare::study
