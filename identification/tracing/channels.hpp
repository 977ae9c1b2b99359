#pragma once

#include "identification/effects/effect.hpp"

#include <functional>
#include <string>
#include <vector>

namespace snare::identification {

/// What an unknown function in one channel would do to the curves, to first order.
struct ChannelColumns {
  static constexpr int stations = 12;

  Channel channel{};
  std::string argument;    ///< what it is a function of, with unit: "travel [mm]"
  std::string effect;      ///< what it does: "adds to the recorded force [N]"
  std::vector<double> at;  ///< stations of the argument, in its unit
  Eigen::MatrixXd
      columns;           ///< whitened change of the forces for one (SI) of the function's hat at each station
  double unit = 1.0;     ///< SI of a value in the unit of `effect`
  std::string constant;  ///< key of the number that a function without slope is: "mount.span_mm"
};

/// A number for each reading of a series.
using OfReading = std::function<double(std::size_t series, Eigen::Index reading)>;

/// Columns of a function of `argument` whose value times `weight` [N] is added to the recorded force;
/// stations over the range of the argument. argument_unit: SI of the unit in which `at` is.
[[nodiscard]] ChannelColumns function_columns(const Data& data, const OfReading& argument,
                                              const OfReading& weight, double argument_unit);

/// Adds to `row`, from column `first` on, `weight` times the values of `count` hats over even stations at a
/// share [0, 1] of their range.
void add_hats(double share, double weight, Eigen::Index count, Eigen::Index first,
              Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> row);

/// One function in every channel that these series have: the reading against travel and against time, the
/// mounts against tension, the pusher's lag against force, what resists the pusher either way, the bending
/// stiffness along the wire.
///                                                                                            theory.md (I.6)
[[nodiscard]] std::vector<ChannelColumns> channel_columns(const Model& model, const Data& data,
                                                          const Fit& current);

/// P that the noise alone leaves as much in the direction of some smooth function of the channel [-]: the
/// score test of its variance,                                                                theory.md (I.8)
///   Q = r^T C K C^T r,  C the columns with the fitted ones projected out,  K_ij = exp(-(i - j)^2 / (2 l^2)),
///   l = 2.5.
[[nodiscard]] double channel_p(const ChannelColumns& channel, const Fit& current);

}  // namespace snare::identification
