#include "validation/elastica_shooting.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace snare::validation::shooting {

using numerics::SolveReport;
using numerics::Termination;

namespace {
using std::numbers::pi;
constexpr int kMostIterations = 30;
constexpr double kLargestMove = 0.3;  // [rad] or lengths L
}  // namespace

double Shooting::critical() const {
  return ends_ == ElasticaEnds::clamped ? 4.0 * pi * pi : pi * pi;
}

System Shooting::assemble(const VectorXd& z, bool wrapped, const Demand& demand) const {
  const Index n = size(wrapped);
  System sys{VectorXd::Zero(n), MatrixXd::Zero(n, n)};
  VectorXd& r = sys.residual;
  MatrixXd& J = sys.jacobian;
  Index row = 0;
  const auto linear = [&](Index column, double value) {
    r[row] = z[column] - value;
    J(row++, column) = 1.0;
  };

  // Left mount: x = 0, y = 0, and angle or moment zero.
  const Index fixed = ends_ == ElasticaEnds::clamped ? 2 : 3;
  linear(0, 0.0);
  linear(1, 0.0);
  linear(fixed, 0.0);

  // Pieces. The end of the last one on either side is kept with its derivative.
  ElasticaSection last{};
  MatrixXd d_last(4, n);
  for (Index piece = 0; piece < 2 * pieces_; ++piece) {
    const bool left = piece < pieces_;
    const Index at_force = left ? left_force() : right_force();
    const double length = (left ? z[begin()] : 1.0 - z[end(wrapped)]) / pieces_;
    const ElasticaFlow flow = elastica_flow(law_, section(z, piece), force(z, at_force), length);
    d_last.setZero();
    d_last(0, 4 * piece) = 1.0;
    d_last(1, 4 * piece + 1) = 1.0;
    const double rate[4] = {flow.rate.x, flow.rate.y, flow.rate.angle, flow.rate.moment};
    for (Index i = 0; i < 4; ++i) {
      const auto& s = flow.sensitivity[static_cast<std::size_t>(i)];
      d_last(i, 4 * piece + 2) += s[0];
      d_last(i, 4 * piece + 3) += s[1];
      d_last(i, at_force) += s[2];
      d_last(i, at_force + 1) += s[3];
      d_last(i, left ? begin() : end(wrapped)) += (left ? 1.0 : -1.0) * rate[i] / pieces_;
    }
    last = flow.end;
    const double end_value[4] = {last.x, last.y, last.angle, last.moment};
    const bool meets_next = piece != 2 * pieces_ - 1 && !(wrapped && piece == pieces_ - 1);
    if (meets_next) {
      for (Index i = 0; i < 4; ++i, ++row) {
        r[row] = z[4 * (piece + 1) + i] - end_value[i];
        J.row(row) = -d_last.row(i);
        J(row, 4 * (piece + 1) + i) += 1.0;
      }
    } else if (piece == 2 * pieces_ - 1) {
      // Right mount.
      const double wanted[3] = {span_, 0.0, 0.0};
      const Index which[3] = {0, 1, fixed};
      for (int i = 0; i < 3; ++i, ++row) {
        r[row] = end_value[which[i]] - wanted[i];
        J.row(row) = d_last.row(which[i]);
      }
    } else {
      // Wrapped, end of the left side: r = c + sigma R nu, curvature of the cylinder.
      const auto [tension, shear] = section_forces(force(z, at_force), last.angle);
      const double c = std::cos(last.angle);
      const double s = std::sin(last.angle);
      r[row] = last.x + sigma_ * radius_ * s - position_;
      J.row(row++) = d_last.row(0) + sigma_ * radius_ * c * d_last.row(2);
      r[row] = last.y - sigma_ * radius_ * c - z[height(true)];
      J.row(row) = d_last.row(1) + sigma_ * radius_ * s * d_last.row(2);
      J(row++, height(true)) -= 1.0;
      Eigen::RowVectorXd d_tension = shear * d_last.row(2);
      d_tension[at_force] += c;
      d_tension[at_force + 1] += s;
      const double e = law_.compliance * tension;
      r[row] = last.moment + law_.natural_curvature + sigma_ * (1.0 + e) / radius_;
      J.row(row++) = d_last.row(3) + sigma_ * law_.compliance / radius_ * d_tension;
      // Tension and arc length, completed by the start of the right side.
      const ElasticaSection p = section(z, pieces_);
      const auto right = section_forces(force(z, right_force()), p.angle);
      r[row] = tension - right.tension;
      J.row(row) = d_tension;
      J(row, 4 * pieces_ + 2) -= right.shear;
      J(row, right_force()) -= std::cos(p.angle);
      J(row++, right_force() + 1) -= std::sin(p.angle);
      const double arc = z[end(true)] - z[begin()];
      r[row] = (1.0 + e) * arc + sigma_ * radius_ * (p.angle - last.angle);
      J.row(row) = law_.compliance * arc * d_tension - sigma_ * radius_ * d_last.row(2);
      J(row, 4 * pieces_ + 2) += sigma_ * radius_;
      J(row, end(true)) += 1.0 + e;
      J(row++, begin()) -= 1.0 + e;
    }
  }

  // Contact at the start of the right side.
  const ElasticaSection p = section(z, pieces_);
  const Index at = 4 * pieces_;
  const double c = std::cos(p.angle);
  const double s = std::sin(p.angle);
  const double fx = z[left_force()] - z[right_force()];
  const double fy = z[left_force() + 1] - z[right_force() + 1];
  const auto force_row = [&](double along_x, double along_y) {
    r[row] = along_x * fx + along_y * fy;
    J(row, left_force()) += along_x;
    J(row, right_force()) -= along_x;
    J(row, left_force() + 1) += along_y;
    J(row, right_force() + 1) -= along_y;
  };
  if (contact_ == ElasticaContact::material_point) {
    linear(begin(), material_);
  } else {
    r[row] = p.x + sigma_ * radius_ * s - position_;
    J(row, at) = 1.0;
    J(row++, at + 2) = sigma_ * radius_ * c;
  }
  const double reach = contact_ == ElasticaContact::material_point ? 0.0 : sigma_ * radius_;
  r[row] = p.y - reach * c - z[height(wrapped)];
  J(row, at + 1) = 1.0;
  J(row, at + 2) = reach * s;
  J(row++, height(wrapped)) = -1.0;
  if (wrapped) {
    const auto [tension, shear] = section_forces(force(z, right_force()), p.angle);
    r[row] = p.moment + law_.natural_curvature + sigma_ * (1.0 + law_.compliance * tension) / radius_;
    const double factor = sigma_ * law_.compliance / radius_;
    J(row, at + 3) = 1.0;
    J(row, at + 2) = factor * shear;
    J(row, right_force()) = factor * c;
    J(row++, right_force() + 1) = factor * s;
  } else if (demand.control == Control::no_force || contact_ == ElasticaContact::material_point) {
    force_row(1.0, 0.0);
    ++row;
  } else if (contact_ == ElasticaContact::sticking) {
    linear(begin(), material_);
  } else {
    // f . t - slope sigma f . nu = 0 with nu = (-s, c).
    const double k = slope_ * sigma_;
    force_row(c + k * s, s - k * c);
    J(row++, at + 2) = fx * (-s + k * c) + fy * (c + k * s);
  }

  switch (demand.control) {
    case Control::no_force:
      force_row(0.0, 1.0);
      break;
    case Control::height:
      r[row] = z[height(wrapped)] - demand.height;
      J(row, height(wrapped)) = 1.0;
      break;
    case Control::arc_length:
      r[row] = demand.direction.dot(z - demand.origin) - demand.step;
      J.row(row) = demand.direction.transpose();
      break;
  }
  return sys;
}

// Newton with halving on the residual. Ends one quadratic step after the update is below 1e-8, which is
// then at rounding.
SolveReport Shooting::solve(VectorXd& z, bool wrapped, const Demand& demand) const {
  SolveReport report;
  System sys = assemble(z, wrapped, demand);
  VectorXd trial = z;
  bool near = false;
  for (report.iterations = 0; report.iterations < kMostIterations; ++report.iterations) {
    report.residual_norm = sys.residual.lpNorm<Eigen::Infinity>();
    const VectorXd step = sys.jacobian.partialPivLu().solve(-sys.residual);
    if (!step.allFinite()) {
      report.termination = Termination::not_finite;
      report.message = "the shooting Jacobian is singular";
      return report;
    }
    VectorXd scale = z.cwiseAbs().cwiseMax(1.0);
    // Rounding of the ends' distance moves the force by 1e-16/eps: not to be asked for more.
    if (law_.compliance > 0.0) {
      auto forces = scale.segment(left_force(), 4);
      forces = forces.cwiseMax(1e-6 / law_.compliance).eval();
    }
    const double relative = step.cwiseAbs().cwiseQuotient(scale).maxCoeff();
    // No section may turn or move by more than this in one step; forces may change at will.
    double largest_move = 0.0;
    for (Index i = 0; i < 8 * pieces_; ++i) {
      if (i % 4 != 3) largest_move = std::max(largest_move, std::abs(step[i]));
    }
    double fraction = std::min(1.0, kLargestMove / largest_move);
    for (int halvings = 0;; ++halvings) {
      trial = z + fraction * step;
      const double arc_begin = trial[begin()];
      const double arc_end = trial[end(wrapped)];
      if (arc_begin > 0.0 && arc_end < 1.0) {
        sys = assemble(trial, wrapped, demand);
        if (near ||
            sys.residual.norm() < (1.0 - 0.1 * fraction) * report.residual_norm * std::sqrt(z.size()) ||
            relative < 1e-8) {
          break;
        }
      }
      fraction *= 0.5;
      if (halvings == 12) {
        report.termination = Termination::step_too_small;
        report.message = "Newton's direction did not reduce the residual";
        return report;
      }
    }
    z = trial;
    if (near) {
      report.residual_norm = sys.residual.lpNorm<Eigen::Infinity>();
      return report;
    }
    near = relative < 1e-8;
  }
  report.termination = Termination::iteration_limit;
  report.message = "Newton did not converge";
  return report;
}

bool Shooting::determinant_positive(const VectorXd& z, bool wrapped, double height) const {
  const Demand demand{Control::height, height, {}, {}, 0.0};
  const auto lu = assemble(z, wrapped, demand).jacobian.partialPivLu();
  int negative = 0;
  for (Index i = 0; i < z.size(); ++i) negative += lu.matrixLU()(i, i) < 0.0 ? 1 : 0;
  const bool even = negative % 2 == 0;
  return (lu.permutationP().determinant() > 0) == even;
}

// Shallow first mode: w = A/2 (1 - cos 2 pi x/l) clamped, A sin(pi x/l) pinned; both have the end
// shortening A^2 pi^2/(4 l).
VectorXd Shooting::buckled_guess(double excess) const {
  VectorXd z = VectorXd::Zero(size(false));
  const double amplitude = 2.0 / pi * std::sqrt(excess * span_);
  const double contact = first_position() / span_;
  const bool clamped = ends_ == ElasticaEnds::clamped;
  for (Index i = 0; i < 2 * pieces_; ++i) {
    const double part = static_cast<double>(i % pieces_) / pieces_;
    const double arc = i < pieces_ ? contact * part : contact + (1.0 - contact) * part;
    const double phase = (clamped ? 2.0 : 1.0) * pi * arc;
    const double rate = phase == 0.0 ? (clamped ? 2.0 : 1.0) * pi / span_ : phase / arc / span_;
    const double half = clamped ? 0.5 * amplitude : amplitude;
    z[4 * i] = arc * span_;
    z[4 * i + 1] = clamped ? half * (1.0 - std::cos(phase)) : half * std::sin(phase);
    z[4 * i + 2] = std::atan(half * rate * (clamped ? std::sin(phase) : std::cos(phase)));
    z[4 * i + 3] = half * rate * rate * (clamped ? std::cos(phase) : -std::sin(phase));
    if (clamped) z[4 * i + 3] -= law_.natural_curvature;
  }
  z[left_force()] = z[right_force()] = -critical();
  z[begin()] = contact;
  z[height(false)] = z[4 * pieces_ + 1] - sigma_ * radius_;
  return z;
}

VectorXd Shooting::straight_guess() const {
  VectorXd z = buckled_guess(0.0);
  z[left_force()] = z[right_force()] = (span_ - 1.0) / law_.compliance;
  return z;
}

// Unloaded shape with the pusher just touching it.
SolveReport Shooting::start(VectorXd& z) {
  const double excess = 1.0 - span_ - critical() * law_.compliance;
  const Demand demand;
  SolveReport report;
  if (excess <= 0.0) {
    z = straight_guess();
    report = solve(z, false, demand);
  } else {
    z = buckled_guess(excess);
    report = solve(z, false, demand);
    // Too slack for one step, or a natural curvature between pins: bring the ends together gradually.
    if (!report.usable() || z[4 * pieces_ + 1] <= 0.0) {
      const double full_span = span_;
      const double full_curvature = law_.natural_curvature;
      const double position = position_;
      double done = std::min(0.5, 1e-2 / excess);
      double step = done;
      double part = 0.0;
      VectorXd reached;
      while (part < 1.0 && step > 1e-6) {
        const double next = std::min(1.0, part + step);
        span_ = 1.0 - critical() * law_.compliance - next * excess;
        position_ = position * span_ / full_span;
        if (ends_ == ElasticaEnds::pinned) law_.natural_curvature = next * full_curvature;
        VectorXd trial = reached.size() == 0 ? buckled_guess(next * excess) : reached;
        report = solve(trial, false, demand);
        if (report.usable()) {
          reached = trial;
          part = next;
          step *= 1.5;
        } else {
          step *= 0.5;
        }
      }
      span_ = full_span;
      position_ = position;
      law_.natural_curvature = full_curvature;
      if (part == 1.0) z = reached;
    }
  }
  if (report.usable() && contact_ == ElasticaContact::sticking) material_ = z[begin()];
  return report;
}

}  // namespace snare::validation::shooting
