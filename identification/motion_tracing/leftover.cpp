#include "identification/motion_tracing/leftover.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace snare::identification {

namespace {

constexpr int steps = 20;   // of the function
constexpr int blocks = 20;  // of the time, by turns to learn and to try

/// Sums of a residual over the steps of an abscissa, learned in the one half of the blocks and tried in the
/// other, both ways.
struct Tally {
  double tried = 0.0, left = 0.0;  // squares
};

void tally(const std::vector<double>& abscissa, const std::vector<double>& residual,
           const std::vector<int>& block, Tally& sum) {
  const auto ends = std::minmax_element(abscissa.begin(), abscissa.end());
  const double low = *ends.first;
  const double width = (*ends.second - low) / steps;
  if (!(width > 0.0)) return;
  const auto bin = [&](double x) { return std::clamp(static_cast<int>((x - low) / width), 0, steps - 1); };
  for (const int half : {0, 1}) {
    std::vector<double> mean(steps, 0.0), count(steps, 0.0);
    for (std::size_t i = 0; i < residual.size(); ++i) {
      if (block[i] % 2 != half) continue;
      mean[static_cast<std::size_t>(bin(abscissa[i]))] += residual[i];
      count[static_cast<std::size_t>(bin(abscissa[i]))] += 1.0;
    }
    for (std::size_t i = 0; i < residual.size(); ++i) {
      if (block[i] % 2 == half) continue;
      const auto b = static_cast<std::size_t>(bin(abscissa[i]));
      const double guess = count[b] > 0.0 ? mean[b] / count[b] : 0.0;
      sum.tried += residual[i] * residual[i];
      sum.left += (residual[i] - guess) * (residual[i] - guess);
    }
  }
}

}  // namespace

std::vector<Leftover> leftovers(const RecordModel& model, const RecordData& data, const RecordFit& fit) {
  const RecordSet& set = model.records();
  std::map<std::pair<std::string, std::string>, std::array<std::vector<double>, 2>> pairs;
  std::map<std::string, std::vector<int>> block_of;
  for (const ResidualPiece& piece : data.pieces) {
    const Record& record = set.records[piece.record];
    const std::string& sensor = record.channels[piece.channel].sensor;
    const RecordPrediction& prediction = fit.predictions[data.place_of(piece.record)];
    const Eigen::VectorXd& own = prediction.channels[piece.channel];
    const Eigen::Index n = piece.size;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double residual = fit.residual[piece.begin + i] * piece.scale;
      const auto add = [&](const std::string& on, double abscissa) {
        auto& pair = pairs[{sensor, on}];
        pair[0].push_back(abscissa);
        pair[1].push_back(residual);
      };
      add("time", record.times[i]);
      const Eigen::Index before = std::max<Eigen::Index>(0, i - 1), after = std::min(n - 1, i + 1);
      const auto rate = [&](const Eigen::VectorXd& v) {
        return (v[after] - v[before]) / (record.times[after] - record.times[before]);
      };
      add("value", own[i]);
      add("rate", rate(own));
      for (std::size_t c = 0; c < record.channels.size(); ++c) {
        if (c == piece.channel) continue;
        add(record.channels[c].sensor, prediction.channels[c][i]);
        add("rate of " + record.channels[c].sensor, rate(prediction.channels[c]));
      }
      block_of[sensor].push_back(static_cast<int>(blocks * i / n));
    }
  }
  std::vector<Leftover> found;
  for (const auto& [key, pair] : pairs) {
    Tally sum;
    tally(pair[0], pair[1], block_of[key.first], sum);
    if (sum.tried > 0.0) found.push_back({key.first, key.second, 1.0 - sum.left / sum.tried});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Leftover& a, const Leftover& b) { return a.share > b.share; });
  return found;
}

}  // namespace snare::identification
