#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/simulate_kinds.hpp"
#include "scenario/contact_scenario.hpp"
#include "scenario/bodies_scenario.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

namespace snare::app {

namespace {

struct Kind {
  const char* name;
  ExitStatus (*run)(const std::filesystem::path& file, const CommonOptions& options, Console& console);
};

constexpr Kind kinds[] = {{"contact", simulate_contact},
                          {"arm_contact", simulate_arm_contact},
                          {"joint_step", simulate_arm},
                          {"tip_impulse", simulate_arm},
                          {"joint_motion", simulate_arm}};

}  // namespace

ExitStatus run_simulate(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  // Keys of another file that the scenario names are that file's matter.
  std::vector<base::Override> own;
  for (const base::Override& one : overrides_of(options)) {
    if (!one.key.starts_with("contact.")) own.push_back(one);
  }
  const std::string asked = scenario::scenario_kind(file, own);
  if (options.threads > 0) base::set_thread_count(options.threads);
  std::string known;
  if (asked == "contact" && scenario::lists_bodies(file, overrides_of(options))) return simulate_bodies(file, options, console);
  for (const Kind& kind : kinds) {
    if (asked == kind.name) return kind.run(file, options, console);
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", kind.name);
  }
  throw base::InputError(
      {file.string(), 0, "kind", fmt::format("\"{}\"", asked), "must be one of " + known});
}

}  // namespace snare::app
