#pragma once

#include "scenario/swings.hpp"
#include "scenario/world.hpp"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace snare::results {

/// What a motion with wires has given.
struct MotionRecord {
  std::vector<coupling::MotionSample> samples;
  coupling::MotionResult result;
};

/// A motion and what it has given; a view of both.
struct FinishedMotion {
  const scenario::NamedMotion& asked;
  const std::vector<coupling::MotionSample>& samples;
  const coupling::MotionResult& result;
};

/// Of the first runs of a scenario, as many as have records.
[[nodiscard]] std::vector<FinishedMotion> finished_motions(const scenario::WireMotions& motions,
                                                           const std::vector<MotionRecord>& records);

/// Whether a signal has left a part of the motions undone.
[[nodiscard]] bool left_undone(const std::vector<scenario::NamedMotion>& motions,
                               const std::vector<MotionRecord>& records);

/// The energies of a motion by their names in the results.
inline constexpr std::pair<const char*, double coupling::EnergyBalance::*> energies[] = {
    {"kinetic", &coupling::EnergyBalance::kinetic},     {"strain", &coupling::EnergyBalance::strain},
    {"potential", &coupling::EnergyBalance::potential}, {"dissipated", &coupling::EnergyBalance::dissipated},
    {"work", &coupling::EnergyBalance::work},           {"integrator", &coupling::EnergyBalance::integrator}};

/// How often a contact closed.
struct Touches {
  int count = 0;
  std::optional<double> first, last_lift_off;  ///< [s]; none: never
};
/// contact: index; springs count on after the contacts, pairs of wires after these.
[[nodiscard]] Touches touches_of(const coupling::MotionResult& result, std::size_t contact);

/// Most points of a contact that were closed at a sample.
[[nodiscard]] std::size_t most_points(const FinishedMotion& run, std::size_t contact);

/// Of the joint whose swings are told; none where nobody asks.
[[nodiscard]] std::vector<scenario::Swing> swings_of(const scenario::WireMotions& motions,
                                                     const FinishedMotion& run);

/// Simulated over wall time [-]; 0 where no time has passed.
[[nodiscard]] double real_time_factor(const coupling::MotionResult& result);

}  // namespace snare::results
