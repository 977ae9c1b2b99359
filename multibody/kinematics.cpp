#include "multibody/kinematics.hpp"

#include "base/index.hpp"

#include <cassert>

namespace snare::multibody {

namespace {

using base::at;

/// Calls `each(column, S)` with the axis of every velocity that moves the frame's body, as a motion in the
/// world, and the velocity of the body that carries the axis.
template <class Each>
void for_axes(const Tree& tree, const Kinematics& kinematics, int body, const Each& each) {
  for (int i = body; i >= 0; i = tree.body(i).parent) {
    const TreeBody& b = tree.body(i);
    const Pose& X_WB = kinematics.X_WB[at(i)];
    switch (b.joint) {
      case JointKind::revolute:
        each(b.v_index, i, X_WB.to_outer(Twist{b.axis, Eigen::Vector3d::Zero()}));
        break;
      case JointKind::prismatic:
        each(b.v_index, i, X_WB.to_outer(Twist{Eigen::Vector3d::Zero(), b.axis}));
        break;
      case JointKind::free:
        for (int k = 0; k < 3; ++k) {
          const Eigen::Vector3d unit = Eigen::Vector3d::Unit(k);
          each(b.v_index + k, i, X_WB.to_outer(Twist{unit, Eigen::Vector3d::Zero()}));
          each(b.v_index + 3 + k, i, X_WB.to_outer(Twist{Eigen::Vector3d::Zero(), unit}));
        }
        break;
    }
  }
}

}  // namespace

Kinematics::Kinematics(const Tree& tree)
    : X_PB(at(tree.size())), X_WB(at(tree.size())), V_B(at(tree.size())) {}

void place(const Tree& tree, const Eigen::VectorXd& q, Kinematics& kinematics) {
  assert(q.size() == tree.coordinates());
  for (int i = 0; i < tree.size(); ++i) {
    const TreeBody& body = tree.body(i);
    kinematics.X_PB[at(i)] = body.X_PJ * joint_pose(body, q);
    kinematics.X_WB[at(i)] =
        body.parent < 0 ? kinematics.X_PB[at(i)] : kinematics.X_WB[at(body.parent)] * kinematics.X_PB[at(i)];
  }
}

void set_moving(const Tree& tree, const Eigen::VectorXd& v, Kinematics& kinematics) {
  assert(v.size() == tree.velocities());
  for (int i = 0; i < tree.size(); ++i) {
    const TreeBody& body = tree.body(i);
    Twist V = body.parent < 0 ? Twist{} : kinematics.X_PB[at(i)].to_inner(kinematics.V_B[at(body.parent)]);
    add_joint_motion(body, v, V);
    kinematics.V_B[at(i)] = V;
  }
}

Pose frame_pose(const Tree& tree, const Kinematics& kinematics, int frame) {
  const TreeFrame& f = tree.frame(frame);
  return f.body < 0 ? f.X_BF : kinematics.X_WB[at(f.body)] * f.X_BF;
}

FrameMotion frame_motion(const Tree& tree, const Kinematics& kinematics, int frame) {
  const TreeFrame& f = tree.frame(frame);
  if (f.body < 0) return {};
  const Twist& V = kinematics.V_B[at(f.body)];
  const Eigen::Matrix3d& R = kinematics.X_WB[at(f.body)].R;
  return {R * V.angular, R * (V.linear + V.angular.cross(f.X_BF.p))};
}

Matrix6X point_jacobian(const Tree& tree, const Kinematics& kinematics, int body,
                        const Eigen::Vector3d& p_W) {
  Matrix6X J = Matrix6X::Zero(6, tree.velocities());
  for_axes(tree, kinematics, body, [&](int column, int, const Twist& S) {
    J.col(column) << S.angular, S.linear + S.angular.cross(p_W);
  });
  return J;
}

void add_force(const Tree& tree, const Kinematics& kinematics, int body, const Eigen::Vector3d& p_W,
               const Wrench& F_W, Eigen::Ref<Eigen::VectorXd> forces) {
  const Wrench about_origin{F_W.moment + p_W.cross(F_W.force), F_W.force};
  for_axes(tree, kinematics, body,
           [&](int column, int, const Twist& S) { forces[column] += dot(S, about_origin); });
}

Matrix6X frame_jacobian(const Tree& tree, const Kinematics& kinematics, int frame) {
  return point_jacobian(tree, kinematics, tree.frame(frame).body, frame_pose(tree, kinematics, frame).p);
}

Matrix6X frame_jacobian_rate(const Tree& tree, const Kinematics& kinematics, int frame) {
  Matrix6X rate = Matrix6X::Zero(6, tree.velocities());
  const Eigen::Vector3d p = frame_pose(tree, kinematics, frame).p;
  const Eigen::Vector3d p_rate = frame_motion(tree, kinematics, frame).linear;
  // An axis is fixed in the body it carries: S' = V x S; and the point moves: (w x p)' = w' x p + w x p'.
  for_axes(tree, kinematics, tree.frame(frame).body, [&](int column, int body, const Twist& S) {
    const Twist S_rate = cross(kinematics.X_WB[at(body)].to_outer(kinematics.V_B[at(body)]), S);
    rate.col(column) << S_rate.angular, S_rate.linear + S_rate.angular.cross(p) + S.angular.cross(p_rate);
  });
  return rate;
}

double kinetic_energy(const Tree& tree, const Kinematics& kinematics) {
  double sum = 0.0;
  for (int i = 0; i < tree.size(); ++i) {
    const Twist& V = kinematics.V_B[at(i)];
    sum += 0.5 * dot(V, tree.body(i).inertia * V);
  }
  return sum;
}

double potential_energy(const Tree& tree, const Kinematics& kinematics) {
  double sum = 0.0;
  for (int i = 0; i < tree.size(); ++i) {
    const SpatialInertia& inertia = tree.body(i).inertia;
    const Pose& X_WB = kinematics.X_WB[at(i)];
    sum -= tree.gravity.dot(X_WB.R * inertia.first_moment + inertia.mass * X_WB.p);
  }
  return sum;
}

Wrench momentum(const Tree& tree, const Kinematics& kinematics) {
  Wrench sum;
  for (int i = 0; i < tree.size(); ++i) {
    sum += kinematics.X_WB[at(i)].to_outer(tree.body(i).inertia * kinematics.V_B[at(i)]);
  }
  return sum;
}

Eigen::Vector3d centre_of_mass(const Tree& tree, const Kinematics& kinematics) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (int i = 0; i < tree.size(); ++i) {
    const SpatialInertia& inertia = tree.body(i).inertia;
    const Pose& X_WB = kinematics.X_WB[at(i)];
    moment += X_WB.R * inertia.first_moment + inertia.mass * X_WB.p;
  }
  const double mass = tree.mass();
  return mass > 0.0 ? Eigen::Vector3d(moment / mass) : moment;
}

BodyWrench wrench_on_frame(const Tree& tree, int frame, const Wrench& F_F) {
  const TreeFrame& f = tree.frame(frame);
  return {f.body, f.X_BF.to_outer(F_F)};
}

BodyWrench world_wrench_on_frame(const Tree& tree, const Kinematics& kinematics, int frame,
                                 const Wrench& F_W) {
  const Eigen::Matrix3d R = frame_pose(tree, kinematics, frame).R;
  return wrench_on_frame(tree, frame, {R.transpose() * F_W.moment, R.transpose() * F_W.force});
}

}  // namespace snare::multibody
