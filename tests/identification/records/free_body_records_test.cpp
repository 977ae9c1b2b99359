// Records of bodies whose motion has a closed form: a free body under a steady moment, a body on a spring.
#include "identification/motion_tracing/trace_records.hpp"
#include "identification/records/record_file.hpp"
#include "identification/records/record_model.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/turning_craft.hpp"

#include "base/errors.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace snare::identification {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180.0;

class FreeBodyRecords : public test::FolderFixture {
 protected:
  /// Readings of a function of time every `interval`, with noise.
  void readings(const std::string& file, const std::string& column, double duration, double interval,
                double sigma, unsigned seed, const std::function<double(double)>& value) const {
    std::mt19937 engine(seed);
    std::normal_distribution<double> noise(0.0, sigma);
    std::string text = "time_s," + column + "\n";
    for (int i = 0; i * interval <= duration; ++i)
      text += fmt::format("{:.4f},{:.9g}\n", i * interval, value(i * interval) + noise(engine));
    write(file, text);
  }
  /// scenario.toml: a body "craft" in free motion with one sensor; `body`: its numbers, and the tables after
  /// it.
  void scenario(double duration, double interval, const std::string& body, const std::string& sensor,
                const std::string& kind) const {
    write(
        "scenario.toml",
        fmt::format(
            "schema = \"snare-scenario/2\"\ntitle = \"craft\"\nduration_s = {:.1f}\noutput_interval_s = {}\n"
            "[[bodies]]\nname = \"craft\"\n{}"
            "[[sensors]]\nname = \"{}\"\nkind = \"{}\"\nframe = \"craft\"\n[solver]\nmax_order = 5\n",
            duration, interval, body, sensor, kind));
  }
  /// A craft of 10 kg m^2 with a moment of 0.05 N m about z: w = w0 + M t/J. Declared 8 % heavier to turn.
  std::filesystem::path craft(double first_spin, double second_spin,
                              const std::string& second_declared) const {
    scenario(10.0, 0.05, test::turning_craft("10.8, 10.8, 10.8"), "gyro", "rate");
    for (const auto& [name, spin, seed] :
         {std::tuple{"first", first_spin, 1u}, std::tuple{"second", second_spin, 2u}})
      readings(fmt::format("{}.csv", name), "rate_deg_s", 10.0, 0.1, 0.01, seed,
               [spin = spin](double t) { return (spin + 0.05 * t / 10.0) / degree; });
    return write("record.toml", R"(schema = "snare-record/1"
title = "t"
scenario = "scenario.toml"
[[records]]
name = "first"
file = "first.csv"
columns = { rate_deg_s = "gyro_z_deg_s" }
sigma = 0.01
[[records]]
name = "second"
file = "second.csv"
columns = { rate_deg_s = "gyro_z_deg_s" }
sigma = 0.01
set = { "bodies[craft].spin_rad_s" = )" +
                                    second_declared + R"( }
[fit]
free = ["bodies[craft].inertia_kg_m2[3]"]
heldout = ["second"]
)");
  }
  /// 5 kg on 200 N/m with a start of 0.02 m/s: x = v/w sin(w t), w = sqrt(40) rad/s, a period of 0.993 s.
  /// `free`: what is fitted.
  std::filesystem::path spring(double duration, const std::string& free) const {
    scenario(2.0, 0.01, R"(mass_kg = 5.0
inertia_kg_m2 = [1.0, 1.0, 1.0]
velocity_m_s = [0.02, 0.0, 0.0]
[[bushings]]
name = "fixture"
frame = "world"
other_frame = "craft"
translational_stiffness_N_m = 190.0
rotational_stiffness_Nm_rad = 100.0
)",
             "place", "position");
    const double w = std::sqrt(40.0);
    readings("a.csv", "x_mm", duration, 0.01, 0.01, 3, [w](double t) { return 20.0 / w * std::sin(w * t); });
    return write("record.toml", R"(schema = "snare-record/1"
title = "t"
scenario = "scenario.toml"
[[records]]
name = "a"
file = "a.csv"
columns = { x_mm = "place_x_mm" }
sigma = 0.01
[fit]
free = [)" + free + "]\n");
  }
  std::string complaint(const std::filesystem::path& file) const {
    try {
      static_cast<void>(read_records(file));
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "";
  }
};

// A vector of many digits in `set` is longer than what messages show of a value.
TEST_F(FreeBodyRecords, SetTakesAVectorWithAllItsDigits) {
  const std::string vector = "[-0.0123456789012345678, 0.0234567890123456789, -0.0345678901234567890]";
  const RecordSet set = read_records(craft(0.01, 0.02, vector));
  ASSERT_EQ(set.records[1].set.size(), 1u);
  EXPECT_THAT(set.records[1].set[0].value, HasSubstr("-0.03456789012345679"));
  EXPECT_THAT(set.records[1].set[0].value, HasSubstr("]"));
}

TEST_F(FreeBodyRecords, NothingIsMissingInEitherRecord) {
  const RecordTrace trace = trace_records(read_records(craft(0.01, -0.03, "[0.0, 0.0, -0.03]")));
  ASSERT_TRUE(trace.report.usable()) << trace.report.message;
  EXPECT_EQ(trace.kind, VerdictKind::nothing_missing);
  EXPECT_NEAR(trace.base.numbers[0].value, 10.0, 4.0 * trace.base.numbers[0].stderr_);  // four deviations
  EXPECT_NEAR(trace.base.heldout_rmse, 0.01, 0.003);  // of 101 readings: 0.0007 is one deviation
}

// Both crafts began 0.004 rad/s faster than each record declares. Of the spin the record shows z alone, and a
// zero of the gyroscope does the same.
TEST_F(FreeBodyRecords, AnEffectAddsToWhatEachRecordDeclares) {
  const RecordTrace trace = trace_records(read_records(craft(0.014, -0.026, "[0.0, 0.0, -0.03]")));
  ASSERT_TRUE(trace.report.usable()) << trace.report.message;
  EXPECT_EQ(trace.kind, VerdictKind::explained);
  ASSERT_EQ(trace.selected, std::vector<std::string>{"body_start_spin (craft)"});
  EXPECT_THAT(trace.rounds[0].classes[0], Contains("sensor_bias (gyro_z_deg_s)"));
  ASSERT_EQ(trace.final.numbers.size(), 2u);
  EXPECT_EQ(trace.final.numbers[1].key, "bodies[craft].spin_rad_s[3]");
  EXPECT_NEAR(trace.final.numbers[1].value, 0.014, 4.0 * trace.final.numbers[1].stderr_);  // four deviations
  EXPECT_NEAR(trace.final.heldout_rmse, 0.01, 0.003);
}

TEST_F(FreeBodyRecords, ASensorAtItsEndIsRefused) {
  const std::filesystem::path file = craft(0.01, 0.02, "[0.0, 0.0, 0.02]");
  const std::function<double(double)> rate = [](double t) { return 0.6 + 0.3 * t; };
  std::mt19937 engine(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::string clipped = "time_s,rate_deg_s\n", stepped = clipped;
  for (int i = 0; i <= 100; ++i) {
    const double value = rate(0.1 * i) + noise(engine);
    clipped += fmt::format("{:.2f},{:.9g}\n", 0.1 * i, std::min(value, 3.0));
    stepped += fmt::format("{:.2f},{:.9g}\n", 0.1 * i, 0.25 * std::round(std::min(value, 3.0) / 0.25));
  }
  write("first.csv", clipped);
  EXPECT_THAT(complaint(file), HasSubstr("saturated"));
  write("first.csv", stepped);  // an encoder of coarse steps that comes to rest there
  EXPECT_EQ(complaint(file), "");
}

// As heavy to turn as a grain of sand the craft would turn 8000 times a second: a trial that takes 100 times
// the steps of the longest run is left.
TEST_F(FreeBodyRecords, ATrialBeyondAllMeasureIsGivenUp) {
  const RecordSet set = read_records(craft(0.01, 0.02, "[0.0, 0.0, 0.02]"));
  const RecordModel model(set);
  std::vector<RecordSetting> settings = model.free_settings({0});
  ASSERT_EQ(settings.size(), 1u);
  settings[0].value = 1e-5;
  const RecordPrediction none = model.predict(settings, {0})[0];
  EXPECT_FALSE(none.usable());
  EXPECT_THAT(none.failure, HasSubstr("100 times those of any run before"));
  settings[0].value = 10.0;
  EXPECT_TRUE(model.predict(settings, {0})[0].usable());
}

TEST_F(FreeBodyRecords, ARecordShorterThanTheSlowestPeriodIsSaidAndNothingIsNamed) {
  const char* stiffness = "\"bushings[fixture].translational_stiffness_N_m\"";
  const RecordTrace longer = trace_records(read_records(spring(1.5, stiffness)));
  ASSERT_TRUE(longer.report.usable()) << longer.report.message;
  EXPECT_TRUE(longer.warnings.empty());
  EXPECT_EQ(longer.kind, VerdictKind::nothing_missing);
  const RecordTrace shorter = trace_records(read_records(spring(0.4, stiffness)));
  ASSERT_TRUE(shorter.report.usable()) << shorter.report.message;
  EXPECT_THAT(shorter.warnings,
              Contains(HasSubstr("less than the slowest period of the declared scenario, 1.019 s")));
  EXPECT_EQ(shorter.kind, VerdictKind::nothing_missing);
}

// Nothing turns: the stiffness against turning changes nothing.
TEST_F(FreeBodyRecords, ANumberThatChangesNothingIsSaid) {
  const RecordTrace trace =
      trace_records(read_records(spring(1.5,
                                        "\"bushings[fixture].translational_stiffness_N_m\", "
                                        "\"bushings[fixture].rotational_stiffness_Nm_rad\"")));
  ASSERT_TRUE(trace.report.usable()) << trace.report.message;
  EXPECT_THAT(trace.warnings, Contains(HasSubstr("rotational_stiffness_Nm_rad is not identifiable")));
  EXPECT_NEAR(trace.base.numbers[0].value, 200.0, 4.0 * trace.base.numbers[0].stderr_);  // four deviations
}

}  // namespace
}  // namespace snare::identification
