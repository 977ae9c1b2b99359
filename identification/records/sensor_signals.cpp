#include "identification/records/sensor_signals.hpp"

#include "identification/records/low_pass.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

/// The low-pass filter of the first order over readings that are straight in between, exactly: with u the way
/// from one reading to the next and T the lag, y' = (s - y)/T gives y = s - T s' + (y0 - s0 + T s')
/// exp(-t/T).
std::vector<double> lagged(const std::vector<double>& times, const std::vector<double>& values, double lag) {
  if (!(lag > 0.0)) return values;
  std::vector<double> filtered(values);
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double step = times[k] - times[k - 1];
    const double slope = (values[k] - values[k - 1]) / step;
    filtered[k] =
        values[k] - lag * slope + (filtered[k - 1] - values[k - 1] + lag * slope) * std::exp(-step / lag);
  }
  return filtered;
}

/// On the cubic through the four samples about a time, of which two are before it; of fewer samples the
/// polynomial through all.
double value_at(const std::vector<double>& times, const std::vector<double>& values, double time) {
  if (time <= times.front()) return values.front();
  if (time >= times.back()) return values.back();
  const auto after =
      static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (time == times[after - 1]) return values[after - 1];
  const std::size_t count = std::min<std::size_t>(4, times.size());
  const std::size_t first = std::min(after < 2 ? 0 : after - 2, times.size() - count);
  double value = 0.0;
  for (std::size_t i = first; i < first + count; ++i) {
    double weight = 1.0;
    for (std::size_t j = first; j < first + count; ++j)
      if (j != i) weight *= (time - times[j]) / (times[i] - times[j]);
    value += weight * values[i];
  }
  return value;
}

}  // namespace

SensorRun read_sensors_of(const std::vector<scenario::Sensor>& sensors, const coupling::Motion& motion,
                          const std::vector<coupling::MotionSample>& samples) {
  SensorRun run;
  for (scenario::Sensor quiet : sensors) {
    quiet.noise = 0.0;
    run.columns.push_back(quiet.columns());
    run.readings.push_back(scenario::read_off(quiet, motion, samples));
  }
  return run;
}

std::vector<Eigen::VectorXd> signals_at(const SensorRun& run, const Record& record, Eigen::Index count,
                                        const std::map<std::string, std::string>& columns,
                                        const SignalChanges& changes) {
  std::vector<Eigen::VectorXd> result(record.channels.size());
  for (std::size_t s = 0; s < run.readings.size(); ++s) {
    const std::vector<std::string>& names = run.columns[s];
    const scenario::Readings& readings = run.readings[s];
    for (std::size_t c = 0; c < record.channels.size(); ++c) {
      const std::string& column = columns.at(record.channels[c].sensor);
      const auto component = std::find(names.begin(), names.end(), column);
      if (component == names.end()) continue;
      SignalChange change;
      for (const std::string& key : {std::string(), column}) {
        if (const auto found = changes.find(key); found != changes.end()) {
          change.gain *= found->second.gain;
          change.bias += found->second.bias;
          change.drift += found->second.drift;
          change.delay += found->second.delay;
          change.lag += found->second.lag;
        }
      }
      const std::vector<double> values = lagged(
          readings.times, readings.values[static_cast<std::size_t>(component - names.begin())], change.lag);
      const RecordFilter& filter = record.filter;
      const Eigen::VectorXd times = filter.cutoff > 0.0 ? filter.times : record.times.head(count);
      result[c].resize(times.size());
      for (Eigen::Index i = 0; i < times.size(); ++i) {
        const double t = times[i];
        result[c][i] =
            change.gain * value_at(readings.times, values, t - change.delay) + change.bias + change.drift * t;
      }
      if (!(filter.cutoff > 0.0)) continue;
      const double interval = (times[times.size() - 1] - times[0]) / static_cast<double>(times.size() - 1);
      result[c] = Eigen::VectorXd(low_passed(result[c], interval, filter.cutoff)(filter.kept)).head(count);
    }
  }
  return result;
}

}  // namespace snare::identification
