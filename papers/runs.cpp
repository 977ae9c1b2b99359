#include "papers/runs.hpp"

#include "results/motion_history.hpp"
#include "results/motion_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace snare::papers {

namespace {

const std::vector<double>* find(const results::History& table, const std::string& name) {
  const auto found = std::ranges::find(table.columns, name, &results::HistoryColumn::name);
  return found == table.columns.end() ? nullptr : &found->numbers;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::pair<const std::vector<double>&, const std::vector<double>&> Run::columns(const std::string& x,
                                                                               const std::string& y) const {
  for (const results::History* table : {&history, &telemetry}) {
    const std::vector<double>*across = find(*table, x), *up = find(*table, y);
    if (across != nullptr && up != nullptr) return {*across, *up};
  }
  throw std::out_of_range(fmt::format("\"{}\" has no columns \"{}\" and \"{}\"", asked.title, x, y));
}

double Run::first_touch(std::size_t contact) const {
  return results::touches_of(result, contact).first.value_or(none);
}

double Run::usable() const {
  return result.report.usable() ? 0.0 : none;
}

const Run& Runs::of(const Case& asked) {
  std::string name = asked.file;
  for (const std::string& setting : asked.settings) name += "\n" + setting;
  return once<Run>(name, [&] { return run(asked); });
}

Run Runs::run(const Case& asked) const {
  go_on();
  std::vector<base::Override> overrides;
  for (const std::string& setting : asked.settings) overrides.push_back(base::parse_override(setting));
  Run run;
  run.asked = scenario::read_scenario(data_ / asked.file, overrides);
  const scenario::NamedMotion& motion = run.asked.motions.runs.front();
  coupling::MotionOptions options = motion.options;
  options.stop = [this] { return watch_.stopped(); };
  run.result = coupling::simulate(motion.motion, options, [&](const coupling::MotionSample& sample) {
    run.samples.push_back(sample);
    watch_.say(fmt::format("{}{}: {:.3f} of {:g} s", stage_, motion.name, sample.time, options.duration));
    return false;
  });
  go_on();
  results::HistoryTable history({}, 1), telemetry({}, 1);
  results::give_history(history, motion.motion, run.samples);
  run.history = std::move(history.history());
  if (!run.asked.motions.sensors.empty()) {
    results::give_telemetry(telemetry, run.asked.motions, run.samples);
    run.telemetry = std::move(telemetry.history());
  }
  return run;
}

}  // namespace snare::papers
