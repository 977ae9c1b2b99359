#pragma once

#include "app/report/reproduce_result.hpp"

#include <string>
#include <vector>

namespace snare::app {

inline coupling::PushShape wire_shape(double travel) {
  coupling::PushShape shape;
  shape.travel = travel;
  shape.x = {0.0, 0.040, 0.175};
  shape.y = {0.0, 0.009, 0.0};
  shape.arc = {0.0, 0.041, 0.180};
  shape.tension = {5.0, 5.5, 6.0};
  shape.moment = {0.1, -0.2, 0.1};
  shape.pusher_centre = {0.040, 0.003};
  return shape;
}

inline identification::Prediction computed_curve(const std::vector<double>& force) {
  identification::Prediction p;
  p.force = force;
  p.curve.curve.shapes = {wire_shape(0.0), wire_shape(2e-3)};
  return p;
}

/// One position. Published is F = 1 N/mm d up to 2 mm, with a scatter of 0.1 N: R^2 = 1/1.03, variance of the
/// law 1/3 N^2. Off by 0, 50 and 100 N: the declared model, rms 64.5 N. Off by 0.2 N throughout: the fitted
/// one.
inline Reproduction reproduction() {
  Reproduction result;
  result.experiment.title = "Static push";
  result.experiment.source = "somebody, somewhere";
  identification::Series s;
  s.name = "s40";
  s.law = identification::QuadraticLaw{0.0, 1000.0, 0.0, 1.0 / 1.03, 2e-3};
  s.test.contact_position = 0.040;
  s.test.pusher.radius = 6e-3;
  s.test.travel = {0.0, 1e-3, 2e-3};
  s.test.wire.diameter = 1.5e-3;
  s.test.wire.length = 0.180;
  s.test.wire.bending_stiffness_override = 0.048;
  s.test.wire.axial_stiffness_override = 341060.0;
  s.test.mount.span = 0.175;
  result.experiment.series = {s};
  result.assumptions = {"the range is assumed"};
  result.models = {{"declared",
                    "declared model",
                    "A solid wire",
                    {{"wire.length_mm", {180.0, {}, "mm"}}},
                    0,
                    {computed_curve({0.0, 51.0, 102.0})}},
                   {"best_fit",
                    "best fit",
                    "",
                    {{"wire.length_mm", {175.12345, 0.0123, "mm"}}},
                    1,
                    {computed_curve({0.2, 1.2, 2.2})}}};
  return result;
}

}  // namespace snare::app
