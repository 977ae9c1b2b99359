#include "coupling/dynamics/contact/wire_pair_geometry.hpp"

#include <cstddef>

namespace snare::coupling {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

Vector3d turn_of(const PairSide::Edge& e) {
  return e.edge.cross(e.rate) / e.edge.squaredNorm();
}

// d(e x e'/|e|^2) = (de x e' + e x de')/|e|^2 - 2 (e.de)/|e|^2 (e x e')/|e|^2.
Vector3d turn_change(const PairSide::Edge& e, const Vector3d& edge, const Vector3d& rate) {
  const double square = e.edge.squaredNorm();
  return (edge.cross(e.rate) + e.edge.cross(rate) - 2.0 * e.edge.dot(edge) / square * e.edge.cross(e.rate)) /
         square;
}

}  // namespace

Vector3d PairSide::turn() const {
  Vector3d sum = Vector3d::Zero();
  for (const Edge& e : edges) {
    if (e.share != 0.0) sum += e.share * turn_of(e);
  }
  return sum;
}

PairGeometry pair_geometry(const WirePair& pair, const std::array<double, 2>& radii,
                           const std::array<PairSide, 2>& sides, bool stands, const BristlesBeside& beside) {
  PairGeometry g;
  g.sides = sides;
  const double thickness = radii[0] + radii[1];
  g.shares = {radii[0] / thickness, radii[1] / thickness};
  g.stands = stands;
  g.apart = sides[0].x - sides[1].x;
  g.distance = g.apart.norm();
  g.normal = g.apart / g.distance;
  g.gap = g.distance - thickness;
  g.relative = sides[0].v - sides[1].v;
  g.gap_rate = g.normal.dot(g.relative);
  g.direction = sides[0].slope.normalized();
  const double across = g.gap_rate - g.normal.dot(g.direction) * g.direction.dot(g.relative);
  g.opening = Opening::between(g.gap_rate, across);
  g.load = pair.foundation.load(g.gap, g.opening.rate);
  g.elastic = pair.foundation.elastic_load(g.gap);
  g.state.normal = g.load[0];
  g.state.elastic = g.elastic[0];
  g.force = g.state.normal * g.normal;
  if (!pair.friction.acts()) return g;
  g.turn = g.shares[0] * sides[0].turn() + g.shares[1] * sides[1].turn();
  g.sliding = g.relative - g.turn.cross(g.apart);
  const Vector3d level = sides[0].slope - g.normal.dot(sides[0].slope) * g.normal;
  g.run = level.norm();
  g.along = level / g.run;
  g.across = g.normal.cross(g.along);
  g.state.sliding = {g.along.dot(g.sliding), g.across.dot(g.sliding)};
  if (pair.friction.has_bristle()) {
    g.shape_functions = beside.shape_functions;
    for (std::size_t h = 0; h < 2; ++h) {
      BristleState at = g.state;
      at.bristle = beside.bristles[h];
      g.of_bristles[h] = tangent_force(pair.friction, at);
      g.friction.add(g.shape_functions[h], g.of_bristles[h]);
    }
  } else {
    g.friction = tangent_force(pair.friction, g.state);
  }
  const Vector3d on_other = g.in_world(g.friction.force);
  g.force -= on_other;
  g.moment = g.apart.cross(on_other);
  return g;
}

// B's point follows r.X_B' = 0: (dX_A - dX_B).X_B' + r.dX_B' = (X_B'.X_B' - r.X_B'') dzeta.
PairChange pair_change(const MotionFriction& friction, const PairGeometry& g, const PairDirection& d) {
  PairChange c;
  const PairSide &a = g.sides[0], &b = g.sides[1];
  const Vector3d shift = d.sides[0].x - d.sides[1].x;
  if (!g.stands) {
    c.zeta =
        (shift.dot(b.slope) + g.apart.dot(d.sides[1].slope)) / (b.slope.squaredNorm() - g.apart.dot(b.bend));
  }
  const Vector3d dapart = shift - b.slope * c.zeta;
  const double dgap = g.normal.dot(dapart);
  const Vector3d dnormal = (dapart - dgap * g.normal) / g.distance;
  const Vector3d drelative = d.sides[0].v - d.sides[1].v - b.slope_v * c.zeta;
  const double dgap_rate = dnormal.dot(g.relative) + g.normal.dot(drelative);
  double dopening = (g.opening.by_gap + g.opening.by_across) * dgap_rate;
  if (g.opening.by_across != 0.0) {
    const Vector3d ddirection =
        (d.sides[0].slope - g.direction.dot(d.sides[0].slope) * g.direction) / a.slope.norm();
    dopening -= g.opening.by_across *
                ((dnormal.dot(g.direction) + g.normal.dot(ddirection)) * g.direction.dot(g.relative) +
                 g.normal.dot(g.direction) * (ddirection.dot(g.relative) + g.direction.dot(drelative)));
  }
  c.load = g.load[1] * dgap + g.load[2] * dopening;
  c.elastic = g.elastic[1] * dgap;
  c.elastic_rate = g.elastic[2] * g.gap_rate * dgap + g.elastic[1] * dgap_rate;
  c.force = c.load * g.normal + g.state.normal * dnormal;
  if (!friction.acts()) return c;
  Vector3d dturn = Vector3d::Zero();
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t j = 0; j < 3; ++j) {
      const PairSide::Edge& e = g.sides[s].edges[j];
      if (e.share != 0.0) {
        dturn += g.shares[s] * e.share * turn_change(e, d.sides[s].edge[j], d.sides[s].rate[j]);
      }
      if (s == 1 && e.share_slope != 0.0) dturn += g.shares[s] * e.share_slope * c.zeta * turn_of(e);
    }
  }
  const Vector3d dsliding = drelative - dturn.cross(g.apart) - g.turn.cross(dapart);
  // The axes turn with X_A' and n: |u| da = du - a (a.du), du = dX' - d(n.X') n - (n.X') dn, db = dn x a + n
  // x da.
  const Vector3d& dslope = d.sides[0].slope;
  const Vector3d du =
      dslope - (dnormal.dot(a.slope) + g.normal.dot(dslope)) * g.normal - g.normal.dot(a.slope) * dnormal;
  const Vector3d dalong = (du - g.along.dot(du) * g.along) / g.run;
  const Vector3d dacross = dnormal.cross(g.along) + g.normal.cross(dalong);
  c.sliding = {dalong.dot(g.sliding) + g.along.dot(dsliding),
               dacross.dot(g.sliding) + g.across.dot(dsliding)};
  Vector2d dfriction =
      g.friction.by_sliding * c.sliding + g.friction.by_normal * c.load + g.friction.by_elastic * c.elastic;
  for (std::size_t h = 0; h < 2; ++h)
    dfriction += g.shape_functions[h] * g.of_bristles[h].by_bristle * d.bristles[h];
  const Vector3d don_other =
      g.in_world(dfriction) + g.friction.force.x() * dalong + g.friction.force.y() * dacross;
  c.force -= don_other;
  c.moment = dapart.cross(g.in_world(g.friction.force)) + g.apart.cross(don_other);
  return c;
}

Vector3d couple_on(const Vector3d& edge, const Vector3d& moment) {
  return moment.cross(edge) / edge.squaredNorm();
}

Vector3d couple_change(const Vector3d& edge, const Vector3d& moment, const Vector3d& edge_change,
                       const Vector3d& moment_change) {
  const double square = edge.squaredNorm();
  return (moment_change.cross(edge) + moment.cross(edge_change) -
          2.0 * edge.dot(edge_change) / square * moment.cross(edge)) /
         square;
}

}  // namespace snare::coupling
