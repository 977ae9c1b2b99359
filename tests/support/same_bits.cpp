#include "tests/support/same_bits.hpp"

#include <gtest/gtest.h>

namespace snare::test {

using coupling::MotionResult;
using coupling::MotionSample;
using coupling::MotionState;

std::vector<double> numbers(const coupling::MotionSample& s) {
  std::vector<double> list{s.time, s.energy.kinetic, s.energy.strain, s.energy.dissipated,
                           s.energy.integrator};
  for (const auto& b : s.bodies) {
    for (int k = 0; k < 3; ++k)
      list.insert(list.end(), {b.position[k], b.velocity[k], b.spin[k], b.orientation.vec()[k]});
  }
  for (const auto& c : s.contacts)
    list.insert(list.end(), {c.normal_force, c.gap, c.arc, c.force.x(), c.force.y()});
  for (const auto& w : s.wires) list.insert(list.end(), w.data(), w.data() + w.size());
  return list;
}

std::vector<MotionState> expect_same_bits_from_checkpoints(const coupling::Motion& motion,
                                                           const coupling::MotionOptions& options) {
  std::vector<std::vector<double>> whole;
  std::vector<MotionState> states;
  const MotionResult through = simulate(
      motion, options,
      [&](const MotionSample& s) {
        whole.push_back(numbers(s));
        return false;
      },
      nullptr, [&](const MotionState& s) { states.push_back(s); });
  EXPECT_TRUE(through.report.usable()) << through.report.message;
  EXPECT_EQ(through.events.empty(), motion.contact_names().empty());
  EXPECT_FALSE(states.empty());
  for (const MotionState& from : states) {
    std::vector<std::vector<double>> parts(whole.begin(), whole.begin() + from.sums.samples);
    const MotionResult on = simulate(
        motion, options,
        [&](const MotionSample& s) {
          parts.push_back(numbers(s));
          return false;
        },
        &from);
    EXPECT_TRUE(on.report.usable()) << on.report.message;
    EXPECT_EQ(parts, whole) << "from " << from.time << " s";
    EXPECT_EQ(on.last.unknowns, through.last.unknowns);
    EXPECT_EQ(on.last.integrals, through.last.integrals);
    EXPECT_EQ(on.last.memory, through.last.memory);
    EXPECT_EQ(on.statistics.steps, through.statistics.steps);
    EXPECT_EQ(on.events.size(), through.events.size());
    EXPECT_EQ(on.largest_penetration, through.largest_penetration);
    EXPECT_EQ(on.peak_force, through.peak_force);
    for (std::size_t w = 0; w < through.left_out.size(); ++w) {
      EXPECT_EQ(on.left_out[w].kinetic, through.left_out[w].kinetic);
      EXPECT_EQ(on.left_out[w].force, through.left_out[w].force);
    }
  }
  return states;
}

}  // namespace snare::test
