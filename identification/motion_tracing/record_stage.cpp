#include "identification/motion_tracing/record_stage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace snare::identification {

namespace {

constexpr double median_of_normal = 0.674489750196082;  // of its size, over its standard deviation

struct Sums {
  double squares = 0.0, measured = 0.0, count = 0.0;
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
};

std::vector<ChannelError> errors_of(const RecordModel& model, const std::vector<std::size_t>& records,
                                    const std::vector<RecordPrediction>& predictions) {
  std::vector<ChannelError> errors;
  std::map<std::string, Sums> sums;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Record& record = model.records().records[records[k]];
    if (!predictions[k].usable()) continue;
    for (std::size_t c = 0; c < record.channels.size(); ++c) {
      const RecordChannel& channel = record.channels[c];
      if (!sums.contains(channel.sensor))
        errors.push_back({channel.sensor, model.unit(channel), channel.fitted, 0.0, 0.0, 0.0,
                          reading_sigma(model.records(), channel.sensor)});
      Sums& s = sums[channel.sensor];
      const Eigen::VectorXd& predicted = predictions[k].channels[c];
      const auto measured = channel.values.head(predicted.size());
      s.squares += (measured - predicted).squaredNorm();
      s.measured += measured.squaredNorm();
      s.count += static_cast<double>(measured.size());
      s.low = std::min(s.low, measured.minCoeff());
      s.high = std::max(s.high, measured.maxCoeff());
    }
  }
  for (ChannelError& e : errors) {
    const Sums& s = sums[e.sensor];
    e.rmse = std::sqrt(s.squares / s.count);
    e.nrmse = e.rmse / (s.high - s.low);
    e.relative = s.measured > 0.0 ? std::sqrt(s.squares / s.measured) : 0.0;
  }
  return errors;
}

/// Root mean square over the fitted channels: of the only one in its unit, of several over their scales.
double rmse_of(const RecordData& data, const Eigen::VectorXd& residual) {
  if (residual.size() == 0) return 0.0;
  bool one = true;
  for (const ResidualPiece& p : data.pieces)
    one =
        one && data.set->records[p.record].channels[p.channel].sensor ==
                   data.set->records[data.pieces.front().record].channels[data.pieces.front().channel].sensor;
  double sum = 0.0;
  for (const ResidualPiece& p : data.pieces)
    sum += residual.segment(p.begin, p.size).squaredNorm() * (one ? p.scale * p.scale : 1.0);
  return std::sqrt(sum / static_cast<double>(residual.size()));
}

}  // namespace

double reading_sigma(const RecordSet& set, const std::string& sensor) {
  std::vector<double> sizes;
  double sum = 0.0;
  for (const Record& record : set.records) {
    for (const RecordChannel& c : record.channels) {
      if (c.sensor != sensor) continue;
      if (c.sigma) return *c.sigma;
      const Eigen::Index n = c.values.size();
      const Eigen::VectorXd second =
          c.values.head(n - 2) - 2.0 * c.values.segment(1, n - 2) + c.values.tail(n - 2);
      for (const double d : second) sizes.push_back(std::abs(d));
      sum += second.squaredNorm();
    }
  }
  if (sizes.empty()) return 0.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  // A coarse encoder stands still most of the time: then the mean square.
  const double of_one =
      *middle > 0.0 ? *middle / median_of_normal : std::sqrt(sum / static_cast<double>(sizes.size()));
  return of_one / std::sqrt(6.0);
}

namespace {

/// Number k of a fit; its standard error and interval by the covariance.
TracedNumber number_of(const RecordModel& model, const RecordFit& fit, std::size_t k) {
  const auto i = static_cast<Eigen::Index>(k);
  const RecordSetting& s = fit.settings[k];
  const auto told = [&](double value) { return model.as_set(fit.settings, k, value); };
  TracedNumber n{s.number.key, s.number.unit, told(s.value), 0.0, {}, {}};
  n.bound = at_bound(s.value, s.number.lower, s.number.upper);
  n.identified = i < fit.covariance.rows() && fit.covariance(i, i) > 0.0 && i < fit.jacobian.cols() &&
                 fit.jacobian.col(i).norm() > 0.0;
  if (!n.identified) return n;
  const double error = std::sqrt(fit.covariance(i, i));
  n.stderr_ = std::abs(told(s.value + error) - n.value);
  if (n.bound != AtBound::lower) n.lower = told(std::max(s.number.lower, s.value - half_width_95 * error));
  if (n.bound != AtBound::upper) n.upper = told(std::min(s.number.upper, s.value + half_width_95 * error));
  return n;
}

/// The null directions of a fit whose rank was asked. Numbers with the sign of their declared value scale;
/// places shift, where they may change theirs.
std::vector<OpenNumbers> open_numbers(const RecordModel& model, const RecordFit& fit) {
  std::vector<OpenNumbers> open;
  for (const NullDirection& direction : fit.rank.directions) {
    OpenNumbers one;
    std::vector<std::size_t> numbers{direction.held};
    numbers.insert(numbers.end(), direction.others.begin(), direction.others.end());
    double largest = 0.0;  // power; what shifts is counted to 1 % of what scales
    for (const std::size_t k : numbers) {
      const RecordSetting& s = fit.settings[k];
      const bool place = s.number.unit == "mm" || s.number.unit == "m" || s.number.unit == "deg";
      const bool relative = s.value * s.number.declared > 0.0 && (s.number.lower >= 0.0 || !place);
      const double change =
          direction.change[static_cast<Eigen::Index>(k)] * s.number.scale / (relative ? s.value : 1.0);
      one.changes.push_back({s.number.key, s.number.unit, change, relative});
      if (relative) largest = std::max(largest, std::abs(change));
      if (k != direction.held) one.known.push_back(number_of(model, fit, k));
    }
    one.held = fit.settings[direction.held].value;
    const double unit = largest > 0.0 ? largest : std::abs(one.changes.front().change);
    for (NamedChange& c : one.changes) c.change /= unit;
    open.push_back(std::move(one));
  }
  return open;
}

}  // namespace

std::vector<TracedNumber> traced_numbers(const RecordModel& model, const RecordFit& fit) {
  std::vector<TracedNumber> numbers;
  for (std::size_t k = 0; k < fit.settings.size(); ++k) {
    TracedNumber n = number_of(model, fit, k);
    if (!fit.rank.is_known(k)) {
      n.identified = false;
      n.stderr_ = 0.0;
      n.lower = n.upper = std::nullopt;
    }
    numbers.push_back(std::move(n));
  }
  return numbers;
}

RecordStage record_stage(const RecordModel& model, const RecordData& data, const RecordFit& fit,
                         const RecordFit* heldout, const RecordData& heldout_data) {
  RecordStage stage;
  stage.numbers = traced_numbers(model, fit);
  stage.open = open_numbers(model, fit);
  stage.errors = errors_of(model, data.records, fit.predictions);
  stage.rmse = rmse_of(data, fit.residual);
  double range = 0.0, squares = 0.0, count = 0.0;
  for (const ChannelError& e : stage.errors) {
    if (!e.fitted) continue;
    range = std::max(range, e.nrmse);
    if (e.sigma > 0.0) {
      squares += e.rmse * e.rmse / (e.sigma * e.sigma);
      count += 1.0;
    }
  }
  stage.nrmse = range;
  const auto readings = static_cast<double>(fit.residual.size());
  const double free = std::max(1.0, readings - static_cast<double>(fit.settings.size()));
  stage.chi2_dof = count > 0.0 ? squares / count * (readings / free) : 0.0;
  stage.predictions.resize(model.records().records.size());
  for (std::size_t k = 0; k < data.records.size(); ++k)
    stage.predictions[data.records[k]] = fit.predictions[k];
  if (heldout == nullptr) return stage;
  stage.heldout = errors_of(model, heldout_data.records, heldout->predictions);
  stage.heldout_rmse = rmse_of(heldout_data, heldout->residual);
  for (std::size_t k = 0; k < heldout_data.records.size(); ++k)
    stage.predictions[heldout_data.records[k]] = heldout->predictions[k];
  return stage;
}

}  // namespace snare::identification
