#include "identification/records/simplex.hpp"

#include <nlopt.h>

#include <cmath>
#include <exception>
#include <limits>
#include <memory>

namespace snare::identification {

namespace {

struct Search {
  const RecordModel& model;
  const RecordData& data;
  const RecordFitOptions& options;
  std::vector<RecordSetting> settings;
  nlopt_opt opt = nullptr;
  int evaluations = 0;
  std::vector<double> best = {};  // numbers over their declared values, of the least sum so far
  double least = std::numeric_limits<double>::max();
  bool hardly_moves = false;  // the last better place is next to the one before it
  std::exception_ptr thrown;
};

/// Honda's measure of a step to a better place: |p - p'| over |p'| with p' the place before, numbers over
/// their declared values.
///                                                                                           theory.md (I.30)
double moves_to(Search& search, double chi2) {
  std::vector<double> there;
  for (const RecordSetting& s : search.settings)
    there.push_back(s.value / (s.number.declared != 0.0 ? std::abs(s.number.declared) : s.number.scale));
  double moved = 0.0, size = 0.0;
  for (std::size_t k = 0; k < search.best.size(); ++k) {
    moved += (there[k] - search.best[k]) * (there[k] - search.best[k]);
    size += search.best[k] * search.best[k];
  }
  const bool first = search.best.empty();
  search.best = std::move(there);
  search.least = chi2;
  return first || !(size > 0.0) ? std::numeric_limits<double>::infinity() : std::sqrt(moved / size);
}

double chi2_at(unsigned count, const double* x, double* /*gradient*/, void* context) {
  Search& search = *static_cast<Search*>(context);
  try {
    for (unsigned k = 0; k < count; ++k) search.settings[k].value = x[k] * search.settings[k].number.scale;
    const Eigen::VectorXd r = search.data.residual(search.model.predict(
        together(search.settings, search.options.fixed), search.data.records, search.data.readings));
    const double chi2 = r.size() == 0 ? 1e6 * static_cast<double>(search.data.rows) : r.squaredNorm();
    const bool go_on = !search.model.stopped() &&
                       (!search.options.progress || search.options.progress(++search.evaluations, chi2));
    if (chi2 < search.least) search.hardly_moves = moves_to(search, chi2) < search.options.simplex_change;
    if (!go_on || search.hardly_moves) nlopt_force_stop(search.opt);
    return chi2;
  } catch (...) {
    search.thrown = std::current_exception();
    nlopt_force_stop(search.opt);
    return 0.0;
  }
}

}  // namespace

void nelder_mead(const RecordModel& model, const RecordData& data, const RecordFitOptions& options,
                 RecordFit& fit) {
  const auto count = static_cast<unsigned>(fit.settings.size());
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> opt(nlopt_create(NLOPT_LN_NELDERMEAD, count),
                                                              nlopt_destroy);
  Search search{model, data, options, fit.settings, opt.get(), 0, {}, std::numeric_limits<double>::max(),
                false, {}};
  std::vector<double> x, lower, upper, step;
  constexpr double wide = 10.0;  // scales: a tenth of a declared number
  for (const RecordSetting& s : fit.settings) {
    const RecordNumber& n = s.number;
    x.push_back(s.value / n.scale);
    lower.push_back(std::isfinite(n.lower) ? n.lower / n.scale : -HUGE_VAL);
    upper.push_back(std::isfinite(n.upper) ? n.upper / n.scale : HUGE_VAL);
    step.push_back(wide);
  }
  nlopt_set_min_objective(opt.get(), chi2_at, &search);
  nlopt_set_lower_bounds(opt.get(), lower.data());
  nlopt_set_upper_bounds(opt.get(), upper.data());
  nlopt_set_initial_step(opt.get(), step.data());
  nlopt_set_ftol_rel(opt.get(), options.tolerance);
  nlopt_set_xtol_rel(opt.get(), options.tolerance);
  nlopt_set_maxeval(opt.get(), 400 * static_cast<int>(count));
  double least = std::numeric_limits<double>::max();
  const nlopt_result result = nlopt_optimize(opt.get(), x.data(), &least);
  if (search.thrown) std::rethrow_exception(search.thrown);
  for (unsigned k = 0; k < count; ++k) fit.settings[k].value = x[k] * fit.settings[k].number.scale;
  fit.iterations = search.evaluations;
  if (search.hardly_moves)
    for (unsigned k = 0; k < count; ++k) {  // of a stop the library gives back the last place but one
      const RecordNumber& n = fit.settings[k].number;
      fit.settings[k].value = search.best[k] * (n.declared != 0.0 ? std::abs(n.declared) : n.scale);
    }
  if (search.hardly_moves) return;
  if (result == NLOPT_FORCED_STOP) {
    static_cast<void>(fit.report.end(numerics::Termination::interrupted, "interrupted"));
  } else if (result < 0) {
    static_cast<void>(fit.report.end(numerics::Termination::step_too_small, "the simplex search failed"));
  } else if (result == NLOPT_MAXEVAL_REACHED) {
    static_cast<void>(
        fit.report.end(numerics::Termination::iteration_limit, "the simplex search did not converge"));
  }
}

}  // namespace snare::identification
