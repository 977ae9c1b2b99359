#include "identification/attribution.hpp"

#include <Eigen/Cholesky>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>

namespace snare::identification {

namespace {

constexpr int stations = 12;

/// A channel's columns: whitened change of the forces for a unit of the function at each station.
struct Channelled {
  ChannelFunction description;
  Eigen::MatrixXd columns;
  double unit = 1.0;  // SI of the values in their printed unit
};

/// Hat functions over evenly spread stations at one argument.
void add_hats(double u, double weight, Eigen::Ref<Eigen::MatrixXd> out, Eigen::Index row) {
  const double at = std::clamp(u, 0.0, 1.0) * (stations - 1);
  const auto j = std::min(static_cast<Eigen::Index>(at), static_cast<Eigen::Index>(stations - 2));
  const double part = at - static_cast<double>(j);
  out(row, j) += weight * (1.0 - part);
  out(row, j + 1) += weight * part;
}

/// argument(series, reading) and weight(series, reading) -> whitened columns; stations over the range of the argument.
Channelled function_of(const Data& data, const std::function<double(std::size_t, Eigen::Index)>& argument,
                       const std::function<double(std::size_t, Eigen::Index)>& weight, double argument_unit) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (const std::size_t k : data.series) {
    for (Eigen::Index i = 0; i < data.measured[k].size(); ++i) {
      low = std::min(low, argument(k, i));
      high = std::max(high, argument(k, i));
    }
  }
  Channelled result;
  result.columns.resize(data.rows(), stations);
  Eigen::Index row = 0;
  for (const std::size_t k : data.series) {
    const Eigen::Index n = data.measured[k].size();
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(n, stations);
    for (Eigen::Index i = 0; i < n; ++i) {
      add_hats(high > low ? (argument(k, i) - low) / (high - low) : 0.0, weight(k, i), own, i);
    }
    result.columns.middleRows(row, n) = data.noise.whiten(k, own);
    row += n;
  }
  for (int s = 0; s < stations; ++s) result.description.at.push_back((low + (high - low) * s / (stations - 1)) / argument_unit);
  return result;
}

/// Ridge regression on second differences beside free columns.
struct Smooth {
  Eigen::VectorXd values;      // of the function
  Eigen::MatrixXd covariance;  // of them
  Eigen::VectorXd free;        // of the fit's numbers
};

Smooth solve(const Eigen::MatrixXd& free, const Eigen::MatrixXd& columns, const Eigen::VectorXd& r, double weight) {
  const Eigen::Index p = free.cols();
  const Eigen::Index m = columns.cols();
  Eigen::MatrixXd all(free.rows(), p + m);
  all << free, columns;
  Eigen::VectorXd scale(p + m);
  const double size = std::max(columns.colwise().norm().maxCoeff(), 1e-300);
  for (Eigen::Index k = 0; k < p; ++k) scale[k] = 1.0 / std::max(free.col(k).norm(), 1e-300);
  scale.tail(m).setConstant(1.0 / size);
  all = all * scale.asDiagonal();
  Eigen::MatrixXd normal = all.transpose() * all;
  normal.diagonal().head(p).array() += 1e-12;
  for (Eigen::Index i = 1; i + 1 < m; ++i) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(p + m);
    d[p + i - 1] = d[p + i + 1] = 1.0;
    d[p + i] = -2.0;
    normal += weight * d * d.transpose();
  }
  normal.diagonal().tail(m).array() += 1e-6 * weight + 1e-9;
  const Eigen::LDLT<Eigen::MatrixXd> factor(normal);
  const Eigen::VectorXd x = scale.asDiagonal() * factor.solve(all.transpose() * r);
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(p + m, p + m));
  return {x.tail(m), inverse.bottomRightCorner(m, m) / (size * size), x.head(p)};
}

/// Groups of series of one position, or of one slack: a function must hold in each when it was found without it.
std::vector<std::vector<Eigen::Index>> left_out_rows(const Model& model, const Data& data) {
  const auto group_by = [&](const std::function<double(const Series&)>& key) {
    std::map<double, std::vector<Eigen::Index>> groups;
    Eigen::Index row = 0;
    for (const std::size_t k : data.series) {
      std::vector<Eigen::Index>& rows = groups[key(model.series()[k])];
      for (Eigen::Index i = 0; i < data.measured[k].size(); ++i) rows.push_back(row++);
    }
    return groups;
  };
  std::vector<std::vector<Eigen::Index>> result;
  for (const auto& key : {std::function<double(const Series&)>([](const Series& s) { return s.test.contact_position / s.test.mount.span; }),
                          std::function<double(const Series&)>([](const Series& s) { return s.test.wire.length - s.test.mount.span; })}) {
    const auto groups = group_by(key);
    if (groups.size() < 2) continue;
    for (const auto& [value, rows] : groups) result.push_back(rows);
  }
  if (!result.empty()) return result;
  // One kind of test only: leave out series by series.
  Eigen::Index row = 0;
  for (const std::size_t k : data.series) {
    std::vector<Eigen::Index> rows(static_cast<std::size_t>(data.measured[k].size()));
    std::iota(rows.begin(), rows.end(), row);
    row += data.measured[k].size();
    result.push_back(std::move(rows));
  }
  return result;
}

std::string describe(const ChannelFunction& f) {
  // Stretches in which the function stands out by more than three deviations and a quarter of its largest value.
  double largest = 0.0;
  for (const double v : f.value) largest = std::max(largest, std::abs(v));
  std::string text;
  std::size_t i = 0;
  while (i < f.value.size()) {
    const auto stands_out = [&](std::size_t k) {
      return std::abs(f.value[k]) > 3.0 * f.deviation[k] && std::abs(f.value[k]) > 0.25 * largest;
    };
    if (!stands_out(i)) {
      ++i;
      continue;
    }
    const std::size_t from = i;
    const bool high = f.value[i] > 0.0;
    while (i < f.value.size() && stands_out(i) && (f.value[i] > 0.0) == high) ++i;
    text += fmt::format("{}{} between {:.3g} and {:.3g}", text.empty() ? "" : ", ", high ? "high" : "low", f.at[from], f.at[i - 1]);
  }
  return text.empty() ? "nowhere beyond three standard deviations" : text;
}

}  // namespace

std::vector<ChannelFunction> attribute(const Model& model, const Data& data, const Fit& current) {
  std::vector<Channelled> channels;
  const auto displacement = [&](std::size_t k, Eigen::Index i) { return measured_displacement(model.series()[k])[static_cast<std::size_t>(i)]; };
  const auto computed = [&](std::size_t k, Eigen::Index i) { return current.evaluation.force[k][i]; };
  const auto add = [&](Channelled c, Channel channel, const std::string& argument, const std::string& effect, double unit) {
    c.description.channel = channel;
    c.description.argument = argument;
    c.description.effect = effect;
    c.unit = unit;
    channels.push_back(std::move(c));
  };
  const auto one = [](std::size_t, Eigen::Index) { return 1.0; };

  add(function_of(data, displacement, one, 1e-3), Channel::sensor, "recorded travel [mm]", "adds to the recorded force [N]", 1.0);
  bool timed = true;
  for (const std::size_t k : data.series) timed = timed && model.series()[k].readings && !model.series()[k].readings->time.empty();
  const auto time = [&](std::size_t k, Eigen::Index i) {
    const auto r = static_cast<std::size_t>(i);
    if (!timed) return static_cast<double>(i);
    return model.series()[k].readings->time[r] - model.series()[k].readings->time.front();
  };
  add(function_of(data, time, one, 1.0), Channel::sensor, timed ? "time since the series began [s]" : "number of the reading",
      "adds to the recorded force [N]", 1.0);

  const Parameter& span = parameter("mount.span_mm");
  const Parameter& zero = parameter("reading.displacement_offset_mm");
  const bool supports = model.series().front().test.mount.kind == wire::MountKind::supports;
  const Evaluation smooth = model.evaluate(current.settings, {&span, &zero});
  if (smooth.complete) {
    if (!supports) {
      const auto tension = [&](std::size_t k, Eigen::Index i) { return current.evaluation.predictions[k].tension[static_cast<std::size_t>(i)]; };
      add(function_of(data, tension, [&](std::size_t k, Eigen::Index i) { return smooth.by[k](i, 0); }, 1.0), Channel::mount,
          "tension at the mount [N]", "moves the mounts apart [mm]", 1e-3);
    }
    add(function_of(data, computed, [&](std::size_t k, Eigen::Index i) { return smooth.by[k](i, 1); }, 1.0), Channel::pusher,
        "force on the pusher [N]", "the pusher lags behind the recorded travel [mm]", 1e-3);
  }
  const auto sense = [&](std::size_t k, Eigen::Index i) {
    const Eigen::Index last = data.measured[k].size() - 1;
    const double move = displacement(k, std::min(i + 1, last)) - displacement(k, std::max<Eigen::Index>(i - 1, 0));
    return move > 0.0 ? 1.0 : (move < 0.0 ? -1.0 : 0.0);
  };
  add(function_of(data, computed, sense, 1.0), Channel::contact, "force on the pusher [N]",
      "resists the pusher's motion, either way [N]", 1.0);
  if (!supports) {
    const Evaluation windows = model.evaluate_windows(current.settings, stations);
    if (windows.complete) {
      Channelled c;
      c.columns = data.jacobian(windows);
      const double length = model.series().front().test.wire.length;
      for (int s = 0; s < stations; ++s) c.description.at.push_back(1e3 * length * s / (stations - 1));
      add(std::move(c), Channel::wire, "place along the wire from the left mount [mm]",
          "changes the bending stiffness there, as a share", 1.0);
    }
  }

  const Eigen::VectorXd& r = current.residual;
  const double excess = r.squaredNorm() - current.dof();
  const auto groups = left_out_rows(model, data);
  std::vector<ChannelFunction> result;
  for (Channelled& channel : channels) {
    double best = std::numeric_limits<double>::lowest();
    double best_weight = 1.0;
    for (const double weight : {1e-4, 1e-2, 1.0, 1e2}) {
      double without = 0.0;
      double with = 0.0;
      for (const std::vector<Eigen::Index>& out : groups) {
        std::vector<bool> left_out(static_cast<std::size_t>(r.size()), false);
        for (const Eigen::Index i : out) left_out[static_cast<std::size_t>(i)] = true;
        std::vector<Eigen::Index> in;
        for (Eigen::Index i = 0; i < r.size(); ++i) {
          if (!left_out[static_cast<std::size_t>(i)]) in.push_back(i);
        }
        const Eigen::MatrixXd none(static_cast<Eigen::Index>(in.size()), 0);
        const Eigen::MatrixXd free = current.jacobian(in, Eigen::all);
        const Smooth s = solve(free, channel.columns(in, Eigen::all), r(in), weight);
        const Smooth plain = solve(free, Eigen::MatrixXd::Zero(free.rows(), 1), r(in), 1.0);
        const Eigen::VectorXd here = r(out) - current.jacobian(out, Eigen::all) * s.free - channel.columns(out, Eigen::all) * s.values;
        const Eigen::VectorXd before = r(out) - current.jacobian(out, Eigen::all) * plain.free;
        with += here.squaredNorm() - static_cast<double>(out.size());
        without += before.squaredNorm() - static_cast<double>(out.size());
      }
      const double share = without > 0.0 ? 1.0 - with / without : 0.0;
      if (share > best) {
        best = share;
        best_weight = weight;
      }
    }
    ChannelFunction f = channel.description;
    const Smooth s = solve(current.jacobian, channel.columns, r, best_weight);
    const double left = (r - current.jacobian * s.free - channel.columns * s.values).squaredNorm();
    f.carried_over = std::min(best, 1.0);
    f.explained = excess > 0.0 ? std::min(1.0, 1.0 - (left - current.dof()) / excess) : 0.0;
    f.chi2_dof = left / std::max(1.0, current.dof() - stations / 2.0);
    for (Eigen::Index k = 0; k < s.values.size(); ++k) {
      f.value.push_back(s.values[k] / channel.unit);
      f.deviation.push_back(std::sqrt(std::max(s.covariance(k, k), 0.0)) / channel.unit);
    }
    f.shape = describe(f);
    f.accepted = f.carried_over > 0.7;
    result.push_back(std::move(f));
  }
  std::stable_sort(result.begin(), result.end(), [](const ChannelFunction& a, const ChannelFunction& b) { return a.carried_over > b.carried_over; });
  return result;
}

}  // namespace snare::identification
