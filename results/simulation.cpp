#include "results/simulation.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace snare::results {

std::vector<MotionRecord> simulate_all(const std::vector<scenario::NamedMotion>& motions, const Watch& watch) {
  std::vector<MotionRecord> records;
  for (const scenario::NamedMotion& asked : motions) {
    MotionRecord record;
    coupling::MotionOptions options = asked.options;
    options.stop = watch.stop;
    record.result = coupling::simulate(asked.motion, options, [&](const coupling::MotionSample& s) {
      record.samples.push_back(s);
      watch.say(fmt::format("{}: {:.3f} of {:.3f} s", asked.name, s.time, options.duration));
      return false;
    });
    const bool stopped = record.result.report.termination == numerics::Termination::interrupted;
    records.push_back(std::move(record));
    if (stopped) break;
  }
  return records;
}

ArmRecord simulate_arm(const scenario::ArmMotion& motion, const Watch& watch) {
  multibody::ArmScenario scenario = motion.scenario;
  scenario.progress = [&watch, end = scenario.end](double time) {
    watch.say(fmt::format("{:.2f} of {:.2f} s", time, end));
  };
  scenario.stop = watch.stop;
  ArmRecord record;
  const auto begin = std::chrono::steady_clock::now();
  record.history = multibody::simulate(scenario);
  record.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (motion.joint >= 0) record.swings = scenario::swings(record.history, scenario.arm, motion.joint);
  return record;
}

}  // namespace snare::results
