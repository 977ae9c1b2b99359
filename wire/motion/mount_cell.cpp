#include "wire/motion/mount_cell.hpp"

#include "numerics/cross_matrix.hpp"
#include "wire/motion/bending_cell.hpp"
#include "wire/motion/curved_rod.hpp"
#include "wire/motion/rod_damping.hpp"

#include <Eigen/Geometry>

namespace snare::wire {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using numerics::cross_matrix;
using numerics::DaePoint;

namespace {

// Of edge, angle and curvatures: rows and columns 0 to 2 belong to the edge vector e, 3 to theta, 4 and 5 to
// k.
constexpr int angle = 3;
constexpr int count = 6;
using Vector6d = Eigen::Matrix<double, count, 1>;
using Matrix6d = Eigen::Matrix<double, count, count>;
using Turned = Eigen::Matrix<double, count, 3>;

/// What acts between a mount and the edge beside it: generalised force (g, gamma) on edge and angle and the
/// rows of the curvatures, the derivatives by these at fixed rates relative to the mount, and by the relative
/// rates e' - w x e, theta' - w.t.
struct EdgeForce {
  Vector6d force = Vector6d::Zero();
  Matrix6d by_place = Matrix6d::Zero(), by_rate = Matrix6d::Zero();
  Vector3d edge, tangent, edge_rate, spin;
  double length = 0.0;
};

EdgeForce edge_force(const RodModel& model, const RodInstant& instant, const DaePoint& at, End end) {
  const int e = model.edge_at(end);
  EdgeForce f;
  f.edge = vertex(instant.state, e + 1) - vertex(instant.state, e);
  f.length = f.edge.norm();
  f.tangent = f.edge / f.length;
  f.spin = *instant.spin[index_of(end)];
  f.edge_rate = Vector3d(at.y.segment<3>(model.velocity_of(e + 1)) - at.y.segment<3>(model.velocity_of(e))) -
                f.spin.cross(f.edge);
  // Elastic part: dE, d2E of the half cell.
  const SpatialRod::EndCell elastic = model.rod().end_cell(instant.state, end);
  f.force.head<4>() = elastic.gradient;
  f.by_place.topLeftCorner<4, 4>() = elastic.hessian;
  if (model.is_curved()) {
    const CurvedEnd bending = curved_end(model, instant, at, end);
    f.force += bending.gradient;
    f.by_place += bending.hessian;
  }
  if (model.damping().bending_time == 0.0 || !BendingCell::exists(model, model.vertex_at(end))) return f;

  // Kelvin-Voigt part k (s.r) s with s, H the gradient and the Hessian of kappa_j, r the relative rates, k =
  // tau EI_j/l:
  //   by (e, theta)  k [(s.r) H + s (H r)^T],   by r  k s s^T.
  const BendingCell cell(model, instant, at, model.vertex_at(end));
  Vector4d rate;
  rate << f.edge_rate, at.rate[model.angle_of(e)] - f.spin.dot(f.tangent);
  const std::array<double, 2> stiffness = viscous_stiffness(model, cell);
  for (int j = 0; j < 2; ++j) {
    const BendingCell::Derivatives kappa = cell.differentiate(j);
    const Vector4d slope = end == End::left ? kappa.gradient.of_after() : kappa.gradient.of_before();
    const Matrix4d hessian = end == End::left ? kappa.hessian.of_after() : kappa.hessian.of_before();
    const double factor = stiffness[base::at(j)];
    f.force.head<4>() += factor * slope.dot(rate) * slope;
    f.by_place.topLeftCorner<4, 4>() +=
        factor * (slope.dot(rate) * hessian + slope * (hessian * rate).transpose());
    f.by_rate.topLeftCorner<4, 4>() += factor * slope * slope.transpose();
  }
  return f;
}

}  // namespace

Vector3d mount_moment(const RodModel& model, const RodInstant& instant, const DaePoint& at, End end) {
  const EdgeForce f = edge_force(model, instant, at, end);
  return f.edge.cross(f.force.head<3>()) + f.force[angle] * f.tangent;
}

// Turned together, edge and mount keep their energy: dE/d(turn of the mount) = -(e x g + t gamma) with the
// edge's force g and the angle's gamma; and g turns with both, so that a turn of the mount alone does what a
// turn of the edge the other way does.
MountCell mount_cell(const RodModel& model, const RodInstant& instant, const DaePoint& at, End end) {
  const EdgeForce f = edge_force(model, instant, at, end);
  const Vector3d g = f.force.head<3>();
  const double gamma = f.force[angle];
  const Matrix3d across = (Matrix3d::Identity() - f.tangent * f.tangent.transpose()) / f.length;  // dt/de

  // (g, gamma) by edge and angle at fixed e', theta' and w: the relative rates change by -w x de and -w.dt.
  Matrix6d rate_by_place = Matrix6d::Zero();
  rate_by_place.topLeftCorner<3, 3>() = -cross_matrix(f.spin);
  rate_by_place.block<1, 3>(angle, 0) = -f.spin.transpose() * across;
  const Matrix6d by_place = f.by_place + f.by_rate * rate_by_place;

  // What a turn phi and a spin of both would do: de = phi x e, dtheta = phi.t; d(relative e') = phi x
  // (relative e'); and the relative rates of a spin w of the mount alone are -w x e, -w.t.
  Turned turned = Turned::Zero(), turned_rate = Turned::Zero(), spun = Turned::Zero();
  turned.topRows<4>() << -cross_matrix(f.edge), f.tangent.transpose();
  turned_rate.topRows<3>() = -cross_matrix(f.edge_rate);
  spun.topRows<4>() << cross_matrix(f.edge), -f.tangent.transpose();

  // A turn of the mount alone: (phi x g, 0, 0) less what the turn of the edge does. The relative rates at
  // fixed spin, e' - w x e, have nothing that turns with the mount but are seen from it.
  Turned by_turn = -f.by_place * turned - f.by_rate * turned_rate;
  by_turn.topRows<3>() -= cross_matrix(g);
  const Turned by_spin = f.by_rate * spun;

  // M = e x g + gamma t:   dM = e x dg + dgamma t   and, by the edge,  -g x de + gamma dt.
  const auto moment = [&](const auto& change) {
    return (cross_matrix(f.edge) * change.template topRows<3>() + f.tangent * change.row(angle)).eval();
  };
  Eigen::Matrix<double, 3, count> by_edge = moment(by_place);
  by_edge.leftCols<3>() += -cross_matrix(g) + gamma * across;
  const Eigen::Matrix<double, 3, count> by_edge_rate = moment(f.by_rate);

  // From edge, angle and curvatures to the two vertices, the angle and the curvatures: e = sign (next -
  // mount).
  const double sign = end == End::left ? 1.0 : -1.0;
  const auto columns = [&](const Eigen::Matrix<double, 3, count>& m) {
    MountCell::ByUnknowns wide;
    wide << -sign * m.leftCols<3>(), sign * m.leftCols<3>(), m.rightCols<3>();
    return wide;
  };
  const auto rows = [&](const Turned& m) {
    MountCell::Rows tall;
    tall << -sign * m.topRows<3>(), sign * m.topRows<3>(), m.bottomRows<3>();
    return tall;
  };
  MountCell cell;
  cell.moment = f.edge.cross(g) + gamma * f.tangent;
  cell.moment_by_turn = moment(by_turn);
  cell.moment_by_spin = moment(by_spin);
  cell.moment_by = columns(by_edge);
  cell.moment_by_rate = columns(by_edge_rate);
  cell.rows_by_turn = rows(by_turn);
  cell.rows_by_spin = rows(by_spin);
  return cell;
}

}  // namespace snare::wire
