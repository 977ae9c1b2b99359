#pragma once

#include <Eigen/Core>

namespace snare::wire {

/// An edge of the rod of higher order: a beam between two vertices, whose curvatures EI k at its ends and whose
/// tension bend it off its chord.                                                            theory.md (W.32)
struct EdgeBeamConstants {
  double rest = 0.0;                                            ///< unstretched length h [m], > 0
  double axial_stiffness = 0.0;                                 ///< EA [N], > 0
  Eigen::Vector2d bending_stiffness = Eigen::Vector2d::Zero();  ///< EI_1, EI_2 [N m^2], > 0
};

/// Its energy as a function of the chord l and of the curvatures k_a, k_b (of kappa_1, kappa_2) at its ends, and the
/// derivatives by (l, k_a1, k_a2, k_b1, k_b2).
///
///   E = stat_N [ N (l - h) - N^2 h/(2 EA) - h/4 sum_j EI_j (C(z_j) (k_a + k_b)_j^2 + D(z_j) (k_a - k_b)_j^2) ]
///   z_j = N (1 + N/EA) h^2/EI_j,   C = tanh(w)/(2 w),   D = (w coth w - 1)/(2 w^2),   w = sqrt(z)/2
///
/// The vertices' terms EI k phi make it the energy of the rod, stationary in k.
struct EdgeBeam {
  static constexpr int chord = 0, near = 1, far = 3, count = 5;
  double energy = 0.0;   ///< [J]
  double tension = 0.0;  ///< N [N]
  Eigen::Matrix<double, count, 1> gradient;
  Eigen::Matrix<double, count, count> hessian;  ///< only where it is asked for
};
/// Which derivatives of an edge's energy are wanted.
enum class EdgeDerivatives { first, second };
/// chord: l [m], > 0; near, far: k_a, k_b [1/m].
[[nodiscard]] EdgeBeam edge_beam(const EdgeBeamConstants& constants, double chord, const Eigen::Vector2d& near,
                                 const Eigen::Vector2d& far, EdgeDerivatives wanted = EdgeDerivatives::second);

/// A flexibility of a beam under tension and its derivatives by z.
struct Flexibility {
  double value, first, second;  ///< C or D and its derivatives by z [-]
};
/// C of a beam whose ends turn alike, D of one whose ends turn against each other.             theory.md (W.32)
/// For z < -4, a compression of 4/pi^2 of the load that buckles the edge itself, their parabolas at -4.
struct Flexibilities {
  Flexibility alike, against;
};
/// z [-], as above.
[[nodiscard]] Flexibilities flexibilities(double z);

}  // namespace snare::wire
