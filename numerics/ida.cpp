#include "numerics/ida.hpp"

#include "numerics/ida_callbacks.hpp"
#include "numerics/newton_solver.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <idas/idas.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <sunnonlinsol/sunnonlinsol_newton.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace snare::numerics {

namespace {

constexpr int tries = 40;  // of one step

std::string name_of(int code) {
  const std::unique_ptr<char, decltype(&std::free)> name(IDAGetReturnFlagName(code), &std::free);
  return name.get();
}

Termination meaning(int code) {
  switch (code) {
    case IDA_TOO_MUCH_WORK:
    case IDA_CONV_FAIL:
      return Termination::iteration_limit;
    case IDA_LSETUP_FAIL:
    case IDA_LSOLVE_FAIL:
      return Termination::singular_matrix;
    case IDA_RES_FAIL:
    case IDA_REP_RES_ERR:
    case IDA_FIRST_RES_FAIL:
      return Termination::not_finite;
    default:
      return Termination::step_too_small;
  }
}

}  // namespace

struct Ida::Memory {
  struct Deleter {
    void operator()(void* memory) const noexcept { IDAFree(&memory); }
  };
  IdaCallbacks callbacks;
  IdaOptions options;
  sundials::Context context;
  Eigen::VectorXd y, rate, tolerance, identity, integrals;
  SunVector y_view, rate_view, tolerance_view, identity_view, integrals_view;
  SunMatrix matrix;
  SunLinearSolver linear;
  std::unique_ptr<void, Deleter> ida;
  SunNonlinearSolver newton;
  double time = 0.0;
  std::vector<int> events;
  IdaReport report;
  IdaStatistics counted;                       // of earlier starts: IDA counts from each start
  bool starting = false;                       // no step since the start
  double longest_step = 0.0;                   // since the last start after which there was one; 0: none yet
  StepLimit limited_by = StepLimit::accuracy;  // the last step

  Memory(DaeSystem& system, const IdaOptions& chosen, IdaIntegrals&& wanted);
  void update_counts();
  void begin(double at, const Eigen::VectorXd& y0, const Eigen::VectorXd& rate0);
  [[nodiscard]] double first_step(double limit) const;
  void fail(int code, const std::string& function);
  [[nodiscard]] std::vector<std::string> worst_unknowns();
};

Ida::Memory::Memory(DaeSystem& system, const IdaOptions& chosen, IdaIntegrals&& wanted)
    : callbacks{system, {}, nullptr, nullptr, 0, std::move(wanted.rates)},
      options(chosen),
      y(Eigen::VectorXd::Zero(system.size())),
      rate(Eigen::VectorXd::Zero(system.size())),
      tolerance(system.size()),
      identity(system.size()),
      integrals(Eigen::VectorXd::Zero(wanted.count)),
      y_view(view(y, context)),
      rate_view(view(rate, context)),
      tolerance_view(view(tolerance, context)),
      identity_view(view(identity, context)),
      integrals_view(view(integrals, context)),
      matrix(made(SUNSparseMatrix(system.size(), system.size(), 1, CSC_MAT, context), "SUNSparseMatrix")),
      linear(make_linear_solver(callbacks, context)),
      ida(made(IDACreate(context), "IDACreate")),
      newton(
          options.newton_test == NewtonTest::every_unknown
              ? make_newton_solver(callbacks, y_view.get(), options.renewals, context)
              : SunNonlinearSolver(made(SUNNonlinSol_Newton(y_view.get(), context), "SUNNonlinSol_Newton"))),
      events(static_cast<std::size_t>(system.event_count()), 0) {
  // IDA bounds the mean over all unknowns of (error/tolerance)^2. So that a body's three velocities are not
  // lost among a wire's hundreds, the mean is made one over blocks: an unknown counts as one over the size of
  // its block.
  int tested = 0;
  int blocks = 0;
  for (const DaeBlock& block : system.layout().blocks()) {
    tolerance.segment(block.first, block.count).setConstant(block.absolute_tolerance);
    identity.segment(block.first, block.count).setConstant(block.kind == DaeKind::differential ? 1.0 : 0.0);
    if (block.kind == DaeKind::differential || options.test_algebraic) {
      tested += block.count;
      ++blocks;
    }
  }
  callbacks.relative = Eigen::VectorXd::Zero(system.size());
  callbacks.scale = Eigen::VectorXd::Ones(system.size());
  for (const DaeBlock& block : system.layout().blocks()) {
    if (block.relative)
      callbacks.relative.segment(block.first, block.count).setConstant(options.relative_tolerance);
    if (block.kind == DaeKind::differential || options.test_algebraic) {
      callbacks.scale.segment(block.first, block.count)
          .setConstant(std::sqrt(static_cast<double>(block.count) * blocks / tested));
    }
  }
  callbacks.tolerance = tolerance;
  void* m = ida.get();
  check(IDASetErrHandlerFn(
            m, [](int, const char*, const char*, char*, void*) {}, nullptr),
        "IDASetErrHandlerFn");
  check(IDAInit(m, snare_ida_residual, 0.0, y_view.get(), rate_view.get()), "IDAInit");
  check(IDASetUserData(m, &callbacks), "IDASetUserData");
  check(IDAWFtolerances(m, snare_ida_weights), "IDAWFtolerances");
  check(IDASetId(m, identity_view.get()), "IDASetId");
  check(IDASetSuppressAlg(m, options.test_algebraic ? 0 : 1), "IDASetSuppressAlg");
  check(IDASetMaxOrd(m, options.max_order), "IDASetMaxOrd");
  check(IDASetMaxNumSteps(m, -1), "IDASetMaxNumSteps");
  check(IDASetNonlinConvCoef(m, options.newton_share), "IDASetNonlinConvCoef");
  check(IDASetMinStep(m, options.smallest_step), "IDASetMinStep");
  // From the longest step of a body that flies to that of its touch are more failures than IDA's ten.
  check(IDASetMaxConvFails(m, tries), "IDASetMaxConvFails");
  check(IDASetMaxErrTestFails(m, tries), "IDASetMaxErrTestFails");
  check(IDASetNonlinearSolver(m, newton.get()), "IDASetNonlinearSolver");
  check(IDASetLinearSolver(m, linear.get(), matrix.get()), "IDASetLinearSolver");
  check(IDASetJacFn(m, snare_ida_jacobian), "IDASetJacFn");
  check(IDASetDeltaCjLSetup(m, options.matrix_change), "IDASetDeltaCjLSetup");
  if (system.event_count() > 0) {
    check(IDARootInit(m, system.event_count(), snare_ida_events), "IDARootInit");
    check(IDASetNoInactiveRootWarn(m), "IDASetNoInactiveRootWarn");
  }
  if (integrals.size() > 0) check(IDAQuadInit(m, snare_ida_integrands, integrals_view.get()), "IDAQuadInit");
}

void Ida::Memory::update_counts() {
  IdaStatistics& s = callbacks.statistics;
  long errors = 0;
  long iterations = 0;
  long failures = 0;
  check(IDAGetNumErrTestFails(ida.get(), &errors), "IDAGetNumErrTestFails");
  check(IDAGetNonlinSolvStats(ida.get(), &iterations, &failures), "IDAGetNonlinSolvStats");
  s.error_test_failures = counted.error_test_failures + errors;
  s.newton_iterations = counted.newton_iterations + iterations;
  s.newton_failures = counted.newton_failures + failures;
}

void Ida::Memory::begin(double at, const Eigen::VectorXd& y0, const Eigen::VectorXd& rate0) {
  y = callbacks.accepted = y0;
  rate = rate0;
  time = at;
  starting = true;
  report = {};
  report.time = at;
  counted = callbacks.statistics;
  ++callbacks.statistics.restarts;
  check(IDAReInit(ida.get(), at, y_view.get(), rate_view.get()), "IDAReInit");
  if (integrals.size() > 0) check(IDAQuadReInit(ida.get(), integrals_view.get()), "IDAQuadReInit");
  std::fill(events.begin(), events.end(), 0);
}

// IDA would begin with a step on which nothing changes by more than half its tolerance, and double it with a
// Jacobian each
// time: a body that flies uniformly costs a dozen. The error test divides a first step that is too long by
// four.
//                                                                                                       (M.2)
double Ida::Memory::first_step(double limit) const {
  if (options.first_step > 0.0 || options.cautious_start) return options.first_step;
  constexpr double of_the_way = 1e-3;
  constexpr double of_the_longest = 0.1;
  const double step = std::max(of_the_way * (limit - time), options.smallest_step);
  return longest_step > 0.0 ? std::min(step, of_the_longest * longest_step) : step;
}

std::vector<std::string> Ida::Memory::worst_unknowns() {
  // The last correction, weighted as the error test does.
  N_Vector predicted{}, predicted_rate{}, current{}, current_rate{}, rows{};
  double t = 0.0;
  double c = 0.0;
  void* user = nullptr;
  if (IDAGetNonlinearSystemData(ida.get(), &t, &predicted, &predicted_rate, &current, &current_rate, &rows,
                                &c, &user) != IDA_SUCCESS ||
      predicted == nullptr || current == nullptr) {
    return {};
  }
  Eigen::VectorXd size = (map(current) - map(predicted)).cwiseAbs();
  size.array() /=
      callbacks.scale.array() * (callbacks.relative.array() * y.array().abs() + tolerance.array());
  if (rows != nullptr) {
    for (Eigen::Index i = 0; i < size.size(); ++i) {
      if (!std::isfinite(map(rows)[i])) size[i] = std::numeric_limits<double>::infinity();
    }
  }
  for (double& s : size) {
    if (std::isnan(s)) s = std::numeric_limits<double>::infinity();
  }
  std::vector<int> order(static_cast<std::size_t>(size.size()));
  std::iota(order.begin(), order.end(), 0);
  const auto shown = std::min<std::ptrdiff_t>(5, size.size());
  std::partial_sort(order.begin(), order.begin() + shown, order.end(),
                    [&](int a, int b) { return size[a] > size[b]; });
  std::vector<std::string> names;
  for (std::ptrdiff_t k = 0; k < shown; ++k) {
    names.push_back(callbacks.system.layout().name_of(order[static_cast<std::size_t>(k)]));
  }
  return names;
}

void Ida::Memory::fail(int code, const std::string& function) {
  if (callbacks.failure) std::rethrow_exception(std::exchange(callbacks.failure, nullptr));
  if (code == IDA_MEM_NULL || code == IDA_NO_MALLOC) check(code, function);
  report.termination = meaning(code);
  report.worst_unknowns = worst_unknowns();
  report.time = time;
  // Where the first residual is none, so is the step.
  if (IDAGetCurrentStep(ida.get(), &report.step) != IDA_SUCCESS || !std::isfinite(report.step))
    report.step = 0.0;
  report.message = fmt::format("{} stopped with {} at {:.9g} s, step {:.3g} s; worst: {}", function,
                               name_of(code), time, report.step, fmt::join(report.worst_unknowns, "; "));
}

Ida::Ida(DaeSystem& system, const IdaOptions& options, IdaIntegrals integrals)
    : memory_(std::make_unique<Memory>(system, options, std::move(integrals))) {}
Ida::~Ida() = default;
Ida::Ida(Ida&&) noexcept = default;
Ida& Ida::operator=(Ida&&) noexcept = default;

void Ida::start(double time, const Eigen::VectorXd& y, const Eigen::VectorXd& rate) {
  memory_->begin(time, y, rate);
}

IdaReport Ida::start_consistently(double time, const Eigen::VectorXd& y, const Eigen::VectorXd& rate,
                                  double towards) {
  Memory& m = *memory_;
  m.begin(time, y, rate);
  const int code = IDACalcIC(m.ida.get(), IDA_YA_YDP_INIT, towards);
  if (code != IDA_SUCCESS) {
    m.fail(code, "IDACalcIC");
    return m.report;
  }
  check(IDAGetConsistentIC(m.ida.get(), m.y_view.get(), m.rate_view.get()), "IDAGetConsistentIC");
  const Eigen::VectorXd y0 = m.y;
  const Eigen::VectorXd rate0 = m.rate;
  m.update_counts();
  --m.callbacks.statistics.restarts;
  m.begin(time, y0, rate0);
  return m.report;
}

IdaAdvance Ida::advance(double limit, double max_step) {
  Memory& m = *memory_;
  // IDA's own bound acts on what it chooses after the step, not on the length that it has chosen already.
  max_step = std::min(max_step, m.options.max_step);
  check(IDASetMaxStep(m.ida.get(), std::isfinite(max_step) ? max_step : 0.0), "IDASetMaxStep");
  // A stop cuts the step behind it, too, which may go further: there is one only where this step would pass
  // it.
  double next = 0.0;
  if (!m.starting) check(IDAGetCurrentStep(m.ida.get(), &next), "IDAGetCurrentStep");
  const double stop = m.starting || next > max_step ? std::min(limit, m.time + max_step) : limit;
  check(IDASetStopTime(m.ida.get(), stop), "IDASetStopTime");
  if (m.starting) check(IDASetInitStep(m.ida.get(), m.first_step(stop)), "IDASetInitStep");
  double reached = m.time;
  const IdaStatistics before = m.callbacks.statistics;
  m.callbacks.limiting_unknown = -1;
  const int code = IDASolve(m.ida.get(), stop, &reached, m.y_view.get(), m.rate_view.get(), IDA_ONE_STEP);
  m.update_counts();
  const bool after_event = std::ranges::any_of(m.events, [](int e) { return e != 0; });
  if (code == IDA_ILL_INPUT && after_event && !m.starting) {
    // An event function was zero at the event and, to the last bit, just after it: IDA takes that for an
    // error, but not at a start.
    const Eigen::VectorXd y = m.y, rate = m.rate;
    m.begin(m.time, y, rate);
    std::fill(m.events.begin(), m.events.end(), 0);
    return advance(limit, max_step);
  }
  if (code < 0) {
    // The views hold the last accepted state.
    m.fail(code, "IDASolve");
    return IdaAdvance::failed;
  }
  IdaStatistics& s = m.callbacks.statistics;
  m.time = reached;
  m.report.time = reached;
  check(IDAGetLastStep(m.ida.get(), &m.report.step), "IDAGetLastStep");
  m.longest_step = m.starting ? m.report.step : std::max(m.longest_step, m.report.step);
  if (s.newton_failures > before.newton_failures)
    m.limited_by = StepLimit::newton;
  else if (s.error_test_failures > before.error_test_failures)
    m.limited_by = StepLimit::error_test;
  else if (m.report.step > 0.4 * max_step)  // IDA halves what would not quite reach a limit
    m.limited_by = StepLimit::longest;
  else
    m.limited_by = m.starting ? StepLimit::start : StepLimit::accuracy;
  m.starting = false;
  ++s.steps;
  s.smallest_step = std::min(s.smallest_step, m.report.step);
  s.largest_step = std::max(s.largest_step, m.report.step);
  if (m.integrals.size() > 0) {
    double at = reached;
    check(IDAGetQuad(m.ida.get(), &at, m.integrals_view.get()), "IDAGetQuad");
  }
  m.callbacks.system.accept({m.time, m.y, m.rate});
  m.callbacks.accepted = m.y;
  if (code == IDA_ROOT_RETURN) {
    check(IDAGetRootInfo(m.ida.get(), m.events.data()), "IDAGetRootInfo");
    return IdaAdvance::event;
  }
  std::fill(m.events.begin(), m.events.end(), 0);
  return code == IDA_TSTOP_RETURN && stop == limit ? IdaAdvance::reached_limit : IdaAdvance::stepped;
}

double Ida::time() const {
  return memory_->time;
}
const Eigen::VectorXd& Ida::y() const {
  return memory_->y;
}
const Eigen::VectorXd& Ida::rate() const {
  return memory_->rate;
}
const Eigen::VectorXd& Ida::integrals() const {
  return memory_->integrals;
}
void Ida::set_integrals(const Eigen::VectorXd& values) {
  assert(values.size() == memory_->integrals.size());
  memory_->integrals = values;
}
const std::vector<int>& Ida::events_found() const {
  return memory_->events;
}
LimitOfStep Ida::what_limited() const {
  const Memory& m = *memory_;
  const auto& blocks = m.callbacks.system.layout().blocks();
  const auto block_of = [&](int unknown) {
    const auto behind =
        std::ranges::find_if(blocks, [unknown](const DaeBlock& b) { return b.first > unknown; });
    return unknown < 0 ? -1 : static_cast<int>(behind - blocks.begin()) - 1;
  };
  if (m.limited_by == StepLimit::newton) return {m.limited_by, block_of(m.callbacks.limiting_unknown)};
  if (m.limited_by == StepLimit::start || m.limited_by == StepLimit::longest) return {m.limited_by, -1};
  // The local errors, over their tolerances, of what is tested.
  Eigen::VectorXd errors(m.y.size());
  const SunVector out = view(errors, m.context);
  check(IDAGetEstLocalErrors(m.ida.get(), out.get()), "IDAGetEstLocalErrors");
  errors.array() /=
      m.callbacks.scale.array() * (m.callbacks.relative.array() * m.y.array().abs() + m.tolerance.array());
  if (!m.options.test_algebraic) errors.array() *= m.identity.array();
  LimitOfStep worst{m.limited_by, -1};
  double largest = 0.0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const double size = errors.segment(blocks[b].first, blocks[b].count).norm();
    if (!(size > largest)) continue;
    largest = size;
    worst.block = static_cast<int>(b);
  }
  return worst;
}

const std::string& Ida::name_of_block(int block) const {
  return memory_->callbacks.system.layout().blocks().at(static_cast<std::size_t>(block)).name;
}

double Ida::last_step() const {
  return memory_->report.step;
}
const IdaReport& Ida::report() const {
  return memory_->report;
}
const IdaStatistics& Ida::statistics() const {
  return memory_->callbacks.statistics;
}

int Ida::last_order() const {
  int order = 0;
  check(IDAGetLastOrder(memory_->ida.get(), &order), "IDAGetLastOrder");
  return order;
}

Eigen::VectorXd Ida::interpolate(double time, int derivative) const {
  Eigen::VectorXd result(memory_->y.size());
  const SunVector out = view(result, memory_->context);
  check(IDAGetDky(memory_->ida.get(), time, derivative, out.get()), "IDAGetDky");
  return result;
}

Eigen::VectorXd Ida::interpolate_integrals(double time, int derivative) const {
  Eigen::VectorXd result(memory_->integrals.size());
  if (result.size() == 0) return result;
  const SunVector out = view(result, memory_->context);
  check(IDAGetQuadDky(memory_->ida.get(), time, derivative, out.get()), "IDAGetQuadDky");
  return result;
}

Eigen::VectorXd Ida::integral_rates() const {
  double reached = 0.0;
  check(IDAGetCurrentTime(memory_->ida.get(), &reached), "IDAGetCurrentTime");
  return reached == memory_->time ? memory_->callbacks.integrated : interpolate_integrals(memory_->time, 1);
}

IdaReport integrate(Ida& ida, double end, const IdaObserver& observer) {
  while (true) {
    switch (ida.advance(end)) {
      case IdaAdvance::failed:
      case IdaAdvance::reached_limit:
        return ida.report();
      case IdaAdvance::stepped:
      case IdaAdvance::event:
        break;
    }
    if (observer && observer(ida)) {
      IdaReport report = ida.report();
      report.termination = Termination::interrupted;
      report.message = fmt::format("stopped by the observer at {:.9g} s", report.time);
      return report;
    }
  }
}

}  // namespace snare::numerics
