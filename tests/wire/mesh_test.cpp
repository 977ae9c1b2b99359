#include "wire/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace snare::wire {
namespace {

constexpr Controls kControls{0.02, 0.3, 1.1};

// Sums of a few dozen numbers of order one.
constexpr double kRoundOff = 2e-15;

TEST(MaterialMesh, CarriesItsControls) {
  for (const double grading : {0.0, 1.0, 4.0}) {
    const MaterialMesh mesh(6, 10, grading);
    EXPECT_EQ(mesh.edges(), 16);
    EXPECT_EQ(mesh.vertices(), 17);
    EXPECT_EQ(mesh.contact_vertex(), 6);
    EXPECT_NEAR(mesh.coordinate(0, kControls), kControls.left, kRoundOff);
    EXPECT_NEAR(mesh.coordinate(6, kControls), kControls.contact, kRoundOff);
    EXPECT_NEAR(mesh.coordinate(16, kControls), kControls.right, kRoundOff);
  }
}

TEST(MaterialMesh, RestLengthsAreTheGapsOfTheCoordinates) {
  const MaterialMesh mesh(6, 10, 2.0);
  for (int e = 0; e < mesh.edges(); ++e) {
    EXPECT_NEAR(mesh.rest_length(e, kControls),
                mesh.coordinate(e + 1, kControls) - mesh.coordinate(e, kControls), kRoundOff);
    EXPECT_GT(mesh.rest_length(e, kControls), 0.0);
  }
}

TEST(MaterialMesh, RestLengthsAreLinearInTheControls) {
  const MaterialMesh mesh(6, 10, 2.0);
  for (int e = 0; e < mesh.edges(); ++e) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
      sum += mesh.rest_length_derivative(e, k) * kControls[static_cast<std::size_t>(k)];
    }
    EXPECT_NEAR(mesh.rest_length(e, kControls), sum, kRoundOff);
    EXPECT_EQ(mesh.rest_length_derivative(e, e < 6 ? 2 : 0), 0.0);  // the other side does not feel it
  }
}

TEST(MaterialMesh, WithoutGradingEdgesAreEqualOnEachSide) {
  const MaterialMesh mesh(4, 5, 0.0);
  for (int e = 0; e < 4; ++e) EXPECT_NEAR(mesh.rest_length(e, kControls), 0.28 / 4, kRoundOff);
  for (int e = 4; e < 9; ++e) EXPECT_NEAR(mesh.rest_length(e, kControls), 0.8 / 5, kRoundOff);
}

TEST(MaterialMesh, GradingDrawsVerticesTowardsMountsAndContact) {
  const MaterialMesh mesh(8, 8, 2.0);
  for (const int side : {0, 8}) {
    for (int e = 0; e < 4; ++e) {
      // Symmetric about the middle of the side, growing towards it.
      EXPECT_NEAR(mesh.rest_length(side + e, kControls), mesh.rest_length(side + 7 - e, kControls),
                  kRoundOff);
    }
    for (int e = 1; e < 4; ++e) {
      EXPECT_GT(mesh.rest_length(side + e, kControls), mesh.rest_length(side + e - 1, kControls));
    }
  }
}

TEST(MaterialMesh, CoarsenedIsNested) {
  const MaterialMesh fine(8, 12, 1.5);
  for (const int factor : {2, 4}) {
    const MaterialMesh coarse = fine.coarsened(factor);
    ASSERT_EQ(coarse.edges(), 20 / factor);
    EXPECT_EQ(coarse.contact_vertex(), 8 / factor);
    for (int i = 0; i < coarse.vertices(); ++i) {
      EXPECT_NEAR(coarse.coordinate(i, kControls), fine.coordinate(factor * i, kControls), kRoundOff);
    }
  }
}

TEST(MaterialMesh, MakeMeshSharesEdgesByTheFraction) {
  for (const double fraction : {0.01, 0.2, 0.37, 0.5, 0.99}) {
    for (const int edges : {16, 20, 52, 200}) {
      const MaterialMesh mesh = make_mesh(edges, fraction, 1.0);
      EXPECT_EQ(mesh.edges(), edges);
      EXPECT_EQ(mesh.contact_vertex() % 4, 0);
      EXPECT_GE(mesh.contact_vertex(), 8);
      EXPECT_GE(edges - mesh.contact_vertex(), 8);
    }
  }
  EXPECT_EQ(make_mesh(200, 0.5, 0.0).contact_vertex(), 100);
}

TEST(MaterialMesh, GradingResolvesTheLayer) {
  EXPECT_EQ(grading_for_layer(1.0, 0.1, 20), 0.0);  // nothing to resolve
  const double weak = grading_for_layer(0.01, 0.1, 20);
  const double strong = grading_for_layer(0.001, 0.1, 20);
  EXPECT_GE(weak, 0.0);
  EXPECT_GE(strong, weak);
  EXPECT_LE(strong, 4.0);
}

}  // namespace
}  // namespace snare::wire
