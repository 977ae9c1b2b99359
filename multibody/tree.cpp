#include "multibody/tree.hpp"

#include <cassert>
#include <cmath>
#include <stdexcept>

namespace snare::multibody {

namespace {

/// R of the quaternion w, x, y, z over its norm.
Eigen::Matrix3d rotation(const Eigen::VectorXd& q, int first) {
  return Eigen::Quaterniond(q[first], q[first + 1], q[first + 2], q[first + 3])
      .normalized()
      .toRotationMatrix();
}

/// Rodrigues' formula about a unit axis.
Eigen::Matrix3d rotation(const Eigen::Vector3d& a, double angle) {
  const double s = std::sin(angle), c = std::cos(angle), d = 1.0 - c;
  Eigen::Matrix3d R;
  R << c + d * a.x() * a.x(), d * a.x() * a.y() - s * a.z(), d * a.x() * a.z() + s * a.y(),
      d * a.x() * a.y() + s * a.z(), c + d * a.y() * a.y(), d * a.y() * a.z() - s * a.x(),
      d * a.x() * a.z() - s * a.y(), d * a.y() * a.z() + s * a.x(), c + d * a.z() * a.z();
  return R;
}

}  // namespace

Tree::Tree() {
  frames_.push_back({"world", -1, {}});
}

int Tree::add_moving(int frame, const std::string& name, JointKind joint, const Eigen::Vector3d& axis,
                     const Pose& X_FJ, const SpatialInertia& inertia) {
  if (find_frame(name) >= 0) throw std::invalid_argument("the name " + name + " is taken");
  TreeBody body;
  body.name = name;
  body.joint = joint;
  if (joint != JointKind::free) {
    if (!(axis.norm() > 0.0)) throw std::invalid_argument("the joint of " + name + " has no axis");
    body.axis = axis.normalized();
  }
  const TreeFrame& base = this->frame(frame);
  body.parent = base.body;
  body.X_PJ = base.X_BF * X_FJ;
  body.inertia = inertia;
  body.q_index = coordinates_;
  body.v_index = velocities_;
  coordinates_ += body.coordinates();
  velocities_ += body.velocities();
  frames_.push_back({name, size(), {}});
  bodies_.push_back(body);
  return static_cast<int>(frames_.size()) - 1;
}

int Tree::add_fixed(int frame, const std::string& name, const Pose& X_FB, const SpatialInertia& inertia) {
  if (find_frame(name) >= 0) throw std::invalid_argument("the name " + name + " is taken");
  const TreeFrame& base = this->frame(frame);
  const Pose X_PB = base.X_BF * X_FB;
  const int body = base.body;
  if (body >= 0) bodies_[static_cast<std::size_t>(body)].inertia += inertia.to_outer(X_PB);
  frames_.push_back({name, body, X_PB});
  return static_cast<int>(frames_.size()) - 1;
}

void Tree::move(const Pose& X_VW) {
  for (TreeBody& body : bodies_) {
    if (body.parent < 0) body.X_PJ = X_VW * body.X_PJ;
  }
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    if (frames_[i].body < 0) frames_[i].X_BF = X_VW * frames_[i].X_BF;
  }
}

int Tree::find_frame(std::string_view name) const {
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (frames_[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

double Tree::mass() const {
  double sum = 0.0;
  for (const TreeBody& body : bodies_) sum += body.inertia.mass;
  return sum;
}

TreeState zero_state(const Tree& tree) {
  TreeState state{Eigen::VectorXd::Zero(tree.coordinates()), Eigen::VectorXd::Zero(tree.velocities())};
  for (const TreeBody& body : tree.bodies()) {
    if (body.joint == JointKind::free) state.q[body.q_index + 3] = 1.0;
  }
  return state;
}

Pose joint_pose(const TreeBody& body, const Eigen::VectorXd& q) {
  const int i = body.q_index;
  switch (body.joint) {
    case JointKind::revolute:
      return {rotation(body.axis, q[i]), Eigen::Vector3d::Zero()};
    case JointKind::prismatic:
      return {Eigen::Matrix3d::Identity(), q[i] * body.axis};
    case JointKind::free:
      return {rotation(q, i + 3), q.segment<3>(i)};
  }
  return {};
}

Eigen::Matrix<double, 7, 1> free_coordinate_rate(const TreeBody& body, const Eigen::VectorXd& q,
                                                 const Eigen::VectorXd& v) {
  const int i = body.q_index, k = body.v_index;
  const double w = q[i + 3];
  const Eigen::Vector3d u = q.segment<3>(i + 4), omega = v.segment<3>(k);
  Eigen::Matrix<double, 7, 1> rate;
  rate.head<3>() = rotation(q, i + 3) * v.segment<3>(k + 3);
  rate[3] = -0.5 * u.dot(omega);
  rate.tail<3>() = 0.5 * (w * omega + u.cross(omega));
  return rate;
}

}  // namespace snare::multibody
