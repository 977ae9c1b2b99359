#include "wire/motion/rod_damping.hpp"

namespace snare::wire {

using Eigen::Vector3d;
using numerics::DaePoint;

std::array<double, 2> viscous_stiffness(const RodModel& model, const BendingCell& cell) {
  const double time = model.damping().bending_time;
  return {time * model.properties().bending_stiffness / cell.length,
          time * model.properties().second_bending_stiffness / cell.length};
}

// D = 1/2 k kappa'^2 with k = tau EI_j/l and kappa' = g.r, g and H the gradient and the Hessian of kappa_j, r
// the rates of what it depends on. The rows k (g.r) g have the derivatives
//   by the places  k [(g.r) H + g (H r)^T],   by the rates  k g g^T,
// and where a mount spins, r also changes with the places.
void add_bending_damping_jacobian(const RodModel& model, const BendingCell& cell, int i, double c,
                                  const RodSlots& slots, std::vector<double>& values) {
  const std::array<double, 2> stiffness = viscous_stiffness(model, cell);
  const Vector3d middle = cell.rate.segment<3>(CellRows::middle);
  const Vector3d a = middle - cell.rate.segment<3>(CellRows::before);
  const Vector3d b = cell.rate.segment<3>(CellRows::after) - middle;
  PairHessian turned;  // sum k (g.r) H
  RodSlots::CellProducts products;
  for (std::size_t j = 0; j < 2; ++j) {
    const BendingCell::Derivatives kappa = cell.differentiate(static_cast<int>(j));
    products.rate[j] = to_cell(kappa.gradient);
    products.force[j] = stiffness[j] * products.rate[j];
    products.place[j] = to_cell(product<double>(kappa.hessian, a, b, cell.rate[CellRows::angle_before],
                                                cell.rate[CellRows::angle_after]));
    add_scaled(kappa.hessian, products.force[j].dot(cell.rate), turned);
  }
  products.m = to_cell(turned);
  if (model.end_of(i)) {
    for (std::size_t j = 0; j < 2; ++j)
      products.place[j] += (products.rate[j].transpose() * cell.rate_by_place()).transpose();
  }
  slots.add_cell(i, products, c, values);
}

}  // namespace snare::wire
