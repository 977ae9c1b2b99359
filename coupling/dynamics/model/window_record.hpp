#pragma once

#include "numerics/dae.hpp"

#include <Eigen/Core>

#include <deque>
#include <span>
#include <vector>

namespace snare::coupling {

/// Values at the states of the last window of time, and at the latest one at or before its beginning.
class WindowRecord {
 public:
  struct Record {
    double time = 0.0;  ///< [s]
    Eigen::VectorXd values;
  };

  /// window [s], >= 0.
  explicit WindowRecord(double window) : window_(window) {}

  /// Length of the window [s].
  [[nodiscard]] double window() const { return window_; }
  /// From the earliest to the latest.
  [[nodiscard]] const std::deque<Record>& records() const { return records_; }
  /// At a state later than the last one [s].
  void add(double time, const Eigen::VectorXd& values) {
    records_.push_back({time, values});
    while (records_.size() > 2 && records_[1].time <= time - window_) records_.pop_front();
  }
  /// See DaePart; times [s], values in their units.
  void save_state(std::vector<double>& memory) const {
    memory.push_back(static_cast<double>(records_.size()));
    memory.push_back(records_.empty() ? 0.0 : static_cast<double>(records_.front().values.size()));
    for (const Record& r : records_) {
      memory.push_back(r.time);
      memory.insert(memory.end(), r.values.begin(), r.values.end());
    }
  }
  void restore_state(std::span<const double>& memory) {
    records_.resize(static_cast<std::size_t>(numerics::take(memory)));
    const auto size = static_cast<Eigen::Index>(numerics::take(memory));
    for (Record& r : records_) {
      r.time = numerics::take(memory);
      r.values.resize(size);
      for (double& v : r.values) v = numerics::take(memory);
    }
  }

 private:
  double window_;
  std::deque<Record> records_;
};

}  // namespace snare::coupling
