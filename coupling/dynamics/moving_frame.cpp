#include "coupling/dynamics/moving_frame.hpp"

#include "multibody/dynamics.hpp"

#include <Eigen/Cholesky>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::Vector4d;
using multibody::Matrix6X;
using multibody::Pose;
using multibody::Wrench;
using numerics::cross_matrix;
using numerics::VectorView;

namespace {

/// An axis of the joints that bear a body of a tree.
struct ChainAxis {
  int velocity;  ///< its index, and that of its column (s, v) in J
  int depth;     ///< of its joint in the chain: 0 at the body, less towards the root
};

std::vector<ChainAxis> chain_of(const multibody::Tree& tree, int body) {
  std::vector<ChainAxis> chain;
  int depth = 0;
  for (int i = body; i >= 0; i = tree.body(i).parent) {
    for (int k = 0; k < tree.body(i).velocities(); ++k) chain.push_back({tree.body(i).v_index + k, -depth});
    ++depth;
  }
  return chain;
}

}  // namespace

MovingFrame::MovingFrame(const multibody::ElasticArmPart& arm, int body, const Pose& X_BF)
    : arm_(body < 0 ? nullptr : &arm), tree_body_(body), X_CF_(X_BF) {}

bool MovingFrame::moves_freely() const {
  return arm_ != nullptr || (body_ != nullptr && body_->moves_freely());
}

std::vector<int> MovingFrame::coordinates() const {
  std::vector<int> list;
  const int first = body_ != nullptr ? body_->position() : (arm_ != nullptr ? arm_->coordinates() : 0);
  const int count = body_ != nullptr ? BodyPart::coordinates : (arm_ != nullptr ? arm_->arm().tree.coordinates() : 0);
  list.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) list.push_back(first + i);
  return list;
}

std::vector<int> MovingFrame::velocities() const {
  std::vector<int> list;
  const int first = body_ != nullptr ? body_->velocity() : (arm_ != nullptr ? arm_->velocities() : 0);
  const int count = body_ != nullptr ? BodyPart::velocities : (arm_ != nullptr ? arm_->arm().tree.velocities() : 0);
  list.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) list.push_back(first + i);
  return list;
}

MovingFrame::State MovingFrame::state(const VectorView& y) const {
  State s;
  if (body_ != nullptr) {
    const Pose X_WB{multibody::rotation(y.segment<4>(body_->quaternion())), y.segment<3>(body_->position())};
    s.X_WF = X_WB * X_CF_;
    s.angular = X_WB.R * y.segment<3>(body_->spin());
    s.linear = y.segment<3>(body_->velocity()) + s.angular.cross(X_WB.R * X_CF_.p);
  } else if (arm_ != nullptr) {
    const multibody::Kinematics& kinematics = arm_->kinematics(y);
    const Pose& X_WB = kinematics.X_WB[static_cast<std::size_t>(tree_body_)];
    const multibody::Twist& V = kinematics.V_B[static_cast<std::size_t>(tree_body_)];
    s.X_WF = X_WB * X_CF_;
    s.angular = X_WB.R * V.angular;
    s.linear = X_WB.R * (V.linear + V.angular.cross(X_CF_.p));
  } else {
    s.X_WF = X_CF_;
  }
  return s;
}

Matrix6X MovingFrame::jacobian(const VectorView& y) const {
  if (body_ != nullptr) {
    const Matrix3d R = multibody::rotation(y.segment<4>(body_->quaternion()));
    // (v, w in B) -> (w, v_F) in the world: w = R w_B, v_F = v - R [p_BF] w_B.
    Matrix6X J = Matrix6X::Zero(6, BodyPart::velocities);
    J.topRightCorner<3, 3>() = R;
    J.bottomLeftCorner<3, 3>().setIdentity();
    J.bottomRightCorner<3, 3>() = -R * cross_matrix(X_CF_.p);
    return J;
  }
  if (arm_ == nullptr) return Matrix6X::Zero(6, 0);
  const multibody::Kinematics& kinematics = arm_->kinematics(y);
  return multibody::point_jacobian(arm_->arm().tree, kinematics, tree_body_,
                                   (kinematics.X_WB[static_cast<std::size_t>(tree_body_)] * X_CF_).p);
}

MovingFrame::Derivatives MovingFrame::differentiate(const VectorView& y) const {
  Derivatives d;
  d.jacobian = jacobian(y);
  if (body_ != nullptr) {
    // Coordinates: the centre of mass and the quaternion, whose change dq turns the body by phi = 4 R Q^T dq. Then
    // dp_WF = dp + phi x R p_BF, and J = [0 R; 1 -R [p_BF]] turns with R: dR = [phi] R.
    const Vector4d q = y.segment<4>(body_->quaternion());
    const Matrix3d R = multibody::rotation(q);
    const Eigen::Matrix<double, 3, 4> turn = 4.0 * R * multibody::quaternion_rates(q).transpose();
    const Vector3d arm = R * X_CF_.p;
    d.place = d.motion = Matrix6X::Zero(6, BodyPart::coordinates);
    d.place.bottomLeftCorner<3, 3>().setIdentity();
    d.place.topRightCorner<3, 4>() = turn;
    d.place.bottomRightCorner<3, 4>() = -cross_matrix(arm) * turn;
    d.jacobian_by.assign(BodyPart::coordinates, Matrix6X::Zero(6, BodyPart::velocities));
    for (int k = 0; k < 4; ++k) {
      const Matrix3d turned = cross_matrix(turn.col(k)) * R;
      const int coordinate = body_->quaternion() - body_->position() + k;
      Matrix6X& by = d.jacobian_by[static_cast<std::size_t>(coordinate)];
      by.topRightCorner<3, 3>() = turned;
      by.bottomRightCorner<3, 3>() = -turned * cross_matrix(X_CF_.p);
      d.motion.col(coordinate) << turned * y.segment<3>(body_->spin()),
          by.bottomRightCorner<3, 3>() * y.segment<3>(body_->spin());
    }
    return d;
  }
  if (arm_ == nullptr) {
    d.place = d.motion = Matrix6X::Zero(6, 0);
    return d;
  }
  // Moving axis j (s_j, and v_j at the frame's origin) carries the axes of its own joint and all outward of it along:
  // ds_i = s_j x s_i, dv_i = s_j x v_i, and moves the origin for those inward: dv_i = s_i x v_j.
  const multibody::Tree& tree = arm_->arm().tree;
  const int nv = tree.velocities(), nq = tree.coordinates();
  const std::vector<ChainAxis> chain = chain_of(tree, tree_body_);
  std::vector<Matrix6X> by_motion(static_cast<std::size_t>(nv), Matrix6X::Zero(6, nv));
  for (const ChainAxis& j : chain) {
    const Vector3d s_j = d.jacobian.col(j.velocity).head<3>(), v_j = d.jacobian.col(j.velocity).tail<3>();
    Matrix6X& by = by_motion[static_cast<std::size_t>(j.velocity)];
    for (const ChainAxis& i : chain) {
      const Vector3d s_i = d.jacobian.col(i.velocity).head<3>(), v_i = d.jacobian.col(i.velocity).tail<3>();
      if (i.depth >= j.depth) {
        by.col(i.velocity) << s_j.cross(s_i), s_j.cross(v_i);
      } else {
        by.col(i.velocity).tail<3>() = s_i.cross(v_j);
      }
    }
  }
  const MatrixXd to_motion = multibody::coordinate_motion(tree, y.segment(arm_->coordinates(), nq));
  d.place = d.jacobian * to_motion;
  d.jacobian_by.assign(static_cast<std::size_t>(nq), Matrix6X::Zero(6, nv));
  d.motion = Matrix6X::Zero(6, nq);
  for (int k = 0; k < nq; ++k) {
    Matrix6X& by = d.jacobian_by[static_cast<std::size_t>(k)];
    for (int j = 0; j < nv; ++j) {
      if (to_motion(j, k) != 0.0) by += to_motion(j, k) * by_motion[static_cast<std::size_t>(j)];
    }
    d.motion.col(k) = by * y.segment(arm_->velocities(), nv);
  }
  return d;
}

MatrixXd MovingFrame::Derivatives::force(const Wrench& wrench) const {
  MatrixXd result(jacobian.cols(), static_cast<Eigen::Index>(jacobian_by.size()));
  for (std::size_t k = 0; k < jacobian_by.size(); ++k)
    result.col(static_cast<Eigen::Index>(k)) = jacobian_by[k].transpose() * wrench.vector();
  return result;
}

void MovingFrame::push(const Matrix6X& jacobian, const Wrench& wrench, Eigen::Ref<Eigen::VectorXd> rows) const {
  if (!moves_freely()) return;
  const int first = body_ != nullptr ? body_->velocity() : arm_->velocities();
  rows.segment(first, jacobian.cols()) -= jacobian.transpose() * wrench.vector();
}

void MovingFrame::apply_impulse(const VectorView& y, const Matrix6X& jacobian, const Wrench& wrench,
                                Eigen::VectorXd& dv) const {
  if (!moves_freely()) return;
  const Eigen::VectorXd force = jacobian.transpose() * wrench.vector();
  if (body_ != nullptr) {
    dv.segment<3>(body_->velocity()) += force.head<3>() / body_->body().properties.mass;
    dv.segment<3>(body_->spin()) += body_->inverse_inertia() * force.tail<3>();
    return;
  }
  const multibody::Tree& tree = arm_->arm().tree;
  multibody::DynamicsWorkspace workspace(tree);
  const MatrixXd& H = multibody::mass_matrix(tree, y.segment(arm_->coordinates(), tree.coordinates()), workspace);
  dv.segment(arm_->velocities(), tree.velocities()) += H.ldlt().solve(force);
}

}  // namespace snare::coupling
