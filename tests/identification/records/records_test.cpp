#include "identification/motion_tracing/trace_records.hpp"
#include "identification/records/coloured_noise.hpp"
#include "identification/records/record_file.hpp"

#include "base/errors.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

namespace snare::identification {
namespace {

using testing::HasSubstr;

/// A pendulum of its own: m l^2 q'' = m g l sin q - c q' - (k + b exp(-(q'/s)^2)) sgn(q'), by Runge and
/// Kutta's method, which shares no code with the solver. Numbers of data/records/pendulum_arm.toml: l =
/// 0.1476 m, m = 0.1478 kg, inertia and the light motor about the bearing.
struct Swing {
  double inertia = 1.091e-4, viscous = 2.24e-4, coulomb = 0.0, noise = 0.02;  // kg m^2, N m s, N m, deg
  double breakaway_excess = 0.0, falls_off = 1.0;                             // b, s: N m, rad/s
};

void write_swing(const std::filesystem::path& file, const Swing& s, unsigned seed) {
  constexpr double mass = 0.1478, arm = 0.1476, g = 9.81, motor = 1e-6, step = 1e-4;
  const double whole = s.inertia + mass * arm * arm + motor;
  double q = std::numbers::pi / 2, v = 0.0;
  const auto acceleration = [&](double angle, double rate) {
    const double dry = s.coulomb + s.breakaway_excess * std::exp(-std::pow(rate / s.falls_off, 2));
    return (mass * g * arm * std::sin(angle) - s.viscous * rate - dry * std::tanh(rate / 1e-4)) / whole;
  };
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0.0, s.noise);
  std::ofstream out(file);
  out << "time_s,angle_deg\n";
  for (int i = 0; i <= 40000; ++i) {
    if (i % 100 == 0)
      out << fmt::format("{:.4f},{:.6f}\n", i * step, q * 180.0 / std::numbers::pi + noise(engine));
    const double k1 = v, a1 = acceleration(q, v);
    const double k2 = v + 0.5 * step * a1, a2 = acceleration(q + 0.5 * step * k1, k2);
    const double k3 = v + 0.5 * step * a2, a3 = acceleration(q + 0.5 * step * k2, k3);
    const double k4 = v + step * a3, a4 = acceleration(q + step * k3, k4);
    q += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    v += step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
}

class Records : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              fmt::format("records_{}", testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    const std::filesystem::path data = std::filesystem::path(SNARE_SOURCE_DIR) / "data/records";
    for (const char* name : {"pendulum.urdf", "pendulum_arm.toml", "pendulum_scenario.toml"})
      std::filesystem::copy_file(data / name, folder_ / name);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& more = "", const std::string& fit = "") {
    std::ofstream out(folder_ / "record.toml");
    out << "schema = \"snare-record/1\"\ntitle = \"t\"\nscenario = \"pendulum_scenario.toml\"\n"
           "set = { \"arms[pendulum].angles_deg[1]\" = 90.0, \"arms[pendulum].rates_deg_s[1]\" = 0.0 }\n"
           "[[records]]\nname = \"a\"\nfile = \"a.csv\"\ncolumns = { angle_deg = \"encoder\" }\n"
        << more
        << "\n[fit]\nfree = [\"arms[pendulum].link.rod.inertia_kg_m2[2]\", "
           "\"arms[pendulum].joint.bearing.viscous_Nms_rad\"]\n"
        << fit;
    out.close();
    return folder_ / "record.toml";
  }
  std::string complaint() {
    try {
      static_cast<void>(read_records(write()));
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "";
  }
  void rows(const std::string& text) { std::ofstream(folder_ / "a.csv") << "time_s,angle_deg\n" << text; }

  std::filesystem::path folder_;
};

std::string ramp(int from, int to) {
  std::string text;
  for (int i = from; i < to; ++i) text += fmt::format("{},{}\n", 0.01 * i, 90.0 + i);
  return text;
}

// Numbers 10 % off come back within their errors: five standard deviations of about 0.1 %.
TEST_F(Records, FitFindsTheNumbersOfAnotherIntegrator) {
  write_swing(folder_ / "a.csv", {.inertia = 1.2e-4, .viscous = 2.0e-4}, 1);
  const RecordSet set = read_records(write("sigma = 0.02\n"));
  const RecordTrace trace = trace_records(set, {.effects = false});
  ASSERT_TRUE(trace.report.usable()) << trace.report.message;
  const double truth[] = {1.2e-4, 2.0e-4};
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(trace.base.numbers[k].value, truth[k], 5.0 * trace.base.numbers[k].stderr_ + 2e-3 * truth[k])
        << trace.base.numbers[k].key;
  EXPECT_NEAR(trace.base.chi2_dof, 1.0,
              0.4);  // 401 readings: 0.07 is one deviation; the rest is the integrators'
}

TEST_F(Records, SimplexFindsWhatGaussNewtonFindsWithMoreSimulations) {
  write_swing(folder_ / "a.csv", {.inertia = 1.2e-4, .viscous = 2.0e-4}, 2);
  const RecordTrace newton = trace_records(read_records(write("sigma = 0.02\n")), {.effects = false});
  const RecordTrace simplex =
      trace_records(read_records(write("sigma = 0.02\n", "method = \"nelder_mead\"\n")), {.effects = false});
  ASSERT_TRUE(newton.report.usable() && simplex.report.usable());
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(simplex.base.numbers[k].value, newton.base.numbers[k].value, newton.base.numbers[k].stderr_);
  EXPECT_GT(simplex.fit_simulations, newton.fit_simulations);
  RecordProperty("newton", static_cast<int>(newton.fit_simulations));
  RecordProperty("simplex", static_cast<int>(simplex.fit_simulations));
}

TEST_F(Records, CoulombFrictionIsNamed) {
  write_swing(folder_ / "a.csv", {.coulomb = 5e-4}, 3);
  const RecordTrace trace = trace_records(read_records(write("sigma = 0.02\n", "most_effects = 1\n")));
  ASSERT_TRUE(trace.report.usable()) << trace.report.message;
  ASSERT_EQ(trace.selected.size(), 1u);
  EXPECT_EQ(trace.selected[0], "joint_coulomb_friction (pendulum::bearing)");
  EXPECT_NEAR(trace.final.numbers.back().value, 5e-4, 0.05 * 5e-4);  // a bound far above the interval
}

// Friction that is larger at rest, where the speed is declared at which it has fallen off; else a late sensor
// is as good.
TEST_F(Records, FrictionThatFallsWithTheSpeedIsNamed) {
  write_swing(folder_ / "a.csv", {.coulomb = 4e-4, .breakaway_excess = 2e-3, .falls_off = 2.0}, 4);
  const RecordTrace trace = trace_records(
      read_records(write("sigma = 0.02\nset = { \"arms[pendulum].joint.bearing.coulomb_Nm\" = 4e-4, "
                         "\"arms[pendulum].joint.bearing.stribeck_velocity_rad_s\" = 2.0 }\n",
                         "most_effects = 1\n")));
  ASSERT_TRUE(trace.report.usable()) << trace.report.message;
  ASSERT_EQ(trace.selected.size(), 1u);
  EXPECT_EQ(trace.selected[0], "joint_breakaway (pendulum::bearing)");
  EXPECT_NEAR(trace.final.numbers.back().value, 2e-3, 0.05 * 2e-3);
}

// Honda's rule ends the search where a better place is hardly another: sooner, and near enough.
TEST_F(Records, SimplexEndsWhereItHardlyMoves) {
  write_swing(folder_ / "a.csv", {.inertia = 1.2e-4, .viscous = 2.0e-4}, 5);
  const std::string method = "method = \"nelder_mead\"\n";
  const RecordTrace far = trace_records(read_records(write("sigma = 0.02\n", method)), {.effects = false});
  const RecordTrace near = trace_records(
      read_records(write("sigma = 0.02\n", method + "simplex_change = 1e-2\n")), {.effects = false});
  ASSERT_TRUE(far.report.usable() && near.report.usable());
  EXPECT_LT(near.fit_simulations, far.fit_simulations);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(near.base.numbers[k].value, far.base.numbers[k].value, 0.05 * far.base.numbers[k].value);
}

// A simplex that ends far from the minimum says so, and calls no number open because chi2 does not rise.
TEST_F(Records, SimplexThatEndsTooEarlySaysSo) {
  write_swing(folder_ / "a.csv", {.inertia = 1.2e-4, .viscous = 2.0e-4}, 5);
  const RecordTrace trace =
      trace_records(read_records(write("sigma = 0.02\n", "method = \"nelder_mead\"\nsimplex_change = 0.2\n")),
                    {.effects = false});
  ASSERT_TRUE(trace.report.usable());
  EXPECT_THAT(trace.warnings, testing::Contains(HasSubstr("has not ended at its least sum of squares")));
  EXPECT_TRUE(trace.base.open.empty());
}

// A record of a swing half again as long: the numbers that are declared lose step with it in the second
// swing.
TEST_F(Records, LostStepIsFoundFromTheBeginnings) {
  write_swing(folder_ / "a.csv", {.inertia = 4.0e-3, .viscous = 2.0e-4}, 6);
  const RecordTrace trace = trace_records(read_records(write("sigma = 0.02\n")), {.effects = false});
  ASSERT_TRUE(trace.report.usable()) << trace.report.message;
  EXPECT_NEAR(trace.base.numbers[0].value, 4.0e-3, 1e-2 * 4.0e-3);
  EXPECT_NEAR(trace.base.chi2_dof, 1.0, 0.4);
}

// The same record by a model whose rod is a tenth heavier: the inertia takes what the weight does not.
TEST_F(Records, FamiliesTellWhatOtherModelsFind) {
  write_swing(folder_ / "a.csv", {}, 7);
  const RecordTrace trace = trace_records(
      read_records(write(
          "sigma = 0.02\n",
          "[[fit.families]]\nname = \"heavier\"\nset = { \"arms[pendulum].link.rod.mass_kg\" = 0.16258 }\n"
          "[[fit.families]]\nname = \"same\"\nset = { \"arms[pendulum].link.rod.mass_kg\" = 0.1478 }\n")),
      {.effects = false});
  ASSERT_TRUE(trace.report.usable()) << trace.report.message;
  ASSERT_EQ(trace.families.size(), 2u);
  EXPECT_EQ(trace.families[0].name, "heavier");
  EXPECT_GT(trace.families[0].simulations, 0);
  const TracedNumber &here = trace.base.numbers[0], &heavier = trace.families[0].numbers[0];
  EXPECT_EQ(heavier.key, here.key);
  EXPECT_TRUE(heavier.value < *here.lower || heavier.value > *here.upper);
  EXPECT_NEAR(trace.families[1].numbers[0].value, here.value, here.stderr_);
  EXPECT_THAT(trace.warnings,
              testing::Contains(HasSubstr("with the models of family heavier: a systematic difference")));
  EXPECT_THAT(trace.warnings, testing::Not(testing::Contains(HasSubstr("of family same"))));
}

TEST_F(Records, BadRecordsAreRefusedWithEverything) {
  rows(ramp(0, 30) + "0.29,1\n0.2,2\n" + ramp(31, 40));
  EXPECT_THAT(complaint(), testing::AllOf(HasSubstr("stands there twice"), HasSubstr("comes after")));
  rows(ramp(0, 30) + ramp(200, 230));
  EXPECT_THAT(complaint(), HasSubstr("longest_gap_s"));
  rows(ramp(0, 10));
  EXPECT_THAT(complaint(), HasSubstr("must be at least 20"));
  std::string constant, saturated;
  for (int i = 0; i < 40; ++i) {
    constant += fmt::format("{},1\n", 0.01 * i);
    saturated += fmt::format("{},{}\n", 0.01 * i, std::min(i, 10));
  }
  rows(constant);
  EXPECT_THAT(complaint(), HasSubstr("all readings are the same"));
  rows(saturated);
  EXPECT_THAT(complaint(), HasSubstr("saturated"));
  // A turn between two steps of an encoder, all of whose other readings differ; the same cut off beyond an
  // end of its range.
  const auto turn = [](double range) {
    std::string text;
    for (int i = 0; i < 400; ++i) {
      const double s = 0.01 * (i - 250);
      text += fmt::format("{:.2f},{:.2f}\n", 0.01 * i,
                          0.05 * std::floor(std::min(range, 40.0 - 6.0 * s * s) / 0.05));
    }
    return text;
  };
  rows(turn(50.0));
  EXPECT_EQ(complaint(), "");
  rows(turn(39.0));
  EXPECT_THAT(complaint(), HasSubstr("saturated"));
  rows(ramp(0, 30) + "0.31,nan\n");
  EXPECT_THAT(complaint(), HasSubstr("angle_deg"));
  std::ofstream(folder_ / "a.csv") << "time_s,other\n0,1\n";
  EXPECT_THAT(complaint(), HasSubstr("angle_deg"));
}

// Of an autoregression of known coefficients: Burg's are within four of their deviations, sqrt((1 - a^2)/n).
TEST(ColouredNoise, FindsAnAutoregression) {
  RecordSet set;
  Record record;
  record.channels.emplace_back().sensor = "s";
  set.records.push_back(record);
  constexpr Eigen::Index n = 4000;
  RecordData data;
  data.set = &set;
  data.records = {0};
  data.pieces = {{0, 0, 0, n, 1.0}};
  data.rows = n;
  std::mt19937 engine(4);
  std::normal_distribution<double> white(0.0, 2.0);
  Eigen::VectorXd e(n);
  for (Eigen::Index t = 0; t < n; ++t) e[t] = (t > 0 ? 0.9 * e[t - 1] : 0.0) + white(engine);
  const ColouredNoise noise = coloured_noise(data, e);
  ASSERT_GE(noise.pieces[0].coefficients.size(), 1);
  EXPECT_NEAR(noise.pieces[0].coefficients[0], 0.9, 4.0 * std::sqrt((1.0 - 0.81) / n) + 0.02);
  EXPECT_NEAR(noise.pieces[0].innovation, 2.0, 4.0 * 2.0 / std::sqrt(2.0 * n));
  // The variance of a mean: of the process s^2/(1 - a)^2 / n, closely.
  const Eigen::MatrixXd mean = Eigen::MatrixXd::Constant(n, 1, 1.0 / n);
  EXPECT_NEAR(coloured(data, noise, mean).squaredNorm(), 4.0 / 0.01 / n, 0.3 * 4.0 / 0.01 / n);
}

}  // namespace
}  // namespace snare::identification
