#pragma once

#include "numerics/dae.hpp"
#include "numerics/ida_statistics.hpp"
#include "numerics/report.hpp"

#include <Eigen/Core>

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace snare::numerics {

/// Of what the Newton iteration's share of the tolerance is a bound.                         theory.md (M.12)
enum class NewtonTest {
  mean,  ///< of the mean over all unknowns, as IDA does it, at the rate of convergence of an earlier step
  every_unknown  ///< of every unknown, at a rate of convergence of 1/10 at best
};

/// The error of a step is tested block by block: the root mean square of error over tolerance in a block, and
/// of that over the blocks with differential unknowns, must be below one.
struct IdaOptions {
  /// Of every unknown but those of blocks that are not relative [-], in (0, 1).
  double relative_tolerance = 1e-5;
  /// Highest order of the backward differentiation formulas, 1 to 5. Orders above 2 are unstable for undamped
  /// oscillations that the step does not resolve.                                             theory.md (M.2)
  int max_order = 5;
  double max_step = std::numeric_limits<double>::infinity();  ///< [s], > 0
  /// A smaller one is a failure [s], > 0: without it IDA creeps up to a time that it cannot pass, for ever.
  double smallest_step = 1e-13;
  /// [s]; 0: a thousandth of the way to the limit, and at most a tenth of the longest step before the last
  /// start; where that is too long the error test shortens it.                                theory.md (M.2)
  double first_step = 0.0;
  /// With first_step = 0: IDA's own, within which nothing changes by half its tolerance.
  bool cautious_start = false;
  bool test_algebraic = false;  ///< algebraic unknowns take part in the error test (index 1 only)
  NewtonTest newton_test = NewtonTest::mean;
  double newton_share = 0.33;  ///< of the tolerance that the Newton iteration may leave [-]
  /// By how much the leading coefficient of a step may change until there is a new matrix, of itself [-], in
  /// (0, 1).
  double matrix_change = 0.25;
  /// How many more matrices a step may have, of its own iterates, where the corrections shrink slowly with
  /// that of its first guess; as many iterations are added. With any, a matrix of an earlier step is
  /// corrected by what its corrections show, and has three times as many iterations. With
  /// NewtonTest::every_unknown.                                                       theory.md (M.12), (N.8)
  int renewals = 0;
};

/// Integrals along the motion on which no equation depends, I' = f(t, y, y'): by the same formula, orders and
/// steps as the unknowns. What is linear in the unknowns and has f as its rate agrees with its integral to
/// round-off and to what the Newton iteration leaves.                                        theory.md (M.11)
struct IdaIntegrals {
  int count = 0;
  std::function<void(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rates)> rates;
};

/// How an integration ended. On failure `message` names time, step and the worst rows.
struct [[nodiscard]] IdaReport : SolveReport {
  double time = 0.0;                        ///< reached [s]
  double step = 0.0;                        ///< last tried [s]
  std::vector<std::string> worst_unknowns;  ///< unknowns with the largest weighted errors, worst first
};

/// What one call of `advance` did.
enum class IdaAdvance {
  stepped,        ///< one internal step, short of the limit
  reached_limit,  ///< the state is at the limit
  event,          ///< an event function is zero here: `events_found`
  failed          ///< see `report`; the state is that of the last accepted step
};

/// What the length of a step came from.
enum class StepLimit {
  newton,      ///< Newton's method did not converge on a longer one
  error_test,  ///< the error of a longer one was too large
  accuracy,    ///< chosen beforehand so that the error passes
  start,       ///< the first one after a start
  longest      ///< no longer one was allowed
};
constexpr int step_limits = 5;  ///< how many there are

/// That, and the block of unknowns in which it was worst; -1: none.
struct LimitOfStep {
  StepLimit kind = StepLimit::accuracy;
  int block = -1;
};

/// SUNDIALS IDA (variable-order, variable-step BDF; as IDAS, which adds the integrals) with KLU on an
/// analytic sparse
/// Jacobian; the pattern is analysed when it changes only.                             theory.md (M.1), (M.2)
/// Exceptions thrown by the parts pass through. Throws LibraryError when SUNDIALS cannot be set up. Times in
/// s, y in SI units.
class Ida {
 public:
  Ida(DaeSystem& system, const IdaOptions& options, IdaIntegrals integrals = {});
  ~Ida();
  Ida(const Ida&) = delete;
  Ida& operator=(const Ida&) = delete;
  Ida(Ida&&) noexcept;
  Ida& operator=(Ida&&) noexcept;

  /// Begins at first order from a consistent (y, y'), after an event too. The integrals go on from where they
  /// are.
  void start(double time, const Eigen::VectorXd& y, const Eigen::VectorXd& rate);
  /// IDACalcIC: algebraic unknowns and rates of the differential ones from the given differential unknowns
  /// (index 1). `towards`: a later time of the integration, for the scale of time [s]. Starts from there when
  /// it converges.
  [[nodiscard]] IdaReport start_consistently(double time, const Eigen::VectorXd& y,
                                             const Eigen::VectorXd& rate, double towards);

  /// One internal step, never beyond `limit` [s] nor longer than `max_step` [s], > 0.
  [[nodiscard]] IdaAdvance advance(double limit, double max_step = std::numeric_limits<double>::infinity());

  /// Where it stands: of the last accepted step, or of the start [s].
  [[nodiscard]] double time() const;
  /// The unknowns there.
  [[nodiscard]] const Eigen::VectorXd& y() const;
  /// Their rates there.
  [[nodiscard]] const Eigen::VectorXd& rate() const;
  /// Derivative k of y at a time within the last step.
  [[nodiscard]] Eigen::VectorXd interpolate(double time, int derivative = 0) const;
  /// The integrals at time(); zero at the first start unless `set_integrals`.
  [[nodiscard]] const Eigen::VectorXd& integrals() const;
  /// Their rates at time(): as evaluated there, where no event has cut the step. The polynomial's err by the
  /// formula's share.
  [[nodiscard]] Eigen::VectorXd integral_rates() const;
  /// To be called before a start.
  void set_integrals(const Eigen::VectorXd& values);
  /// The integrals, or a derivative of them, at a time within the last step.
  [[nodiscard]] Eigen::VectorXd interpolate_integrals(double time, int derivative = 0) const;
  /// For every event function: 0, or the direction (-1, +1) in which it passed zero.
  [[nodiscard]] const std::vector<int>& events_found() const;
  /// Of the last step.
  [[nodiscard]] LimitOfStep what_limited() const;
  [[nodiscard]] const std::string& name_of_block(int block) const;
  [[nodiscard]] double last_step() const;
  [[nodiscard]] int last_order() const;
  [[nodiscard]] const IdaReport& report() const;
  [[nodiscard]] const IdaStatistics& statistics() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

/// Called after every step; true: stop here.
using IdaObserver = std::function<bool(const Ida&)>;

/// Integrates to `end` without regard to events (they only split steps); `interrupted` when the observer says
/// so. end [s].
[[nodiscard]] IdaReport integrate(Ida& ida, double end, const IdaObserver& observer = {});

}  // namespace snare::numerics
