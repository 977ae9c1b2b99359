#pragma once

#include "identification/fitting/experiment.hpp"
#include "identification/fitting/reading_model.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::identification {

/// Recorded displacements of a series [m].
[[nodiscard]] const std::vector<double>& measured_displacement(const Series& series);

/// Speed of the pusher at the readings of a series by differences over neighbouring times [m/s]; zero without
/// times.
[[nodiscard]] std::vector<double> speeds(const Series& series);

/// What the wire and the pusher do at the readings of a series, one entry a reading.
struct TrueForce {
  std::vector<double> force;    ///< of the wire on the pusher [N]
  std::vector<double> viscous;  ///< viscous stiffness G [N/m]; empty: no rates
};

/// Travel of the pusher from first touch at the readings [m]; negative before it.
[[nodiscard]] std::vector<double> true_travel(const Series& series, const ReadingModel& reading);

/// What the machine records at the readings [N].
[[nodiscard]] std::vector<double> recorded_force(const Series& series, const ReadingModel& reading,
                                                 const TrueForce& wire);

/// Change of the recorded forces by changes of the true ones, to first order: columns [N] of one row a
/// reading.
[[nodiscard]] Eigen::MatrixXd recorded_change(const Series& series, const ReadingModel& reading,
                                              const TrueForce& wire, Eigen::MatrixXd change);

}  // namespace snare::identification
