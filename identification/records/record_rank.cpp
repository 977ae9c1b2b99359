#include "identification/records/record_rank.hpp"

#include "identification/records/coloured_noise.hpp"
#include "identification/records/record_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace snare::identification {

namespace {

/// A step along a direction from the answer: one number is held there.
struct Move {
  Eigen::Index held = 0;
  std::vector<RecordSetting> settings;
  bool clipped = false;   ///< the number has a bound before
  double promised = 0.0;  ///< change of the residual by it, over its noise, as the derivatives have it
};

/// Standard deviation of a row of the residual.
double noise_of(const RecordData& data, const RecordFit& optimum) {
  const auto dof = static_cast<double>(std::max<Eigen::Index>(1, data.rows - optimum.jacobian.cols()));
  return std::sqrt(std::max(optimum.chi2 / dof, 1e-300));
}

/// As far as should change the residual by `share` of `doubtful_change`; negative: to the other side. `held`
/// moves, at most that far.
Move move_along(const RecordData& data, const RecordFit& optimum, const Eigen::VectorXd& direction,
                Eigen::Index held, double share) {
  constexpr double far = 200.0;  // scales, twice a declared number
  Move move;
  move.held = held;
  const double by_scale =
      (optimum.jacobian * direction).norm() / std::abs(direction[move.held]) / noise_of(data, optimum);
  const double size = share * std::min(far, doubtful_change / std::max(by_scale, 1e-300));
  move.promised = by_scale * std::abs(size);
  move.settings = optimum.settings;
  for (std::size_t k = 0; k < move.settings.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    RecordSetting& s = move.settings[k];
    const double to = s.value + size * direction[i] / direction[move.held] * s.number.scale;
    s.value = std::clamp(to, s.number.lower, s.number.upper);
    move.clipped = move.clipped || (i == move.held && s.value != to);
  }
  return move;
}

/// The fit with the held number where the move has it; none where nothing can be simulated.
std::optional<RecordFit> refitted(const RecordModel& model, const RecordData& data, const Move& move) {
  RecordFitOptions options;
  std::vector<RecordSetting> others = move.settings;
  options.fixed = {others[static_cast<std::size_t>(move.held)]};
  others.erase(others.begin() + move.held);
  options.max_iterations = 15;
  options.derivatives = FitDerivatives::last;
  RecordFit moved = fit_motion(model, data, others, options);
  if (!std::ranges::all_of(moved.predictions, &RecordPrediction::usable)) return std::nullopt;
  return moved;
}

double rise_of(const RecordData& data, const RecordFit& optimum, double chi2) {
  const double noise = noise_of(data, optimum);
  return (chi2 - optimum.chi2) / (noise * noise);
}

// Rises of chi2 that end the way through a valley: what chance does not do, and too far up its side.
constexpr double clear_rise = 2.0, steep_rise = 5.0;
constexpr double conclusive_change = 3.0;  // of the residual: its square is a clear rise

/// Where a number is held at a share of its way, the others refitted.
struct ValleyPoint {
  double share = 0.0;                   ///< of the way that should change the residual by `doubtful_change`
  double rise = 0.0;                    ///< of chi2 [-]
  double promised = 0.0;                ///< change of the residual, over its noise, by the derivatives
  std::vector<RecordSetting> settings;  ///< of all numbers

  [[nodiscard]] bool rises() const { return rise >= clear_rise; }
  [[nodiscard]] bool ends() const { return share >= 1.0 || rises() || falls(); }
  /// Whether chi2 is clearly lower than at the answer, which then is no minimum.
  [[nodiscard]] bool falls() const { return rise <= -clear_rise; }
  /// Whether chi2 rises here, or stays although the derivatives promise a clear rise.
  [[nodiscard]] bool is_conclusive() const { return rises() || (!falls() && promised >= conclusive_change); }
};

/// The move to `share`, the others on the polynomial through the last points, of which there may be three.
Move carried_on(Move move, double share, const std::vector<ValleyPoint>& points) {
  if (points.size() < 2) return move;
  const std::size_t first = points.size() - std::min<std::size_t>(3, points.size());
  for (std::size_t k = 0; k < move.settings.size(); ++k) {
    if (static_cast<Eigen::Index>(k) == move.held) continue;
    double value = 0.0;
    for (std::size_t i = first; i < points.size(); ++i) {
      double weight = 1.0;
      for (std::size_t j = first; j < points.size(); ++j)
        if (j != i) weight *= (share - points[j].share) / (points[i].share - points[j].share);
      value += weight * points[i].settings[k].value;
    }
    move.settings[k].value = std::clamp(value, move.settings[k].number.lower, move.settings[k].number.upper);
  }
  return move;
}

/// Follows the valley of chi2 from the answer to one side (1 or -1) until it rises clearly: number k is held
/// at points along `direction`, the others are fitted again. Steps are shorter where nothing can be simulated
/// and where chi2 has risen by more than `most`. Returns the last point: where it has risen, the end of the
/// way, or where it ends before, as at a bound. Where chi2 falls the answer is no minimum: `lower` keeps the
/// place.
ValleyPoint follow_valley(const RecordModel& model, const RecordData& data, RecordFit& optimum,
                          const Eigen::VectorXd& direction, Eigen::Index k, double side, double most) {
  constexpr double first_step = 0.35, least_step = 0.005;
  constexpr int most_fits = 12;
  std::vector<ValleyPoint> points{{0.0, 0.0, 0.0, optimum.settings}};
  double step = first_step;
  for (int fits = 0; fits < most_fits && !points.back().ends() && !model.stopped(); ++fits) {
    const double share = std::min(1.0, points.back().share + step);
    const Move move = carried_on(move_along(data, optimum, direction, k, side * share), share, points);
    const std::optional<RecordFit> there = move.clipped ? std::nullopt : refitted(model, data, move);
    const double rise = there ? rise_of(data, optimum, there->chi2) : 0.0;
    const bool too_far = !there || rise > most;
    if (too_far && step >= least_step) {
      step *= 0.5;
      continue;
    }
    if (!there) break;
    step = std::min(2.0 * step, first_step);
    std::vector<RecordSetting> settings = there->settings;
    settings.insert(settings.begin() + k, move.settings[static_cast<std::size_t>(k)]);
    points.push_back({share, rise, move.promised, std::move(settings)});
  }
  if (points.back().falls()) optimum.lower = points.back().settings;
  return points.back();
}

/// Whether chi2 stays where it is along a direction about whose derivatives there is doubt; none where the
/// way ends on both sides before that is clear.
std::optional<bool> stays_along(const RecordModel& model, const RecordData& data, RecordFit& optimum,
                                const Eigen::VectorXd& direction) {
  Eigen::Index held = 0;  // what moves most
  optimum.jacobian.colwise().norm().transpose().cwiseProduct(direction).cwiseAbs().maxCoeff(&held);
  for (const double side : {1.0, -1.0}) {
    const ValleyPoint end =
        follow_valley(model, data, optimum, direction, held, side, std::numeric_limits<double>::infinity());
    if (end.is_conclusive()) return !end.rises();
  }
  return std::nullopt;
}

/// Whether the numbers that move along a direction nearly make up for each other.
bool go_together(const RecordFit& optimum, const Eigen::VectorXd& direction) {
  const Eigen::VectorXd effect =
      optimum.jacobian.colwise().norm().transpose().cwiseProduct(direction).cwiseAbs();
  return (optimum.jacobian * direction).norm() < 0.1 * effect.maxCoeff();
}

/// Follows the valley to one side of the answer of number k, unless chi2 rises half the way along a straight
/// line as in a linear model; with `in_any_case` also then. None where the interval stands, or where the way
/// ends too early, at a bound or where nothing can be simulated.
std::optional<ValleyPoint> valley_beside(const RecordModel& model, const RecordData& data, RecordFit& optimum,
                                         const Eigen::VectorXd& direction, Eigen::Index k, double side,
                                         bool in_any_case) {
  const Move half = move_along(data, optimum, direction, k, 0.5 * side);
  const std::vector<RecordPrediction> there = model.predict(half.settings, data.records, data.readings);
  if (!in_any_case && !half.clipped && std::ranges::all_of(there, &RecordPrediction::usable)) {
    const double share =
        rise_of(data, optimum, data.residual(there).squaredNorm()) / (half.promised * half.promised);
    if (share > 0.5 && share < 2.0) return std::nullopt;
  }
  const ValleyPoint end = follow_valley(model, data, optimum, direction, k, side, steep_rise);
  if (model.stopped() || !end.is_conclusive()) return std::nullopt;
  return end;
}

/// Adds the null direction in which number k has moved to the end of a valley. What has moved by more than
/// its standard error on the way belongs to it.
void add_valley(const RecordData& data, const ValleyPoint& valley, Eigen::Index k, RecordFit& fit) {
  const Eigen::MatrixXd& covariance = fit.rank.covariance;
  const auto moved = [&](Eigen::Index i) {
    const auto at = static_cast<std::size_t>(i);
    return (valley.settings[at].value - fit.settings[at].value) / fit.settings[at].number.scale;
  };
  Eigen::VectorXd direction(covariance.rows());
  std::vector<std::size_t> others;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    direction[i] = moved(i) / moved(k);
    const double deviation = std::sqrt(covariance(i, i)) * noise_of(data, fit);
    const bool goes_along =
        i != k && fit.rank.is_known(static_cast<std::size_t>(i)) && std::abs(moved(i)) > deviation;
    if (goes_along) others.push_back(static_cast<std::size_t>(i));
  }
  fit.rank.add_direction(static_cast<std::size_t>(k), others, direction, fit.jacobian);
}

/// Compares the interval of every number with the rise of chi2 to both sides of the answer. Where it does not
/// rise the number becomes a null direction: where the readings depend on a number by its square, as on the
/// height of a probe above a plane of symmetry, every answer off the plane has a derivative and the plane
/// has none. Where the interval misses the profile of chi2, by the wider of its sides, by a factor of 2 it
/// becomes the profile's: the factors of the standard errors come back. On a bound chi2 has a slope, and
/// nothing is asked.                                                                  theory.md (I.32)
Eigen::VectorXd test_intervals(const RecordModel& model, const RecordData& data, RecordFit& fit) {
  const Eigen::Index count = fit.rank.covariance.rows();
  Eigen::VectorXd factors = Eigen::VectorXd::Ones(count);
  const auto is_small = [](double factor) { return factor > 0.5 && factor < 2.0; };
  for (Eigen::Index k = 0; k < count && !model.stopped() && fit.lower.empty(); ++k) {
    const double variance = fit.rank.covariance(k, k);
    const RecordSetting& number = fit.settings[static_cast<std::size_t>(k)];
    const bool on_bound = number.value <= number.number.lower || number.value >= number.number.upper;
    if (!fit.rank.is_known(static_cast<std::size_t>(k)) || !(variance > 0.0) || on_bound) continue;
    const Eigen::VectorXd direction = fit.rank.covariance.col(k) / variance;
    // Where numbers nearly make up for each other a straight line leaves a curved valley, and chi2 rises
    // along it in any case. One side that agrees with the interval is enough.
    bool in_any_case = go_together(fit, direction);
    double widest = 0.0;
    for (const double side : {1.0, -1.0}) {
      const std::optional<ValleyPoint> valley =
          valley_beside(model, data, fit, direction, k, side, in_any_case);
      if (valley && !valley->rises()) {
        add_valley(data, *valley, k, fit);
        break;
      }
      const double factor = valley ? valley->promised / std::sqrt(valley->rise) : 1.0;
      widest = std::max(widest, factor);
      in_any_case = in_any_case && !is_small(factor);
    }
    if (!is_small(widest) && fit.rank.is_known(static_cast<std::size_t>(k))) factors[k] = widest;
  }
  return factors;
}

/// The covariance with one number of each null direction held.
void hold_null_directions(const RecordData& data, RecordFit& fit) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < fit.rank.covariance.rows(); ++k)
    if (fit.rank.covariance(k, k) > 0.0) free.push_back(k);
  fit.covariance.setZero();
  if (free.empty()) return;
  const ColouredNoise noise = coloured_noise(data, fit.residual, static_cast<Eigen::Index>(free.size()));
  Eigen::VectorXd scale(static_cast<Eigen::Index>(free.size()));
  for (Eigen::Index k = 0; k < scale.size(); ++k)
    scale[k] = fit.settings[static_cast<std::size_t>(free[static_cast<std::size_t>(k)])].number.scale;
  fit.covariance(free, free) =
      scale.asDiagonal() * sandwich(data, noise, fit.jacobian(Eigen::all, free)) * scale.asDiagonal();
}

}  // namespace

void find_rank(const RecordModel& model, const RecordData& data, RecordFit& fit) {
  const auto numbers = static_cast<Eigen::Index>(fit.settings.size());
  if (numbers == 0 || !fit.report.usable() || fit.jacobian.cols() != numbers || model.stopped()) return;
  constexpr double twice = 2.0;
  const Eigen::MatrixXd wide =
      signal_derivatives(model, data, fit.settings, fit.predictions, {}, Differences::central, twice);
  if (model.stopped()) return;
  fit.rank = identifiability_of(fit.jacobian, wide - fit.jacobian, [&](const Eigen::VectorXd& direction) {
    return stays_along(model, data, fit, direction);
  });
  const Eigen::VectorXd factors = test_intervals(model, data, fit);
  fit.rank.covariance = factors.asDiagonal() * fit.rank.covariance * factors.asDiagonal();
  if (fit.covariance.cols() != numbers) return;
  if (!fit.rank.directions.empty()) hold_null_directions(data, fit);
  fit.covariance = factors.asDiagonal() * fit.covariance * factors.asDiagonal();
}

}  // namespace snare::identification
