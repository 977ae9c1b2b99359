#include "identification/records/record_csv.hpp"

#include "base/csv.hpp"
#include "identification/records/low_pass.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

/// Share of the readings that may stand at the largest or the smallest value.
constexpr double most_at_end = 0.5;
constexpr std::size_t longest_chance_run =
    4;                               ///< readings at an end of the range that noise never makes the same
constexpr double most_beyond = 4.0;  ///< steps of the sensor: a turn that its steps hide is one at most
constexpr double usual_gaps = 20.0;  ///< times the median interval

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Where the longest run of readings that are exactly `value` begins, and how many there are.
std::pair<std::size_t, std::size_t> longest_run(const std::vector<double>& values, double value) {
  std::size_t first = 0, longest = 0, run = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    run = values[k] == value ? run + 1 : 0;
    if (run <= longest) continue;
    longest = run;
    first = k + 1 - run;
  }
  return {first, longest};
}

/// Smallest difference of two readings, but for rounding: the step of an encoder, or the last digit of the
/// file.
double resolution(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double rounding = 1e-9 * (values.back() - values.front());
  double least = values.back() - values.front();
  for (std::size_t k = 1; k < values.size(); ++k)
    if (const double step = values[k] - values[k - 1]; step > rounding) least = std::min(least, step);
  return least;
}

/// How far a signal would have gone beyond a run of the same readings, had it gone on as it came and as it
/// left: a parabola with both slopes, or at the end of the record with the first. 0 for a run at the start,
/// where a system is at rest.
double beyond(const std::vector<double>& values, std::size_t first, std::size_t count) {
  constexpr std::size_t few = 3;  // readings, for a slope
  if (first < few) return 0.0;
  const double end = values[first];
  const double came = std::abs(end - values[first - few]);
  const bool stays = first + count + few > values.size();
  const double left = stays ? came : std::abs(values[first + count + few - 1] - end);
  return 0.25 * static_cast<double>(count) * 0.5 * (came + left) / static_cast<double>(few);
}

/// Problems of the times, a few of each kind.
void check_times(const RecordCsv& csv, const std::vector<double>& times,
                 std::vector<base::InputProblem>& problems) {
  constexpr std::size_t most_told = 3;
  const auto tell = [&](double time, std::string requirement) {
    problems.push_back({csv.file.string(), 0, csv.time_column, fmt::format("{:.9g}", time + csv.clock),
                        std::move(requirement)});
  };
  std::size_t told = 0;
  std::vector<double> steps;
  for (std::size_t k = 1; k < times.size(); ++k) {
    steps.push_back(times[k] - times[k - 1]);
    if (steps.back() > 0.0 || told >= most_told) continue;
    ++told;
    tell(times[k], steps.back() == 0.0
                       ? "stands there twice: times must ascend"
                       : fmt::format("comes after {:.9g}: times must ascend", times[k - 1] + csv.clock));
  }
  if (!times.empty() && times.front() < -1e-9)
    tell(times.front(),
         fmt::format("must not be before clock_s = {:.9g}, when the scenario begins", csv.clock));
  if (told > 0 || steps.empty()) return;
  const double usual = median(steps);
  const double most = csv.most_gap.value_or(usual_gaps * usual);
  for (std::size_t k = 0; k < steps.size() && told < most_told; ++k) {
    if (steps[k] <= most) continue;
    ++told;
    tell(times[k + 1], fmt::format("comes {:.6g} s after the reading before, usual are {:.6g} s: part the "
                                   "record, or declare longest_gap_s",
                                   steps[k], usual));
  }
}

void check_values(const RecordCsv& csv, const std::string& column, const std::vector<double>& values,
                  std::vector<base::InputProblem>& problems) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const auto tell = [&](double value, std::string requirement) {
    problems.push_back({csv.file.string(), 0, column, fmt::format("{:.9g}", value), std::move(requirement)});
  };
  if (*low == *high) return tell(*low, "all readings are the same: nothing can be learned from them");
  for (const double end : {*low, *high}) {
    const auto count = std::count(values.begin(), values.end(), end);
    if (static_cast<double>(count) > most_at_end * static_cast<double>(values.size()))
      tell(end, fmt::format(
                    "{} of {} readings stand at this end of the range: the sensor was saturated or at rest",
                    count, values.size()));
    else if (const auto [first, run] = longest_run(values, end);
             run >= longest_chance_run && beyond(values, first, run) > most_beyond * resolution(values))
      tell(end,
           fmt::format(
               "{} readings one after the other stand at this end of the range, at which the signal came "
               "at full rate: the sensor was saturated, leave these out by from_s and to_s",
               run));
  }
}

/// Low-pass filter, where one is asked, and of what is left each of so many.
void thin_out(const RecordCsv& csv, RecordReadings& readings, std::vector<base::InputProblem>& problems) {
  const std::size_t count = readings.times.size();
  if (csv.cutoff > 0.0) {
    const double interval = (readings.times.back() - readings.times.front()) / static_cast<double>(count - 1);
    constexpr double even = 0.01;  // share of the interval
    double off = 0.0;
    for (std::size_t k = 0; k < count; ++k)
      off = std::max(
          off, std::abs(readings.times[k] - readings.times.front() - static_cast<double>(k) * interval));
    const auto tell = [&](std::string requirement) {
      problems.push_back(
          {csv.file.string(), 0, "lowpass_Hz", fmt::format("{:.6g}", csv.cutoff), std::move(requirement)});
    };
    if (!(off <= even * interval)) return tell("only for readings that are evenly spaced");
    if (!(csv.cutoff * interval < 0.5))
      return tell(fmt::format("must be below half the rate of the readings, {:.6g} Hz", 0.5 / interval));
    readings.filter.cutoff = csv.cutoff;
    readings.filter.times =
        Eigen::Map<const Eigen::VectorXd>(readings.times.data(), static_cast<Eigen::Index>(count));
    for (std::vector<double>& column : readings.values) {
      const Eigen::Map<Eigen::VectorXd> values(column.data(), static_cast<Eigen::Index>(count));
      const Eigen::VectorXd filtered = low_passed(values, interval, csv.cutoff);
      std::copy(filtered.begin(), filtered.end(), column.begin());
    }
  }
  const auto thin = [&](std::vector<double>& values) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < values.size(); k += static_cast<std::size_t>(csv.every))
      values[kept++] = values[k];
    values.resize(kept);
  };
  for (std::size_t k = 0; k < count; k += static_cast<std::size_t>(csv.every))
    readings.filter.kept.push_back(static_cast<Eigen::Index>(k));
  thin(readings.times);
  for (std::vector<double>& column : readings.values) thin(column);
}

}  // namespace

RecordReadings read_record_csv(const RecordCsv& csv) {
  std::vector<base::CsvColumn> asked{{csv.time_column}};
  for (const auto& [name, factor] : csv.columns) asked.push_back({.name = name, .unit = factor});
  for (const auto& [name, value] : csv.rows) asked.push_back({name});
  const base::CsvTable table = base::read_csv(csv.file, asked);
  RecordReadings readings;
  readings.values.resize(csv.columns.size());
  const std::size_t first_filter = 1 + csv.columns.size();
  for (std::size_t i = 0; i < table.rows; ++i) {
    bool taken = true;
    for (std::size_t f = 0; f < csv.rows.size(); ++f)
      taken = taken && table.columns[first_filter + f][i] == csv.rows[f].second;
    const double time = table.columns[0][i];
    if (!taken || time < csv.from || time > csv.to) continue;
    readings.times.push_back(time - csv.clock);
    for (std::size_t c = 0; c < csv.columns.size(); ++c)
      readings.values[c].push_back(table.columns[1 + c][i]);
  }
  std::vector<base::InputProblem> problems;
  const auto few = [&] {
    if (readings.times.size() >= fewest_readings) return false;
    problems.push_back(
        {csv.file.string(), 0, "", "",
         fmt::format("{} readings, must be at least {}", readings.times.size(), fewest_readings)});
    return true;
  };
  if (!few()) {
    check_times(csv, readings.times, problems);
    for (std::size_t c = 0; c < csv.columns.size(); ++c)
      check_values(csv, csv.columns[c].first, readings.values[c], problems);
    if (problems.empty()) {
      thin_out(csv, readings, problems);
      few();
    }
  }
  if (!problems.empty()) throw base::InputError(problems);
  return readings;
}

std::vector<std::string> read_into(const std::function<RecordReadings()>& read, Record& record) {
  std::vector<std::string> problems;
  try {
    const RecordReadings readings = read();
    record.times = Eigen::Map<const Eigen::VectorXd>(readings.times.data(),
                                                     static_cast<Eigen::Index>(readings.times.size()));
    record.filter = readings.filter;
    for (std::size_t c = 0; c < record.channels.size(); ++c)
      record.channels[c].values = Eigen::Map<const Eigen::VectorXd>(
          readings.values[c].data(), static_cast<Eigen::Index>(readings.values[c].size()));
  } catch (const base::InputError& error) {
    for (const base::InputProblem& p : error.problems()) problems.push_back(p.message());
  }
  return problems;
}

}  // namespace snare::identification
