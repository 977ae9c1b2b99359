#pragma once

#include "multibody/tree.hpp"
#include "tests/multibody/tree_motion.hpp"

#include <Eigen/Geometry>

#include <random>
#include <string>
#include <vector>

namespace snare::test {

/// A tree told in a way of its own, from which ours and those of other libraries are built.
struct PlainBody {
  enum class Joint { fixed, revolute, prismatic, free };
  int parent = -1;
  Joint joint = Joint::revolute;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< of the joint's frame in the parent
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double mass = 1.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  ///< about the centre of mass
};

struct PlainTree {
  std::vector<PlainBody> bodies;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
};

enum class Base { on_the_world, floating };

inline Eigen::Vector3d random_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

inline Eigen::VectorXd random_values(std::mt19937& random, int count, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return Eigen::VectorXd::NullaryExpr(count, [&] { return uniform(random); });
}

inline Eigen::Matrix3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

/// 1 to 12 bodies of order one in mass and size, each on an earlier one or the next in a chain.
inline PlainTree random_tree(std::mt19937& random, Base base, bool branched = true) {
  std::uniform_int_distribution<int> count(1, 12), kind(0, 9);
  std::uniform_real_distribution<double> mass(0.3, 3.0), unit(0.0, 1.0);
  PlainTree tree;
  tree.gravity = random_vector(random, 10.0);
  const int n = count(random);
  for (int i = 0; i < n; ++i) {
    PlainBody body;
    body.parent = branched && i > 0
                      ? std::uniform_int_distribution<int>(base == Base::floating ? 0 : -1, i - 1)(random)
                      : i - 1;
    const int drawn = kind(random);
    body.joint = drawn < 6   ? PlainBody::Joint::revolute
                 : drawn < 8 ? PlainBody::Joint::prismatic
                             : PlainBody::Joint::fixed;
    if (i == 0) body.joint = base == Base::floating ? PlainBody::Joint::free : PlainBody::Joint::revolute;
    body.axis = random_vector(random, 1.0).normalized();
    body.R = random_rotation(random);
    body.p = random_vector(random, 1.0);
    body.mass = mass(random);
    body.centre = random_vector(random, 0.5);
    // Moments of a cloud of mass: positive definite, triangle inequality.
    const Eigen::Vector3d spread(0.05 + unit(random), 0.05 + unit(random), 0.05 + unit(random));
    const Eigen::Matrix3d R = random_rotation(random);
    body.inertia = R * (Eigen::Matrix3d::Identity() * spread.sum() - Eigen::Matrix3d(spread.asDiagonal())) *
                   R.transpose();
    tree.bodies.push_back(body);
  }
  return tree;
}

inline std::string body_name(std::size_t i) {
  return "body" + std::to_string(i);
}

/// Ours; frame i + 1 is that of body i.
inline multibody::Tree make_tree(const PlainTree& plain) {
  multibody::Tree tree;
  tree.gravity = plain.gravity;
  for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
    const PlainBody& b = plain.bodies[i];
    const auto inertia = multibody::SpatialInertia::about_centre(b.mass, b.centre, b.inertia);
    const multibody::Pose X{b.R, b.p};
    switch (b.joint) {
      case PlainBody::Joint::fixed:
        tree.add_fixed(b.parent + 1, body_name(i), X, inertia);
        break;
      case PlainBody::Joint::revolute:
        tree.add_moving(b.parent + 1, body_name(i), multibody::JointKind::revolute, b.axis, X, inertia);
        break;
      case PlainBody::Joint::prismatic:
        tree.add_moving(b.parent + 1, body_name(i), multibody::JointKind::prismatic, b.axis, X, inertia);
        break;
      case PlainBody::Joint::free:
        tree.add_moving(b.parent + 1, body_name(i), multibody::JointKind::free, b.axis, X, inertia);
        break;
    }
  }
  return tree;
}

/// Joint values in [-3, 3], any attitude of free bodies, velocities in [-2, 2].
inline multibody::TreeState random_state(std::mt19937& random, const multibody::Tree& tree) {
  multibody::TreeState state{random_values(random, tree.coordinates(), 3.0),
                             random_values(random, tree.velocities(), 2.0)};
  normalise(tree, state.q);
  return state;
}

/// Largest difference over the largest entry of the reference, at least one.
inline double relative_difference(const Eigen::MatrixXd& value, const Eigen::MatrixXd& reference) {
  if (value.size() == 0) return 0.0;
  return (value - reference).cwiseAbs().maxCoeff() / std::max(1.0, reference.cwiseAbs().maxCoeff());
}

}  // namespace snare::test
