#include "identification/records/profile.hpp"

#include "identification/records/coloured_noise.hpp"
#include "numerics/dense_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace snare::identification {

namespace {

constexpr int most_points = 16;      // on one side
constexpr double most_growth = 4.0;  // of a step over the one before
// of the deviate: the limit is read between two points that are that near, or by the secant
constexpr double close = 0.02;
constexpr double first_target = 1.0;  // deviates: one on the way to the limit
const double limit_deviate = std::sqrt(profile_rise_95);

/// Whether a number stands at one of its bounds.
bool at_bound(const RecordSetting& s) {
  return s.value <= s.number.lower || s.value >= s.number.upper;
}

/// Variance by noise of the fall of the sum of squares that one number brings: with g the column, those of
/// the others taken out, g' Sigma g / g' g. theory.md (I.27)
double rise_unit(const RecordData& data, const RecordFit& fit, Eigen::Index number) {
  std::vector<Eigen::Index> others;
  for (Eigen::Index k = 0; k < fit.jacobian.cols(); ++k)
    if (k != number && fit.jacobian.col(k).norm() > 0.0 &&
        !at_bound(fit.settings[static_cast<std::size_t>(k)]))
      others.push_back(k);
  Eigen::VectorXd g = fit.jacobian.col(number);
  if (!others.empty()) {
    const Eigen::MatrixXd beside = fit.jacobian(Eigen::all, others);
    g -= beside * numerics::full_rank_least_squares(beside, g);
  }
  const double square = g.squaredNorm();
  // Where the number does nothing that the others cannot, white noise of the same power.
  if (!(square > 1e-18 * fit.jacobian.col(number).squaredNorm()))
    return fit.residual.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, fit.residual.size()));
  const ColouredNoise noise = coloured_noise(data, fit.residual, fit.jacobian.cols());
  return coloured(data, noise, g).squaredNorm() / square;
}

/// The way outward on one side.
class Side {
 public:
  Side(const RecordModel& model, const RecordData& data, const RecordFit& fit, std::size_t number,
       const RecordFitOptions& options, double unit, double direction)
      : model_(model),
        data_(data),
        fit_(fit),
        number_(number),
        options_(options),
        unit_(unit),
        direction_(direction),
        others_(fit.settings) {
    others_.erase(others_.begin() + static_cast<std::ptrdiff_t>(number));
    options_.derivatives = FitDerivatives::last;
    options_.fixed.push_back(fit.settings[number]);
  }

  ProfileSide walk(double first_step) {
    const RecordSetting& own = fit_.settings[number_];
    const double bound = direction_ < 0.0 ? own.number.lower : own.number.upper;
    double value = own.value, deviate = 0.0, step = first_step;
    std::optional<double> barrier;  // nearest value that cannot be simulated
    ProfileSide side;
    while (static_cast<int>(points.size()) < most_points && !model_.stopped()) {
      if (value == bound) {
        side.limit = bound;
        side.end = ProfileEnd::bound;
        return side;
      }
      double next = value + direction_ * step;
      if (direction_ * (next - bound) > 0.0) next = bound;
      if (barrier && direction_ * (next - *barrier) >= 0.0) next = 0.5 * (value + *barrier);
      const std::optional<double> found = deviate_at(next);
      if (!found) {
        barrier = next;
        step = 0.5 * std::abs(next - value);
        if (step <= 1e-3 * first_step) {
          side.end = ProfileEnd::not_simulated;
          return side;
        }
        continue;
      }
      const double inner = value, inner_deviate = deviate;
      value = next;
      deviate = *found;
      if (deviate >= limit_deviate) {
        side.limit = crossing(inner, inner_deviate, value, deviate);
        side.end = ProfileEnd::crossed;
        return side;
      }
      const double slope = (deviate - inner_deviate) / std::abs(value - inner);
      const double target = deviate < first_target - close ? first_target : 1.02 * limit_deviate;
      const double wanted = slope > 0.0 ? (target - deviate) / slope : most_growth * std::abs(value - inner);
      step = std::clamp(wanted, 0.05 * std::abs(value - inner), most_growth * std::abs(value - inner));
    }
    return side;
  }

  std::vector<ProfilePoint> points;
  double fall = 0.0;

 private:
  /// Root of the rise where the number is held, the others fitted again; nothing where that cannot be
  /// simulated.
  std::optional<double> deviate_at(double value) {
    options_.fixed.back().value = value;
    const RecordFit there = fit_motion(model_, data_, others_, options_);
    if (there.residual.size() == 0) return std::nullopt;
    others_ = there.settings;
    options_.first_jacobian = there.jacobian;
    const double rise = (there.chi2 - fit_.chi2) / unit_;
    fall = std::max(fall, -rise);
    points.push_back({value, std::max(0.0, rise)});
    return std::sqrt(std::max(0.0, rise));
  }
  /// Between a point below the limit and one beyond it, by secants of the deviate.
  double crossing(double below, double below_deviate, double above, double above_deviate) {
    for (int k = 0; k < 4 && above_deviate - below_deviate > close && !model_.stopped(); ++k) {
      const double between =
          below + (above - below) * (limit_deviate - below_deviate) / (above_deviate - below_deviate);
      if (above_deviate - limit_deviate < close) return between;
      const std::optional<double> found = deviate_at(between);
      if (!found) break;
      if (std::abs(*found - limit_deviate) < 0.25 * close) return between;
      if (*found > limit_deviate) {
        above = between;
        above_deviate = *found;
      } else {
        below = between;
        below_deviate = *found;
      }
    }
    return below + (above - below) * (limit_deviate - below_deviate) / (above_deviate - below_deviate);
  }

  const RecordModel& model_;
  const RecordData& data_;
  const RecordFit& fit_;
  std::size_t number_;
  RecordFitOptions options_;
  double unit_, direction_;
  std::vector<RecordSetting> others_;
};

}  // namespace

Profile profile_of(const RecordModel& model, const RecordData& data, const RecordFit& fit, std::size_t number,
                   const RecordFitOptions& options) {
  const auto column = static_cast<Eigen::Index>(number);
  if (number >= fit.settings.size() || column >= fit.jacobian.cols())
    throw std::invalid_argument("profile_of: no such number, or a fit without its jacobian");
  const RecordSetting& own = fit.settings[number];
  Profile profile;
  profile.key = own.number.key;
  profile.unit = own.number.unit;
  profile.value = own.value;
  profile.points.push_back({own.value, 0.0});
  const long before = model.simulations();
  const double unit = rise_unit(data, fit, column);
  const double variance = fit.covariance(column, column);
  const double step = variance > 0.0 ? first_target * std::sqrt(variance) : own.number.scale;
  for (const double direction : {-1.0, 1.0}) {
    Side side(model, data, fit, number, options, unit, direction);
    (direction < 0.0 ? profile.lower : profile.upper) = side.walk(step);
    profile.points.insert(profile.points.end(), side.points.begin(), side.points.end());
    profile.fall = std::max(profile.fall, side.fall);
  }
  std::sort(profile.points.begin(), profile.points.end(),
            [](const ProfilePoint& a, const ProfilePoint& b) { return a.value < b.value; });
  profile.simulations = model.simulations() - before;
  return profile;
}

}  // namespace snare::identification
