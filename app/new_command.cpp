#include "app/new_command.hpp"

#include "app/commands.hpp"
#include "app/result_folder.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "base/one_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace snare::app {

namespace {

namespace fs = std::filesystem;

/// Shipped files that make a starter set, under the names that they get. The first is the one to run.
struct StartingSet {
  const char* name;
  std::vector<std::pair<const char*, const char*>> files;  ///< in the folder of the data, in the new one
  const char* verb;
};

const std::array<StartingSet, 3>& starting_sets() {
  static const std::array<StartingSet, 3> sets{
      {{"capture",
        {{"scenarios/ssrms_htv_capture.toml", "capture.toml"},
         {"arms/ssrms_on_station.toml", "arms/ssrms_on_station.toml"},
         {"arms/ssrms_like.urdf", "arms/ssrms_like.urdf"},
         {"arms/station_like.urdf", "arms/station_like.urdf"}},
        "simulate"},
       {"experiment",
        {{"starter/experiment.toml", "experiment.toml"},
         {"starter/middle.csv", "middle.csv"},
         {"starter/quarter.csv", "quarter.csv"}},
        "trace"},
       {"wire", {{"wires/traced_published.toml", "wire.toml"}}, "distil"}}};
  return sets;
}

/// Files beside each other in the data are below the first one in the set.
std::string with_own_paths(std::string text) {
  constexpr std::string_view before = "\"../arms/", after = "\"arms/";
  for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before, at + after.size()))
    text.replace(at, before.size(), after);
  return text;
}

}  // namespace

ExitStatus run_new(const std::string& what, const CommonOptions& options, Console& console) {
  const auto& sets = starting_sets();
  const auto set =
      std::find_if(sets.begin(), sets.end(), [&](const StartingSet& s) { return what == s.name; });
  if (set == sets.end())
    throw base::InputError({"", 0, "new", what, "must be \"capture\", \"experiment\" or \"wire\""});
  std::vector<std::string> names;
  for (const auto& [from, to] : set->files) names.emplace_back(to);
  const ResultFolder folder(options, names);
  // All or nothing: what is there stays as it is.
  std::vector<base::InputProblem> problems;
  std::vector<std::pair<fs::path, std::string>> files;
  for (const auto& [from, to] : set->files) {
    files.emplace_back(options.out / to, with_own_paths(base::read_text(data_directory() / from)));
    if (fs::exists(files.back().first))
      problems.push_back({files.back().first.string(), 0, "--out", options.out.string(),
                          "must be a folder without that file: nothing was written"});
  }
  if (!problems.empty()) throw base::InputError(problems);
  std::vector<fs::path> written;
  try {
    for (const auto& [path, text] : files) {
      base::write_text(path, text);
      written.push_back(path);
    }
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& path : written) fs::remove(path, ignored);
    throw;
  }
  for (const auto& [path, text] : files) console.say(path.string());
  console.say(fmt::format("next: snare {} {} --out {}", set->verb,
                          base::shell_word(files.front().first.string()),
                          base::shell_word((options.out / "out").string())));
  return ExitStatus::done;
}

}  // namespace snare::app
