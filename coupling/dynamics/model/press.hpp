#pragma once

#include "coupling/dynamics/model/input_memo.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace snare::coupling {

/// How hard a contact presses.
struct Press {
  double depth = 0.0;  ///< the largest [m], 0: nothing touches
  double load = 0.0;   ///< in all [N]
};

/// What is closed, by its nodes with weights [m] and their geometries, presses with.
template <class ContactCache>
[[nodiscard]] Press press_of(const ContactCache& found) {
  Press press;
  for (std::size_t q = 0; q < found.nodes.size(); ++q) {
    press.depth = std::max(press.depth, -found.geometries[q].gap);
    press.load += found.nodes[q].weight * found.geometries[q].state.normal;
  }
  return press;
}

/// The share of a way, in (0, 1), after which a contact is about `wanted` deep [m].
///
/// at_start: depth at its beginning [m], less than wanted; negative: the gap. depth(share): after a share of
/// the way [m], zero where nothing touches; at_end: after the whole way [m], larger than wanted.
template <class Depth>
[[nodiscard]] double share_to_touch(double at_start, double at_end, double wanted, const Depth& depth) {
  constexpr int tries = 30;
  constexpr double about = 4.0;
  struct Place {
    double share = 0.0, depth = 0.0;
  };
  // A straight line through two places: a closed one, and another at which the depth is known, as it is not
  // where nothing touches.
  Place open{0.0, at_start}, closed{1.0, at_end}, other = open;
  for (int k = 0; k < tries; ++k) {
    double share =
        closed.share + (wanted - closed.depth) * (other.share - closed.share) / (other.depth - closed.depth);
    if (!(share > open.share && share < closed.share)) share = 0.5 * (open.share + closed.share);
    const Place next{share, depth(share)};
    if (next.depth > wanted / about && next.depth < wanted * about) return share;
    if (next.depth > wanted) {
      other = std::exchange(closed, next);
    } else {
      open = next;
      if (next.depth > 0.0) other = next;
    }
  }
  return closed.share;
}

/// Where Newton's method begins with a contact, on the way from accepted to predicted unknowns.
///                                                                                           theory.md (M.12)
///
/// A load grows with d^(3/2) and with the speed of approach: the method finds it from a lighter one, but not
/// from one that is many times too large, nor from none. So it begins where a touch does, and at the accepted
/// unknowns where the prediction has another load than they.
/// tolerance: of places [m]; gap(): at the accepted unknowns [m]; depth(share): after a share of the way [m].
template <class Gap, class Depth>
[[nodiscard]] numerics::IterationStart start_with_contact(const Press& accepted, const Press& predicted,
                                                          double tolerance, const Gap& gap,
                                                          const Depth& depth) {
  constexpr double steady = 8.0;           // most that the load may change by
  const double begun = 0.003 * tolerance;  // depth of a touch that has just begun
  const double reach = 0.3 * tolerance;    // of a step behind the touch
  if (predicted.depth == 0.0) return {};
  if (accepted.depth >= begun) {
    const bool same = predicted.load < steady * accepted.load && steady * predicted.load > accepted.load;
    return {same || accepted.load == 0.0 ? 1.0 : 0.0};
  }
  if (predicted.depth <= begun) return {};
  if (predicted.depth > reach) return {0.0, true};
  const double at_start = accepted.depth > 0.0 ? accepted.depth : -std::max(0.0, gap());
  return {share_to_touch(at_start, predicted.depth, begun, depth)};
}

/// How a contact pressed at the accepted unknowns. What is closed at unknowns y (SI units) is asked for as
/// found_at(y): see press_of.
class AcceptedPress {
 public:
  AcceptedPress() = default;
  explicit AcceptedPress(InputMemo inputs)
      : inputs_(std::move(inputs)) {}  ///< the unknowns on which the contact depends

  /// Told the accepted unknowns y (SI units).
  template <class FoundAt>
  void take(const numerics::VectorView& y, const FoundAt& found_at) {
    press_ = press_of(found_at(y));
    inputs_.take(y);
  }
  /// Where Newton's method begins between unknowns (SI units); tolerance: of places [m]; gap(y) [m].
  template <class FoundAt, class Gap>
  [[nodiscard]] numerics::IterationStart start(const numerics::VectorView& from,
                                               const numerics::VectorView& to, double tolerance,
                                               const FoundAt& found_at, const Gap& gap) {
    const Press predicted = press_of(found_at(to));
    if (predicted.depth == 0.0) return {};
    if (!inputs_.holds(from)) take(from, found_at);  // a start that was not accepted
    return start_with_contact(
        press_, predicted, tolerance, [&] { return gap(from); },
        [&](double share) { return press_of(found_at(from + share * (to - from))).depth; });
  }

 private:
  InputMemo inputs_;
  Press press_;
};

}  // namespace snare::coupling
