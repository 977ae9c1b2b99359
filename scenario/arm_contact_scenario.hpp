#pragma once

#include "scenario/contact_scenario.hpp"
#include "multibody/arm/arm_file.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace snare::scenario {

/// An arm that carries the wire or the body of a contact scenario: kind "arm_contact".        docs/scenario_file.md
struct ArmContactScenario {
  enum class Carries { wire, body };
  enum class Hold { as_described, limp, locked };

  std::string title, source;
  std::filesystem::path file;
  std::string input;  ///< canonical text of everything that was read: equal for equal scenarios
  ContactScenario contact;  ///< wire, mounts, body with its probe, models, solver
  multibody::ArmDescription arm;
  Eigen::VectorXd angles;  ///< of the arm's joints at the start [rad]
  Carries carries = Carries::wire;
  Hold hold = Hold::as_described;
  /// Of the arm's tip: in the wire's frame (left mount, x along the chord, y with the bulge), or in the body's.
  multibody::Pose X_CT;
};

/// Reads the scenario, and the arm and the contact scenario that it names; throws InputError with everything that is wrong.
/// Overrides whose key begins with "contact." go to the contact scenario.
[[nodiscard]] ArmContactScenario read_arm_contact_scenario(
    const std::filesystem::path& file, const std::vector<base::Override>& overrides = {});

/// The motion of one of its models. The world is the wire's frame at the start; the base of the arm follows from there.
/// An arm that carries the body starts with the joint rates that give its tip the body's motion, as nearly as they can
/// (least squares), its motors alike.
[[nodiscard]] coupling::Motion motion_of(const ArmContactScenario& scenario, const WireModel& model);

}  // namespace snare::scenario
