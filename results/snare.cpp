#include "results/snare.hpp"

#include "results/case_runner.hpp"

namespace snare {

namespace {

nlohmann::json document(const std::filesystem::path& file, const char* verb, const Overrides& overrides,
                        const results::Watch& watch) {
  const results::CaseRunner runner(file, verb, file);
  runner.check(overrides);
  watch.say(verb);
  nlohmann::json result;
  const results::CaseEnd end = runner.run(
      overrides, [&watch] { return watch.stopped(); }, result);
  if (end.status != results::CaseEnd::Status::done) throw SolverStopped(file.string() + ": " + end.reason);
  return result;
}

}  // namespace

nlohmann::json push(const std::filesystem::path& file, const Overrides& overrides, const results::Watch& watch) {
  return document(file, "push", overrides, watch);
}

nlohmann::json fit(const std::filesystem::path& file, const Overrides& overrides, const results::Watch& watch) {
  return document(file, "fit", overrides, watch);
}

nlohmann::json trace(const std::filesystem::path& file, const Overrides& overrides, const results::Watch& watch) {
  return document(file, "trace", overrides, watch);
}

nlohmann::json distil(const std::filesystem::path& file, const Overrides& overrides, const results::Watch& watch) {
  return document(file, "distil", overrides, watch);
}

nlohmann::json simulate(const std::filesystem::path& file, const Overrides& overrides, const results::Watch& watch) {
  return document(file, "simulate", overrides, watch);
}

}  // namespace snare
