#include "numerics/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::numerics {

namespace {

// Newton's method on an assembled problem; `finish` completes system and residuals after each assembly,
// `take` applies a step to the point.
template <class Finish, class Take>
SolveReport newton(PathProblem& problem, PathPoint& point, PathWorkspace& w, int max_iterations,
                   const Finish& finish, const Take& take) {
  SolveReport report;
  w.factored = false;
  double best = std::numeric_limits<double>::max();
  int worse = 0;
  double last_change = std::numeric_limits<double>::max();
  for (report.iterations = 0;; ++report.iterations) {
    problem.assemble(point, w.system, w.by_parameter);
    report.residual_norm = problem.error(point, w.system);
    finish(w);
    if (!std::isfinite(report.residual_norm)) {
      return report.end(Termination::not_finite, "a residual is not finite");
    }
    // The extra equation of the arc is linear and holds after one step; the first pass always takes one.
    if (report.residual_norm <= 1.0 &&
        (report.iterations > 0 || w.system.border_residual.size() == point.border.size())) {
      return report.end(Termination::converged);
    }
    // A step below the last place of the coordinates cannot be improved on.
    if (last_change < 1e-15 * problem.length_scale() && report.residual_norm <= 1e3) {
      return report.end(Termination::converged);
    }
    // No progress for three iterations ends it.
    worse = report.residual_norm < best ? 0 : worse + 1;
    // Round-off may keep the residual at some times its tolerance: no iteration lowers it then.
    if (worse > 0 && best <= 16.0 && report.residual_norm <= 16.0) {
      return report.end(Termination::converged);
    }
    best = std::min(best, report.residual_norm);
    if (report.iterations == max_iterations || worse >= 3) {
      return report.end(Termination::iteration_limit, "Newton's method did not converge");
    }
    if (!w.solver.factorize(w.system)) {
      return report.end(Termination::singular_matrix, "the tangent matrix is singular");
    }
    w.factored = true;
    // [K C; D E] (dq, db) = -(r_q, r_b).                                                      theory.md (N.1)
    w.band_step = -w.system.band_residual;
    w.border_step = -w.system.border_residual;
    w.solver.solve(w.system, w.band_step, w.border_step);
    last_change = w.band_step.lpNorm<Eigen::Infinity>();
    const double far = last_change / (0.1 * problem.length_scale());
    if (!(far < 1e6)) {
      return report.end(Termination::singular_matrix, "the tangent matrix is nearly singular");
    }
    // No step moves a band unknown by more than a tenth of the length.
    if (far > 1.0) {
      w.band_step /= far;
      w.border_step /= far;
    }
    take(w);
  }
}

}  // namespace

SolveReport correct(PathProblem& problem, PathPoint& point, PathWorkspace& workspace, int max_iterations) {
  return newton(
      problem, point, workspace, max_iterations, [](PathWorkspace&) {},
      [&point](PathWorkspace& w) {
        point.band += w.band_step;
        point.border += w.border_step;
      });
}

std::optional<PathTangent> tangent(PathProblem& problem, const PathPoint& point, PathWorkspace& workspace,
                                   const PathTangent* like) {
  problem.assemble(point, workspace.system, workspace.by_parameter);
  if (!workspace.solver.factorize(workspace.system))
    return like != nullptr ? std::optional(*like) : std::nullopt;
  PathTangent result;
  // [K C; D E] (q', b') = -(0, d r_b/d p) with p' = 1, then scaled to |q'|^2/n + p'^2 = 1.    theory.md (N.4)
  result.band.setZero(point.band.size());
  result.border = -workspace.by_parameter;
  workspace.solver.solve(workspace.system, result.band, result.border);
  const double norm = std::sqrt(result.band.squaredNorm() / static_cast<double>(point.band.size()) + 1.0);
  double factor = 1.0 / norm;
  if (like != nullptr) {
    const double product =
        like->band.dot(result.band) / static_cast<double>(point.band.size()) + like->parameter;
    if (product < 0.0) factor = -factor;
  }
  result.band *= factor;
  result.border *= factor;
  result.parameter = factor;
  return result;
}

SolveReport correct_along(PathProblem& problem, PathPoint& point, const PathPoint& start,
                          const PathTangent& direction, double step, PathWorkspace& workspace,
                          int max_iterations) {
  const auto n = static_cast<double>(point.band.size());
  const auto m = point.border.size();
  const auto finish = [&](PathWorkspace& w) {
    // One more column, d r_b/d p, and one more row: q'.(q - q_0)/n + p'(p - p_0) - s = 0.     theory.md (N.5)
    BorderedSystem& s = w.system;
    s.corner.conservativeResize(m + 1, m + 1);
    s.corner.row(m).setZero();
    s.corner.col(m).setZero();
    s.corner.col(m).head(m) = w.by_parameter;
    s.corner(m, m) = direction.parameter;
    for (Eigen::Index i = 0; i < direction.band.size(); ++i) {
      s.rows.push_back({static_cast<int>(m), static_cast<int>(i), direction.band[i] / n});
    }
    s.border_residual.conservativeResize(m + 1);
    s.border_residual[m] = direction.band.dot(point.band - start.band) / n +
                           direction.parameter * (point.parameter - start.parameter) - step;
  };
  point.band = start.band + step * direction.band;
  point.border = start.border + step * direction.border;
  point.parameter = start.parameter + step * direction.parameter;
  return newton(problem, point, workspace, max_iterations, finish, [&point, m](PathWorkspace& w) {
    point.band += w.band_step;
    point.border += w.border_step.head(m);
    point.parameter += w.border_step[m];
  });
}

}  // namespace snare::numerics
