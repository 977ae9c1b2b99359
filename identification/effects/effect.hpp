#pragma once

#include "identification/fitting/least_squares.hpp"
#include "identification/fitting/model.hpp"

#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// Where in the experiment an effect sits.
enum class Channel { wire, mount, contact, pusher, sensor, geometry };
[[nodiscard]] std::string to_string(Channel channel);

/// A number of an effect with the range in which it makes physical sense, in the number's unit.
struct EffectNumber {
  Parameter parameter;
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

/// An effect that a declared model may lack. Every effect is one file, identification/effects/<name>.cpp,
/// which says what it is, which numbers it has, what they may be and how they enter the model (see
/// Parameter); the physics lives where it belongs (wire, coupling, prediction). The list is in catalogue.cpp.
struct Effect {
  std::string name{};
  Channel channel{};
  std::string meaning{};  ///< what happens, for a test engineer
  std::vector<EffectNumber> numbers{};
  bool one_sided = false;  ///< the first number can only grow from its null value
  /// Coordinates of the numbers at which to try an effect that has no derivative at null; none: it has one.
  std::vector<std::vector<double>> (*trials)(const TrialContext&) = nullptr;
  /// Coordinates of the first number, other than its null value, at which refits start; null: the effect is
  /// nearly linear.
  std::vector<double> (*sizes)(const PushProblem& declared) = nullptr;
  /// Why these series cannot show the effect; empty when they may.
  std::string (*unobservable)(const std::vector<Series>&) = nullptr;
  std::string independent_check{};  ///< a measurement that settles the effect by itself
};

/// For Effect::unobservable: a wire that rests on supports is not held by mounts.
[[nodiscard]] std::string needs_mounts(const std::vector<Series>& series);

/// A spring's compliance [m/N] or [rad/(N m)] in place of its stiffness; 0 for a rigid mount.
[[nodiscard]] double compliance(const std::optional<double>& stiffness);
void set_compliance(std::optional<double>& stiffness, double value);
/// For Effect::unobservable: no record has times.
[[nodiscard]] std::string needs_times(const std::vector<Series>& series);
/// The same: no record turns back.
[[nodiscard]] std::string needs_unloading(const std::vector<Series>& series);
/// The same: only published fits, no readings of sensors.
[[nodiscard]] std::string needs_readings(const std::vector<Series>& series);

}  // namespace snare::identification
