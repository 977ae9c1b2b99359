#include "coupling/statics/push_path.hpp"
#include "coupling/statics/push_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace snare::coupling {

namespace {

constexpr int coarsest = 4;  // of the edges of the mesh, one

/// The values that are extrapolated, in addition to the derivatives of the force. All forces on the wire are
/// among them, and are extrapolated together or not at all: their balance holds after extrapolation as it
/// does on every mesh. The place of the contact is extrapolated by itself, the energy at all points of a
/// curve or at none, since only its differences mean something.
constexpr std::array extrapolated_values{&PushPoint::force,
                                         &PushPoint::transverse_force,
                                         &PushPoint::axial_force,
                                         &PushPoint::tension_left,
                                         &PushPoint::tension_right,
                                         &PushPoint::reaction_along_left,
                                         &PushPoint::reaction_across_left,
                                         &PushPoint::reaction_z_left,
                                         &PushPoint::reaction_along_right,
                                         &PushPoint::reaction_across_right,
                                         &PushPoint::reaction_z_right,
                                         &PushPoint::energy,
                                         &PushPoint::contact_coordinate};
constexpr std::size_t extrapolated_forces = extrapolated_values.size() - 2, energy = extrapolated_forces;

/// What a coarser mesh contributes to a point. A curve of a million of them is large: the rest goes.
struct CoarsePoint {
  CoarsePoint(const PushPoint& p, const double* derivatives)
      : travel(p.travel),
        force_by(derivatives),
        iterations(p.iterations),
        unstable_modes(p.unstable_modes),
        in_contact(p.in_contact),
        slipping(p.slipping) {
    for (std::size_t v = 0; v < values.size(); ++v) values[v] = p.*extrapolated_values[v];
  }
  [[nodiscard]] bool same_state(const PushPoint& p) const {
    return in_contact == p.in_contact && slipping == p.slipping && unstable_modes == p.unstable_modes;
  }

  double travel;
  std::array<double, extrapolated_values.size()> values{};
  const double* force_by;  ///< in `CoarseCurve::derivatives`, as many as the finest mesh has
  int iterations, unstable_modes;
  bool in_contact, slipping;
};

struct CoarseCurve {
  explicit CoarseCurve(PushCurve curve)
      : natural_height(curve.natural_height),
        touch_height(curve.touch_height),
        newton_iterations(curve.newton_iterations),
        report(std::move(curve.report)) {
    std::size_t count = 0;
    for (const PushPoint& p : curve.points) count += p.force_by.size();
    derivatives.reserve(count);  // points refer to it: it does not grow
    points.reserve(curve.points.size());
    for (const PushPoint& p : curve.points) {
      points.emplace_back(p, derivatives.data() + derivatives.size());
      derivatives.insert(derivatives.end(), p.force_by.begin(), p.force_by.end());
    }
  }
  CoarseCurve(CoarseCurve&&) = default;
  CoarseCurve(const CoarseCurve&) = delete;

  double natural_height, touch_height;
  int newton_iterations;
  numerics::SolveReport report;
  std::vector<double> derivatives;  ///< of the forces of all points, one point behind another
  std::vector<CoarsePoint> points;
};

/// A value on meshes of h, 2 h and 4 h.
struct Refinement {
  double fine, half, quarter;

  [[nodiscard]] double extrapolated() const {
    return (64.0 * fine - 20.0 * half + quarter) / 45.0;
  }  // theory.md (W.11)
  [[nodiscard]] double largest_change() const {
    return std::max(std::abs(fine - half), std::abs(half - quarter));
  }
  /// Whether the change falls as it does with a power of h between 1 and 5.
  [[nodiscard]] bool in_order() const {
    const double ratio = (fine - half) / (half - quarter);
    return ratio >= 1.0 / 40.0 && ratio <= 0.5;
  }
};

using Refinements = std::array<Refinement, extrapolated_values.size()>;

/// Whether the forces of a point are of one branch: each converges in order, or changes by less than a tenth
/// of itself, as where its error passes through zero. Those that hardly change beside the others are not
/// asked.
bool are_of_one_branch(const Refinements& values) {
  constexpr double hardly = 0.05, much = 0.1;
  const auto forces = std::span(values).first<extrapolated_forces>();
  double largest = 0.0;
  for (const Refinement& r : forces) largest = std::max(largest, r.largest_change());
  return std::ranges::all_of(forces, [&](const Refinement& r) {
    return r.largest_change() <= std::max(hardly * largest, much * std::abs(r.fine)) || r.in_order();
  });
}

/// Extrapolates the values of a point that converge in order, and returns what is left of the error of the
/// force [N].
double extrapolate(PushPoint& p, const CoarsePoint& half, const CoarsePoint& quarter) {
  Refinements values;
  for (std::size_t v = 0; v < values.size(); ++v)
    values[v] = {p.*extrapolated_values[v], half.values[v], quarter.values[v]};
  const Refinement& arc = values.back();
  static_assert(extrapolated_values[energy] == &PushPoint::energy);
  static_assert(extrapolated_values.back() == &PushPoint::contact_coordinate);
  if (arc.in_order()) p.contact_coordinate = arc.extrapolated();
  const Refinement& force = values.front();
  static_assert(extrapolated_values.front() == &PushPoint::force);
  if (!are_of_one_branch(values)) return force.largest_change();
  for (std::size_t v = 0; v < extrapolated_forces; ++v) p.*extrapolated_values[v] = values[v].extrapolated();
  for (std::size_t v = 0; v < p.force_by.size(); ++v)
    p.force_by[v] = Refinement{p.force_by[v], half.force_by[v], quarter.force_by[v]}.extrapolated();
  const double third_order = (32.0 * force.fine - 12.0 * force.half + force.quarter) / 21.0;
  return force.in_order() ? 2.0 * std::abs(p.force - third_order) : force.largest_change();
}

/// values: one a point, fewer where points have no partners on the coarser meshes.
void extrapolate_energies(const std::vector<Refinement>& values, std::vector<PushPoint>& points) {
  constexpr double much = 0.1, nothing = 1e-6;  // of the energy there, of the largest
  double largest = 0.0;
  for (const Refinement& r : values) largest = std::max(largest, std::abs(r.fine));
  const bool all =
      values.size() == points.size() && std::ranges::all_of(values, [&](const Refinement& r) {
        return r.in_order() || r.largest_change() <= std::max(much * std::abs(r.fine), nothing * largest);
      });
  for (std::size_t i = 0; all && i < points.size(); ++i) points[i].energy = values[i].extrapolated();
}

/// Of a coarse mesh only the curve is wanted, in the steps of the finest.
PushOptions coarse(const PushOptions& options, const PushCurve& finest) {
  PushOptions result = options;
  result.steps = finest.steps;
  result.shapes_at.clear();
  result.progress = nullptr;
  result.examine_out_of_plane = false;
  result.examine_rates = false;
  return result;
}

/// Without the variations, and every second of the steps left out.
CoarseCurve with_longer_steps(const PushProblem& test, PushOptions options) {
  options.variations.clear();
  for (std::vector<double>& leg : options.steps) {
    std::vector<double> ends;
    for (std::size_t k = 1; k < leg.size(); k += 2) ends.push_back(leg[k]);
    if (leg.size() % 2 == 1) ends.push_back(leg.back());
    leg = std::move(ends);
  }
  return CoarseCurve(solve_push(test, options, coarsest));
}

// Index of the next point at a travel, searched from an index on; the number of points where the search
// fails.
std::size_t find(const std::vector<CoarsePoint>& points, std::size_t from, double travel) {
  while (from < points.size() && points[from].travel != travel) ++from;
  return from;
}

// The point at a travel, and the index from which the next one is searched; null where there is none.
const CoarsePoint* next(const std::vector<CoarsePoint>& points, std::size_t& from, double travel) {
  const std::size_t found = find(points, from, travel);
  if (found == points.size()) return nullptr;
  from = found + 1;
  return &points[found];
}

// The path is of first order in its steps: the change of its force in steps twice as long estimates its
// error. Errors are remembered by the path, so the largest one up to a point counts.
void add_path_error(const CoarseCurve& steps, const CoarseCurve& longer, ExtrapolatedCurve& result) {
  double largest = 0.0;
  std::size_t in_steps = 0;
  std::size_t in_longer = 0;
  for (std::size_t i = 0; i < result.curve.points.size(); ++i) {
    const double travel = result.curve.points[i].travel;
    const std::size_t j = find(steps.points, in_steps, travel);
    const std::size_t k = find(longer.points, in_longer, travel);
    if (j < steps.points.size() && k < longer.points.size()) {
      in_steps = j + 1;
      in_longer = k + 1;
      largest = std::max(largest, std::abs(steps.points[j].values[0] - longer.points[k].values[0]));
    }
    result.discretisation_error[i] += largest;
  }
}

}  // namespace

ExtrapolatedCurve solve_push_with_path_error(const PushProblem& test, const PushOptions& options) {
  ExtrapolatedCurve result;
  result.curve = solve_push(test, options);
  result.discretisation_error.assign(result.curve.points.size(), 0.0);
  if (result.curve.steps.empty() || result.curve.report.termination == numerics::Termination::interrupted)
    return result;
  PushOptions same_steps = coarse(options, result.curve);
  same_steps.variations.clear();
  const CoarseCurve steps(solve_push(test, same_steps, coarsest));
  const CoarseCurve longer = with_longer_steps(test, same_steps);
  result.curve.newton_iterations += steps.newton_iterations + longer.newton_iterations;
  add_path_error(steps, longer, result);
  return result;
}

ExtrapolatedCurve solve_push_extrapolated(const PushProblem& test, const PushOptions& options) {
  ExtrapolatedCurve result;
  result.curve = solve_push(test, options);
  result.discretisation_error.assign(result.curve.points.size(), 0.0);
  if (result.curve.report.termination == numerics::Termination::interrupted) return result;
  const PushOptions on_coarse = coarse(options, result.curve);
  const CoarseCurve half(solve_push(test, on_coarse, 2));
  const CoarseCurve quarter(solve_push(test, on_coarse, coarsest));
  result.curve.newton_iterations += half.newton_iterations + quarter.newton_iterations;
  for (const CoarseCurve* other : {&half, &quarter}) {
    if (other->report.termination != numerics::Termination::interrupted) continue;
    result.curve.report = other->report;  // the forces of the fine mesh stay as they are
    return result;
  }
  if (half.report.usable() && quarter.report.usable()) {
    PushCurve& c = result.curve;
    c.natural_height =
        Refinement{c.natural_height, half.natural_height, quarter.natural_height}.extrapolated();
    c.touch_height = Refinement{c.touch_height, half.touch_height, quarter.touch_height}.extrapolated();
  }

  // Points are paired in the order in which they were reached; arcs through folds have travels of their own.
  std::size_t in_half = 0;
  std::size_t in_quarter = 0;
  std::vector<Refinement> energies;
  for (std::size_t i = 0; i < result.curve.points.size(); ++i) {
    PushPoint& p = result.curve.points[i];
    const CoarsePoint* h = next(half.points, in_half, p.travel);
    const CoarsePoint* q = next(quarter.points, in_quarter, p.travel);
    double& error = result.discretisation_error[i];
    if (h) p.iterations += h->iterations;
    if (q) p.iterations += q->iterations;
    if (h && q && h->same_state(p) && q->same_state(p)) {
      error = extrapolate(p, *h, *q);
      energies.push_back({p.energy, h->values[energy], q->values[energy]});
    } else {  // in other states of contact, or a mesh has not come here: they differ by what they err
      for (const CoarsePoint* other : {h, q})
        if (other) error = std::max(error, std::abs(p.force - other->values.front()));
      if (!h && !q) error = std::numeric_limits<double>::quiet_NaN();
    }
  }
  extrapolate_energies(energies, result.curve.points);
  if (!result.curve.steps.empty()) {
    const CoarseCurve longer = with_longer_steps(test, on_coarse);
    result.curve.newton_iterations += longer.newton_iterations;
    add_path_error(quarter, longer, result);
  }
  return result;
}

}  // namespace snare::coupling
