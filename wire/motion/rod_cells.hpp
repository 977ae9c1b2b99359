#pragma once

#include "wire/motion/rod_model.hpp"
#include "wire/motion/rod_rows.hpp"
#include "wire/spatial_cell.hpp"

namespace snare::wire {

/// Four vertices between the ends of a rod in motion, from i on, as its rows have them: their twisting, what
/// they bend about, and bending of rods whose vertices have it.
struct InnerCells {
  numerics::Lanes there;   ///< 1, or 0 where no vertex is
  numerics::Lanes length;  ///< of the cells [m]
  DirectorsOf<numerics::Lanes> before, after;
  SpatialCellOf<numerics::Lanes> cell;

  [[gnu::always_inline]] InnerCells(const CellTerms& terms, const RodRows& rows, int i)
      : there(rows.at(RodRow::is_inner, i)),
        length(0.5 * (rows.at(RodRow::rest_length, i - 1) + rows.at(RodRow::rest_length, i))),
        before{rows.at3(RodRow::first, i - 1), rows.at3(RodRow::second, i - 1)},
        after{rows.at3(RodRow::first, i), rows.at3(RodRow::second, i)} {
    using numerics::Lanes;
    cell.turn = make_turn<Lanes>(rows.at3(RodRow::tangent, i - 1), rows.at3(RodRow::tangent, i));
    cell.inverse = {rows.at(RodRow::inverse_length, i - 1), rows.at(RodRow::inverse_length, i)};
    const Lanes tau = rows.at(RodRow::theta, i) - rows.at(RodRow::theta, i - 1) + rows.at(RodRow::twist, i);
    add_twisting<Lanes>(tau, length, 0.0, terms, cell);
    if (terms.bends) add_bending<Lanes>(before, after, length, 0.0, terms, cell);
  }
};

/// EI_1, EI_2 of a rod [N m^2].
[[nodiscard]] inline Pair<double> bending_stiffness(const RodModel& model) {
  return {model.properties().bending_stiffness, model.properties().second_bending_stiffness};
}

/// Curvatures k of four vertices of a rod of higher order [1/m].
[[nodiscard, gnu::always_inline]] inline Pair<numerics::Lanes> curvatures_at(const RodRows& rows, int i) {
  return {rows.at(RodRow::curvature, i), rows.at(RodRow::curvature + 1, i)};
}

}  // namespace snare::wire
