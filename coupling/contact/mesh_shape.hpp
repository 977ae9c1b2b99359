#pragma once

#include "coupling/contact/mesh_file.hpp"
#include "coupling/contact/shape.hpp"

#include <Eigen/Core>

#include <memory>

namespace snare::coupling {

/// A solid bounded by triangles. The distance is that to the nearest point of the surface, its sign that of
/// the side of the nearest face, edge or vertex by the angle-weighted normal there (Baerentzen, Aanaes 2005).
///                                                                                     theory.md (G.4), (G.5)
///
/// Hessian by the nearest feature: 0 over a face, 1/distance across an edge, 1/distance in both directions at
/// a vertex: the surface at the distance of a wire's radius rounds the convex edges and is once
/// differentiable there.
class MeshShape final : public ContactShape {
 public:
  /// Throws InputError that names the mesh and the faulty triangles and edges: degenerate triangles, edges
  /// that bound one triangle or more than two, neighbours that run the same way along their edge, surfaces
  /// that touch in a vertex or cross themselves, triangles that face inward.
  explicit MeshShape(const TriangleMesh& mesh);
  ~MeshShape() override;
  MeshShape(const MeshShape&) = delete;
  MeshShape& operator=(const MeshShape&) = delete;

  [[nodiscard]] DistanceField at(const Eigen::Vector3d& p) const override;
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const override;

  /// The sharp edges; where there are few, as of a smooth surface, some of all.
  [[nodiscard]] std::vector<Eigen::Matrix3Xd> drawing() const override;

  /// Whether a point p [m] of the shape's frame is inside, by counting the crossings of a ray instead of the
  /// nearest feature.
  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const;
  [[nodiscard]] double volume() const;  ///< [m^3], > 0

 private:
  struct Surface;
  struct Near;
  [[nodiscard]] Near nearest(const Eigen::Vector3d& p) const;

  std::unique_ptr<const Surface> surface_;
};

}  // namespace snare::coupling
