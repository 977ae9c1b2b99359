#pragma once

#include "identification/records/record_number.hpp"
#include "identification/records/record_set.hpp"
#include "scenario/sensors.hpp"

#include <Eigen/Core>

#include <map>
#include <string>
#include <vector>

namespace snare::identification {

/// What the sensors read along a run, without noise.
struct SensorRun {
  std::vector<std::vector<std::string>> columns;  ///< of every sensor
  std::vector<scenario::Readings> readings;
};
[[nodiscard]] SensorRun read_sensors_of(const std::vector<scenario::Sensor>& sensors,
                                        const coupling::Motion& motion,
                                        const std::vector<coupling::MotionSample>& samples);

/// The first `count` readings, in the units of their columns, at the times of a record, with changes:
/// theory.md (I.23). Between readings of a sensor on the cubic through four; before the first one and behind
/// the last one they stand. columns: full names of the channels' sensors.
[[nodiscard]] std::vector<Eigen::VectorXd> signals_at(const SensorRun& run, const Record& record,
                                                      Eigen::Index count,
                                                      const std::map<std::string, std::string>& columns,
                                                      const SignalChanges& changes);

}  // namespace snare::identification
