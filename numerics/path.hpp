#pragma once

#include "numerics/bordered.hpp"
#include "numerics/report.hpp"

#include <Eigen/Core>

#include <optional>

namespace snare::numerics {

/// A state on a path of equilibria: band unknowns, border unknowns, and the parameter that is varied.
struct PathPoint {
  Eigen::VectorXd band;
  Eigen::VectorXd border;
  double parameter = 0.0;  ///< in its unit
};

/// Equations F(band, border; parameter) = 0 whose solutions form the path. The parameter enters the border
/// equations only. Unknowns and parameter in SI units.
class PathProblem {
 public:
  virtual ~PathProblem() = default;

  /// Residual and Jacobian at `at`; `by_parameter`: derivative of the border residual by the parameter (m).
  virtual void assemble(const PathPoint& at, BorderedSystem& system, Eigen::VectorXd& by_parameter) = 0;

  /// Largest residual over its tolerance [-]; <= 1 means converged.
  [[nodiscard]] virtual double error(const PathPoint& at, const BorderedSystem& system) const = 0;

  /// Length by which the band unknowns of a typical state vary; scales arc length and step limits.
  [[nodiscard]] virtual double length_scale() const = 0;
};

/// Storage that Newton's method reuses from point to point, and the last factorisation.
struct PathWorkspace {
  BorderedSystem system;
  BorderedSolver solver;
  Eigen::VectorXd by_parameter;
  Eigen::VectorXd band_step;
  Eigen::VectorXd border_step;
  bool factored = false;  ///< whether the solver holds a factorisation of the last correction's path
};

/// Newton's method at the fixed parameter of `point`, from `point` as the start.     theory.md (N.1)
/// On success the factorisation of the last Newton step is in the workspace, unless none was needed
/// (`factored`).
SolveReport correct(PathProblem& problem, PathPoint& point, PathWorkspace& workspace, int max_iterations);

/// Direction of the path at a corrected point, of unit length in the norm |band|^2 / n + parameter^2 and
/// pointing so that its product with `like` is positive.                                      theory.md (N.4)
/// Where the matrix there is singular the path has no such direction: then `like`, or nothing where that is
/// null.
struct PathTangent {
  Eigen::VectorXd band;
  Eigen::VectorXd border;
  double parameter = 1.0;  ///< along the path's arc [-]
};
[[nodiscard]] std::optional<PathTangent> tangent(PathProblem& problem, const PathPoint& point,
                                                 PathWorkspace& workspace, const PathTangent* like);

/// Newton's method for the point of the path in the plane through `start` + step * tangent that is normal to
/// the tangent (pseudo arc length, Keller 1977): passes folds in the parameter.               theory.md (N.5)
/// step: in the norm of PathTangent, in the units of band and parameter.
SolveReport correct_along(PathProblem& problem, PathPoint& point, const PathPoint& start,
                          const PathTangent& direction, double step, PathWorkspace& workspace,
                          int max_iterations);

}  // namespace snare::numerics
