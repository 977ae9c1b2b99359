#include "wire/motion/curved_rod.hpp"

#include "wire/motion/vertex_turning.hpp"

#include <optional>

namespace snare::wire {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using numerics::DaePoint;

namespace {

Vector2d stiffness_of(const RodModel& model) {
  return {model.properties().bending_stiffness, model.properties().second_bending_stiffness};
}

/// 1/k_mount of the mount at vertex i [rad/(N m)]; 0 elsewhere.
double flexibility_at(const RodModel& model, int i) {
  const std::optional<End> end = model.end_of(i);
  return end ? 1.0 / model.properties().end(*end).rotational_stiffness : 0.0;
}

EdgeBeam beam_of(const RodModel& model, const RodInstant& instant, const Vector2d& near, const Vector2d& far,
                 int e) {
  const double chord = (vertex(instant.state, e + 1) - vertex(instant.state, e)).norm();
  return edge_beam({model.rest_length(e), model.properties().axial_stiffness, stiffness_of(model)}, chord,
                   near, far);
}

}  // namespace

void add_curved_vertex(const RodModel& model, const BendingCell& cell, int i, const DaePoint& at,
                       RodAssembly& out, Matrix2Xd& by_curvature) {
  const VertexTurning turning(cell);
  const Vector2d moment = curved_moments(model, at, i);
  const double flexibility = flexibility_at(model, i);
  out.energy += moment.dot(turning.angles()) - 0.5 * flexibility * moment.squaredNorm();
  by_curvature.col(i) += stiffness_of(model).cwiseProduct(turning.angles() - flexibility * moment);
  add_to_bands(model, i, turning.gradient(moment), 1.0, out.gradient);
}

CurvedEnd curved_end(const RodModel& model, const RodInstant& instant, const DaePoint& at, End end) {
  CurvedEnd result;
  const int i = model.vertex_at(end);
  if (!BendingCell::exists(model, i)) return result;
  const auto of_edge = [end](const auto& g) { return end == End::left ? g.of_after() : g.of_before(); };
  const BendingCell cell(model, instant, at, i);
  const VertexTurning turning(cell);
  const Vector2d stiffness = stiffness_of(model);
  const Vector2d moment = curved_moments(model, at, i);
  const double flexibility = flexibility_at(model, i);
  result.gradient << of_edge(turning.gradient(moment)),
      stiffness.cwiseProduct(turning.angles() - flexibility * moment);
  result.hessian.topLeftCorner<4, 4>() = of_edge(turning.hessian(moment));
  for (int j = 0; j < 2; ++j) {
    result.hessian.col(4 + j).head<4>() = of_edge(turning.gradient(stiffness[j] * Vector2d::Unit(j)));
    result.hessian.row(4 + j).head<4>() = result.hessian.col(4 + j).head<4>().transpose();
    result.hessian(4 + j, 4 + j) = -flexibility * stiffness[j] * stiffness[j];
  }
  return result;
}

Vector3d curved_end_moment(const RodModel& model, const RodInstant& instant, const DaePoint& at, End end) {
  const int i = model.vertex_at(end);
  if (!BendingCell::exists(model, i)) return Vector3d::Zero();
  const BendingCell cell(model, instant, at, i);
  return VertexTurning(cell).by_rotation(curved_moments(model, at, i));
}

Vector2d curved_moments(const RodModel& model, const DaePoint& at, int vertex) {
  return stiffness_of(model).cwiseProduct(at.y.segment<2>(model.curvature_of(vertex)) -
                                          model.properties().natural_curvature);
}

// Newton's method on dE/dk = 0, whose matrix has a band of two vertices and is negative definite near the
// solution: it begins from the turn at each vertex over half of the neighbouring edges. (From a straight wire
// a stiff and coarse one would find edges that are short because they are compressed.)
Matrix2Xd balanced_curvatures(const RodModel& model, const RodInstant& instant, const DaePoint& at) {
  const int n = model.edges();
  const Vector2d stiffness = stiffness_of(model);
  const Vector2d& natural = model.properties().natural_curvature;
  Matrix2Xd k = natural.replicate(1, n + 1);
  Matrix2Xd angles = Matrix2Xd::Zero(2, n + 1);
  for (int i = 0; i <= n; ++i) {
    if (!BendingCell::exists(model, i)) continue;
    const BendingCell cell(model, instant, at, i);
    angles.col(i) = VertexTurning(cell).angles();
    double length = 0.0;
    if (i > 0) length += 0.5 * model.rest_length(i - 1);
    if (i < n) length += 0.5 * model.rest_length(i);
    const double flexibility = flexibility_at(model, i);
    k.col(i) += (angles.col(i).array() / (length + flexibility * stiffness.array())).matrix();
  }
  numerics::SymmetricBandMatrix matrix(2 * (n + 1), 3);
  numerics::BandLdlt factor;
  constexpr int most = 30;
  for (int iteration = 0; iteration < most; ++iteration) {
    matrix.set_zero();
    Matrix2Xd rows = Matrix2Xd::Zero(2, n + 1);
    for (int e = 0; e < n; ++e) {
      const EdgeBeam beam = beam_of(model, instant, k.col(e), k.col(e + 1), e);
      rows.col(e) += beam.gradient.segment<2>(EdgeBeam::near);
      rows.col(e + 1) += beam.gradient.segment<2>(EdgeBeam::far);
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b <= a; ++b) matrix.lower(2 * e + a, 2 * e + b) += beam.hessian(1 + a, 1 + b);
      }
    }
    for (int i = 0; i <= n; ++i) {
      if (!BendingCell::exists(model, i)) {
        rows.col(i).setZero();
        matrix.hold(2 * i);
        matrix.hold(2 * i + 1);
        continue;
      }
      const double flexibility = flexibility_at(model, i);
      const Vector2d moment = stiffness.cwiseProduct(k.col(i) - natural);
      rows.col(i) += stiffness.cwiseProduct(angles.col(i) - flexibility * moment);
      for (int j = 0; j < 2; ++j)
        matrix.lower(2 * i + j, 2 * i + j) -= flexibility * stiffness[j] * stiffness[j];
    }
    if (!factor.factorize(matrix)) break;
    Eigen::MatrixXd step = rows.reshaped();
    factor.solve(step);
    k.reshaped() -= step;
    if (step.norm() <= 1e-12 * k.norm()) break;
  }
  return k;
}

}  // namespace snare::wire
