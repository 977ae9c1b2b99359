#include "wire/rod_dynamics.hpp"

#include "wire/cross_matrix.hpp"
#include "wire/curvature.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace snare::wire {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using numerics::DaeKind;
using numerics::DaePoint;

namespace {

constexpr int block = SpatialRod::block;
constexpr int reach = SpatialRod::half_bandwidth;
constexpr int width = 2 * reach + 1;
constexpr int local = 11;  // unknowns of a vertex's cell: x and theta of its two edges and the last x

using LocalVector = Eigen::Matrix<double, local, 1>;
using LocalMatrix = Eigen::Matrix<double, local, local>;

MaterialMesh mesh_of(const RodInMotion& rod) {
  assert(rod.elements >= 4 && rod.length > 0.0 && rod.mass_per_length > 0.0);
  return {rod.elements / 2, rod.elements - rod.elements / 2, rod.grading};
}

std::size_t at_slot(int i, int j) {
  return static_cast<std::size_t>(i * width + (j - i + reach));
}

void add_to(std::vector<double>& values, int slot, double value) {
  if (slot >= 0) values[static_cast<std::size_t>(slot)] += value;
}

/// By (x_{i-1}, theta_{i-1}, x_i, theta_i, x_{i+1}) from derivatives by the edges a = x_i - x_{i-1}, b = x_{i+1} - x_i.
LocalVector to_local(const PairGradient& g) {
  LocalVector v;
  v << -g.a, g.theta_a, g.a - g.b, g.theta_b, g.b;
  return v;
}

LocalMatrix to_local(const PairHessian& h) {
  LocalMatrix m = LocalMatrix::Zero();
  const Matrix3d ba = h.ab.transpose();
  m.block<3, 3>(0, 0) = h.aa;
  m.block<3, 3>(0, 4) = -h.aa + h.ab;
  m.block<3, 3>(0, 8) = -h.ab;
  m.block<3, 3>(4, 0) = -h.aa + ba;
  m.block<3, 3>(4, 4) = h.aa - h.ab - ba + h.bb;
  m.block<3, 3>(4, 8) = h.ab - h.bb;
  m.block<3, 3>(8, 0) = -ba;
  m.block<3, 3>(8, 4) = ba - h.bb;
  m.block<3, 3>(8, 8) = h.bb;
  const auto angle = [&m](int column, const Vector3d& a, const Vector3d& b) {
    m.block<3, 1>(0, column) = -a;
    m.block<3, 1>(4, column) = a - b;
    m.block<3, 1>(8, column) = b;
    m.block<1, 3>(column, 0) = -a.transpose();
    m.block<1, 3>(column, 4) = (a - b).transpose();
    m.block<1, 3>(column, 8) = b.transpose();
  };
  angle(3, h.a_theta_a, h.b_theta_a);
  angle(7, h.a_theta_b, h.b_theta_b);
  m(3, 3) = h.theta_aa;
  m(3, 7) = m(7, 3) = h.theta_ab;
  m(7, 7) = h.theta_bb;
  return m;
}

}  // namespace

/// One vertex's bending for the damping: turn, directors, stiffness, rates of the local unknowns.
struct RodPart::ViscousCell {
  bool exists = false;
  Turn turn;
  InverseLengths inverse;
  Directors before, after;
  double length = 0.0;                  // of the cell [m]
  std::array<double, 2> coefficient{};  // tau k_j [N m s]
  LocalVector rate = LocalVector::Zero();
  Vector3d spin = Vector3d::Zero();  // of a mount that moves
  Vector3d edge = Vector3d::Zero();  // beside it

  ViscousCell(const RodPart& part, const DaePoint& at, int i) {
    const SpatialRodProperties& p = part.rod_.properties();
    const int n = part.rod_.mesh().edges();
    const SpatialEnd* end = i == 0 ? &p.left : (i == n ? &p.right : nullptr);
    if (end != nullptr && end->kind != SpatialEnd::Kind::clamp) return;
    exists = true;
    Vector3d tangents[2];
    for (int side = 0; side < 2; ++side) {
      const int e = i - 1 + side;
      Directors& directors = side == 0 ? before : after;
      double& inverse_length = side == 0 ? inverse.a : inverse.b;
      const bool mount = e < 0 || e >= n;
      Frame frame = mount ? (e < 0 ? *part.trial_.left_mount : *part.trial_.right_mount)
                          : part.trial_.frames[static_cast<std::size_t>(e)];
      const double theta = mount ? end->twist_angle : part.trial_.q[block * e + 3];
      tangents[side] = frame.tangent;
      directors.first = turned_director(frame, theta);
      directors.second = frame.tangent.cross(directors.first);
      inverse_length = mount ? 0.0 : 1.0 / (vertex(part.trial_, e + 1) - vertex(part.trial_, e)).norm();
      if (!mount) rate[4 * side + 3] = at.rate[part.angle_of(e)];
    }
    for (int k = -1; k <= 1; ++k) {
      if (i + k >= 0 && i + k <= n) rate.segment<3>(4 * (k + 1)) = at.y.segment<3>(part.velocity_of(i + k));
    }
    // A mount that spins carries the frame in which the edge beside it bends: rates are relative to it.
    if (end != nullptr && part.carried_[i == 0 ? 0 : 1]) {
      spin = part.carried_[i == 0 ? 0 : 1](at.y).angular;
      const int e = i == 0 ? 0 : n - 1;
      edge = vertex(part.trial_, e + 1) - vertex(part.trial_, e);
      if (i == 0) {
        rate.segment<3>(8) -= spin.cross(edge);
        rate[7] -= spin.dot(tangents[1]);
      } else {
        rate.segment<3>(0) += spin.cross(edge);
        rate[3] -= spin.dot(tangents[0]);
      }
    }
    turn = make_turn(tangents[0], tangents[1]);
    const double rest_before = i > 0 ? part.rod_.mesh().rest_length(i - 1, part.controls_) : 0.0;
    const double rest_after = i < n ? part.rod_.mesh().rest_length(i, part.controls_) : 0.0;
    length = 0.5 * (rest_before + rest_after);
    coefficient = {part.constants_.damping.bending_time * p.bending_stiffness / length,
                   part.constants_.damping.bending_time * p.second_bending_stiffness / length};
  }
  /// Change of the relative rates with the places of the local unknowns.
  [[nodiscard]] LocalMatrix rate_by_place(bool right) const {
    LocalMatrix m = LocalMatrix::Zero();
    if (spin.isZero(0.0)) return m;
    const double size = edge.norm();
    const Vector3d t = edge / size;
    const Matrix3d spinning = cross_matrix(spin);
    const Vector3d along = (spin - spin.dot(t) * t) / size;
    // At the left end rate(8..10) -= spin x (x_1 - x_0); at the right one rate(0..2) += spin x (x_n - x_{n-1}).
    const int row = right ? 0 : 8, angle = right ? 3 : 7, first = right ? 0 : 4;
    const double sign = right ? 1.0 : -1.0;
    m.block<3, 3>(row, first) = -sign * spinning;
    m.block<3, 3>(row, first + 4) = sign * spinning;
    m.block<1, 3>(angle, first) = along.transpose();
    m.block<1, 3>(angle, first + 4) = -along.transpose();
    return m;
  }
  [[nodiscard]] WeightedCurvature curvature(int j) const {
    return {turn, before, after, j == 0 ? Eigen::Vector2d(1.0, 0.0) : Eigen::Vector2d(0.0, 1.0)};
  }
};

/// What the strands of a vertex answer.                                                            theory.md (M.14)
struct RodPart::StrandCell {
  Vector2d moment;    // of the strands [N m]
  Vector2d rate;      // z' [1/(m s)]
  Matrix2d by_reach;  // d(moment/extra_stiffness) / de

  StrandCell(const RodStrands& s, const Vector2d& held, const Vector2d& curvature_rate) {
    const Vector2d e = held + s.time * curvature_rate;
    const double size = e.norm();
    Vector2d m = e;
    by_reach.setIdentity();
    if (size > s.slip_curvature) {
      const Vector2d direction = e / size;
      m = s.slip_curvature * direction;
      by_reach = s.slip_curvature / size * (Matrix2d::Identity() - direction * direction.transpose());
    }
    moment = s.extra_stiffness * m;
    rate = (m - held) / s.time;
  }
};

RodPart::RodPart(std::string name, const RodInMotion& rod, const RodTolerances& tolerances)
    : name_(std::move(name)),
      constants_(rod),
      tolerances_(tolerances),
      rod_(mesh_of(rod), rod.properties),
      controls_{0.0, rod.length * (rod.elements / 2) / rod.elements, rod.length} {
  const int n = rod_.mesh().vertices();
  mass_.assign(static_cast<std::size_t>(n), 0.0);
  for (int e = 0; e + 1 < n; ++e) {
    const double half = 0.5 * rod.mass_per_length * rod_.mesh().rest_length(e, controls_);
    mass_[static_cast<std::size_t>(e)] += half;
    mass_[static_cast<std::size_t>(e + 1)] += half;
  }
  held_.assign(static_cast<std::size_t>(3 * n), false);
  const auto hold = [this](const SpatialEnd& end, int vertex) {
    if (end.kind == SpatialEnd::Kind::free) return;
    for (int k = 0; k < 3; ++k) {
      held_[static_cast<std::size_t>(3 * vertex + k)] = k > 0 || std::isinf(end.translational_stiffness);
    }
  };
  hold(rod.properties.left, 0);
  hold(rod.properties.right, n - 1);
  if (!rod.properties.left.orients() && !rod.properties.right.orients()) {
    // The drag on the spin of a straight wire is that of a wire bent by some 3e-5 rad in all: it exerts no moment of note.
    constexpr double share = 1e-9;
    holds_first_angle_ = rod.damping.bending_time == 0.0;
    spin_drag_ = share * rod.damping.bending_time * rod.properties.bending_stiffness / rod.length;
  }
  band_.resize(rod_.unknowns());
}

void RodPart::declare(numerics::DaeLayout& layout) {
  const int n = vertices();
  const std::vector<std::string> axes{"x", "y", "z"};
  x_ = layout.add({name_ + " position", axes, 3 * n, DaeKind::differential, tolerances_.position, 0});
  theta_ = layout.add({name_ + " twist angle", {}, n, DaeKind::algebraic, tolerances_.angle, 0});
  v_ = layout.add({name_ + " velocity", axes, 3 * n, DaeKind::differential, tolerances_.velocity, 0});
  if (constants_.strands.act()) {
    // A thousandth of the curvature at which they slip.
    strand_ = layout.add({name_ + " strands", {"1", "2"}, 2 * n, DaeKind::differential,
                          1e-3 * constants_.strands.slip_curvature, 0});
  }
}

int RodPart::unknown_of(int band) const {
  const int i = band / block;
  const int k = band % block;
  return k == 3 ? theta_ + i : x_ + 3 * i + k;
}

namespace {

bool is_angle(int band) {
  return band % block == 3;
}

}  // namespace

void RodPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  const int bands = rod_.unknowns();
  const bool damped = bends_with_loss() || constants_.damping.axial_time > 0.0;
  for (int i = 0; constants_.strands.act() && i < vertices(); ++i) {
    for (int z = strand_of(i); z < strand_of(i) + 2; ++z) {
      entries.emplace_back(z, strand_of(i));
      entries.emplace_back(z, strand_of(i) + 1);
      for (int j = std::max(0, block * (i - 1)); j < std::min(bands, block * (i - 1) + local); ++j) {
        const int vertex = j / block;
        entries.emplace_back(z, unknown_of(j));
        if (!is_angle(j)) entries.emplace_back(z, velocity_of(vertex) + j % block);
        entries.emplace_back(is_angle(j) ? unknown_of(j) : velocity_of(vertex) + j % block, z);
      }
    }
  }
  for (int i = 0; i < bands; ++i) {
    const int at = unknown_of(i);
    const int vertex = i / block;
    if (is_angle(i)) {
      entries.emplace_back(at, at);
      if (holds_angle(vertex)) continue;
    } else {
      const int velocity = velocity_of(vertex) + i % block;
      entries.emplace_back(at, at);
      entries.emplace_back(at, velocity);
      entries.emplace_back(velocity, velocity);
      if (is_held(vertex, i % block)) continue;
    }
    const int row = is_angle(i) ? at : velocity_of(vertex) + i % block;
    for (int j = std::max(0, i - reach); j <= std::min(bands - 1, i + reach); ++j) {
      // A round rod's twist acts through the edges' vectors of both sides: within the band everything may be filled.
      entries.emplace_back(row, unknown_of(j));
      if (damped && !is_angle(j)) entries.emplace_back(row, velocity_of(j / block) + j % block);
    }
  }
}

void RodPart::attach_pattern(const numerics::SparseMatrix& pattern) {
  pattern_ = &pattern;
  const int bands = rod_.unknowns();
  band_slots_.assign(static_cast<std::size_t>(bands * width), -1);
  rate_slots_.assign(static_cast<std::size_t>(bands * width), -1);
  diagonal_.assign(static_cast<std::size_t>(3 * bands), -1);
  for (int i = 0; i < bands; ++i) {
    const int at = unknown_of(i);
    const int vertex = i / block;
    const auto d = static_cast<std::size_t>(3 * i);
    diagonal_[d] = pattern.slot(at, at);
    bool held = false;
    int row = at;
    if (is_angle(i)) {
      held = holds_angle(vertex);
    } else {
      row = velocity_of(vertex) + i % block;
      diagonal_[d + 1] = pattern.slot(at, row);
      diagonal_[d + 2] = pattern.slot(row, row);
      held = is_held(vertex, i % block);
    }
    if (held) continue;
    for (int j = std::max(0, i - reach); j <= std::min(bands - 1, i + reach); ++j) {
      band_slots_[at_slot(i, j)] = pattern.slot(row, unknown_of(j));
      if (!is_angle(j)) rate_slots_[at_slot(i, j)] = pattern.slot(row, velocity_of(j / block) + j % block);
    }
  }
}

void RodPart::place(const Matrix3Xd& positions, const Matrix3Xd& velocities, Eigen::VectorXd& y) {
  const int n = vertices();
  assert(positions.cols() == n);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(rod_.unknowns());
  for (int i = 0; i < n; ++i) {
    q.segment<3>(block * i) = positions.col(i);
    y.segment<3>(position_of(i)) = positions.col(i);
    y[angle_of(i)] = 0.0;
    y.segment<3>(velocity_of(i)).setZero();
    if (velocities.cols() == n) y.segment<3>(velocity_of(i)) = velocities.col(i);
  }
  base_ = rod_.make_state(q, controls_);
  trial_ = base_;
}

void RodPart::take_unknowns(const numerics::VectorView& y) {
  for (int i = 0; i < vertices(); ++i) {
    band_.segment<3>(block * i) = y.segment<3>(position_of(i));
    band_[block * i + 3] = y[angle_of(i)];
  }
}

void RodPart::evaluate(const DaePoint& at) {
  take_unknowns(at.y);
  trial_ = base_;
  set_mounts(at.y, trial_);
  wire::accept(trial_, band_);
  rod_.assemble_forces(trial_, assembly_);
  viscous_power_ = strand_energy_ = 0.0;
  viscous_couples_ = {Vector3d::Zero(), Vector3d::Zero()};
  strand_rates_.assign(static_cast<std::size_t>(vertices()), Vector2d::Zero());
  add_viscous(at, assembly_.gradient);
}

void RodPart::add_viscous(const DaePoint& at, Eigen::VectorXd& gradient) {
  const int n = rod_.mesh().edges();
  if (constants_.damping.axial_time > 0.0) {
    for (int e = 0; e < n; ++e) {
      const Vector3d d = vertex(trial_, e + 1) - vertex(trial_, e);
      const Vector3d t = d.normalized();
      const double rest = rod_.mesh().rest_length(e, controls_);
      const double rate = t.dot(at.y.segment<3>(velocity_of(e + 1)) - at.y.segment<3>(velocity_of(e))) / rest;
      const double force = constants_.damping.axial_time * rod_.properties().axial_stiffness * rate;
      gradient.segment<3>(block * e) -= force * t;
      gradient.segment<3>(block * (e + 1)) += force * t;
      viscous_power_ += force * rate * rest;
    }
  }
  if (!bends_with_loss()) return;
  for (int i = 0; i <= n; ++i) {
    const ViscousCell cell(*this, at, i);
    if (!cell.exists) continue;
    const LocalVector& r = cell.rate;
    const Vector3d rate_a = r.segment<3>(4) - r.segment<3>(0);
    const Vector3d rate_b = r.segment<3>(8) - r.segment<3>(4);
    std::array<PairGradient, 2> gradients;
    Vector2d rates;
    for (int j = 0; j < 2; ++j) {
      PairGradient& g = gradients[static_cast<std::size_t>(j)];
      cell.curvature(j).add_gradient(cell.inverse, g);
      rates[j] = g.a.dot(rate_a) + g.b.dot(rate_b) + g.theta_a * r[3] + g.theta_b * r[7];
    }
    Vector2d strands = Vector2d::Zero();
    if (constants_.strands.act()) {
      const Vector2d held = at.y.segment<2>(strand_of(i));
      const StrandCell s(constants_.strands, held, rates / cell.length);
      strands = s.moment;
      strand_rates_[static_cast<std::size_t>(i)] = s.rate;
      const double stiffness = constants_.strands.extra_stiffness * cell.length;
      strand_energy_ += 0.5 * stiffness * held.squaredNorm();
      // The dashpot's heat and that of the sliding.
      viscous_power_ += stiffness * constants_.strands.time * s.rate.squaredNorm() +
                        s.moment.dot(rates - cell.length * s.rate);
    }
    for (int j = 0; j < 2; ++j) {
      const PairGradient& g = gradients[static_cast<std::size_t>(j)];
      const double viscous = cell.coefficient[static_cast<std::size_t>(j)] * rates[j];
      const double moment = viscous + strands[j];
      viscous_power_ += viscous * rates[j];
      if (i == 0) viscous_couples_[0] -= moment * cell.curvature(j).by_rotation();
      if (i == n) viscous_couples_[1] += moment * cell.curvature(j).by_rotation();
      if (i > 0) {
        gradient.segment<3>(block * (i - 1)) -= moment * g.a;
        gradient[block * (i - 1) + 3] += moment * g.theta_a;
      }
      gradient.segment<3>(block * i) += moment * (g.a - g.b);
      if (i < n) {
        gradient[block * i + 3] += moment * g.theta_b;
        gradient.segment<3>(block * (i + 1)) += moment * g.b;
      }
    }
  }
}

void RodPart::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  evaluate(at);
  const int n = vertices();
  const double mass_rate = constants_.damping.mass_rate;
  for (int i = 0; i < n; ++i) {
    const SpatialEnd& end = i == 0 ? rod_.properties().left : rod_.properties().right;
    const double m = mass_of(i);
    for (int k = 0; k < 3; ++k) {
      const int x = position_of(i) + k;
      const int v = velocity_of(i) + k;
      if (is_held(i, k)) {
        rows[x] += at.y[x] - end.position[k];
        rows[v] += at.y[v];
      } else {
        rows[x] += at.rate[x] - at.y[v];
        rows[v] += m * (at.rate[v] + mass_rate * at.y[v]) + assembly_.gradient[block * i + k];
      }
    }
    rows[angle_of(i)] += holds_angle(i) ? at.y[angle_of(i)] : assembly_.gradient[block * i + 3];
    if (constants_.strands.act()) {
      rows.segment<2>(strand_of(i)) += at.rate.segment<2>(strand_of(i)) - strand_rates_[static_cast<std::size_t>(i)];
    }
  }
  if (spin_drag_ > 0.0) rows[angle_of(0)] += spin_drag_ * at.rate[angle_of(0)];
}

void RodPart::jacobian(const DaePoint& at, double c, std::vector<double>& values) {
  evaluate(at);
  rod_.assemble(trial_, {false, false, false}, assembly_);
  const int bands = rod_.unknowns();
  for (int i = 0; i < bands; ++i) {
    const int vertex = i / block;
    const auto d = static_cast<std::size_t>(3 * i);
    if (is_angle(i)) {
      if (holds_angle(vertex)) add_to(values, diagonal_[d], 1.0);
    } else if (is_held(vertex, i % block)) {
      add_to(values, diagonal_[d], 1.0);
      add_to(values, diagonal_[d + 2], 1.0);
    } else {
      add_to(values, diagonal_[d], c);
      add_to(values, diagonal_[d + 1], -1.0);
      add_to(values, diagonal_[d + 2], mass_of(vertex) * (c + constants_.damping.mass_rate));
    }
  }
  for (int j = 0; j < bands; ++j) {
    const double* column = assembly_.hessian.column(j);
    for (int i = j; i <= std::min(bands - 1, j + reach); ++i) {
      const double value = column[i - j];
      add_to(values, band_slots_[at_slot(i, j)], value);
      if (i != j) add_to(values, band_slots_[at_slot(j, i)], value);
    }
  }
  if (spin_drag_ > 0.0) add_to(values, diagonal_[9], c * spin_drag_);  // of band index 3, the first angle
  add_viscous_jacobian(at, c, values);
}

void RodPart::add_viscous_jacobian(const DaePoint& at, double c, std::vector<double>& values) {
  const int n = rod_.mesh().edges();
  const int bands = rod_.unknowns();
  if (constants_.damping.axial_time > 0.0) {
    for (int e = 0; e < n; ++e) {
      const Vector3d d = vertex(trial_, e + 1) - vertex(trial_, e);
      const double length = d.norm();
      const Vector3d t = d / length;
      const Vector3d w = at.y.segment<3>(velocity_of(e + 1)) - at.y.segment<3>(velocity_of(e));
      const double factor = constants_.damping.axial_time * rod_.properties().axial_stiffness /
                            rod_.mesh().rest_length(e, controls_);
      const Matrix3d across = (Matrix3d::Identity() - t * t.transpose()) / length;
      const Matrix3d by_edge = factor * (t * (across * w).transpose() + t.dot(w) * across);
      const Matrix3d by_rate = factor * t * t.transpose();
      for (int a = 0; a < 6; ++a) {
        for (int b = 0; b < 6; ++b) {
          const double sign = (a < 3) == (b < 3) ? 1.0 : -1.0;
          const int i = block * (e + a / 3) + a % 3;
          const int j = block * (e + b / 3) + b % 3;
          add_to(values, band_slots_[at_slot(i, j)], sign * by_edge(a % 3, b % 3));
          add_to(values, rate_slots_[at_slot(i, j)], sign * by_rate(a % 3, b % 3));
        }
      }
    }
  }
  if (!bends_with_loss()) return;
  for (int i = 0; i <= n; ++i) {
    const ViscousCell cell(*this, at, i);
    if (constants_.strands.act()) add_strands_jacobian(cell, i, at, c, values);
    if (!cell.exists || constants_.damping.bending_time == 0.0) continue;
    LocalMatrix by_local = LocalMatrix::Zero();
    LocalMatrix by_rate = LocalMatrix::Zero();
    for (int j = 0; j < 2; ++j) {
      PairGradient g;
      PairHessian h;
      const WeightedCurvature curvature = cell.curvature(j);
      curvature.add_gradient(cell.inverse, g);
      curvature.add_hessian(cell.inverse, h);
      const LocalVector slope = to_local(g);
      const LocalMatrix hessian = to_local(h);
      const double factor = cell.coefficient[static_cast<std::size_t>(j)];
      by_local += factor * (slope.dot(cell.rate) * hessian + slope * (hessian * cell.rate).transpose());
      by_rate += factor * slope * slope.transpose();
    }
    if (i == 0 || i == n) by_local += by_rate * cell.rate_by_place(i == n);
    for (int a = 0; a < local; ++a) {
      const int row = block * (i - 1) + a;
      if (row < 0 || row >= bands) continue;
      for (int b = 0; b < local; ++b) {
        const int column = block * (i - 1) + b;
        if (column < 0 || column >= bands) continue;
        const std::size_t slot = at_slot(row, column);
        add_to(values, band_slots_[slot], by_local(a, b) + (is_angle(column) ? c * by_rate(a, b) : 0.0));
        if (!is_angle(column)) add_to(values, rate_slots_[slot], by_rate(a, b));
      }
    }
  }
}

void RodPart::add_strands_jacobian(const ViscousCell& cell, int vertex, const DaePoint& at, double c,
                                   std::vector<double>& values) {
  const int z = strand_of(vertex);
  const auto add = [&](int row, int column, double value) { add_to(values, pattern_->slot(row, column), value); };
  add(z, z, c);
  add(z + 1, z + 1, c);
  if (!cell.exists) return;
  const RodStrands& s = constants_.strands;
  const int bands = rod_.unknowns();
  std::array<LocalVector, 2> slope;    // of kappa_j
  std::array<LocalMatrix, 2> hessian;  // of kappa_j
  std::array<LocalVector, 2> turning;  // of kappa_j' by the local unknowns
  Vector2d rates;
  for (std::size_t j = 0; j < 2; ++j) {
    PairGradient g;
    PairHessian h;
    const WeightedCurvature curvature = cell.curvature(static_cast<int>(j));
    curvature.add_gradient(cell.inverse, g);
    curvature.add_hessian(cell.inverse, h);
    slope[j] = to_local(g);
    hessian[j] = to_local(h);
    turning[j] = hessian[j] * cell.rate;
    rates[static_cast<Eigen::Index>(j)] = slope[j].dot(cell.rate);
  }
  const StrandCell strands(s, at.y.segment<2>(z), rates / cell.length);
  LocalMatrix by_local = strands.moment[0] * hessian[0] + strands.moment[1] * hessian[1];
  LocalMatrix by_rate = LocalMatrix::Zero();
  for (std::size_t j = 0; j < 2; ++j) {
    for (std::size_t m = 0; m < 2; ++m) {
      const double share = strands.by_reach(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(m));
      const double factor = s.extra_stiffness * s.time / cell.length * share;
      by_local += factor * slope[j] * turning[m].transpose();
      by_rate += factor * slope[j] * slope[m].transpose();
      const int row = z + static_cast<int>(j);
      const int column = z + static_cast<int>(m);
      add(row, column, -(share - (j == m ? 1.0 : 0.0)) / s.time);
      for (int a = 0; a < local; ++a) {
        const int band = block * (vertex - 1) + a;
        // The last angle belongs to no edge: the mount's stands in its place.
        if (band < 0 || band >= bands - 1) continue;
        const double by_position = -share / cell.length * turning[m][a];
        const double by_velocity = -share / cell.length * slope[m][a];
        add(row, unknown_of(band), by_position + (is_angle(band) ? c * by_velocity : 0.0));
        if (!is_angle(band)) add(row, velocity_of(band / block) + band % block, by_velocity);
        // Rows of the forces, but of what is held.
        if (band_slots_[at_slot(band, band)] < 0) continue;
        add(is_angle(band) ? unknown_of(band) : velocity_of(band / block) + band % block, column,
            s.extra_stiffness * share * slope[j][a]);
      }
    }
  }
  for (int a = 0; a < local; ++a) {
    const int row = block * (vertex - 1) + a;
    if (row < 0 || row >= bands) continue;
    for (int b = 0; b < local; ++b) {
      const int column = block * (vertex - 1) + b;
      if (column < 0 || column >= bands - 1) continue;
      const std::size_t slot = at_slot(row, column);
      add_to(values, band_slots_[slot], by_local(a, b) + (is_angle(column) ? c * by_rate(a, b) : 0.0));
      if (!is_angle(column)) add_to(values, rate_slots_[slot], by_rate(a, b));
    }
  }
}

void RodPart::carry(bool right, std::function<MountMotion(const numerics::VectorView& y)> motion) {
  const SpatialEnd& end = right ? rod_.properties().right : rod_.properties().left;
  assert(end.kind != SpatialEnd::Kind::free && std::isinf(end.translational_stiffness));
  static_cast<void>(end);
  carried_[right ? 1 : 0] = std::move(motion);
  const int i = right ? vertices() - 1 : 0;
  for (int k = 0; k < 3; ++k) held_[static_cast<std::size_t>(3 * i + k)] = false;
}

void RodPart::set_mounts(const numerics::VectorView& y, SpatialState& state) const {
  if (carried_[0] && state.left_mount) state.left_mount = carried_[0](y).frame;
  if (carried_[1] && state.right_mount) state.right_mount = carried_[1](y).frame;
}

/// What acts between a mount and the edge beside it: generalised force on edge and angle (4), its derivatives by these
/// at fixed rates relative to the mount, and by the relative rates.
struct RodPart::EndForces {
  Eigen::Vector4d force;
  Eigen::Matrix4d by_place, by_rate;
  Vector3d edge, tangent, edge_rate, spin;
  double length = 0.0;
};

RodPart::EndForces RodPart::end_forces(const DaePoint& at, bool right) const {
  const int n = rod_.mesh().edges();
  const int e = right ? n - 1 : 0;
  EndForces f;
  f.edge = vertex(trial_, e + 1) - vertex(trial_, e);
  f.length = f.edge.norm();
  f.tangent = f.edge / f.length;
  f.spin = carried_[right ? 1 : 0](at.y).angular;
  f.edge_rate = Vector3d(at.y.segment<3>(velocity_of(e + 1)) - at.y.segment<3>(velocity_of(e))) - f.spin.cross(f.edge);
  const SpatialRod::EndCell elastic = rod_.end_cell(trial_, right);
  f.force = elastic.gradient;
  f.by_place = elastic.hessian;
  f.by_rate.setZero();
  if (constants_.damping.bending_time == 0.0) return f;
  const ViscousCell cell(*this, at, right ? n : 0);
  if (!cell.exists) return f;
  Eigen::Vector4d rate;
  rate << f.edge_rate, at.rate[angle_of(e)] - f.spin.dot(f.tangent);
  for (int j = 0; j < 2; ++j) {
    PairGradient g;
    PairHessian h;
    const WeightedCurvature curvature = cell.curvature(j);
    curvature.add_gradient(cell.inverse, g);
    curvature.add_hessian(cell.inverse, h);
    const Vector3d coupling = right ? h.a_theta_a : h.b_theta_b;
    Eigen::Vector4d slope;
    Eigen::Matrix4d hessian;
    slope << (right ? g.a : g.b), (right ? g.theta_a : g.theta_b);
    hessian << (right ? h.aa : h.bb), coupling, coupling.transpose(), (right ? h.theta_aa : h.theta_bb);
    const double factor = cell.coefficient[static_cast<std::size_t>(j)];
    f.force += factor * slope.dot(rate) * slope;
    f.by_place += factor * (slope.dot(rate) * hessian + slope * (hessian * rate).transpose());
    f.by_rate += factor * slope * slope.transpose();
  }
  return f;
}

Vector3d RodPart::mount_moment(const DaePoint& at, bool right) {
  const EndForces f = end_forces(at, right);
  return f.edge.cross(f.force.head<3>()) + f.force[3] * f.tangent;
}

// Turned together, edge and mount keep their energy: dE/d(turn of the mount) = -(e x g + t gamma) with the edge's force g and
// the angle's gamma; and g turns with both, so that a turn of the mount alone does what a turn of the edge the other way does.
RodPart::MountCell RodPart::mount_cell(const DaePoint& at, bool right) {
  evaluate(at);
  const EndForces f = end_forces(at, right);
  const Vector3d g = f.force.head<3>();
  const double gamma = f.force[3];
  const Matrix3d across = (Matrix3d::Identity() - f.tangent * f.tangent.transpose()) / f.length;
  // By the edge, its angle, and their rates, the mount being fixed or spinning as it is.
  Eigen::Matrix4d rate_by_place = Eigen::Matrix4d::Zero();
  rate_by_place.topLeftCorner<3, 3>() = -cross_matrix(f.spin);
  rate_by_place.bottomLeftCorner<1, 3>() = -f.spin.transpose() * across;
  const Eigen::Matrix4d by_place = f.by_place + f.by_rate * rate_by_place;
  Eigen::Matrix<double, 4, 3> turned, turned_rate, spun;  // what a turn and a spin of both would do
  turned << -cross_matrix(f.edge), f.tangent.transpose();
  turned_rate << -cross_matrix(f.edge_rate), Eigen::RowVector3d::Zero();
  spun << cross_matrix(f.edge), -f.tangent.transpose();
  Eigen::Matrix<double, 4, 3> by_turn = -f.by_place * turned - f.by_rate * turned_rate;
  // Relative rates at fixed spin: e' - w x e has nothing that turns with the mount but is seen from it.
  by_turn.topRows<3>() -= cross_matrix(g);
  const Eigen::Matrix<double, 4, 3> by_spin = f.by_rate * spun;
  // M = e x g + t gamma.
  const auto moment = [&](const auto& change) {
    return (cross_matrix(f.edge) * change.template topRows<3>() + f.tangent * change.template bottomRows<1>()).eval();
  };
  Eigen::Matrix<double, 3, 4> by_edge = moment(by_place);
  by_edge.leftCols<3>() += -cross_matrix(g) + gamma * across;
  const Eigen::Matrix<double, 3, 4> by_edge_rate = moment(f.by_rate);
  MountCell cell;
  cell.moment = f.edge.cross(g) + gamma * f.tangent;
  cell.moment_by_turn = moment(by_turn);
  cell.moment_by_spin = moment(by_spin);
  const double sign = right ? -1.0 : 1.0;  // e = sign (next - mount)
  const auto spread = [&](const Eigen::Matrix<double, 3, 4>& m) {
    Eigen::Matrix<double, 3, 7> wide;
    wide << -sign * m.leftCols<3>(), sign * m.leftCols<3>(), m.col(3);
    return wide;
  };
  cell.moment_by = spread(by_edge);
  cell.moment_by_rate = spread(by_edge_rate);
  const auto rows = [&](const Eigen::Matrix<double, 4, 3>& m) {
    Eigen::Matrix<double, 7, 3> tall;
    tall << -sign * m.topRows<3>(), sign * m.topRows<3>(), m.row(3);
    return tall;
  };
  cell.rows_by_turn = rows(by_turn);
  cell.rows_by_spin = rows(by_spin);
  return cell;
}

bool RodPart::accept(const DaePoint& at) {
  take_unknowns(at.y);
  set_mounts(at.y, base_);
  wire::accept(base_, band_);
  return false;
}

void RodPart::save_state(std::vector<double>& memory) const {
  for (const Frame& f : base_.frames) {
    for (int k = 0; k < 3; ++k) memory.push_back(f.tangent[k]);
    for (int k = 0; k < 3; ++k) memory.push_back(f.director[k]);
  }
  memory.insert(memory.end(), base_.reference_twist.begin(), base_.reference_twist.end());
}

void RodPart::restore_state(const numerics::VectorView& y, std::span<const double>& memory) {
  take_unknowns(y);
  base_ = rod_.make_state(band_, controls_);
  for (Frame& f : base_.frames) {
    for (int k = 0; k < 3; ++k) f.tangent[k] = numerics::take(memory);
    for (int k = 0; k < 3; ++k) f.director[k] = numerics::take(memory);
  }
  for (double& m : base_.reference_twist) m = numerics::take(memory);
  trial_ = base_;
}

double RodPart::mount_error(const numerics::VectorView& y) const {
  double worst = 0.0;
  for (const int i : {0, vertices() - 1}) {
    const SpatialEnd& end = i == 0 ? rod_.properties().left : rod_.properties().right;
    for (int k = 0; k < 3; ++k) {
      if (is_held(i, k)) worst = std::max(worst, std::abs(y[position_of(i) + k] - end.position[k]));
    }
  }
  return worst;
}

RodPart::Energies RodPart::energies(const DaePoint& at) {
  evaluate(at);
  Energies result;
  double square = 0.0;
  for (int i = 0; i < vertices(); ++i) {
    const Vector3d v = at.y.segment<3>(velocity_of(i));
    square += mass_of(i) * v.squaredNorm();
    result.momentum += mass_of(i) * v;
    result.angular_momentum += mass_of(i) * vertex(trial_, i).cross(v);
  }
  for (int e = 0; e + 1 < vertices(); ++e) {
    result.potential -= 0.5 * rod_.mesh().rest_length(e, controls_) *
                        rod_.properties().weight.dot(vertex(trial_, e) + vertex(trial_, e + 1));
  }
  result.kinetic = 0.5 * square;
  result.strain = assembly_.energy - result.potential + strand_energy_;
  result.dissipation = viscous_power_ + constants_.damping.mass_rate * square;
  const Vector3d& weight = rod_.properties().weight;
  for (int i = 0; weight != Vector3d::Zero() && i < vertices(); ++i) {
    // Half the weight of each edge is at its ends, as the mass is.
    result.weight_moment += mass_of(i) / constants_.mass_per_length * vertex(trial_, i).cross(weight);
  }
  const std::array<Vector3d, 2> moments = rod_.end_moments(trial_);
  for (std::size_t side = 0; side < 2; ++side) {
    const SpatialEnd& end = side == 0 ? rod_.properties().left : rod_.properties().right;
    if (end.kind == SpatialEnd::Kind::free || carried_[side]) continue;
    const int i = side == 0 ? 0 : vertices() - 1;
    result.mount_forces[side] = assembly_.gradient.segment<3>(block * i);
    if (!is_held(i, 0)) {
      result.mount_forces[side].x() =
          -end.translational_stiffness * (at.y[position_of(i)] - end.position.x());
    }
    result.mount_moments[side] = vertex(trial_, i).cross(result.mount_forces[side]) + viscous_couples_[side] +
                                 (side == 0 ? Vector3d(-moments[0]) : moments[1]);
  }
  return result;
}

}  // namespace snare::wire
