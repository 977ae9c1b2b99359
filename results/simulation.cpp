#include "results/simulation.hpp"

#include "results/motion_summary.hpp"
#include "results/warnings.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace snare::results {

std::vector<MotionRecord> simulate_all(const std::vector<scenario::NamedMotion>& motions,
                                       const Watch& watch) {
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

nlohmann::json simulation_document(const scenario::Scenario& asked, const std::vector<MotionRecord>& records,
                                   const Watch& watch) {
  const std::vector<FinishedMotion> finished = finished_motions(asked.motions, records);
  nlohmann::json document = motion_summary(asked, finished.front(), watch.stop);
  document["interrupted"] = left_undone(asked.motions.runs, records);
  document["warnings"] = motion_warnings(finished);
  return document;
}

}  // namespace snare::results
