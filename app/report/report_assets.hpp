#pragma once

#include <string_view>

/// Files that every report page carries; built into the command by cmake/EmbedText.cmake, so that an
/// installed command needs nothing beside it.
namespace snare::app::report_assets {

extern const std::string_view d3_script;     ///< D3 3.5, BSD-3-Clause, from Debian's libjs-d3
extern const std::string_view d3_notice;     ///< its licence, which has to go with it
extern const std::string_view three_script;  ///< three.js 111, MIT, from Debian's libjs-three
extern const std::string_view orbit_script;  ///< its controls of the camera
extern const std::string_view three_notice;  ///< its licence
extern const std::string_view scene_script;  ///< assets/scene.js
extern const std::string_view plot_script;   ///< assets/plots.js
extern const std::string_view style_sheet;   ///< assets/report.css

}  // namespace snare::app::report_assets
