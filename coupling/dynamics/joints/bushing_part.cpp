#include "coupling/dynamics/joints/bushing_part.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using multibody::Wrench;
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
    slope =
        (-2.0 / (t * t * t) + cot / (2.0 * t * t) + 1.0 / (4.0 * t * std::sin(half) * std::sin(half))) / t;
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

  Relative(const std::vector<MovingFrame>& frames, const VectorView& y)
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
  Vector3d turn = Vector3d::Zero(), shift = Vector3d::Zero(), spin = Vector3d::Zero(),
           velocity = Vector3d::Zero();
};

}  // namespace

BushingPart::BushingPart(const MotionBushing& bushing, MovingFrame first, MovingFrame second)
    : FrameForces({std::move(first), std::move(second)}), bushing_(bushing) {}

BushingPart::State BushingPart::state(const VectorView& y) const {
  const Relative now(frames(), y);
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

std::vector<Wrench> BushingPart::wrenches(const VectorView& y) const {
  return work(y).wrenches;
}

FrameForces::Work BushingPart::work(const VectorView& y) const {
  const State s = state(y);
  return {{s.on_first, s.on_second}, {s.energy, s.lost_power}};
}

Eigen::MatrixXd BushingPart::derivatives(const VectorView& y) const {
  const Relative now(frames(), y);
  const MotionBushing& c = bushing_;
  const Matrix3d& R = now.a.X_WF.R;
  const State s = state(y);
  // Changes of both wrenches when both frames move.
  const auto change = [&](const FrameChange& a, const FrameChange& b) {
    const Vector3d dr = b.shift - a.shift;
    const Vector3d du = b.velocity - a.velocity - a.spin.cross(now.r) - now.a.angular.cross(dr);
    const Vector3d dd = R.transpose() * (dr - a.turn.cross(now.r));
    const Vector3d dd_rate = R.transpose() * (du - a.turn.cross(now.u));
    const Vector3d dphi = turn_rate(now.phi, R.transpose() * (b.turn - a.turn));
    const Vector3d dw = R.transpose() * (b.spin - a.spin - a.turn.cross(now.spin));
    const Vector3d force =
        a.turn.cross(s.on_second.force) -
        R * (c.translational_stiffness.cwiseProduct(dd) + c.translational_damping.cwiseProduct(dd_rate));
    const Vector3d moment =
        a.turn.cross(s.on_second.moment) - R * (turn_moment_change(now.phi, c.rotational_stiffness, dphi) +
                                                c.rotational_damping.cwiseProduct(dw));
    return std::array<Wrench, 2>{Wrench{-moment - dr.cross(s.on_second.force) - now.r.cross(force), -force},
                                 Wrench{moment, force}};
  };
  Eigen::MatrixXd D(2 * wrench_rows, 2 * motion_columns);
  const auto fill = [&D](Eigen::Index column, const std::array<Wrench, 2>& changes) {
    D.col(column) << changes[0].vector(), changes[1].vector();
  };
  for (Eigen::Index j = 0; j < motion_columns; ++j) {
    const Eigen::Matrix<double, motion_columns, 1> e = Eigen::Matrix<double, motion_columns, 1>::Unit(j);
    const FrameChange one{e.segment<3>(0), e.segment<3>(3), e.segment<3>(6), e.segment<3>(9)};
    fill(j, change(one, {}));
    fill(motion_columns + j, change({}, one));
  }
  return D;
}

}  // namespace snare::coupling
