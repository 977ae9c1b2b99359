#pragma once

#include "coupling/dynamics/contact/contact_intervals.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace snare::coupling {

// How a load is integrated along a closed stretch of a wire: the same for contact with bodies and with other
// wires.
//                                                                                      theory.md (M.8), (M.9)

/// Gauss's rule on a closed stretch: exact for a parabola of load under the cubics of the curve.
inline constexpr std::array<double, 3> gauss_places{0.5 - 0.3872983346207417, 0.5, 0.5 + 0.3872983346207417};
inline constexpr std::array<double, 3> gauss_weights{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

/// Where the load of a stretch is taken: use(u, weight), weights as shares of the element's length [-].
///
/// Where a crest is about to part a stretch, that is integrated as the two that it will be; where the crest
/// has just risen from one lobe, as one. In between, with x = 1 - (gap of the crest)/(that of the shallower
/// lobe), the two have the share x^2 (3 - 2 x): so no load jumps where a stretch
/// parts or closes.                                                                     theory.md (M.8)
template <class Use>
void for_each_place(const ContactInterval& stretch, const Use& use) {
  const auto lobe = [&](std::size_t k) {  // before crest k
    return k < stretch.crests.size() ? stretch.crests[k].before : stretch.behind;
  };
  const auto parts = [&](const auto& self, double from, double to, std::size_t first, std::size_t last,
                         double share) {
    std::size_t top = first;
    for (std::size_t k = first; k < last; ++k) {
      if (stretch.crests[k].gap > stretch.crests[top].gap) top = k;
    }
    double parted = 0.0;
    if (first < last) {
      double left = lobe(first), right = lobe(last);
      for (std::size_t k = first; k <= last; ++k)
        (k <= top ? left : right) = std::min(k <= top ? left : right, lobe(k));
      const double x = std::clamp(1.0 - stretch.crests[top].gap / std::max(left, right), 0.0, 1.0);
      parted = x * x * (3.0 - 2.0 * x);
    }
    const double whole = share * (1.0 - parted);
    for (std::size_t q = 0; whole > 0.0 && q < gauss_places.size(); ++q)
      use(from + gauss_places[q] * (to - from), whole * gauss_weights[q] * (to - from));
    if (parted == 0.0) return;
    self(self, from, stretch.crests[top].u, first, top, share * parted);
    self(self, stretch.crests[top].u, to, top + 1, last, share * parted);
  };
  parts(parts, stretch.from, stretch.to, 0, stretch.crests.size(), 1.0);
}

/// A slider slower than this stands still [m/s].
inline constexpr double standing = 1e-5;

}  // namespace snare::coupling
