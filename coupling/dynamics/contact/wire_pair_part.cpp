#include "coupling/dynamics/contact/wire_pair_part.hpp"

#include "base/index.hpp"
#include "coupling/contact/curve.hpp"
#include "coupling/dynamics/contact/contact_integral.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

namespace snare::coupling {

using Eigen::Vector2d;
using Eigen::Vector3d;
using numerics::DaeKind;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

// Rows and columns of a local block: of a place its forces; its places and velocities; bristles behind both.
constexpr Eigen::Index rows_of_place = 12, row_of_bristle = 24;
constexpr Eigen::Index columns_of_place = 24, column_of_velocity = 12, column_of_bristle = 48;

// Elements on either side of those that touch which are in the pattern, too.
constexpr int neighbours_coupled = 1;

double smaller_default(const WirePair& pair, const wire::RodPart& a, const wire::RodPart& b) {
  const auto of = [](const wire::RodPart& rod, double radius) {
    const wire::SpatialRodProperties& p = rod.constants().properties;
    return default_modulus(p.axial_stiffness, p.bending_stiffness, 2.0 * radius);
  };
  return std::min(of(a, pair.radii[0]), of(b, pair.radii[1]));
}

}  // namespace

WirePairPart::WirePairPart(const WirePair& pair, const wire::RodPart& first, const wire::RodPart& second)
    : pair_(pair),
      rods_{&first, &second},
      search_(pair, first, second),
      touches_(search_.curve(0).longest(), pair.friction.has_bristle()) {
  assert(first.vertices() >= 5 && second.vertices() >= 5);
  for (std::size_t w = 0; w < 2; ++w) found_.pieces[w] = CubicPieces(search_.curve(w).elements());
  if (pair_.foundation.modulus == 0.0) pair_.foundation.modulus = smaller_default(pair, first, second);
}

void WirePairPart::declare(numerics::DaeLayout& layout) {
  if (!has_bristle()) return;
  // Outside of the error test: see ContactPart.
  for (std::size_t w = 0; w < 2; ++w) {
    bristles_[w] = layout.add({pair_.name + (w == 0 ? " bristle of the first" : " bristle of the second"),
                               {"along", "across"},
                               2 * rods_[w]->vertices(),
                               DaeKind::algebraic,
                               0.1 * pair_.friction.bristle_displacement,
                               0});
  }
}

void WirePairPart::attach_pattern(const numerics::SparseMatrix& pattern) {
  slots_.attach(pattern);
  if (found_.inputs.depends()) return;
  for (std::size_t w = 0; w < 2; ++w) {
    found_.inputs.depend_on(rods_[w]->position_of(0), 3 * rods_[w]->vertices());
    found_.inputs.depend_on(rods_[w]->velocity_of(0), 3 * rods_[w]->vertices());
    if (has_bristle()) found_.inputs.depend_on(bristles_[w], 2 * rods_[w]->vertices());
  }
  accepted_ = AcceptedPress(found_.inputs);
}

bool WirePairPart::outgrows_pattern(const DaePoint& at) {
  const ContactCache& found = found_at(at.y);
  const auto elements = [](const QuadraturePoint& n) {
    const int own = n.places[0].element, other = n.places[1].element;
    return n.own == 0 ? std::pair(own, other) : std::pair(other, own);
  };
  const auto known = [&](const QuadraturePoint& n) {
    return std::ranges::binary_search(coupled_, elements(n));
  };
  if (std::ranges::all_of(found.nodes, known)) return false;
  std::vector<std::pair<int, int>> wanted;
  std::ranges::set_intersection(coupled_, search_.candidates(), std::back_inserter(wanted));
  const std::array<int, 2> last{search_.curve(0).elements() - 1, search_.curve(1).elements() - 1};
  for (const QuadraturePoint& n : found.nodes) {
    const auto [a, b] = elements(n);
    for (int i = std::max(0, a - neighbours_coupled); i <= std::min(last[0], a + neighbours_coupled); ++i) {
      for (int j = std::max(0, b - neighbours_coupled); j <= std::min(last[1], b + neighbours_coupled); ++j)
        wanted.emplace_back(i, j);
    }
  }
  std::ranges::sort(wanted);
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  coupled_ = std::move(wanted);
  return true;
}

void WirePairPart::restore_state(const VectorView& y, std::span<const double>& memory) {
  touches_.restore_state(memory);
  coupled_.clear();
  update_candidates(y);
}

// By pairs of vertices, of either wire, that an element of one and an element of the other couple.
void WirePairPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  std::vector<std::pair<int, int>> vertices;  // those of the second wire behind those of the first
  for (const auto& [a, b] : coupled_) {
    std::array<int, 8> of{};
    for (int k = 0; k < 4; ++k) {
      of[base::at(k)] = search_.curve(0).first_vertex(a) + k;
      of[base::at(4 + k)] = rods_[0]->vertices() + search_.curve(1).first_vertex(b) + k;
    }
    for (const int i : of) {
      for (const int j : of) vertices.emplace_back(i, j);
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (const auto& [row_vertex, column_vertex] : vertices) {
    const std::size_t wr = row_vertex < rods_[0]->vertices() ? 0 : 1,
                      wc = column_vertex < rods_[0]->vertices() ? 0 : 1;
    const int i = row_vertex - (wr == 0 ? 0 : rods_[0]->vertices());
    const int j = column_vertex - (wc == 0 ? 0 : rods_[0]->vertices());
    std::vector<int> rows, columns;
    for (int a = 0; a < 3; ++a) {
      if (!rods_[wr]->is_held(i, a)) rows.push_back(rods_[wr]->velocity_of(i) + a);
      columns.push_back(rods_[wc]->position_of(j) + a);
      columns.push_back(rods_[wc]->velocity_of(j) + a);
    }
    for (int a = 0; has_bristle() && a < 2; ++a) {
      rows.push_back(bristles_[wr] + 2 * i + a);
      columns.push_back(bristles_[wc] + 2 * j + a);
    }
    for (const int row : rows) {
      for (const int column : columns) entries.emplace_back(row, column);
    }
  }
  for (std::size_t w = 0; has_bristle() && w < 2; ++w) {
    for (int k = 0; k < 2 * rods_[w]->vertices(); ++k)
      entries.emplace_back(bristles_[w] + k, bristles_[w] + k);
  }
}

WirePairPart::QuadraturePoint::Place WirePairPart::place(std::size_t wire, int element, double u) const {
  const BezierWire& curve = search_.curve(wire);
  QuadraturePoint::Place p;
  p.element = element;
  p.u = u;
  p.first = curve.first_vertex(element);
  p.value = curve.value(element, u);
  p.slope = curve.slope(element, u);
  p.bend = curve.bend(element, u);
  // A section turns with the edges beside it: hats between their middles.
  const std::size_t own = base::at(element - p.first);
  const double rise = 1.0 / curve.length(element);
  p.share[own] = 1.0;
  if (u < 0.5 && element > 0) {
    p.share[own - 1] = 0.5 - u;
    p.share[own] = 0.5 + u;
    p.share_slope[own - 1] = -rise;
    p.share_slope[own] = rise;
  } else if (u >= 0.5 && element + 1 < curve.elements()) {
    p.share[own] = 1.5 - u;
    p.share[own + 1] = u - 0.5;
    p.share_slope[own] = -rise;
    p.share_slope[own + 1] = rise;
  }
  return p;
}

void WirePairPart::find(const VectorView& y, ContactCache& found) const {
  for (std::size_t w = 0; w < 2; ++w) {
    for (const NearElements& n : search_.near(w))
      found.pieces[w].set(n.element, search_.curve(w).control(n.element, y));
  }
  for (std::size_t w = 0; w < 2; ++w) {
    for (const NearElements& n : search_.near(w)) find_along(w, n, found);
  }
}

void WirePairPart::find_along(std::size_t own, const NearElements& near, ContactCache& found) const {
  const std::size_t other = 1 - own;
  const BezierWire& curve = search_.curve(own);
  const CubicPieces &along = found.pieces[own], &across = found.pieces[other];
  const double length = curve.length(near.element);
  const double thickness = pair_.radii[0] + pair_.radii[1];
  if (parted(along, near.element, across, near.first, near.last, thickness)) return;
  const auto gap = [&](double u) {
    const Vector3d x = along.value(near.element, u);
    const FootPoint foot = foot_point(across, near.first, near.last, x);
    const Vector3d apart = x - across.value(foot.element, foot.u);
    const double distance = apart.norm();
    const Vector3d slope = along.slope(near.element, u) / length;
    // Where the other wire bends towards this one, by its part along the other's tangent.
    const Vector3d tangent = across.slope(foot.element, foot.u);
    const double over = slope.dot(tangent) / tangent.squaredNorm();
    const double towards = apart.dot(across.bend(foot.element, foot.u)) / distance;
    return GapPlace{u, distance - thickness, apart.dot(slope) / distance,
                    std::max(0.0, towards * over * over)};
  };
  found.closed.clear();
  found.minima.clear();
  ContactIntervals(length, along.way(near.element), along.largest_bend(near.element) / (length * length),
                   search_.resolution(own))
      .find(gap, gap(0.0), gap(1.0), found.closed, found.minima);
  for (const ContactInterval& s : found.closed) {
    const double begin = curve.begin(near.element);
    found.stretches.push_back({own, begin + s.from * length, begin + s.to * length, s.deepest.gap});
    const auto make = [&](double u, double weight) {
      const FootPoint foot = foot_point(across, near.first, near.last, along.value(near.element, u));
      QuadraturePoint n;
      n.own = own;
      n.weight = 0.5 * weight * length;
      n.stands = foot.stands;
      n.stretch = found.stretches.size() - 1;
      n.places = {place(own, near.element, u), place(other, foot.element, foot.u)};
      n.shape_functions = {1.0 - u, u};
      return n;
    };
    for_each_place(s, [&](double u, double weight) { found.nodes.push_back(make(u, weight)); });
    for (const double u : {s.from, s.to}) {
      if (has_bristle() && u > 0.0 && u < 1.0) found.ends.push_back(make(u, 1.0 / length));
    }
  }
}

PairSide WirePairPart::side(std::size_t wire, const QuadraturePoint::Place& p, const VectorView& y) const {
  const wire::RodPart& rod = *rods_[wire];
  const Eigen::Map<const BezierWire::Control> x(y.data() + rod.position_of(p.first));
  const Eigen::Map<const BezierWire::Control> v(y.data() + rod.velocity_of(p.first));
  PairSide s;
  s.x = x * p.value;
  s.slope = x * p.slope;
  s.bend = x * p.bend;
  s.v = v * p.value;
  s.slope_v = v * p.slope;
  if (!pair_.friction.acts()) return s;
  for (int j = 0; j < 3; ++j) {
    s.edges[base::at(j)] = {p.share[base::at(j)], p.share_slope[base::at(j)], x.col(j + 1) - x.col(j),
                            v.col(j + 1) - v.col(j)};
  }
  return s;
}

PairGeometry WirePairPart::geometry(const QuadraturePoint& n, const VectorView& y) const {
  BristlesBeside beside;
  beside.shape_functions = n.shape_functions;
  for (int h = 0; has_bristle() && h < 2; ++h) beside.bristles[base::at(h)] = y.segment<2>(bristle_of(n, h));
  const std::size_t other = 1 - n.own;
  return pair_geometry(pair_, {pair_.radii[n.own], pair_.radii[other]},
                       {side(n.own, n.places[0], y), side(other, n.places[1], y)}, n.stands, beside);
}

BristleState WirePairPart::bristle_state(const QuadraturePoint& n, std::size_t h, const PairGeometry& g,
                                         const VectorView& y) const {
  BristleState at = g.state;
  at.bristle = y.segment<2>(bristle_of(n, static_cast<int>(h)));
  return at;
}

BristleFlow WirePairPart::bristle_flow_at(const QuadraturePoint& n, std::size_t h, const PairGeometry& g,
                                          const VectorView& y) const {
  return bristle_flow(pair_.friction, bristle_state(n, h, g, y), g.of_bristles[h], g.elastic_rate());
}

WirePairPart::NodalLoad WirePairPart::nodal_load(const QuadraturePoint& n, const PairGeometry& g,
                                                 std::size_t s) const {
  const QuadraturePoint::Place& p = n.places[s];
  const Vector3d force = (s == 0 ? n.weight : -n.weight) * g.force;
  NodalLoad load;
  for (int k = 0; k < 4; ++k) load.force[base::at(k)] = p.value[k] * force;
  for (std::size_t j = 0; pair_.friction.acts() && j < 3; ++j) {
    if (p.share[j] == 0.0) continue;
    const Vector3d& edge = g.sides[s].edges[j].edge;
    const Vector3d moment = n.weight * g.shares[s] * p.share[j] * g.moment;
    const Vector3d couple = couple_on(edge, moment);
    load.force[j] -= couple;
    load.force[j + 1] += couple;
    load.held_moment += moment.dot(edge) / edge.squaredNorm() * edge;
  }
  return load;
}

const WirePairPart::ContactCache& WirePairPart::found_at(const VectorView& y) const {
  if (found_.inputs.holds(y)) return found_;
  found_.inputs.take(y);
  found_.nodes.clear();
  found_.ends.clear();
  found_.stretches.clear();
  found_.geometries.clear();
  if (!search_.candidates().empty()) find(y, found_);
  for (const QuadraturePoint& n : found_.nodes) found_.geometries.push_back(geometry(n, y));
  if (has_bristle()) add_up_bristles(y, found_);
  return found_;
}

void WirePairPart::accept(const DaePoint& at) {
  search_.update(at.y);
  accepted_.take(at.y, [this](const VectorView& y) -> const ContactCache& { return found_at(y); });
}

numerics::IterationStart WirePairPart::iteration_start(const VectorView& from, const VectorView& to) {
  const double tolerance = std::min(rods_[0]->tolerances().position, rods_[1]->tolerances().position);
  return accepted_.start(
      from, to, tolerance, [this](const VectorView& y) -> const ContactCache& { return found_at(y); },
      [this](const VectorView& y) { return search_.nearest(y).gap; });
}

void WirePairPart::add_up_bristles(const VectorView& y, ContactCache& found) const {
  for (std::size_t w = 0; w < 2; ++w) found.bristles[w].begin(rods_[w]->vertices());
  for (std::size_t q = 0; q < found.nodes.size(); ++q) {
    const QuadraturePoint& n = found.nodes[q];
    const PairGeometry& g = found.geometries[q];
    for (std::size_t h = 0; h < 2; ++h) {
      const double share = n.weight * n.shape_functions[h];
      found.bristles[n.own].add(n.places[0].element + static_cast<int>(h), share * g.state.elastic,
                                share * bristle_flow_at(n, h, g, y).flow);
    }
  }
  for (std::size_t w = 0; w < 2; ++w)
    found.bristles[w].finish(y.segment(bristles_[w], 2 * rods_[w]->vertices()), pair_.friction.bristle_time);
}

void WirePairPart::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  const ContactCache& found = found_at(at.y);
  for (std::size_t q = 0; q < found.nodes.size(); ++q) {
    const QuadraturePoint& n = found.nodes[q];
    // m v_k' + ... less the forces, but for components that a mount holds.
    for (std::size_t s = 0; s < 2; ++s) {
      const wire::RodPart& rod = *rods_[wire_of(n, s)];
      const NodalLoad load = nodal_load(n, found.geometries[q], s);
      for (int k = 0; k < 4; ++k) {
        const int i = n.places[s].first + k;
        for (int a = 0; a < 3; ++a) {
          if (!rod.is_held(i, a)) rows[rod.velocity_of(i) + a] -= load.force[base::at(k)][a];
        }
      }
    }
  }
  if (!has_bristle()) return;
  for (std::size_t w = 0; w < 2; ++w) {
    const int count = 2 * rods_[w]->vertices();
    rows.segment(bristles_[w], count) +=
        at.rate.segment(bristles_[w], count) - found.bristles[w].rates.reshaped();
  }
}

void WirePairPart::jacobian(const DaePoint& at, double c, std::vector<double>& values) {
  const numerics::PatternValues into(slots_, values);
  const ContactCache& found = found_at(at.y);
  for (std::size_t w = 0; has_bristle() && w < 2; ++w) {
    for (int i = 0; i < rods_[w]->vertices(); ++i) {
      for (int a = 0; a < 2; ++a)
        into.add(bristle_of(w, i) + a, bristle_of(w, i) + a, c + found.bristles[w].forgetting(i));
    }
  }
  LocalBlock block = LocalBlock::Zero();
  for (std::size_t k = 0; k < found.nodes.size(); ++k) {
    const QuadraturePoint& n = found.nodes[k];
    add_node_jacobian(n, found.geometries[k], at.y, block);
    const auto same = [&n](const QuadraturePoint& next) {
      return next.own == n.own && next.places[0].element == n.places[0].element &&
             next.places[1].element == n.places[1].element;
    };
    if (k + 1 < found.nodes.size() && same(found.nodes[k + 1])) continue;
    add_block(n, block, into);
    block.setZero();
  }
  for (const QuadraturePoint& end : found.ends) {
    add_end_jacobian(end, at.y, block);
    add_block(end, block, into);
    block.setZero();
  }
}

void WirePairPart::add_column(const QuadraturePoint& n, const PairGeometry& g, const PairDirection& d,
                              const VectorView& y, Eigen::Ref<Eigen::Matrix<double, 28, 1>> column) const {
  const PairChange c = pair_change(pair_.friction, g, d);
  for (std::size_t s = 0; s < 2; ++s) {
    const QuadraturePoint::Place& p = n.places[s];
    const double sign = s == 0 ? -n.weight : n.weight;
    const double zeta = s == 0 ? 0.0 : c.zeta;
    const Eigen::Index row = rows_of_place * static_cast<Eigen::Index>(s);
    for (int k = 0; k < 4; ++k)
      column.segment<3>(row + 3 * k) += sign * (p.value[k] * c.force + p.slope[k] * zeta * g.force);
    for (std::size_t j = 0; pair_.friction.acts() && j < 3; ++j) {
      if (p.share[j] == 0.0) continue;
      const double share = n.weight * g.shares[s];
      const Vector3d couple =
          couple_change(g.sides[s].edges[j].edge, share * p.share[j] * g.moment, d.sides[s].edge[j],
                        share * (p.share[j] * c.moment + p.share_slope[j] * zeta * g.moment));
      const auto first = row + 3 * static_cast<Eigen::Index>(j);
      column.segment<3>(first) += couple;
      column.segment<3>(first + 3) -= couple;
    }
  }
  for (std::size_t h = 0; has_bristle() && h < 2; ++h) {
    const BristleFlow flow = bristle_flow_at(n, h, g, y);
    const BristleChange by{d.bristles[h], c.sliding, c.load, c.elastic, c.elastic_rate};
    const double share = n.weight * n.shape_functions[h];
    column.segment<2>(row_of_bristle + 2 * static_cast<Eigen::Index>(h)) += found_.bristles[n.own].change(
        n.places[0].element + static_cast<int>(h), share * c.elastic,
        share * flow_change(pair_.friction, bristle_state(n, h, g, y), g.of_bristles[h], flow, by));
  }
}

// One unknown after another: the direction along which it moves what the node depends on, and what changes in
// all rows.
void WirePairPart::add_node_jacobian(const QuadraturePoint& n, const PairGeometry& g, const VectorView& y,
                                     LocalBlock& block) const {
  for (std::size_t s = 0; s < 2; ++s) {
    const QuadraturePoint::Place& p = n.places[s];
    const Eigen::Index first = columns_of_place * static_cast<Eigen::Index>(s);
    for (int k = 0; k < 4; ++k) {
      for (int a = 0; a < 3; ++a) {
        const Vector3d unit = Vector3d::Unit(a);
        PairDirection place, velocity;
        place.sides[s].x = p.value[k] * unit;
        place.sides[s].slope = p.slope[k] * unit;
        velocity.sides[s].v = p.value[k] * unit;
        if (k < 3) {
          place.sides[s].edge[base::at(k)] = -unit;
          velocity.sides[s].rate[base::at(k)] = -unit;
        }
        if (k > 0) {
          place.sides[s].edge[base::at(k - 1)] = unit;
          velocity.sides[s].rate[base::at(k - 1)] = unit;
        }
        add_column(n, g, place, y, block.col(first + 3 * k + a));
        add_column(n, g, velocity, y, block.col(first + column_of_velocity + 3 * k + a));
      }
    }
  }
  for (std::size_t h = 0; has_bristle() && h < 2; ++h) {
    for (int a = 0; a < 2; ++a) {
      PairDirection d;
      d.bristles[h] = Vector2d::Unit(a);
      add_column(n, g, d, y, block.col(column_of_bristle + 2 * static_cast<Eigen::Index>(h) + a));
    }
  }
}

void WirePairPart::add_end_jacobian(const QuadraturePoint& n, const VectorView& y, LocalBlock& block) const {
  const PairGeometry g = geometry(n, y);
  const double growth = std::max(-pair_.foundation.modulus * g.gap_rate, 0.0);
  const double steep = std::abs(g.normal.dot(g.sides[0].slope));
  if (growth == 0.0 || steep < 1e-12) return;
  for (int h = 0; h < 2; ++h) {
    const Vector2d flow =
        0.5 * growth / steep * n.weight * n.shape_functions[base::at(h)] * y.segment<2>(bristle_of(n, h));
    const Vector2d by_gap = found_.bristles[n.own].change(n.places[0].element + h, 0.0, flow);
    for (std::size_t s = 0; s < 2; ++s) {  // dg = n.(dX_A - dX_B)
      const Vector3d normal = s == 0 ? g.normal : Vector3d(-g.normal);
      for (int k = 0; k < 4; ++k) {
        const Eigen::Index column = columns_of_place * static_cast<Eigen::Index>(s) + 3 * k;
        block.block<2, 3>(row_of_bristle + 2 * h, column) +=
            n.places[s].value[k] * by_gap * normal.transpose();
      }
    }
  }
}

void WirePairPart::add_block(const QuadraturePoint& n, const LocalBlock& block,
                             const numerics::PatternValues& into) const {
  constexpr int none = -1;
  std::array<int, 28> rows;
  std::array<int, 52> columns;
  rows.fill(none);
  columns.fill(none);
  for (std::size_t s = 0; s < 2; ++s) {
    const wire::RodPart& rod = *rods_[wire_of(n, s)];
    const std::size_t row = base::at(rows_of_place) * s, column = base::at(columns_of_place) * s;
    for (int k = 0; k < 4; ++k) {
      const int i = n.places[s].first + k;
      for (int a = 0; a < 3; ++a) {
        const std::size_t of = base::at(3 * k + a);
        if (!rod.is_held(i, a)) rows[row + of] = rod.velocity_of(i) + a;
        columns[column + of] = rod.position_of(i) + a;
        columns[column + base::at(column_of_velocity) + of] = rod.velocity_of(i) + a;
      }
    }
  }
  for (std::size_t k = 0; has_bristle() && k < 4; ++k)
    rows[row_of_bristle + k] = columns[column_of_bristle + k] = bristle_of(n, 0) + static_cast<int>(k);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (columns[j] == none) continue;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double value = block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (rows[i] != none && value != 0.0) into.add(rows[i], columns[j], value);
    }
  }
}

}  // namespace snare::coupling
