#pragma once

#include <Eigen/Core>

namespace snare::identification {

/// Where the numbers of  x = b + sum_m e_m(t) (C_m cos w_m t + S_m sin w_m t)  stand:  theory.md (I.10)
/// the offset b, then C, S, w, s of every mode, then g of the mode that friction acts on besides.
struct OscillationLayout {
  static constexpr Eigen::Index numbers_a_mode = 4;
  Eigen::Index modes = 0;
  Eigen::Index rubbing = -1;  ///< mode with friction; -1: none
  [[nodiscard]] Eigen::Index size() const { return 1 + numbers_a_mode * modes + (rubbing >= 0 ? 1 : 0); }
  [[nodiscard]] Eigen::Index cosine(Eigen::Index mode) const { return 1 + numbers_a_mode * mode; }
  [[nodiscard]] Eigen::Index sine(Eigen::Index mode) const { return cosine(mode) + 1; }
  [[nodiscard]] Eigen::Index frequency(Eigen::Index mode) const { return cosine(mode) + 2; }
  [[nodiscard]] Eigen::Index decay(Eigen::Index mode) const { return cosine(mode) + 3; }
  [[nodiscard]] Eigen::Index friction() const { return size() - 1; }
};

/// Values [m] at these times [s] from the first reading and, where `by` is given, their derivatives by the
/// numbers p: b, C, S [m], w [rad/s], s, g [1/s].
[[nodiscard]] Eigen::VectorXd oscillations(const OscillationLayout& layout, const Eigen::VectorXd& p,
                                           const Eigen::VectorXd& time, Eigen::MatrixXd* by = nullptr);

}  // namespace snare::identification
