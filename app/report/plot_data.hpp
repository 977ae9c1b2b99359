#pragma once

#include "app/report/plot.hpp"

#include <nlohmann/json_fwd.hpp>

namespace snare::app {

/// What assets/plots.js reads to draw a plot.
/// Throws std::invalid_argument, naming plot, curve and index, when a value is not finite or lengths differ.
[[nodiscard]] nlohmann::json plot_data(const PlotSpecification& plot);

/// What assets/scene.js reads; there is at least one frame.
/// Throws std::invalid_argument when a coordinate is not finite or a frame does not have what the items say.
[[nodiscard]] nlohmann::json scene_data(const SceneSpecification& scene);

}  // namespace snare::app
