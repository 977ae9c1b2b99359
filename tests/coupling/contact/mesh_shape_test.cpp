#include "coupling/contact/mesh_shape.hpp"

#include "base/errors.hpp"
#include "coupling/contact/revolved_solids.hpp"
#include "tests/support/derivatives.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/mesh_files.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <numbers>
#include <random>

namespace snare::coupling {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::cuboid;
using test::revolved_mesh;
using ::testing::HasSubstr;

class MeshFiles : public test::FolderFixture {
 protected:
  /// What the reader says of a file.
  [[nodiscard]] std::string complaint(const std::string& name, const std::string& text) const {
    return test::refusal([&] { return read_triangle_mesh(write(name, text), 1e-3); });
  }
};

/// Distance to a cuboid about the origin, from its definition as a product of intervals.
double cuboid_distance(const Vector3d& p, const Vector3d& half) {
  const Vector3d q = p.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(0.0, q.maxCoeff());
}

TEST_F(MeshFiles, AreReadInEveryFormat) {
  const TriangleMesh box = cuboid(8e-3, 6e-3, 4e-3);
  for (const char* name : {"box.stl", "box_binary.stl", "BOX.off", "box.obj"}) {
    const double unit = std::string(name) == "box.obj" ? 1.0 : 1e-3;
    test::write_mesh(folder_ / name, box, unit);
    const TriangleMesh mesh = read_triangle_mesh(folder_ / name, unit);
    EXPECT_EQ(mesh.points.size(), 8u) << name;
    EXPECT_EQ(mesh.triangles.size(), 12u) << name;
    const MeshShape shape(mesh);
    EXPECT_NEAR(shape.volume(), 8e-3 * 6e-3 * 4e-3, 1e-20) << name;
    EXPECT_NEAR(shape.distance({6e-3, 0.0, 0.0}), 2e-3, 1e-15) << name;
  }
  // Quadrilaterals are cut, comments and counts from the end understood.
  const fs::path file =
      write("quads.obj",
            "# a box\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvn 0 0 1\n"
            "f 1 4 3 2\nf -4 -3 -2 -1\nf 1 2 6 5\nf 2/1/1 3/1/1 7 6\nf 3 4 8 7 # side\nf 4 1 5 8\n");
  EXPECT_NEAR(MeshShape(read_triangle_mesh(file, 1.0)).volume(), 1.0, 1e-15);
}

TEST_F(MeshFiles, WrongOnesAreNamedWithTheirLine) {
  const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
  const std::tuple<const char*, std::string, const char*> wrong[] = {
      {"a.step", "ISO-10303-21;", "mesh = .step, must be a file with the ending .stl, .obj or .off"},
      {"empty.stl", "", "mesh = 0 bytes, is no STL: neither \"solid\" nor a binary header"},
      {"text.stl", std::string(200, 'x'), "is no STL: neither \"solid\" nor the "},
      {"cut.stl", "solid a\n" + facet, "cut.stl:5: mesh, must be \"vertex\" with three numbers"},
      {"quad.stl", "solid a\n" + facet + "vertex 1 1 0\nvertex 0 1 0\nendloop\n",
       "quad.stl:7: mesh = vertex, must be \"endloop\""},
      {"nan.stl", "solid a\n" + facet + "vertex 1 nan 0\n", "nan.stl:6: mesh = nan, must be a finite number"},
      {"none.stl", "solid a\nendsolid a\n", "mesh = 0 triangles, must have some"},
      {"far.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n", "far.obj:3: mesh = 3, must be a point's number, 1 to 2"},
      {"two.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", "two.obj:3: mesh = f, must have three corners or more"},
      {"word.obj", "v 0 zero 0\n", "word.obj:1: mesh = zero, must be a finite number"},
      {"empty.obj", "", "mesh = 0 triangles, must have some"},
      {"no.off", "COFF\n", "no.off:1: mesh = COFF, must be \"OFF\""},
      {"short.off", "OFF\n3 1 0\n0 0 0\n", "mesh, ends after 1 of 3 points"},
      {"index.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n",
       "index.off:5: mesh = 7, must be a point's index, 0 to 2"},
      {"edge.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n",
       "edge.off:5: mesh = 2, must be the number of the face's corners"},
  };
  for (const auto& [name, text, message] : wrong)
    EXPECT_THAT(complaint(name, text), HasSubstr(message)) << name;
  test::write_mesh(folder_ / "cut_binary.stl", cuboid(1.0, 1.0, 1.0), 1.0);
  fs::resize_file(folder_ / "cut_binary.stl", 400);
  EXPECT_THROW((void)read_triangle_mesh(folder_ / "cut_binary.stl", 1.0), base::InputError);
  EXPECT_THROW((void)read_triangle_mesh(folder_ / "nowhere.stl", 1.0), base::InputError);
}

TEST(MeshShapes, WrongSurfacesAreNamedWithTriangleAndEdge) {
  const auto said = [](const TriangleMesh& mesh) -> std::string {
    return test::refusal([&] { return MeshShape(mesh); });
  };
  TriangleMesh hole = cuboid(1.0, 1.0, 1.0);
  hole.triangles.erase(hole.triangles.begin() + 3);
  EXPECT_THAT(
      said(hole),
      HasSubstr("cuboid: mesh edge of points 5, 6 = triangle 2, must have a triangle on its other side too"));
  TriangleMesh flipped = cuboid(1.0, 1.0, 1.0);
  std::swap(flipped.triangles[4][0], flipped.triangles[4][1]);
  EXPECT_THAT(
      said(flipped),
      HasSubstr("mesh edge of points 1, 4 = triangles 4 and 5, must be run along in opposite directions"));
  TriangleMesh inside_out = cuboid(1.0, 1.0, 1.0);
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_THAT(said(inside_out),
              HasSubstr("mesh = volume -1 m^3, must face outward: it is turned inside out"));
  TriangleMesh degenerate = cuboid(1.0, 1.0, 1.0);
  degenerate.points.emplace_back(degenerate.points[0]);
  degenerate.triangles.push_back({0, 1, 8});
  EXPECT_THAT(said(degenerate), HasSubstr("mesh triangle 12 = points 0, 1, 8, must have an area"));
  TriangleMesh fin = cuboid(1.0, 1.0, 1.0);
  fin.points.emplace_back(2.0, 2.0, 2.0);
  fin.triangles.push_back({0, 1, 8});
  EXPECT_THAT(said(fin), HasSubstr("mesh edge of points 0, 1 = 3 triangles"));
  TriangleMesh crossing = cuboid(1.0, 1.0, 1.0);
  crossing.points[7] = {-0.8, -0.8, -0.8};  // a corner pulled through the opposite one
  EXPECT_THAT(said(crossing), HasSubstr("must not cross each other"));
  EXPECT_THAT(said(crossing), HasSubstr("mesh triangles "));
  TriangleMesh touching = cuboid(1.0, 1.0, 1.0);
  const TriangleMesh other = cuboid(1.0, 1.0, 1.0);
  for (std::size_t k = 1; k < 8; ++k) touching.points.emplace_back(other.points[k] + Vector3d::Ones());
  for (auto t : other.triangles) {
    for (int& i : t) i = i == 0 ? 7 : i + 7;
    touching.triangles.push_back(t);
  }
  EXPECT_THAT(said(touching), HasSubstr("must not touch itself in a vertex"));
  EXPECT_THAT(said({"nothing", {}, {}}), HasSubstr("nothing: mesh = 0 triangles, must have some"));
}

TEST(MeshShapes, HollowIsOutside) {
  TriangleMesh shell = cuboid(1.0, 1.0, 1.0);
  TriangleMesh hollow = cuboid(0.5, 0.5, 0.5);
  for (const Vector3d& p : hollow.points) shell.points.push_back(p);
  for (auto t : hollow.triangles) shell.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  const MeshShape shape(shell);
  EXPECT_NEAR(shape.volume(), 0.875, 1e-15);
  EXPECT_NEAR(shape.distance(Vector3d::Zero()), 0.25, 1e-15);
  EXPECT_NEAR(shape.distance({0.3, 0.0, 0.0}), -0.05, 1e-15);
}

TEST(MeshShapes, CuboidIsExact) {
  const Vector3d half(0.4, 0.3, 0.2);
  const MeshShape shape(cuboid(0.8, 0.6, 0.4));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.8, 0.8);
  for (int k = 0; k < 400; ++k) {
    const Vector3d p(place(random), place(random), place(random));
    EXPECT_NEAR(shape.distance(p), cuboid_distance(p, half), 1e-14) << p.transpose();
    EXPECT_EQ(shape.contains(p), cuboid_distance(p, half) < 0.0) << p.transpose();
  }
}

TEST(MeshShapes, AreDrawnBySharpEdges) {
  EXPECT_EQ(MeshShape(cuboid(8e-3, 6e-3, 4e-3)).drawing().size(), 12u);  // not the diagonals
}

TEST(MeshShapes, DerivativesFollowFaceEdgeAndVertex) {
  const MeshShape shape(cuboid(0.8, 0.6, 0.4));
  const std::tuple<const char*, Vector3d, double> places[] = {{"face", {0.1, 0.05, 0.35}, 0.0},
                                                              {"diagonal of a face", {0.0, 0.0, 0.35}, 0.0},
                                                              {"edge", {0.5, 0.45, 0.05}, 1.0},
                                                              {"vertex", {0.5, 0.45, 0.35}, 2.0}};
  for (const auto& [name, p, curvatures] : places) {
    const DistanceField f = shape.at(p);
    EXPECT_NEAR(f.normal.norm(), 1.0, 1e-14) << name;
    EXPECT_NEAR(f.hessian.trace(), curvatures / f.distance, 1e-10) << name;
    const auto value = [&shape](const VectorXd& x) { return shape.distance(x); };
    const auto slope = [&shape](const VectorXd& x) -> VectorXd { return shape.at(x).normal; };
    EXPECT_LT(test::compare_gradient(value, p, f.normal, 0.01).relative, 1e-9) << name;
    if (curvatures > 0.0) {
      EXPECT_LT(test::compare_jacobian(slope, p, f.hessian, 0.01).relative, 1e-8) << name;
    }
  }
  // Inside beside an edge that points inward (a reflex one): the ring between shell and hollow.
  TriangleMesh shell = cuboid(1.0, 1.0, 1.0);
  const TriangleMesh hollow = cuboid(0.5, 0.5, 0.5);
  for (const Vector3d& p : hollow.points) shell.points.push_back(p);
  for (auto t : hollow.triangles) shell.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  const MeshShape ring(shell);
  const Vector3d p(0.29, 0.28, 0.03);
  const DistanceField f = ring.at(p);
  EXPECT_NEAR(f.distance, -0.05, 1e-15);
  const auto slope = [&ring](const VectorXd& x) -> VectorXd { return ring.at(x).normal; };
  EXPECT_LT(test::compare_jacobian(slope, p, f.hessian, 0.01).relative, 1e-8);
}

TEST(MeshShapes, TessellatedShaftIsTheShaftWithinItsTessellation) {
  GrappleShaft dimensions;
  const auto shaft = grapple_shaft(dimensions);
  constexpr int around = 48;
  constexpr int divisions = 24;
  const Profile profile = grapple_profile(dimensions);
  const MeshShape mesh(revolved_mesh(profile.outline(profile.whole(), divisions), around));
  std::mt19937 random(17);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  // Chords lie inside circles by at most the sagitta of the largest, and the bulged arc's chords by less.
  const double sagitta = dimensions.cam_radius * (1.0 - std::cos(std::numbers::pi / around));
  int inside = 0;
  for (int k = 0; k < 500; ++k) {
    const Vector3d p(0.02 * place(random), 0.02 * place(random), 0.045 + 0.05 * place(random));
    const double exact = shaft->distance(p);
    const double d = mesh.distance(p);
    EXPECT_GE(d, exact - 1e-12) << p.transpose();
    // Deep inside the medial axis the nearest foot may be another: still the distance to nearly the same
    // surface.
    EXPECT_LE(d, exact + 1.5 * sagitta) << p.transpose();
    EXPECT_EQ(mesh.contains(p), d < 0.0) << p.transpose();
    inside += d < 0.0 ? 1 : 0;
    if (exact > 2e-3) {
      EXPECT_LT((mesh.at(p).normal - shaft->at(p).normal).norm(), 2.0 * std::numbers::pi / around)
          << p.transpose();
    }
  }
  EXPECT_GT(inside, 20);
}

}  // namespace
}  // namespace snare::coupling
