#include "wire/motion/rod_in_plane.hpp"

#include "base/index.hpp"
#include "numerics/lanes.hpp"
#include "wire/motion/edge_beam.hpp"
#include "wire/motion/rod_cells.hpp"
#include "wire/motion/stiffness_blocks.hpp"
#include "wire/motion/strand_friction.hpp"
#include "wire/motion/vertex_turning.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace snare::wire {

using Eigen::Vector2d;
using numerics::DaePoint;
using numerics::Lanes;

namespace {

using enum stiffness::Block;
using stiffness::entry;
using stiffness::entry_of_two;
using Row = RodRow;

/// How four vertices between the ends of a rod in a plane turn, from i on, as its rows have them, and what
/// they do to the edges: with the tangent t = (t_u, t_v) the angle of an edge changes by (-t_v, t_u)/length.
///                                                                                     theory.md (W.2), (W.3)
struct PlaneTurn {
  Lanes before_u, before_v, after_u, after_v;  ///< tangents
  Lanes inverse_a, inverse_b;                  ///< of the edges' lengths [1/m]
  Lanes kappa;                                 ///< 2 tan(phi/2) [-]
  Lanes slope;                                 ///< its derivative by phi

  [[gnu::always_inline]] PlaneTurn(const RodRows& rows, const RodPlane& plane, int i)
      : before_u(rows.at(Row::tangent + plane.axes[0], i - 1)),
        before_v(rows.at(Row::tangent + plane.axes[1], i - 1)),
        after_u(rows.at(Row::tangent + plane.axes[0], i)),
        after_v(rows.at(Row::tangent + plane.axes[1], i)),
        inverse_a(rows.at(Row::inverse_length, i - 1)),
        inverse_b(rows.at(Row::inverse_length, i)),
        kappa(2.0 * (before_u * after_v - before_v * after_u) /
              (1.0 + before_u * after_u + before_v * after_v)),
        slope(1.0 + 0.25 * kappa * kappa) {}

  /// phi [rad].
  [[nodiscard, gnu::always_inline]] Lanes angle() const {
    const Lanes u = 0.25 * kappa * kappa;
    if (numerics::all_below(u, turning::series)) return kappa * turning::of_small(u).value;
    return numerics::each(kappa, [](double k) { return 2.0 * std::atan(0.5 * k); });
  }
  /// Its rate [1/s].
  [[nodiscard, gnu::always_inline]] Lanes rate(const RodRows& rows, const RodPlane& plane, int i) const {
    const auto across = [&](const Lanes& u, const Lanes& v, int e) __attribute__((always_inline)) {
      const int du = Row::velocity + plane.axes[0], dv = Row::velocity + plane.axes[1];
      return u * (rows.at(dv, e + 1) - rows.at(dv, e)) - v * (rows.at(du, e + 1) - rows.at(du, e));
    };
    return across(after_u, after_v, i) * inverse_b - across(before_u, before_v, i - 1) * inverse_a;
  }
};

// Stretching (W.3) or the beam (W.32) of edges, and damping.
[[gnu::always_inline]] inline void work_on_edges(const RodModel& model, const RodPlane& plane, RodRows& rows,
                                                 const RodSums& out) {
  const int n = model.edges();
  const auto [u, v] = plane.axes;
  const int curvature = Row::curvature + plane.bending, by_curvature = Row::by_curvature + plane.bending;
  const double stiffness = model.properties().axial_stiffness;
  const double viscosity = model.damping().axial_time * stiffness;
  const double bending = bending_stiffness(model)[base::at(plane.bending)];
  const double natural = model.properties().natural_curvature[plane.bending];
  const double bent = 0.5 * bending * natural * natural;
  const auto step = [&](int row, int e) __attribute__((always_inline)) {
    return rows.at(row, e + 1) - rows.at(row, e);
  };
  Lanes energy = 0.0, power = 0.0;
  for (int e = 0; e < n; e += Lanes::count) {
    const Lanes rest = rows.at(Row::rest_length, e);
    const Lanes there = rows.at(Row::is_edge, e);
    const Lanes du = step(Row::place + u, e), dv = step(Row::place + v, e);
    const Lanes chord = numerics::sqrt(du * du + dv * dv);
    const Lanes inverse = 1.0 / chord;
    const Lanes tu = inverse * du, tv = inverse * dv;
    Lanes tension;
    if (model.is_curved()) {
      const BalancedBeam<Lanes> beam =
          balanced_beam<Lanes>(rest, chord, {rows.at(curvature, e), 0.0}, {rows.at(curvature, e + 1), 0.0},
                               stiffness, {bending, bending});
      tension = beam.tension;
      energy += there * (beam.energy + bent * rest);
      rows.add(by_curvature, e, there * beam.near[0]);
      rows.add(by_curvature, e + 1, there * beam.far[0]);
    } else {
      const Lanes strain = chord / rest - 1.0;
      tension = stiffness * strain;
      energy += there * (0.5 * stiffness * strain * strain * rest);
    }
    if (viscosity > 0.0) {
      const Lanes rate = (tu * step(Row::velocity + u, e) + tv * step(Row::velocity + v, e)) / rest;
      const Lanes viscous = viscosity * rate;
      power += there * (viscous * rate * rest);
      tension += viscous;
    }
    rows.set(Row::tension, e, tension);
    rows.set(Row::force + u, e, tension * tu);
    rows.set(Row::force + v, e, tension * tv);
    rows.set(Row::tangent + u, e, tu);
    rows.set(Row::tangent + v, e, tv);
    rows.set(Row::inverse_length, e, inverse);
  }
  out.assembly.energy += energy.sum();
  out.losses.power += power.sum();
  for (const int r : plane.axes)
    std::fill_n(rows.row(Row::tangent + r) + n, Lanes::count, rows.row(Row::tangent + r)[n - 1]);
}

// A vertex turns by phi with kappa = 2 tan(phi/2), kappa' = 1 + kappa^2/4, whose moment M = dE/dphi + tau
// EI/l kappa'^2 phi' acts across both edges (W.3): by the edge after (-t_v, t_u)/|b|, by the one before the
// same of it with the other sign.
[[gnu::always_inline]] inline void work_on_vertices(const RodModel& model, const RodPlane& plane,
                                                    const DaePoint& at, RodRows& rows, const RodSums& out) {
  const int n = model.edges();
  const auto [u, v] = plane.axes;
  const int bending = plane.bending;
  const double sign = plane.sign;
  const double stiffness = bending_stiffness(model)[base::at(bending)];
  const double natural = model.properties().natural_curvature[bending];
  const double time = model.damping().bending_time;
  Lanes energy = 0.0, power = 0.0;
  for (int i = 1; i < n; i += Lanes::count) {
    const Lanes there = rows.at(Row::is_inner, i);
    const PlaneTurn turn(rows, plane, i);
    const Lanes length = 0.5 * (rows.at(Row::rest_length, i - 1) + rows.at(Row::rest_length, i));
    Lanes moment;
    if (model.is_curved()) {
      // (W.31), (W.33): EI (k - n) phi.
      const Lanes angle = sign * turn.angle();
      const Lanes bent = stiffness * (rows.at(Row::curvature + bending, i) - natural);
      energy += there * (bent * angle);
      rows.add(Row::by_curvature + bending, i, there * (stiffness * angle));
      moment = sign * bent;
    } else {
      const Lanes strain = turn.kappa - (sign * natural) * length;
      const Lanes bent = stiffness / length * strain;
      energy += there * (0.5 * bent * strain);
      moment = bent * turn.slope;
    }
    if (model.bends_with_loss()) {
      const Lanes rate = turn.slope * turn.rate(rows, plane, i);
      Lanes lost = time / length * stiffness * rate;
      power += there * (lost * rate);
      if (model.strands().act()) {
        for (int k = 0; k < Lanes::count && i + k < n; ++k) {
          Vector2d rates = Vector2d::Zero();
          rates[bending] = sign * rate[k];
          lost.v[k] += sign * strand_moment(model, i + k, length[k], rates, at, out.losses)[bending];
        }
      }
      moment += lost * turn.slope;
    }
    const Lanes a = there * moment * turn.inverse_a, b = there * moment * turn.inverse_b;
    rows.add(Row::force + u, i - 1, a * turn.before_v);
    rows.add(Row::force + v, i - 1, -(a * turn.before_u));
    rows.add(Row::force + u, i, -(b * turn.after_v));
    rows.add(Row::force + v, i, b * turn.after_u);
  }
  out.assembly.energy += energy.sum();
  out.losses.power += power.sum();
}

// H = H_ll t t^T + N/l (I - t t^T) of an edge by itself, and its damping, see RodStiffness.
[[gnu::always_inline]] inline void differentiate_edges(const RodModel& model, const RodPlane& plane,
                                                       const RodRows& rows, RodRows& blocks) {
  const std::array<int, 2>& axes = plane.axes;
  const int j = plane.bending;
  const double stiffness = model.properties().axial_stiffness;
  const double viscosity = model.damping().axial_time * stiffness;
  const double bending = bending_stiffness(model)[base::at(j)];
  for (int e = 0; e < model.edges(); e += Lanes::count) {
    const Lanes there = rows.at(Row::is_edge, e);
    const Lanes rest = rows.at(Row::rest_length, e);
    const Lanes inverse = rows.at(Row::inverse_length, e);
    const Lanes chord = 1.0 / inverse;
    const std::array<Lanes, 2> t{rows.at(Row::tangent + axes[0], e), rows.at(Row::tangent + axes[1], e)};
    Lanes axial, tension;
    if (model.is_curved()) {
      const Pair<Lanes> near{rows.at(Row::curvature + j, e), 0.0},
          far{rows.at(Row::curvature + j, e + 1), 0.0};
      const BalancedBeam<Lanes> beam =
          balanced_beam<Lanes>(rest, chord, near, far, stiffness, {bending, bending});
      const BeamStiffness<Lanes> h = beam_stiffness<Lanes>(beam, rest, near, far, {bending, bending});
      axial = h.chord;
      tension = beam.tension;
      for (const std::size_t r : {0U, 1U}) {
        blocks.set(entry(near_curvature, axes[r], j), e, there * h.chord_near[0] * t[r]);
        blocks.set(entry(far_curvature, axes[r], j), e, there * h.chord_far[0] * t[r]);
      }
      blocks.add(entry_of_two(curvature, j, j), e, there * h.near[0][0]);
      blocks.add(entry_of_two(curvature, j, j), e + 1, there * h.far[0][0]);
      blocks.set(entry_of_two(next_curvature, j, j), e, there * h.next[0][0]);
    } else {
      axial = stiffness / rest;
      tension = stiffness * (chord / rest - 1.0);
    }
    Lanes across = there * tension * inverse;
    const Lanes along = there * axial - across;
    std::array<Lanes, 2> second{along * t[0], along * t[1]};
    Lanes viscous = 0.0;
    if (viscosity > 0.0) {
      viscous = there * (viscosity / rest);
      std::array<Lanes, 2> w;
      for (const std::size_t r : {0U, 1U})
        w[r] = rows.at(Row::velocity + axes[r], e + 1) - rows.at(Row::velocity + axes[r], e);
      const Lanes rate = t[0] * w[0] + t[1] * w[1];
      const Lanes of_rate = viscous * rate * inverse;
      for (const std::size_t r : {0U, 1U})
        second[r] += viscous * inverse * (w[r] - rate * t[r]) - of_rate * t[r];
      across += of_rate;
    }
    for (const std::size_t s : {0U, 1U}) {
      for (const std::size_t r : {0U, 1U}) {
        const Lanes value = t[r] * second[s];
        blocks.set(entry(own_place, axes[r], axes[s]), e, r == s ? value + across : value);
        blocks.set(entry(own_rate, axes[r], axes[s]), e, viscous * t[r] * t[s]);
      }
    }
  }
}

// With g and H the derivatives of phi by the edges, r the rates of these and h = H r: the moment M(phi) has
// M' g g^T + M H,  and damping Q = tau EI/l kappa'^2 phi' by the places  Q H + tau EI/l kappa'^2 (kappa phi'
// g g^T + g h^T)  and by the rates tau EI/l kappa'^2 g g^T.  Of an edge b at the angle alpha  dalpha/db =
// n/|b|,  d2alpha/db2 = -(n t^T + t n^T)/|b|^2.
[[gnu::always_inline]] inline void differentiate_vertices(const RodModel& model, const RodPlane& plane,
                                                          const RodRows& rows, RodRows& blocks) {
  const int n = model.edges();
  const std::array<int, 2>& axes = plane.axes;
  const int j = plane.bending;
  const double sign = plane.sign;
  const double stiffness = bending_stiffness(model)[base::at(j)];
  const double natural = model.properties().natural_curvature[j];
  const double time = model.damping().bending_time;
  for (int i = 1; i < n; i += Lanes::count) {
    const Lanes there = rows.at(Row::is_inner, i);
    const PlaneTurn turn(rows, plane, i);
    const Lanes length = 0.5 * (rows.at(Row::rest_length, i - 1) + rows.at(Row::rest_length, i));
    // Of the edge before and of the one after: t, g and H.
    const Lanes a = -turn.inverse_a, b = turn.inverse_b;
    const std::array<std::array<Lanes, 2>, 2> t{
        {{turn.before_u, turn.before_v}, {turn.after_u, turn.after_v}}};
    const std::array<std::array<Lanes, 2>, 2> g{
        {{-(a * turn.before_v), a * turn.before_u}, {-(b * turn.after_v), b * turn.after_u}}};
    const auto twice = [&](std::size_t edge, std::size_t r, std::size_t s) __attribute__((always_inline)) {
      const Lanes inverse = edge == 0 ? turn.inverse_a : turn.inverse_b;
      return -inverse * (g[edge][r] * t[edge][s] + t[edge][r] * g[edge][s]);
    };
    Lanes moment, slope = 0.0;
    if (model.is_curved()) {
      moment = sign * stiffness * (rows.at(Row::curvature + j, i) - natural);
      for (const std::size_t r : {0U, 1U}) {
        blocks.add(entry(far_curvature, axes[r], j), i - 1, there * (sign * stiffness) * g[0][r]);
        blocks.add(entry(near_curvature, axes[r], j), i, there * (sign * stiffness) * g[1][r]);
      }
    } else {
      const Lanes hinge = stiffness / length;
      const Lanes strain = turn.kappa - (sign * natural) * length;
      moment = hinge * strain * turn.slope;
      slope = hinge * (turn.slope * turn.slope + 0.5 * strain * turn.kappa * turn.slope);
    }
    Lanes viscosity = 0.0;
    std::array<std::array<Lanes, 2>, 2> turned;  // H r
    if (time > 0.0) {
      viscosity = time / length * stiffness * turn.slope * turn.slope;
      const Lanes rate = turn.rate(rows, plane, i);
      moment += viscosity * rate;
      slope += viscosity * turn.kappa * rate;
      for (const std::size_t edge : {0U, 1U}) {
        const int e = i - 1 + static_cast<int>(edge);
        std::array<Lanes, 2> w;
        for (const std::size_t r : {0U, 1U})
          w[r] = rows.at(Row::velocity + axes[r], e + 1) - rows.at(Row::velocity + axes[r], e);
        for (const std::size_t r : {0U, 1U})
          turned[edge][r] = twice(edge, r, 0) * w[0] + twice(edge, r, 1) * w[1];
      }
    }
    for (const std::size_t after_r : {0U, 1U}) {
      for (const std::size_t after_s : {0U, 1U}) {
        const bool own = after_r == after_s;
        const int place = own ? own_place : after_s == 1 ? next_place : last_place;
        const int rate = own ? own_rate : after_s == 1 ? next_rate : last_rate;
        const int edge = own && after_r == 1 ? i : i - 1;
        for (const std::size_t r : {0U, 1U}) {
          for (const std::size_t s : {0U, 1U}) {
            Lanes value = slope * g[after_r][r] * g[after_s][s];
            if (own) value += moment * twice(after_r, r, s);
            if (time > 0.0) {
              value += viscosity * g[after_r][r] * turned[after_s][s];
              blocks.add(entry(rate, axes[r], axes[s]), edge,
                         there * viscosity * g[after_r][r] * g[after_s][s]);
            }
            blocks.add(entry(place, axes[r], axes[s]), edge, there * value);
          }
        }
      }
    }
  }
}

[[gnu::always_inline]] inline void forces(const RodModel& model, const RodPlane& plane, const DaePoint& at,
                                          RodRows& rows, const RodSums& out) {
  work_on_edges(model, plane, rows, out);
  work_on_vertices(model, plane, at, rows, out);
}

// No product is joined with its sum in one rounding, so that all processors give the same bits.
[[gnu::target("avx2")]] void forces_by_four(const RodModel& model, const RodPlane& plane, const DaePoint& at,
                                            RodRows& rows, const RodSums& out) {
  forces(model, plane, at, rows, out);
}

[[gnu::always_inline]] inline void stiffness_of(const RodModel& model, const RodPlane& plane,
                                                const RodRows& rows, RodRows& blocks) {
  differentiate_edges(model, plane, rows, blocks);
  differentiate_vertices(model, plane, rows, blocks);
}

[[gnu::target("avx2")]] void stiffness_by_four(const RodModel& model, const RodPlane& plane,
                                               const RodRows& rows, RodRows& blocks) {
  stiffness_of(model, plane, rows, blocks);
}

}  // namespace

void work_out_forces(const RodModel& model, const RodPlane& plane, const DaePoint& at, bool four,
                     RodRows& rows, const RodSums& out) {
  four ? forces_by_four(model, plane, at, rows, out) : forces(model, plane, at, rows, out);
}

void work_out_stiffness(const RodModel& model, const RodPlane& plane, const RodRows& rows, bool four,
                        RodRows& blocks) {
  four ? stiffness_by_four(model, plane, rows, blocks) : stiffness_of(model, plane, rows, blocks);
}

}  // namespace snare::wire
