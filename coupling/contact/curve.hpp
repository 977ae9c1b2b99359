#pragma once

#include <Eigen/Core>

namespace snare::wire {
class RodPart;
}

namespace snare::coupling {

// The curve of contact: the C1 curve through the vertices of a wire. At a vertex its slope is that of the
// parabola through the vertex and its two neighbours, between vertices it is the cubic Hermite curve with
// these slopes.

/// Slope dX/dS of the curve at a vertex, from the edge vectors e0 and e1 before and after it.
/// theory.md (C.1)
///
///   u = before e0 + after e1,   before = h1/(h0 (h0 + h1)),   after = h0/(h1 (h0 + h1))
///
/// second order on unequal edges of the rest lengths h0, h1. At an end of the wire it is the slope of the
/// only edge (no moment acts on a wire that slides over a support). In the plane (n = 2) or in space (n = 3).
template <int n>
struct VertexSlope {
  using Vector = Eigen::Matrix<double, n, 1>;
  Vector u;                           ///< [-]; |u| is about the stretch
  double before = 0.0;                ///< factor of e0 [1/m]; 0 at the left end
  double after = 0.0;                 ///< factor of e1 [1/m]; 0 at the right end
  Vector by_before = Vector::Zero();  ///< du/d h0 [1/m]
  Vector by_after = Vector::Zero();   ///< du/d h1 [1/m]
};

/// e0, e1: edge vectors before and after the vertex [m]; h0, h1: their rest lengths [m], 0 where there is
/// none.
template <int n>
[[nodiscard]] VertexSlope<n> vertex_slope(const Eigen::Matrix<double, n, 1>& e0,
                                          const Eigen::Matrix<double, n, 1>& e1, double h0, double h1);
extern template VertexSlope<2> vertex_slope<2>(const Eigen::Vector2d&, const Eigen::Vector2d&, double,
                                               double);
extern template VertexSlope<3> vertex_slope<3>(const Eigen::Vector3d&, const Eigen::Vector3d&, double,
                                               double);

/// Weights of the four vertices first ... first + 3 in the curve at a material coordinate, and their
/// derivatives by it: X(S) = sum N_k x_k, the cubic Hermite curve with the slopes of (C.1).  theory.md (M.6)
struct CurveWeights {
  int first = 0;
  Eigen::Vector4d value, slope, bend;  ///< N [-], N' [1/m], N'' [1/m^2]
};
/// coordinate: from 0 to that of the last vertex [m]; a wire of at least 4 vertices.
[[nodiscard]] CurveWeights curve_weights(const wire::RodPart& rod, double coordinate);

}  // namespace snare::coupling
