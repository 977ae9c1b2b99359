#include "wire/planar_rod.hpp"

#include "base/index.hpp"
#include "wire/planar_gradient.hpp"
#include "wire/series_stiffness.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

namespace snare::wire {

namespace {

/// One edge: its vector's length and unit tangent, its rest length, and the derivative of its direction angle
/// alpha, d alpha/d e = e_perp / l^2.
struct Edge {
  double tx, ty;  // unit tangent
  double length;
  double rest;
  double ax, ay;  // d alpha / d e
};

/// Bending of one vertex as a function of the turning angle phi.
struct Cell {
  double moment = 0.0;     // dE/dphi
  double stiffness = 0.0;  // d2E/dphi2
  double energy = 0.0;
  double by_length = 0.0;         // dE/d l_i
  double moment_by_length = 0.0;  // d2E/dphi d l_i
  double by_length_twice = 0.0;   // d2E/d l_i^2
};

Edge make_edge(double ex, double ey, double rest) {
  const double length = std::sqrt(ex * ex + ey * ey);
  const double inv = 1.0 / length;
  return {ex * inv, ey * inv, length, rest, -ey * inv * inv, ex * inv * inv};
}

/// Integrated curvature 2 tan(phi/2) = 2 sin(phi)/(1 + cos(phi)).                             theory.md (W.2)
double integrated_curvature(const Edge& before, const Edge& after) {
  const double cross = before.tx * after.ty - before.ty * after.tx;
  const double dot = before.tx * after.tx + before.ty * after.ty;
  return 2.0 * cross / (1.0 + dot);
}

/// What the bending of one vertex depends on beside its edges.
struct CellLaw {
  double length;             // l_i
  double factor;             // of EI here
  double mount_flexibility;  // of a clamp that gives [rad/(N m)]
  const double* slipped;     // of the sliders; null: virgin
};

/// A measure kappa of the turning phi and its derivatives by phi.
struct TurningMeasure {
  double value, slope, curvature;
};

/// E = 1/2 k s^2, s = kappa - n l, n the natural curvature; ' is d/dphi:
///   dE/dphi = k s kappa',   d2E/dphi2 = k (kappa'^2 + s kappa''),   d2E/dphi dl = (s dk/dl - k n) kappa',
///   dE/dl = 1/2 s^2 dk/dl - k n s,   d2E/dl2 = 1/2 s^2 d2k/dl2 - 2 n s dk/dl + k n^2
Cell bend_elastic(const TurningMeasure& kappa, const SeriesStiffness<double>& k, double length,
                  double natural_curvature) {
  const double strain = kappa.value - natural_curvature * length;
  Cell cell;
  cell.energy = 0.5 * k.k * strain * strain;
  cell.moment = k.k * strain * kappa.slope;
  cell.stiffness = k.k * (kappa.slope * kappa.slope + strain * kappa.curvature);
  cell.by_length = 0.5 * k.first * strain * strain - k.k * natural_curvature * strain;
  cell.moment_by_length = (k.first * strain - k.k * natural_curvature) * kappa.slope;
  cell.by_length_twice = 0.5 * k.second * strain * strain - 2.0 * k.first * natural_curvature * strain +
                         k.k * natural_curvature * natural_curvature;
  return cell;
}

/// kappa = 2 tan(phi/2): kappa' = 1 + kappa^2/4, kappa'' = kappa kappa'/2.                   theory.md (W.2)
TurningMeasure tangent_measure(double kappa) {
  const double slope = 1.0 + 0.25 * kappa * kappa;
  return {kappa, slope, 0.5 * kappa * slope};
}

/// Half a cell next to a mount that gives, whose spring is linear in the angle.               theory.md (W.6)
Cell turn_with_mount(double kappa, double ei, const CellLaw& law, double natural_curvature) {
  const SeriesStiffness<double> both = in_series(law.length, ei, law.mount_flexibility);
  const SeriesStiffness<double> a = of_the_angle(both, law.length, ei);
  const SeriesStiffness<double> b{both.k - a.k, both.first - a.first, both.second - a.second};
  Cell cell = bend_elastic({2.0 * std::atan(0.5 * kappa), 1.0, 0.0}, a, law.length, natural_curvature);
  const Cell rest = bend_elastic(tangent_measure(kappa), b, law.length, natural_curvature);
  cell.energy += rest.energy;
  cell.moment += rest.moment;
  cell.stiffness += rest.stiffness;
  cell.by_length += rest.by_length;
  cell.moment_by_length += rest.moment_by_length;
  cell.by_length_twice += rest.by_length_twice;
  return cell;
}

/// E = l W(c - n) with c = kappa/l and W, M = W', M' of the section with its sliders (W.13); kappa' as above:
///   dE/dphi = M kappa',   d2E/dphi2 = M'/l kappa'^2 + M kappa kappa'/2,   d2E/dphi dl = -M' c/l kappa',
///   dE/dl = W - c M,   d2E/dl2 = c^2 M'/l
Cell bend_with_sliders(double kappa, double ei, const CellLaw& law, const PlanarRodProperties& p) {
  const double l = law.length;
  const double c = kappa / l;
  const SectionResponse r = respond(ei, p.bending_sliders, c - p.natural_curvature, law.slipped);
  const double slope = 1.0 + 0.25 * kappa * kappa;
  Cell cell;
  cell.energy = l * r.energy;
  cell.moment = r.resultant * slope;
  cell.stiffness = r.tangent / l * slope * slope + 0.5 * r.resultant * kappa * slope;
  cell.by_length = r.energy - c * r.resultant;
  cell.moment_by_length = -r.tangent * c / l * slope;
  cell.by_length_twice = c * c * r.tangent / l;
  return cell;
}

double total_stiffness(double elastic, const std::vector<SliderElement>& sliders) {
  for (const SliderElement& s : sliders) elastic += s.stiffness;
  return elastic;
}

Cell bend(const Edge& before, const Edge& after, const CellLaw& law, const PlanarRodProperties& p) {
  const double kappa = integrated_curvature(before, after);
  const double ei = law.factor * p.bending_stiffness;
  if (law.mount_flexibility != 0.0)  // also beyond zero, for differences by it
    return turn_with_mount(kappa, total_stiffness(ei, p.bending_sliders), law, p.natural_curvature);
  if (p.bending_sliders.empty())
    return bend_elastic(tangent_measure(kappa), in_series(law.length, ei, 0.0), law.length,
                        p.natural_curvature);
  return bend_with_sliders(kappa, ei, law, p);
}

Edge direction_of(const PlanarEnd& end) {
  return {end.direction.x(), end.direction.y(), 1.0, 1.0, 0.0, 0.0};
}

double flexibility(const PlanarEnd& end) {
  return 1.0 / end.rotational_stiffness;
}

/// Factor of EI at a material coordinate.
double profile_at(const std::vector<double>& profile, double coordinate, const Controls& controls) {
  if (profile.empty()) return 1.0;
  const double at =
      (coordinate - controls.left) / controls.length() * static_cast<double>(profile.size() - 1);
  const double cell = std::clamp(std::floor(at), 0.0, static_cast<double>(profile.size()) - 2.0);
  const auto j = static_cast<std::size_t>(cell);
  return profile[j] + (at - cell) * (profile[j + 1] - profile[j]);
}

/// The edges on either side of vertex i; a clamp's direction stands for the edge outside.
struct Corner {
  Edge before, after;
  double length;
  double mount_flexibility;
  bool bends;
};

Corner corner_at(int i, const std::vector<Edge>& edges, const PlanarRodProperties& p) {
  const int last = static_cast<int>(edges.size());
  if (i == 0) {
    const Edge& after = edges.front();
    return {direction_of(p.left), after, 0.5 * after.rest, flexibility(p.left),
            p.left.kind == PlanarEnd::Kind::clamp};
  }
  if (i == last) {
    const Edge& before = edges.back();
    return {before, direction_of(p.right), 0.5 * before.rest, flexibility(p.right),
            p.right.kind == PlanarEnd::Kind::clamp};
  }
  const Edge& before = edges[base::at(i - 1)];
  const Edge& after = edges[base::at(i)];
  return {before, after, 0.5 * (before.rest + after.rest), 0.0, true};
}

/// Bending of vertex i between edges i-1 and i.
Cell bend_at(int i, const std::vector<Edge>& edges, const PlanarRodProperties& p, const MaterialMesh& mesh,
             const PlanarState& state) {
  const Corner corner = corner_at(i, edges, p);
  if (!corner.bends) return {};
  const double factor =
      p.bending_profile.empty()
          ? 1.0
          : profile_at(p.bending_profile, mesh.coordinate(i, state.controls), state.controls);
  const double* slipped = nullptr;
  if (state.memory != nullptr && !p.bending_sliders.empty()) {
    slipped = state.memory->bending.data() + base::at(i) * p.bending_sliders.size();
  }
  return bend(corner.before, corner.after, {corner.length, factor, corner.mount_flexibility, slipped}, p);
}

/// Axial force, its tangent and energy of edge e at a strain.
SectionResponse stretch_at(int e, double strain, const PlanarRodProperties& p, const PlanarState& state) {
  if (p.axial_sliders.empty()) {
    const double force = p.axial_stiffness * strain;
    return {force, p.axial_stiffness, 0.5 * force * strain};
  }
  const double* slipped =
      state.memory == nullptr ? nullptr : state.memory->axial.data() + base::at(e) * p.axial_sliders.size();
  return respond(p.axial_stiffness, p.axial_sliders, strain, slipped);
}

void fill_edges(const MaterialMesh& mesh, const PlanarState& state, std::vector<Edge>& edges) {
  const int n = mesh.edges();
  edges.resize(base::at(n));
  const double* q = state.q.data();
  for (int e = 0; e < n; ++e) {
    edges[base::at(e)] =
        make_edge(q[2 * e + 2] - q[2 * e], q[2 * e + 3] - q[2 * e + 1], mesh.rest_length(e, state.controls));
  }
}

/// Forces on the two vertices of an edge, x and y of the first at `row`: -f and f of the edge (W.3), less
/// half its weight on either.
void add_forces(int row, const std::array<double, 2>& f, const std::array<double, 2>& half_weight,
                RodAssembly& out) {
  double* near = out.gradient.data() + row;
  double* far = near + PlanarRod::block;
  for (std::size_t r = 0; r < 2; ++r) {
    near[r] -= f[r] + half_weight[r];
    far[r] += f[r] - half_weight[r];
  }
}

/// d2E/de2 of an edge, e = x_{e+1} - x_e.
struct EdgeStiffness {
  double xx, xy, yy;
};

/// Adds it to the edge's two vertices: [K -K; -K K], lower triangle; column(j)[i - j] is the entry (i, j).
void add_edge_stiffness(int row, const EdgeStiffness& k, numerics::SymmetricBandMatrix& hessian) {
  double* near_x = hessian.column(row);
  double* near_y = hessian.column(row + 1);
  double* far_x = hessian.column(row + 2);
  double* far_y = hessian.column(row + 3);
  near_x[0] += k.xx;
  near_x[1] += k.xy;
  near_x[2] -= k.xx;
  near_x[3] -= k.xy;
  near_y[0] += k.yy;
  near_y[1] -= k.xy;
  near_y[2] -= k.yy;
  far_x[0] += k.xx;
  far_x[1] += k.xy;
  far_y[0] += k.yy;
}

/// d phi_i/d(x_{i-1}, x_i, x_{i+1}) = (d_-, -d_- - d_+, d_+) with d = d alpha/de of the edges before and
/// after: phi = alpha_+ - alpha_-, e_- = x_i - x_{i-1}, e_+ = x_{i+1} - x_i. A mount's direction has d = 0.
/// (W.4)
struct TurnGradient {
  std::array<double, 6> values{};
  int row;         // unknown of values[0]
  int first, end;  // values that belong to vertices

  TurnGradient(int i, const std::vector<Edge>& edges) : row(PlanarRod::block * (i - 1)) {
    const bool has_before = i > 0;
    const bool has_after = i < static_cast<int>(edges.size());
    auto& [before_x, before_y, middle_x, middle_y, after_x, after_y] = values;
    if (has_before) {
      before_x = edges[base::at(i - 1)].ax;
      before_y = edges[base::at(i - 1)].ay;
    }
    if (has_after) {
      after_x = edges[base::at(i)].ax;
      after_y = edges[base::at(i)].ay;
    }
    middle_x = -before_x - after_x;
    middle_y = -before_y - after_y;
    first = has_before ? 0 : PlanarRod::block;
    end = has_after ? 6 : 4;
  }
};

/// Adds factor * v v^T.
void add_rank_one(const TurnGradient& v, double factor, numerics::SymmetricBandMatrix& hessian) {
  for (int a = v.first; a < v.end; ++a) {
    double* column = hessian.column(v.row + a);
    const double s = factor * v.values[base::at(a)];
    for (int b = a; b < v.end; ++b) column[b - a] += s * v.values[base::at(b)];
  }
}

/// dl/dS_k of vertex i's cell.
std::array<double, 3> length_by_controls(int i, const MaterialMesh& mesh) {
  std::array<double, 3> share{};
  for (int k = 0; k < 3; ++k) {
    share[base::at(k)] = 0.5 * ((i > 0 ? mesh.rest_length_derivative(i - 1, k) : 0.0) +
                                (i < mesh.edges() ? mesh.rest_length_derivative(i, k) : 0.0));
  }
  return share;
}

}  // namespace

PlanarRod::PlanarRod(MaterialMesh mesh, const PlanarRodProperties& properties)
    : mesh_(std::move(mesh)), properties_(properties) {
  assert(properties.bending_stiffness > 0.0 && properties.axial_stiffness > 0.0);
}

double PlanarRod::energy(const PlanarState& state) const {
  std::vector<Edge> edges;
  fill_edges(mesh_, state, edges);
  double sum = 0.0;
  for (int e = 0; e < mesh_.edges(); ++e) {
    const Edge& edge = edges[base::at(e)];
    const double strain = edge.length / edge.rest - 1.0;
    sum += stretch_at(e, strain, properties_, state).energy * edge.rest;
    sum -= 0.5 * edge.rest * properties_.weight.dot(vertex(state, e) + vertex(state, e + 1));
  }
  for (int i = 0; i <= mesh_.edges(); ++i) sum += bend_at(i, edges, properties_, mesh_, state).energy;
  const auto spring = [](const PlanarEnd& end, double x) {
    if (end.kind == PlanarEnd::Kind::free || std::isinf(end.translational_stiffness)) return 0.0;
    const double give = x - end.position.x();
    return 0.5 * end.translational_stiffness * give * give;
  };
  return sum + spring(properties_.left, state.q[0]) + spring(properties_.right, state.q[2 * mesh_.edges()]);
}

namespace {

/// derivatives: the Hessian and what goes with it, else the gradient alone.
template <bool derivatives>
void assemble_into(const PlanarRod& rod, const PlanarState& state, const std::array<bool, 3>& wanted,
                   RodAssembly& out) {
  const MaterialMesh& mesh = rod.mesh();
  const PlanarRodProperties& properties = rod.properties();
  thread_local std::vector<Edge> edges;
  thread_local std::vector<Cell> cells;
  const int n = mesh.edges();
  const int unknown_count = rod.unknowns();
  fill_edges(mesh, state, edges);
  cells.resize(base::at(n + 1));
  for (int i = 0; i <= n; ++i) cells[base::at(i)] = bend_at(i, edges, properties, mesh, state);

  out.gradient.setZero(unknown_count);
  if constexpr (!derivatives) {
    // Stays as it was.
  } else if (out.hessian.order() != unknown_count) {
    out.hessian = numerics::SymmetricBandMatrix(unknown_count, PlanarRod::half_bandwidth);
  } else {
    out.hessian.set_zero();
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (wanted[k]) out.control_columns[k].setZero(unknown_count);
  }
  out.control_gradient.setZero();
  if constexpr (derivatives) out.control_hessian.setZero();
  out.energy = 0.0;

  const double wx = properties.weight.x();
  const double wy = properties.weight.y();
  for (int e = 0; e < n; ++e) {
    const Edge& edge = edges[base::at(e)];
    const Cell& left = cells[base::at(e)];
    const Cell& right = cells[base::at(e + 1)];
    const double stretch = edge.length / edge.rest;
    const SectionResponse section = stretch_at(e, stretch - 1.0, properties, state);
    const double tension = section.resultant;
    // dE/de = T t + (M_i - M_{i+1}) e_perp/l^2 (W.3): a turn of the edge by alpha adds to phi_i of its left
    // vertex, whose outgoing edge it is, and takes from phi_{i+1} of its right one.
    const double turn = left.moment - right.moment;
    const double gx = tension * edge.tx + turn * edge.ax;
    const double gy = tension * edge.ty + turn * edge.ay;
    const double half = 0.5 * edge.rest;
    add_forces(2 * e, {gx, gy}, {half * wx, half * wy}, out);

    const double axial = section.tangent / edge.rest;
    if constexpr (derivatives) {
      // d2l/de2 = (I - t t^T)/l, so that stretching has EA/h t t^T + T (I - t t^T)/l;
      // d2alpha/de2 = -(e e_perp^T + e_perp e^T)/l^4 (W.4).
      const double lateral = tension / edge.length;
      const double bxx = (axial - lateral) * edge.tx * edge.tx + lateral;
      const double bxy = (axial - lateral) * edge.tx * edge.ty;
      const double byy = (axial - lateral) * edge.ty * edge.ty + lateral;
      const double twist = -turn / (edge.length * edge.length);
      add_edge_stiffness(
          2 * e,
          {bxx - 2.0 * twist * edge.tx * edge.ty, bxy + twist * (edge.tx * edge.tx - edge.ty * edge.ty),
           byy + 2.0 * twist * edge.tx * edge.ty},
          out.hessian);
    }

    // By the rest length, through the edge and through the two cells it belongs to.
    const double middle_x = 0.5 * (state.q[2 * e] + state.q[2 * e + 2]);
    const double middle_y = 0.5 * (state.q[2 * e + 1] + state.q[2 * e + 3]);
    const double weight_work = wx * middle_x + wy * middle_y;
    out.energy += section.energy * edge.rest - edge.rest * weight_work;
    const double by_rest =
        section.energy - stretch * tension - weight_work + 0.5 * (left.by_length + right.by_length);
    for (int k = 0; k < 3; ++k) {
      const double share = mesh.rest_length_derivative(e, k);
      if (share == 0.0) continue;
      out.control_gradient[k] += share * by_rest;
      if constexpr (!derivatives) continue;
      for (int m = 0; m < 3; ++m) {
        out.control_hessian(k, m) += share * mesh.rest_length_derivative(e, m) * axial * stretch * stretch;
      }
      if (!wanted[base::at(k)]) continue;
      double* column = out.control_columns[base::at(k)].data() + 2 * e;
      const double pull = -share * axial * stretch;
      column[0] -= pull * edge.tx + 0.5 * share * wx;
      column[1] -= pull * edge.ty + 0.5 * share * wy;
      column[2] += pull * edge.tx - 0.5 * share * wx;
      column[3] += pull * edge.ty - 0.5 * share * wy;
    }
  }

  // Mounts that give along x: 1/2 k (x - X)^2 (W.6).
  const auto spring = [&](const PlanarEnd& end, int row) {
    if (end.kind == PlanarEnd::Kind::free || std::isinf(end.translational_stiffness)) return;
    const double give = state.q[row] - end.position.x();
    out.energy += 0.5 * end.translational_stiffness * give * give;
    out.gradient[row] += end.translational_stiffness * give;
    if constexpr (derivatives) out.hessian.add(row, row, end.translational_stiffness);
  };
  spring(properties.left, 0);
  spring(properties.right, 2 * n);

  // Rank-one part of bending (W.4): M' v v^T with v = d phi/d(x_{i-1}, x_i, x_{i+1}), M' = d2E/dphi2.
  for (int i = 0; i <= n; ++i) {
    const Cell& cell = cells[base::at(i)];
    out.energy += cell.energy;
    if (!derivatives || cell.stiffness == 0.0) continue;
    const TurnGradient v(i, edges);
    add_rank_one(v, cell.stiffness, out.hessian);
    // By the cell's length l = (h_{i-1} + h_i)/2, linear in the controls (W.10).
    const std::array<double, 3> share = length_by_controls(i, mesh);
    for (std::size_t k = 0; k < 3; ++k) {
      if (share[k] == 0.0) continue;
      for (std::size_t m = 0; m < 3; ++m) {
        out.control_hessian(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(m)) +=
            share[k] * share[m] * cell.by_length_twice;
      }
      if (!wanted[k]) continue;
      Eigen::VectorXd& column = out.control_columns[k];
      for (int a = v.first; a < v.end; ++a)
        column[v.row + a] += share[k] * cell.moment_by_length * v.values[base::at(a)];
    }
  }
}

}  // namespace

void PlanarRod::assemble(const PlanarState& state, const std::array<bool, 3>& wanted,
                         RodAssembly& out) const {
  assemble_into<true>(*this, state, wanted, out);
}

void assemble_gradient(const PlanarRod& rod, const PlanarState& state, RodAssembly& out) {
  assemble_into<false>(rod, state, {false, false, false}, out);
}

namespace {

/// Calls `action` with every unknown that the mounts hold rigidly.
template <class Action>
void for_each_held(const PlanarRodProperties& p, int edges, const Action& action) {
  const auto mount = [&action](const PlanarEnd& end, int first_row) {
    if (end.kind == PlanarEnd::Kind::free) return;
    if (std::isinf(end.translational_stiffness)) action(first_row);
    action(first_row + 1);
  };
  mount(p.left, 0);
  mount(p.right, 2 * edges);
}

}  // namespace

void PlanarRod::hold_mounts(RodAssembly& assembly) const {
  for_each_held(properties_, mesh_.edges(), [&assembly](int row) {
    assembly.gradient[row] = 0.0;
    assembly.hessian.hold(row);
    for (Eigen::VectorXd& column : assembly.control_columns) {
      if (column.size() > row) column[row] = 0.0;
    }
  });
}

void PlanarRod::clear_held(Eigen::VectorXd& band) const {
  for_each_held(properties_, mesh_.edges(), [&band](int row) { band[row] = 0.0; });
}

Eigen::VectorXd PlanarRod::moments(const PlanarState& state) const {
  std::vector<Edge> edges;
  fill_edges(mesh_, state, edges);
  Eigen::VectorXd result(mesh_.vertices());
  for (int i = 0; i < mesh_.vertices(); ++i) result[i] = bend_at(i, edges, properties_, mesh_, state).moment;
  return result;
}

Eigen::VectorXd PlanarRod::tensions(const PlanarState& state) const {
  std::vector<Edge> edges;
  fill_edges(mesh_, state, edges);
  Eigen::VectorXd result(mesh_.edges());
  for (int e = 0; e < mesh_.edges(); ++e) {
    const Edge& edge = edges[base::at(e)];
    result[e] = stretch_at(e, edge.length / edge.rest - 1.0, properties_, state).resultant;
  }
  return result;
}

double PlanarRod::rate_form(const PlanarState& state, const PlanarState& rate) const {
  // Central differences of strain and curvature along the rate: exact to the square of a step that moves the
  // wire by a millionth of its length.
  const double largest = std::max(rate.q.lpNorm<Eigen::Infinity>(), 1e-300);
  const double h = 1e-6 * state.controls.length() / largest;
  std::array<std::vector<Edge>, 2> edges;
  for (const int side : {0, 1}) {
    PlanarState moved = state;
    const double sign = side == 0 ? -h : h;
    moved.q += sign * rate.q;
    for (std::size_t k = 0; k < 3; ++k) moved.controls[k] += sign * rate.controls[k];
    fill_edges(mesh_, moved, edges[base::at(side)]);
  }
  double sum = 0.0;
  for (int e = 0; e < mesh_.edges(); ++e) {
    const Edge& low = edges[0][base::at(e)];
    const Edge& high = edges[1][base::at(e)];
    const double strain_rate = (high.length / high.rest - low.length / low.rest) / (2.0 * h);
    sum += properties_.axial_stiffness * strain_rate * strain_rate * mesh_.rest_length(e, state.controls);
  }
  for (int i = 0; i <= mesh_.edges(); ++i) {
    const Corner low = corner_at(i, edges[0], properties_);
    if (!low.bends) continue;
    const Corner high = corner_at(i, edges[1], properties_);
    const double length = 0.5 * (low.length + high.length);
    const double curvature_rate = (integrated_curvature(high.before, high.after) / high.length -
                                   integrated_curvature(low.before, low.after) / low.length) /
                                  (2.0 * h);
    sum += properties_.bending_stiffness * curvature_rate * curvature_rate * length;
  }
  return sum;
}

SectionMemory PlanarRod::remembered(const PlanarState& state) const {
  const PlanarRodProperties& p = properties_;
  std::vector<Edge> edges;
  fill_edges(mesh_, state, edges);
  SectionMemory result;
  result.controls = state.controls;
  if (state.memory != nullptr) {
    result.bending = state.memory->bending;
    result.axial = state.memory->axial;
  }
  const std::size_t bending = p.bending_sliders.size();
  const std::size_t axial = p.axial_sliders.size();
  result.bending.resize(bending * base::at(mesh_.vertices()), 0.0);
  result.axial.resize(axial * base::at(mesh_.edges()), 0.0);
  for (int i = 0; i <= mesh_.edges() && bending > 0; ++i) {
    const Corner corner = corner_at(i, edges, p);
    if (!corner.bends || corner.mount_flexibility > 0.0) continue;
    slide(p.bending_sliders,
          integrated_curvature(corner.before, corner.after) / corner.length - p.natural_curvature,
          result.bending.data() + base::at(i) * bending);
  }
  for (int e = 0; e < mesh_.edges() && axial > 0; ++e) {
    const Edge& edge = edges[base::at(e)];
    slide(p.axial_sliders, edge.length / edge.rest - 1.0, result.axial.data() + base::at(e) * axial);
  }
  // Within the step the sliders went along with the vertices; what had slipped before belongs to the
  // material.
  if (state.memory != nullptr && state.memory->controls != state.controls) {
    const auto carry = [&](const std::vector<double>& old, std::vector<double>& now, std::size_t elements,
                           bool of_edges) {
      const std::vector<double> carried = carried_over(mesh_, old, static_cast<int>(elements), of_edges,
                                                       state.memory->controls, state.controls);
      for (std::size_t i = 0; i < now.size(); ++i) now[i] += carried[i] - old[i];
    };
    carry(state.memory->bending, result.bending, bending, false);
    carry(state.memory->axial, result.axial, axial, true);
  }
  return result;
}

}  // namespace snare::wire
