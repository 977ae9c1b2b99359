#include "coupling/statics/spatial_push_system.hpp"

#include "multibody/spatial.hpp"
#include "wire/statics/equilibrium.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace snare::coupling {

namespace {

using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int block = wire::SpatialRod::block;

}  // namespace

SpatialPushSystem::SpatialPushSystem(const wire::SpatialRod& rod, wire::SpatialState accepted,
                                     const SpatialPin& pin_)
    : pin(pin_),
      rod_(&rod),
      accepted_(std::move(accepted)),
      length_(accepted_.controls[2] - accepted_.controls[0]),
      shortest_edge_(length_) {
  for (int e = 0; e < rod.mesh().edges(); ++e) {
    shortest_edge_ = std::min(shortest_edge_, rod.mesh().rest_length(e, accepted_.controls));
  }
}

wire::SpatialState SpatialPushSystem::state(const numerics::PathPoint& at) const {
  wire::SpatialState s = accepted_;
  wire::accept(s, at.band);
  s.controls[1] = at.border[Rows::coordinate];
  return s;
}

VertexSlope<3> SpatialPushSystem::slope(const wire::SpatialState& s) const {
  const int i = rod_->mesh().contact_vertex();
  return vertex_slope<3>(
      wire::vertex(s, i) - wire::vertex(s, i - 1), wire::vertex(s, i + 1) - wire::vertex(s, i),
      rod_->mesh().rest_length(i - 1, s.controls), rod_->mesh().rest_length(i, s.controls));
}

SpatialPushSystem::Geometry SpatialPushSystem::geometry(const numerics::PathPoint& at,
                                                        const wire::SpatialState& s) const {
  const int i = rod_->mesh().contact_vertex();
  Geometry g;
  g.tangent = slope(s).u.normalized();
  g.normal = pin.side * pin.axis.cross(g.tangent).normalized();
  g.across = g.normal.cross(pin.axis);
  g.zeta = pin.axis.dot(wire::vertex(s, i) - pin.centre - at.parameter * pin.motion);
  const double turned =
      std::atan2(pin.axis.dot(pin.last_normal.cross(g.normal)), pin.last_normal.dot(g.normal));
  const double fed = at.border[Rows::coordinate] - pin.last_coordinate;
  g.slip = {-pin.radius * turned - g.tangent.dot(g.across) * fed,
            g.zeta - pin.last_zeta - g.tangent.dot(pin.axis) * fed};
  const Vector3d f = force(at);
  g.normal_force = f.dot(g.normal);
  g.friction = {f.dot(g.across), f.dot(pin.axis)};
  g.trial = g.friction - rod_->properties().axial_stiffness / length_ * g.slip;
  return g;
}

void SpatialPushSystem::assemble(const numerics::PathPoint& at, numerics::BorderedSystem& system,
                                 Eigen::VectorXd& by_parameter) {
  const wire::SpatialState s = state(at);
  rod_->assemble(s, {false, true, false}, assembly_);
  system.reset(rod_->unknowns(), border_unknowns);
  by_parameter.setZero(border_unknowns);
  const int last = block * rod_->mesh().edges();
  reactions_ = {assembly_.gradient.segment<3>(0), assembly_.gradient.segment<3>(last)};
  const std::array<const wire::SpatialEnd*, 2> ends{&rod_->properties().left, &rod_->properties().right};
  for (std::size_t k = 0; k < 2; ++k) {
    if (std::isinf(ends[k]->translational_stiffness)) continue;
    // By the wire's side of the balance, as in PushSystem.
    reactions_[k].x() -= ends[k]->translational_stiffness * (s.q[k == 0 ? 0 : last] - ends[k]->position.x());
  }
  rod_->hold_mounts(assembly_);
  system.band_residual = assembly_.gradient;
  std::swap(system.matrix, assembly_.hessian);

  const int i = rod_->mesh().contact_vertex();
  const Vector3d f = force(at);
  const double gap = at.border[Rows::gap];
  Eigen::MatrixXd& corner = system.corner;
  Eigen::VectorXd& residual = system.border_residual;
  system.columns.emplace_back(Rows::coordinate, &assembly_.control_columns[1]);
  const bool pressed = pin.pressed;
  if (pressed) {
    for (int a = 0; a < 3; ++a) {
      system.band_residual[block * i + a] -= f[a];
      system.anchors.push_back({block * i + a, Rows::force + a});
    }
  }

  const VertexSlope<3> curve = this->slope(s);
  const double size = curve.u.norm();
  const Geometry g = geometry(at, s);
  const Vector3d w = pin.axis.cross(g.tangent);
  // dt/du, dn/du, dc/du.
  const Matrix3d dt = (Matrix3d::Identity() - g.tangent * g.tangent.transpose()) / size;
  const Matrix3d dn = pin.side / w.norm() * (Matrix3d::Identity() - g.normal * g.normal.transpose()) *
                      numerics::cross_matrix(pin.axis) * dt;
  const Matrix3d dc = -numerics::cross_matrix(pin.axis) * dn;
  const double share_before = rod_->mesh().rest_length_derivative(i - 1, 1);
  const double share_after = rod_->mesh().rest_length_derivative(i, 1);
  // Adds factor . du to a border equation.
  const auto add_slope = [&](int row, const RowVector3d& factor) {
    for (int a = 0; a < 3; ++a) {
      system.rows.push_back({row, block * (i - 1) + a, -curve.before * factor[a]});
      system.rows.push_back({row, block * i + a, (curve.before - curve.after) * factor[a]});
      system.rows.push_back({row, block * (i + 1) + a, curve.after * factor[a]});
    }
    corner(row, Rows::coordinate) +=
        factor.dot(share_before * curve.by_before + share_after * curve.by_after);
  };

  // Position across the axis: b.(x - p - (R + g) n) = 0 for two directions b.
  const Vector3d arm =
      wire::vertex(s, i) - pin.centre - at.parameter * pin.motion - (pin.radius + gap) * g.normal;
  const Vector3d sideways = pin.axis.cross(pin.motion);  // none where the pin moves along its axis
  const Vector3d b0 =
      sideways.norm() > 1e-3 ? sideways.normalized() : pin.axis.cross(pin.last_normal).normalized();
  const std::array<Vector3d, 2> across{b0, pin.axis.cross(b0)};
  for (int k = 0; k < 2; ++k) {
    const Vector3d& b = across[static_cast<std::size_t>(k)];
    const int row = Rows::position + k;
    residual[row] = b.dot(arm);
    for (int a = 0; a < 3; ++a) system.rows.push_back({row, block * i + a, b[a]});
    add_slope(row, -(pin.radius + gap) * b.transpose() * dn);
    corner(row, Rows::gap) = -b.dot(g.normal);
    by_parameter[row] = -b.dot(pin.motion);
  }
  if (!pressed) {
    residual.segment<3>(Rows::friction) = f;
    for (int a = 0; a < 3; ++a) corner(Rows::friction + a, Rows::force + a) = 1.0;
    return;
  }
  residual[Rows::closure] = gap;
  corner(Rows::closure, Rows::gap) = 1.0;
  // Friction in the directions c and a: rows f_T - mu N w/|w| while it slides, r v while it sticks.
  const bool sliding = slides(g);
  const double scale = rod_->properties().axial_stiffness / length_;
  const double fed = at.border[Rows::coordinate] - pin.last_coordinate;
  const std::array<RowVector3d, 2> direction{g.across.transpose(), pin.axis.transpose()};
  const std::array<RowVector3d, 2> friction_by_u{f.transpose() * dc, RowVector3d::Zero()};
  const std::array<RowVector3d, 2> slip_by_u{
      pin.radius * g.across.transpose() * dn - fed * (g.across.transpose() * dt + g.tangent.transpose() * dc),
      -fed * pin.axis.transpose() * dt};
  const std::array<double, 2> slip_by_feed{-g.tangent.dot(g.across), -g.tangent.dot(pin.axis)};
  // Adds factor * d slip_k to a row.
  const auto add_slip = [&](int row, int k, double factor) {
    const auto c = static_cast<std::size_t>(k);
    add_slope(row, factor * slip_by_u[c]);
    corner(row, Rows::coordinate) += factor * slip_by_feed[c];
    if (k == 0) return;
    for (int a = 0; a < 3; ++a) system.rows.push_back({row, block * i + a, factor * pin.axis[a]});
    by_parameter[row] -= factor * pin.axis.dot(pin.motion);
  };
  const auto add_friction = [&](int row, int k, double factor) {
    const auto c = static_cast<std::size_t>(k);
    corner.block<1, 3>(row, Rows::force) += factor * direction[c];
    add_slope(row, factor * friction_by_u[c]);
  };
  const double size_of_trial = g.trial.norm();
  const Vector2d unit = size_of_trial > 0.0 ? Vector2d(g.trial / size_of_trial) : Vector2d(Vector2d::Zero());
  const double normal = std::max(0.0, g.normal_force);
  for (int k = 0; k < 2; ++k) {
    const int row = Rows::friction + k;
    if (!sliding) {
      residual[row] = scale * g.slip[k];
      add_slip(row, k, scale);
      continue;
    }
    residual[row] = g.friction[k] - pin.friction * normal * unit[k];
    add_friction(row, k, 1.0);
    if (pin.friction == 0.0) continue;
    if (g.normal_force > 0.0) {
      corner.block<1, 3>(row, Rows::force) -= pin.friction * unit[k] * g.normal.transpose();
      add_slope(row, -pin.friction * unit[k] * f.transpose() * dn);
    }
    for (int m = 0; m < 2; ++m) {
      const double turn = pin.friction * normal / size_of_trial * ((k == m ? 1.0 : 0.0) - unit[k] * unit[m]);
      add_friction(row, m, -turn);
      add_slip(row, m, turn * scale);
    }
  }
}

double SpatialPushSystem::error(const numerics::PathPoint& at, const numerics::BorderedSystem& system) const {
  const wire::SpatialRodProperties& p = rod_->properties();
  const double largest = std::max({force(at).norm(), reactions_[0].norm(), reactions_[1].norm()});
  const double balance =
      wire::force_tolerance(1e-10, p.bending_stiffness, p.axial_stiffness, length_, shortest_edge_, largest);
  const double position = 1e-12 * length_;
  double error = 0.0;
  for (Eigen::Index i = 0; i < system.band_residual.size(); ++i) {
    // Rows of the edge angles are moments: a force times the edge is as good as a force.
    double allowed = i % block == block - 1 ? balance * shortest_edge_ : balance;
    if (i == 0) allowed += wire::mount_round_off(p.left.translational_stiffness, length_);
    if (i == block * rod_->mesh().edges())
      allowed += wire::mount_round_off(p.right.translational_stiffness, length_);
    error = std::max(error, std::abs(system.band_residual[i]) / allowed);
  }
  const bool open = !pin.pressed;
  const Eigen::VectorXd& residual = system.border_residual;
  error = std::max(error, residual.segment<2>(Rows::position).lpNorm<Eigen::Infinity>() / position);
  error = std::max(error, residual.segment<2>(Rows::friction).lpNorm<Eigen::Infinity>() / balance);
  return std::max(error, std::abs(residual[Rows::closure]) / (open ? balance : position));
}

}  // namespace snare::coupling
