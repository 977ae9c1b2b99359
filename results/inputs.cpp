#include "results/inputs.hpp"

#include "base/inputs.hpp"

#include <nlohmann/json.hpp>

namespace snare::results {

nlohmann::json with_inputs(nlohmann::json document) {
  document["inputs"] = nlohmann::json::array();
  if (const std::shared_ptr<base::Inputs> inputs = base::current_inputs()) {
    for (const base::Inputs::File& file : inputs->files())
      document["inputs"].push_back({{"file", file.path.string()}, {"sha256", file.sha256}});
  }
  return document;
}

}  // namespace snare::results
