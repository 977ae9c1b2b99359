// Causes that a score at the base fit does not see, or that act on the sensors: readings by the model itself
// with a planted cause and drawn noise, traced from what was declared.

#include "identification/effects/catalogue.hpp"
#include "identification/tracing/trace.hpp"
#include "tests/support/declared_wire.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace snare::identification {
namespace {

using test::mm;

/// Three positions of a solid wire of this size, 20 readings on the way in.
std::vector<Series> bench(double diameter, double modulus, double length, double span, double travel) {
  std::vector<Series> all;
  for (const double share : {0.25, 0.4, 0.5}) {
    Series s;
    s.name = "s" + std::to_string(all.size() + 1);
    s.test = test::declared_wire(share * span, 5.0 * mm);
    s.test.wire.construction = wire::Construction::solid;
    s.test.wire.diameter = diameter;
    s.test.wire.youngs_modulus = modulus;
    s.test.wire.length = length;
    s.test.wire.bending_stiffness_override.reset();
    s.test.wire.axial_stiffness_override.reset();
    s.test.mount.span = span;
    Readings r;
    for (int i = 1; i <= 20; ++i) r.displacement.push_back(travel * i / 20);
    r.force.assign(r.displacement.size(), 0.0);
    for (std::size_t i = 0; i < r.force.size(); ++i) r.time.push_back(static_cast<double>(i));
    s.readings = std::move(r);
    all.push_back(std::move(s));
  }
  return all;
}

SolverSettings few_edges() {
  SolverSettings s;
  s.elements = 64;
  return s;
}

/// An experiment of which these settings are the truth.
Experiment with(std::vector<Series> series, const std::vector<Setting>& truth, double sigma,
                unsigned seed = 1) {
  for (Series& s : series) {
    s.largest_displacement = series.front().readings->displacement.back();
    s.largest_force = 1.0;
    s.force_sigma = sigma;
  }
  // The range of the load cell is that of what it reads.
  for (int k = 0; k < 2; ++k) {
    const Evaluation at = Model(series, few_edges()).evaluate(truth);
    EXPECT_TRUE(at.complete) << at.message;
    double largest = 0.0;
    for (std::size_t j = 0; j < series.size(); ++j) {
      series[j].readings->force.assign(at.force[j].begin(), at.force[j].end());
      largest = std::max(largest, at.force[j].cwiseAbs().maxCoeff());
    }
    for (Series& s : series) s.largest_force = largest;
  }
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  for (Series& s : series) {
    for (double& f : s.readings->force) f += normal(random);
  }
  Experiment experiment;
  experiment.series = std::move(series);
  experiment.solver = few_edges();
  return experiment;
}

Setting planted(const char* key, double coordinate) {
  return {&parameters().at(key), coordinate};
}

std::string told(const Trace& t) {
  std::string text = to_string(t.kind);
  for (const std::string& name : t.selected) text += " " + name;
  for (const Finding& f : t.findings) text += " [" + to_string(f.kind) + "]";
  return text;
}

/// The first selected effect, or one that these data cannot tell from it.
testing::AssertionResult names(const Trace& t, const std::string& effect) {
  const bool found =
      t.selected.size() == 1 && testing::Value(t.selected_classes.front(), testing::Contains(effect));
  return (found ? testing::AssertionSuccess() : testing::AssertionFailure()) << told(t);
}

// A score at the base fit points away from clamps that turn: stiffnesses of the base have gone far astray.
// What was declared of the stiffnesses, from which the fit begins, must not matter.
TEST(SlowCauses, ClampsThatTurnAreFoundFromAnyStart) {
  const auto nitinol = bench(0.8 * mm, 60e9, 220.0 * mm, 214.0 * mm, 12.0 * mm);
  Experiment e = with(nitinol, {planted("mount_rotational_compliance.compliance_rad_Nm", 3.33)}, 0.03);
  const double bending = nitinol.front().test.wire.bending_stiffness();
  const double axial = nitinol.front().test.wire.axial_stiffness();
  for (const double factor : {1.0, 0.4}) {
    for (Series& s : e.series) {
      s.test.wire.bending_stiffness_override = factor * bending;
      s.test.wire.axial_stiffness_override = axial / factor;
    }
    const Trace t = trace(e);
    EXPECT_TRUE(names(t, "mount_rotational_compliance")) << factor;
  }
}

// Both stiffnesses and nothing else, though two effects could bring as much: one diameter is one cause.
TEST(SlowCauses, ADiameterIsOneCause) {
  Experiment e = with(bench(1.5 * mm, 193e9, 177.5 * mm, 175.0 * mm, 4.0 * mm),
                      {planted("wire.diameter_mm", 0.1 * mm)}, 0.06);
  e.free = {"wire.length_mm"};
  const Trace t = trace(e);
  EXPECT_TRUE(names(t, "wire_diameter"));
  for (const FittedNumber& n : t.final.numbers) {
    if (n.key == "wire.diameter_mm") {
      EXPECT_NEAR(n.value, 1.6, 0.005);
    }
  }
}

TEST(SlowCauses, ALoadCellThatIsNotLinear) {
  const auto steel = bench(1.5 * mm, 193e9, 180.0 * mm, 175.0 * mm, 6.0 * mm);
  EXPECT_TRUE(names(trace(with(steel, {planted("load_cell_nonlinearity.at_half_range", 0.01)}, 0.05)),
                    "load_cell_nonlinearity"));
}

// The usual tolerance hides what clamps that turn leave, not a stiffness beyond the section.
TEST(SlowCauses, AStiffnessBeyondTheSectionIsLookedInto) {
  const auto nitinol = bench(0.8 * mm, 60e9, 220.0 * mm, 214.0 * mm, 6.0 * mm);
  Experiment e = with(nitinol, {planted("mount_rotational_compliance.compliance_rad_Nm", 3.33)}, 0.02);
  for (Series& s : e.series) s.force_sigma.reset();
  const Trace t = trace(e);
  EXPECT_TRUE(names(t, "mount_rotational_compliance"));
  EXPECT_LT(t.base.rmse, 0.01 * t.peak_force);
}

// A single cause of one series beside causes of all.
TEST(SlowCauses, ASeriesOfAnotherWire) {
  const auto steel = bench(1.5 * mm, 193e9, 180.0 * mm, 175.0 * mm, 4.0 * mm);
  const Trace t = trace(with(steel,
                             {planted("series[s3].wire.bending_stiffness_Nm2", 0.3),
                              planted("series[s3].wire.axial_stiffness_N", -0.4)},
                             0.05));
  EXPECT_EQ(t.kind, VerdictKind::not_explained) << told(t);
  EXPECT_EQ(t.channel, "wire");
  const auto odd = std::ranges::find_if(
      t.findings, [](const Finding& f) { return f.kind == FindingKind::series_of_another_specimen; });
  ASSERT_NE(odd, t.findings.end()) << told(t);
  EXPECT_EQ(odd->key, "series[s3]");
}

// The files of two positions are exchanged.
TEST(SlowCauses, ExchangedSeries) {
  const auto steel = bench(1.5 * mm, 193e9, 180.0 * mm, 175.0 * mm, 4.0 * mm);
  Experiment e = with(steel, {planted("wire.bending_stiffness_Nm2", -0.1)}, 0.05);
  std::swap(e.series[0].readings, e.series[2].readings);
  const Trace t = trace(e);
  EXPECT_EQ(t.kind, VerdictKind::not_explained) << told(t);
  const auto odd = std::ranges::find_if(
      t.findings, [](const Finding& f) { return f.kind == FindingKind::series_exchanged; });
  ASSERT_NE(odd, t.findings.end()) << told(t);
  EXPECT_NE(odd->what.find("series s1 and s3 look exchanged"), std::string::npos) << odd->what;
}

}  // namespace
}  // namespace snare::identification
