#pragma once

#include "base/toml_tree.hpp"

#include <Eigen/Core>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// One column of a record: what a sensor of the scenario read, in the unit of the sensor's column.
struct RecordChannel {
  /// column of the scenario's telemetry: "gyro_x_deg_s", or the sensor's name where it has one column
  std::string sensor;
  std::string column;           ///< of the CSV file
  bool fitted = true;           ///< false: compared and told, not fitted
  std::optional<double> sigma;  ///< declared standard deviation of one reading
  Eigen::VectorXd values;
};

/// What was done to the readings of a record before they are compared, and is done to a prediction alike.
///                                                                                           theory.md (I.25)
struct RecordFilter {
  double cutoff = 0.0;             ///< of the low-pass filter [Hz]; 0: none
  Eigen::VectorXd times;           ///< of all readings, evenly spaced [s]
  std::vector<Eigen::Index> kept;  ///< of these those that are compared
};

/// A record in time of one run of the scenario.
struct Record {
  std::string name;
  std::vector<base::Override> set;  ///< keys of the scenario that were otherwise in this run
  Eigen::VectorXd times;            ///< on the scenario's clock [s], ascending, >= 0
  std::vector<RecordChannel> channels;
  RecordFilter filter;
  bool heldout = false;  ///< never used for fitting or selection
};

/// A declared number that is fitted: its key in the scenario's or an arm's file, in the unit of the key.
struct FreeNumber {
  std::string key;
  bool each = false;  ///< of every record for itself
  std::optional<double> lower, upper, scale;
  bool profile = false;  ///< its profile likelihood is asked
};

/// Other keys of the scenario under which the base fit is done once more: another kind of model of the same
/// records.
struct RecordFamily {
  std::string name;
  std::vector<base::Override> set;
};

enum class FitMethod { gauss_newton, nelder_mead };

/// A record file: records in time of runs of one scenario.
/// docs/record_file.md
struct RecordSet {
  std::filesystem::path file, scenario;
  std::string title, source;
  std::vector<base::Override> set;  ///< of the scenario, for all records: --set scenario.KEY=VALUE
  std::vector<Record> records;
  std::vector<FreeNumber> free;
  FitMethod method = FitMethod::gauss_newton;
  /// Relative change of the numbers with which the simplex ends, (I.30); 0: none.
  double simplex_change = 0.0;
  std::optional<double> tolerance;  ///< share of a channel's rms below which nothing is called missing
  int most_effects = 4;
  std::vector<RecordFamily> families;

  [[nodiscard]] std::vector<std::size_t> used(bool heldout) const;  ///< indices of the records of one kind
};

}  // namespace snare::identification
