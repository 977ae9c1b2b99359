#include "identification/motion_tracing/motion_beginnings.hpp"

#include "identification/records/record_csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

namespace snare::identification {

namespace {

constexpr double most_left = 0.5;  // of the sum of squares of the whole records
constexpr double shares[] = {0.125, 0.25, 0.5};
constexpr auto fewest = static_cast<Eigen::Index>(fewest_readings);

}  // namespace

MotionFit fit_from_beginnings(const MotionModel& model, const MotionData& data, const std::vector<MotionSetting>& start,
                              const MotionFitOptions& options) {
  MotionFitOptions on_the_way = options;
  on_the_way.derivatives = FitDerivatives::last;
  on_the_way.first_jacobian.resize(0, 0);
  std::vector<MotionSetting> reached = start;
  const long before = model.simulations();
  for (const double share : shares) {
    const std::optional<MotionData> part = beginnings(data, share, fewest);
    if (!part || model.stopped()) continue;
    MotionFit fit = fit_motion(model, *part, reached, on_the_way);
    if (fit.residual.size() > 0) reached = std::move(fit.settings);
  }
  MotionFitOptions whole = options;
  whole.first_jacobian.resize(0, 0);
  MotionFit fit = fit_motion(model, data, reached, whole);
  fit.simulations = model.simulations() - before;
  return fit;
}

RoundResult round_from_beginnings(const RoundInput& in, const std::vector<MotionSetting>& start) {
  RoundResult none;
  for (std::size_t k = std::size(shares); k-- > 0 && !in.model.stopped();) {
    const std::optional<MotionData> part = beginnings(in.data, shares[k], fewest);
    if (!part) break;
    MotionFitOptions options;
    options.progress = in.progress;
    const MotionFit there = fit_from_beginnings(in.model, *part, start, options);
    if (!there.report.usable() || there.jacobian.cols() == 0) continue;
    RoundInput of_part{in.model, *part, there, in.effects, in.selected, in.significance, in.tolerance};
    of_part.progress = in.progress;
    RoundResult found = motion_round(of_part);
    if (!found.added) continue;
    MotionFit whole = fit_from_beginnings(in.model, in.data, found.better.settings, options);
    if (!whole.report.usable() || whole.chi2 > most_left * in.current.chi2) continue;
    const MotionRecord& record = in.data.set->records[part->pieces.front().record];
    found.round.reason = fmt::format("in the first {:.4g} s of the records: {}; it holds in all of them",
                                     record.times[part->pieces.front().size - 1], found.round.reason);
    found.better = std::move(whole);
    return found;
  }
  return none;
}

}  // namespace snare::identification
