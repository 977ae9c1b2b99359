#include "identification/motion_tracing/record_findings.hpp"

#include "identification/motion_tracing/record_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>

namespace snare::identification {

namespace {

constexpr double degrees_a_radian = 180.0 / std::numbers::pi;

/// A factor between two units, readings over what is declared.
struct Factor {
  double factor;
  const char* units;
};
constexpr Factor factors[] = {{degrees_a_radian, "degrees for radians"},
                              {1.0 / degrees_a_radian, "radians for degrees"},
                              {1e3, "a thousandth of the unit (mm for m, mN for N)"},
                              {1e-3, "a thousand times the unit (m for mm, kN for N)"},
                              {25.4, "mm for inches"},
                              {1.0 / 25.4, "inches for mm"},
                              {9.80665, "N for kgf, or m/s^2 for g"},
                              {1.0 / 9.80665, "kgf for N, or g for m/s^2"}};

const Factor* near_factor(double ratio, double within) {
  for (const Factor& f : factors)
    if (ratio > 0.0 && std::abs(std::log(ratio / f.factor)) < within) return &f;
  return nullptr;
}

/// ChannelSums over the readings of one sensor, less their means.
struct ChannelSums {
  double measured = 0.0, predicted = 0.0, both = 0.0;
  /// Share of the readings' squares that a multiple of the prediction leaves.
  [[nodiscard]] double left(double multiple) const {
    return (measured - 2.0 * multiple * both + multiple * multiple * predicted) / measured;
  }
};

std::map<std::string, ChannelSums> sums_of(const RecordData& data,
                                           const std::vector<RecordPrediction>& predictions) {
  std::map<std::string, ChannelSums> sums;
  for (const ResidualPiece& piece : data.pieces) {
    const RecordPrediction& prediction = predictions[data.place_of(piece.record)];
    if (!prediction.usable() || prediction.channels.size() <= piece.channel) continue;
    const RecordChannel& channel = data.set->records[piece.record].channels[piece.channel];
    const Eigen::VectorXd m = channel.values.head(piece.size),
                          p = prediction.channels[piece.channel].head(piece.size);
    const Eigen::VectorXd measured = m.array() - m.mean(), predicted = p.array() - p.mean();
    ChannelSums& s = sums[channel.sensor];
    s.measured += measured.squaredNorm();
    s.predicted += predicted.squaredNorm();
    s.both += measured.dot(predicted);
  }
  return sums;
}

/// What the readings of a sensor are to a prediction, if they are not the same.
std::optional<Finding> channel_finding(const std::string& sensor, const ChannelSums& s) {
  constexpr double follows = 0.04;  // share of the squares: a fifth of the standard deviation
  constexpr double within = 0.05;   // of a factor
  if (!(s.measured > 0.0) || !(s.predicted > 0.0) || s.left(1.0) <= follows) return std::nullopt;
  const double multiple = s.both / s.predicted;
  if (s.left(multiple) > follows) return std::nullopt;
  Finding f{.kind = FindingKind::sign_turned, .key = sensor, .value = multiple, .limit = -1.0};
  if (s.left(-1.0) <= follows) {
    f.sure = true;
    f.what = fmt::format(
        "the readings of {} have the other sign than the scenario's sensor: turn the sign round by "
        "scale, or the sensor",
        sensor);
    return f;
  }
  const Factor* slip = near_factor(std::abs(multiple), within);
  if (slip == nullptr) return std::nullopt;
  f.kind = FindingKind::unit_slip;
  f.limit = slip->factor;
  f.what =
      fmt::format("the readings of {} are {:.4g} times what the scenario's sensor reads: it looks like {}",
                  sensor, multiple, slip->units);
  return f;
}

}  // namespace

std::vector<Finding> channel_findings(const RecordData& data,
                                      const std::vector<const std::vector<RecordPrediction>*>& predictions) {
  std::vector<Finding> findings;
  for (const std::vector<RecordPrediction>* of_model : predictions) {
    if (of_model->size() != data.records.size()) continue;
    for (const auto& [sensor, sums] : sums_of(data, *of_model)) {
      if (std::ranges::find(findings, sensor, &Finding::key) != findings.end()) continue;
      if (std::optional<Finding> f = channel_finding(sensor, sums)) findings.push_back(std::move(*f));
    }
  }
  return findings;
}

std::vector<Finding> number_findings(const RecordStage& stage, const std::vector<RecordSetting>& settings) {
  std::vector<Finding> findings;
  for (const OpenNumbers& open : stage.open) {
    Finding f{.kind = FindingKind::not_identifiable, .key = open.changes.front().key, .sure = true};
    f.what = open.changes.size() > 1
                 ? fmt::format("{}; their values are not identifiable", null_words(open.changes))
                 : fmt::format("{} is not identifiable: these records do not change with it", f.key);
    findings.push_back(std::move(f));
  }
  constexpr double within = 0.03;
  for (const TracedNumber& n : stage.numbers) {
    if (n.bound != AtBound::none) {
      const bool lower = n.bound == AtBound::lower;
      Finding f{
          .kind = FindingKind::on_bound, .key = n.key, .unit = n.unit, .value = n.value, .limit = n.value};
      f.what = fmt::format(
          "{} = {:.4g}{}{} stands on its {} bound: the records ask for {} than is admissible", n.key, n.value,
          n.unit.empty() ? "" : " ", n.unit, lower ? "lower" : "upper", lower ? "less" : "more");
      findings.push_back(std::move(f));
      continue;
    }
    const auto declared =
        std::ranges::find_if(settings, [&](const RecordSetting& s) { return s.number.key == n.key; });
    if (!n.identified || declared == settings.end() || declared->number.declared == 0.0) continue;
    const double ratio = n.value / declared->number.declared;
    const Factor* slip = near_factor(ratio, within);
    if (slip == nullptr) continue;
    Finding f{.kind = FindingKind::unit_slip, .key = n.key, .value = ratio, .limit = slip->factor};
    f.what = fmt::format(
        "{} is {:.4g} times its declared value: it looks like a slip of units by {:.4g}, in that "
        "value or in the readings",
        n.key, ratio, slip->factor);
    findings.push_back(std::move(f));
  }
  return findings;
}

std::optional<std::string> lower_minimum(const RecordModel& model, const RecordFit& fit, FitMethod method) {
  if (fit.lower.empty()) return std::nullopt;
  RecordFit there = fit;
  there.settings = fit.lower;
  std::string where;
  for (const TracedNumber& n : traced_numbers(model, there))
    where += fmt::format("{}{} = {:.6g} {}", where.empty() ? "" : ", ", n.key, n.value, n.unit);
  return fmt::format(
      "the fit has not ended at its least sum of squares, which is clearly lower at {}: its numbers and "
      "intervals cannot be relied on; begin there{}",
      where, method == FitMethod::nelder_mead ? ", take a smaller fit.simplex_change, or gauss_newton" : "");
}

}  // namespace snare::identification
