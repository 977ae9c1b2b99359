#include "identification/fitting/record_map.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

/// Times of the readings [s]; null where the record has none.
const std::vector<double>* times_of(const Series& series) {
  const bool timed = series.readings && series.readings->time.size() == series.readings->displacement.size();
  return timed ? &series.readings->time : nullptr;
}

/// Recorded travel at the time `lag` before each reading, linear between readings.
std::vector<double> delayed(const std::vector<double>& d, const std::vector<double>& t, double lag) {
  std::vector<double> result(d.size());
  for (std::size_t i = 0; i < d.size(); ++i) {
    const double at = t[i] - lag;
    const auto after = std::upper_bound(t.begin(), t.end(), at);
    const auto k = static_cast<std::size_t>(after - t.begin());
    if (k == 0 || k == d.size()) {
      result[i] = k == 0 ? d.front() : d.back();
      continue;
    }
    result[i] = d[k - 1] + (d[k] - d[k - 1]) * (at - t[k - 1]) / (t[k] - t[k - 1]);
  }
  return result;
}

/// What follows a record with so much play: it stands still where the record turns back, until the play is
/// taken up. An odd function of the play, so that it has a derivative at zero.
std::vector<double> with_play(std::vector<double> d, double play) {
  const double width = std::abs(play);
  double follows = d.empty() ? 0.0 : d.front();
  for (double& at : d) {
    follows = std::clamp(follows, at, at + width);
    at += play > 0.0 ? follows - at : at - follows;
  }
  return d;
}

/// 4 b x (1 - x / range): what a sensor of that bow records beyond x.
double bow(double share, double x, double range) {
  return range > 0.0 ? 4.0 * share * x * (1.0 - x / range) : 0.0;
}

/// f + c y by columns, dy/dt = (f - y) / time from rest, f linear between readings.
void add_creep(const std::vector<double>& t, double share, double time, Eigen::MatrixXd& f) {
  Eigen::RowVectorXd y = Eigen::RowVectorXd::Zero(f.cols());
  Eigen::RowVectorXd before = f.row(0);
  for (Eigen::Index i = 0; i < f.rows(); ++i) {
    const Eigen::RowVectorXd now = f.row(i);
    if (i > 0) {
      const auto k = static_cast<std::size_t>(i);
      const double x = std::max(0.0, t[k] - t[k - 1]) / time;
      const double left = std::exp(-x);
      // Of a ramp from `before` to `now` the response is now - before left - (now - before)(1 - left) / x.
      const double mean = x > 1e-6 ? -std::expm1(-x) / x : 1.0 - 0.5 * x;
      y = left * y + (now - left * before) - mean * (now - before);
    }
    f.row(i) = now + share * y;
    before = now;
  }
}

/// F + tau v G, after the creep of the cell.
Eigen::MatrixXd sensed_force(const Series& series, const ReadingModel& reading, const TrueForce& wire) {
  Eigen::MatrixXd sensed =
      Eigen::Map<const Eigen::VectorXd>(wire.force.data(), static_cast<Eigen::Index>(wire.force.size()));
  if (reading.relaxation_time != 0.0 && !wire.viscous.empty()) {
    const std::vector<double> speed = speeds(series);
    for (std::size_t i = 0; i < wire.force.size(); ++i)
      sensed(static_cast<Eigen::Index>(i), 0) += reading.relaxation_time * speed[i] * wire.viscous[i];
  }
  const std::vector<double>* t = times_of(series);
  if (reading.creep != 0.0 && t != nullptr && sensed.rows() > 0)
    add_creep(*t, reading.creep, reading.creep_time, sensed);
  return sensed;
}

}  // namespace

const std::vector<double>& measured_displacement(const Series& series) {
  return series.readings ? series.readings->displacement : series.test.travel;
}

std::vector<double> speeds(const Series& series) {
  const std::vector<double>& d = measured_displacement(series);
  std::vector<double> result(d.size(), 0.0);
  if (!series.readings || series.readings->time.size() != d.size()) return result;
  const std::vector<double>& t = series.readings->time;
  // Over the interval before a reading, whose rate a wire that relaxes remembers; the first has that after
  // it.
  for (std::size_t i = 0; i < d.size(); ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1;
    const std::size_t b = i == 0 ? std::min<std::size_t>(1, d.size() - 1) : i;
    if (t[b] > t[a]) result[i] = (d[b] - d[a]) / (t[b] - t[a]);
  }
  return result;
}

std::vector<double> true_travel(const Series& series, const ReadingModel& reading) {
  const std::vector<double>& d = measured_displacement(series);
  std::vector<double> travel = d;
  const std::vector<double>* t = times_of(series);
  if (reading.lag != 0.0 && t != nullptr) travel = delayed(travel, *t, reading.lag);
  if (reading.play != 0.0) travel = with_play(std::move(travel), reading.play);
  for (std::size_t i = 0; i < d.size(); ++i) {
    const double bent = bow(reading.travel_bow, d[i], series.largest_displacement);
    travel[i] = travel[i] - reading.displacement_offset - bent;
  }
  return travel;
}

std::vector<double> recorded_force(const Series& series, const ReadingModel& reading, const TrueForce& wire) {
  const Eigen::MatrixXd sensed = sensed_force(series, reading, wire);
  const std::vector<double>* t = times_of(series);
  std::vector<double> result(wire.force.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double s = sensed(static_cast<Eigen::Index>(i), 0);
    const double drifted = t != nullptr ? reading.drift * ((*t)[i] - t->front()) : 0.0;
    const double bent = bow(reading.force_bow, s, series.largest_force);
    result[i] = reading.force_offset + drifted + reading.force_gain * (s + bent);
  }
  return result;
}

Eigen::MatrixXd recorded_change(const Series& series, const ReadingModel& reading, const TrueForce& wire,
                                Eigen::MatrixXd change) {
  if (change.size() == 0) return change;
  const std::vector<double>* t = times_of(series);
  if (reading.creep != 0.0 && t != nullptr) add_creep(*t, reading.creep, reading.creep_time, change);
  if (reading.force_bow == 0.0) return reading.force_gain * change;
  const Eigen::MatrixXd sensed = sensed_force(series, reading, wire);
  const double range = series.largest_force;
  for (Eigen::Index i = 0; i < change.rows(); ++i) {
    const double slope = range > 0.0 ? 4.0 * reading.force_bow * (1.0 - 2.0 * sensed(i, 0) / range) : 0.0;
    change.row(i) *= reading.force_gain * (1.0 + slope);
  }
  return change;
}

}  // namespace snare::identification
