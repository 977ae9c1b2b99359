// Damping from free vibrations: data by closed forms with noise, and by the full wire; wrong files.

#include "identification/ring_down/mode_match.hpp"

#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"
#include "wire/motion/rod_in_motion.hpp"
#include "wire/motion/rod_modes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

namespace snare::identification {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

struct TrueMode {
  double frequency, decay, amplitude, phase;  // [Hz], [1/s], [m], [rad]
};

/// x = sum A exp(-s t) cos(2 pi f t + phase) and normal noise.
RingDown modal_sum(const std::vector<TrueMode>& modes, double duration, int readings, double noise,
                   unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  RingDown data;
  data.time.resize(readings);
  data.displacement.resize(readings);
  data.modes = static_cast<int>(modes.size());
  for (int i = 0; i < readings; ++i) {
    const double t = duration * i / (readings - 1);
    double x = 1e-4;  // the gauge's zero is off
    for (const TrueMode& m : modes)
      x += m.amplitude * std::exp(-m.decay * t) * std::cos(2.0 * pi * m.frequency * t + m.phase);
    data.time[i] = 3.0 + t;
    data.displacement[i] = x + noise * normal(random);
  }
  return data;
}

/// Four standard errors: 6e-5 of all honest cases are beyond.
void expect_near(const Estimate& e, double truth) {
  EXPECT_LT(std::abs(e.value - truth), 4.0 * e.error) << e.value << " -+ " << e.error << " for " << truth;
}

TEST(RingDown, FindsTheNumbersOfADampedModalSum) {
  const double time = 1e-5;
  const double rate = 5.0;
  std::vector<TrueMode> modes{{215.0, 0.0, 5e-4, 0.3}, {592.0, 0.0, 1.5e-4, -1.2}};
  for (TrueMode& m : modes) m.decay = 0.5 * (rate + time * std::pow(2.0 * pi * m.frequency, 2));
  const RingDown data = modal_sum(modes, 0.3, 1500, 2e-6, 1);
  const RingDownFit fit = fit_ring_down(data);
  ASSERT_TRUE(fit.report.usable()) << fit.report.message;
  ASSERT_EQ(fit.modes.size(), 2u);
  std::vector<DecayOfMode> decays;
  for (std::size_t m = 0; m < 2; ++m) {
    expect_near(fit.modes[m].frequency, modes[m].frequency);
    expect_near(fit.modes[m].decay, modes[m].decay);
    expect_near(fit.modes[m].amplitude, modes[m].amplitude);
    EXPECT_NEAR(fit.modes[m].damping_ratio.value, modes[m].decay / (2.0 * pi * modes[m].frequency),
                0.03 * fit.modes[m].damping_ratio.value);
    EXPECT_TRUE(fit.modes[m].significant());
    decays.push_back({fit.modes[m].natural(), 1.0, fit.modes[m].decay});
  }
  EXPECT_EQ(fit.largest, 0u);
  EXPECT_FALSE(fit.friction.has_value());
  EXPECT_TRUE(fit.noise_only());
  EXPECT_NEAR(fit.rmse, 2e-6, 2e-7);  // 1500 readings
  const DampingSplit split = split_damping(decays);
  EXPECT_TRUE(split.separated);
  // The natural frequency differs from the damped one by less than 1e-4 here.
  expect_near(split.bending_time, time);
  expect_near(split.mass_rate, rate);
  EXPECT_LT(split.bending_time.error, 0.05 * time);
}

// 95 % intervals hold the truth in 95 of 100: 84 and less happen once in 1e5.
TEST(RingDown, IntervalsCover) {
  int inside = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    RingDown data = modal_sum({{50.0, 4.0, 1e-3, 0.5}}, 0.4, 300, 3e-5, seed);
    data.friction = false;
    const RingDownFit fit = fit_ring_down(data);
    const Estimate& decay = fit.modes.at(0).decay;
    inside += decay.lower() <= 4.0 && 4.0 <= decay.upper() ? 1 : 0;
  }
  EXPECT_GT(inside, 84);
}

// da/dt = -s a - f: a = (a0 + f/s) exp(-s t) - f/s.
TEST(RingDown, TellsFrictionFromViscousDecay) {
  const double s = 1.5;
  const double f = 2e-3;
  const double a0 = 2e-3;
  RingDown data = modal_sum({{40.0, s, a0, 0.0}}, 1.2, 2400, 0.0, 0);
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 1e-5);
  for (Eigen::Index i = 0; i < data.time.size(); ++i) {
    const double t = data.time[i] - data.time[0];
    const double a = std::max(0.0, (a0 + f / s) * std::exp(-s * t) - f / s);
    data.displacement[i] = a * std::cos(2.0 * pi * 40.0 * t) + noise(random);
  }
  const RingDownFit fit = fit_ring_down(data);
  ASSERT_TRUE(fit.friction.has_value());
  expect_near(*fit.friction, f);
  expect_near(fit.modes[0].decay, s);
  EXPECT_TRUE(fit.noise_only());
  EXPECT_GT(fit.friction_bic, 10.0);
  // Without the friction the misfit shows.
  data.friction = false;
  EXPECT_FALSE(fit_ring_down(data).noise_only());
}

TEST(RingDown, OneFrequencyDoesNotSeparate) {
  const DampingSplit split =
      split_damping(std::vector<DecayOfMode>{{300.0, 1.0, {2.0, 0.1}}, {310.0, 1.0, {2.0, 0.1}}});
  EXPECT_FALSE(split.separated);
  EXPECT_THAT(split.statement, HasSubstr("split is not"));
  EXPECT_NEAR(split.mass_rate.value, 4.0, 1e-12);
  EXPECT_NEAR(split.bending_time.value, 4.0 / (305.0 * 305.0), 1e-2 * 4.0 / (305.0 * 305.0));
  EXPECT_THAT(split_damping(std::vector<DecayOfMode>{}).statement, HasSubstr("nothing is known"));
}

// One wire that decays by 6.0 and by 1.6 1/s at one frequency, as where a mount gives in one direction only.
// Whichever has the higher frequency, no damping of (M.4) gives both.
TEST(RingDown, DecaysAtOneFrequencyThatContradictEachOther) {
  for (const double step : {-0.3, 0.3}) {
    const DampingSplit split =
        split_damping(std::vector<DecayOfMode>{{691.0, 1.0, {3.0, 0.01}}, {691.0 + step, 1.0, {0.8, 0.003}}});
    EXPECT_LT(split.misfit_p, 1e-10) << step;
    EXPECT_EQ(split.misfit_dof, 1) << step;
    EXPECT_THAT(split.statement, HasSubstr("contradict each other: 2 s from 1.6 to 6 1/s")) << step;
    ASSERT_EQ(split.warnings.size(), 1u);
    EXPECT_LE(split.mass_rate.lower(), 1.6) << step;
    EXPECT_GE(split.mass_rate.upper(), 6.0) << step;
    EXPECT_GE(split.bending_time.upper(), 6.0 / (691.0 * 691.0)) << step;
  }
}

// Two polarisations of one wire in one record, 0.8 Hz apart: their errors are correlated, and they contradict
// each other.
TEST(RingDown, ModesOfOneRecordThatContradictEachOther) {
  RingDownFile file;
  file.series.push_back(
      {modal_sum({{110.0, 3.0, 1e-3, 0.0}, {110.8, 0.8, 8e-4, 0.0}}, 3.0, 1500, 1e-5, 8), {}});
  const RingDownFit fit = fit_ring_down(file.series[0].data);
  ASSERT_EQ(fit.modes.size(), 2u);
  expect_near(fit.modes[0].decay, 3.0);
  expect_near(fit.modes[1].decay, 0.8);
  const DampingSplit split = split_damping(match_modes(file, {fit}));
  EXPECT_LT(split.misfit_p, 1e-10);
  EXPECT_FALSE(split.warnings.empty());
  EXPECT_GE(split.mass_rate.upper(), 6.0);
}

// Three decays at nearly one frequency and three over a decade, which follow the law: of 400 sets each 5 %
// have a P below 0.05 where no number is near zero; a binomial's 3 standard deviations are 3.3 %. Without
// material damping the test is cautious, never lenient.
TEST(RingDown, MisfitOfDecaysThatFollowTheLawIsUniform) {
  std::mt19937 random(12);
  std::normal_distribution<double> normal(0.0, 1.0);
  const auto share_below = [&](double bending_time, double mass_rate, double spacing) {
    int below = 0;
    for (int set = 0; set < 400; ++set) {
      std::vector<DecayOfMode> decays;
      for (int m = 0; m < 4; ++m) {
        const double w = 300.0 * std::pow(spacing, m);
        const double s = 0.5 * (mass_rate + bending_time * w * w);
        decays.push_back({w, 1.0, {s * (1.0 + 0.02 * normal(random)), 0.02 * s}});
      }
      below += split_damping(decays).misfit_p < 0.05 ? 1 : 0;
    }
    return below / 400.0;
  };
  EXPECT_NEAR(share_below(1e-5, 2.0, 2.0), 0.05, 0.033);
  EXPECT_LT(share_below(0.0, 2.0, 1.01), 0.083);
  EXPECT_LT(share_below(1e-5, 0.0, 1.01), 0.083);
}

// A line that needs negative damping is no answer, although two decays always lie on one.
TEST(RingDown, NegativeDampingIsAContradiction) {
  const DampingSplit split =
      split_damping(std::vector<DecayOfMode>{{100.0, 1.0, {3.0, 0.02}}, {300.0, 1.0, {1.0, 0.02}}});
  EXPECT_TRUE(split.separated);
  EXPECT_LT(split.misfit_p, 1e-10);
  EXPECT_GE(split.bending_time.value, 0.0);
  EXPECT_LE(split.mass_rate.lower(), 2.0);
  EXPECT_GE(split.mass_rate.upper(), 6.0);
}

TEST(RingDown, SaysWhenTheLawDoesNotFit) {
  // A decay that rises with w, not with w^2.
  const DampingSplit split = split_damping(std::vector<DecayOfMode>{
      {100.0, 1.0, {1.0, 0.02}}, {300.0, 1.0, {3.0, 0.02}}, {900.0, 1.0, {9.0, 0.02}}});
  EXPECT_TRUE(split.separated);
  EXPECT_LT(split.misfit_p, 1e-3);
  EXPECT_THAT(split.statement, HasSubstr("do not lie on one line"));
  // All material: the mass-proportional part is not different from zero.
  const DampingSplit material =
      split_damping(std::vector<DecayOfMode>{{100.0, 1.0, {0.5, 0.05}}, {300.0, 1.0, {4.5, 0.05}}});
  EXPECT_THAT(material.statement, HasSubstr("mass_rate is not different from zero, at most"));
  EXPECT_NEAR(material.bending_time.value, 1e-4, 1e-12);
  // Known tension: only half of the stiffness bends.
  const DampingSplit half =
      split_damping(std::vector<DecayOfMode>{{100.0, 0.5, {0.25, 0.05}}, {300.0, 0.5, {2.25, 0.05}}});
  EXPECT_NEAR(half.bending_time.value, 1e-4, 1e-12);
}

wire::WireSpecification steel_wire(double length) {
  wire::WireSpecification w;
  w.diameter = 1.5e-3;
  w.length = length;
  w.youngs_modulus = 193e9;
  w.poisson_ratio = 0.29;
  w.density = 7930.0;
  return w;
}

/// Displacement of a vertex along y of the full wire, damped, from its rest with the given velocities.
RingDown full_wire(const wire::RodInMotion& rod, const Eigen::Matrix3Xd& velocities, int vertex,
                   double duration, double tolerance) {
  coupling::Motion motion;
  motion.wires.push_back({"wire", rod, coupling::resting_wire(rod), velocities});
  coupling::MotionOptions options;
  options.duration = duration;
  options.output_interval = 1e-4;
  options.relative_tolerance = tolerance;  // of coordinates up to 0.1 m, not of the swing
  options.position_tolerance = 1e-10;
  options.velocity_tolerance = 1e-6;
  options.max_order = 5;
  std::vector<double> t;
  std::vector<double> x;
  const coupling::MotionResult result =
      coupling::simulate(motion, options, [&](const coupling::MotionSample& s) {
        t.push_back(s.time);
        x.push_back(s.wires[0](1, vertex));
        return false;
      });
  EXPECT_TRUE(result.report.usable()) << result.report.message;
  RingDown data;
  data.time = Eigen::Map<Eigen::VectorXd>(t.data(), static_cast<Eigen::Index>(t.size()));
  data.displacement = Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  data.modes = 2;
  return data;
}

// The full wire between clamps, straight, in its first two modes; the finder knows nothing of it.
TEST(RingDown, RecoversTheDampingOfTheFullWire) {
  const double time = 2e-5;
  const double rate = 8.0;
  wire::RodInMotion rod = wire::rod_in_motion(steel_wire(0.175), 0.175, 24);
  rod.damping = {time, 1e-6, rate};
  Eigen::Matrix3Xd v = Eigen::Matrix3Xd::Zero(3, rod.elements + 1);
  for (int i = 1; i < rod.elements; ++i) {
    double share = 0.02;
    for (const double b : {4.730040744862704, 7.853204624095838}) {
      const double x = b * i / rod.elements;
      const double ratio = (std::cosh(b) - std::cos(b)) / (std::sinh(b) - std::sin(b));
      v(1, i) += share * (std::cosh(x) - std::cos(x) - ratio * (std::sinh(x) - std::sin(x)));
      share = 0.01;
    }
  }
  const RingDownFit fit = fit_ring_down(full_wire(rod, v, 8, 0.06, 1e-6));
  ASSERT_EQ(fit.modes.size(), 2u);
  std::vector<DecayOfMode> decays;
  for (const RingDownMode& m : fit.modes) decays.push_back({m.natural(), 1.0, m.decay});
  const DampingSplit split = split_damping(decays);
  EXPECT_TRUE(split.separated);
  // Free of noise: what is left is the integrator's error, and the swing's own nonlinearity at 0.01 mm.
  EXPECT_NEAR(split.bending_time.value, time, 0.01 * time);
  EXPECT_NEAR(split.mass_rate.value, rate, 0.05 * rate);
}

// A loose wire: its modes bend and stretch against a prestress, so that only the computed shares give the
// damping back.
TEST(RingDown, RecoversTheDampingOfALooseWire) {
  const double time = 2e-5;
  const double rate = 8.0;
  wire::RodInMotion rod = wire::rod_in_motion(steel_wire(0.180), 0.175, 60);
  const Eigen::Matrix3Xd rest = coupling::resting_wire(rod);
  std::vector<wire::RodMode> inside;  // of the plane
  for (const wire::RodMode& m : wire::rod_modes(rod, rest, 12)) {
    if (m.shape.row(1).cwiseAbs().maxCoeff() > 0.5) inside.push_back(m);
  }
  ASSERT_GE(inside.size(), 2u);
  rod.damping = {time, time, rate};
  const RingDown data = full_wire(rod, 0.03 * inside[0].shape + 0.03 * inside[1].shape, 20, 0.03, 1e-8);
  RingDownFile file;
  file.wire.emplace();
  file.wire->wire = steel_wire(0.180);
  file.wire->mount.span = 0.175;
  file.series.push_back({data, {}});
  const RingDownFit fit = fit_ring_down(data);
  const std::vector<MatchedMode> modes = match_modes(file, {fit});
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_GT(modes[0].decay.bending_share, 1.05);  // the compression takes stiffness away
  EXPECT_NEAR(modes[0].computed, modes[0].decay.natural, 2e-3 * modes[0].computed);
  const DampingSplit split = split_damping(modes);
  EXPECT_TRUE(split.separated);
  EXPECT_NEAR(split.bending_time.value, time, 0.02 * time);
  EXPECT_NEAR(split.mass_rate.value, rate, 0.1 * rate);
}

class RingDownFileTest : public test::FolderFixture {
 protected:
  RingDownFileTest() {
    const RingDown data = modal_sum({{20.0, 1.0, 1e-3, 0.0}}, 1.0, 100, 1e-5, 2);
    std::ofstream csv(path("good.csv"));
    csv << "time_s,displacement_mm\n";
    for (Eigen::Index i = 0; i < 100; ++i) csv << data.time[i] << ',' << 1e3 * data.displacement[i] << '\n';
    write("still.csv", "time_s,displacement_mm\n" + still());
    write("short.csv", "time_s,displacement_mm\n0,1\n1,2\n");
    write("columns.csv", "time_s,force_N\n0,1\n");
    write("words.csv", "time_s,displacement_mm\n0,one\n");
    write("back.csv", "time_s,displacement_mm\n1,1\n0,2\n");
  }
  static std::string still() {
    std::string rows;
    for (int i = 0; i < 30; ++i) rows += std::to_string(i) + ",1.5\n";
    return rows;
  }
  std::string message_of(const std::string& text) {
    return test::refusal([&] { return read_ring_down_file(write("x.toml", text)); });
  }
};

TEST_F(RingDownFileTest, IsReadAndChecked) {
  const std::string head = "schema = \"snare-ringdown/1\"\ntitle = \"t\"\n";
  const std::string series = head + "[[series]]\nname = \"a\"\n";
  EXPECT_EQ(message_of(series +
                       "file = \"good.csv\"\nmodes = 1\nbending_share = [0.9]\nfrom_s = 3.0\nto_s = 3.9\n"),
            "accepted");
  const std::pair<std::string, const char*> wrong[] = {
      {"title = \"t\"\n", "schema, missing"},
      {head, "must have at least one [[series]]"},
      {series, "x.toml:3: series[a].file, missing"},
      {series + "file = \"none.csv\"\n", "must be a CSV file beside this one"},
      {series + "file = \"columns.csv\"\n", "displacement_mm"},
      {series + "file = \"words.csv\"\n", "words.csv:2"},
      {series + "file = \"back.csv\"\n", "back.csv:3"},
      {series + "file = \"short.csv\"\n", "has 2 readings, must have at least 20"},
      {series + "file = \"still.csv\"\n", "does not move"},
      {series + "file = \"good.csv\"\nmodes = 0\n", "series[a].modes = 0, must be an integer >= 1 and <= 6"},
      {series + "file = \"good.csv\"\nmodes = 1.5\n", "series[a].modes = 1.5"},
      {series + "file = \"good.csv\"\nbending_share = [-1.5]\n", "bending_share"},
      {series + "file = \"good.csv\"\nbending_share = [0.5, 0.5]\n", "must not have more numbers than modes"},
      {series + "file = \"good.csv\"\nfrom_s = 2.0\nto_s = 1.0\n", "must be > from_s"},
      {series + "file = \"good.csv\"\nto_s = -1.0\n", "has no reading from from_s to to_s"},
      {series + "file = \"good.csv\"\nfrom_s = 3.95\n", "readings, must have at least 20"},
      {series + "file = \"good.csv\"\n[wire]\nlength_mm = 1.0\n", "wire.diameter_mm, missing"},
      {series + "file = \"good.csv\"\n[mount]\nkind = \"supports\"\n", "must be \"clamped\" or \"pinned\""},
      {series + "file = \"good.csv\"\nfrequncy = 1\n", "frequncy"},
      {series + "file = \"good.csv\"\n[[series]]\nname = \"a\"\nfile = \"good.csv\"\n",
       "is taken by another series"},
  };
  for (const auto& [text, message] : wrong) EXPECT_THAT(message_of(text), HasSubstr(message)) << text;
}

TEST_F(RingDownFileTest, ShippedExampleIsRecovered) {
  const RingDownFile file =
      read_ring_down_file(std::filesystem::path(SNARE_SOURCE_DIR) / "data/experiments/ringdown.toml");
  std::vector<RingDownFit> fits;
  for (const RingDownSeries& s : file.series) fits.push_back(fit_ring_down(s.data));
  const DampingSplit split = split_damping(match_modes(file, fits));
  // As the file's head says how it was made.
  expect_near(split.bending_time, 1e-5);
  expect_near(split.mass_rate, 5.0);
}

}  // namespace
}  // namespace snare::identification
