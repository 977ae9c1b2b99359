#include "validation/scenario_run.hpp"

#include "base/toml_tree.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace snare::validation {

using coupling::MotionEvent;
using coupling::MotionSample;

scenario::NamedMotion motion_of(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  std::vector<base::Override> overrides;
  for (const std::string& s : settings) overrides.push_back(base::parse_override(s));
  return scenario::read_scenario(file, overrides).motions.runs.front();
}

ScenarioRun run_motion(scenario::NamedMotion asked, const std::function<void(const MotionSample&)>& each) {
  ScenarioRun run;
  run.asked = std::move(asked);
  run.result = coupling::simulate(run.asked.motion, run.asked.options, [&](const MotionSample& s) {
    run.last = s;
    if (each) each(s);
    return false;
  });
  return run;
}

ScenarioRun run_of(const std::filesystem::path& file, const std::vector<std::string>& settings,
                   const std::function<void(const MotionSample&)>& each) {
  return run_motion(motion_of(file, settings), each);
}

double first_touch(const coupling::MotionResult& result, int contact) {
  const auto found = std::find_if(
      result.events.begin(), result.events.end(),
      [contact](const MotionEvent& e) { return e.kind == MotionEvent::Kind::touch && e.contact == contact; });
  return found == result.events.end() ? not_computed : found->time;
}

}  // namespace snare::validation
