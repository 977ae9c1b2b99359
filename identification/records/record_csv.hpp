#pragma once

#include "identification/records/record_set.hpp"

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::identification {

/// What of a CSV file is one record.
struct RecordCsv {
  std::filesystem::path file;
  std::string time_column = "time_s";
  std::vector<std::pair<std::string, double>>
      columns;                                       ///< with the factor that leads to the unit of the sensor
  std::vector<std::pair<std::string, double>> rows;  ///< only those in which this column has this value
  double from = -std::numeric_limits<double>::infinity(),
         to = std::numeric_limits<double>::infinity();  ///< of the file's clock [s]
  double clock = 0.0;              ///< time of the file's clock at which the scenario begins [s]
  int every = 1;                   ///< of the rows that are left, each of so many
  double cutoff = 0.0;             ///< of a low-pass filter before [Hz]; 0: none
  std::optional<double> most_gap;  ///< longest time between two readings [s]; absent: 20 times the usual
};

/// Times on the scenario's clock and values of the columns.
struct RecordReadings {
  std::vector<double> times;  ///< on the record's clock [s]
  std::vector<std::vector<double>> values;
  RecordFilter filter;
};

/// Reads it. Throws InputError with everything that is wrong (at most a few of each kind): columns that are
/// missing, cells that are no number, times that stand still or go back, gaps, times before the scenario
/// begins; fewer than `fewest_readings`; columns that are constant, or stand at their largest or smallest
/// value most of the time.
[[nodiscard]] RecordReadings read_record_csv(const RecordCsv& csv);

inline constexpr std::size_t fewest_readings = 20;

/// Puts what `read` gives into a record; or says what is wrong.
[[nodiscard]] std::vector<std::string> read_into(const std::function<RecordReadings()>& read, Record& record);

}  // namespace snare::identification
