#pragma once

#include "coupling/contact/friction.hpp"
#include "coupling/dynamics/joints/frame_forces.hpp"
#include "multibody/spatial.hpp"

#include <ceres/jet.h>
#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace snare::coupling {

/// Laws between frames in numbers that carry their derivatives along, so that a law is written once: Ceres'
/// Jet.
template <int N>
using Dual = ceres::Jet<double, N>;
template <class S>
using Vector3 = Eigen::Matrix<S, 3, 1>;

/// Axes, origin, angular velocity and velocity of the origin of a frame, in the world.
template <class S>
struct FrameMotion {
  Eigen::Matrix<S, 3, 3> R;
  Vector3<S> p, angular, linear;

  /// Place in the world of a point fixed in the frame [m].
  [[nodiscard]] Vector3<S> point(const Eigen::Vector3d& p_FP) const { return p + R * p_FP.cast<S>(); }
  /// Velocity there of the frame's material [m/s].
  [[nodiscard]] Vector3<S> velocity_at(const Vector3<S>& p_WP) const {
    return linear + angular.cross(p_WP - p);
  }
};

/// Moment about the frame's origin and force on it.
template <class S>
struct FrameWrench {
  Vector3<S> moment = Vector3<S>::Zero(), force = Vector3<S>::Zero();

  /// Adds a force f [N] that acts on the frame at a point of the world [m].
  void add(const FrameMotion<S>& frame, const Vector3<S>& p_WP, const Vector3<S>& f) {
    force += f;
    moment += Vector3<S>(p_WP - frame.p).cross(f);
  }
};

/// The frames at unknowns y of the run (SI units).
template <std::size_t K>
[[nodiscard]] std::array<FrameMotion<double>, K> motions(const std::vector<MovingFrame>& frames,
                                                         const numerics::VectorView& y) {
  std::array<FrameMotion<double>, K> now;
  for (std::size_t k = 0; k < K; ++k) {
    const MovingFrame::State s = frames[k].state(y);
    now[k] = {s.X_WF.R, s.X_WF.p, s.angular, s.linear};
  }
  return now;
}

/// Variables of a law between K frames: what it needs to know of how they move. It sees places and velocities
/// relative to each other only, so that the last frame's shift and velocity follow from all others'; of the
/// first K - Turning it does not see how they turn.
template <std::size_t K, std::size_t Turning = K>
struct FrameVariables {
  enum Kind : int { turn, shift, spin, velocity };  ///< [rad], [m], [rad/s], [m/s]; three of each
  static constexpr int count = 12 * static_cast<int>(K) - 6 - 3 * static_cast<int>(K - Turning);

  /// Whether frame k has them as variables [-].
  [[nodiscard]] static constexpr bool has(std::size_t k, Kind kind) {
    return kind == turn ? k >= K - Turning : kind == spin || k + 1 < K;
  }
  /// Index of the first of three that there are.
  [[nodiscard]] static constexpr int first(std::size_t k, Kind kind) {
    int before = 0;
    for (std::size_t of = 0; of <= k; ++of) {
      for (const Kind other : {turn, shift, spin, velocity})
        if ((of < k || other < kind) && has(of, other)) before += 3;
    }
    return before;
  }
};

/// The frames' motions, in SI units, with these as variables, and room for `Inner` more behind them.
template <class Variables, int Inner = 0, std::size_t K>
[[nodiscard]] auto with_derivatives(const std::array<FrameMotion<double>, K>& now) {
  using S = Dual<Variables::count + Inner>;
  std::array<FrameMotion<S>, K> dual;
  for (std::size_t k = 0; k < K; ++k) {
    const auto variables = [&](const Eigen::Vector3d& value, typename Variables::Kind kind) {
      Vector3<S> v = value.cast<S>();
      for (int i = 0; Variables::has(k, kind) && i < 3; ++i)
        v[i] = S(value[i], Variables::first(k, kind) + i);
      return v;
    };
    dual[k].R = now[k].R.template cast<S>();
    if (Variables::has(k, Variables::turn)) {
      const Vector3<S> turn = variables(Eigen::Vector3d::Zero(), Variables::turn);
      for (int j = 0; j < 3; ++j) {
        const Vector3<S> axis = dual[k].R.col(j);
        dual[k].R.col(j) = axis + turn.cross(axis);
      }
    }
    dual[k].p = variables(now[k].p, Variables::shift);
    dual[k].angular = variables(now[k].angular, Variables::spin);
    dual[k].linear = variables(now[k].linear, Variables::velocity);
  }
  return dual;
}

/// Wrenches [N m, N] as a list, one a frame.
template <std::size_t K>
[[nodiscard]] std::vector<multibody::Wrench> plain(const std::array<FrameWrench<double>, K>& wrenches) {
  std::vector<multibody::Wrench> list;
  for (const FrameWrench<double>& w : wrenches) list.push_back({w.moment, w.force});
  return list;
}

/// Adds the derivatives of a vector by the frames' motions to three rows of D of FrameForces, in SI units.
template <class Variables, std::size_t K, class S>
void add_derivatives(const Vector3<S>& vector, Eigen::Index row, Eigen::MatrixXd& D) {
  constexpr auto last = static_cast<Eigen::Index>(K - 1);
  for (int i = 0; i < 3; ++i, ++row) {
    for (std::size_t k = 0; k < K; ++k) {
      for (const auto kind : {Variables::turn, Variables::shift, Variables::spin, Variables::velocity}) {
        if (!Variables::has(k, kind)) continue;
        const Eigen::RowVector3d by = vector[i].v.template segment<3>(Variables::first(k, kind)).transpose();
        D.block<1, 3>(row, 12 * static_cast<Eigen::Index>(k) + 3 * kind) += by;
        if (kind == Variables::shift || kind == Variables::velocity)
          D.block<1, 3>(row, 12 * last + 3 * kind) -= by;
      }
    }
  }
}

/// Adds the derivatives of all wrenches to the first rows of D, in SI units.
template <class Variables, class S, std::size_t K>
void add_derivatives(const std::array<FrameWrench<S>, K>& wrenches, Eigen::MatrixXd& D) {
  Eigen::Index row = 0;
  for (const FrameWrench<S>& w : wrenches) {
    for (const Vector3<S>* part : {&w.moment, &w.force}) {
      add_derivatives<Variables, K>(*part, row, D);
      row += 3;
    }
  }
}

/// Their derivatives: D of FrameForces, (6 K, 12 K), in SI units.
template <class Variables, class S, std::size_t K>
[[nodiscard]] Eigen::MatrixXd derivatives_of(const std::array<FrameWrench<S>, K>& wrenches) {
  Eigen::MatrixXd D =
      Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(K), 12 * static_cast<Eigen::Index>(K));
  add_derivatives<Variables>(wrenches, D);
  return D;
}

/// Power that the frames get [W].
template <std::size_t K>
[[nodiscard]] double power_of(const std::array<FrameWrench<double>, K>& wrenches,
                              const std::array<FrameMotion<double>, K>& frames) {
  double sum = 0.0;
  for (std::size_t k = 0; k < K; ++k)
    sum += wrenches[k].moment.dot(frames[k].angular) + wrenches[k].force.dot(frames[k].linear);
  return sum;
}

/// The number without its derivatives. In whatever unit it has.
[[nodiscard]] inline double value_of(double x) {
  return x;
}
template <int N>
[[nodiscard]] double value_of(const Dual<N>& x) {
  return x.a;
}

/// f(x, y) by its value and slopes there. In their units; by_x, by_y: df/dx, df/dy.
[[nodiscard]] inline double lifted(double value, double /*by_x*/, double /*x*/, double /*by_y*/,
                                   double /*y*/) {
  return value;
}
template <int N>
[[nodiscard]] Dual<N> lifted(double value, double by_x, const Dual<N>& x, double by_y, const Dual<N>& y) {
  return Dual<N>(value, by_x * x.v + by_y * y.v);
}

/// The numbers of a vector without their derivatives. In whatever unit they have.
template <class S>
[[nodiscard]] Eigen::Vector3d values_of(const Vector3<S>& x) {
  return {value_of(x[0]), value_of(x[1]), value_of(x[2])};
}

/// What friction between bodies depends on, in numbers with derivatives or without.
template <class S>
struct BristleInputs {
  Vector3<S> bristle, sliding;            ///< z [m], w [m/s]
  S normal{}, elastic{}, elastic_rate{};  ///< p, p_e [N], dp_e/dt [N/s]

  /// The numbers alone, in SI units.
  [[nodiscard]] BristleStateIn<3> state() const {
    return {values_of(bristle), values_of(sliding), value_of(normal), value_of(elastic)};
  }
};

/// A vector that depends on them, in SI units, by its value and by `change`, which returns its change by
/// those of the inputs.
template <class Change>
[[nodiscard]] Eigen::Vector3d lifted(const Eigen::Vector3d& value, const BristleInputs<double>& /*in*/,
                                     const Change& /*change*/) {
  return value;
}
/// The same with derivatives, in SI units.
template <int N, class Change>
[[nodiscard]] Vector3<Dual<N>> lifted(const Eigen::Vector3d& value, const BristleInputs<Dual<N>>& in,
                                      const Change& change) {
  Vector3<Dual<N>> f = value.cast<Dual<N>>();
  for (int k = 0; k < N; ++k) {
    const auto slopes = [k](const Vector3<Dual<N>>& x) {
      return Eigen::Vector3d(x[0].v[k], x[1].v[k], x[2].v[k]);
    };
    const Eigen::Vector3d by = change(BristleChangeIn<3>{
        slopes(in.bristle), slopes(in.sliding), in.normal.v[k], in.elastic.v[k], in.elastic_rate.v[k]});
    for (int i = 0; i < 3; ++i) f[i].v[k] = by[i];
  }
  return f;
}

/// Smooth friction [N] of what slides with w [m/s] across a unit normal under a normal force [N]: against w.
///                                                                                            theory.md (M.9)
template <class S>
[[nodiscard]] Vector3<S> smooth_friction(const MotionFriction& friction, const Vector3<S>& w,
                                         const S& normal) {
  const BristleInputs<S> in{Vector3<S>::Zero(), w, normal, S(0.0), S(0.0)};
  const TangentForceIn<3> f = tangent_force(friction, in.state());
  return -lifted(f.force, in, [&f](const BristleChangeIn<3>& by) { return force_change(f, by); });
}

}  // namespace snare::coupling
