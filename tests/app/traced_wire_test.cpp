#include "app/traced_wire.hpp"

#include "base/files.hpp"
#include "identification/effects/catalogue.hpp"
#include "reduction/wire_file.hpp"
#include "tests/app/report/reproduce_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <string>

namespace snare::app {
namespace {

using identification::VerdictKind;

/// A reproduction whose tracing ends with these two numbers.
Reproduction traced_reproduction(VerdictKind kind) {
  Reproduction result = reproduction();
  identification::Series& first = result.experiment.series.front();
  first.test.wire.youngs_modulus = 193e9;
  first.test.wire.poisson_ratio = 0.29;
  first.test.wire.density = 7930.0;
  result.experiment.file = "/somewhere/test.toml";
  identification::Trace trace;
  trace.report.termination = numerics::Termination::converged;
  trace.kind = kind;
  trace.explained = kind == VerdictKind::nothing_missing || kind == VerdictKind::explained;
  trace.final.numbers = {{"wire.axial_stiffness_N", "N", 341060.0, 17721.0, 700.0, {}, {}, false},
                         {"wire.length_mm", "mm", 180.0, 175.5, {}, {}, {}, false}};
  const identification::Parameter* axial = identification::parameters().find("wire.axial_stiffness_N");
  const identification::Parameter* offset =
      identification::parameters().find("reading.displacement_offset_mm");
  trace.final_settings = {{axial, axial->coordinate(341060.0, 17721.0)},
                          {offset, offset->coordinate(0.0, 0.5e-3)}};
  result.trace = trace;
  return result;
}

TEST(TracedWire, IsAWireFileOfTheFinalModel) {
  const std::string text =
      traced_wire_toml(traced_reproduction(VerdictKind::nothing_missing), "snare reproduce test.toml");
  const reduction::WireFile file = reduction::parse_wire_file("traced.toml", text);
  ASSERT_EQ(file.cases.size(), 1u);
  const reduction::WireCase& wire = file.cases.front();
  constexpr double roundings = 1e-12;  // of a logarithm and its exponential
  EXPECT_NEAR(wire.test.wire.axial_stiffness(), 17721.0, roundings * 17721.0);
  EXPECT_EQ(wire.test.wire.bending_stiffness(), 0.048) << "as declared";
  EXPECT_EQ(wire.test.mount.span, 0.175);
  EXPECT_EQ(wire.travel.high, 2e-3) << "as far as the test";
  EXPECT_EQ(wire.law_positions, std::vector{0.040});
  ASSERT_EQ(wire.law_offsets.size(), 1u);
  EXPECT_NEAR(wire.law_offsets.front(), 0.5e-3, roundings);
  EXPECT_EQ(file.title, "traced wire of \"Static push\": nothing missing");
  EXPECT_EQ(file.source, "snare reproduce test.toml, on: somebody, somewhere");
}

TEST(TracedWire, CommentsStateWhatWasTraced) {
  const std::string text =
      traced_wire_toml(traced_reproduction(VerdictKind::explained), "snare reproduce test.toml");
  for (const char* line :
       {"written by `snare reproduce test.toml`", "# Declared in test.toml.\n", "# Verdict: explained. ",
        "#   wire.axial_stiffness_N = 17721 +- 7e+02 N (declared: 341060)\n",
        "#   wire.length_mm = 175.5 (not determined) mm (declared: 180)\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << " in\n" << text;
  }
  EXPECT_EQ(text.find("do not rely"), std::string::npos);
}

// Of published fits the leading explanation is written, not the fit whose range is assumed.
TEST(TracedWire, IsThatOfTheLeadingExplanation) {
  Reproduction result = traced_reproduction(VerdictKind::nothing_missing);
  result.map = std::make_shared<nlohmann::json>(
      nlohmann::json::parse(base::read_text(SNARE_SOURCE_DIR "/data/published/published_static_map.json")));
  const identification::Parameter* mounts =
      identification::parameters().find("mount_axial_compliance.compliance_m_N");
  RefittedLeader leader{"mounts_give_and_turn", "the mounts give way and turn",           6, 0.5, {},
                        result.experiment,      {{mounts, mounts->coordinate(0.0, 2e-5)}}};
  leader.experiment.series.front().test.travel = {0.0, 3e-3, 7e-3};
  result.leader = leader;
  const std::string text = traced_wire_toml(result, "snare reproduce test.toml");
  const reduction::WireFile file = reduction::parse_wire_file("traced.toml", text);
  const coupling::PushProblem& test = file.cases.front().test;
  EXPECT_NEAR(test.mount.translational_stiffness.value_or(0.0), 5e4, 1e-6);
  EXPECT_EQ(test.wire.bending_stiffness(), 0.048) << "as declared";
  EXPECT_EQ(file.cases.front().travel.high, 7e-3) << "as far as its range";
  EXPECT_EQ(file.title, "traced wire of \"Static push\": explained");
  for (const char* line :
       {"by the leading explanation of", "# The published fits agree with the declared wire",
        "# Here the mounts give way and turn, one of these explanations, fitted to 6 readings a series",
        "#   mount_axial_compliance.compliance_m_N = 2e-05 m/N (declared: 0)\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << " in\n" << text;
  }
}

TEST(TracedWire, SaysWhereNoModelIsAccepted) {
  for (const VerdictKind kind : {VerdictKind::not_explained, VerdictKind::cannot_tell}) {
    const std::string text = traced_wire_toml(traced_reproduction(kind), "snare reproduce");
    EXPECT_NE(text.find("# No model was accepted: do not rely on these numbers."), std::string::npos) << text;
    EXPECT_NE(reduction::parse_wire_file("x.toml", text).title.find(", do not rely on it"), std::string::npos)
        << text;
  }
}

TEST(TracedWire, TitlesWithQuotesAndLineBreaksStayReadable) {
  Reproduction result = traced_reproduction(VerdictKind::explained);
  result.experiment.title = "a \"quoted\\\" title\n[wire]\nlength_mm = 1.0";
  const reduction::WireFile file =
      reduction::parse_wire_file("x.toml", traced_wire_toml(result, "snare reproduce"));
  EXPECT_EQ(file.cases.front().test.wire.length, 0.180);
}

}  // namespace
}  // namespace snare::app
