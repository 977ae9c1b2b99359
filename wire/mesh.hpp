#pragma once

#include "base/index.hpp"

#include <cstddef>
#include <vector>

namespace snare::wire {

/// Material coordinates that carry the mesh: where the left mount, the contact and the right mount hold
/// the wire, measured along the unstretched wire [m], increasing.
///
/// Feeding through a mount moves `left` or `right`; sliding over the pusher moves `contact`.
struct Controls {
  double left = 0.0;
  double contact = 0.0;
  double right = 0.0;

  /// Control k in this order, 0 to 2, as in derivatives by the controls.
  [[nodiscard]] double& operator[](std::size_t k) noexcept {
    return k == 0 ? left : (k == 1 ? contact : right);
  }
  [[nodiscard]] double operator[](std::size_t k) const noexcept {
    return k == 0 ? left : (k == 1 ? contact : right);
  }
  [[nodiscard]] bool operator==(const Controls&) const = default;
  /// Unstretched length between the mounts [m].
  [[nodiscard]] double length() const noexcept { return right - left; }
};

/// A mesh that moves with the contact.                                             theory.md (W.10)
///
/// Vertex i sits at the material coordinate S_i = (1 - xi_i) S_a + xi_i S_b, where (a, b) are the two
/// controls of its side of the contact and xi_i in [0, 1] is fixed; so vertex `contact_vertex()` always is
/// the point of contact, and every rest length is linear in the controls.
class MaterialMesh {
 public:
  /// left_edges, right_edges: number of edges on either side of the contact, >= 2.
  /// grading: 0 gives equal edges on each side; larger values draw vertices towards mounts and contact,
  /// xi(u) = (1 + tanh(g (2u - 1)) / tanh g) / 2, in [0, 4]. grading: g [-].
  MaterialMesh(int left_edges, int right_edges, double grading);

  /// The mesh whose vertices are every `factor`-th of these; for extrapolation. Both sides need a multiple of
  /// `factor` edges, at least twice as many.
  [[nodiscard]] MaterialMesh coarsened(int factor) const;

  /// Edges between the mounts, vertices (one more), and the vertex that carries the contact.
  [[nodiscard]] int edges() const noexcept { return static_cast<int>(rest_share_.size()); }
  [[nodiscard]] int vertices() const noexcept { return edges() + 1; }
  [[nodiscard]] int contact_vertex() const noexcept { return left_edges_; }

  /// Material coordinate of vertex i [m].
  [[nodiscard]] double coordinate(int i, const Controls& controls) const;
  /// Rest length of edge e [m], > 0 for increasing controls.
  [[nodiscard]] double rest_length(int e, const Controls& controls) const {
    const double side =
        e < left_edges_ ? controls.contact - controls.left : controls.right - controls.contact;
    return rest_share_[base::at(e)] * side;
  }
  /// Derivative of the rest length of edge e by control k: -share, +share or 0 [-].
  [[nodiscard]] double rest_length_derivative(int e, int k) const {
    const int a = first_control(e);
    const double share = rest_share_[base::at(e)];
    return k == a ? -share : (k == a + 1 ? share : 0.0);
  }

 private:
  [[nodiscard]] int first_control(int e) const noexcept { return e < left_edges_ ? 0 : 1; }

  int left_edges_;
  double grading_;
  std::vector<double> rest_share_;  // of its side's length, one an edge
  std::vector<double> position_;    // xi, one a vertex
};

/// Shares `edges` (a multiple of 4, >= 16) between the two sides of a contact at `fraction` of the length (in
/// (0, 1)), each side getting a multiple of 4, >= 8, so that coarsened(2) and coarsened(4) are nested in it.
[[nodiscard]] MaterialMesh make_mesh(int edges, double fraction, double grading);

/// Grading that resolves the boundary layers sqrt(EI/T) at mounts and contact.
/// layer: their length [m]; side: length of the shorter side [m]; edges_per_side >= 2.
[[nodiscard]] double grading_for_layer(double layer, double side, int edges_per_side);

}  // namespace snare::wire
