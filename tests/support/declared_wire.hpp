#pragma once

#include "base/units.hpp"
#include "coupling/statics/push_solver.hpp"
#include "validation/declared_wire.hpp"
#include "validation/elastica_push.hpp"

#include <vector>

namespace snare::test {

using base::mm;

using validation::declared_wire;

/// The same with the stiffness of a strand: it wraps a pin of some millimetres.
inline coupling::PushProblem soft_wire(double position, double radius) {
  coupling::PushProblem test = declared_wire(position, radius);
  test.wire.bending_stiffness_override = 5e-4;
  test.wire.axial_stiffness_override = 114e3;
  return test;
}

/// 0 to `to` in equal steps, and back where asked.
inline std::vector<double> travel_to(double to, int steps) {
  std::vector<double> travel;
  for (int i = 0; i <= steps; ++i) travel.push_back(to * i / steps);
  return travel;
}
inline std::vector<double> there_and_back(double to, int steps) {
  std::vector<double> travel = travel_to(to, steps);
  for (int i = steps - 1; i >= 0; --i) travel.push_back(to * i / steps);
  return travel;
}

inline coupling::PushOptions mesh(int elements, double grading = -1.0) {
  coupling::PushOptions options;
  options.elements = elements;
  options.grading = grading;
  return options;
}

/// The continuous wire of the same test, which shares no code with the rod.
inline validation::ElasticaPush elastica_of(const coupling::PushProblem& test) {
  validation::ElasticaPush e;
  e.wire = {test.wire.length, test.wire.bending_stiffness(), test.wire.axial_stiffness(), 0.0};
  e.span = test.mount.span;
  e.position = test.contact_position;
  e.radius = test.pusher.radius > 0.0 ? test.pusher.radius + 0.5 * test.wire.diameter : 0.0;
  if (test.mount.kind == wire::MountKind::pinned) e.ends = validation::ElasticaEnds::pinned;
  return e;
}

}  // namespace snare::test
