#include "identification/fitting/experiment.hpp"
#include "identification/effects/catalogue.hpp"

#include "base/errors.hpp"
#include "base/files.hpp"
#include "tests/identification/valid_experiment.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace snare::identification {
namespace {

using base::InputError;
using base::write_text;

/// A folder with an experiment whose first series has a CSV file.
class ExperimentFiles : public test::FolderFixture {
 protected:
  ExperimentFiles() { write("x.toml", edited("travel_mm = 2.0\npoints = 21", "file = \"s40.csv\"")); }

  /// Message for a CSV file with this content, the folder taken out.
  [[nodiscard]] std::string message_of_csv(const std::string& content) const {
    write("s40.csv", content);
    return message();
  }
  [[nodiscard]] std::string message(const std::vector<Override>& overrides = {}) const {
    try {
      static_cast<void>(read_experiment(path("x.toml"), parameters(), overrides));
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string prefix = folder_.string() + "/";
      for (std::size_t at = 0; (at = text.find(prefix)) != std::string::npos;) text.erase(at, prefix.size());
      return text;
    }
    return "accepted";
  }
};

// Where the stiffnesses are given nothing is asked of the material; a modulus stands for stresses only.
TEST(Experiment, TheModulusMayBeLeftOutBesideTheStiffnesses) {
  const Experiment e = parse_experiment("x.toml",
                                        edited("youngs_modulus_GPa = 193.0\npoisson_ratio = 0.29\n",
                                               "bending_stiffness_Nm2 = 0.01\naxial_stiffness_N = 2e4\n"),
                                        parameters());
  const wire::WireSpecification& wire = e.series[0].test.wire;
  EXPECT_FALSE(e.series[0].modulus_declared);
  EXPECT_EQ(wire.bending_stiffness(), 0.01);
  EXPECT_EQ(wire.poisson_ratio, 0.3);
  EXPECT_NEAR(wire.youngs_modulus * 0.25 * std::numbers::pi * std::pow(wire.diameter, 2), 2e4, 1e-9 * 2e4);
  const std::string said = test::refusal([&] {
    return parse_experiment(
        "x.toml", edited("youngs_modulus_GPa = 193.0\n", "bending_stiffness_Nm2 = 0.01\n"), parameters());
  });
  EXPECT_NE(said.find("wire.youngs_modulus_GPa, missing"), std::string::npos) << said;
}

TEST(Experiment, ANumberOfEverySeries) {
  const Experiment e =
      parse_experiment("x.toml",
                       edited("heldout = [\"s65\"]",
                              "per_series = [\"reading.displacement_offset_mm\"]\nmodel_tolerance = 0.02"),
                       parameters());
  EXPECT_EQ(e.free, (std::vector<std::string>{"wire.length_mm", "reading.force_gain",
                                              "series[s40].reading.displacement_offset_mm",
                                              "series[s65].reading.displacement_offset_mm"}));
  EXPECT_EQ(e.model_tolerance, 0.02);
}

TEST(Experiment, ValidFileIsReadInSi) {
  const Experiment experiment = parse_experiment("x.toml", valid_experiment, parameters());
  EXPECT_EQ(experiment.file, "x.toml");
  EXPECT_EQ(experiment.title, "a loose wire");
  EXPECT_EQ(experiment.source, "");
  EXPECT_EQ(experiment.solver.elements, SolverSettings{}.elements);
  EXPECT_EQ(experiment.solver.extrapolate, SolverSettings{}.extrapolate);
  EXPECT_EQ(experiment.free, (std::vector<std::string>{"wire.length_mm", "reading.force_gain"}));
  EXPECT_EQ(experiment.heldout, std::vector<std::string>{"s65"});
  ASSERT_EQ(experiment.series.size(), 2u);

  const coupling::PushProblem& test = experiment.series[0].test;
  EXPECT_EQ(test.wire.construction, wire::Construction::solid);
  EXPECT_EQ(test.wire.diameter, 0.0015);
  EXPECT_EQ(test.wire.length, 0.18);
  EXPECT_EQ(test.wire.youngs_modulus, 193e9);
  EXPECT_EQ(test.wire.poisson_ratio, 0.29);
  EXPECT_EQ(test.wire.density, 7930.0);
  EXPECT_EQ(test.wire.natural_curvature, 0.0);
  EXPECT_FALSE(test.wire.bending_stiffness_override || test.wire.axial_stiffness_override ||
               test.wire.torsional_stiffness_override);
  EXPECT_EQ(test.mount.kind, wire::MountKind::clamped);
  EXPECT_EQ(test.mount.span, 0.175);
  EXPECT_FALSE(test.mount.translational_stiffness || test.mount.rotational_stiffness ||
               test.mount.slip_tension);
  EXPECT_EQ(test.pusher.radius, 0.006);
  EXPECT_EQ(test.pusher.friction, 0.0);
  EXPECT_EQ(test.pusher.direction, coupling::PushDirection::outward);
  EXPECT_EQ(test.bulge.mode, 1);
  EXPECT_EQ(test.bulge.plane, 0.0);
  EXPECT_EQ(test.gravity, (std::array<double, 3>{0.0, 0.0, 0.0}));
  EXPECT_EQ(test.contact_position, 0.04);
  ASSERT_EQ(test.travel.size(), 21u);
  EXPECT_EQ(test.travel.front(), 0.0);
  EXPECT_NEAR(test.travel[1], 1e-4, 1e-18);  // two roundings of 1e-4
  EXPECT_EQ(test.travel.back(), 0.002);      // the end is reached exactly
  EXPECT_FALSE(experiment.series[0].readings || experiment.series[0].law || experiment.series[0].force_sigma);
  EXPECT_EQ(experiment.series[0].position_sigma, 0.0);

  const Series& law = experiment.series[1];
  ASSERT_TRUE(law.law.has_value());
  EXPECT_EQ(law.law->a, 878089.0);
  EXPECT_EQ(law.law->b, -1086.0);
  EXPECT_EQ(law.law->c, 0.2115);
  EXPECT_EQ(law.law->r_squared, 0.998);
  EXPECT_EQ(law.law->to, 0.004);
  EXPECT_EQ(law.test.travel.size(), 20u);
  EXPECT_EQ(law.test.travel.back(), 0.004);
}

// R2 counts as rounded to four decimals, or to as many as it has, unless the file says otherwise.
TEST(Experiment, DecimalsOfR2) {
  const auto digits = [](const std::vector<Override>& changes) {
    return parse_experiment("x.toml", valid_experiment, parameters(), changes)
        .series[1]
        .law->r_squared_digits;
  };
  EXPECT_EQ(digits({}), 4);
  EXPECT_EQ(digits({{"series[2].law.R2", "0.99876"}}), 5);
  EXPECT_EQ(digits({{"series[2].law.R2", "1"}}), 4);
  EXPECT_EQ(digits({{"series[2].law.R2_digits", "3"}}), 3);
  EXPECT_EQ(digits({{"series[2].law.R2_digits", "2"}}), 2) << "fewer than R2 has: a wider interval";
  const std::string said = test::refusal([&] { return digits({{"series[2].law.R2_digits", "0"}}); });
  EXPECT_NE(said.find("R2_digits = 0, must be"), std::string::npos) << said;
  EXPECT_EQ(parse_experiment("x.toml", valid_experiment, parameters(), {{"fit.published_scatter", "each"}})
                .published_scatter,
            PublishedScatter::each);
}

TEST(Experiment, EveryOptionalKeyIsRead) {
  const std::string text =
      "schema = 'snare-experiment/1'\ntitle = 't'\nsource = 's'\n"
      "gravity.vector_m_s2 = [0, -9.81, 1]\nbulge = { mode = 2, plane_deg = -90 }\n"
      "solver = { elements = 128, extrapolate = false }\n"
      "[wire]\nconstruction = 'strand'\ndiameter_mm = 2\nlength_mm = 180\nyoungs_modulus_GPa = 193\n"
      "poisson_ratio = 0\ndensity_kg_m3 = 7930\nbending_stiffness_Nm2 = 5e-4\naxial_stiffness_N = 1e5\n"
      "torsional_stiffness_Nm2 = 4e-4\nnatural_curvature_1_m = -2\n"
      "[mount]\nkind = 'clamped'\nspan_mm = 175\ntranslational_stiffness_N_m = 1e6\n"
      "rotational_stiffness_Nm_rad = 20\nslip_tension_N = 30\n"
      "[pusher]\nshape = 'cylinder'\nradius_mm = 0\nfriction = 0.3\ndirection = 'inward'\ntilt_deg = "
      "2\nmisalignment_deg = -1\n"
      "[[series]]\nname = 'a'\ncontact_position_mm = 90\ncontact_position_sigma_mm = 0.2\n"
      "force_sigma_N = 0.05\npath_mm = [0, 2, 1]\npoints = 3\n";
  const Experiment experiment = parse_experiment("x.toml", text, parameters());
  const coupling::PushProblem& test = experiment.series.at(0).test;
  EXPECT_EQ(test.gravity, (std::array<double, 3>{0.0, -9.81, 1.0}));
  EXPECT_EQ(test.bulge.mode, 2);
  EXPECT_NEAR(test.bulge.plane, -std::numbers::pi / 2.0, 1e-15);  // roundings of a number of order one
  EXPECT_EQ(experiment.solver.elements, 128);
  EXPECT_FALSE(experiment.solver.extrapolate);
  EXPECT_EQ(test.wire.construction, wire::Construction::strand);
  EXPECT_EQ(test.wire.bending_stiffness(), 5e-4);
  EXPECT_EQ(test.wire.axial_stiffness(), 1e5);
  EXPECT_EQ(test.wire.torsional_stiffness(), 4e-4);
  EXPECT_EQ(test.wire.natural_curvature, -2.0);
  EXPECT_EQ(test.mount.translational_stiffness, 1e6);
  EXPECT_EQ(test.mount.rotational_stiffness, 20.0);
  EXPECT_EQ(test.mount.slip_tension, 30.0);
  EXPECT_EQ(test.pusher.radius, 0.0);
  EXPECT_EQ(test.pusher.friction, 0.3);
  EXPECT_EQ(test.pusher.direction, coupling::PushDirection::inward);
  EXPECT_NEAR(test.pusher.tilt, std::numbers::pi / 90.0, 1e-16);  // as above
  EXPECT_NEAR(test.pusher.misalignment, -std::numbers::pi / 180.0, 1e-16);
  EXPECT_EQ(experiment.series[0].force_sigma, 0.05);
  EXPECT_NEAR(experiment.series[0].position_sigma, 2e-4, 1e-19);  // roundings
  // Three points a leg, the turning point in common.
  EXPECT_EQ(test.travel, (std::vector<double>{0.0, 0.001, 0.002, 0.0015, 0.001}));
}

TEST(Experiment, SeriesOverridesTheFile) {
  const Experiment experiment = parse_experiment(
      "x.toml",
      edited("points = 21",
             "points = 21\nmount.span_mm = 174\nwire.length_mm = 173\npusher.direction = 'inward'\n"
             "bulge.mode = 2\ngravity.vector_m_s2 = [0, 0, -9.81]"),
      parameters());
  EXPECT_EQ(experiment.series[0].test.mount.span, 0.174);
  EXPECT_EQ(experiment.series[0].test.wire.length, 0.173);  // less than 1 % shorter than its own span
  EXPECT_EQ(experiment.series[0].test.pusher.direction, coupling::PushDirection::inward);
  EXPECT_EQ(experiment.series[0].test.bulge.mode, 2);
  EXPECT_EQ(experiment.series[0].test.gravity[2], -9.81);
  EXPECT_EQ(experiment.series[1].test.mount.span, 0.175);
  EXPECT_EQ(experiment.series[1].test.wire.length, 0.18);
  EXPECT_EQ(experiment.series[1].test.bulge.mode, 1);
}

TEST(Experiment, KeyThatEverySeriesGivesMayBeAbsentFromTheFile) {
  std::string text = edited("span_mm = 175.0\n", "");
  EXPECT_THROW(static_cast<void>(parse_experiment("x.toml", text, parameters())), InputError);
  const std::vector<Override> spans{{"series[s40].mount.span_mm", "174"},
                                    {"series[s65].mount.span_mm", "175"}};
  EXPECT_EQ(parse_experiment("x.toml", text, parameters(), spans).series[1].test.mount.span, 0.175);
}

TEST(Experiment, OverridesOfTheCommandAreCheckedAndNamed) {
  const auto message = [](const std::string& key, const std::string& value) -> std::string {
    return test::refusal([&] {
      return parse_experiment("x.toml", valid_experiment, parameters(), {{key, value}});
    });
  };
  const Experiment changed = parse_experiment("x.toml", valid_experiment, parameters(),
                                              {{"wire.length_mm", "181"},
                                               {"series[s40].contact_position_mm", "41"},
                                               {"mount.kind", "pinned"},
                                               {"solver.elements", "32"}});
  EXPECT_EQ(changed.series[0].test.wire.length, 0.181);
  EXPECT_EQ(changed.series[0].test.contact_position, 0.041);
  EXPECT_EQ(changed.series[1].test.contact_position, 0.065);
  EXPECT_EQ(changed.series[1].test.mount.kind, wire::MountKind::pinned);
  EXPECT_EQ(changed.solver.elements, 32);
  EXPECT_EQ(message("wire.length_mm", "-1"), "--set: wire.length_mm = -1, must be > 0 and <= 100000");
  EXPECT_EQ(message("wire.length_mm", "long"),
            "--set: wire.length_mm = long, must be a number > 0 and <= 100000");
  EXPECT_EQ(message("wire.length_mm", "170"),
            "--set: wire.length_mm = 170, must be >= 173.25, 99 % of the span of 175 mm");
  EXPECT_EQ(message("wire.lenght_mm", "181"),
            "--set: wire.lenght_mm = 181, unknown key; did you mean length_mm?");
  EXPECT_EQ(message("series[s90].points", "5"),
            "--set: series[s90].points = 5, no such series; there are: s40, s65");
  EXPECT_EQ(message("mount.span_mm", "186"),
            "x.toml:7: wire.length_mm = 180.0, must be >= 184.14, 99 % of the span of 186 mm");
}

TEST_F(ExperimentFiles, ReadingsAreReadInTheOrderInWhichTheyWereTaken) {
  write_text(path("s40.csv"),
             "\xEF\xBB\xBF# machine 3\r\ntime_s,force_N,channel_7,displacement_mm\r\n"
             "0,0.01,a,0\r\n1,2.5,b,1.5\r\n2,1.25,c,0.5 # unloading\r\n");
  const Series series = read_experiment(path("x.toml"), parameters()).series[0];
  ASSERT_TRUE(series.readings.has_value());
  EXPECT_EQ(series.readings->displacement, (std::vector<double>{0.0, 0.0015, 0.0005}));
  EXPECT_EQ(series.readings->force, (std::vector<double>{0.01, 2.5, 1.25}));
  EXPECT_EQ(series.readings->time, (std::vector<double>{0.0, 1.0, 2.0}));
  EXPECT_EQ(series.test.travel, series.readings->displacement);
}

// Exports of testing machines: names, units and the sign of a load cell that counts compression negative.
TEST_F(ExperimentFiles, ColumnsAreNamedAndScaledByTheSeries) {
  write_text(path("s40.csv"),
             "Standardweg;Standardkraft;Zeit\nmm;kN;s\n0,0;-0,001;0\n1,5;-0,025;1\n0,5;-0,0125;2\n");
  const auto read = [&](const std::string& columns, const std::string& scale) {
    return read_experiment(path("x.toml"), parameters(),
                           {{"series[s40].columns", columns}, {"series[s40].scale", scale}});
  };
  const std::string names =
      "{ Standardweg = \"displacement_mm\", Standardkraft = \"force_N\", Zeit = \"time_s\" }";
  const Series series = read(names, "{ Standardkraft = -1000.0 }").series[0];
  ASSERT_TRUE(series.readings.has_value());
  EXPECT_EQ(series.readings->displacement, (std::vector<double>{0.0, 0.0015, 0.0005}));
  EXPECT_EQ(series.readings->force, (std::vector<double>{1.0, 25.0, 12.5}));
  EXPECT_EQ(series.readings->time, (std::vector<double>{0.0, 1.0, 2.0}));
  const auto said = [&](const std::string& columns, const std::string& scale) {
    return message({{"series[s40].columns", columns}, {"series[s40].scale", scale}});
  };
  EXPECT_EQ(message({{"series[s40].columns", names}}),
            "s40.csv:2: Standardkraft, is in kN, not in that of force_N: write scale = { \"Standardkraft\" = "
            "1000 }");
  EXPECT_THAT(said("{ force_N = \"Standardkraft\" }", "{ force_N = 2.0 }"),
              testing::HasSubstr("stands the wrong way round: { \"Standardkraft\" = \"force_N\" }"));
  EXPECT_THAT(said("{ Standardkraft = \"force_kN\" }", "{ force_N = 2.0 }"),
              testing::HasSubstr("must be \"displacement_mm\", \"force_N\" or \"time_s\""));
  EXPECT_THAT(said("{ Standardkraft = \"force_N\", Zeit = \"force_N\" }", "{ Zeit = 2.0 }"),
              testing::HasSubstr("another column is force_N already"));
  EXPECT_THAT(said(names, "{ Standardkraft = 0.0 }"), testing::HasSubstr("must not be 0"));
  EXPECT_THAT(said(names, "{ Zeit = -1.0 }"), testing::HasSubstr("must be > 0"));
  EXPECT_THAT(said(names, "{ Kraft = 1000.0 }"),
              testing::HasSubstr("must be a column that is read: Standardweg, Standardkraft or Zeit"));
  EXPECT_THAT(said("3", "{ Zeit = 2.0 }"),
              testing::HasSubstr("must be a table of columns and what they are"));
  EXPECT_THAT(message({{"series[s65].scale", "{ force_N = 2.0 }"}}), testing::HasSubstr("only with file"));
}

TEST_F(ExperimentFiles, WrongReadingsHaveTheirMessage) {
  const std::string header = "displacement_mm,force_N\n";
  EXPECT_EQ(message(), "x.toml:25: series[s40].file = \"s40.csv\", s40.csv: no such file");
  EXPECT_EQ(message_of_csv(""),
            "x.toml:25: series[s40].file = \"s40.csv\", s40.csv: is empty, must have a header that names the "
            "columns");
  EXPECT_EQ(message_of_csv(header),
            "x.toml:25: series[s40].file = \"s40.csv\", s40.csv: has a header but no rows");
  EXPECT_EQ(message_of_csv(header + "0,0\n1,1\n"),
            "x.toml:25: series[s40].file = \"s40.csv\", s40.csv: has 2 rows, must have at least 3");
  EXPECT_EQ(message_of_csv(header + "1,0\n1,1\n1,2\n"),
            "x.toml:25: series[s40].file = \"s40.csv\", s40.csv: displacement_mm is the same in every row");
  EXPECT_EQ(message_of_csv("displacement_mm\n1\n2\n3\n"),
            "s40.csv:1: force_N, no such column; the file has \"displacement_mm\"; name it: columns = { "
            "\"COLUMN\" = "
            "\"force_N\" }");
  EXPECT_EQ(message_of_csv(header + "0,0\n1,one\n2,2\n"), "s40.csv:3: force_N = one, must be a number");
  EXPECT_EQ(message_of_csv(header + "0,0\n1,NaN\n2,2\n"),
            "s40.csv:3: force_N = NaN, must be a finite number");
  EXPECT_EQ(message_of_csv(header + "0,0\n1001,1\n2,2\n"),
            "s40.csv:3: displacement_mm = 1001, must be >= -1000 and <= 1000");
  EXPECT_EQ(message_of_csv("time_s," + header + "0,0,0\n2,1,1\n1,2,2\n"),
            "s40.csv:4: time_s = 1, must be >= 2, the value of the row before");
  EXPECT_EQ(message_of_csv(header + "0,0\n\xFE,1\n2,2\n"),
            "s40.csv:3: byte 0xfe is not UTF-8: save the file as UTF-8");
  EXPECT_EQ(message({{"series[s40].file", "gone.csv"}}),
            "--set: series[s40].file = gone.csv, gone.csv: no such file");
  std::filesystem::remove(path("s40.csv"));
  std::filesystem::create_directory(path("s40.csv"));
  EXPECT_EQ(message(), "x.toml:25: series[s40].file = \"s40.csv\", s40.csv: is a directory, must be a file");
}

TEST_F(ExperimentFiles, ProblemsOfBothKindsOfFileAreListedTogether) {
  write_text(path("s40.csv"), "displacement_mm,force_N\n0,x\n");
  EXPECT_EQ(message({{"wire.length_mm", "0"}, {"pusher.friction", "9"}}),
            "--set: wire.length_mm = 0, must be > 0 and <= 100000\n"
            "--set: pusher.friction = 9, must be >= 0 and <= 2\n"
            "s40.csv:2: force_N = x, must be a number");
}

TEST(QuadraticLaw, ScatterIsThatOfReadingsWithThisR2) {
  // Forward: noise of the predicted scatter on evenly spread readings gives the printed R^2 back. The
  // relative error of R^2's complement over n readings is about sqrt(2 / n), 0.3 % for n = 200 000; four of
  // these are allowed.
  QuadraticLaw law;
  law.a = 878089.0;
  law.b = -1086.0;
  law.c = 0.2115;
  law.r_squared = 0.95;
  law.to = 4e-3;
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, law.scatter());
  const int n = 200'000;
  std::vector<double> readings;
  double mean = 0.0, residual = 0.0, total = 0.0;
  for (int i = 0; i < n; ++i) {
    const double error = noise(random);
    readings.push_back(law.force(law.to * (i + 0.5) / n) + error);
    mean += readings.back() / n;
    residual += error * error;
  }
  for (const double reading : readings) total += (reading - mean) * (reading - mean);
  EXPECT_NEAR(residual / total, 1.0 - law.r_squared, 4.0 * 0.0032 * (1.0 - law.r_squared));
  law.r_squared = 1.0;
  EXPECT_EQ(law.scatter(), 0.0);
}

TEST(WireSpecification, StiffnessOfTheSolidRoundSection) {
  // Stated beside the published experiment: EI = 0.04796 N m^2, EA = 341.06 kN; half a unit of the last
  // digit.
  const wire::WireSpecification wire =
      parse_experiment("x.toml", valid_experiment, parameters()).series[0].test.wire;
  EXPECT_NEAR(wire.bending_stiffness(), 0.04796, 0.5e-5);
  EXPECT_NEAR(wire.axial_stiffness(), 341.06e3, 5.0);
  // G J with G = E / (2 (1 + nu)) and J = pi d^4 / 32, 1e-12: roundings only.
  const double torsional = 193e9 / (2.0 * 1.29) * std::numbers::pi * std::pow(1.5e-3, 4) / 32.0;
  EXPECT_NEAR(wire.torsional_stiffness(), torsional, 1e-12 * torsional);
  // 7930 kg/m^3 over 1.7671 mm^2 is 14.013 g/m.
  EXPECT_NEAR(wire.mass_per_length(), 14.013e-3, 0.5e-6);
}

TEST(PublishedExperiment, IsValid) {
  const Experiment experiment = read_experiment(
      std::filesystem::path(SNARE_SOURCE_DIR) / "data/experiments/published_static.toml", parameters());
  ASSERT_EQ(experiment.series.size(), 3u);
  const double positions[] = {0.040, 0.065, 0.090};
  for (std::size_t i = 0; i < 3; ++i) {
    const Series& series = experiment.series[i];
    EXPECT_EQ(series.test.contact_position, positions[i]);
    EXPECT_EQ(series.test.wire.length, 0.18);
    EXPECT_EQ(series.test.mount.span, 0.175);
    ASSERT_TRUE(series.law.has_value());
    EXPECT_EQ(series.law->to, 0.004);
  }
}

}  // namespace
}  // namespace snare::identification
