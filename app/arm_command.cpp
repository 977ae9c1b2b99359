#include "app/arm_command.hpp"

#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "base/one_line.hpp"
#include "base/toml_reader.hpp"
#include "base/units.hpp"
#include "multibody/arm/arm_file.hpp"
#include "results/in_mm.hpp"
#include "scenario/hold.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>
#include <string>

namespace snare::app {

namespace {

using base::degree;

constexpr const char* drive_modes[] = {"locked", "servo", "limp"};  // names of multibody::DriveMode

constexpr const char* joint_kinds[] = {"revolute", "prismatic", "free"};  // names of multibody::JointKind

/// Angles of the elastic joints [rad].
Eigen::VectorXd angles_of(const std::string& pose, const multibody::ArmDescription& arm) {
  const int count = static_cast<int>(arm.joints.size());
  if (pose.empty()) return Eigen::VectorXd::Zero(arm.arm.motors());
  for (const multibody::ArmPose& known : arm.poses) {
    if (known.name == pose) return known.angles;
  }
  Eigen::VectorXd angles(count);
  int found = 0;
  const char* at = pose.data();
  const char* const end = at + pose.size();
  bool sound = true;
  while (sound && at <= end) {
    double value = 0.0;
    const auto [stopped, error] = std::from_chars(at, end, value);
    sound = error == std::errc() && (stopped == end || *stopped == ',') && found < count && std::isfinite(value);
    if (sound) angles[found++] = value * degree;
    at = stopped + 1;
  }
  if (!sound || found != count) {
    std::string names;
    for (const multibody::ArmPose& known : arm.poses) names += (names.empty() ? "" : ", ") + known.name;
    throw base::InputError({"", 0, "--pose", pose,
                            fmt::format("must be {} angles in degrees separated by commas{}", count,
                                        names.empty() ? "" : ", or one of: " + names)});
  }
  return arm.with_flexures(angles);
}

nlohmann::json frequencies(const multibody::ArmDescription& arm, const Eigen::VectorXd& q,
                           const std::vector<multibody::Drive>& drives) {
  nlohmann::json list = nlohmann::json::array();
  for (const multibody::ArmMode& mode : multibody::natural_modes(arm.arm, q, drives)) {
    if (mode.frequency > 0.0) list.push_back(mode.frequency);
  }
  return list;
}

/// Stiffness of the last piece of a joint's law: that of a large deflection [N m/rad].
double outer_stiffness(const multibody::ElasticJoint& joint) {
  return joint.spring.pieces().back().stiffness;
}

nlohmann::json describe(const multibody::ArmDescription& arm, const Eigen::VectorXd& angles) {
  const multibody::Tree& tree = arm.arm.tree;
  const Eigen::VectorXd q = arm.coordinates(angles);
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, q, kinematics);
  const Eigen::Vector3d tip = multibody::frame_pose(tree, kinematics, arm.tip).p;
  nlohmann::json result{{"schema", "snare-arm-show/1"},
                        {"title", arm.title},
                        {"source", arm.source},
                        {"arm_mass_kg", arm.arm_mass},
                        {"moving_mass_kg", tree.mass()},
                        {"reach_m", multibody::reach(arm)},
                        {"tip_m", {tip.x(), tip.y(), tip.z()}},
                        {"joints", nlohmann::json::array()}};
  for (int k = 0; k < arm.arm.motors(); ++k) {
    const multibody::ElasticJoint& joint = arm.arm.joints[static_cast<std::size_t>(k)];
    const multibody::TreeBody& body = tree.body(joint.body);
    result["joints"].push_back(
        {{"joint", joint.name},
         {"link", joint.link},
         {"angle_deg", results::in_degrees(angles[k])},
         {"link_mass_kg", body.inertia.mass},
         {"motor_inertia_kg_m2", joint.motor_inertia},
         {"stiffness_first_Nm_rad", joint.spring.stiffness(0)},
         {"stiffness_outer_Nm_rad", outer_stiffness(joint)},
         {"coulomb_Nm", joint.friction.coulomb},
         {"viscous_Nms_rad", joint.friction.viscous},
         {"drive", drive_modes[static_cast<std::size_t>(arm.drives[static_cast<std::size_t>(k)].mode)]}});
  }
  const std::vector<multibody::Drive> locked(arm.drives.size(), multibody::Drive::locked());
  std::vector<multibody::Drive> limp = arm.drives;
  scenario::hold(scenario::Hold::limp, angles, arm.arm, limp);
  result["warnings"] = arm.warnings;
  result["frequencies_locked_Hz"] = frequencies(arm, q, locked);
  result["frequencies_driven_Hz"] = frequencies(arm, q, arm.drives);
  result["frequencies_limp_Hz"] = frequencies(arm, q, limp);
  multibody::ArmDescription outer = arm;
  bool same = true;
  for (multibody::ElasticJoint& joint : outer.arm.joints) {
    same = same && joint.spring.pieces().size() == 1;
    joint.spring = multibody::DeflectionLaw::linear(outer_stiffness(joint), 0.0);
  }
  if (!same) result["frequencies_locked_large_deflection_Hz"] = frequencies(outer, q, locked);
  return result;
}

std::string listed(const nlohmann::json& values) {
  std::string text;
  for (const nlohmann::json& value : values)
    text += (text.empty() ? "" : ", ") + fmt::format("{:.4g}", value.get<double>());
  return text.empty() ? "none" : text;
}

/// What a robot description says by itself; stiffness and drives, and so the frequencies, are in an arm file.
ExitStatus show_robot(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const multibody::RobotDescription robot = multibody::read_urdf(file);
  double mass = 0.0;
  for (const multibody::RobotLink& link : robot.links) mass += link.inertia.mass;
  nlohmann::json result{
      {"schema", "snare-arm-show/1"}, {"title", robot.name},        {"mass_kg", mass},
      {"root", robot.root},           {"warnings", robot.warnings}, {"joints", nlohmann::json::array()}};
  for (std::size_t k = 0; k < robot.joints.size(); ++k) {
    const multibody::RobotJoint& joint = robot.joints[k];
    result["joints"].push_back({{"joint", joint.name},
                                {"kind", joint.kind ? joint_kinds[static_cast<std::size_t>(*joint.kind)] : "fixed"},
                                {"from", joint.parent},
                                {"link", joint.child},
                                {"length_m", joint.X_PJ.p.norm()},
                                {"link_mass_kg", robot.links[k + 1].inertia.mass}});
  }
  for (const std::string& warning : robot.warnings) console.warn(warning);
  if (options.json) {
    print_result(result);
    return ExitStatus::done;
  }
  std::string text = fmt::format(
      "{}: a robot description of {} links, {:.6g} kg, root {}\n{:<18}{:<12}{:<22}{:<22}{:>11}{:>11}\n", robot.name,
      robot.links.size(), mass, robot.root, "joint", "kind", "from", "link", "length [m]", "mass [kg]");
  for (const nlohmann::json& joint : result["joints"]) {
    text += fmt::format("{:<18}{:<12}{:<22}{:<22}{:>11.4g}{:>11.2f}\n", joint["joint"].get<std::string>(),
                        joint["kind"].get<std::string>(), joint["from"].get<std::string>(),
                        joint["link"].get<std::string>(), joint["length_m"].get<double>(),
                        joint["link_mass_kg"].get<double>());
  }
  text +=
      "Stiffness, drives and natural frequencies: `snare arm show` of an arm file that names this one, see "
      "docs/arm_files.md\n";
  print(text);
  return ExitStatus::done;
}

}  // namespace

ExitStatus run_arm_show(const std::filesystem::path& file, const std::string& pose, const CommonOptions& options,
                        Console& console) {
  const std::vector<base::Override> overrides = overrides_of(options);
  if (file.extension() == ".urdf") {
    if (!pose.empty()) throw base::InputError({"", 0, "--pose", pose, "only with an arm file (TOML)"});
    if (!overrides.empty())
      throw base::InputError({"", 0, "--set", overrides.front().key, "only with an arm file (TOML)"});
    return show_robot(file, options, console);
  }
  const multibody::ArmDescription arm = multibody::read_arm(file, overrides);
  const Eigen::VectorXd angles = angles_of(pose, arm);
  console.progress(fmt::format("natural frequencies of {} joints", arm.arm.motors()));
  const nlohmann::json result = describe(arm, angles);
  console.end_progress();
  begin_writing();
  for (const std::string& warning : arm.warnings) console.warn(warning);
  if (options.json) {
    print_result(result);
    return ExitStatus::done;
  }
  std::string text =
      fmt::format("{}\narm {:.6g} kg, all that moves {:.6g} kg; reach {:.4g} m; tip at {:.4g}, {:.4g}, {:.4g} m\n",
                  base::visible(arm.title), result["arm_mass_kg"].get<double>(), result["moving_mass_kg"].get<double>(),
                  result["reach_m"].get<double>(), result["tip_m"][0].get<double>(), result["tip_m"][1].get<double>(),
                  result["tip_m"][2].get<double>());
  text += fmt::format("{:<18}{:<22}{:>9}{:>11}{:>14}{:>26}  {}\n", "joint", "link", "angle", "mass [kg]",
                      "motor [kg m2]", "stiffness [N m/rad]", "drive");
  for (const nlohmann::json& joint : result["joints"]) {
    const double first = joint["stiffness_first_Nm_rad"], outer = joint["stiffness_outer_Nm_rad"];
    text += fmt::format("{:<18}{:<22}{:>5.1f} deg{:>11.2f}{:>14.4g}{:>26}  {}\n", joint["joint"].get<std::string>(),
                        joint["link"].get<std::string>(), joint["angle_deg"].get<double>(),
                        joint["link_mass_kg"].get<double>(), joint["motor_inertia_kg_m2"].get<double>(),
                        first == outer ? fmt::format("{:.4g}", first) : fmt::format("{:.4g} to {:.4g}", first, outer),
                        joint["drive"].get<std::string>());
  }
  for (const nlohmann::json& joint : result["joints"]) {
    const double dry = joint["coulomb_Nm"], viscous = joint["viscous_Nms_rad"];
    if (dry > 0.0 || viscous > 0.0)
      text += fmt::format("friction of {}: dry {:.4g} N m, viscous {:.4g} N m s/rad\n",
                          joint["joint"].get<std::string>(), dry, viscous);
  }
  text += fmt::format("natural frequencies [Hz]\n  motors locked  {}\n", listed(result["frequencies_locked_Hz"]));
  if (result.contains("frequencies_locked_large_deflection_Hz")) {
    text +=
        fmt::format("  the same, large deflections  {}\n", listed(result["frequencies_locked_large_deflection_Hz"]));
  }
  text += fmt::format("  as driven      {}\n  limp           {}\n", listed(result["frequencies_driven_Hz"]),
                      listed(result["frequencies_limp_Hz"]));
  print(text);
  return ExitStatus::done;
}

}  // namespace snare::app
