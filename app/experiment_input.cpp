#include "app/experiment_input.hpp"
#include "identification/effects/catalogue.hpp"

namespace snare::app {

std::vector<base::Override> overrides_of(const CommonOptions& options) {
  std::vector<base::Override> overrides;
  for (const std::string& text : options.overrides) overrides.push_back(base::parse_override(text));
  return overrides;
}

identification::Experiment open_experiment(const std::filesystem::path& file, const CommonOptions& options) {
  return identification::read_experiment(file, identification::parameters(), overrides_of(options));
}

}  // namespace snare::app
