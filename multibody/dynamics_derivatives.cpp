#include "multibody/dynamics_derivatives.hpp"

#include "base/index.hpp"

#include <cassert>

namespace snare::multibody {

namespace {

using base::at;

/// Axis k of a body's joint as a motion in the world.
Twist axis_in_world(const TreeBody& body, const Pose& X_WB, int k) {
  Twist S;
  switch (body.joint) {
    case JointKind::revolute:
      S.angular = body.axis;
      break;
    case JointKind::prismatic:
      S.linear = body.axis;
      break;
    case JointKind::free:
      (k < 3 ? S.angular : S.linear) = Eigen::Vector3d::Unit(k % 3);
      break;
  }
  return X_WB.to_outer(S);
}

Wrench apply(const Matrix6& matrix, const Twist& v) {
  const Vector6 f = matrix * v.vector();
  return {f.head<3>(), f.tail<3>()};
}

/// 2 B of one body: the derivative of V x* I V along a change of V that the body carries.
///   2 B u = V x* (I u) - I (V x u) + u x* (I V)
Matrix6 quadratic(const SpatialInertia& inertia, const Twist& V) {
  Matrix6 V_cross;
  V_cross << cross_matrix(V.angular), Eigen::Matrix3d::Zero(), cross_matrix(V.linear),
      cross_matrix(V.angular);
  const Matrix6 carried = inertia.matrix() * V_cross;
  const Wrench momentum = inertia * V;
  const Eigen::Matrix3d n = cross_matrix(momentum.moment), f = cross_matrix(momentum.force);
  Matrix6 turned;
  turned << -n, -f, -f, Eigen::Matrix3d::Zero();
  return turned - carried - carried.transpose();  // V x* = -(V x)^T
}

}  // namespace

InverseDynamicsDerivatives::InverseDynamicsDerivatives(const Tree& tree)
    : position(Eigen::MatrixXd::Zero(tree.velocities(), tree.velocities())),
      velocity(position),
      mass(position),
      kinematics(tree),
      V_W(at(tree.size())),
      A_W(at(tree.size())),
      inertia_W(at(tree.size())),
      quadratic_W(at(tree.size())),
      wrench_W(at(tree.size())) {}

const InverseDynamicsDerivatives& differentiate_inverse_dynamics(const Tree& tree, const Eigen::VectorXd& q,
                                                                 const Eigen::VectorXd& v,
                                                                 const Eigen::VectorXd& acceleration,
                                                                 BodyWrenches wrenches,
                                                                 InverseDynamicsDerivatives& derivatives) {
  assert(q.size() == tree.coordinates() && v.size() == tree.velocities() && acceleration.size() == v.size());
  InverseDynamicsDerivatives& d = derivatives;
  const Twist world{Eigen::Vector3d::Zero(), -tree.gravity};
  place(tree, q, d.kinematics);
  for (int i = 0; i < tree.size(); ++i) {
    const TreeBody& body = tree.body(i);
    const Pose& X_WB = d.kinematics.X_WB[at(i)];
    Twist joint_v, joint_a;
    for (int k = 0; k < body.velocities(); ++k) {
      const Twist S = axis_in_world(body, X_WB, k);
      joint_v += v[body.v_index + k] * S;
      joint_a += acceleration[body.v_index + k] * S;
    }
    const bool rooted = body.parent < 0;
    const Twist V = (rooted ? Twist{} : d.V_W[at(body.parent)]) + joint_v;
    const Twist A = (rooted ? world : d.A_W[at(body.parent)]) + joint_a + cross(V, joint_v);
    const SpatialInertia inertia = body.inertia.to_outer(X_WB);
    d.V_W[at(i)] = V;
    d.A_W[at(i)] = A;
    d.inertia_W[at(i)] = inertia;
    d.quadratic_W[at(i)] = quadratic(inertia, V);
    d.wrench_W[at(i)] = inertia * A + cross(V, inertia * V);
    if (!wrenches.empty()) d.wrench_W[at(i)] -= X_WB.to_outer(wrenches[at(i)]);
  }

  // Moving joint axis S_j moves all that it carries rigidly, and changes the velocities there by psi' =
  // V_parent x S_j and the accelerations by psi'' = A_parent x S_j + V_parent x psi' (+ psi' x V), seen from
  // the bodies. Each column therefore needs one wrench at its own body, which is felt by the joints below;
  // the joints above feel their composite bodies'.
  d.position.setZero();
  d.velocity.setZero();
  d.mass.setZero();
  for (int i = tree.size() - 1; i >= 0; --i) {
    const TreeBody& body = tree.body(i);
    const SpatialInertia& inertia = d.inertia_W[at(i)];
    const Matrix6& quadratic_i = d.quadratic_W[at(i)];
    const Wrench& wrench = d.wrench_W[at(i)];
    const Twist V_parent = body.parent < 0 ? Twist{} : d.V_W[at(body.parent)];
    const Twist A_parent = body.parent < 0 ? world : d.A_W[at(body.parent)];

    for (int k = 0; k < body.velocities(); ++k) {
      const int column = body.v_index + k;
      const Twist S = axis_in_world(body, d.kinematics.X_WB[at(i)], k);
      const Twist psi = cross(V_parent, S);
      const Twist psi_rate = cross(A_parent, S) + cross(V_parent, psi);
      const Twist S_rate = cross(d.V_W[at(i)], S);
      const Wrench by_velocity = apply(quadratic_i, S) + inertia * (psi + S_rate);
      const Wrench by_acceleration = inertia * S;
      const Wrench inner = apply(quadratic_i, psi) + inertia * psi_rate;
      const Wrench outer = inner + cross(S, wrench);
      // Rows of this body and of those below it.
      for (int j = i; j >= 0; j = tree.body(j).parent) {
        const TreeBody& bearer = tree.body(j);
        for (int l = 0; l < bearer.velocities(); ++l) {
          const int row = bearer.v_index + l;
          const Twist T = axis_in_world(bearer, d.kinematics.X_WB[at(j)], l);
          d.position(row, column) = dot(T, j == i ? inner : outer);
          d.velocity(row, column) = dot(T, by_velocity);
          d.mass(row, column) = dot(T, by_acceleration);
          d.mass(column, row) = d.mass(row, column);
        }
      }
      // Row of this axis, columns of the joints below: their change of the motion in this body's composite.
      const Vector6 row_quadratic = quadratic_i.transpose() * S.vector();

      for (int j = body.parent; j >= 0; j = tree.body(j).parent) {
        const TreeBody& bearer = tree.body(j);
        const bool rooted = bearer.parent < 0;
        const Twist V_below = rooted ? Twist{} : d.V_W[at(bearer.parent)];
        const Twist A_below = rooted ? world : d.A_W[at(bearer.parent)];
        for (int l = 0; l < bearer.velocities(); ++l) {
          const Twist T = axis_in_world(bearer, d.kinematics.X_WB[at(j)], l);
          const Twist T_psi = cross(V_below, T);
          const Twist T_psi_rate = cross(A_below, T) + cross(V_below, T_psi);
          const Twist T_rate = cross(d.V_W[at(j)], T);
          d.position(column, bearer.v_index + l) =
              row_quadratic.dot(T_psi.vector()) + dot(S, inertia * T_psi_rate);
          d.velocity(column, bearer.v_index + l) =
              row_quadratic.dot(T.vector()) + dot(S, inertia * (T_psi + T_rate));
        }
      }
    }
    if (body.parent >= 0) {
      d.inertia_W[at(body.parent)] += inertia;
      d.quadratic_W[at(body.parent)] += quadratic_i;
      d.wrench_W[at(body.parent)] += wrench;
    }
  }
  return d;
}

MomentumDerivatives differentiate_momentum(const Tree& tree, const InverseDynamicsDerivatives& derivatives) {
  MomentumDerivatives d{Matrix6X::Zero(6, tree.velocities()), Matrix6X::Zero(6, tree.velocities())};
  std::vector<Wrench> carried(at(tree.size()));  // momentum of each body with all that it carries
  for (int i = tree.size() - 1; i >= 0; --i) {
    const TreeBody& body = tree.body(i);
    const Pose& X_WB = derivatives.kinematics.X_WB[at(i)];
    carried[at(i)] += body.inertia.to_outer(X_WB) * derivatives.V_W[at(i)];
    if (body.parent >= 0) carried[at(body.parent)] += carried[at(i)];
    const Twist V_parent = body.parent < 0 ? Twist{} : derivatives.V_W[at(body.parent)];
    for (int k = 0; k < body.velocities(); ++k) {
      const Twist S = axis_in_world(body, X_WB, k);
      const SpatialInertia& inertia = derivatives.inertia_W[at(i)];
      d.position.col(body.v_index + k) = (cross(S, carried[at(i)]) + inertia * cross(V_parent, S)).vector();
      d.velocity.col(body.v_index + k) = (inertia * S).vector();
    }
  }
  return d;
}

Eigen::Matrix<double, 6, 7> free_coordinate_motion(const TreeBody& body, const Eigen::VectorXd& q) {
  // Body-fixed turn 2 conj(quat) dquat / |quat|^2; the part along quat changes only its norm.
  const int i = body.q_index;
  const double w = q[i + 3];
  const Eigen::Vector3d u = q.segment<3>(i + 4);
  const double scale = 2.0 / (w * w + u.squaredNorm());
  Eigen::Matrix<double, 6, 7> motion = Eigen::Matrix<double, 6, 7>::Zero();
  motion.block<3, 1>(0, 3) = -scale * u;
  motion.block<3, 3>(0, 4) = scale * (w * Eigen::Matrix3d::Identity() - cross_matrix(u));
  motion.block<3, 3>(3, 0) = joint_pose(body, q).R.transpose();
  return motion;
}

Eigen::MatrixXd coordinate_motion(const Tree& tree, const Eigen::VectorXd& q) {
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(tree.velocities(), tree.coordinates());
  for (const TreeBody& body : tree.bodies()) {
    if (body.joint == JointKind::free) {
      motion.block<6, 7>(body.v_index, body.q_index) = free_coordinate_motion(body, q);
    } else {
      motion(body.v_index, body.q_index) = 1.0;
    }
  }
  return motion;
}

FreeRateDerivatives differentiate_free_coordinate_rate(const TreeBody& body, const Eigen::VectorXd& q,
                                                       const Eigen::VectorXd& v) {
  const int i = body.q_index, k = body.v_index;
  const Eigen::Vector3d omega = v.segment<3>(k), linear = v.segment<3>(k + 3);
  const Eigen::Matrix3d R = joint_pose(body, q).R;
  FreeRateDerivatives d{Eigen::Matrix<double, 7, 7>::Zero(), Eigen::Matrix<double, 7, 6>::Zero()};
  // p' = R v, and a turn dtheta of the body changes R v by R (dtheta x v).
  d.by_coordinates.topRightCorner<3, 4>() =
      -R * cross_matrix(linear) * free_coordinate_motion(body, q).topRightCorner<3, 4>();
  d.by_velocities.topRightCorner<3, 3>() = R;
  // w' = -u.omega / 2, u' = (w omega + u x omega) / 2.
  d.by_coordinates.block<1, 3>(3, 4) = -0.5 * omega.transpose();
  d.by_coordinates.block<3, 1>(4, 3) = 0.5 * omega;
  d.by_coordinates.block<3, 3>(4, 4) = -0.5 * cross_matrix(omega);
  d.by_velocities.block<1, 3>(3, 0) = -0.5 * q.segment<3>(i + 4).transpose();
  d.by_velocities.block<3, 3>(4, 0) =
      0.5 * (q[i + 3] * Eigen::Matrix3d::Identity() + cross_matrix(q.segment<3>(i + 4)));
  return d;
}

}  // namespace snare::multibody
