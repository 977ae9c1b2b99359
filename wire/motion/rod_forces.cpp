#include "wire/motion/rod_forces.hpp"

#include "numerics/lanes.hpp"
#include "wire/motion/bending_cell.hpp"
#include "wire/motion/curved_rod.hpp"
#include "wire/motion/edge_beam.hpp"
#include "wire/motion/rod_cells.hpp"
#include "wire/motion/rod_damping.hpp"
#include "wire/motion/rod_in_plane.hpp"
#include "wire/motion/strand_friction.hpp"
#include "wire/motion/vertex_turning.hpp"
#include "wire/twist.hpp"

#include <algorithm>

namespace snare::wire {

using Eigen::Vector2d;
using Eigen::Vector3d;
using numerics::DaePoint;
using numerics::Lanes;
using numerics::Lanes3;

namespace {

/// Damping and strands of a vertex at an end.
void add_bending_losses(const RodModel& model, const BendingCell& cell, int i, const DaePoint& at,
                        Eigen::VectorXd& gradient, RodLosses& losses) {
  const Vector2d rates = cell.curvature_rates();
  const std::array<double, 2> viscosity = viscous_stiffness(model, cell);
  Vector2d moments(viscosity[0] * rates[0], viscosity[1] * rates[1]);
  losses.power += moments.dot(rates);
  if (model.strands().act()) moments += strand_moment(model, i, cell.length, rates, at, losses);
  const WeightedCurvature curvature = cell.curvature(moments);
  // Of the mounts on the wire: what a turn of all that follows does, less at the left, which precedes (W.29).
  if (i == 0) losses.couples[index_of(End::left)] -= curvature.by_rotation();
  if (i == model.edges()) losses.couples[index_of(End::right)] += curvature.by_rotation();
  PairGradient g;
  curvature.add_gradient(cell.inverse, g);
  add_to_bands(model, i, g, 1.0, gradient);
}

}  // namespace

RodForces::RodForces(const RodModel& model, bool four) : four_(four), rows_(RodRow::count, model.vertices()) {
  const int n = model.edges();
  for (int i = 0; i < rows_.length(); ++i) {
    rows_.row(Row::rest_length)[i] = model.rest_length(std::min(i, n - 1));
    rows_.row(Row::is_edge)[i] = i < n ? 1.0 : 0.0;
    rows_.row(Row::is_inner)[i] = i > 0 && i < n ? 1.0 : 0.0;
    // Of no edge: along x and y.
    for (const int r : {+Row::old_tangent, Row::old_director + 1}) rows_.row(r)[i] = 1.0;
  }
}

void RodForces::restrict_to_plane(const std::optional<RodPlane>& plane) {
  plane_ = plane;
  // Nothing is computed across the plane.
  rows_.clear(Row::force, 3);
}

void RodForces::take_frames(const RodInstant& accepted) {
  for (std::size_t e = 0; e < accepted.state.frames.size(); ++e) {
    const Frame& frame = accepted.state.frames[e];
    for (int k = 0; k < 3; ++k) {
      rows_.row(Row::old_tangent + k)[e] = frame.tangent[k];
      rows_.row(Row::old_director + k)[e] = frame.director[k];
    }
  }
  std::ranges::copy(accepted.state.reference_twist, rows_.row(Row::old_twist));
}

void RodForces::take_unknowns(const RodModel& model, const DaePoint& at) {
  const int n = model.edges();
  const double* const x = at.y.data() + model.position_of(0);
  const double* const v = at.y.data() + model.velocity_of(0);
  for (int k = 0; k < 3; ++k) {
    double* const places = rows_.row(Row::place + k);
    double* const velocities = rows_.row(Row::velocity + k);
    for (int i = 0; i <= n; ++i) {
      places[i] = x[3 * i + k];
      velocities[i] = v[3 * i + k];
    }
    // What stands for no vertex continues as the last edge does.
    for (int i = n + 1; i < rows_.length(); ++i) places[i] = places[i - 1] + (places[n] - places[n - 1]);
  }
  std::copy_n(at.y.data() + model.angle_of(0), n, rows_.row(Row::theta));
  std::copy_n(at.rate.data() + model.angle_of(0), n, rows_.row(Row::theta_rate));
  if (!model.is_curved()) return;
  const double* const k = at.y.data() + model.curvature_of(0);
  for (int i = 0; i <= n; ++i) {
    rows_.row(Row::curvature)[i] = k[2 * i];
    rows_.row(Row::curvature + 1)[i] = k[2 * i + 1];
  }
}

// Frames go from the last accepted state to the point's; then what an edge does by its stretch and the bow of
// its beam.
[[gnu::always_inline]] inline void RodForces::work_on_edges(const RodModel& model, RodInstant& trial,
                                                            const RodSums& out) {
  const int n = model.edges();
  const double stiffness = model.properties().axial_stiffness;
  const double viscosity = model.damping().axial_time * stiffness;
  const Pair<double> bending = bending_stiffness(model);
  const Vector2d& natural = model.properties().natural_curvature;
  // Energy of natural curvature, a length of an edge (W.33).
  const double bent = 0.5 * (bending[0] * natural[0] * natural[0] + bending[1] * natural[1] * natural[1]);
  Lanes energy = 0.0, power = 0.0;
  for (int e = 0; e < n; e += Lanes::count) {
    const Lanes rest = rows_.at(Row::rest_length, e);
    const Lanes there = rows_.at(Row::is_edge, e);
    const Lanes3 d = rows_.at3(Row::place, e + 1) - rows_.at3(Row::place, e);
    const Lanes chord = numerics::sqrt(d.squaredNorm());
    const Lanes inverse = 1.0 / chord;
    const Lanes3 t = inverse * d;
    const Lanes3 carried =
        transported<Lanes>(rows_.at3(Row::old_director, e), rows_.at3(Row::old_tangent, e), t);
    const Lanes3 m1 = turned<Lanes>(carried, t, rows_.at(Row::theta, e));
    const Lanes3 m2 = t.cross(m1);
    // Stretching (W.3) or the beam (W.32), and its damping tau EA e' with e' = t.(v_{i+1} - v_i)/h (M.4).
    Lanes tension;
    if (model.is_curved()) {
      const BalancedBeam<Lanes> beam = balanced_beam<Lanes>(rest, chord, curvatures_at(rows_, e),
                                                            curvatures_at(rows_, e + 1), stiffness, bending);
      tension = beam.tension;
      energy += there * (beam.energy + bent * rest);
      for (const int j : {0, 1}) {
        rows_.add(Row::by_curvature + j, e, there * beam.near[base::at(j)]);
        rows_.add(Row::by_curvature + j, e + 1, there * beam.far[base::at(j)]);
      }
    } else {
      const Lanes strain = chord / rest - 1.0;
      tension = stiffness * strain;
      energy += there * (0.5 * stiffness * strain * strain * rest);
    }
    if (viscosity > 0.0) {
      const Lanes rate = t.dot(rows_.at3(Row::velocity, e + 1) - rows_.at3(Row::velocity, e)) / rest;
      const Lanes viscous = viscosity * rate;
      power += there * (viscous * rate * rest);
      tension += viscous;
    }
    rows_.set(Row::tension, e, tension);
    rows_.set(Row::force, e, tension * t);
    rows_.set(Row::tangent, e, t);
    rows_.set(Row::director, e, carried);
    rows_.set(Row::first, e, m1);
    rows_.set(Row::second, e, m2);
    rows_.set(Row::inverse_length, e, inverse);
  }
  out.assembly.energy += energy.sum();
  out.losses.power += power.sum();
  // What stands for no edge has the last one's directions: between any others there may be no turn.
  for (const int first : {+Row::tangent, +Row::director, +Row::first, +Row::second}) {
    for (int r = first; r < first + 3; ++r) std::fill_n(rows_.row(r) + n, Lanes::count, rows_.row(r)[n - 1]);
  }
  for (int e = 0; e < n; ++e) {
    const auto of_edge = [&](int r) {
      return Vector3d(rows_.row(r)[e], rows_.row(r + 1)[e], rows_.row(r + 2)[e]);
    };
    trial.state.frames[base::at(e)] = {of_edge(Row::tangent), of_edge(Row::director)};
    trial.directors[base::at(e)] = {of_edge(Row::first), of_edge(Row::second)};
    trial.inverse_lengths[base::at(e)] = rows_.row(Row::inverse_length)[e];
  }
}

// Twisting and bending of the vertices between the ends, all as one gradient by their two edges: of the
// cosine, of curvatures with the sum of their weights, of the twist. The moment M_j = tau EI_j/l kappa_j' +
// k_x m_j of damping and strands is one of these weights.
[[gnu::always_inline]] inline void RodForces::work_on_vertices(const RodModel& model, const DaePoint& at,
                                                               RodInstant& trial, const RodSums& out) {
  const int n = model.edges();
  const SpatialRodProperties& p = model.properties();
  const CellTerms terms(p, model.rod().strains());
  const Pair<double> stiffness = bending_stiffness(model);
  const double time = model.damping().bending_time;
  Lanes energy = 0.0, power = 0.0;
  for (int i = 1; i < n; i += Lanes::count) {
    rows_.set(Row::twist, i,
              twist_between<Lanes>(rows_.at3(Row::tangent, i - 1), rows_.at3(Row::director, i - 1),
                                   rows_.at3(Row::tangent, i), rows_.at3(Row::director, i),
                                   rows_.at(Row::old_twist, i)));
    auto [there, l, before, after, cell] = InnerCells(terms, rows_, i);
    Pair<Lanes> weights = cell.by_kappa;
    if (model.is_curved()) {
      // (W.31), (W.33): w_j phi_j with w_j = EI_j (k_j - n_j) and phi_j = f kappa_j.
      const TurningShare<Lanes> share = turning_share(cell.turn);
      const Pair<Lanes> kappa = curvature_pair(cell.turn, before, after);
      for (const int j : {0, 1}) {
        const std::size_t c = base::at(j);
        const Lanes moment = stiffness[c] * (rows_.at(Row::curvature + j, i) - p.natural_curvature[j]);
        const Lanes angle = share.value * kappa[c];
        cell.energy += moment * angle;
        cell.by_cosine += moment * kappa[c] * share.first;
        weights[c] = moment * share.value;
        rows_.add(Row::by_curvature + j, i, there * (stiffness[c] * angle));
      }
    }
    energy += there * cell.energy;
    if (model.bends_with_loss()) {
      const auto rate = [&](int k) __attribute__((always_inline)) {
        return rows_.at3(Row::velocity, k + 1) - rows_.at3(Row::velocity, k);
      };
      const Pair<Lanes> rates = curvature_rates<Lanes>(
          cell.turn, before, after, cell.inverse.a * rate(i - 1), cell.inverse.b * rate(i),
          rows_.at(Row::theta_rate, i - 1), rows_.at(Row::theta_rate, i));
      const Lanes by_length = time / l;
      for (std::size_t j = 0; j < 2; ++j) {
        const Lanes moment = by_length * stiffness[j] * rates[j];
        weights[j] += moment;
        power += there * (moment * rates[j]);
      }
      if (model.strands().act()) {
        for (int k = 0; k < Lanes::count && i + k < n; ++k) {
          const Vector2d moment =
              strand_moment(model, i + k, l[k], {rates[0][k], rates[1][k]}, at, out.losses);
          weights[0].v[k] += moment[0];
          weights[1].v[k] += moment[1];
        }
      }
    }
    PairGradientOf<Lanes> g;
    add_cosine_gradient<Lanes>(cell.turn, cell.inverse, there * cell.by_cosine, g);
    add_twist_gradient<Lanes>(cell.turn, cell.inverse, there * cell.torque, g);
    WeightedCurvatureOf<Lanes>(cell.turn, before, after, there * weights[0], there * weights[1])
        .add_gradient(cell.inverse, g);
    rows_.add(Row::force, i - 1, g.a);
    rows_.add(Row::force, i, g.b);
    rows_.add(Row::torque, i - 1, g.theta_a);
    rows_.add(Row::torque, i, g.theta_b);
  }
  out.assembly.energy += energy.sum();
  out.losses.power += power.sum();
  std::copy_n(rows_.row(Row::twist) + 1, n - 1, trial.state.reference_twist.begin() + 1);
}

[[gnu::always_inline]] inline void RodForces::work(const RodModel& model, const DaePoint& at,
                                                   RodInstant& trial, const RodSums& out) {
  work_on_edges(model, trial, out);
  work_on_vertices(model, at, trial, out);
}

// No product is joined with its sum in one rounding, so that all processors give the same bits.
[[gnu::target("avx2")]] void RodForces::evaluate_avx2(const RodModel& model, const DaePoint& at,
                                                      RodInstant& trial, const RodSums& out) {
  work(model, at, trial, out);
}

void RodForces::work_by_two(const RodModel& model, const DaePoint& at, RodInstant& trial,
                            const RodSums& out) {
  work(model, at, trial, out);
}

// Directors stay across the plane, or across the tangent in it.
void RodForces::turn_frames(RodInstant& trial) const {
  const auto [u, v] = plane_->axes;
  const bool stands_across = plane_->bending == 1;
  Vector3d director = Vector3d::Zero();
  director[plane_->normal] = -plane_->sign;
  for (std::size_t e = 0; e < trial.state.frames.size(); ++e) {
    Vector3d tangent = Vector3d::Zero();
    tangent[u] = rows_.row(Row::tangent + u)[e];
    tangent[v] = rows_.row(Row::tangent + v)[e];
    if (!stands_across) {
      director[u] = -plane_->sign * tangent[v];
      director[v] = plane_->sign * tangent[u];
      director[plane_->normal] = 0.0;
    }
    trial.state.frames[e] = {tangent, director};
    trial.directors[e] = {director, tangent.cross(director)};
    trial.inverse_lengths[e] = rows_.row(Row::inverse_length)[e];
  }
}

// From edges to vertices: what pulls at the edge behind and at the one before, and half the weight of both
// (W.8).
void RodForces::gather(const RodModel& model, const RodSums& out) {
  constexpr int block = RodModel::block;
  const int n = model.edges();
  const Vector3d& weight = model.properties().weight;
  double* const g = out.assembly.gradient.data();
  for (int k = 0; k < 3; ++k) {
    const double* const f = rows_.row(Row::force + k);
    g[k] = -f[0];
    for (int i = 1; i < n; ++i) g[block * i + k] = f[i - 1] - f[i];
    g[block * n + k] = f[n - 1];
  }
  for (int i = 0; i < n; ++i) g[block * i + RodModel::angle] = rows_.row(Row::torque)[i];
  g[block * n + RodModel::angle] = 0.0;
  if (!weight.isZero(0.0)) {
    for (int i = 0; i <= n; ++i) {
      const double length = model.mass_of(i) / model.constants().mass_per_length;
      for (int k = 0; k < 3; ++k) {
        g[block * i + k] -= length * weight[k];
        out.assembly.energy -= length * weight[k] * rows_.row(Row::place + k)[i];
      }
    }
  }
  for (int i = 0; model.is_curved() && i <= n; ++i)
    out.by_curvature.col(i) = Vector2d(rows_.row(Row::by_curvature)[i], rows_.row(Row::by_curvature + 1)[i]);
}

void RodForces::add_end(const RodModel& model, const DaePoint& at, RodInstant& trial, End end,
                        const RodSums& out) {
  const int i = model.vertex_at(end);
  SpatialState& state = trial.state;
  const std::optional<Frame>& mount = end == End::left ? state.left_mount : state.right_mount;
  double& twist = state.reference_twist[base::at(i)];
  if (mount && end == End::left)
    twist = reference_twist(*mount, state.frames.front(), rows_.row(Row::old_twist)[i]);
  if (mount && end == End::right)
    twist = reference_twist(state.frames.back(), *mount, rows_.row(Row::old_twist)[i]);
  model.rod().add_end_forces(state, end, out.assembly);
  if (!BendingCell::exists(model, i)) {
    if (model.is_curved())
      out.by_curvature.col(i) = at.y.segment<2>(model.curvature_of(i)) - model.properties().natural_curvature;
    return;
  }
  if (!model.bends_with_loss() && !model.is_curved()) return;
  const BendingCell cell(model, trial, at, i);
  if (model.is_curved()) add_curved_vertex(model, cell, i, at, out.assembly, out.by_curvature);
  if (model.bends_with_loss()) add_bending_losses(model, cell, i, at, out.assembly.gradient, out.losses);
}

void RodForces::evaluate(const RodModel& model, const DaePoint& at, RodInstant& trial, const RodSums& out) {
  const int n = model.edges();
  take_unknowns(model, at);
  rows_.clear(Row::torque, 1);
  rows_.clear(Row::by_curvature, 2);
  out.assembly.energy = 0.0;
  out.assembly.gradient.resize(model.bands());
  if (model.is_curved()) out.by_curvature.resize(2, n + 1);
  out.losses.power = out.losses.strand_energy = 0.0;
  out.losses.couples = {Vector3d::Zero(), Vector3d::Zero()};
  out.losses.strand_rates.assign(base::at(n + 1), Vector2d::Zero());
  if (plane_) {
    work_out_forces(model, *plane_, at, four_, rows_, out);
    turn_frames(trial);
  } else {
    four_ ? evaluate_avx2(model, at, trial, out) : work_by_two(model, at, trial, out);
  }
  gather(model, out);
  for (const End end : ends) add_end(model, at, trial, end, out);
}

}  // namespace snare::wire
