#include "identification/tracing/next_experiment.hpp"

#include "identification/effects/catalogue.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace snare::identification {
namespace {

using test::mm;

/// What to do next after pushes to `travel` at mid-span, if a length of 1 mm more or less is in question.
std::string next_after(double travel, double sigma) {
  Series s;
  s.name = "middle";
  s.test = test::declared_wire(87.5 * mm, 6.0 * mm);
  Readings r;
  for (int i = 0; i <= 10; ++i) r.displacement.push_back(0.1 * i * travel);
  r.force.assign(r.displacement.size(), 0.0);
  s.test.travel = r.displacement;
  s.readings = r;
  SolverSettings solver;
  solver.elements = 64;
  const Model model({s}, solver);
  const Parameter* length = parameters().find("wire.length_mm");
  const double declared = model.declared(*length);
  return next_experiment(model, {{length, length->coordinate(declared, declared)}},
                         {{length, length->coordinate(declared, declared + 0.5 * mm)}},
                         {"displacement_offset", "force_offset"}, sigma)
      .what;
}

// A solid wire with 5 mm of slack that is bent by a few millimetres is far from its strength.
TEST(NextExperiment, PrefersAPushThatTheWireBears) {
  for (const double travel : {0.3 * mm, 4.0 * mm}) {
    const std::string next = next_after(travel, 0.1);
    EXPECT_TRUE(next.starts_with("push at")) << next;
    EXPECT_EQ(next.find("may break it"), std::string::npos) << next;
  }
}

// Only where it is pushed until it is taut, and beyond, do the models differ by more than this noise.
TEST(NextExperiment, NamesHarmlessChecksBeforeAPushThatMayBreakTheWire) {
  const std::string harsh = next_after(4.0 * mm, 40.0);
  EXPECT_FALSE(harsh.starts_with("push at")) << harsh;
  EXPECT_NE(harsh.find("may break it"), std::string::npos) << harsh;
}

}  // namespace
}  // namespace snare::identification
