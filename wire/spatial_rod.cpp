#include "wire/spatial_rod.hpp"

#include "wire/curvature.hpp"
#include "wire/twist.hpp"

#include <Eigen/Geometry>

#include <cassert>
#include <cmath>
#include <utility>

namespace snare::wire {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr int kBlock = SpatialRod::block;

/// One edge, or the direction of a mount in the place of one.
struct Edge {
  Vector3d tangent;
  double length = 1.0;
  double inverse_length = 0.0;  // 0 for a mount: its derivatives vanish
  double rest = 1.0;
  double theta = 0.0;
  Directors directors;  // only of rods that feel them
};

/// Stiffness of a cell with a mount's flexibility in series, 1/k = l/B + f, and its derivatives by l.
struct SeriesStiffness {
  double k = 0.0;
  double first = 0.0;
  double second = 0.0;
};

SeriesStiffness in_series(double cell_length, double stiffness, double flexibility) {
  SeriesStiffness s;
  s.k = 1.0 / (cell_length / stiffness + flexibility);
  s.first = -s.k * s.k / stiffness;
  s.second = -2.0 * s.k * s.first / stiffness;
  return s;
}

/// Energy of one vertex as a function of c, kappa_1, kappa_2, tau and the cell's length l.
struct Cell {
  bool bends = false;
  bool twists = false;
  bool directed = false;  // feels the directors
  Turn turn;
  InverseLengths inverse;
  double energy = 0.0;
  double by_cosine = 0.0;        // dE/dc
  double by_cosine_twice = 0.0;  // d2E/dc2
  Vector2d by_kappa = Vector2d::Zero();
  double anisotropy = 0.0;       // d2E/dkappa_1^2 = -d2E/dkappa_2^2
  double torque = 0.0;           // dE/dtau
  double twist_stiffness = 0.0;  // d2E/dtau2
  // And by the cell's length.
  double by_length = 0.0;
  double by_length_twice = 0.0;
  double cosine_by_length = 0.0;
  Vector2d kappa_by_length = Vector2d::Zero();
  double torque_by_length = 0.0;
};

/// The constants that decide which terms there are.
struct Law {
  explicit Law(const SpatialRodProperties& p)
      : properties(p),
        directed(p.bending_stiffness != p.second_bending_stiffness ||
                 p.natural_curvature != Vector2d::Zero()) {}
  const SpatialRodProperties& properties;
  bool directed;
};

void bend(const Edge& before, const Edge& after, double l, double flexibility, const Law& law, Cell& cell) {
  const SpatialRodProperties& p = law.properties;
  cell.bends = true;
  const SeriesStiffness k1 = in_series(l, p.bending_stiffness, flexibility);
  const SeriesStiffness k2 = law.directed ? in_series(l, p.second_bending_stiffness, flexibility) : k1;
  // |kb|^2 = 4 (1 - c)/(1 + c), taken from kb to keep its digits; d/dc = -8/(1 + c)^2.
  const double square = cell.turn.binormal.squaredNorm();
  const double inverse_chi = 1.0 / cell.turn.chi;
  const double slope = -8.0 * inverse_chi * inverse_chi;
  const double mean = 0.25 * (k1.k + k2.k);
  const double mean_first = 0.25 * (k1.first + k2.first);
  cell.energy += mean * square;
  cell.by_cosine = mean * slope;
  cell.by_cosine_twice = -2.0 * mean * slope * inverse_chi;
  cell.by_length += mean_first * square;
  cell.by_length_twice += 0.25 * (k1.second + k2.second) * square;
  cell.cosine_by_length = mean_first * slope;
  if (!law.directed) return;

  cell.directed = true;
  const Vector2d kappa = curvatures(cell.turn, before.directors, after.directors);
  const Vector2d& natural = p.natural_curvature;
  const double difference = kappa[0] * kappa[0] - kappa[1] * kappa[1];
  cell.anisotropy = 0.5 * (k1.k - k2.k);
  const double anisotropy_first = 0.5 * (k1.first - k2.first);
  cell.energy += 0.5 * cell.anisotropy * difference;
  cell.by_kappa = cell.anisotropy * Vector2d(kappa[0], -kappa[1]);
  cell.by_length += 0.5 * anisotropy_first * difference;
  cell.by_length_twice += 0.25 * (k1.second - k2.second) * difference;
  cell.kappa_by_length = anisotropy_first * Vector2d(kappa[0], -kappa[1]);
  const auto add_natural = [&](int j, const SeriesStiffness& k) {
    const double n = natural[j];
    cell.energy += k.k * n * l * (0.5 * n * l - kappa[j]);
    cell.by_kappa[j] -= k.k * n * l;
    cell.kappa_by_length[j] -= n * (k.first * l + k.k);
    cell.by_length += 0.5 * n * n * l * (k.first * l + 2.0 * k.k) - n * kappa[j] * (k.first * l + k.k);
    cell.by_length_twice += 0.5 * n * n * (k.second * l * l + 4.0 * k.first * l + 2.0 * k.k) -
                            n * kappa[j] * (k.second * l + 2.0 * k.first);
  };
  add_natural(0, k1);
  add_natural(1, k2);
}

void twist(double tau, double l, double flexibility, const SpatialRodProperties& p, Cell& cell) {
  cell.twists = true;
  const SeriesStiffness k = in_series(l, p.torsional_stiffness, flexibility);
  const double natural = p.natural_twist;
  const double strain = tau - natural * l;
  cell.energy += 0.5 * k.k * strain * strain;
  cell.torque = k.k * strain;
  cell.twist_stiffness = k.k;
  cell.torque_by_length = k.first * strain - k.k * natural;
  cell.by_length += 0.5 * k.first * strain * strain - k.k * natural * strain;
  cell.by_length_twice +=
      0.5 * k.second * strain * strain - 2.0 * k.first * natural * strain + k.k * natural * natural;
}

Directors directors_of(const Frame& frame, const Vector3d& tangent, double theta) {
  const Vector3d first = turned_director({tangent, frame.director}, theta);
  return {first, tangent.cross(first)};
}

Edge edge_at(int e, const MaterialMesh& mesh, const SpatialState& state, const Law& law) {
  const double* q = state.q.data() + kBlock * e;
  Edge edge;
  const Vector3d d(q[4] - q[0], q[5] - q[1], q[6] - q[2]);
  edge.length = std::sqrt(d.squaredNorm());
  edge.inverse_length = 1.0 / edge.length;
  edge.tangent = edge.inverse_length * d;
  edge.rest = mesh.rest_length(e, state.controls);
  edge.theta = q[3];
  if (law.directed) {
    edge.directors = directors_of(state.frames[static_cast<std::size_t>(e)], edge.tangent, edge.theta);
  }
  return edge;
}

Edge mount_edge(const SpatialEnd& end, const std::optional<Frame>& frame, const Law& law) {
  Edge edge;
  if (!end.orients()) return edge;
  assert(frame && "the state was made for other mounts");
  edge.tangent = frame->tangent;
  edge.theta = end.twist_angle;
  if (law.directed) edge.directors = directors_of(*frame, edge.tangent, edge.theta);
  return edge;
}

/// Vertex i of n edges. `before`, `after`: its edges; at an end the mount stands for the outer one.
Cell cell_at(int i, int n, const Edge& before, const Edge& after, const SpatialState& state, const Law& law) {
  const SpatialRodProperties& p = law.properties;
  Cell cell;
  const SpatialEnd* end = i == 0 ? &p.left : (i == n ? &p.right : nullptr);
  if (end != nullptr && !end->orients()) return cell;
  const double length =
      end == nullptr ? 0.5 * (before.rest + after.rest) : 0.5 * (i == 0 ? after.rest : before.rest);
  cell.turn = make_turn(before.tangent, after.tangent);
  cell.inverse = {before.inverse_length, after.inverse_length};
  const double tau = after.theta - before.theta + state.reference_twist[static_cast<std::size_t>(i)];
  twist(tau, length, end == nullptr ? 0.0 : 1.0 / end->twisting_stiffness, p, cell);
  if (end == nullptr) {
    bend(before, after, length, 0.0, law, cell);
  } else if (end->kind == SpatialEnd::Kind::clamp) {
    bend(before, after, length, 1.0 / end->rotational_stiffness, law, cell);
  }
  return cell;
}

/// Calls visit(i, cell, before, after) at every vertex in order.
template <class Visitor>
void visit_cells(const MaterialMesh& mesh, const SpatialState& state, const Law& law, const Visitor& visit) {
  const int n = mesh.edges();
  assert(state.q.size() == kBlock * (n + 1) && static_cast<int>(state.frames.size()) == n &&
         "a state is made by make_state");
  Edge before = mount_edge(law.properties.left, state.left_mount, law);
  for (int i = 0; i <= n; ++i) {
    const Edge after =
        i < n ? edge_at(i, mesh, state, law) : mount_edge(law.properties.right, state.right_mount, law);
    visit(i, cell_at(i, n, before, after, state, law), before, after);
    before = after;
  }
}

PairGradient gradient_of(const Cell& cell, const Edge& before, const Edge& after) {
  PairGradient g;
  if (cell.bends) add_cosine_gradient(cell.turn, cell.inverse, cell.by_cosine, g);
  if (cell.directed) {
    WeightedCurvature(cell.turn, before.directors, after.directors, cell.by_kappa)
        .add_gradient(cell.inverse, g);
  }
  if (cell.twists) add_twist_gradient(cell.turn, cell.inverse, cell.torque, g);
  return g;
}

/// Derivative of the cell's gradient by its length.
PairGradient gradient_by_length(const Cell& cell, const Edge& before, const Edge& after) {
  PairGradient g;
  if (cell.bends) add_cosine_gradient(cell.turn, cell.inverse, cell.cosine_by_length, g);
  if (cell.directed) {
    WeightedCurvature(cell.turn, before.directors, after.directors, cell.kappa_by_length)
        .add_gradient(cell.inverse, g);
  }
  if (cell.twists) add_twist_gradient(cell.turn, cell.inverse, cell.torque_by_length, g);
  return g;
}

PairHessian hessian_of(const Cell& cell, const Edge& before, const Edge& after) {
  PairHessian h;
  if (cell.bends) add_cosine_hessian(cell.turn, cell.inverse, cell.by_cosine, cell.by_cosine_twice, h);
  if (cell.twists) add_twist_hessian(cell.turn, cell.inverse, cell.torque, cell.twist_stiffness, h);
  if (cell.directed) {
    WeightedCurvature(cell.turn, before.directors, after.directors, cell.by_kappa)
        .add_hessian(cell.inverse, h);
    PairGradient g1;
    PairGradient g2;
    WeightedCurvature(cell.turn, before.directors, after.directors, {1.0, 0.0})
        .add_gradient(cell.inverse, g1);
    WeightedCurvature(cell.turn, before.directors, after.directors, {0.0, 1.0})
        .add_gradient(cell.inverse, g2);
    add_square(g1, cell.anisotropy, h);
    add_square(g2, -cell.anisotropy, h);
  }
  return h;
}

/// Derivative of the cell's energy by a rigid rotation omega of what follows: dc = t.(omega x u),
/// dtau = omega.(t + u)/chi.
Vector3d moment_of(const Cell& cell, const Edge& before, const Edge& after) {
  Vector3d moment = Vector3d::Zero();
  if (cell.bends) moment -= 0.5 * cell.by_cosine * cell.turn.chi * cell.turn.binormal;
  if (cell.directed) {
    moment += WeightedCurvature(cell.turn, before.directors, after.directors, cell.by_kappa).by_rotation();
  }
  if (cell.twists) moment += cell.torque * cell.turn.mean;
  return moment;
}

/// Everything that belongs to one edge alone, collected from its two vertices and its stretching.
struct EdgeBlock {
  Vector3d force = Vector3d::Zero();      // dE/de
  Matrix3d stiffness = Matrix3d::Zero();  // d2E/de2
  Vector3d coupling = Vector3d::Zero();   // d2E/de dtheta
  double torsion = 0.0;                   // d2E/dtheta2
  double by_rest = 0.0;                   // through the cells' lengths
};

/// Adds an edge's block to its two vertices and its angle: e = x_{e+1} - x_e.
void scatter_edge(int e, const EdgeBlock& block, RodAssembly& out) {
  const int first = kBlock * e;
  double* g = out.gradient.data() + first;
  for (int r = 0; r < 3; ++r) {
    g[r] -= block.force[r];
    g[4 + r] += block.force[r];
  }
  for (int s = 0; s < 3; ++s) {
    double* near = out.hessian.column(first + s);  // entries of rows first + s + k
    double* far = out.hessian.column(first + 4 + s);
    for (int r = s; r < 3; ++r) {
      near[r - s] += block.stiffness(r, s);
      far[r - s] += block.stiffness(r, s);
    }
    for (int r = 0; r < 3; ++r) near[4 + r - s] -= block.stiffness(r, s);
    near[3 - s] -= block.coupling[s];
  }
  double* angle = out.hessian.column(first + 3);
  angle[0] += block.torsion;
  for (int r = 0; r < 3; ++r) angle[1 + r] += block.coupling[r];
}

/// Adds what couples the edges before (a) and after (b) vertex i: a = x_i - x_{i-1}, b = x_{i+1} - x_i.
void scatter_pair(int i, const PairHessian& h, RodAssembly& out) {
  const int first = kBlock * (i - 1);
  for (int s = 0; s < 3; ++s) {
    double* left = out.hessian.column(first + s);
    double* middle = out.hessian.column(first + 4 + s);
    for (int r = 0; r < 3; ++r) {
      left[4 + r - s] += h.ab(s, r);
      left[8 + r - s] -= h.ab(s, r);
      middle[4 + r - s] += h.ab(s, r);
    }
    for (int r = s; r < 3; ++r) middle[r - s] -= h.ab(r, s) + h.ab(s, r);
    left[7 - s] -= h.a_theta_b[s];
    middle[3 - s] += h.a_theta_b[s];
  }
  double* angle = out.hessian.column(first + 3);
  for (int r = 0; r < 3; ++r) {
    angle[1 + r] -= h.b_theta_a[r];
    angle[5 + r] += h.b_theta_a[r];
  }
  angle[4] += h.theta_ab;
}

void reset(RodAssembly& out, int unknowns, const std::array<bool, 3>& wanted) {
  out.energy = 0.0;
  out.gradient.setZero(unknowns);
  if (out.hessian.order() != unknowns || out.hessian.half_bandwidth() != SpatialRod::half_bandwidth) {
    out.hessian = numerics::SymmetricBandMatrix(unknowns, SpatialRod::half_bandwidth);
  } else {
    out.hessian.set_zero();
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (wanted[k]) out.control_columns[k].setZero(unknowns);
  }
  out.control_gradient.setZero();
  out.control_hessian.setZero();
}

double spring_energy(const SpatialEnd& end, double x) {
  if (end.kind == SpatialEnd::Kind::free || std::isinf(end.translational_stiffness)) return 0.0;
  const double give = x - end.position.x();
  return 0.5 * end.translational_stiffness * give * give;
}

bool feels_controls(const MaterialMesh& mesh, int i, int n, std::array<double, 3>& share) {
  bool any = false;
  for (int k = 0; k < 3; ++k) {
    const double before = i > 0 ? mesh.rest_length_derivative(i - 1, k) : 0.0;
    const double after = i < n ? mesh.rest_length_derivative(i, k) : 0.0;
    share[static_cast<std::size_t>(k)] = 0.5 * (before + after);
    any = any || share[static_cast<std::size_t>(k)] != 0.0;
  }
  return any;
}

}  // namespace

SpatialRod::SpatialRod(MaterialMesh mesh, const SpatialRodProperties& properties)
    : mesh_(std::move(mesh)), properties_(properties) {
  assert(properties.bending_stiffness > 0.0 && properties.second_bending_stiffness > 0.0);
  assert(properties.torsional_stiffness > 0.0 && properties.axial_stiffness > 0.0);
}

void SpatialRod::set_mounts(const SpatialEnd& left, const SpatialEnd& right) {
  properties_.left = left;
  properties_.right = right;
}

SpatialState SpatialRod::make_state(const Eigen::VectorXd& q, const Controls& controls) const {
  assert(q.size() == unknowns());
  const int n = mesh_.edges();
  SpatialState state;
  state.q = q;
  state.controls = controls;
  state.frames.resize(static_cast<std::size_t>(n));
  state.reference_twist.assign(static_cast<std::size_t>(n + 1), 0.0);
  const auto tangent = [&](int e) { return Vector3d(vertex(state, e + 1) - vertex(state, e)).normalized(); };
  Frame frame{tangent(0), any_normal(tangent(0))};
  if (properties_.left.orients()) {
    state.left_mount = Frame{properties_.left.direction, properties_.left.director};
    frame = *state.left_mount;
  }
  for (int e = 0; e < n; ++e) {
    frame = transport(frame, tangent(e));
    state.frames[static_cast<std::size_t>(e)] = frame;
  }
  if (properties_.right.orients()) {
    state.right_mount = Frame{properties_.right.direction, properties_.right.director};
    state.reference_twist.back() = reference_twist(frame, *state.right_mount, 0.0);
  }
  return state;
}

SpatialState SpatialRod::straight_state(const Controls& controls) const {
  const double length = controls[2] - controls[0];
  Eigen::VectorXd q = Eigen::VectorXd::Zero(unknowns());
  for (int i = 0; i < mesh_.vertices(); ++i) {
    const double share = (mesh_.coordinate(i, controls) - controls[0]) / length;
    q.segment<3>(block * i) = (1.0 - share) * properties_.left.position + share * properties_.right.position;
  }
  return make_state(q, controls);
}

void SpatialRod::adopt_mounts(SpatialState& state) const {
  Eigen::VectorXd q = state.q;
  const auto place = [&q](const SpatialEnd& end, int row) {
    if (end.kind == SpatialEnd::Kind::free) return;
    if (std::isinf(end.translational_stiffness)) q[row] = end.position.x();
    q.segment<2>(row + 1) = end.position.tail<2>();
  };
  place(properties_.left, 0);
  place(properties_.right, block * mesh_.edges());
  const auto orient = [](const SpatialEnd& end, std::optional<Frame>& frame) {
    frame.reset();
    if (end.orients()) frame = Frame{end.direction, end.director};
  };
  orient(properties_.left, state.left_mount);
  orient(properties_.right, state.right_mount);
  accept(state, q);
}

void accept(SpatialState& state, const Eigen::VectorXd& q) {
  assert(q.size() == state.q.size());
  state.q = q;
  const std::size_t n = state.frames.size();
  const double* x = state.q.data();
  for (std::size_t e = 0; e < n; ++e, x += kBlock) {
    Vector3d tangent(x[4] - x[0], x[5] - x[1], x[6] - x[2]);
    tangent *= 1.0 / std::sqrt(tangent.squaredNorm());
    state.frames[e] = transport(state.frames[e], tangent);
  }
  const auto update = [&state](std::size_t i, const Frame& before, const Frame& after) {
    state.reference_twist[i] = reference_twist(before, after, state.reference_twist[i]);
  };
  if (state.left_mount) update(0, *state.left_mount, state.frames.front());
  for (std::size_t i = 1; i < n; ++i) update(i, state.frames[i - 1], state.frames[i]);
  if (state.right_mount) update(n, state.frames.back(), *state.right_mount);
}

double SpatialRod::energy(const SpatialState& state) const {
  double sum = spring_energy(properties_.left, state.q[0]) +
               spring_energy(properties_.right, state.q[block * mesh_.edges()]);
  const int n = mesh_.edges();
  visit_cells(mesh_, state, Law(properties_), [&](int i, const Cell& cell, const Edge&, const Edge& after) {
    sum += cell.energy;
    if (i == n) return;
    const double strain = after.length / after.rest - 1.0;
    sum += 0.5 * properties_.axial_stiffness * strain * strain * after.rest;
    sum -= 0.5 * after.rest * properties_.weight.dot(vertex(state, i) + vertex(state, i + 1));
  });
  return sum;
}

void SpatialRod::assemble_forces(const SpatialState& state, RodAssembly& out) const {
  const int n = mesh_.edges();
  const double ea = properties_.axial_stiffness;
  out.energy = spring_energy(properties_.left, state.q[0]) + spring_energy(properties_.right, state.q[block * n]);
  out.gradient.setZero(unknowns());
  double* g = out.gradient.data();
  const auto add_edge = [g](int e, const Vector3d& force) {
    for (int r = 0; r < 3; ++r) {
      g[block * e + r] -= force[r];
      g[block * (e + 1) + r] += force[r];
    }
  };
  visit_cells(mesh_, state, Law(properties_), [&](int i, const Cell& cell, const Edge& before, const Edge& after) {
    out.energy += cell.energy;
    if (cell.bends || cell.twists) {
      const PairGradient pair = gradient_of(cell, before, after);
      if (i > 0) {
        add_edge(i - 1, pair.a);
        g[block * (i - 1) + 3] += pair.theta_a;
      }
      if (i < n) {
        add_edge(i, pair.b);
        g[block * i + 3] += pair.theta_b;
      }
    }
    if (i == n) return;
    const double strain = after.length / after.rest - 1.0;
    add_edge(i, ea * strain * after.tangent);
    out.energy += 0.5 * ea * strain * strain * after.rest -
                  0.5 * after.rest * properties_.weight.dot(vertex(state, i) + vertex(state, i + 1));
    for (int r = 0; r < 3; ++r) {
      g[block * i + r] -= 0.5 * after.rest * properties_.weight[r];
      g[block * (i + 1) + r] -= 0.5 * after.rest * properties_.weight[r];
    }
  });
  const auto spring = [&](const SpatialEnd& end, int row) {
    if (end.kind == SpatialEnd::Kind::free || std::isinf(end.translational_stiffness)) return;
    g[row] += end.translational_stiffness * (state.q[row] - end.position.x());
  };
  spring(properties_.left, 0);
  spring(properties_.right, block * n);
}

void SpatialRod::assemble(const SpatialState& state, const std::array<bool, 3>& wanted,
                          RodAssembly& out) const {
  reset(out, unknowns(), wanted);
  const int n = mesh_.edges();
  const double ea = properties_.axial_stiffness;
  const Vector3d& weight = properties_.weight;
  EdgeBlock pending;  // of the edge before the vertex at hand

  // Stretching and weight of edge e, whose cells are complete; then its block goes to its vertices.
  const auto finish_edge = [&](int e, const Edge& edge, EdgeBlock& edge_block) {
    const double stretch = edge.length / edge.rest;
    const double tension = ea * (stretch - 1.0);
    const double axial = ea / edge.rest;
    const double lateral = tension * edge.inverse_length;
    edge_block.force += tension * edge.tangent;
    // d2l/de2 = (I - t t^T)/l
    const Vector3d along = (axial - lateral) * edge.tangent;
    edge_block.stiffness += along * edge.tangent.transpose();
    edge_block.stiffness.diagonal().array() += lateral;
    scatter_edge(e, edge_block, out);
    const double work = 0.5 * weight.dot(vertex(state, e) + vertex(state, e + 1));
    out.energy += 0.5 * ea * (stretch - 1.0) * (stretch - 1.0) * edge.rest - edge.rest * work;
    const Vector3d half_weight = (0.5 * edge.rest) * weight;
    out.gradient.segment<3>(block * e) -= half_weight;
    out.gradient.segment<3>(block * (e + 1)) -= half_weight;

    const double by_rest = edge_block.by_rest - 0.5 * ea * (stretch * stretch - 1.0) - work;
    for (int k = 0; k < 3; ++k) {
      const double share = mesh_.rest_length_derivative(e, k);
      if (share == 0.0) continue;
      out.control_gradient[k] += share * by_rest;
      for (int m = 0; m < 3; ++m) {
        out.control_hessian(k, m) += share * mesh_.rest_length_derivative(e, m) * axial * stretch * stretch;
      }
      if (!wanted[static_cast<std::size_t>(k)]) continue;
      Eigen::VectorXd& column = out.control_columns[static_cast<std::size_t>(k)];
      const Vector3d pull = (-share * axial * stretch) * edge.tangent;
      column.segment<3>(block * e) -= pull + (0.5 * share) * weight;
      column.segment<3>(block * (e + 1)) += pull - (0.5 * share) * weight;
    }
  };

  const auto add_cell_controls = [&](int i, const Cell& cell, const Edge& before, const Edge& after) {
    std::array<double, 3> share{};
    if (!feels_controls(mesh_, i, n, share)) return;
    for (int k = 0; k < 3; ++k) {
      for (int m = 0; m < 3; ++m) {
        out.control_hessian(k, m) +=
            share[static_cast<std::size_t>(k)] * share[static_cast<std::size_t>(m)] * cell.by_length_twice;
      }
    }
    if (!wanted[0] && !wanted[1] && !wanted[2]) return;
    const PairGradient slope = gradient_by_length(cell, before, after);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!wanted[k] || share[k] == 0.0) continue;
      Eigen::VectorXd& column = out.control_columns[k];
      const int row = block * i;
      if (i > 0) {
        column.segment<3>(row - block) -= share[k] * slope.a;
        column.segment<3>(row) += share[k] * slope.a;
        column[row - 1] += share[k] * slope.theta_a;
      }
      if (i < n) {
        column.segment<3>(row) -= share[k] * slope.b;
        column.segment<3>(row + block) += share[k] * slope.b;
        column[row + 3] += share[k] * slope.theta_b;
      }
    }
  };

  visit_cells(mesh_, state, Law(properties_),
              [&](int i, const Cell& cell, const Edge& before, const Edge& after) {
                EdgeBlock next;
                if (cell.bends || cell.twists) {
                  out.energy += cell.energy;
                  const PairGradient g = gradient_of(cell, before, after);
                  const PairHessian h = hessian_of(cell, before, after);
                  pending.force += g.a;
                  pending.stiffness += h.aa;
                  pending.coupling += h.a_theta_a;
                  pending.torsion += h.theta_aa;
                  pending.by_rest += 0.5 * cell.by_length;
                  next.force = g.b;
                  next.stiffness = h.bb;
                  next.coupling = h.b_theta_b;
                  next.torsion = h.theta_bb;
                  next.by_rest = 0.5 * cell.by_length;
                  if (i > 0) out.gradient[block * i - 1] += g.theta_a;
                  if (i < n) out.gradient[block * i + 3] += g.theta_b;
                  if (i > 0 && i < n) scatter_pair(i, h, out);
                  add_cell_controls(i, cell, before, after);
                }
                if (i > 0) finish_edge(i - 1, before, pending);
                pending = next;
              });

  const auto spring = [&](const SpatialEnd& end, int row) {
    if (end.kind == SpatialEnd::Kind::free || std::isinf(end.translational_stiffness)) return;
    out.energy += spring_energy(end, state.q[row]);
    out.gradient[row] += end.translational_stiffness * (state.q[row] - end.position.x());
    out.hessian.add(row, row, end.translational_stiffness);
  };
  spring(properties_.left, 0);
  spring(properties_.right, block * n);
}

void SpatialRod::hold_mounts(RodAssembly& assembly) const {
  const auto hold = [&assembly](int row) {
    assembly.gradient[row] = 0.0;
    assembly.hessian.hold(row);
    for (Eigen::VectorXd& column : assembly.control_columns) {
      if (column.size() > row) column[row] = 0.0;
    }
  };
  const auto mount = [&](const SpatialEnd& end, int row) {
    if (end.kind == SpatialEnd::Kind::free) return;
    if (std::isinf(end.translational_stiffness)) hold(row);
    hold(row + 1);
    hold(row + 2);
  };
  mount(properties_.left, 0);
  mount(properties_.right, block * mesh_.edges());
  hold(block * mesh_.edges() + 3);
}

SpatialRod::EndCell SpatialRod::end_cell(const SpatialState& state, bool right) const {
  const int n = mesh_.edges();
  const Law law(properties_);
  const Edge before = right ? edge_at(n - 1, mesh_, state, law) : mount_edge(properties_.left, state.left_mount, law);
  const Edge after = right ? mount_edge(properties_.right, state.right_mount, law) : edge_at(0, mesh_, state, law);
  const Cell cell = cell_at(right ? n : 0, n, before, after, state, law);
  EndCell result;
  if (!cell.bends && !cell.twists) return result;
  const PairGradient g = gradient_of(cell, before, after);
  const PairHessian h = hessian_of(cell, before, after);
  const Vector3d coupling = right ? h.a_theta_a : h.b_theta_b;
  result.gradient << (right ? g.a : g.b), (right ? g.theta_a : g.theta_b);
  result.hessian << (right ? h.aa : h.bb), coupling, coupling.transpose(), (right ? h.theta_aa : h.theta_bb);
  return result;
}

Eigen::Matrix3Xd SpatialRod::moments(const SpatialState& state) const {
  Eigen::Matrix3Xd result(3, mesh_.vertices());
  visit_cells(mesh_, state, Law(properties_),
              [&](int i, const Cell& cell, const Edge& before, const Edge& after) {
                result.col(i) = moment_of(cell, before, after);
              });
  return result;
}

std::array<Vector3d, 2> SpatialRod::end_moments(const SpatialState& state) const {
  const Law law(properties_);
  const int n = mesh_.edges();
  const Edge left = mount_edge(properties_.left, state.left_mount, law);
  const Edge right = mount_edge(properties_.right, state.right_mount, law);
  const Edge first = edge_at(0, mesh_, state, law);
  const Edge last = edge_at(n - 1, mesh_, state, law);
  return {moment_of(cell_at(0, n, left, first, state, law), left, first),
          moment_of(cell_at(n, n, last, right, state, law), last, right)};
}

Eigen::VectorXd SpatialRod::torques(const SpatialState& state) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(mesh_.vertices());
  visit_cells(mesh_, state, Law(properties_),
              [&](int i, const Cell& cell, const Edge&, const Edge&) { result[i] = cell.torque; });
  return result;
}

Eigen::VectorXd SpatialRod::tensions(const SpatialState& state) const {
  Eigen::VectorXd result(mesh_.edges());
  for (int e = 0; e < mesh_.edges(); ++e) {
    const double length = (vertex(state, e + 1) - vertex(state, e)).norm();
    result[e] = properties_.axial_stiffness * (length / mesh_.rest_length(e, state.controls) - 1.0);
  }
  return result;
}

}  // namespace snare::wire
