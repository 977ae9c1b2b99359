#pragma once

#include "base/toml_reader.hpp"
#include "coupling/contact/contact_law.hpp"
#include "coupling/dynamics/model/law_wire.hpp"
#include "numerics/cubic_spline.hpp"
#include "scenario/distilled_law.hpp"
#include "wire/motion/rod_in_motion.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snare::scenario {

/// What stands for a wire whose mounts stand still to each other, and that a shaft pushes across its chord: a
/// table that was distilled from it, or a law of one place.                                  theory.md (M.27)
struct PushModel {
  double side = 1.0;         ///< of the push: 1 with the bulge, -1 against it [-]
  coupling::ContactLaw law;  ///< of one place; empty: the table
  double position = 0.0;     ///< of that place along the chord, from the first mount [m]
  std::shared_ptr<const DistilledLaw> table;
};

/// The words of `model` that name such laws, each with the table of its numbers.
struct PushModelName {
  std::string_view model, table;
};
[[nodiscard]] const std::vector<PushModelName>& push_models();

/// Where files beside the scenario are, and what stands for the content of those that are read.
struct BesideScenario {
  const std::filesystem::path& folder;
  std::string& input;
};

/// Of the model of this name, from the table of its numbers in a wire's table; nothing after a problem, which
/// is reported.
[[nodiscard]] std::optional<PushModel> read_push_model(const base::TomlTable& wire, std::string_view model,
                                                       const BesideScenario& beside);
/// Reports what is wrong in a table of such numbers that stands beside another model.
void read_numbers(const base::TomlTable& wire, std::string_view model);
/// Reports what does not fit a wire: its span [m], which it is between mounts that stand still to each other.
void check_push_model(const PushModel& push, const wire::RodInMotion& rod, double span,
                      const base::TomlTable& wire);

/// Where a disc of a radius first touches a wire at rest, by its place s along the chord [m]: the height
/// along the push [m].
///   y(s) = min over x of w(x) - sqrt(R^2 - (x - s)^2),  w the wire's height
/// rest: vertices of the wire between mounts at the origin and on the x axis, bulging to y [m]. Throws
/// base::InputError where the wire does not lie over its chord.
[[nodiscard]] numerics::HermiteCurve first_touch(const Eigen::Matrix3Xd& rest, double radius, double side);

/// Puts the law into a wire that has its shaft. rod: in its own frame, as of wire::rod_in_motion. Throws
/// base::InputError where the wire finds no rest.
void set_push_law(const PushModel& push, const wire::RodInMotion& rod, coupling::LawWire& wire);

}  // namespace snare::scenario
