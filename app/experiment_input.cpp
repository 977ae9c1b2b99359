#include "app/experiment_input.hpp"
#include "base/parallel.hpp"
#include "identification/effects/catalogue.hpp"

namespace snare::app {

std::vector<base::Override> overrides_of(const CommonOptions& options) {
  std::vector<base::Override> overrides;
  for (const std::string& text : options.overrides) overrides.push_back(base::parse_override(text));
  return overrides;
}

identification::Experiment open_experiment(const std::filesystem::path& file, const CommonOptions& options) {
  identification::Experiment experiment =
      identification::read_experiment(file, identification::parameters(), overrides_of(options));
  if (options.threads > 0) base::set_thread_count(options.threads);
  return experiment;
}

}  // namespace snare::app
