#pragma once

#include "app/report/paraview.hpp"
#include "app/report/report_page.hpp"
#include "scenario/world.hpp"

#include <string>
#include <vector>

namespace snare::app {

/// How the world is looked at; y is up.
enum class View {
  along_z,  ///< x to the right
  along_x   ///< z to the right
};

/// Wire, probe and the way to the body's centre of mass, seen along z, to scale.
[[nodiscard]] AnimationSpecification animation_of(const scenario::Probe& probe, const std::string& model,
                                                  const std::vector<coupling::MotionSample>& samples);

/// Wires, bodies (centres of mass and shapes) and arms (lines from joint to joint), to scale.
[[nodiscard]] AnimationSpecification animation_of(const coupling::Motion& motion,
                                                  const std::vector<coupling::MotionSample>& samples, View view);

/// The wires, then the shapes of the bodies.
[[nodiscard]] std::vector<ParaviewFrame> paraview_frames(const coupling::Motion& motion,
                                                         const std::vector<coupling::MotionSample>& samples);

}  // namespace snare::app
