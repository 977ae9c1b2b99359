#include "reduction/snare_joint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::reduction {

namespace {

/// Moves one axis: returns spring and slider together.
double slide(const JointAxis& law, double& sliding, double from, double to) {
  sliding = std::clamp(sliding + law.stick_stiffness * (to - from), -law.friction, law.friction);
  return law.stiffness * to + sliding;
}

/// Spring by a straight line through the cycle, friction by its area, and the stick stiffness that fits best.
void fit(JointCycle& cycle) {
  const Eigen::Index a = cycle.axis;
  const auto begin = cycle.path.begin() + static_cast<std::ptrdiff_t>(cycle.cycle_begin);
  double uu = 0.0;
  double uf = 0.0;
  double f = 0.0;
  double ff = 0.0;
  double u_sum = 0.0;
  double n = 0.0;
  double amplitude = 0.0;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (auto p = begin + 1; p != cycle.path.end(); ++p) {
    const double u = p->displacement[a];
    const double force = p->force[a];
    uu += u * u;
    uf += u * force;
    ff += force * force;
    f += force;
    u_sum += u;
    n += 1.0;
    amplitude = std::max(amplitude, std::abs(u));
    low = std::min(low, force);
    high = std::max(high, force);
  }
  cycle.force_range = high - low;
  const double slope = (uf - u_sum * f / n) / (uu - u_sum * u_sum / n);
  cycle.linear_r2 = slope * slope * (uu - u_sum * u_sum / n) / (ff - f * f / n);
  double best = std::numeric_limits<double>::infinity();
  constexpr int shares = 71;  // up to 0.79
  double share = 1e-3;
  for (int k = 0; k < shares; ++k, share *= 1.1) {
    // loop = 4 f (a - f/q) with f/q = share * a.
    JointAxis trial;
    trial.friction = cycle.loop / (4.0 * amplitude * (1.0 - share));
    trial.stick_stiffness = trial.friction > 0.0 ? trial.friction / (share * amplitude) : 1.0;
    // The spring then follows linearly from what the slider leaves.
    double sliding = trial.friction;
    double now = amplitude;
    double su = 0.0;
    std::vector<double> sliders;
    for (auto p = begin + 1; p != cycle.path.end(); ++p) {
      sliders.push_back(
          slide({0.0, trial.friction, trial.stick_stiffness}, sliding, now, p->displacement[a]));
      now = p->displacement[a];
      su += now * (p->force[a] - sliders.back());
    }
    trial.stiffness = su / uu;
    double sum = 0.0;
    double largest = 0.0;
    for (std::size_t i = 0; i < sliders.size(); ++i) {
      const coupling::ShaftPoint& p = *(begin + 1 + static_cast<std::ptrdiff_t>(i));
      const double miss = trial.stiffness * p.displacement[a] + sliders[i] - p.force[a];
      sum += miss * miss;
      largest = std::max(largest, std::abs(miss));
    }
    if (sum >= best) continue;
    best = sum;
    cycle.fitted = trial;
    cycle.rms_error = std::sqrt(sum / n);
    cycle.largest_error = largest;
  }
}

}  // namespace

Eigen::Vector3d SnareJoint::move(JointState& state, const Eigen::Vector3d& displacement) const {
  Eigen::Vector3d force;
  for (Eigen::Index i = 0; i < 3; ++i) {
    force[i] =
        slide(axis[static_cast<std::size_t>(i)], state.sliding[i], state.displacement[i], displacement[i]);
  }
  state.displacement = displacement;
  return force;
}

JointCycle cycle_snare(const coupling::SnareSpecification& snare, int axis, double amplitude, int steps) {
  JointCycle cycle;
  cycle.axis = axis;
  std::vector<Eigen::Vector3d> way;
  const auto leg = [&](double from, double to, int count) {
    for (int i = 1; i <= count; ++i) {
      Eigen::Vector3d d = Eigen::Vector3d::Zero();
      d[axis] = from + (to - from) * i / count;
      way.push_back(d);
    }
  };
  leg(0.0, amplitude, (steps + 1) / 2);
  cycle.cycle_begin = way.size() - 1;
  leg(amplitude, -amplitude, steps);
  leg(-amplitude, amplitude, steps);
  coupling::ShaftPath path = coupling::move_shaft(snare, way);
  cycle.report = path.report;
  cycle.path = std::move(path.points);
  if (!cycle.report.usable()) return cycle;
  const std::size_t b = cycle.cycle_begin;
  for (std::size_t i = b + 1; i < cycle.path.size(); ++i) {
    const coupling::ShaftPoint& p = cycle.path[i];
    const coupling::ShaftPoint& q = cycle.path[i - 1];
    cycle.loop += 0.5 * (p.force + q.force).dot(p.displacement - q.displacement);
  }
  cycle.dissipated = cycle.path.back().dissipated - cycle.path[b].dissipated;
  // The way back meets the same displacements in reverse.
  for (int i = 0; i <= steps; ++i) {
    const auto down = static_cast<std::size_t>(i);
    const double gap = cycle.path[b + 2 * static_cast<std::size_t>(steps) - down].force[axis] -
                       cycle.path[b + down].force[axis];
    cycle.half_width = std::max(cycle.half_width, 0.5 * std::abs(gap));
  }
  fit(cycle);
  return cycle;
}

}  // namespace snare::reduction
