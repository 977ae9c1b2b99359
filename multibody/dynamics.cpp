#include "multibody/dynamics.hpp"

#include "base/index.hpp"
#include "multibody/kinematics.hpp"

#include <Eigen/Cholesky>

#include <cassert>

namespace snare::multibody {

namespace {

using base::at;

/// V x VJ, the acceleration that the joint's velocity brings because its axis turns with the body.
Twist velocity_product(const TreeBody& body, const Twist& V, const Eigen::VectorXd& v) {
  switch (body.joint) {
    case JointKind::revolute: {
      const Eigen::Vector3d w = v[body.v_index] * body.axis;
      return {V.angular.cross(w), V.linear.cross(w)};
    }
    case JointKind::prismatic:
      return {Eigen::Vector3d::Zero(), V.angular.cross(v[body.v_index] * body.axis)};
    case JointKind::free: {
      Twist VJ;
      add_joint_motion(body, v, VJ);
      return cross(V, VJ);
    }
  }
  return {};
}

Pose pose_in_parent(const TreeBody& body, const Eigen::VectorXd& q) {
  switch (body.joint) {
    case JointKind::revolute:
      return {body.X_PJ.R * joint_pose(body, q).R, body.X_PJ.p};
    case JointKind::prismatic:
      return {body.X_PJ.R, body.X_PJ.p + body.X_PJ.R * (q[body.q_index] * body.axis)};
    case JointKind::free:
      return body.X_PJ * joint_pose(body, q);
  }
  return {};
}

/// Component of a wrench along the axis of a joint with one.
double along_axis(const TreeBody& body, const Wrench& f) {
  return body.axis.dot(body.joint == JointKind::revolute ? f.moment : f.force);
}

Wrench apply(const ArticulatedInertia& inertia, const Twist& v) {
  return {inertia.I * v.angular + inertia.H * v.linear,
          inertia.H.transpose() * v.angular + inertia.M * v.linear};
}

/// The same inertia seen from the parent. After turning, with P = [p]x: H_P = H + P M, I_P = I - H P + P
/// H_P^T.
ArticulatedInertia to_outer(const ArticulatedInertia& inertia, const Pose& X_PB) {
  const Eigen::Matrix3d& R = X_PB.R;
  const Eigen::Matrix3d P = cross_matrix(X_PB.p);
  ArticulatedInertia out;
  out.M.noalias() = R * inertia.M * R.transpose();
  const Eigen::Matrix3d H = R * inertia.H * R.transpose();
  out.H.noalias() = H + P * out.M;
  out.I.noalias() = R * inertia.I * R.transpose();
  out.I.noalias() += P * out.H.transpose();
  out.I.noalias() -= H * P;
  return out;
}

}  // namespace

DynamicsWorkspace::DynamicsWorkspace(const Tree& tree)
    : X_PB(at(tree.size())),
      V_B(at(tree.size())),
      A_B(at(tree.size())),
      F_B(at(tree.size())),
      composite(at(tree.size())),
      articulated(at(tree.size())),
      bias(at(tree.size())),
      U(at(tree.size())),
      D(at(tree.size())),
      u(at(tree.size())),
      torque(Eigen::VectorXd::Zero(tree.velocities())),
      acceleration(Eigen::VectorXd::Zero(tree.velocities())),
      mass_matrix(Eigen::MatrixXd::Zero(tree.velocities(), tree.velocities())) {}

const Eigen::VectorXd& inverse_dynamics(const Tree& tree, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                        const Eigen::VectorXd& acceleration, BodyWrenches wrenches,
                                        DynamicsWorkspace& workspace) {
  assert(q.size() == tree.coordinates() && v.size() == tree.velocities() && acceleration.size() == v.size());
  assert(wrenches.empty() || static_cast<int>(wrenches.size()) == tree.size());
  const Twist world{Eigen::Vector3d::Zero(), -tree.gravity};  // gravity as an acceleration of the world
  for (int i = 0; i < tree.size(); ++i) {
    const TreeBody& body = tree.body(i);
    const Pose X = workspace.X_PB[at(i)] = pose_in_parent(body, q);
    Twist V, A;
    if (body.parent < 0) {
      A = X.to_inner(world);
    } else {
      V = X.to_inner(workspace.V_B[at(body.parent)]);
      A = X.to_inner(workspace.A_B[at(body.parent)]);
    }
    add_joint_motion(body, v, V);
    add_joint_motion(body, acceleration, A);
    A += velocity_product(body, V, v);
    workspace.V_B[at(i)] = V;
    workspace.A_B[at(i)] = A;
    Wrench F = body.inertia * A + cross(V, body.inertia * V);
    if (!wrenches.empty()) F -= wrenches[at(i)];
    workspace.F_B[at(i)] = F;
  }
  for (int i = tree.size() - 1; i >= 0; --i) {
    const TreeBody& body = tree.body(i);
    const Wrench& F = workspace.F_B[at(i)];
    if (body.joint == JointKind::free) {
      workspace.torque.segment<3>(body.v_index) = F.moment;
      workspace.torque.segment<3>(body.v_index + 3) = F.force;
    } else {
      workspace.torque[body.v_index] = along_axis(body, F);
    }
    if (body.parent >= 0) workspace.F_B[at(body.parent)] += workspace.X_PB[at(i)].to_outer(F);
  }
  return workspace.torque;
}

const Eigen::MatrixXd& mass_matrix(const Tree& tree, const Eigen::VectorXd& q, DynamicsWorkspace& workspace) {
  assert(q.size() == tree.coordinates());
  for (int i = 0; i < tree.size(); ++i) {
    workspace.X_PB[at(i)] = pose_in_parent(tree.body(i), q);
    workspace.composite[at(i)] = tree.body(i).inertia;
  }
  Eigen::MatrixXd& H = workspace.mass_matrix;
  for (int i = tree.size() - 1; i >= 0; --i) {
    const TreeBody& body = tree.body(i);
    const SpatialInertia& composite = workspace.composite[at(i)];
    if (body.parent >= 0) workspace.composite[at(body.parent)] += composite.to_outer(workspace.X_PB[at(i)]);

    // The wrench that a unit acceleration of the joint asks for, carried down to every joint that bears it.
    const auto column = [&](int k, Wrench F) {
      for (int j = i; j >= 0; j = tree.body(j).parent) {
        const TreeBody& bearer = tree.body(j);
        if (bearer.joint == JointKind::free) {
          H.col(k).segment<3>(bearer.v_index) = F.moment;
          H.col(k).segment<3>(bearer.v_index + 3) = F.force;
          H.row(k).segment<3>(bearer.v_index) = F.moment;
          H.row(k).segment<3>(bearer.v_index + 3) = F.force;
        } else {
          H(bearer.v_index, k) = H(k, bearer.v_index) = along_axis(bearer, F);
        }
        if (bearer.parent >= 0) F = workspace.X_PB[at(j)].to_outer(F);
      }
    };
    switch (body.joint) {
      case JointKind::revolute:
        column(body.v_index, {composite.rotational * body.axis, -composite.first_moment.cross(body.axis)});
        break;
      case JointKind::prismatic:
        column(body.v_index, {composite.first_moment.cross(body.axis), composite.mass * body.axis});
        break;
      case JointKind::free:
        for (int k = 0; k < 3; ++k) {
          const Eigen::Vector3d unit = Eigen::Vector3d::Unit(k);
          column(body.v_index + k, composite * Twist{unit, Eigen::Vector3d::Zero()});
          column(body.v_index + 3 + k, composite * Twist{Eigen::Vector3d::Zero(), unit});
        }
        break;
    }
  }
  return H;
}

const Eigen::VectorXd& forward_dynamics(const Tree& tree, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                        const Eigen::VectorXd& torque, BodyWrenches wrenches,
                                        DynamicsWorkspace& workspace) {
  assert(q.size() == tree.coordinates() && v.size() == tree.velocities() && torque.size() == v.size());
  assert(wrenches.empty() || static_cast<int>(wrenches.size()) == tree.size());
  // Outwards: velocities, velocity products, and the bias wrench of each body alone (kept in F_B).
  for (int i = 0; i < tree.size(); ++i) {
    const TreeBody& body = tree.body(i);
    const Pose X = workspace.X_PB[at(i)] = pose_in_parent(body, q);
    Twist V = body.parent < 0 ? Twist{} : X.to_inner(workspace.V_B[at(body.parent)]);
    add_joint_motion(body, v, V);
    workspace.V_B[at(i)] = V;
    workspace.bias[at(i)] = velocity_product(body, V, v);
    workspace.F_B[at(i)] = cross(V, body.inertia * V);
    if (!wrenches.empty()) workspace.F_B[at(i)] -= wrenches[at(i)];
    workspace.articulated[at(i)] = {body.inertia.rotational, cross_matrix(body.inertia.first_moment),
                                    body.inertia.mass * Eigen::Matrix3d::Identity()};
  }
  // Inwards: what is left of inertia and bias once the joint gives way.
  for (int i = tree.size() - 1; i >= 0; --i) {
    const TreeBody& body = tree.body(i);
    if (body.joint == JointKind::free) {
      // Nothing but the joint's own wrench passes to the parent.
      if (body.parent >= 0) {
        const Wrench passed{torque.segment<3>(body.v_index), torque.segment<3>(body.v_index + 3)};
        workspace.F_B[at(body.parent)] += workspace.X_PB[at(i)].to_outer(passed);
      }
      continue;
    }
    const ArticulatedInertia& inertia = workspace.articulated[at(i)];
    Wrench& U = workspace.U[at(i)];
    if (body.joint == JointKind::revolute) {
      U = {inertia.I * body.axis, inertia.H.transpose() * body.axis};
    } else {
      U = {inertia.H * body.axis, inertia.M * body.axis};
    }
    const double D = workspace.D[at(i)] = along_axis(body, U);
    const double u = workspace.u[at(i)] = torque[body.v_index] - along_axis(body, workspace.F_B[at(i)]);
    if (body.parent < 0) continue;
    const Eigen::Vector3d moment = U.moment / D, force = U.force / D;
    ArticulatedInertia left = inertia;
    left.I.noalias() -= U.moment * moment.transpose();
    left.H.noalias() -= U.moment * force.transpose();
    left.M.noalias() -= U.force * force.transpose();
    const Wrench passed =
        workspace.F_B[at(i)] + apply(left, workspace.bias[at(i)]) + Wrench{u * moment, u * force};
    const Pose& X = workspace.X_PB[at(i)];
    const ArticulatedInertia felt = to_outer(left, X);
    ArticulatedInertia& parent = workspace.articulated[at(body.parent)];
    parent.I += felt.I;
    parent.H += felt.H;
    parent.M += felt.M;
    workspace.F_B[at(body.parent)] += X.to_outer(passed);
  }
  // Outwards: accelerations.
  const Twist world{Eigen::Vector3d::Zero(), -tree.gravity};
  for (int i = 0; i < tree.size(); ++i) {
    const TreeBody& body = tree.body(i);
    const Pose& X = workspace.X_PB[at(i)];
    Twist A = X.to_inner(body.parent < 0 ? world : workspace.A_B[at(body.parent)]) + workspace.bias[at(i)];
    if (body.joint == JointKind::free) {
      const ArticulatedInertia& inertia = workspace.articulated[at(i)];
      Matrix6 whole;
      whole << inertia.I, inertia.H, inertia.H.transpose(), inertia.M;
      const Vector6 left = torque.segment<6>(body.v_index) - workspace.F_B[at(i)].vector();
      const Vector6 total = whole.ldlt().solve(left);  // acceleration of the body, gravity taken off
      workspace.acceleration.segment<6>(body.v_index) = total - A.vector();
      A = {total.head<3>(), total.tail<3>()};
    } else {
      const double rate = (workspace.u[at(i)] - dot(A, workspace.U[at(i)])) / workspace.D[at(i)];
      workspace.acceleration[body.v_index] = rate;
      (body.joint == JointKind::revolute ? A.angular : A.linear) += rate * body.axis;
    }
    workspace.A_B[at(i)] = A;
  }
  return workspace.acceleration;
}

}  // namespace snare::multibody
