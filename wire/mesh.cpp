#include "wire/mesh.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace snare::wire {

namespace {

double graded(double u, double grading) {
  if (grading < 1e-6) return u;
  return 0.5 * (1.0 + std::tanh(grading * (2.0 * u - 1.0)) / std::tanh(grading));
}

}  // namespace

MaterialMesh::MaterialMesh(int left_edges, int right_edges, double grading)
    : left_edges_(left_edges), grading_(grading) {
  assert(left_edges >= 2 && right_edges >= 2 && grading >= 0.0);
  const auto edges = static_cast<std::size_t>(left_edges + right_edges);
  rest_share_.reserve(edges);
  position_.reserve(edges + 1);
  for (const int side_edges : {left_edges, right_edges}) {
    for (int k = 0; k < side_edges; ++k) {
      const double from = graded(static_cast<double>(k) / side_edges, grading);
      const double to = graded(static_cast<double>(k + 1) / side_edges, grading);
      rest_share_.push_back(to - from);
      position_.push_back(from);
    }
  }
  position_.push_back(1.0);
}

MaterialMesh MaterialMesh::coarsened(int factor) const {
  assert(left_edges_ % factor == 0 && edges() % factor == 0);
  return MaterialMesh(left_edges_ / factor, (edges() - left_edges_) / factor, grading_);
}

double MaterialMesh::coordinate(int i, const Controls& controls) const {
  const double xi = position_[base::at(i)];
  return i < left_edges_ ? (1.0 - xi) * controls.left + xi * controls.contact
                         : (1.0 - xi) * controls.contact + xi * controls.right;
}

MaterialMesh make_mesh(int edges, double fraction, double grading) {
  assert(edges >= 16 && edges % 4 == 0 && fraction > 0.0 && fraction < 1.0);
  const int fours = edges / 4;
  const int left = std::clamp(static_cast<int>(std::lround(fraction * fours)), 2, fours - 2);
  return MaterialMesh(4 * left, 4 * (fours - left), grading);
}

double grading_for_layer(double layer, double side, int edges_per_side) {
  // At the ends of a side the edges are g / (sinh g cosh g) of their mean; ask for ten edges in a layer.
  const double wanted = std::min(1.0, layer / 10.0 * edges_per_side / side);
  double low = 0.0;
  double high = 2.0;  // beyond, the middle of the side gets too coarse
  for (int k = 0; k < 40; ++k) {
    const double g = 0.5 * (low + high);
    (g / (std::sinh(g) * std::cosh(g)) > wanted ? low : high) = g;
  }
  return wanted >= 1.0 ? 0.0 : 0.5 * (low + high);
}

}  // namespace snare::wire
