// Profiles against closed forms: of a body that turns under a steady moment, w = w0 + M t/J, w0 and M enter
// linearly and J does not.
#include "identification/records/profile.hpp"
#include "identification/motion_tracing/trace_records.hpp"
#include "identification/records/record_file.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/turning_craft.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace snare::identification {
namespace {

using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double inertia = 10.0, moment = 0.05, start = 0.01;  // kg m^2, N m, rad/s
constexpr int readings = 101;
constexpr double interval = 0.1, deviate = 1.9599639845400545;

class ProfileOfATurningBody : public test::FolderFixture {
 protected:
  /// Sums of least squares for w = w0 + slope t, in deg and s.
  struct Line {
    double slope = 0.0, squares_about_mean = 0.0, mean_time = 0.0, through_origin = 0.0, squares = 0.0;
  };
  Line line;

  std::filesystem::path record(double sigma, const std::string& fit) {
    write("scenario.toml", R"(schema = "snare-scenario/2"
title = "craft"
duration_s = 10.0
output_interval_s = 0.05
[[bodies]]
name = "craft"
)" + test::turning_craft("100.0, 100.0, 10.0") +
                               R"([[sensors]]
name = "gyro"
kind = "rate"
frame = "craft"
[solver]
max_order = 5
)");
    std::mt19937 engine(11);
    std::normal_distribution<double> noise(0.0, sigma);
    std::string text = "time_s,rate_deg_s\n";
    double st = 0.0, sy = 0.0, stt = 0.0, sty = 0.0, own = 0.0;
    for (int i = 0; i < readings; ++i) {
      const double t = interval * i, y = (start + moment * t / inertia) / degree + noise(engine);
      text += fmt::format("{:.2f},{:.12g}\n", t, y);
      st += t;
      sy += y;
      stt += t * t;
      sty += t * y;
      own += t * (y - start / degree);
    }
    line.mean_time = st / readings;
    line.squares_about_mean = stt - st * st / readings;
    line.slope = (sty - st * sy / readings) / line.squares_about_mean;
    line.through_origin = own / stt;
    line.squares = stt;
    write("a.csv", text);
    return write("record.toml", fmt::format(R"(schema = "snare-record/1"
title = "t"
scenario = "scenario.toml"
[[records]]
name = "a"
file = "a.csv"
columns = {{ rate_deg_s = "gyro_z_deg_s" }}
sigma = {}
[fit]
{})",
                                            sigma, fit));
  }
};

// M with w0 fitted beside it: the rise is (M - M^)^2 over the variance that the covariance has, and both
// intervals are one.
TEST_F(ProfileOfATurningBody, IsTheCovarianceWhereNumbersEnterLinearly) {
  const char* key = "loads[thruster].moment_Nm[3]";
  const RecordTrace t = trace_records(
      read_records(record(
          0.02,
          fmt::format("free = [\"{0}\", \"bodies[craft].spin_rad_s[3]\"]\nprofile = [\"{0}\"]\n", key))),
      {.effects = false});
  ASSERT_TRUE(t.report.usable()) << t.report.message;
  ASSERT_EQ(t.profiles.size(), 1u);
  const Profile& p = t.profiles[0];
  const TracedNumber& n = t.base.numbers[0];
  EXPECT_NEAR(p.value, line.slope * degree * inertia, 1e-6 * moment);  // accuracy of the integration
  ASSERT_TRUE(p.lower.limit && p.upper.limit);
  EXPECT_EQ(p.upper.end, ProfileEnd::crossed);
  const double half = deviate * n.stderr_;  // limits to a hundredth of the half width: where secants end
  EXPECT_NEAR(*p.lower.limit, p.value - half, 0.01 * half);
  EXPECT_NEAR(*p.upper.limit, p.value + half, 0.01 * half);
  for (const ProfilePoint& point : p.points) {
    const double z = (point.value - p.value) / n.stderr_;
    EXPECT_NEAR(point.rise, z * z, 0.01 * (1.0 + z * z)) << point.value;
  }
}

// J alone: 1/J enters linearly, so its profile in J is (1/J - 1/J^)^2 over a variance, and lopsided. With
// noise of a fifth of what is seen the covariance's interval is symmetric and wrong on both sides.
TEST_F(ProfileOfATurningBody, IsThatOfTheInverseWhereTheCovarianceMisleads) {
  constexpr double sigma = 3.3;  // deg/s: 1/J to a fifth
  const RecordTrace t = trace_records(
      read_records(record(
          sigma,
          "free = [\"bodies[craft].inertia_kg_m2[3]\"]\nprofile = [\"bodies[craft].inertia_kg_m2[3]\"]\n")),
      {.effects = false});
  ASSERT_TRUE(t.report.usable()) << t.report.message;
  ASSERT_EQ(t.profiles.size(), 1u);
  const Profile& p = t.profiles[0];
  const double best = line.through_origin * degree / moment;  // 1/J^
  // The deviate of 1/J that belongs to one of J, to first order: that unit the profile has, too.
  const double unit = t.base.numbers[0].stderr_ * best * best;
  // A fit ends where the sum of 101 would fall by less than 1e-5 of itself: within 0.03 deviates.
  ASSERT_NEAR(1.0 / p.value, best, 0.03 * unit);
  ASSERT_TRUE(p.lower.limit && p.upper.limit);
  EXPECT_NEAR(1.0 / *p.lower.limit, best + deviate * unit, 0.05 * unit);
  EXPECT_NEAR(1.0 / *p.upper.limit, best - deviate * unit, 0.05 * unit);
  const double below = p.value - *p.lower.limit, above = *p.upper.limit - p.value;
  const double u = deviate * unit / best;  // about a half
  EXPECT_NEAR(above / below, (1.0 + u) / (1.0 - u),
              0.2 * (1.0 + u) / (1.0 - u));  // of limits that are each right to 0.05 deviates
}

// A moment that may not be below its declared bound, which the readings ask for: the profile ends there, the
// other side goes up from it.
TEST_F(ProfileOfATurningBody, EndsAtABound) {
  const char* key = "loads[thruster].moment_Nm[3]";
  const RecordTrace t = trace_records(
      read_records(
          record(0.5,
                 fmt::format(
                     "free = [\"{0}\"]\nprofile = [\"{0}\"]\n[[fit.numbers]]\nkey = \"{0}\"\nlower = 0.05\n",
                     key)),
          {{"scenario.bodies[craft].spin_rad_s", "[0.0, 0.0, 0.012]"}}),
      {.effects = false});
  ASSERT_TRUE(t.report.usable()) << t.report.message;
  ASSERT_EQ(t.profiles.size(), 1u);
  const Profile& p = t.profiles[0];
  EXPECT_EQ(p.value, 0.05);
  EXPECT_EQ(p.lower.end, ProfileEnd::bound);
  ASSERT_TRUE(p.lower.limit && p.upper.limit);
  EXPECT_EQ(*p.lower.limit, 0.05);
  EXPECT_GT(*p.upper.limit, 0.05);
}

TEST_F(ProfileOfATurningBody, AsksForAFittedNumber) {
  try {
    static_cast<void>(read_records(record(
        0.02, "free = [\"bodies[craft].mass_kg\"]\nprofile = [\"bodies[craft].inertia_kg_m2[3]\"]\n")));
    FAIL() << "taken";
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), HasSubstr("must be one of fit.free or fit.free_each"));
  }
}

}  // namespace
}  // namespace snare::identification
