#include "identification/motion_tracing/record_beginnings.hpp"

#include "identification/records/record_csv.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace snare::identification {

namespace {

constexpr double most_left = 0.5;  // of the sum of squares of the whole records
constexpr std::array shares{0.03125, 0.0625, 0.125, 0.25, 0.5};
constexpr auto shares_of_a_fit = std::span(shares).last<3>();
constexpr int most_members = 5;  // of a class of the beginnings that are tried on the whole
constexpr auto fewest = static_cast<Eigen::Index>(fewest_readings);

}  // namespace

RecordFit fit_from_beginnings(const RecordModel& model, const RecordData& data,
                              const std::vector<RecordSetting>& start, const RecordFitOptions& options) {
  RecordFitOptions on_the_way = options;
  on_the_way.derivatives = FitDerivatives::last;
  on_the_way.first_jacobian.resize(0, 0);
  std::vector<RecordSetting> reached = start;
  const long before = model.simulations();
  for (const double share : shares_of_a_fit) {
    const std::optional<RecordData> part = beginnings(data, share, fewest);
    if (!part || model.stopped()) continue;
    RecordFit fit = fit_motion(model, *part, reached, on_the_way);
    if (fit.residual.size() > 0) reached = std::move(fit.settings);
  }
  RecordFitOptions whole = options;
  whole.first_jacobian.resize(0, 0);
  RecordFit fit = fit_motion(model, data, reached, whole);
  fit.simulations = model.simulations() - before;
  return fit;
}

RoundResult round_from_beginnings(const RoundInput& in, const std::vector<RecordSetting>& start) {
  RoundResult best;
  RecordFitOptions options;
  options.progress = in.progress;
  for (const double share : shares) {
    const std::optional<RecordData> part = beginnings(in.data, share, fewest);
    if (!part) continue;
    const RecordFit there = fit_from_beginnings(in.model, *part, start, options);
    if (in.model.stopped()) break;
    if (!there.report.usable() || there.jacobian.cols() == 0) continue;
    RoundInput of_part{in.model, *part, there, in.effects, in.selected, in.significance, in.tolerance};
    of_part.progress = in.progress;
    RoundResult found = record_round(of_part);
    if (!found.added) continue;
    // What the beginnings do not tell apart the whole records do.
    int tried = 0;
    for (std::size_t k = 0; k < found.round.candidates.size() && tried < most_members && !in.model.stopped();
         ++k) {
      const RecordCandidate& c = found.round.candidates[k];
      if (c.class_index != 0 || !c.refitted) continue;
      ++tried;
      RecordFit whole = fit_from_beginnings(in.model, in.data, together(there.settings, c.settings), options);
      const double limit = best.added ? best.better.chi2 : most_left * in.current.chi2;
      if (!whole.report.usable() || whole.chi2 > limit) continue;
      const Record& record = in.data.set->records[part->pieces.front().record];
      best.round = found.round;
      best.round.added = in.effects[c.score.effect].label();
      best.round.reason = fmt::format("in the first {:.4g} s of the records: {}; it holds in all of them",
                                      record.times[part->pieces.front().size - 1], found.round.reason);
      best.added = c.score.effect;
      best.better = std::move(whole);
    }
    if (best.added && !out_of_step(in.data, best.better)) break;
  }
  return best;
}

}  // namespace snare::identification
