#include "coupling/dynamics/bushing_part.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using multibody::Matrix6X;
using multibody::Wrench;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

/// J^-1(phi) = I - [phi]/2 + c [phi]^2, c = 1/t^2 - cot(t/2)/(2 t), t = |phi|.
struct TurnRate {
  double c, slope;  // c'/t

  explicit TurnRate(const Vector3d& phi) {
    const double t = phi.norm();
    if (t < 1e-3) {  // its series: the next terms are below 1e-14
      c = 1.0 / 12.0 + t * t / 720.0;
      slope = 1.0 / 360.0;
      return;
    }
    const double half = 0.5 * t, cot = std::cos(half) / std::sin(half);
    c = 1.0 / (t * t) - cot / (2.0 * t);
    slope = (-2.0 / (t * t * t) + cot / (2.0 * t * t) + 1.0 / (4.0 * t * std::sin(half) * std::sin(half))) / t;
  }
};

/// J^-1(phi) w.
Vector3d turn_rate(const Vector3d& phi, const Vector3d& w) {
  return w - 0.5 * phi.cross(w) + TurnRate(phi).c * phi.cross(phi.cross(w));
}

/// J^-T(phi) m, m = K phi.
Vector3d turn_moment(const Vector3d& phi, const Vector3d& m) {
  return m + 0.5 * phi.cross(m) + TurnRate(phi).c * phi.cross(phi.cross(m));
}

/// Its change by dphi.
Vector3d turn_moment_change(const Vector3d& phi, const Vector3d& stiffness, const Vector3d& dphi) {
  const TurnRate r(phi);
  const Vector3d m = stiffness.cwiseProduct(phi), dm = stiffness.cwiseProduct(dphi), phi_m = phi.cross(m);
  return dm + 0.5 * (dphi.cross(m) + phi.cross(dm)) + r.slope * phi.dot(dphi) * phi.cross(phi_m) +
         r.c * (dphi.cross(phi_m) + phi.cross(dphi.cross(m)) + phi.cross(phi.cross(dm)));
}

Vector3d rotation_vector(const Matrix3d& R) {
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(R).normalized());
  return turn.angle() * turn.axis();
}

/// Places and motions of both frames, and what follows from them in the axes of the first.
struct Relative {
  MovingFrame::State a, b;
  Vector3d r, u, spin;         // p_B - p_A, v_B - v_A - w_A x r, w_B - w_A
  Vector3d d, d_rate, phi, w;  // in A

  Relative(const std::array<MovingFrame, 2>& frames, const VectorView& y)
      : a(frames[0].state(y)),
        b(frames[1].state(y)),
        r(b.X_WF.p - a.X_WF.p),
        u(b.linear - a.linear - a.angular.cross(r)),
        spin(b.angular - a.angular),
        d(a.X_WF.R.transpose() * r),
        d_rate(a.X_WF.R.transpose() * u),
        phi(rotation_vector(a.X_WF.R.transpose() * b.X_WF.R)),
        w(a.X_WF.R.transpose() * spin) {}
};

/// A change of a frame's place and motion, in the world.
struct FrameChange {
  Vector3d turn = Vector3d::Zero(), shift = Vector3d::Zero(), spin = Vector3d::Zero(), velocity = Vector3d::Zero();
};

}  // namespace

BushingPart::BushingPart(const MotionBushing& bushing, MovingFrame first, MovingFrame second)
    : bushing_(bushing), frames_{std::move(first), std::move(second)} {}

BushingPart::State BushingPart::state(const VectorView& y) const {
  const Relative now(frames_, y);
  const MotionBushing& c = bushing_;
  State s;
  s.shift = now.d;
  s.turn = now.phi;
  const Vector3d elastic = c.translational_stiffness.cwiseProduct(now.d);
  const Vector3d viscous = c.translational_damping.cwiseProduct(now.d_rate);
  const Vector3d bent = c.rotational_stiffness.cwiseProduct(now.phi);
  const Vector3d twisted = c.rotational_damping.cwiseProduct(now.w);
  s.on_second = {-now.a.X_WF.R * (turn_moment(now.phi, bent) + twisted), -now.a.X_WF.R * (elastic + viscous)};
  s.on_first = {-s.on_second.moment - now.r.cross(s.on_second.force), -s.on_second.force};
  s.energy = 0.5 * (elastic.dot(now.d) + bent.dot(now.phi));
  s.lost_power = viscous.dot(now.d_rate) + twisted.dot(now.w);
  return s;
}

void BushingPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  for (const MovingFrame& carrier : frames_) {
    if (!carrier.moves_freely()) continue;
    for (const int row : carrier.velocities()) {
      for (const MovingFrame& other : frames_) {
        for (const int column : other.coordinates()) entries.emplace_back(row, column);
        for (const int column : other.velocities()) entries.emplace_back(row, column);
      }
    }
  }
}

void BushingPart::residual(const DaePoint& at, Eigen::Ref<VectorXd> rows) {
  const State s = state(at.y);
  const std::array<Wrench, 2> wrenches{s.on_first, s.on_second};
  for (std::size_t k = 0; k < 2; ++k) {
    if (frames_[k].moves_freely()) frames_[k].push(frames_[k].jacobian(at.y), wrenches[k], rows);
  }
}

void BushingPart::jacobian(const DaePoint& at, double /*c*/, std::vector<double>& values) {
  const numerics::PatternValues into(*pattern_, values);
  const Relative now(frames_, at.y);
  const MotionBushing& c = bushing_;
  const Matrix3d& R = now.a.X_WF.R;
  const State s = state(at.y);
  const std::array<Wrench, 2> wrenches{s.on_first, s.on_second};
  const std::array<MovingFrame::Derivatives, 2> d{frames_[0].differentiate(at.y), frames_[1].differentiate(at.y)};
  // Changes of both wrenches when both frames move.
  const auto change = [&](const FrameChange& a, const FrameChange& b) {
    const Vector3d dr = b.shift - a.shift;
    const Vector3d du = b.velocity - a.velocity - a.spin.cross(now.r) - now.a.angular.cross(dr);
    const Vector3d dd = R.transpose() * (dr - a.turn.cross(now.r));
    const Vector3d dd_rate = R.transpose() * (du - a.turn.cross(now.u));
    const Vector3d dphi = turn_rate(now.phi, R.transpose() * (b.turn - a.turn));
    const Vector3d dw = R.transpose() * (b.spin - a.spin - a.turn.cross(now.spin));
    const Vector3d force = a.turn.cross(s.on_second.force) - R * (c.translational_stiffness.cwiseProduct(dd) +
                                                                  c.translational_damping.cwiseProduct(dd_rate));
    const Vector3d moment =
        a.turn.cross(s.on_second.moment) -
        R * (turn_moment_change(now.phi, c.rotational_stiffness, dphi) + c.rotational_damping.cwiseProduct(dw));
    return std::array<Wrench, 2>{Wrench{-moment - dr.cross(s.on_second.force) - now.r.cross(force), -force},
                                 Wrench{moment, force}};
  };
  const auto add = [&](int column, const std::array<Wrench, 2>& changes) {
    for (std::size_t k = 0; k < 2; ++k) {
      if (!frames_[k].moves_freely()) continue;
      const VectorXd by = d[k].jacobian.transpose() * changes[k].vector();
      const std::vector<int> rows = frames_[k].velocities();
      for (std::size_t i = 0; i < rows.size(); ++i) into.add(rows[i], column, -by[static_cast<Eigen::Index>(i)]);
    }
  };
  for (std::size_t k = 0; k < 2; ++k) {
    const auto of_frame = [&](const FrameChange& one) { return k == 0 ? change(one, {}) : change({}, one); };
    const std::vector<int> q = frames_[k].coordinates(), v = frames_[k].velocities();
    for (std::size_t j = 0; j < q.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      add(q[j], of_frame({d[k].place.col(column).head<3>(), d[k].place.col(column).tail<3>(),
                          d[k].motion.col(column).head<3>(), d[k].motion.col(column).tail<3>()}));
    }
    for (std::size_t j = 0; j < v.size() && d[k].jacobian.cols() > 0; ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      add(v[j], of_frame({Vector3d::Zero(), Vector3d::Zero(), d[k].jacobian.col(column).head<3>(),
                          d[k].jacobian.col(column).tail<3>()}));
    }
    // The Jacobian of the carrier turns with it.
    if (!frames_[k].moves_freely()) continue;
    const Eigen::MatrixXd turned = d[k].force(wrenches[k]);
    for (std::size_t i = 0; i < v.size(); ++i) {
      for (std::size_t j = 0; j < q.size(); ++j)
        into.add(v[i], q[j], -turned(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
    }
  }
}

}  // namespace snare::coupling
