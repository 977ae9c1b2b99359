#pragma once

#include "identification/fitting/least_squares.hpp"
#include "identification/fitting/model.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace snare::identification {

/// Where in the experiment an effect sits.
enum class Channel { wire, mount, contact, pusher, sensor, geometry };
[[nodiscard]] std::string to_string(Channel channel);

/// A number of an effect with the range in which it makes physical sense, in the number's unit.
struct EffectNumber {
  std::string key;
  double plausible_lower = 0.0;
  double plausible_upper = 0.0;
  bool optional = false;  ///< stays at its usual value unless a trial gives another
};

/// What the fitted base model says of the experiment, for the choice of trial values. SI units.
struct TrialContext {
  const Model* model = nullptr;
  double highest_tension = 0.0;      ///< in the wire, at its left mount
  double highest_compression = 0.0;  ///< >= 0
  double highest_curvature = 0.0;    ///< estimate, of the bent wire
  double bending_stiffness = 0.0;    ///< as fitted
  double axial_stiffness = 0.0;
};

/// An effect that a declared model may lack. Every effect is one file, effect_<name>.cpp, which describes it; the
/// physics lives where it belongs (wire, coupling, prediction), reached through the effect's numbers (see Parameter).
struct Effect {
  std::string name;
  Channel channel{};
  std::string meaning;  ///< what happens, for a test engineer
  std::vector<EffectNumber> numbers;
  bool one_sided = false;  ///< the first number can only grow from its null value
  /// Coordinates of the numbers at which to try an effect that has no derivative at null; none: it has one.
  std::vector<std::vector<double>> (*trials)(const TrialContext&) = nullptr;
  /// Why these series cannot show the effect; empty when they may.
  std::string (*unobservable)(const std::vector<Series>&) = nullptr;
  std::string independent_check;  ///< a measurement that settles the effect by itself
};

/// Every effect, in the order in which equals are listed.
[[nodiscard]] const std::vector<Effect>& catalogue();

/// Null when there is none of this name.
[[nodiscard]] const Effect* find_effect(std::string_view name);

/// For Effect::unobservable: a wire that rests on supports is not held by mounts.
[[nodiscard]] std::string needs_mounts(const std::vector<Series>& series);

// One a file.
[[nodiscard]] Effect bending_stiffness_effect();
[[nodiscard]] Effect axial_stiffness_effect();
[[nodiscard]] Effect wire_length_effect();
[[nodiscard]] Effect span_effect();
[[nodiscard]] Effect contact_position_effect();
[[nodiscard]] Effect push_misalignment_effect();
[[nodiscard]] Effect mount_slip_effect();
[[nodiscard]] Effect mount_axial_compliance_effect();
[[nodiscard]] Effect mount_rotational_compliance_effect();
[[nodiscard]] Effect contact_friction_effect();
[[nodiscard]] Effect pusher_compliance_effect();
[[nodiscard]] Effect displacement_offset_effect();
[[nodiscard]] Effect force_offset_effect();
[[nodiscard]] Effect force_gain_effect();
[[nodiscard]] Effect natural_curvature_effect();
[[nodiscard]] Effect strand_hysteresis_effect();
[[nodiscard]] Effect plasticity_effect();
[[nodiscard]] Effect gravity_effect();
[[nodiscard]] Effect rate_viscosity_effect();

}  // namespace snare::identification
