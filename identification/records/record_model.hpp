#pragma once

#include "identification/records/declared_scenario.hpp"
#include "identification/records/record_number.hpp"
#include "identification/records/record_set.hpp"
#include "identification/records/slowest_mode.hpp"

#include <Eigen/Core>

#include <atomic>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

struct SensorRun;

/// What the scenario says of the channels of one record, at the record's times, or at the first of them.
struct RecordPrediction {
  std::vector<Eigen::VectorXd> channels;
  std::string failure;  ///< why there is none; empty: there is

  [[nodiscard]] bool usable() const { return failure.empty(); }  ///< the run came to its end
};

/// Numbers with their values.
struct RecordSetting {
  RecordNumber number;
  double value = 0.0;  ///< in the unit of its key
};

/// How lively the declared motion is, for the sizes at which effects are tried: root mean squares along the
/// first record.
struct JointUse {
  double torque = 0.0, rate = 0.0;  ///< in the spring or of the drive, the larger [N m]; of the motor [rad/s]
  bool slides = false;
  std::string link;  ///< that it moves
};

/// A scenario as a model of records: numbers in, channels out.                               theory.md (I.20)
class RecordModel {
 public:
  /// stop: asked during simulations; true: leave them. Throws InputError for a scenario without sensors, or
  /// that lacks one of the channels, and for keys of free values that are not numbers.
  explicit RecordModel(const RecordSet& set, std::function<bool()> stop = {});

  [[nodiscard]] const RecordSet& records() const { return set_; }  ///< as read
  /// The scenario as its file says.
  [[nodiscard]] const DeclaredScenario& declared() const { return declared_; }
  /// The free numbers of the file, at their declared values; those of every record for itself once for each
  /// of `records`.
  [[nodiscard]] std::vector<RecordSetting> free_settings(const std::vector<std::size_t>& records) const;
  /// Unit of a channel's column, from the sensor's name: "mm".
  [[nodiscard]] std::string unit(const RecordChannel& channel) const;
  [[nodiscard]] const std::map<std::string, JointUse>& joints() const { return joints_; }
  /// Of the first record's scenario.
  [[nodiscard]] const std::optional<SlowMode>& slowest() const { return slowest_; }
  /// Full column of a channel's sensor.
  [[nodiscard]] const std::string& column(const RecordChannel& channel) const {
    return columns_.at(channel.sensor);
  }

  /// Predictions of these records, of the first `readings` of each (empty: of all), beyond which nothing is
  /// simulated. In parallel, the same for any number of threads.
  [[nodiscard]] std::vector<RecordPrediction> predict(const std::vector<RecordSetting>& settings,
                                                      const std::vector<std::size_t>& records,
                                                      const std::vector<Eigen::Index>& readings = {}) const;
  /// The same for several settings at once: [setting][record]. Numbers of one record cost no simulation of
  /// the others: `base` are the predictions at settings that differ in that number only, and are taken over
  /// where `only` says so.
  [[nodiscard]] std::vector<std::vector<RecordPrediction>> predict_many(
      const std::vector<std::vector<RecordSetting>>& settings, const std::vector<std::size_t>& records,
      const std::vector<Eigen::Index>& readings = {}, const std::vector<RecordPrediction>* base = nullptr,
      const std::vector<std::optional<std::size_t>>& only = {}) const;

  /// What the key of a number is set to, in its unit, where the number has this value and those before it in
  /// `settings` theirs: in the first of the fitted records that it is in. An effect's number is counted from
  /// what is declared, and acts beside what others have set. The value itself where a number has no key of
  /// the files.
  [[nodiscard]] double as_set(const std::vector<RecordSetting>& settings, std::size_t number,
                              double value) const;

  [[nodiscard]] long simulations() const { return simulations_; }  ///< runs so far
  [[nodiscard]] bool stopped() const { return stop_ && stop_(); }  ///< somebody wants the work to end

 private:
  /// Null with `failure` set where the scenario cannot be simulated.
  [[nodiscard]] std::shared_ptr<const SensorRun> run(const std::vector<base::Override>& overrides,
                                                     std::size_t record, std::string& failure) const;
  /// A run came to its end in so many steps.
  void took(long steps) const;
  void bound_trials() const;
  [[nodiscard]] RecordPrediction simulate(const std::vector<RecordSetting>& settings, std::size_t record,
                                          Eigen::Index readings) const;
  /// Keys of a record's scenario with the first `count` settings, and with all of them and the duration that
  /// so many readings want.
  [[nodiscard]] std::vector<base::Override> keys_of(const std::vector<RecordSetting>& settings,
                                                    std::size_t count, std::size_t record) const;
  [[nodiscard]] std::vector<base::Override> overrides_of(const std::vector<RecordSetting>& settings,
                                                         std::size_t record, Eigen::Index readings) const;
  void look_at_joints();
  /// Zero or next to it for a number > 0 whose reader takes none below.
  [[nodiscard]] double lower_bound(const FreeNumber& number) const;

  const RecordSet& set_;
  DeclaredScenario declared_;
  std::vector<DeclaredScenario> declared_in_;  ///< as the records declare it, each with its own keys
  std::function<bool()> stop_;
  std::map<std::string, std::string> columns_;  ///< full column of a sensor's short name
  std::map<std::string, JointUse> joints_;
  std::optional<SlowMode> slowest_;
  std::map<std::string, double> bounds_;  ///< lower ones of the free numbers
  mutable std::atomic<long> simulations_ = 0;
  /// Steps of the longest run that came to its end, the declared one first.
  mutable std::atomic<long> longest_run_ = 0;
  /// After which a trial is given up in which something spins or swings beyond all measure. What one batch of
  /// runs takes bounds the next, so that threads do not matter.
  mutable std::atomic<long> most_steps_ = std::numeric_limits<long>::max();
  /// Runs kept for settings that differ in the sensors only: the last few, by record and keys.
  mutable std::mutex kept_guard_;
  mutable std::deque<std::pair<std::string, std::shared_ptr<const SensorRun>>> kept_;
};

}  // namespace snare::identification
