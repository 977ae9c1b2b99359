#include "wire/motion/strand_friction.hpp"

#include "base/index.hpp"

#include <array>

namespace snare::wire {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Vector2d;

StrandResponse::StrandResponse(const RodStrands& s, const Vector2d& held, const Vector2d& curvature_rate) {
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

Vector2d strand_moment(const RodModel& model, int i, double length, const Vector2d& rates,
                       const numerics::DaePoint& at, RodLosses& losses) {
  const Vector2d held = at.y.segment<2>(model.strand_of(i));
  const StrandResponse s(model.strands(), held, rates / length);
  losses.strand_rates[base::at(i)] = s.rate;
  const double stiffness = model.strands().extra_stiffness * length;
  losses.strand_energy += 0.5 * stiffness * held.squaredNorm();
  // The dashpot's heat k_x tau |z'|^2 l and that of the sliding, k_x m.(kappa' - l z').
  losses.power +=
      stiffness * model.strands().time * s.rate.squaredNorm() + s.moment.dot(rates - length * s.rate);
  return s.moment;
}

void add_resting_strands_jacobian(const RodModel& model, int i, double c, const RodSlots& slots,
                                  std::vector<double>& values) {
  const int z = model.strand_of(i);
  slots.add(z, z, c, values);
  slots.add(z + 1, z + 1, c, values);
}

// With g_j and H_j the gradient and the Hessian of kappa_j, r the rates, kappa_j' = g_j.r and S = dm/de:
//   rows of z, z' - (m - z)/tau:   by z_k    -(S_jk - delta_jk)/tau   and c on the diagonal,
//                                  by places -S_jk/l H_k r,   by rates -S_jk/l g_k;
//   balances, k_x sum_j m_j g_j:   by z_k    k_x S_jk g_j,
//                                  by places k_x [m_j H_j + tau/l S_jk g_j (H_k r)^T],   by rates k_x tau/l
//                                    S_jk g_j g_k^T.
void add_strands_jacobian(const RodModel& model, const BendingCell& cell, int i, const numerics::DaePoint& at,
                          double c, const RodSlots& slots, std::vector<double>& values) {
  add_resting_strands_jacobian(model, i, c, slots, values);
  const int z = model.strand_of(i);
  const RodStrands& s = model.strands();
  // The last angle belongs to no edge: the mount's stands in its place.
  const int columns = model.bands() - 1;
  std::array<CellVector, 2> slope;    // g_j
  std::array<CellMatrix, 2> hessian;  // H_j
  std::array<CellVector, 2> turning;  // H_j r: of kappa_j' by the places
  Vector2d rates;
  for (std::size_t j = 0; j < 2; ++j) {
    const BendingCell::Derivatives kappa = cell.differentiate(static_cast<int>(j));
    slope[j] = to_cell(kappa.gradient);
    hessian[j] = to_cell(kappa.hessian);
    turning[j] = hessian[j] * cell.rate;
    rates[static_cast<Index>(j)] = slope[j].dot(cell.rate);
  }
  const StrandResponse strands(s, at.y.segment<2>(z), rates / cell.length);
  CellMatrix by_place = strands.moment[0] * hessian[0] + strands.moment[1] * hessian[1];
  CellMatrix by_rate = CellMatrix::Zero();
  for (std::size_t j = 0; j < 2; ++j) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double share = strands.by_reach(static_cast<Index>(j), static_cast<Index>(k));
      const double factor = s.extra_stiffness * s.time / cell.length * share;
      by_place += factor * slope[j] * turning[k].transpose();
      by_rate += factor * slope[j] * slope[k].transpose();
      const int row = z + static_cast<int>(j);
      const int column = z + static_cast<int>(k);
      slots.add(row, column, -(share - (j == k ? 1.0 : 0.0)) / s.time, values);
      for (int a = 0; a < CellRows::count; ++a) {
        const int band = CellRows::first_band(i) + a;
        if (band < 0 || band >= columns) continue;
        const bool angle = RodModel::is_angle(band);
        const double place = -share / cell.length * turning[k][a];
        const double rate = -share / cell.length * slope[k][a];
        slots.add(row, model.unknown_of(band), place + (angle ? c * rate : 0.0), values);
        if (!angle) slots.add(row, model.rate_of(band), rate, values);
        if (slots.has_balance(band))
          slots.add(model.balance_of(band), column, s.extra_stiffness * share * slope[j][a], values);
      }
    }
  }
  slots.add_cell(i, by_place, by_rate, c, values);
}

}  // namespace snare::wire
