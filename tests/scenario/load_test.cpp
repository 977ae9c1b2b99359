// Loads at places of a body: pulses with flanks, in a run of 0.1 s.
#include "scenario/scenario.hpp"

#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace snare::scenario {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::Pointwise;

class Loads : public test::FolderFixture {
 protected:
  coupling::FrameLoad read(const std::string& load) const {
    return read_scenario(write("s.toml", R"(schema = "snare-scenario/2"
title = "a push"
duration_s = 0.1
output_interval_s = 0.01
[[bodies]]
name = "craft"
mass_kg = 5.0
inertia_kg_m2 = [1.0, 2.0, 2.5]
[[loads]]
name = "push"
frame = "craft"
force_N = [2.0, 0.0, 0.0]
)" + load))
        .motions.runs.at(0)
        .motion.loads.at(0);
  }
  static std::vector<double> along(const coupling::FrameLoad& load) {
    const Eigen::VectorXd row = load.forces.row(0);
    return {row.begin(), row.end()};
  }
};

TEST_F(Loads, ToTheEndOfTheRunHaveTheFirstFlankAlone) {
  const coupling::FrameLoad load = read("begin_s = 0.02\nramp_s = 0.03\n");
  EXPECT_THAT(load.times, Pointwise(DoubleNear(1e-15), {0.02, 0.05, 0.1}));
  EXPECT_EQ(along(load), (std::vector{0.0, 2.0, 2.0}));
}

TEST_F(Loads, OfADurationHaveBothFlanks) {
  const coupling::FrameLoad load = read("begin_s = 0.02\nduration_s = 0.08\nramp_s = 0.03\n");
  EXPECT_THAT(load.times, Pointwise(DoubleNear(1e-15), {0.02, 0.05, 0.07, 0.1}));
  EXPECT_EQ(along(load), (std::vector{0.0, 2.0, 2.0, 0.0}));
}

TEST_F(Loads, FlanksMustFit) {
  EXPECT_THAT(test::refusal([&] { return read("begin_s = 0.08\nramp_s = 0.03\n"); }),
              HasSubstr("ramp_s = 0.03, must end before the run"));
  EXPECT_THAT(test::refusal([&] { return read("duration_s = 0.05\nramp_s = 0.03\n"); }),
              HasSubstr("ramp_s = 0.03, must be at most half of duration_s"));
}

}  // namespace
}  // namespace snare::scenario
