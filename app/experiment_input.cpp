#include "app/experiment_input.hpp"

#include <omp.h>

namespace snare::app {

std::vector<numerics::Override> overrides_of(const CommonOptions& options) {
  std::vector<numerics::Override> overrides;
  for (const std::string& text : options.overrides) overrides.push_back(numerics::parse_override(text));
  return overrides;
}

identification::Experiment open_experiment(const std::filesystem::path& file, const CommonOptions& options) {
  identification::Experiment experiment = identification::read_experiment(file, overrides_of(options));
  if (options.threads > 0) omp_set_num_threads(options.threads);
  return experiment;
}

}  // namespace snare::app
