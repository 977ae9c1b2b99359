// Numbers that the readings of a push do not determine, readings of another sign or unit, and every key as a
// free number.
#include "base/errors.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/tracing/trace.hpp"
#include "tests/support/declared_wire.hpp"
#include "tests/support/wire_text.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

namespace snare::identification {
namespace {

using test::mm;
using testing::HasSubstr;

constexpr double sigma = 0.2;  // of a reading [N]

/// Two places of the published wire, 12 readings each from a strand's stiffnesses, with noise.
Experiment loose_wire(double bending = 0.0094, double axial = 19300.0, double noise = sigma) {
  Experiment e;
  e.file = "x.toml";
  e.solver.elements = 32;
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, noise);
  for (const double place : {45.0 * mm, 87.5 * mm}) {
    Series s;
    s.name = "s" + std::to_string(e.series.size());
    s.test = test::declared_wire(place, 6.0 * mm);
    s.test.wire.length = 175.5 * mm;
    s.test.wire.bending_stiffness_override = bending;
    s.test.wire.axial_stiffness_override = axial;
    for (int i = 1; i <= 12; ++i) s.test.travel.push_back(0.3 * mm * i);
    s.readings = Readings{s.test.travel, predict(s, e.solver).force, {}};
    for (double& f : s.readings->force) f += normal(random);
    s.force_sigma = sigma;
    e.series.push_back(std::move(s));
  }
  return e;
}

TraceOptions only_fit() {
  TraceOptions options;
  options.most_effects = 0;
  options.attribute = false;
  return options;
}

const FittedNumber& number(const Trace& t, const std::string& key) {
  return *std::ranges::find_if(t.final.numbers, [&](const FittedNumber& n) { return n.key == key; });
}

bool has(const Trace& t, FindingKind kind) {
  return std::ranges::any_of(t.findings, [kind](const Finding& f) { return f.kind == kind; });
}

// A push is homogeneous of first degree in its stiffnesses and the gain: whatever the start, only products
// are known.
TEST(OpenNumbers, AGainBesideBothStiffnessesIsOpen) {
  std::vector<double> products;
  for (const double factor : {1.0, 2.0, 0.5}) {
    Experiment e = loose_wire();
    for (Series& s : e.series) {
      s.test.wire.bending_stiffness_override = 0.0094 * factor;
      s.test.wire.axial_stiffness_override = 19300.0 * factor;
    }
    e.free = {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N", "wire.length_mm", "reading.force_gain"};
    const Trace t = trace(e, only_fit());
    ASSERT_TRUE(t.report.usable());
    for (const char* key : {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N", "reading.force_gain"}) {
      const FittedNumber& n = number(t, key);
      EXPECT_FALSE(n.identified || n.standard_error || n.lower || n.upper) << key;
    }
    const FittedNumber& length = number(t, "wire.length_mm");
    ASSERT_TRUE(length.identified && length.lower && length.upper);
    EXPECT_TRUE(*length.lower < 175.5 && 175.5 < *length.upper);
    EXPECT_EQ(t.kind, VerdictKind::cannot_tell);
    EXPECT_FALSE(t.explained || t.decided);
    ASSERT_EQ(t.final.open.size(), 1u);
    EXPECT_THAT(null_words(t.final.open.front().changes), HasSubstr("scale together"));
    ASSERT_EQ(t.final.open.front().known.size(), 2u);  // what is known while the third is held
    for (const FittedNumber& n : t.final.open.front().known)
      EXPECT_TRUE(n.lower && n.upper && n.standard_error);
    products.push_back(number(t, "wire.axial_stiffness_N").value * number(t, "reading.force_gain").value);
  }
  // All starts end at one product, to the tolerance of the iteration, 1e-6 of chi2, about a hundredth of a
  // standard error.
  for (const double p : products) EXPECT_NEAR(p, products.front(), 1e-3 * products.front());
}

TEST(OpenNumbers, OneOffsetForAllAndOneASeriesAreOpen) {
  Experiment e = loose_wire();
  const std::string offset = "reading.displacement_offset_mm";
  e.free = {offset, "series[s0]." + offset, "series[s1]." + offset, "wire.axial_stiffness_N"};
  const Trace t = trace(e, only_fit());
  for (std::size_t k = 0; k < 3; ++k) EXPECT_FALSE(t.final.numbers[k].identified || t.final.numbers[k].lower);
  EXPECT_TRUE(number(t, "wire.axial_stiffness_N").lower);
  ASSERT_EQ(t.final.open.size(), 1u);
  EXPECT_THAT(null_words(t.final.open.front().changes), HasSubstr("shift together"));
}

TEST(OpenNumbers, IndependentNumbersStayKnown) {
  Experiment e = loose_wire();
  e.free = {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N", "reading.displacement_offset_mm",
            "reading.force_offset_N"};
  const Trace t = trace(e, only_fit());
  for (const FittedNumber& n : t.final.numbers) EXPECT_TRUE(n.identified && n.lower && n.upper) << n.key;
  EXPECT_TRUE(t.final.open.empty());
  EXPECT_TRUE(t.findings.empty());
}

// A wire that is stiffer than declared asks for less than no compliance: the other numbers reach their
// minimum with that one on its bound.
TEST(OpenNumbers, ANumberOnItsBoundLeavesTheOthersTheirMinimum) {
  const std::string bending = "wire.bending_stiffness_Nm2", mounts = "mount_axial_compliance.compliance_m_N";
  std::vector<double> found;
  for (const double factor : {1.0, 0.9, 0.95, 1.05, 1.1}) {
    Experiment e = loose_wire();
    for (Series& s : e.series) {
      s.test.wire.bending_stiffness_override = 0.0094 * factor;
      s.test.wire.axial_stiffness_override = 19100.0;
    }
    e.free = {bending, mounts};
    const Trace t = trace(e, only_fit());
    EXPECT_EQ(number(t, mounts).value, 0.0);
    ASSERT_TRUE(number(t, bending).standard_error);
    found.push_back(number(t, bending).value / *number(t, bending).standard_error);
  }
  for (const double f : found) EXPECT_NEAR(f, found.front(), 0.02);
}

TEST(ReadingFindings, ForcesOfTheOtherSignAreNamed) {
  Experiment e = loose_wire();
  for (double& f : e.series[1].readings->force) f = -f;
  const Trace t = trace(e, only_fit());
  const auto found =
      std::ranges::find_if(t.findings, [](const Finding& f) { return f.kind == FindingKind::sign_turned; });
  ASSERT_NE(found, t.findings.end());
  EXPECT_EQ(found->key, "series[s1]");
  EXPECT_FALSE(t.decided);
}

TEST(ReadingFindings, TravelsThatGoDownAreNamedAndNothingElseIsSaid) {
  Experiment e = loose_wire();
  for (Series& s : e.series) {
    for (double& f : s.readings->force) f = -f;
    for (double& d : s.readings->displacement) d = -d;
    s.test.travel = s.readings->displacement;
  }
  const Trace t = trace(e, only_fit());
  EXPECT_EQ(
      std::ranges::count_if(t.findings, [](const Finding& f) { return f.kind == FindingKind::sign_turned; }),
      2);
  for (const FittedNumber& n : t.final.numbers) EXPECT_FALSE(n.identified || n.lower || n.upper) << n.key;
  EXPECT_NE(t.kind, VerdictKind::nothing_missing);
}

struct Slip {
  double force, travel;
  const char* words;
};

class UnitSlips : public testing::TestWithParam<Slip> {};

TEST_P(UnitSlips, AreNamed) {
  const auto [force, travel, words] = GetParam();
  Experiment e = loose_wire(0.0094, 19300.0, 0.01);
  for (Series& s : e.series) {
    s.test.wire.bending_stiffness_override = 0.0090;  // what is declared is some per cent off
    s.test.wire.axial_stiffness_override = 20000.0;
    for (double& f : s.readings->force) f /= force;
    for (double& d : s.readings->displacement) d /= travel;
    s.test.travel = s.readings->displacement;
    s.force_sigma = 0.2 / force;
  }
  const Trace t = trace(e, only_fit());
  ASSERT_TRUE(t.report.usable());
  const auto found =
      std::ranges::find_if(t.findings, [](const Finding& f) { return f.kind == FindingKind::unit_slip; });
  ASSERT_NE(found, t.findings.end());
  EXPECT_THAT(found->what, HasSubstr(words));
  EXPECT_FALSE(t.decided);
}

INSTANTIATE_TEST_SUITE_P(Known, UnitSlips,
                         testing::Values(Slip{9.80665, 1.0, "kgf"}, Slip{1.0 / 9.80665, 1.0, "9.81"},
                                         Slip{1e3, 1.0, "kN"}, Slip{1e-3, 1.0, "mN"},
                                         Slip{1.0 / 25.4, 1.0, "25.4"}, Slip{4.4482216, 1.0, "lbf"},
                                         Slip{1.0, 25.4, "inches"}, Slip{1.0, 1e3, "displacements in m "}));

// Stiffnesses that are merely other than declared are no slip of units.
TEST(ReadingFindings, OtherStiffnessesAreNoSlip) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> factor(std::log(0.5), std::log(2.0));
  for (int k = 0; k < 10; ++k) {
    Experiment e = loose_wire(0.0094, 19300.0, 0.05);
    for (Series& s : e.series) {
      s.test.wire.bending_stiffness_override = 0.0094 * std::exp(factor(random));
      s.test.wire.axial_stiffness_override = 19300.0 * std::exp(factor(random));
    }
    const Trace t = trace(e, only_fit());
    EXPECT_FALSE(has(t, FindingKind::unit_slip) || has(t, FindingKind::sign_turned));
  }
}

TEST(ReadingFindings, ANumberOnItsBoundHasNoIntervalBeyondIt) {
  Experiment e = loose_wire();
  for (Series& s : e.series)
    s.test.wire.axial_stiffness_override = 19300.0 / 8.0;  // at most five times as much
  e.free = {"wire.axial_stiffness_N"};
  const Trace t = trace(e, only_fit());
  const FittedNumber& n = number(t, "wire.axial_stiffness_N");
  EXPECT_EQ(n.bound, AtBound::upper);
  EXPECT_FALSE(n.upper);
  EXPECT_TRUE(n.lower && *n.lower < n.value);
  EXPECT_TRUE(has(t, FindingKind::on_bound));
}

/// Dotted names of the numbers of an object of a schema.
void collect(const nlohmann::json& schema, const nlohmann::json& object, const std::string& prefix,
             std::vector<std::string>& keys) {
  if (object.contains("$ref")) {
    const std::string ref = object["$ref"];
    return collect(schema, schema["$defs"][ref.substr(ref.rfind('/') + 1)], prefix, keys);
  }
  const nlohmann::json type = object.value("type", nlohmann::json());
  if (type == "number" || type == "integer") keys.push_back(prefix);
  if (object.contains("items"))
    collect(schema, object["items"], prefix == "series" ? "series[s0]" : prefix, keys);
  if (!object.contains("properties")) return;
  for (const auto& [name, inner] : object["properties"].items())
    collect(schema, inner, prefix.empty() ? name : prefix + "." + name, keys);
}

// Every number of the format and every number that can be fitted, as the one free number beside the axial
// stiffness: an answer, or a refusal with its reason. Four kinds of test, so that each number is declared in
// one of them.
TEST(FreeNumbers, EveryKeyHasAnAnswerOrAReason) {
  std::ifstream file(SNARE_SOURCE_DIR "/data/schemas/experiment.schema.json");
  const nlohmann::json schema = nlohmann::json::parse(file);
  std::vector<std::string> keys = parameters().keys();
  collect(schema, schema, "", keys);
  for (const std::string& key : parameters().keys()) keys.push_back("series[s0]." + key);
  ASSERT_GT(keys.size(), 90u);
  const std::string plain = test::wire_tables("176.0");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = plain;
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string bases[] = {
      plain,
      with("kind = \"clamped\"",
           "kind = \"clamped\"\nslip_tension_N = 60.0\nrotational_stiffness_Nm_rad = 5.0"),
      with("friction = 0.0", "friction = 0.1") + "[gravity]\nvector_m_s2 = [0.0, -9.81, 0.0]\n",
      with("kind = \"clamped\"", "kind = \"supports\"\nsupport_radius_mm = 3.0")};
  int answers = 0, refusals = 0;
  for (const std::string& base : bases) {
    for (const std::string& key : keys) {
      std::string text =
          "schema = \"snare-experiment/1\"\n" + base + "[solver]\nelements = 16\nextrapolate = false\n";
      for (const char* s : {"s0", "s1"})
        text +=
            fmt::format("[[series]]\nname = \"{}\"\ncontact_position_mm = {}\ntravel_mm = 1.2\npoints = 7\n",
                        s, s[1] == '0' ? 65.0 : 87.5);
      text += fmt::format("[fit]\nfree = [\"{}\"]\n", key);
      try {
        Experiment e = parse_experiment("x.toml", text, parameters());
        for (Series& s : e.series) {
          s.readings = Readings{s.test.travel, predict(s, e.solver).force, {}};
          s.force_sigma = 0.1;
        }
        const Trace t = trace(e, only_fit());
        ASSERT_TRUE(t.report.usable() || !t.report.message.empty()) << key;
        for (const FittedNumber& n : t.final.numbers) EXPECT_TRUE(std::isfinite(n.value)) << key;
        ++answers;
      } catch (const base::InputError& error) {
        EXPECT_GT(error.problems().front().requirement.size(), 20u) << key;
        ++refusals;
      }
    }
  }
  EXPECT_GT(answers, 60);
  EXPECT_GT(refusals, 100);
}

TEST(FreeNumbers, WhatNoForceDependsOnIsRefusedWithItsReason) {
  Experiment e = loose_wire();
  const std::pair<const char*, const char*> reasons[] = {
      {"wire.density_kg_m3", "the wire has no weight"},
      {"wire.youngs_modulus_GPa", "both stiffnesses are declared"},
      {"mount.support_radius_mm", "only a wire on supports"},
      {"wire.natural_curvature_1_m", "between rigid clamps"},
      {"rate_viscosity.relaxation_time_s", "no times"}};
  for (const auto& [key, why] : reasons) {
    e.free = {key};
    try {
      static_cast<void>(trace(e, only_fit()));
      ADD_FAILURE() << key;
    } catch (const base::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(why));
    }
  }
}

}  // namespace
}  // namespace snare::identification
