#include "identification/published/range_profile.hpp"

#include "identification/published/importance_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace snare::identification {

namespace {

using Eigen::Index;

/// log p at given ranges.
struct Node {
  double log_to = 0.0;                // of the common range
  double guide = impossible;          // what log p is at most with a medium number of readings
  std::vector<ByScatter> by_scatter;  // by number of readings; empty where only the guide was asked for
  std::vector<double> by_readings;    // the scatter integrated out

  [[nodiscard]] double largest() const { return by_readings.empty() ? guide : std::ranges::max(by_readings); }
};

/// The profile of some curves over common ranges.
class CommonRanges {
 public:
  CommonRanges(const FitRanges& ranges, std::vector<TouchCurve> curves)
      : ranges_(ranges), curves_(std::move(curves)), medium_(ranges.readings().size() / 3) {}

  /// Nodes with guides alone, dense about the best of them, the edges of all bins among them.
  [[nodiscard]] std::vector<Node> guides() const;
  /// The same nodes and more, as dense as p asks for where it is not below a floor.
  [[nodiscard]] std::vector<Node> filled(std::vector<Node> nodes, double floor) const;
  /// log p at other ranges, as of a node.
  [[nodiscard]] Node node_at(const FitCells& cells, double floor) const;

 private:
  [[nodiscard]] double guide(const FitCells& cells, std::size_t readings) const {
    std::vector<std::optional<double>> zeros(curves_.size());
    return by_scatter(cells, readings, curves_, zeros, -impossible).most;
  }
  void fill(Node& node, double floor) const {
    Node all = node_at(ranges_.at(std::vector<double>(ranges_.series(), std::exp(node.log_to))), floor);
    node.by_scatter = std::move(all.by_scatter);
    node.by_readings = std::move(all.by_readings);
  }
  std::vector<Node>::iterator halve(std::vector<Node>& nodes, std::size_t i) const {
    const double log_to = 0.5 * (nodes[i].log_to + nodes[i + 1].log_to);
    const FitCells medium = ranges_.at(std::vector<double>(ranges_.series(), std::exp(log_to)), medium_);
    return nodes.insert(nodes.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                        {log_to, guide(medium, 0), {}, {}});
  }

  const FitRanges& ranges_;
  std::vector<TouchCurve> curves_;
  std::size_t medium_;
};

constexpr int most_halvings = 60;

double best_guide(const std::vector<Node>& nodes) {
  return std::ranges::max_element(nodes, {}, &Node::guide)->guide;
}

Node CommonRanges::node_at(const FitCells& cells, double floor) const {
  std::vector<std::optional<double>> zeros(curves_.size());
  Node node;
  for (std::size_t n = 0; n < ranges_.readings().size(); ++n) {
    ByScatter all = by_scatter(cells, n, curves_, zeros, floor);
    const double log = log_sum(std::vector<double>(all.log.begin(), all.log.end())) + std::log(scatter_step);
    node.by_readings.push_back(all.most > floor ? log : all.most);
    node.by_scatter.push_back(std::move(all));
  }
  return node;
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

std::vector<Node> CommonRanges::guides() const {
  std::vector<Node> nodes;
  for (const FitCells& edge : ranges_.edges())
    nodes.push_back({std::log(edge.to.front()), guide(edge, medium_), {}, {}});
  for (int k = 0; k < most_halvings; ++k) {
    const std::optional<std::size_t> i = next_to_halve(nodes, 0.0);
    if (!i) break;
    halve(nodes, *i);
  }
  return nodes;
}

std::vector<Node> CommonRanges::filled(std::vector<Node> nodes, double floor) const {
  constexpr double worth = 20.0;   // of the logarithm of a guide, below the best one
  constexpr double matters = 8.0;  // of the logarithm of p
  const double best = best_guide(nodes);
  for (Node& node : nodes)
    if (node.guide > best - worth) fill(node, floor);
  for (int k = 0; k < most_halvings; ++k) {
    const std::optional<std::size_t> i = next_to_halve(nodes, matters);
    if (!i) break;
    fill(*halve(nodes, *i), floor);
  }
  return nodes;
}

constexpr double hopeless = 100.0;  // of the logarithm of a guide, below the floor

/// Half of the way [-] to the nodes on either side of node i among first to last.
template <class Place>
double half_way(const std::vector<Node>& nodes, std::size_t first, std::size_t i, std::size_t last,
                Place place) {
  const double below = i > first ? place(nodes[i]) - place(nodes[i - 1]) : 0.0;
  const double above = i < last ? place(nodes[i + 1]) - place(nodes[i]) : 0.0;
  return 0.5 * (below + above);
}

double log_place(const Node& node) {
  return node.log_to;
}
double even_place(const Node& node) {
  return std::exp(node.log_to);
}

/// Bins of common ranges.
void add_common(const FitRanges& ranges, const CommonRanges& common, double floor, RangeProfile& profile) {
  const std::size_t columns = ranges.readings().size();
  std::vector<Node> nodes = common.guides();
  if (!(best_guide(nodes) < floor - hopeless)) nodes = common.filled(std::move(nodes), floor);
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
        terms.push_back(nodes[i].by_readings[n] +
                        std::log(half_way(nodes, first, i, last, log_place) / width));
        if (nodes[i].by_readings[n] > best) {
          best = nodes[i].by_readings[n];
          profile.best_to[r * columns + n].assign(ranges.series(), std::exp(nodes[i].log_to));
        }
      }
      profile.log[r * columns + n] = log_sum(terms);
      profile.largest = std::max(profile.largest, best);
    }
    first = last;
  }
}

/// log p of one series with one number of readings over its own ranges, by a scatter in steps of
/// scatter_step.
struct OwnRange {
  double log_mean = impossible, largest = impossible;
  double to = 0.0;  // of the largest [m]
};
template <class Place>
std::map<long, OwnRange> own_range(const std::vector<Node>& nodes, std::size_t readings, Place place) {
  std::map<long, std::vector<double>> terms;
  std::map<long, OwnRange> result;
  const double whole = place(nodes.back()) - place(nodes.front());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].by_scatter.empty()) continue;
    const ByScatter& all = nodes[i].by_scatter[readings];
    const double log_share = std::log(half_way(nodes, 0, i, nodes.size() - 1, place) / whole);
    for (Index s = 0; s < all.log.size(); ++s) {
      if (all.log[s] == impossible) continue;
      const long at = std::lround(all.log_sigma[s] / scatter_step);
      terms[at].push_back(all.log[s] + log_share);
      OwnRange& own = result[at];
      if (all.log[s] > own.largest) own.largest = all.log[s], own.to = std::exp(nodes[i].log_to);
    }
  }
  for (auto& [at, own] : result) own.log_mean = log_sum(terms[at]);
  return result;
}

constexpr double far_off = 20.0;  // likewise, of the sum of guides of single series

/// Ranges of every series its own.
void add_own(const FitRanges& ranges, const std::vector<TouchCurve>& curves, double floor,
             RangeProfile& profile) {
  std::vector<CommonRanges> each;
  std::vector<std::vector<Node>> nodes;
  double guide = 0.0;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    each.emplace_back(ranges.single()[k], std::vector<TouchCurve>{curves[k]});
    nodes.push_back(each.back().guides());
    guide += best_guide(nodes.back());
  }
  if (guide < floor - far_off || guide == impossible) return;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const double others = guide - best_guide(nodes[k]);
    nodes[k] = each[k].filled(std::move(nodes[k]), floor - others);
  }
  const auto add = [&](std::size_t at, std::size_t n, auto place) {
    std::map<long, std::vector<OwnRange>> all;
    for (std::size_t k = 0; k < curves.size(); ++k)
      for (const auto& [scatter, own] : own_range(nodes[k], n, place))
        if (std::vector<OwnRange>& some = all[scatter]; some.size() == k) some.push_back(own);
    std::vector<double> terms;
    double best = impossible;
    for (const auto& [scatter, own] : all) {
      if (own.size() < curves.size()) continue;
      double mean = 0.0, largest = 0.0;
      for (const OwnRange& o : own) mean += o.log_mean, largest += o.largest;
      terms.push_back(mean);
      if (!(largest > best)) continue;
      best = largest;
      profile.best_to[at].clear();
      for (const OwnRange& o : own) profile.best_to[at].push_back(o.to);
    }
    profile.log[at] = log_sum(terms) + std::log(scatter_step);
    profile.largest = std::max(profile.largest, best + std::log(scatter_step));
  };
  const std::size_t columns = ranges.readings().size();
  for (std::size_t n = 0; n < columns; ++n) {
    add(ranges.bins() * columns + n, n, log_place);
    add((ranges.bins() + 1) * columns + n, n, even_place);
  }
}

}  // namespace

ByScatter by_scatter(const FitCells& cells, std::size_t readings, const std::vector<TouchCurve>& curves,
                     std::vector<std::optional<double>>& zeros, double floor) {
  double centre = 0.0;
  for (std::size_t k = 0; k < curves.size(); ++k)
    centre += cells.cell(readings, k).log_scatter / static_cast<double>(curves.size());
  const double first = std::round((centre + first_scatter) / scatter_step);
  ByScatter all{scatter_step * (first + Eigen::ArrayXd::LinSpaced(scatters, 0.0, scatters - 1.0)),
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
  profile.best_to.resize(profile.log.size());
  if (curves.size() != ranges.series()) return profile;
  const CommonRanges common(ranges, curves);
  add_common(ranges, common, floor, profile);
  if (!ranges.single().empty()) add_own(ranges, curves, floor, profile);
  const std::size_t behind = ranges.ranges().size() - ranges.taut().size();
  for (std::size_t j = 0; j < ranges.taut().size(); ++j) {
    const std::vector<double> log = common.node_at(ranges.taut()[j], floor).by_readings;
    std::ranges::copy(log, profile.log.begin() + static_cast<std::ptrdiff_t>((behind + j) * columns));
    profile.largest = std::max(profile.largest, std::ranges::max(log));
  }
  return profile;
}

}  // namespace snare::identification
