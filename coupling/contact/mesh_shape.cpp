#include "coupling/contact/mesh_shape.hpp"

#include "base/errors.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
// Which triangle is nearest is asked in plain double precision: three times as fast, and a triangle that is
// no farther than another to round-off is as good.
using FastKernel = CGAL::Simple_cartesian<double>;
using FastMesh = CGAL::Surface_mesh<FastKernel::Point_3>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<FastMesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<FastKernel, Primitive>>;
namespace pmp = CGAL::Polygon_mesh_processing;

constexpr std::size_t most_problems = 10;  // of one kind that are listed

Vector3d vector(const Kernel::Point_3& p) {
  return {p.x(), p.y(), p.z()};
}
Kernel::Point_3 point(const Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

/// Collects what is wrong with a mesh, the first few of each kind.
class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}
  void add(const std::string& key, const std::string& value, const std::string& requirement) {
    const std::size_t count = ++counts_[requirement];
    if (count <= most_problems)
      list_.push_back({file_, 0, key.empty() ? "mesh" : "mesh " + key, value, requirement});
  }
  void raise() {
    if (list_.empty()) return;
    for (const auto& [requirement, count] : counts_) {
      if (count > most_problems)
        list_.push_back({file_, 0, "mesh", fmt::format("{} more", count - most_problems), requirement});
    }
    throw base::InputError(list_);
  }

 private:
  std::string file_;
  std::map<std::string, std::size_t> counts_;
  std::vector<base::InputProblem> list_;
};

std::string corners_of(const std::array<int, 3>& t) {
  return fmt::format("points {}, {}, {}", t[0], t[1], t[2]);
}

void check_triangles(const TriangleMesh& mesh, Problems& problems) {
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const std::array<int, 3>& t = mesh.triangles[k];
    const auto corner = [&](std::size_t i) { return point(mesh.points[static_cast<std::size_t>(t[i])]); };
    if (CGAL::collinear(corner(0), corner(1), corner(2)))
      problems.add(fmt::format("triangle {}", k), corners_of(t), "must have an area: is degenerate");
  }
}

// Every edge belongs to two triangles that run along it in opposite directions.
void check_edges(const TriangleMesh& mesh, Problems& problems) {
  struct Sides {
    std::vector<std::size_t> forward, backward;  // triangles
  };
  std::map<std::pair<int, int>, Sides> edges;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const std::array<int, 3>& t = mesh.triangles[k];
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i];
      const int b = t[(i + 1) % 3];
      Sides& sides = edges[std::minmax(a, b)];
      (a < b ? sides.forward : sides.backward).push_back(k);
    }
  }
  for (const auto& [edge, sides] : edges) {
    const std::string key = fmt::format("edge of points {}, {}", edge.first, edge.second);
    std::vector<std::size_t> all = sides.forward;
    all.insert(all.end(), sides.backward.begin(), sides.backward.end());
    if (all.size() == 1) {
      problems.add(key, fmt::format("triangle {}", all[0]),
                   "must have a triangle on its other side too: the surface is not closed");
    } else if (all.size() > 2) {
      problems.add(key, fmt::format("{} triangles, the first {} and {}", all.size(), all[0], all[1]),
                   "must have two triangles");
    } else if (sides.forward.size() != 1) {
      problems.add(key, fmt::format("triangles {} and {}", all[0], all[1]),
                   "must be run along in opposite directions: one of them is flipped");
    }
  }
}

double volume_of(const Mesh& m) {
  double six = 0.0;
  for (const Mesh::Face_index f : m.faces()) {
    const Mesh::Halfedge_index h = m.halfedge(f);
    const Vector3d a = vector(m.point(m.source(h)));
    six += a.dot(vector(m.point(m.target(h))).cross(vector(m.point(m.target(m.next(h))))));
  }
  return six / 6.0;
}

}  // namespace

struct MeshShape::Surface {
  Mesh mesh;
  std::vector<Vector3d> face_normal, edge_normal,
      vertex_normal;   // outward; of edges and vertices of no length in particular
  FastMesh fast_mesh;  // faces as in mesh
  std::unique_ptr<Tree> tree;
  std::unique_ptr<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side;
};

/// The nearest point of the surface.
struct MeshShape::Near {
  enum class Feature { face, edge, vertex } feature = Feature::face;
  Vector3d foot = Vector3d::Zero();
  Vector3d outward = Vector3d::UnitX();  // its normal, averaged at an edge or a vertex
  Vector3d along = Vector3d::Zero();     // of an edge, unit
};

MeshShape::MeshShape(const TriangleMesh& mesh) {
  Problems problems(mesh.name);
  if (mesh.triangles.empty()) problems.add("", "0 triangles", "must have some");
  check_triangles(mesh, problems);
  problems.raise();
  check_edges(mesh, problems);
  problems.raise();
  if (!pmp::is_polygon_soup_a_polygon_mesh(mesh.triangles)) {
    problems.add("", "", "must not touch itself in a vertex");
    problems.raise();
  }
  auto surface = std::make_unique<Surface>();
  std::vector<Kernel::Point_3> points;
  points.reserve(mesh.points.size());
  for (const Vector3d& p : mesh.points) points.push_back(point(p));
  pmp::polygon_soup_to_polygon_mesh(points, mesh.triangles, surface->mesh);
  const Mesh& m = surface->mesh;
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> crossing;
  pmp::self_intersections(m, std::back_inserter(crossing));
  for (const auto& [a, b] : crossing) {
    problems.add(fmt::format("triangles {} and {}", a.idx(), b.idx()), "", "must not cross each other");
  }
  problems.raise();
  // A shell inside another faces its hollow.
  const double volume = volume_of(m);
  if (volume <= 0.0 || !pmp::does_bound_a_volume(m)) {
    problems.add(
        "", fmt::format("volume {:.6g} m^3", volume),
        fmt::format("must face outward: {} turned inside out", volume <= 0.0 ? "it is" : "a part of it is"));
    problems.raise();
  }

  surface->face_normal.resize(m.number_of_faces());
  surface->edge_normal.assign(m.number_of_edges(), Vector3d::Zero());
  surface->vertex_normal.assign(m.number_of_vertices(), Vector3d::Zero());
  for (const Mesh::Face_index f : m.faces()) {
    const Mesh::Halfedge_index first = m.halfedge(f);
    const Vector3d a = vector(m.point(m.source(first)));
    const Vector3d b = vector(m.point(m.target(first)));
    const Vector3d c = vector(m.point(m.target(m.next(first))));
    const Vector3d normal = (b - a).cross(c - a).normalized();
    surface->face_normal[f.idx()] = normal;
    Mesh::Halfedge_index h = first;
    for (int k = 0; k < 3; ++k, h = m.next(h)) {
      surface->edge_normal[m.edge(h).idx()] += normal;
      const Vector3d corner = vector(m.point(m.target(h)));
      const Vector3d back = vector(m.point(m.source(h))) - corner;
      const Vector3d on = vector(m.point(m.target(m.next(h)))) - corner;
      surface->vertex_normal[m.target(h).idx()] += std::atan2(back.cross(on).norm(), back.dot(on)) * normal;
    }
  }
  FastMesh& fast = surface->fast_mesh;
  for (const Mesh::Vertex_index v : m.vertices())
    fast.add_vertex({m.point(v).x(), m.point(v).y(), m.point(v).z()});
  for (const Mesh::Face_index f : m.faces()) {
    std::vector<FastMesh::Vertex_index> corners;
    for (const Mesh::Vertex_index v : m.vertices_around_face(m.halfedge(f))) corners.emplace_back(v.idx());
    fast.add_face(corners);
  }
  surface->tree = std::make_unique<Tree>(fast.faces().begin(), fast.faces().end(), fast);
  surface->tree->accelerate_distance_queries();
  surface->side = std::make_unique<CGAL::Side_of_triangle_mesh<Mesh, Kernel>>(surface->mesh);
  surface_ = std::move(surface);
}

MeshShape::~MeshShape() = default;

// The nearest face is known; where on it the foot stands follows from the signs of its projections (Ericson
// 2004, sec. 5.1.5). What lies straight above a face is the face's, though its foot be on an edge: between
// the triangles of one flat face, or to round-off.
MeshShape::Near MeshShape::nearest(const Vector3d& p) const {
  const Mesh& m = surface_->mesh;
  const Mesh::Face_index face(
      surface_->tree->closest_point_and_primitive({p.x(), p.y(), p.z()}).second.idx());
  std::array<Mesh::Halfedge_index, 3> sides;
  std::array<Vector3d, 3> corner;  // the start of every side
  sides[0] = m.halfedge(face);
  sides[1] = m.next(sides[0]);
  sides[2] = m.next(sides[1]);
  for (std::size_t k = 0; k < 3; ++k) corner[k] = vector(m.point(m.source(sides[k])));
  const Vector3d& normal = surface_->face_normal[face.idx()];
  constexpr double straight = 1.0 - 1e-10;  // cosine of 1.4e-5 rad
  const auto above = [&](const Vector3d& foot) {
    return std::abs((p - foot).dot(normal)) >= straight * (p - foot).norm();
  };
  Near near;
  near.foot = p - (p - corner[0]).dot(normal) * normal;
  near.outward = normal;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& a = corner[k];
    const Vector3d& b = corner[(k + 1) % 3];
    const Vector3d& c = corner[(k + 2) % 3];
    const Vector3d ab = b - a;
    const double along = (p - a).dot(ab);
    if (along <= 0.0 && (p - a).dot(c - a) <= 0.0) {
      if (above(a)) return near;
      near.feature = Near::Feature::vertex;
      near.foot = a;
      near.outward = surface_->vertex_normal[m.source(sides[k]).idx()];
      return near;
    }
    if (along > 0.0 && (p - b).dot(ab) < 0.0 && normal.dot(ab.cross(p - a)) <= 0.0) {
      const Vector3d foot = a + along / ab.squaredNorm() * ab;
      if (above(foot)) return near;
      near.feature = Near::Feature::edge;
      near.along = ab.normalized();
      near.foot = foot;
      near.outward = surface_->edge_normal[m.edge(sides[k]).idx()];
      return near;
    }
  }
  return near;
}

double MeshShape::distance(const Vector3d& p) const {
  const Near near = nearest(p);
  const Vector3d away = p - near.foot;
  if (near.feature == Near::Feature::face) return away.dot(near.outward);
  return std::copysign(away.norm(), away.dot(near.outward));
}

DistanceField MeshShape::at(const Vector3d& p) const {
  const Near near = nearest(p);
  const Vector3d away = p - near.foot;
  DistanceField field;
  if (near.feature == Near::Feature::face) {
    field.distance = away.dot(near.outward);
    field.normal = near.outward;
    return field;
  }
  field.distance = std::copysign(away.norm(), away.dot(near.outward));
  if (field.distance == 0.0) {
    field.normal = near.outward.normalized();
    return field;
  }
  field.normal = away / field.distance;
  Matrix3d across = Matrix3d::Identity() - field.normal * field.normal.transpose();
  if (near.feature == Near::Feature::edge) across -= near.along * near.along.transpose();
  field.hessian = across / field.distance;
  return field;
}

std::vector<Eigen::Matrix3Xd> MeshShape::drawing() const {
  const double sharp = std::cos(std::numbers::pi / 9.0);  // 20 degrees between the faces' normals
  constexpr std::size_t least = 6;
  constexpr std::size_t most = 400;
  const Mesh& m = surface_->mesh;
  std::vector<Eigen::Matrix3Xd> all, edges;
  for (const Mesh::Edge_index e : m.edges()) {
    const Mesh::Halfedge_index h = m.halfedge(e);
    Eigen::Matrix3Xd line(3, 2);
    line << vector(m.point(m.source(h))), vector(m.point(m.target(h)));
    all.push_back(line);
    const Vector3d& on_this_side = surface_->face_normal[m.face(h).idx()];
    if (on_this_side.dot(surface_->face_normal[m.face(m.opposite(h)).idx()]) < sharp) edges.push_back(line);
  }
  const std::vector<Eigen::Matrix3Xd>& chosen = edges.size() >= least ? edges : all;
  std::vector<Eigen::Matrix3Xd> drawn;
  for (std::size_t k = 0; k < chosen.size(); k += 1 + chosen.size() / most) drawn.push_back(chosen[k]);
  return drawn;
}

bool MeshShape::contains(const Vector3d& p) const {
  return (*surface_->side)(point(p)) == CGAL::ON_BOUNDED_SIDE;
}

double MeshShape::volume() const {
  return volume_of(surface_->mesh);
}

}  // namespace snare::coupling
