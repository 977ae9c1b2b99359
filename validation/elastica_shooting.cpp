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

PieceEnd Shooting::end_of(const VectorXd& z, Index piece, bool wrapped) const {
  const bool left = piece < pieces_;
  const Index at_force = left ? left_force() : right_force();
  const double length = (left ? z[begin()] : 1.0 - z[end(wrapped)]) / pieces_;
  const ElasticaFlow flow = elastica_flow(law_, section(z, piece), force(z, at_force), length);
  PieceEnd result{flow.end, MatrixXd::Zero(4, size(wrapped))};
  result.by(0, 4 * piece) = 1.0;
  result.by(1, 4 * piece + 1) = 1.0;
  const double rate[4] = {flow.rate.x, flow.rate.y, flow.rate.angle, flow.rate.moment};
  for (Index i = 0; i < 4; ++i) {
    const auto& s = flow.sensitivity[static_cast<std::size_t>(i)];
    result.by(i, 4 * piece + 2) += s[0];
    result.by(i, 4 * piece + 3) += s[1];
    result.by(i, at_force) += s[2];
    result.by(i, at_force + 1) += s[3];
    result.by(i, left ? begin() : end(wrapped)) += (left ? 1.0 : -1.0) * rate[i] / pieces_;
  }
  return result;
}

void Shooting::add_piece_end(const VectorXd& z, Index piece, bool wrapped, System& sys) const {
  const PieceEnd last = end_of(z, piece, wrapped);
  if (wrapped && piece == pieces_ - 1) {
    add_lift_off(z, last, sys);
    return;
  }
  if (piece == 2 * pieces_ - 1) {
    add_right_mount(z, last, sys);
    return;
  }
  const double value[4] = {last.section.x, last.section.y, last.section.angle, last.section.moment};
  for (Index i = 0; i < 4; ++i, ++sys.row) {
    sys.residual[sys.row] = z[4 * (piece + 1) + i] - value[i];
    sys.jacobian.row(sys.row) = -last.by.row(i);
    sys.jacobian(sys.row, 4 * (piece + 1) + i) += 1.0;
  }
}

void Shooting::add_left_mount(const VectorXd& z, System& sys) const {
  sys.residual[sys.row] = z[0] - mount_axial_ * z[left_force()];
  sys.jacobian(sys.row, 0) = 1.0;
  sys.jacobian(sys.row++, left_force()) = -mount_axial_;
  sys.hold(z, 1, 0.0);
  if (ends_ == ElasticaEnds::pinned) {
    sys.hold(z, 3, 0.0);
    return;
  }
  sys.residual[sys.row] = z[2] - mount_rotational_ * z[3];
  sys.jacobian(sys.row, 2) = 1.0;
  sys.jacobian(sys.row++, 3) = -mount_rotational_;
}

void Shooting::add_right_mount(const VectorXd& z, const PieceEnd& end, System& sys) const {
  sys.residual[sys.row] = end.section.x + mount_axial_ * z[right_force()] - span_;
  sys.jacobian.row(sys.row) = end.by.row(0);
  sys.jacobian(sys.row++, right_force()) += mount_axial_;
  sys.residual[sys.row] = end.section.y;
  sys.jacobian.row(sys.row++) = end.by.row(1);
  if (ends_ == ElasticaEnds::pinned) {
    sys.residual[sys.row] = end.section.moment;
    sys.jacobian.row(sys.row++) = end.by.row(3);
    return;
  }
  sys.residual[sys.row] = end.section.angle + mount_rotational_ * end.section.moment;
  sys.jacobian.row(sys.row++) = end.by.row(2) + mount_rotational_ * end.by.row(3);
}

// Wrapped, end of the left side: r = c + sigma R nu, curvature of the cylinder. Tension and arc length,
// completed by the start of the right side.
void Shooting::add_lift_off(const VectorXd& z, const PieceEnd& end_left, System& sys) const {
  VectorXd& r = sys.residual;
  MatrixXd& J = sys.jacobian;
  Index& row = sys.row;
  const ElasticaSection& last = end_left.section;
  const MatrixXd& d_last = end_left.by;
  const Index at_force = left_force();
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

void Shooting::write_force_row(const VectorXd& z, double along_x, double along_y, System& sys) const {
  const double fx = z[left_force()] - z[right_force()];
  const double fy = z[left_force() + 1] - z[right_force() + 1];
  sys.residual[sys.row] = along_x * fx + along_y * fy;
  sys.jacobian(sys.row, left_force()) += along_x;
  sys.jacobian(sys.row, right_force()) -= along_x;
  sys.jacobian(sys.row, left_force() + 1) += along_y;
  sys.jacobian(sys.row, right_force() + 1) -= along_y;
}

void Shooting::add_contact(const VectorXd& z, bool wrapped, Control control, System& sys) const {
  VectorXd& r = sys.residual;
  MatrixXd& J = sys.jacobian;
  Index& row = sys.row;
  const ElasticaSection p = section(z, pieces_);
  const Index at = 4 * pieces_;
  const double c = std::cos(p.angle);
  const double s = std::sin(p.angle);
  if (contact_ == ElasticaContact::material_point) {
    sys.hold(z, begin(), material_);
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
  } else if (control == Control::no_force || contact_ == ElasticaContact::material_point) {
    write_force_row(z, 1.0, 0.0, sys);
    ++row;
  } else if (contact_ == ElasticaContact::sticking) {
    sys.hold(z, begin(), material_);
  } else {
    // f . t - slope sigma f . nu = 0 with nu = (-s, c).
    const double k = slope_ * sigma_;
    const double fx = z[left_force()] - z[right_force()];
    const double fy = z[left_force() + 1] - z[right_force() + 1];
    write_force_row(z, c + k * s, s - k * c, sys);
    J(row++, at + 2) = fx * (-s + k * c) + fy * (c + k * s);
  }
}

void Shooting::add_demand(const VectorXd& z, bool wrapped, const Demand& demand, System& sys) const {
  switch (demand.control) {
    case Control::no_force:
      write_force_row(z, 0.0, 1.0, sys);
      break;
    case Control::height:
      sys.residual[sys.row] = z[height(wrapped)] - demand.height;
      sys.jacobian(sys.row, height(wrapped)) = 1.0;
      break;
    case Control::arc_length:
      sys.residual[sys.row] = demand.direction.dot(z - demand.origin) - demand.step;
      sys.jacobian.row(sys.row) = demand.direction.transpose();
      break;
  }
}

System Shooting::assemble(const VectorXd& z, bool wrapped, const Demand& demand) const {
  const Index n = size(wrapped);
  System sys{VectorXd::Zero(n), MatrixXd::Zero(n, n), 0};
  add_left_mount(z, sys);
  for (Index piece = 0; piece < 2 * pieces_; ++piece) add_piece_end(z, piece, wrapped, sys);
  add_contact(z, wrapped, demand.control, sys);
  add_demand(z, wrapped, demand, sys);
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
