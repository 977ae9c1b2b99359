#pragma once

#include "identification/fitting/model.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// A measurement that would separate members of a class.
struct NextExperiment {
  std::string what;
  std::vector<std::string> separates;
  double difference = 0.0;  ///< root mean square difference of the two models' forces there [N]
  double sigmas = 0.0;      ///< the same over the noise of a reading
};

/// The push test, of a list of variations of the present ones (position, slack, load and unload, direction,
/// speed), in which two models that explain the present data differ most, of those that load the wire little
/// if one of them separates the models; with it the measurement that settles an effect by itself, which comes
/// first where the push may break the wire.
/// names: of the two effects. sigma: of a reading [N].
[[nodiscard]] NextExperiment next_experiment(const Model& model, const std::vector<Setting>& one,
                                             const std::vector<Setting>& other,
                                             const std::vector<std::string>& names, double sigma);

}  // namespace snare::identification
