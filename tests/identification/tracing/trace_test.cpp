#include "identification/tracing/trace.hpp"

#include "tests/support/declared_wire.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace snare::identification {
namespace {

using test::mm;

/// Two series of `n` readings whose forces `f` says.
Experiment experiment_of(int n, const std::function<double(int)>& f) {
  Experiment e;
  e.file = "x.toml";
  e.solver.elements = 64;
  for (const double position : {65.0 * mm, 90.0 * mm}) {
    Series s;
    s.name = position < 80.0 * mm ? "a" : "b";
    s.test = test::declared_wire(position, 6.0 * mm);
    Readings r;
    for (int i = 0; i < n; ++i) {
      r.displacement.push_back(0.1 * mm * i);
      r.force.push_back(f(i));
    }
    s.test.travel = r.displacement;
    s.readings = r;
    e.series.push_back(s);
  }
  return e;
}

void expect_refused(const Experiment& e, const std::string& part) {
  const std::string said = test::refusal([&] { return trace(e); });
  EXPECT_NE(said.find(part), std::string::npos) << said;
  EXPECT_NE(said.find("x.toml"), std::string::npos) << said;
}

TEST(TraceInput, ConstantForceIsRefused) {
  expect_refused(experiment_of(20, [](int) { return 2.0; }), "force_N is 2 in every reading");
}

TEST(TraceInput, ARecordThatNeverTouchesIsRefused) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  expect_refused(experiment_of(40, [&](int) { return 0.01 * normal(random); }), "never touched");
}

TEST(TraceInput, TooFewReadingsAreRefused) {
  Experiment e = experiment_of(3, [](int i) { return 1.0 * i; });
  e.free = {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N", "wire.length_mm",
            "reading.force_offset_N"};
  expect_refused(e, "must leave at least 3 degrees of freedom: at most 3 keys with 6 readings");
}

TEST(TraceInput, SeriesWithoutReadingsAreRefused) {
  Experiment e = experiment_of(10, [](int i) { return 1.0 * i; });
  e.series[1].readings.reset();
  expect_refused(e, "series[b], must have readings or a law");
}

TEST(TraceInput, AnUnknownNumberIsNamedBesideThoseThatThereAre) {
  Experiment e = experiment_of(10, [](int i) { return 1.0 * i; });
  e.free = {"wire.colour"};
  const std::string text = test::refusal([&] { return trace(e); });
  const std::string begin =
      "fit.free = \"wire.colour\", must be one of wire.bending_stiffness_Nm2, wire.axial_stiffness_N, "
      "wire.length_mm, wire.diameter_mm, wire.youngs_modulus_GPa, wire.density_kg_m3, "
      "wire.natural_curvature_1_m, mount.span_mm, ";
  EXPECT_NE(text.find(begin), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("pusher_play.width_mm, rate_viscosity.relaxation_time_s")) << text;
}

TEST(TraceInput, AThresholdThatIsNotDeclaredCannotBeFitted) {
  Experiment e = experiment_of(10, [](int i) { return 1.0 * i; });
  e.free = {"mount_slip.tension_N"};
  expect_refused(e, "declare a value to start from");
}

}  // namespace
}  // namespace snare::identification
