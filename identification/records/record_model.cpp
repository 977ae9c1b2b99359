#include "identification/records/record_model.hpp"

#include "base/errors.hpp"
#include "base/index.hpp"
#include "base/parallel.hpp"
#include "identification/records/sensor_signals.hpp"
#include "scenario/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::identification {

namespace {

using scenario::WireMotions;

constexpr long longest_trial = 100;  // over the longest run before
constexpr long a_run = 150;  // steps that a run may take at least, however quiet the declared motion is

/// The run of a scenario with sensors.
const WireMotions& run_of(const scenario::Scenario& s, const RecordSet& set) {
  if (s.motions.sensors.empty())
    throw base::InputError({set.file.string(), 0, "scenario", set.scenario.string(),
                            "must have [[sensors]]: a record is compared with what they read"});
  return s.motions;
}

/// Whether every reading of a record comes with a sample of the computed motion.
bool is_sampled(const Record& record, double interval) {
  constexpr double round_off = 1e-6;  // of the interval
  return !(record.filter.cutoff > 0.0) && std::ranges::all_of(record.times, [&](double time) {
    return std::abs(time / interval - std::round(time / interval)) < round_off;
  });
}

/// Sensors with a reading at every sample, where there are so many more samples; others as they are.
std::vector<scenario::Sensor> sampled_more_often(std::vector<scenario::Sensor> sensors, double interval,
                                                 int parts) {
  for (scenario::Sensor& s : sensors)
    if (s.interval == interval) s.interval /= parts;
  return sensors;
}

/// Long enough for the first readings of a record, whatever the scenario's own duration. A filter that runs
/// both ways wants all of them.
double duration_for(const Record& record, Eigen::Index readings, double interval) {
  const Eigen::Index last = (record.filter.cutoff > 0.0 ? record.times.size() : readings) - 1;
  return (std::ceil(record.times[last] / interval) + 1.0) * interval;
}

}  // namespace

RecordModel::RecordModel(const RecordSet& set, std::function<bool()> stop)
    : set_(set), declared_(declared_scenario(set)), stop_(std::move(stop)) {
  const scenario::Scenario read = scenario::read_scenario(set.scenario, set.set);
  const WireMotions& motions = run_of(read, set);
  std::string known;
  for (const scenario::Sensor& s : motions.sensors) {
    const std::vector<std::string> names = s.columns();
    for (const std::string& name : names) {
      columns_[name] = name;
      known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", name);
    }
    if (names.size() == 1) columns_[s.name] = names.front();
  }
  std::vector<base::InputProblem> problems;
  for (const Record& r : set.records) {
    for (const RecordChannel& c : r.channels)
      if (!columns_.contains(c.sensor))
        problems.push_back({set.file.string(), 0, fmt::format("records[{}].columns.{}", r.name, c.column),
                            c.sensor, "must be a column of the scenario's sensors: " + known});
  }
  for (const FreeNumber& f : set.free) {
    // What stands in no file may still be a key; an override finds out.
    std::vector<base::Override> overrides = set.set;
    overrides.push_back({f.key, exact_text(declared_.number(f.key).value_or(f.scale.value_or(0.0)))});
    try {
      static_cast<void>(scenario::read_scenario(set.scenario, overrides));
    } catch (const base::InputError& error) {
      problems.push_back({set.file.string(), 0, "fit.free", f.key,
                          "must be a number of the scenario: " + error.problems().front().message()});
    }
    if (f.lower && declared_.number(f.key).value_or(0.0) < *f.lower)
      problems.push_back(
          {set.file.string(), 0, "fit.numbers", f.key,
           fmt::format("is declared as {:.9g}, below its bound", declared_.number(f.key).value_or(0.0))});
    if (f.upper && declared_.number(f.key).value_or(0.0) > *f.upper)
      problems.push_back(
          {set.file.string(), 0, "fit.numbers", f.key,
           fmt::format("is declared as {:.9g}, above its bound", declared_.number(f.key).value_or(0.0))});
  }
  // Keys of records must be right, too, before anything is written.
  for (const Record& r : set.records) {
    if (r.set.empty()) continue;
    try {
      std::vector<base::Override> overrides = set.set;
      overrides.insert(overrides.end(), r.set.begin(), r.set.end());
      static_cast<void>(scenario::read_scenario(set.scenario, overrides));
    } catch (const base::InputError& error) {
      problems.push_back({set.file.string(), 0, fmt::format("records[{}].set", r.name), "",
                          error.problems().front().message()});
    }
  }
  for (const RecordFamily& family : set.families) {
    try {
      std::vector<base::Override> overrides = set.set;
      overrides.insert(overrides.end(), family.set.begin(), family.set.end());
      static_cast<void>(scenario::read_scenario(set.scenario, overrides));
    } catch (const base::InputError& error) {
      problems.push_back({set.file.string(), 0, fmt::format("fit.families[{}].set", family.name), "",
                          error.problems().front().message()});
    }
  }
  if (!problems.empty()) throw base::InputError(problems);
  for (const Record& r : set.records) declared_in_.push_back(declared_scenario(set, r.set));
  for (const FreeNumber& f : set.free) bounds_[f.key] = lower_bound(f);
  look_at_joints();
}

double RecordModel::lower_bound(const FreeNumber& number) const {
  const double declared = declared_.number(number.key).value_or(0.0);
  constexpr double none = -std::numeric_limits<double>::infinity();
  constexpr double next_to_zero = 1e-6;  // of what is declared, where zero itself is refused
  if (!(declared > 0.0)) return none;
  const auto taken = [&](double value) {
    std::vector<base::Override> overrides = set_.set;
    overrides.push_back({number.key, exact_text(value)});
    try {
      static_cast<void>(scenario::read_scenario(set_.scenario, overrides));
      return true;
    } catch (const base::InputError&) {
      return false;
    }
  };
  if (taken(-declared)) return none;
  return taken(0.0) ? 0.0 : next_to_zero * declared;
}

std::vector<RecordSetting> RecordModel::free_settings(const std::vector<std::size_t>& records) const {
  std::vector<RecordSetting> settings;
  for (const FreeNumber& f : set_.free) {
    RecordNumber number = keyed_number(f.key, declared_.number(f.key).value_or(0.0));
    number.lower = f.lower.value_or(bounds_.at(f.key));
    if (f.upper) number.upper = *f.upper;
    if (f.scale) {
      number.scale = *f.scale;
      number.scale_follows = false;
    }
    if (!f.each) {
      settings.push_back({number, number.declared});
      continue;
    }
    for (const std::size_t r : records) {
      number.record = r;
      number.key = fmt::format("records[{}].{}", set_.records[r].name, f.key);
      for (const base::Override& one : set_.records[r].set)
        if (one.key == f.key) number.declared = std::stod(one.value);
      settings.push_back({number, number.declared});
    }
  }
  return settings;
}

std::string RecordModel::unit(const RecordChannel& channel) const {
  const auto column = columns_.find(channel.sensor);
  return column == columns_.end() ? "" : unit_of_key(column->second);
}

std::vector<base::Override> RecordModel::keys_of(const std::vector<RecordSetting>& settings,
                                                 std::size_t count, std::size_t record) const {
  std::vector<base::Override> overrides = set_.set;
  const Record& r = set_.records[record];
  overrides.insert(overrides.end(), r.set.begin(), r.set.end());
  // an override, and the key above which it is counted
  std::vector<std::pair<std::size_t, std::string>> counted_above;
  for (std::size_t k = 0; k < count; ++k) {
    const RecordSetting& s = settings[k];
    if (!s.number.overrides || (s.number.record && *s.number.record != record)) continue;
    if (!s.number.above.empty()) counted_above.emplace_back(overrides.size(), s.number.above);
    for (base::Override& one : s.number.overrides(s.value, {declared_in_[record], overrides}))
      overrides.push_back(std::move(one));
  }
  for (const auto& [at, key] : counted_above) {
    const double other = StandingNumbers{declared_in_[record], overrides}.number(key).value_or(0.0);
    overrides[at].value = exact_text(std::stod(overrides[at].value) + other);
  }
  return overrides;
}

std::vector<base::Override> RecordModel::overrides_of(const std::vector<RecordSetting>& settings,
                                                      std::size_t record, Eigen::Index readings) const {
  std::vector<base::Override> overrides = keys_of(settings, settings.size(), record);
  const double interval = declared_.number("output_interval_s").value_or(1e-3);
  overrides.push_back({"duration_s", exact_text(duration_for(set_.records[record], readings, interval))});
  return overrides;
}

double RecordModel::as_set(const std::vector<RecordSetting>& settings, std::size_t number,
                           double value) const {
  const RecordNumber& own = settings[number].number;
  if (!own.overrides || !own.above.empty()) return value;
  const std::size_t record = own.record.value_or(set_.used(false).front());
  const std::vector<base::Override> before = keys_of(settings, number, record);
  const std::vector<base::Override> last = own.overrides(value, {declared_in_[record], before});
  const bool sets = std::ranges::any_of(last, [&](const base::Override& one) { return one.key == own.key; });
  return sets ? StandingNumbers{declared_in_[record], last}.number(own.key).value_or(value) : value;
}

std::shared_ptr<const SensorRun> RecordModel::run(const std::vector<base::Override>& overrides,
                                                  std::size_t record, std::string& failure) const {
  std::string key = std::to_string(record);
  for (const base::Override& one : overrides) key += "\n" + one.key + "=" + one.value;
  {
    const std::scoped_lock lock(kept_guard_);
    for (const auto& [of, run] : kept_)
      if (of == key) return run;
  }
  const scenario::Scenario read = scenario::read_scenario(set_.scenario, overrides);
  const WireMotions& motions = run_of(read, set_);
  const scenario::NamedMotion& named = motions.runs.front();
  coupling::MotionOptions options = named.options;
  // A cubic between samples errs by the fourth power of their distance.
  const int parts = is_sampled(set_.records[record], options.output_interval) ? 1 : 4;
  options.output_interval /= parts;
  const long most = most_steps_;
  long steps = 0;
  options.stop = [&] { return ++steps > most || stopped(); };
  std::vector<coupling::MotionSample> samples;
  ++simulations_;
  const coupling::MotionResult result =
      coupling::simulate(named.motion, options, [&](const coupling::MotionSample& s) {
        samples.push_back(s);
        return false;
      });
  if (steps > most) {
    failure = fmt::format("the integration takes more than {} steps, {} times those of any run before", most,
                          longest_trial);
    return nullptr;
  }
  if (!result.report.usable()) {
    failure = result.report.message.empty() ? "the integration stopped" : result.report.message;
    return nullptr;
  }
  took(steps);
  auto run = std::make_shared<const SensorRun>(read_sensors_of(
      sampled_more_often(motions.sensors, named.options.output_interval, parts), named.motion, samples));
  constexpr std::size_t most_kept = 12;
  const std::scoped_lock lock(kept_guard_);
  kept_.emplace_back(key, run);
  if (kept_.size() > most_kept) kept_.pop_front();
  return run;
}

RecordPrediction RecordModel::simulate(const std::vector<RecordSetting>& settings, std::size_t record,
                                       Eigen::Index readings) const {
  RecordPrediction prediction;
  try {
    const std::shared_ptr<const SensorRun> run =
        this->run(overrides_of(settings, record, readings), record, prediction.failure);
    if (run == nullptr) return prediction;
    SignalChanges changes;
    for (const RecordSetting& s : settings)
      if (s.number.signal && (!s.number.record || *s.number.record == record))
        s.number.signal(changes, s.value);
    prediction.channels = signals_at(*run, set_.records[record], readings, columns_, changes);
  } catch (const base::InputError& error) {
    prediction.failure = error.problems().front().message();
  }
  for (const Eigen::VectorXd& c : prediction.channels)
    if (!c.allFinite()) prediction.failure = "the prediction is not finite";
  return prediction;
}

std::vector<RecordPrediction> RecordModel::predict(const std::vector<RecordSetting>& settings,
                                                   const std::vector<std::size_t>& records,
                                                   const std::vector<Eigen::Index>& readings) const {
  return predict_many({settings}, records, readings).front();
}

std::vector<std::vector<RecordPrediction>> RecordModel::predict_many(
    const std::vector<std::vector<RecordSetting>>& settings, const std::vector<std::size_t>& records,
    const std::vector<Eigen::Index>& readings, const std::vector<RecordPrediction>* base,
    const std::vector<std::optional<std::size_t>>& only) const {
  std::vector<std::vector<RecordPrediction>> all(settings.size(),
                                                 std::vector<RecordPrediction>(records.size()));
  struct Task {
    std::size_t setting, record;
  };
  std::vector<Task> tasks;
  for (std::size_t s = 0; s < settings.size(); ++s) {
    for (std::size_t r = 0; r < records.size(); ++r) {
      if (base != nullptr && s < only.size() && only[s] && *only[s] != records[r])
        all[s][r] = (*base)[r];
      else
        tasks.push_back({s, r});
    }
  }
  base::parallel_for(tasks.size(), [&](std::size_t t) {
    const auto [s, r] = tasks[t];
    const Eigen::Index count = readings.empty() ? set_.records[records[r]].times.size() : readings[r];
    all[s][r] = simulate(settings[s], records[r], count);
  });
  bound_trials();
  return all;
}

void RecordModel::took(long steps) const {
  long longest = longest_run_;
  while (steps > longest && !longest_run_.compare_exchange_weak(longest, steps)) {
  }
}

void RecordModel::bound_trials() const {
  if (longest_run_ > 0) most_steps_ = longest_trial * std::max<long>(longest_run_, a_run);
}

void RecordModel::look_at_joints() {
  const std::size_t first = set_.used(false).front();
  const scenario::Scenario read =
      scenario::read_scenario(set_.scenario, overrides_of({}, first, set_.records[first].times.size()));
  const scenario::NamedMotion& run = run_of(read, set_).runs.front();
  slowest_ = slowest_mode(run.motion);
  coupling::MotionOptions options = run.options;
  long steps = 0;
  options.stop = [&] {
    ++steps;
    return stopped();
  };
  struct Sum {
    Eigen::VectorXd spring, drive, rate;
  };
  std::vector<Sum> sums;
  for (const coupling::MotionArm& arm : run.motion.arms) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(arm.arm.motors());
    sums.push_back({none, none, none});
  }
  double count = 0.0;
  const coupling::MotionResult result =
      coupling::simulate(run.motion, options, [&](const coupling::MotionSample& s) {
        for (std::size_t a = 0; a < sums.size(); ++a) {
          sums[a].spring += s.arms[a].joint_torque.cwiseAbs2();
          sums[a].drive += s.arms[a].drive_torque.cwiseAbs2();
          sums[a].rate += s.arms[a].state.motor_rate.cwiseAbs2();
        }
        count += 1.0;
        return false;
      });
  if (result.report.usable()) took(steps);
  bound_trials();
  if (count == 0.0) return;
  for (std::size_t a = 0; a < sums.size(); ++a) {
    const coupling::MotionArm& arm = run.motion.arms[a];
    for (int j = 0; j < arm.arm.motors(); ++j) {
      const multibody::ElasticJoint& joint = arm.arm.joints[base::at(j)];
      if (joint.flexure) continue;
      joints_[arm.name + "::" + joint.name] = {
          std::sqrt(std::max(sums[a].spring[j], sums[a].drive[j]) / count),
          std::sqrt(sums[a].rate[j] / count),
          arm.arm.tree.body(joint.body).joint == multibody::JointKind::prismatic, joint.link};
    }
  }
}

}  // namespace snare::identification
