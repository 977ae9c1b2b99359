#include "results/snare.hpp"

#include "base/inputs.hpp"
#include "results/case_runner.hpp"
#include "results/inputs.hpp"

#include <memory>
#include <utility>

namespace snare {

namespace {

nlohmann::json document(const std::filesystem::path& file, const char* verb, const Overrides& overrides,
                        const results::Watch& watch) {
  const base::InputScope scope(std::make_shared<base::Inputs>());  // each input is read once a call
  const results::CaseRunner runner(file, verb, file);
  watch.say(verb);
  nlohmann::json result;
  const results::CaseEnd end = runner.run_or_throw(overrides, watch, result);
  if (end.status != results::CaseEnd::Status::done) throw SolverStopped(file.string() + ": " + end.reason);
  return results::with_inputs(std::move(result));
}

}  // namespace

nlohmann::json push(const std::filesystem::path& file, const Overrides& overrides,
                    const results::Watch& watch) {
  return document(file, "push", overrides, watch);
}

nlohmann::json fit(const std::filesystem::path& file, const Overrides& overrides,
                   const results::Watch& watch) {
  return document(file, "fit", overrides, watch);
}

nlohmann::json trace(const std::filesystem::path& file, const Overrides& overrides,
                     const results::Watch& watch) {
  return document(file, "trace", overrides, watch);
}

nlohmann::json distil(const std::filesystem::path& file, const Overrides& overrides,
                      const results::Watch& watch) {
  return document(file, "distil", overrides, watch);
}

nlohmann::json simulate(const std::filesystem::path& file, const Overrides& overrides,
                        const results::Watch& watch) {
  return document(file, "simulate", overrides, watch);
}

}  // namespace snare
