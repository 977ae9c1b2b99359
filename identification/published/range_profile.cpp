#include "identification/published/range_profile.hpp"

#include "identification/published/importance_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace snare::identification {

namespace {

using Eigen::Index;

/// log p at given ranges.
struct Node {
  double log_to = 0.0;              // of the common range
  double guide = impossible;        // what log p is at most with a medium number of readings
  std::vector<double> by_readings;  // empty where only the guide was asked for

  [[nodiscard]] double largest() const { return by_readings.empty() ? guide : std::ranges::max(by_readings); }
};

/// The profile of some curves over common ranges.
class CommonRanges {
 public:
  CommonRanges(const FitRanges& ranges, const std::vector<TouchCurve>& curves, double floor)
      : ranges_(ranges), curves_(curves), floor_(floor), medium_(ranges.readings().size() / 3) {}

  /// Nodes as dense as p asks for, the edges of all bins among them.
  [[nodiscard]] std::vector<Node> nodes() const;
  [[nodiscard]] std::vector<double> by_readings(const FitCells& cells) const;

 private:
  [[nodiscard]] double guide(const FitCells& cells, std::size_t readings) const {
    std::vector<std::optional<double>> zeros(curves_.size());
    return by_scatter(cells, readings, curves_, zeros, -impossible).most;
  }
  [[nodiscard]] FitCells at(double log_to) const {
    return ranges_.at(std::vector<double>(ranges_.series(), std::exp(log_to)));
  }

  const FitRanges& ranges_;
  const std::vector<TouchCurve>& curves_;
  double floor_;
  std::size_t medium_;
};

std::vector<double> CommonRanges::by_readings(const FitCells& cells) const {
  std::vector<std::optional<double>> zeros(curves_.size());
  std::vector<double> result;
  for (std::size_t n = 0; n < ranges_.readings().size(); ++n) {
    const ByScatter all = by_scatter(cells, n, curves_, zeros, floor_);
    const double log = log_sum(std::vector<double>(all.log.begin(), all.log.end())) + std::log(scatter_step);
    result.push_back(all.most > floor_ ? log : all.most);
  }
  return result;
}

/// Index of the interval (i, i + 1) that is to be halved next: next to the best node until p hardly changes,
/// and wherever p matters.
std::optional<std::size_t> next_to_halve(const std::vector<Node>& nodes, double matters) {
  constexpr double next_to_best = 0.5, anywhere = 1.0, narrow = 1e-4, far = 1e3;
  const auto best = static_cast<std::size_t>(
      std::distance(nodes.begin(), std::ranges::max_element(nodes, {}, &Node::largest)));
  std::optional<std::size_t> found;
  double largest_change = 0.0;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const Node &a = nodes[i], &b = nodes[i + 1];
    const bool next = i == best || i + 1 == best;
    if (b.log_to - a.log_to < narrow) continue;
    if (!next && !(std::max(a.largest(), b.largest()) > nodes[best].largest() - matters)) continue;
    const double change = std::min(std::abs(a.largest() - b.largest()), far);
    if (!(change > (next ? next_to_best : anywhere))) continue;
    const double weight = next ? 10.0 * change : change;
    if (weight > largest_change) found = i, largest_change = weight;
  }
  return found;
}

std::vector<Node> CommonRanges::nodes() const {
  constexpr int most_halvings = 60;
  constexpr double hopeless = 100.0;  // of the logarithm, below the floor
  constexpr double worth = 20.0;      // of the logarithm of a guide, below the best one
  constexpr double matters = 8.0;     // of the logarithm of p
  std::vector<Node> nodes;
  for (const FitCells& edge : ranges_.edges())
    nodes.push_back({std::log(edge.to.front()), guide(edge, medium_), {}});
  const auto halve = [&](std::size_t i) {
    const double log_to = 0.5 * (nodes[i].log_to + nodes[i + 1].log_to);
    const FitCells medium = ranges_.at(std::vector<double>(ranges_.series(), std::exp(log_to)), medium_);
    return nodes.insert(nodes.begin() + static_cast<std::ptrdiff_t>(i) + 1, {log_to, guide(medium, 0), {}});
  };
  for (int k = 0; k < most_halvings; ++k) {  // to the best range by the guides alone
    const std::optional<std::size_t> i = next_to_halve(nodes, 0.0);
    if (!i) break;
    halve(*i);
  }
  double best = impossible;
  for (const Node& node : nodes) best = std::max(best, node.guide);
  if (best < floor_ - hopeless) return nodes;
  for (Node& node : nodes)
    if (node.guide > best - worth) node.by_readings = by_readings(at(node.log_to));
  for (int k = 0; k < most_halvings; ++k) {
    const std::optional<std::size_t> i = next_to_halve(nodes, matters);
    if (!i) break;
    const auto node = halve(*i);
    node->by_readings = by_readings(at(node->log_to));
  }
  return nodes;
}

}  // namespace

ByScatter by_scatter(const FitCells& cells, std::size_t readings, const std::vector<TouchCurve>& curves,
                     std::vector<std::optional<double>>& zeros, double floor) {
  double centre = 0.0;
  for (std::size_t k = 0; k < curves.size(); ++k)
    centre += cells.cell(readings, k).log_scatter / static_cast<double>(curves.size());
  ByScatter all{
      centre + first_scatter + scatter_step * Eigen::ArrayXd::LinSpaced(scatters, 0.0, scatters - 1.0),
      Eigen::ArrayXd::Constant(scatters, impossible)};
  Eigen::ArrayXd most = Eigen::ArrayXd::Zero(scatters);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const FitCell& cell = cells.cell(readings, k);
    zeros[k] = best_zero(cell, curves[k], zeros[k]);
    most += most_likelihoods(cell, curves[k], *zeros[k], all.log_sigma);
  }
  all.most = most.maxCoeff();
  std::vector<Index> counted;
  for (Index s = 0; s < scatters; ++s)
    if (most[s] > floor) counted.push_back(s);
  if (counted.empty()) return all;
  const Eigen::ArrayXd log_sigma = all.log_sigma(counted);
  all.log(counted).setZero();
  for (std::size_t k = 0; k < curves.size(); ++k)
    all.log(counted) += log_likelihoods(cells.cell(readings, k), curves[k], *zeros[k], log_sigma);
  return all;
}

RangeProfile range_profile(const FitRanges& ranges, const std::vector<TouchCurve>& curves, double floor) {
  const std::size_t columns = ranges.readings().size();
  RangeProfile profile;
  profile.log.assign(ranges.ranges().size() * columns, impossible);
  profile.best_to.assign(profile.log.size(), 0.0);
  if (curves.size() != ranges.series()) return profile;
  const CommonRanges common(ranges, curves, floor);
  std::vector<Node> nodes = common.nodes();
  for (Node& node : nodes)
    if (node.by_readings.empty()) node.by_readings.assign(columns, std::min(node.guide, floor));
  std::size_t first = 0;
  for (std::size_t r = 0; r < ranges.bins(); ++r) {
    // Rounding apart, the nodes of a bin are those up to its upper edge.
    const double upper = std::log(ranges.ranges()[r].to.front()) - 1e-9;
    std::size_t last = first + 1;
    while (nodes[last].log_to < upper) ++last;
    const double width = nodes[last].log_to - nodes[first].log_to;
    for (std::size_t n = 0; n < columns; ++n) {
      std::vector<double> terms;
      double best = impossible;
      for (std::size_t i = first; i <= last; ++i) {
        const double below = i > first ? nodes[i].log_to - nodes[i - 1].log_to : 0.0;
        const double above = i < last ? nodes[i + 1].log_to - nodes[i].log_to : 0.0;
        terms.push_back(nodes[i].by_readings[n] + std::log(0.5 * (below + above) / width));
        if (nodes[i].by_readings[n] > best) {
          best = nodes[i].by_readings[n];
          profile.best_to[r * columns + n] = std::exp(nodes[i].log_to);
        }
      }
      profile.log[r * columns + n] = log_sum(terms);
      profile.largest = std::max(profile.largest, best);
    }
    first = last;
  }
  for (std::size_t j = 0; j < ranges.taut().size(); ++j) {
    const std::vector<double> log = common.by_readings(ranges.taut()[j]);
    std::ranges::copy(log, profile.log.begin() + static_cast<std::ptrdiff_t>((ranges.bins() + j) * columns));
    profile.largest = std::max(profile.largest, std::ranges::max(log));
  }
  return profile;
}

}  // namespace snare::identification
