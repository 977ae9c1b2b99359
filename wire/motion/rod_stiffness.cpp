#include "wire/motion/rod_stiffness.hpp"

#include "wire/motion/bending_cell.hpp"
#include "wire/motion/curved_rod.hpp"
#include "wire/motion/edge_beam.hpp"
#include "wire/motion/rod_cells.hpp"
#include "wire/motion/rod_in_plane.hpp"
#include "wire/motion/stiffness_blocks.hpp"
#include "wire/motion/vertex_turning.hpp"
#include "wire/twist.hpp"

#include <type_traits>
#include <utility>

namespace snare::wire {

using numerics::Lanes;
using numerics::Lanes3;

namespace {

using enum stiffness::Block;
using stiffness::entry;
using stiffness::entry_of_two;
using stiffness::of_angle;

/// What a vertex's forces are by two edges and their angles: 0 to 2 the edge before, 3 its angle, 4 to 6 the
/// edge after, 7 its angle.
using PairVector = std::array<Lanes, 8>;

[[nodiscard, gnu::always_inline]] inline PairVector listed(const PairGradientOf<Lanes>& g) {
  return {g.a[0], g.a[1], g.a[2], g.theta_a, g.b[0], g.b[1], g.b[2], g.theta_b};
}

[[nodiscard, gnu::always_inline]] inline PairVector scaled(const Lanes& factor, const PairVector& v) {
  PairVector w;
  for (std::size_t k = 0; k < v.size(); ++k) w[k] = factor * v[k];
  return w;
}

/// H_rs of a Hessian, in the order of a PairVector.
template <int r, int s>
[[nodiscard, gnu::always_inline]] inline Lanes entry_of(const PairHessianOf<Lanes>& h) {
  constexpr bool after_r = r > of_angle, after_s = s > of_angle;
  constexpr int k = r % 4, m = s % 4;
  if constexpr (k == of_angle && m != of_angle)
    return entry_of<s, r>(h);
  else if constexpr (k == of_angle)
    return after_r != after_s ? h.theta_ab : after_r ? h.theta_bb : h.theta_aa;
  else if constexpr (m == of_angle)
    return after_r ? (after_s ? h.b_theta_b[k] : h.b_theta_a[k])
                   : (after_s ? h.a_theta_b[k] : h.a_theta_a[k]);
  else if constexpr (after_r)
    return after_s ? h.bb(k, m) : h.ab(m, k);
  else
    return after_s ? h.ab(k, m) : h.aa(k, m);
}

/// Calls work(k) for k = 0 to count - 1, each a constant.
template <int count, class Work>
[[gnu::always_inline]] inline void unrolled(const Work& work) {
  [&]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) {
    (work(std::integral_constant<int, k>()), ...);
  }
  (std::make_integer_sequence<int, count>());
}

}  // namespace

RodStiffness::RodStiffness(const RodModel& model, bool four)
    : four_(four), blocks_(stiffness::Block::blocks, model.vertices()) {}

// An edge by itself: (W.3) or the beam (W.32) with H = H_ll t t^T + N/l (I - t t^T), and its damping. f t
// with f = tau EA e' by the edge d and by w = v_{i+1} - v_i:
//   d(f t)/dd = tau EA/h [t (P w)^T + (t.w) P],   d(f t)/dw = tau EA/h t t^T,   P = (I - t t^T)/|d|.
[[gnu::always_inline]] inline void RodStiffness::work_on_edges(const RodModel& model, const Point& point) {
  const RodRows& rows = point.rows;
  const double stiffness = model.properties().axial_stiffness;
  const double viscosity = model.damping().axial_time * stiffness;
  const Pair<double> bending = bending_stiffness(model);
  for (int e = 0; e < model.edges(); e += Lanes::count) {
    const Lanes there = rows.at(RodRow::is_edge, e);
    const Lanes rest = rows.at(RodRow::rest_length, e);
    const Lanes inverse = rows.at(RodRow::inverse_length, e);
    const Lanes chord = 1.0 / inverse;
    const Lanes3 t = rows.at3(RodRow::tangent, e);
    Lanes axial, tension;
    if (model.is_curved()) {
      const Pair<Lanes> near = curvatures_at(rows, e), far = curvatures_at(rows, e + 1);
      const BalancedBeam<Lanes> beam = balanced_beam<Lanes>(rest, chord, near, far, stiffness, bending);
      const BeamStiffness<Lanes> h = beam_stiffness<Lanes>(beam, rest, near, far, bending);
      axial = h.chord;
      tension = beam.tension;
      for (const int j : {0, 1}) {
        const std::size_t m = base::at(j);
        for (const int r : {0, 1, 2}) {
          blocks_.set(entry(near_curvature, r, j), e, there * h.chord_near[m] * t[r]);
          blocks_.set(entry(far_curvature, r, j), e, there * h.chord_far[m] * t[r]);
        }
        for (const int k : {0, 1}) {
          blocks_.add(entry_of_two(curvature, k, j), e, there * h.near[base::at(k)][m]);
          blocks_.add(entry_of_two(curvature, k, j), e + 1, there * h.far[base::at(k)][m]);
          blocks_.set(entry_of_two(next_curvature, k, j), e, there * h.next[base::at(k)][m]);
        }
      }
    } else {
      axial = stiffness / rest;
      tension = stiffness * (chord / rest - 1.0);
    }
    // By the edge, rows r and columns s: first_r t_s + t_r second_s + across delta_rs.
    Lanes across = there * tension * inverse;
    const Lanes along = there * axial - across;
    Lanes3 second = along * t;
    Lanes viscous = 0.0;
    if (viscosity > 0.0) {
      viscous = there * (viscosity / rest);
      const Lanes3 w = rows.at3(RodRow::velocity, e + 1) - rows.at3(RodRow::velocity, e);
      const Lanes rate = t.dot(w);
      const Lanes of_rate = viscous * rate * inverse;
      second += (viscous * inverse) * (w - rate * t) - of_rate * t;
      across += of_rate;
    }
    for (const int s : {0, 1, 2}) {
      for (const int r : {0, 1, 2}) {
        const Lanes value = t[r] * second[s];
        blocks_.set(entry(own_place, r, s), e, r == s ? value + across : value);
        blocks_.set(entry(own_rate, r, s), e, viscous * t[r] * t[s]);
      }
    }
  }
}

// A vertex between the ends by its two edges. With g_j and H_j the gradient and the Hessian of kappa_j, r the
// rates of what it depends on and k_j = tau EI_j/l, damping has by the places  sum_j k_j [(g_j.r) H_j + g_j
// (H_j r)^T]  and by the rates sum_j k_j g_j g_j^T; of higher order w.phi has  sum_j f w_j H_j + (f' d2c +
// f'' dc dc^T) kappa + f' (dc dkappa^T + dkappa dc^T) with kappa = w.kappa.
[[gnu::always_inline]] inline void RodStiffness::work_on_vertices(const RodModel& model, const Point& point) {
  const RodRows& rows = point.rows;
  const int n = model.edges();
  const SpatialRodProperties& p = model.properties();
  const CellTerms terms(p, model.rod().strains());
  const Pair<double> stiffness = bending_stiffness(model);
  const double time = model.damping().bending_time;
  const bool by_kappa = model.is_curved() || terms.directed || time > 0.0;
  for (int i = 1; i < n; i += Lanes::count) {
    const InnerCells inner(terms, rows, i);
    const Lanes there = inner.there;
    const DirectorsOf<Lanes>&before = inner.before, &after = inner.after;
    const SpatialCellOf<Lanes>& cell = inner.cell;
    PairHessianOf<Lanes> h;
    add_twist_hessian<Lanes>(cell.turn, cell.inverse, cell.torque, cell.twist_stiffness, h);
    if (terms.bends)
      add_cosine_hessian<Lanes>(cell.turn, cell.inverse, cell.by_cosine, cell.by_cosine_twice, h);
    // Products of vectors that are added: left right^T.
    std::array<PairVector, 4> left{}, right{};
    std::array<PairVector, 2> slope{};
    Pair<Lanes> viscosity{0.0, 0.0};
    if (by_kappa) {
      const Lanes3 rate_a = rows.at3(RodRow::velocity, i) - rows.at3(RodRow::velocity, i - 1);
      const Lanes3 rate_b = rows.at3(RodRow::velocity, i + 1) - rows.at3(RodRow::velocity, i);
      const Lanes turn_a = rows.at(RodRow::theta_rate, i - 1), turn_b = rows.at(RodRow::theta_rate, i);
      const Pair<Lanes> kappa = curvature_pair(cell.turn, before, after);
      const TurningShare<Lanes> share = turning_share(cell.turn);
      const Lanes by_length = time / inner.length;
      PairGradientOf<Lanes> whole;  // of w.kappa
      Lanes of_turning = 0.0;       // w.kappa
      for (std::size_t j = 0; j < 2; ++j) {
        const WeightedCurvatureOf<Lanes> of(cell.turn, before, after, j == 0 ? 1.0 : 0.0, j == 0 ? 0.0 : 1.0);
        PairGradientOf<Lanes> g;
        PairHessianOf<Lanes> m;
        of.add_gradient(cell.inverse, g);
        of.add_hessian(cell.inverse, m);
        slope[j] = listed(g);
        viscosity[j] = by_length * stiffness[j];
        const Lanes rate = g.a.dot(rate_a) + g.b.dot(rate_b) + g.theta_a * turn_a + g.theta_b * turn_b;
        Lanes weight = viscosity[j] * rate;
        if (model.is_curved()) {
          const Lanes moment = stiffness[j] * (rows.at(RodRow::curvature + static_cast<int>(j), i) -
                                               p.natural_curvature[static_cast<Eigen::Index>(j)]);
          weight += moment * share.value;
          of_turning += moment * kappa[j];
          whole.a += moment * g.a;
          whole.b += moment * g.b;
          whole.theta_a += moment * g.theta_a;
          whole.theta_b += moment * g.theta_b;
        } else {
          weight += cell.by_kappa[j];
        }
        add_scaled(m, weight, h);
        const PairGradientOf<Lanes> turned = product<Lanes>(m, rate_a, rate_b, turn_a, turn_b);
        left[j] = scaled(viscosity[j], slope[j]);
        right[j] = listed(turned);
      }
      if (model.is_curved()) {
        add_cosine_hessian<Lanes>(cell.turn, cell.inverse, of_turning * share.first,
                                  of_turning * share.second, h);
        PairGradientOf<Lanes> cosine;
        add_cosine_gradient<Lanes>(cell.turn, cell.inverse, share.first, cosine);
        left[2] = right[3] = listed(cosine);
        right[2] = left[3] = listed(whole);
        // The turning of vertex i by its edges: coupling with its curvatures.
        for (std::size_t j = 0; j < 2; ++j) {
          for (int r = 0; r < 4; ++r) {
            const auto of = [&](int k) __attribute__((always_inline)) {
              const std::size_t q = base::at(k);
              return there * stiffness[j] * (share.value * slope[j][q] + kappa[j] * left[2][q]);
            };
            blocks_.add(entry(far_curvature, r, static_cast<int>(j)), i - 1, of(r));
            blocks_.add(entry(near_curvature, r, static_cast<int>(j)), i, of(4 + r));
          }
        }
      } else if (terms.directed) {
        left[2] = scaled(cell.anisotropy, slope[0]);
        left[3] = scaled(-1.0 * cell.anisotropy, slope[1]);
        right[2] = slope[0];
        right[3] = slope[1];
      }
    }
    unrolled<64>([&](auto index) __attribute__((always_inline)) {
      constexpr int r = index % 8, s = index / 8;
      constexpr bool after_r = r > of_angle, after_s = s > of_angle;
      constexpr int block = after_r == after_s ? 0 : after_s ? 1 : 2;  // own, next, last
      const int edge = after_r && after_s ? i : i - 1;
      Lanes value = entry_of<r, s>(h);
      if (by_kappa) {
        for (std::size_t q = 0; q < left.size(); ++q) value += left[q][r] * right[q][s];
      }
      if (time > 0.0) {
        const Lanes rate = left[0][r] * slope[0][s] + left[1][r] * slope[1][s];
        if constexpr (s % 4 == of_angle) {
          value += point.c * rate;
        } else {
          constexpr int first = block == 0 ? own_rate : block == 1 ? next_rate : last_rate;
          blocks_.add(entry(first, r % 4, s % 4), edge, there * rate);
        }
      }
      constexpr int first = block == 0 ? own_place : block == 1 ? next_place : last_place;
      blocks_.add(entry(first, r % 4, s % 4), edge, there * value);
    });
  }
}

// The half cell of an end with its mount; k - n = 0 of a vertex that does not bend.
void RodStiffness::add_end(const RodModel& model, const Point& point, End end) {
  const int e = model.edge_at(end), i = model.vertex_at(end);
  const Eigen::Matrix4d elastic = model.rod().end_cell(point.instant.state, end).hessian;
  for (int s = 0; s < 4; ++s) {
    for (int r = 0; r < 4; ++r) blocks_.row(entry(own_place, r, s))[e] += elastic(r, s);
  }
  if (!model.is_curved()) return;
  if (!BendingCell::exists(model, i)) {
    for (int s = 0; s < 2; ++s) {
      for (int r = 0; r < 2; ++r) blocks_.row(entry_of_two(curvature, r, s))[i] = r == s ? 1.0 : 0.0;
    }
    return;
  }
  const CurvedEnd bending = curved_end(model, point.instant, point.at, end);
  for (int s = 0; s < 4; ++s) {
    for (int r = 0; r < 4; ++r) blocks_.row(entry(own_place, r, s))[e] += bending.hessian(r, s);
  }
  const int coupling = end == End::left ? near_curvature : far_curvature;
  for (int j = 0; j < 2; ++j) {
    for (int r = 0; r < 4; ++r) blocks_.row(entry(coupling, r, j))[e] += bending.hessian(r, 4 + j);
    for (int k = 0; k < 2; ++k)
      blocks_.row(entry_of_two(curvature, k, j))[i] += bending.hessian(4 + k, 4 + j);
  }
}

[[gnu::always_inline]] inline void RodStiffness::work(const RodModel& model, const Point& point) {
  work_on_edges(model, point);
  work_on_vertices(model, point);
}

// No product is joined with its sum in one rounding, so that all processors give the same bits.
[[gnu::target("avx2")]] void RodStiffness::evaluate_avx2(const RodModel& model, const Point& point) {
  work(model, point);
}

void RodStiffness::work_by_two(const RodModel& model, const Point& point) {
  work(model, point);
}

namespace {

/// Which components of places, and which of curvatures, are computed, and whether edges turn about
/// themselves.
struct InSpace {
  static constexpr std::array<int, 3> axes{0, 1, 2};
  static constexpr std::array<int, 2> curvatures{0, 1};
  static constexpr bool turns = true;
};
struct InPlane {
  explicit InPlane(const RodPlane& plane) : axes(plane.axes), curvatures{plane.bending} {}
  std::array<int, 2> axes;
  std::array<int, 1> curvatures;
  static constexpr bool turns = false;
};

/// Calls by_place(row, column, value), by_rate(row, column, value) for all that vertex i's balances and those
/// of the edge behind it are by places and angles, and by velocities: rows and columns as bands counted from
/// x_i's; value() is that of four vertices from i on.
template <class Components, class ByPlace, class ByRate>
[[gnu::always_inline]] inline void visit_bands(const RodRows& blocks, int i, const Components& components,
                                               const ByPlace& by_place, const ByRate& by_rate) {
  constexpr int block = RodModel::block;
  const auto at = [&blocks](int r, int e) __attribute__((always_inline)) {
    return blocks.at(r, e);
  };
  // D_{e,f} - D_{e+1,f} and the like, by how far the one vertex is from the other.
  const auto between = [&](int own, int next, int last, const auto& visit) __attribute__((always_inline)) {
    for (const int s : components.axes) {
      for (const int r : components.axes) {
        const int o = entry(own, r, s), x = entry(next, r, s), b = entry(last, r, s);
        visit(r, -2 * block + s, -at(b, i - 2));
        visit(r, -block + s, at(b, i - 2) - at(o, i - 1) + at(b, i - 1));
        visit(r, s, at(o, i - 1) - at(x, i - 1) - at(b, i - 1) + at(o, i));
        visit(r, block + s, at(x, i - 1) - at(o, i) + at(x, i));
        visit(r, 2 * block + s, -at(x, i));
      }
      if (!Components::turns) continue;
      const int o = entry(own, of_angle, s), x = entry(next, of_angle, s), b = entry(last, of_angle, s);
      visit(of_angle, -block + s, -at(b, i - 1));
      visit(of_angle, s, at(b, i - 1) - at(o, i));
      visit(of_angle, block + s, at(o, i) - at(x, i));
      visit(of_angle, 2 * block + s, at(x, i));
    }
  };
  between(own_place, next_place, last_place, by_place);
  between(own_rate, next_rate, last_rate, by_rate);
  if (!Components::turns) return;
  for (const int r : components.axes) {
    const int o = entry(own_place, r, of_angle), x = entry(next_place, r, of_angle),
              b = entry(last_place, r, of_angle);
    by_place(r, of_angle - 2 * block, at(b, i - 2));
    by_place(r, of_angle - block, at(o, i - 1) - at(b, i - 1));
    by_place(r, of_angle, at(x, i - 1) - at(o, i));
    by_place(r, of_angle + block, -at(x, i));
  }
  by_place(of_angle, of_angle - block, at(entry(last_place, of_angle, of_angle), i - 1));
  by_place(of_angle, of_angle, at(entry(own_place, of_angle, of_angle), i));
  by_place(of_angle, of_angle + block, at(entry(next_place, of_angle, of_angle), i));
}

/// The same of curvatures: by_cell(local, j, value) of the cell's unknown `local` and vertex i's curvature j,
/// for the balance by the curvature and for its row by the place; own(j, k, value) and next(j, k, value) of
/// its row j by its own curvature k and by that of the next vertex.
template <class Components, class ByCell, class Own, class Next>
[[gnu::always_inline]] inline void visit_curvatures(const RodRows& blocks, int i,
                                                    const Components& components, const ByCell& by_cell,
                                                    const Own& own, const Next& next) {
  const auto at = [&blocks](int r, int e) __attribute__((always_inline)) {
    return blocks.at(r, e);
  };
  for (const int j : components.curvatures) {
    for (const int r : components.axes) {
      const Lanes far = at(entry(far_curvature, r, j), i - 1), near = at(entry(near_curvature, r, j), i);
      by_cell(CellRows::before + r, j, -far);
      by_cell(CellRows::middle + r, j, far - near);
      by_cell(CellRows::after + r, j, near);
    }
    if (Components::turns) {
      by_cell(CellRows::angle_before, j, at(entry(far_curvature, of_angle, j), i - 1));
      by_cell(CellRows::angle_after, j, at(entry(near_curvature, of_angle, j), i));
    }
    for (const int k : components.curvatures) {
      own(j, k, at(entry_of_two(curvature, j, k), i));
      next(j, k, at(entry_of_two(next_curvature, j, k), i));
    }
  }
}

}  // namespace

// The slots of all entries in the order in which they are visited, those of four vertices behind each other.
void RodStiffness::attach(const RodModel& model, const RodSlots& slots) {
  if (plane_)
    list_slots(model, slots, InPlane(*plane_));
  else
    list_slots(model, slots, InSpace());
}

template <class Components>
void RodStiffness::list_slots(const RodModel& model, const RodSlots& slots, const Components& components) {
  slots_.clear();
  const int vertices = model.vertices(), bands = model.bands();
  const auto list = [&](int i, const auto& slot_of) {
    for (int k = i; k < i + Lanes::count; ++k) slots_.push_back(k < vertices ? slot_of(k) : -1);
  };
  for (int i = 0; i < vertices; i += Lanes::count) {
    const auto of_bands = [&](int row, int column, bool rate) {
      list(i, [&](int k) {
        const int r = RodModel::block * k + row, s = RodModel::block * k + column;
        if (s < 0 || s >= bands) return -1;
        return rate ? slots.rate_slot(r, s) : slots.place_slot(r, s);
      });
    };
    visit_bands(
        blocks_, i, components, [&](int row, int column, const Lanes&) { of_bands(row, column, false); },
        [&](int row, int column, const Lanes&) { of_bands(row, column, true); });
    if (!model.is_curved()) continue;
    visit_curvatures(
        blocks_, i, components,
        [&](int local, int j, const Lanes&) {
          const auto unknown = [&](int k) { return CellRows::first_band(k) + local; };
          const auto is = [&](int k) { return unknown(k) >= 0 && unknown(k) < bands - 1; };
          list(i, [&](int k) {
            return is(k) ? slots.slot(model.balance_of(unknown(k)), model.curvature_of(k) + j) : -1;
          });
          list(i, [&](int k) {
            return is(k) ? slots.slot(model.curvature_of(k) + j, model.unknown_of(unknown(k))) : -1;
          });
        },
        [&](int j, int m, const Lanes&) {
          list(i, [&](int k) { return slots.slot(model.curvature_of(k) + j, model.curvature_of(k) + m); });
        },
        [&](int j, int m, const Lanes&) {
          const auto is = [&](int k) { return k + 1 < vertices; };
          list(i, [&](int k) {
            return is(k) ? slots.slot(model.curvature_of(k) + j, model.curvature_of(k + 1) + m) : -1;
          });
          list(i, [&](int k) {
            return is(k) ? slots.slot(model.curvature_of(k + 1) + m, model.curvature_of(k) + j) : -1;
          });
        });
  }
}

template <class Components>
[[gnu::always_inline]] inline void RodStiffness::put_components(const RodModel& model,
                                                                const Components& components,
                                                                std::vector<double>& values) const {
  const int* slot = slots_.data();
  double* const to = values.data();
  const auto put = [&](const Lanes& value) __attribute__((always_inline)) {
    for (int k = 0; k < Lanes::count; ++k) {
      if (slot[k] >= 0) to[slot[k]] += value[k];
    }
    slot += Lanes::count;
  };
  const auto of_bands = [&](int, int, const Lanes& value) __attribute__((always_inline)) {
    put(value);
  };
  const auto twice = [&](int, int, const Lanes& value) __attribute__((always_inline)) {
    put(value);
    put(value);
  };
  for (int i = 0; i < model.vertices(); i += Lanes::count) {
    visit_bands(blocks_, i, components, of_bands, of_bands);
    if (model.is_curved()) visit_curvatures(blocks_, i, components, twice, of_bands, twice);
  }
}

[[gnu::always_inline]] inline void RodStiffness::put_all(const RodModel& model,
                                                         std::vector<double>& values) const {
  if (plane_)
    put_components(model, InPlane(*plane_), values);
  else
    put_components(model, InSpace(), values);
}

[[gnu::target("avx2")]] void RodStiffness::put_by_four(const RodModel& model,
                                                       std::vector<double>& values) const {
  put_all(model, values);
}

void RodStiffness::put_by_two(const RodModel& model, std::vector<double>& values) const {
  put_all(model, values);
}

void RodStiffness::add(const RodModel& model, const Point& point, std::vector<double>& values) {
  blocks_.clear();
  if (plane_)
    work_out_stiffness(model, *plane_, point.rows, four_, blocks_);
  else
    four_ ? evaluate_avx2(model, point) : work_by_two(model, point);
  for (const End end : ends) add_end(model, point, end);
  four_ ? put_by_four(model, values) : put_by_two(model, values);
}

}  // namespace snare::wire
