#include "multibody/inverse_kinematics.hpp"

#include "base/index.hpp"
#include "multibody/kinematics.hpp"
#include "numerics/dense_solvers.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace snare::multibody {

using base::at;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr double arrived = 1e-11;  // [rad], [m over the arm's size]
constexpr double same = 1e-6;      // [rad, m]: solutions that differ by less are one

/// Moves joints of a tree until a frame is somewhere.
class Seeker {
 public:
  Seeker(const Tree& tree, int frame, const Pose& X_WF, const std::vector<ReachingJoint>& joints)
      : tree_(tree), frame_(frame), X_WF_(X_WF), joints_(joints), kinematics_(tree) {
    for (const TreeBody& body : tree.bodies()) size_ = std::max(size_, body.X_PJ.p.norm());
  }

  /// What is left: the turn from the frame to its target, and the way, over the arm's size.
  Vector6 error(const VectorXd& q) {
    place(tree_, q, kinematics_);
    const Pose X = frame_pose(tree_, kinematics_, frame_);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(X_WF_.R * X.R.transpose()));
    Vector6 e;
    e << turn.angle() * turn.axis(), (X_WF_.p - X.p) / size_;
    return e;
  }

  /// Levenberg and Marquardt's method: less damping behind a step that helps, more behind one that does not.
  bool seek(VectorXd& q) {
    Vector6 e = error(q);
    double damping = 1e-2;
    constexpr int most = 200;
    const auto n = static_cast<Index>(joints_.size());
    for (int k = 0; k < most && damping < 1e8; ++k) {
      if (e.cwiseAbs().maxCoeff() < arrived) return true;
      place(tree_, q, kinematics_);
      const Matrix6X all = frame_jacobian(tree_, kinematics_, frame_);
      Matrix6X J(6, n);
      for (Index j = 0; j < n; ++j)
        J.col(j) = all.col(tree_.body(joints_[at(static_cast<int>(j))].body).v_index);
      J.bottomRows<3>() /= size_;
      const Eigen::MatrixXd normal = J.transpose() * J + damping * damping * Eigen::MatrixXd::Identity(n, n);
      const VectorXd step = numerics::solve_symmetric(normal, J.transpose() * e);
      VectorXd next = q;
      // No joint turns by more than half a radian at once: the way there is that of the branch.
      const double largest = std::max(1.0, step.cwiseAbs().maxCoeff() / 0.5);
      for (Index j = 0; j < n; ++j) next[coordinate(j)] += step[j] / largest;
      const Vector6 left = error(next);
      if (left.norm() < e.norm()) {
        q = next;
        e = left;
        damping = std::max(1e-9, 0.2 * damping);
      } else {
        damping = 5.0 * damping;
      }
    }
    return e.cwiseAbs().maxCoeff() < 1e3 * arrived;
  }

  [[nodiscard]] Index coordinate(Index joint) const {
    return tree_.body(joints_[at(static_cast<int>(joint))].body).q_index;
  }
  [[nodiscard]] bool turns(Index joint) const {
    return tree_.body(joints_[at(static_cast<int>(joint))].body).joint == JointKind::revolute;
  }
  [[nodiscard]] double size() const { return size_; }

 private:
  const Tree& tree_;
  int frame_;
  Pose X_WF_;
  const std::vector<ReachingJoint>& joints_;
  Kinematics kinematics_;
  double size_ = 1e-3;  // longest way from a joint to the next [m]
};

/// The k-th of points that fill an interval evenly: van der Corput's sequence in a base.
double spread(int k, int base) {
  double value = 0.0, share = 1.0;
  for (int rest = k; rest > 0; rest /= base) {
    share /= base;
    value += share * (rest % base);
  }
  return value;
}

/// An angle by whole turns to where it is nearest to another within limits, or, where none is, to the limits.
double turned_near(double angle, double near, double lower, double upper) {
  double best = angle + two_pi * std::round((near - angle) / two_pi);
  double outside = std::max({0.0, lower - best, best - upper});
  for (const int turns : {-2, -1, 1, 2}) {
    const double other = angle + two_pi * (std::round((near - angle) / two_pi) + turns);
    const double beyond = std::max({0.0, lower - other, other - upper});
    if (beyond < outside || (beyond == outside && std::abs(other - near) < std::abs(best - near))) {
      best = other;
      outside = beyond;
    }
  }
  return best;
}

}  // namespace

Reach reach_pose(const Tree& tree, int frame, const Pose& X_WF, const VectorXd& posture,
                 const std::vector<ReachingJoint>& joints) {
  constexpr int tries = 400;
  constexpr std::array<int, 6> bases{2, 3, 5, 7, 11, 13};
  constexpr double slack = 1e-9;  // of limits [rad, m]
  Seeker seeker(tree, frame, X_WF, joints);
  const auto n = static_cast<Index>(joints.size());
  Reach reach;
  reach.q = posture;
  double nearest = std::numeric_limits<double>::infinity();
  double nearest_beyond = nearest, least_left = nearest;
  std::vector<VectorXd> known;
  for (int k = 0; k <= tries; ++k) {
    VectorXd q = posture;
    for (Index j = 0; j < n && k > 0; ++j) {
      const double half = seeker.turns(j) ? std::numbers::pi : 10.0;
      const ReachingJoint& joint = joints[at(static_cast<int>(j))];
      const double lower = std::isfinite(joint.lower) ? joint.lower : posture[seeker.coordinate(j)] - half;
      const double upper = std::isfinite(joint.upper) ? joint.upper : posture[seeker.coordinate(j)] + half;
      q[seeker.coordinate(j)] = lower + (upper - lower) * spread(k, bases[at(static_cast<int>(j) % 6)]);
    }
    const bool there = seeker.seek(q);
    double way = 0.0, farthest = 0.0;
    int beyond = -1;
    for (Index j = 0; j < n; ++j) {
      const ReachingJoint& joint = joints[at(static_cast<int>(j))];
      double& coordinate = q[seeker.coordinate(j)];
      const double before = posture[seeker.coordinate(j)];
      if (seeker.turns(j)) coordinate = turned_near(coordinate, before, joint.lower, joint.upper);
      way += (coordinate - before) * (coordinate - before);
      const double outside = std::max(joint.lower - coordinate, coordinate - joint.upper);
      if (outside > std::max(slack, farthest)) {
        farthest = outside;
        beyond = static_cast<int>(j);
      }
    }
    if (!there) {
      const Vector6 left = seeker.error(q);
      if (!reach.found() && reach.beyond < 0 && left.norm() < least_left) {
        least_left = left.norm();
        reach.q = q;
        reach.angle = left.head<3>().norm();
        reach.distance = left.tail<3>().norm() * seeker.size();
      }
      continue;
    }
    if (beyond >= 0) {
      if (!reach.found() && way < nearest_beyond) {
        nearest_beyond = way;
        reach.q = q;
        reach.beyond = beyond;
        reach.beyond_at = q[seeker.coordinate(beyond)];
        reach.distance = reach.angle = 0.0;
      }
      continue;
    }
    if (std::ranges::any_of(known,
                            [&](const VectorXd& other) { return (other - q).cwiseAbs().maxCoeff() < same; }))
      continue;
    known.push_back(q);
    if (way < nearest) {
      nearest = way;
      reach.q = q;
    }
    reach.solutions = static_cast<int>(known.size());
    reach.beyond = -1;
    reach.distance = reach.angle = 0.0;
  }
  return reach;
}

}  // namespace snare::multibody
