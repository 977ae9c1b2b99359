#include "tests/support/random_rods.hpp"

#include <Eigen/Geometry>

namespace snare::test {

wire::PlanarRodProperties planar_properties() {
  wire::PlanarRodProperties p;
  p.bending_stiffness = 0.7;
  p.axial_stiffness = 5.0;
  p.natural_curvature = 0.4;
  p.weight = {0.3, -0.5};
  p.left.rotational_stiffness = 3.0;
  p.right.position = {1.0, 0.0};
  p.right.direction = {std::cos(0.2), std::sin(0.2)};
  p.right.translational_stiffness = 2.0;
  return p;
}

wire::SpatialRodProperties round_properties() {
  wire::SpatialRodProperties p;
  p.bending_stiffness = 0.7;
  p.second_bending_stiffness = 0.7;
  p.torsional_stiffness = 0.5;
  p.axial_stiffness = 5.0;
  p.weight = {0.3, -0.5, 0.2};
  p.left.rotational_stiffness = 3.0;
  p.right.position = {1.0, 0.0, 0.0};
  p.right.direction = {std::cos(0.2), std::sin(0.2), 0.0};
  p.right.director = {-std::sin(0.2), std::cos(0.2), 0.0};
  p.right.translational_stiffness = 2.0;
  return p;
}

wire::SpatialRodProperties general_properties() {
  wire::SpatialRodProperties p = round_properties();
  p.second_bending_stiffness = 1.9;
  p.natural_curvature = {0.4, -0.9};
  p.natural_twist = 0.6;
  p.left.direction = Eigen::Vector3d(1.0, 0.3, -0.2).normalized();
  p.left.director = p.left.direction.cross(Eigen::Vector3d(0.1, 0.2, 1.0)).normalized();
  p.left.twist_angle = 0.3;
  p.left.twisting_stiffness = 2.0;
  p.right.direction = Eigen::Vector3d(1.0, -0.2, 0.4).normalized();
  p.right.director = p.right.direction.cross(Eigen::Vector3d(-0.4, 0.2, 1.0)).normalized();
  p.right.twist_angle = -0.7;
  return p;
}

wire::PlanarState random_state(const wire::PlanarRod& rod, const wire::Controls& controls,
                               std::mt19937& random, double amount) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double disturbance = amount * controls.length() / rod.mesh().edges();
  wire::PlanarState state;
  state.controls = controls;
  state.q.resize(rod.unknowns());
  for (int i = 0; i < rod.mesh().vertices(); ++i) {
    state.q[2 * i] = rod.mesh().coordinate(i, controls) + disturbance * unit(random);
    state.q[2 * i + 1] = disturbance * unit(random);
  }
  return state;
}

wire::SpatialState random_state(const wire::SpatialRod& rod, const wire::Controls& controls,
                                std::mt19937& random, double amount) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double disturbance = amount * controls.length() / rod.mesh().edges();
  Eigen::VectorXd q(rod.unknowns());
  for (int i = 0; i < rod.mesh().vertices(); ++i) {
    q.segment<4>(4 * i) << rod.mesh().coordinate(i, controls) + disturbance * unit(random),
        disturbance * unit(random), disturbance * unit(random), unit(random);
  }
  return rod.make_state(q, controls);
}

}  // namespace snare::test
