#pragma once

#include "base/errors.hpp"
#include "base/toml_tree.hpp"
#include "results/version.hpp"
#include "results/watch.hpp"
#include "scenario/distilled_law.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

/// The usual calls in one header: the verbs of the command on the command's own files.
///
///   #include <snare/snare.hpp>
///   nlohmann::json pushed = snare::push("my_push.toml", {{"pusher.friction", "0.2"}});
///
/// Each gives the document that the command writes as JSON, with the units in the names, and writes nothing.
/// Overrides are keys of the file with values in TOML, as `--set` takes them. watch: who is told what is
/// under way, and may stop it. Throws base::InputError for a wrong file, with every problem found, and
/// SolverStopped where a computation did not come to its end. Calls share nothing: any number may run at a
/// time.
namespace snare {

using Overrides = std::vector<base::Override>;

/// A computation that did not come to its end: what() says where and why.
class SolverStopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Force-displacement curves of an experiment file, in summary.            docs/experiment_file.md
[[nodiscard]] nlohmann::json push(const std::filesystem::path& file, const Overrides& overrides = {},
                                  const results::Watch& watch = {});
/// fit.json of an experiment file.                                          docs/trace_json.md
[[nodiscard]] nlohmann::json fit(const std::filesystem::path& file, const Overrides& overrides = {},
                                 const results::Watch& watch = {});
/// trace.json of an experiment file.                                        docs/trace_json.md
[[nodiscard]] nlohmann::json trace(const std::filesystem::path& file, const Overrides& overrides = {},
                                   const results::Watch& watch = {});
/// law.json of a wire file; scenario::read_distilled_law evaluates one.     docs/law_json.md
[[nodiscard]] nlohmann::json distil(const std::filesystem::path& file, const Overrides& overrides = {},
                                    const results::Watch& watch = {});
/// summary.json of a scenario file.                                         docs/summary_json.md
[[nodiscard]] nlohmann::json simulate(const std::filesystem::path& file, const Overrides& overrides = {},
                                      const results::Watch& watch = {});

}  // namespace snare
