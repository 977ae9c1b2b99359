#pragma once

#include "numerics/dae.hpp"

#include <utility>

namespace snare::coupling {

/// How hard a contact presses.
struct Press {
  double depth = 0.0;  ///< the largest [m], 0: nothing touches
  double load = 0.0;   ///< in all [N]
};

/// The share of a way, in (0, 1), after which something that is open at its beginning touches to about the depth `wanted` [m].
///
/// gap: at the beginning of the way [m], positive; depth(share): after a share of the way [m], zero where nothing touches; at_end: after
/// the whole way [m], larger than wanted.
template <class Depth>
[[nodiscard]] double share_to_touch(double gap, double at_end, double wanted, const Depth& depth) {
  constexpr int tries = 30;
  constexpr double about = 4.0;
  struct Place {
    double share = 0.0, depth = 0.0;
  };
  Place open{0.0, -gap}, closed{1.0, at_end},
      other = open;  // a straight line goes through the closed place and another one
  for (int k = 0; k < tries; ++k) {
    double share = closed.share + (wanted - closed.depth) * (other.share - closed.share) / (other.depth - closed.depth);
    if (!(share > open.share && share < closed.share)) share = 0.5 * (open.share + closed.share);
    const Place next{share, depth(share)};
    if (next.depth > wanted / about && next.depth < wanted * about) return share;
    if (next.depth > wanted)
      other = std::exchange(closed, next);
    else
      open = next;
    if (next.depth > 0.0 && next.depth < wanted)
      other = next;  // how far from touching something is that does not, is not known
  }
  return closed.share;
}

/// Where Newton's method begins with a contact, on the way from accepted to predicted unknowns.            theory.md (M.12)
///
/// A load grows with d^(3/2) and with the speed of approach: the method finds it from a lighter one, but not from one that is many times too
/// large, nor from none. So it begins where a touch does, and at the accepted unknowns where the prediction has another load than they.
/// tolerance: of places [m]; gap(): at the accepted unknowns [m]; depth(share): after a share of the way [m].
template <class Gap, class Depth>
[[nodiscard]] numerics::IterationStart start_with_contact(const Press& accepted, const Press& predicted,
                                                          double tolerance, const Gap& gap, const Depth& depth) {
  constexpr double steady = 8.0;     // most that the load may change by
  constexpr double begun = 0.003;    // depth of a touch that has just begun, of the tolerance
  constexpr double behind_it = 0.3;  // longest way behind the touch, of the tolerance
  if (predicted.depth == 0.0) return {};
  if (accepted.load > 0.0) {
    const bool same = predicted.load < steady * accepted.load && steady * predicted.load > accepted.load;
    return {same ? 1.0 : 0.0};
  }
  if (accepted.depth > 0.0 || predicted.depth <= begun * tolerance) return {};
  const double open = gap();
  if (!(open > 0.0)) return {};
  if (predicted.depth > behind_it * tolerance) return {0.0, true};
  return {share_to_touch(open, predicted.depth, begun * tolerance, depth)};
}

}  // namespace snare::coupling
