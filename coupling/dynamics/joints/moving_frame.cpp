#include "coupling/dynamics/joints/moving_frame.hpp"

#include "multibody/dynamics.hpp"
#include "numerics/dense_solvers.hpp"

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

/// The axes of the joints that bear a body of a tree.
std::vector<MovingFrame::ChainAxis> chain_of(const multibody::Tree& tree, int body) {
  std::vector<MovingFrame::ChainAxis> chain;
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
  const int count =
      body_ != nullptr ? BodyPart::coordinates : (arm_ != nullptr ? arm_->arm().tree.coordinates() : 0);
  list.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) list.push_back(first + i);
  return list;
}

std::vector<int> MovingFrame::velocities() const {
  std::vector<int> list;
  const int first = body_ != nullptr ? body_->velocity() : (arm_ != nullptr ? arm_->velocities() : 0);
  const int count =
      body_ != nullptr ? BodyPart::velocities : (arm_ != nullptr ? arm_->arm().tree.velocities() : 0);
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

// A body's coordinates are the centre of mass and the quaternion, whose change dq turns it by phi = 4 R Q^T
// dq. Then dp_WF = dp + phi x R p_BF, and of J = [0 R; 1 -R [p_BF]] the columns of the spin turn with R.
// Moving axis j (s_j, and v_j at the frame's origin) of an arm carries the axes of its own joint and all
// outward of it along: ds_i = s_j x s_i, dv_i = s_j x v_i, and moves the origin for those inward: dv_i = s_i
// x v_j.
template <class Each>
void MovingFrame::Derivatives::for_changes(const Each& each) const {
  const auto angular = [this](int i) -> Vector3d { return jacobian.col(i).head<3>(); };
  const auto linear = [this](int i) -> Vector3d { return jacobian.col(i).tail<3>(); };
  if (!of_arm()) {
    for (int j = 0; j < turn_.cols(); ++j) {
      const Vector3d phi = turn_.col(j);
      for (int i = spin_; i < jacobian.cols(); ++i)
        each(i, first_turning_ + j, multibody::Twist{phi.cross(angular(i)), phi.cross(linear(i))});
    }
    return;
  }
  for (const ChainAxis& j : chain_) {
    const Vector3d s_j = angular(j.velocity), v_j = linear(j.velocity);
    for (const ChainAxis& i : chain_) {
      if (i.depth >= j.depth)
        each(i.velocity, j.velocity,
             multibody::Twist{s_j.cross(angular(i.velocity)), s_j.cross(linear(i.velocity))});
      else
        each(i.velocity, j.velocity, multibody::Twist{Vector3d::Zero(), angular(i.velocity).cross(v_j)});
    }
  }
}

void MovingFrame::Derivatives::add_motion(const Eigen::Ref<const Eigen::VectorXd>& velocities) {
  Matrix6X by = Matrix6X::Zero(6, of_arm() ? jacobian.cols() : place.cols());
  for_changes(
      [&](int i, int j, const multibody::Twist& change) { by.col(j) += velocities[i] * change.vector(); });
  motion = of_arm() ? Matrix6X(by * to_motion_) : by;
}

MatrixXd MovingFrame::Derivatives::force(const Wrench& wrench) const {
  MatrixXd by = MatrixXd::Zero(jacobian.cols(), of_arm() ? jacobian.cols() : place.cols());
  for_changes([&](int i, int j, const multibody::Twist& change) {
    by(i, j) = change.angular.dot(wrench.moment) + change.linear.dot(wrench.force);
  });
  return of_arm() ? MatrixXd(by * to_motion_) : by;
}

MovingFrame::Derivatives MovingFrame::differentiate(const VectorView& y) const {
  Derivatives d;
  d.jacobian = jacobian(y);
  if (body_ != nullptr) {
    const Vector4d q = y.segment<4>(body_->quaternion());
    const Matrix3d R = multibody::rotation(q);
    d.turn_ = 4.0 * R * multibody::quaternion_rates(q).transpose();
    d.first_turning_ = body_->quaternion() - body_->position();
    d.spin_ = body_->spin() - body_->velocity();
    d.place = Matrix6X::Zero(6, BodyPart::coordinates);
    d.place.bottomLeftCorner<3, 3>().setIdentity();
    d.place.topRightCorner<3, 4>() = d.turn_;
    d.place.bottomRightCorner<3, 4>() = -cross_matrix(Vector3d(R * X_CF_.p)) * d.turn_;
    d.add_motion(y.segment<BodyPart::velocities>(body_->velocity()));
  } else if (arm_ != nullptr) {
    const multibody::Tree& tree = arm_->arm().tree;
    d.chain_ = chain_of(tree, tree_body_);
    d.to_motion_ = multibody::coordinate_motion(tree, y.segment(arm_->coordinates(), tree.coordinates()));
    d.place = d.jacobian * d.to_motion_;
    d.add_motion(y.segment(arm_->velocities(), tree.velocities()));
  } else {
    d.place = d.motion = Matrix6X::Zero(6, 0);
  }
  return d;
}

void MovingFrame::push(const VectorView& y, const Wrench& wrench, Eigen::Ref<Eigen::VectorXd> rows) const {
  if (!moves_freely()) return;
  if (body_ != nullptr) {
    const Matrix3d R = multibody::rotation(y.segment<4>(body_->quaternion()));
    rows.segment<3>(body_->velocity()) -= wrench.force;
    rows.segment<3>(body_->spin()) -=
        R.transpose() * wrench.moment + X_CF_.p.cross(Vector3d(R.transpose() * wrench.force));
    return;
  }
  const multibody::Kinematics& kinematics = arm_->kinematics(y);
  multibody::add_force(arm_->arm().tree, kinematics, tree_body_,
                       (kinematics.X_WB[static_cast<std::size_t>(tree_body_)] * X_CF_).p,
                       {-wrench.moment, -wrench.force},
                       rows.segment(arm_->velocities(), arm_->arm().tree.velocities()));
}

void MovingFrame::push(const Matrix6X& jacobian, const Wrench& wrench,
                       Eigen::Ref<Eigen::VectorXd> rows) const {
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
  const MatrixXd& H =
      multibody::mass_matrix(tree, y.segment(arm_->coordinates(), tree.coordinates()), workspace);
  dv.segment(arm_->velocities(), tree.velocities()) += numerics::solve_symmetric(H, force);
}

}  // namespace snare::coupling
