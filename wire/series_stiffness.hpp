#pragma once

namespace snare::wire {

/// Stiffness of a cell of length l and section stiffness B with a mount's flexibility f in series:
///   1/k = l/B + f,   dk/dl = -k^2/B,   d2k/dl2 = -2 k (dk/dl)/B                            theory.md (W.6)
template <class S>
struct SeriesStiffness {
  S k = 0.0;       ///< [N m/rad]
  S first = 0.0;   ///< dk/dl [N/rad]
  S second = 0.0;  ///< d2k/dl2 [N/(m rad)]
};

template <class S>
[[nodiscard, gnu::always_inline]] inline SeriesStiffness<S> in_series(const S& cell_length, double stiffness,
                                                                      double flexibility) {
  SeriesStiffness<S> s;
  s.k = 1.0 / (cell_length / stiffness + flexibility);
  s.first = -s.k * s.k / stiffness;
  s.second = -2.0 * s.k * s.first / stiffness;
  return s;
}

/// What of it [N m/rad] is of the angle phi by which cell and mount turn; the rest, b, is of the cell's 2
/// tan(phi/2).
///   b = k s^3, s = k l/B:   of a rigid mount b = k, of a soft one 0                         theory.md (W.6)
inline SeriesStiffness<double> of_the_angle(const SeriesStiffness<double>& series, double cell_length,
                                            double stiffness) {
  const double share = series.k * cell_length / stiffness;
  const double cube = share * share * share;
  const double slope = share * share * series.k / stiffness;  // db/dl = slope k (3 - 4 s)
  return {series.k - series.k * cube, series.first - slope * series.k * (3.0 - 4.0 * share),
          series.second - share * series.k * series.k * series.k / (stiffness * stiffness) *
                              (6.0 - 24.0 * share + 20.0 * share * share)};
}

}  // namespace snare::wire
