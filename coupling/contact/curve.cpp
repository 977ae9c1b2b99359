#include "coupling/contact/curve.hpp"

#include "wire/motion/rod_part.hpp"

#include <algorithm>

namespace snare::coupling {

namespace {

using Eigen::Vector3d;

/// The factors of the two edge vectors in the slope between them [1/m].            theory.md (C.1)
struct EdgeFactors {
  double before;
  double after;
};

EdgeFactors edge_factors(double h0, double h1) {
  return {h1 / (h0 * (h0 + h1)), h0 / (h1 * (h0 + h1))};
}

/// Weights of the slope of the curve at vertex i on the vertices i-1, i, i+1 (at an end on the three
/// nearest).
struct SlopeWeights {
  int first;
  Vector3d weight;
};

SlopeWeights slope_weights(const wire::RodPart& rod, int i) {
  const int last = rod.vertices() - 1;
  const int middle = std::clamp(i, 1, last - 1);
  const double h0 = rod.coordinate(middle) - rod.coordinate(middle - 1);
  const double h1 = rod.coordinate(middle + 1) - rod.coordinate(middle);
  const auto [a, b] = edge_factors(h0, h1);
  const Vector3d at_middle(-a, a - b, b);
  if (i == middle) return {middle - 1, at_middle};
  // The parabola's slope at its end: twice that of the chord less that at the middle.
  if (i < middle) return {0, 2.0 / h0 * Vector3d(-1.0, 1.0, 0.0) - at_middle};
  return {middle - 1, 2.0 / h1 * Vector3d(0.0, -1.0, 1.0) - at_middle};
}

/// The edge that holds a material coordinate.
int edge_at(const wire::RodPart& rod, double coordinate) {
  int low = 0;
  int high = rod.vertices() - 1;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (rod.coordinate(middle) <= coordinate ? low : high) = middle;
  }
  return low;
}

}  // namespace

template <int n>
VertexSlope<n> vertex_slope(const Eigen::Matrix<double, n, 1>& e0, const Eigen::Matrix<double, n, 1>& e1,
                            double h0, double h1) {
  VertexSlope<n> result;
  if (h0 == 0.0) {
    result.after = 1.0 / h1;
    result.by_after = -e1 / (h1 * h1);
  } else if (h1 == 0.0) {
    result.before = 1.0 / h0;
    result.by_before = -e0 / (h0 * h0);
  } else {
    const double sum = h0 + h1;
    const EdgeFactors factors = edge_factors(h0, h1);
    result.before = factors.before;
    result.after = factors.after;
    // d before/dh0 = -h1 (2 h0 + h1)/(h0 (h0 + h1))^2,  d after/dh0 = 1/(h0 + h1)^2; by h1 with 0 and 1
    // exchanged.
    result.by_before = -e0 * h1 * (2.0 * h0 + h1) / (h0 * h0 * sum * sum) + e1 / (sum * sum);
    result.by_after = -e1 * h0 * (2.0 * h1 + h0) / (h1 * h1 * sum * sum) + e0 / (sum * sum);
  }
  result.u = result.before * e0 + result.after * e1;
  return result;
}

template VertexSlope<2> vertex_slope<2>(const Eigen::Vector2d&, const Eigen::Vector2d&, double, double);
template VertexSlope<3> vertex_slope<3>(const Eigen::Vector3d&, const Eigen::Vector3d&, double, double);

CurveWeights curve_weights(const wire::RodPart& rod, double coordinate) {
  const int e = edge_at(rod, coordinate);
  const double from = rod.coordinate(e);
  const double h = rod.coordinate(e + 1) - from;
  const double u = (coordinate - from) / h;
  CurveWeights w;
  w.first = std::clamp(e - 1, 0, rod.vertices() - 4);
  w.value.setZero();
  w.slope.setZero();
  w.bend.setZero();
  // Hermite's polynomials in u with their first and second derivatives by u; d/dS = 1/h d/du.
  const auto add = [&](int vertex, double value, double slope, double bend) {
    w.value[vertex - w.first] += value;
    w.slope[vertex - w.first] += slope / h;
    w.bend[vertex - w.first] += bend / (h * h);
  };
  add(e, (1.0 + 2.0 * u) * (1.0 - u) * (1.0 - u), 6.0 * u * (u - 1.0), 12.0 * u - 6.0);
  add(e + 1, u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u), 6.0 - 12.0 * u);
  const auto add_slope = [&](int vertex, double value, double slope, double bend) {
    const SlopeWeights m = slope_weights(rod, vertex);
    for (int k = 0; k < 3; ++k)
      add(m.first + k, value * h * m.weight[k], slope * h * m.weight[k], bend * h * m.weight[k]);
  };
  add_slope(e, u * (1.0 - u) * (1.0 - u), (1.0 - u) * (1.0 - 3.0 * u), 6.0 * u - 4.0);
  add_slope(e + 1, u * u * (u - 1.0), u * (3.0 * u - 2.0), 6.0 * u - 2.0);
  return w;
}

}  // namespace snare::coupling
