#pragma once

#include "base/toml_reader.hpp"
#include "coupling/statics/push_problem.hpp"
#include "scenario/world.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace snare::scenario {

/// One wire model of a scenario: the full wire, or a law that stands for it.
struct WireModel {
  std::string name;
  std::string kind;               ///< "wire", "quasi_static", or the law's name
  coupling::ContactLaw law = {};  ///< empty: the wire itself
  bool quasi_static = false;      ///< of the wire itself
};

/// A body with a probe that meets a wire between its mounts: scenario of kind "contact" without lists.
struct ContactScenario {
  std::string input;           ///< canonical text of everything that was read: equal for equal scenarios
  coupling::PushProblem push;  ///< wire, mounts, probe (the pusher) and contact position
  wire::RodDamping damping;
  coupling::WireStrength strength;
  double strand_time = wire::RodStrands{}.time;  ///< of a wire with strand friction [s]
  int elements = 60;
  wire::Formulation formulation = wire::Formulation::vertices;
  coupling::MotionBody body;                        ///< at the start; position.y: less its distance to the wire
  Eigen::Vector3d probe = Eigen::Vector3d::Zero();  ///< p_BP of the probe's axis [m]
  coupling::ElasticFoundation foundation;
  coupling::MotionFriction friction;
  std::vector<WireModel> models;  ///< run one after the other
  coupling::MotionOptions options;
  MotionOutput output;
};

/// Reads what is particular to such a scenario and finishes the document.
[[nodiscard]] ContactScenario read_contact(base::TomlDocument& document);

/// Reads a scenario alone; throws InputError with everything that is wrong in it.
[[nodiscard]] ContactScenario read_contact_scenario(const std::filesystem::path& file,
                                                    const std::vector<base::Override>& overrides = {});

/// The motion of one of its models. The world frame has the left mount at its origin, x along the chord, y with the bulge.
[[nodiscard]] coupling::Motion motion_of(const ContactScenario& scenario, const WireModel& model);

/// One run for each of its models. A law that stands for the wire may be zero over the first part of its travel: its steps are
/// limited to a tenth of a millimetre at the speed of the start, so that none leaps over the rest.
[[nodiscard]] WireMotions motions_of(const ContactScenario& scenario);

}  // namespace snare::scenario
