#include "identification/records/record_data.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

Eigen::VectorXd stacked(const RecordData& data, const std::vector<RecordPrediction>& predictions,
                        bool residual) {
  Eigen::VectorXd all(data.rows);
  for (const ResidualPiece& piece : data.pieces) {
    const RecordPrediction& p = predictions[data.place_of(piece.record)];
    if (!p.usable()) return {};
    all.segment(piece.begin, piece.size) = p.channels[piece.channel].head(piece.size) / piece.scale;
    if (residual)
      all.segment(piece.begin, piece.size) =
          data.set->records[piece.record].channels[piece.channel].values.head(piece.size) / piece.scale -
          all.segment(piece.begin, piece.size);
  }
  return all;
}

}  // namespace

std::size_t RecordData::place_of(std::size_t record) const {
  return static_cast<std::size_t>(std::find(records.begin(), records.end(), record) - records.begin());
}

Eigen::VectorXd RecordData::residual(const std::vector<RecordPrediction>& predictions) const {
  return stacked(*this, predictions, true);
}

Eigen::VectorXd RecordData::signal(const std::vector<RecordPrediction>& predictions) const {
  return stacked(*this, predictions, false);
}

std::vector<RecordSetting> together(std::vector<RecordSetting> settings,
                                    const std::vector<RecordSetting>& fixed) {
  settings.insert(settings.end(), fixed.begin(), fixed.end());
  return settings;
}

RecordData record_data(const RecordSet& set, const std::vector<std::size_t>& records,
                       const ChannelScales& scales) {
  RecordData data;
  data.set = &set;
  data.records = records;
  for (const std::size_t r : records) {
    for (std::size_t c = 0; c < set.records[r].channels.size(); ++c) {
      const RecordChannel& channel = set.records[r].channels[c];
      if (!channel.fitted) continue;
      const double scale =
          channel.sigma.value_or(scales.contains(channel.sensor) ? scales.at(channel.sensor) : 1.0);
      data.pieces.push_back({r, c, data.rows, channel.values.size(), scale});
      data.rows += channel.values.size();
    }
  }
  return data;
}

std::optional<RecordData> beginnings(const RecordData& data, double share, Eigen::Index fewest) {
  RecordData part = data;
  part.rows = 0;
  part.readings.assign(data.records.size(), 1);
  for (ResidualPiece& piece : part.pieces) {
    piece.begin = part.rows;
    piece.size = static_cast<Eigen::Index>(std::ceil(share * static_cast<double>(piece.size)));
    if (piece.size < fewest) return std::nullopt;
    part.rows += piece.size;
    part.readings[data.place_of(piece.record)] = piece.size;
  }
  return part;
}

ChannelScales first_scales(const RecordSet& set, const std::vector<std::size_t>& records) {
  struct Sum {
    double squares = 0.0, count = 0.0;
  };
  std::map<std::string, Sum> sums;
  for (const std::size_t r : records) {
    for (const RecordChannel& c : set.records[r].channels) {
      sums[c.sensor].squares += (c.values.array() - c.values.mean()).square().sum();
      sums[c.sensor].count += static_cast<double>(c.values.size());
    }
  }
  ChannelScales scales;
  for (const auto& [sensor, sum] : sums)
    scales[sensor] = std::max(1e-300, std::sqrt(sum.squares / std::max(1.0, sum.count)));
  return scales;
}

}  // namespace snare::identification
