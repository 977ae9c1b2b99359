#include "identification/tracing/channels.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/fitting/statistics.hpp"
#include "identification/tracing/projection.hpp"
#include "numerics/dense_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace snare::identification {

namespace {

constexpr int stations = ChannelColumns::stations;

}  // namespace

void add_hats(double share, double weight, Eigen::Index count, Eigen::Index first,
              Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> row) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(count - 1);
  const auto j = std::min(static_cast<Eigen::Index>(at), count - 2);
  const double part = at - static_cast<double>(j);
  row[first + j] += weight * (1.0 - part);
  row[first + j + 1] += weight * part;
}

ChannelColumns function_columns(const Data& data, const OfReading& argument, const OfReading& weight,
                                double argument_unit) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (const std::size_t k : data.series) {
    for (Eigen::Index i = 0; i < data.measured[k].size(); ++i) {
      low = std::min(low, argument(k, i));
      high = std::max(high, argument(k, i));
    }
  }
  ChannelColumns result;
  const auto hats = [&](std::size_t k) {
    const Eigen::Index n = data.measured[k].size();
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(n, stations);
    for (Eigen::Index i = 0; i < n; ++i) {
      add_hats(high > low ? (argument(k, i) - low) / (high - low) : 0.0, weight(k, i), stations, 0,
               own.row(i));
    }
    return own;
  };
  result.columns = data.whiten(hats, stations);
  for (int s = 0; s < stations; ++s)
    result.at.push_back((low + (high - low) * s / (stations - 1)) / argument_unit);
  return result;
}

std::vector<ChannelColumns> channel_columns(const Model& model, const Data& data, const Fit& current) {
  std::vector<ChannelColumns> channels;
  const auto displacement = [&](std::size_t k, Eigen::Index i) {
    return measured_displacement(model.series()[k])[static_cast<std::size_t>(i)];
  };
  const auto computed = [&](std::size_t k, Eigen::Index i) { return current.evaluation.force[k][i]; };
  const auto add = [&](ChannelColumns c, Channel channel, const std::string& argument,
                       const std::string& effect, double unit, const std::string& constant) {
    c.channel = channel;
    c.argument = argument;
    c.effect = effect;
    c.unit = unit;
    c.constant = constant;
    channels.push_back(std::move(c));
  };
  const auto one = [](std::size_t, Eigen::Index) { return 1.0; };

  add(function_columns(data, displacement, one, 1e-3), Channel::sensor, "recorded travel [mm]",
      "adds to the recorded force [N]", 1.0, "reading.force_offset_N");
  bool timed = true;
  for (const std::size_t k : data.series)
    timed = timed && model.series()[k].readings && !model.series()[k].readings->time.empty();
  const auto time = [&](std::size_t k, Eigen::Index i) {
    const auto r = static_cast<std::size_t>(i);
    if (!timed) return static_cast<double>(i);
    return model.series()[k].readings->time[r] - model.series()[k].readings->time.front();
  };
  add(function_columns(data, time, one, 1.0), Channel::sensor,
      timed ? "time since the series began [s]" : "number of the reading", "adds to the recorded force [N]",
      1.0, "reading.force_offset_N");

  const Parameter& span = parameters().at("mount.span_mm");
  const Parameter& zero = parameters().at("reading.displacement_offset_mm");
  const bool supports = model.series().front().test.mount.kind == wire::MountKind::supports;
  const Evaluation smooth = model.evaluate(current.settings, {&span, &zero});
  if (smooth.complete) {
    if (!supports) {
      const auto pull = [&](std::size_t k, Eigen::Index i) {
        return current.evaluation.predictions[k].mount_pull[static_cast<std::size_t>(i)];
      };
      add(function_columns(
              data, pull, [&](std::size_t k, Eigen::Index i) { return smooth.by[k](i, 0); }, 1.0),
          Channel::mount, "pull on the mount along the chord [N]", "moves the mounts apart [mm]", 1e-3,
          span.key);
    }
    add(function_columns(
            data, computed, [&](std::size_t k, Eigen::Index i) { return smooth.by[k](i, 1); }, 1.0),
        Channel::pusher, "force on the pusher [N]", "the pusher lags behind the recorded travel [mm]", 1e-3,
        zero.key);
  }
  const auto sense = [&](std::size_t k, Eigen::Index i) {
    const Eigen::Index last = data.measured[k].size() - 1;
    const double move =
        displacement(k, std::min(i + 1, last)) - displacement(k, std::max<Eigen::Index>(i - 1, 0));
    return move > 0.0 ? 1.0 : (move < 0.0 ? -1.0 : 0.0);
  };
  add(function_columns(data, computed, sense, 1.0), Channel::contact, "force on the pusher [N]",
      "resists the pusher's motion, either way [N]", 1.0, "");
  if (!supports) {
    const Evaluation windows = model.evaluate_windows(current.settings, stations);
    if (windows.complete) {
      ChannelColumns c;
      c.columns = data.jacobian(windows);
      const double length = model.series().front().test.wire.length;
      for (int s = 0; s < stations; ++s) c.at.push_back(1e3 * length * s / (stations - 1));
      add(std::move(c), Channel::wire, "place along the wire from the left mount [mm]",
          "changes the bending stiffness there, as a share", 1.0, "wire.bending_stiffness_Nm2");
    }
  }

  return channels;
}

double channel_p(const ChannelColumns& channel, const Fit& current) {
  constexpr double length = 2.5;  // of the correlation between stations
  const Eigen::Index m = channel.columns.cols();
  Eigen::MatrixXd prior(m, m);
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < m; ++j)
      prior(i, j) = std::exp(-0.5 * std::pow(static_cast<double>(i - j) / length, 2));
  }
  const numerics::SymmetricEigen root = numerics::symmetric_eigen(prior);
  const Eigen::MatrixXd half =
      root.vectors * root.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() * root.vectors.transpose();
  const Eigen::MatrixXd c = Projection(current.jacobian).without(channel.columns) * half;
  return chi_square_mixture_tail((c.transpose() * current.residual).squaredNorm(),
                                 numerics::symmetric_eigen(c.transpose() * c).values);
}

}  // namespace snare::identification
