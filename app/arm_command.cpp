#include "app/arm_command.hpp"

#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "base/one_line.hpp"
#include "base/toml_reader.hpp"
#include "base/units.hpp"
#include "multibody/arm/arm_file.hpp"
#include "multibody/dynamics.hpp"
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
    sound =
        error == std::errc() && (stopped == end || *stopped == ',') && found < count && std::isfinite(value);
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

nlohmann::json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

/// The mass matrix of all that moves, without the motors, at coordinates q; `names` are those of the joints
/// by the bodies that they carry, a free body has its own name.
nlohmann::json mass_matrix_of(const multibody::Tree& tree, const Eigen::VectorXd& q,
                              const std::vector<std::string>& names) {
  constexpr const char* of_free[] = {".spin_x",     ".spin_y",     ".spin_z",
                                     ".velocity_x", ".velocity_y", ".velocity_z"};
  nlohmann::json joints = nlohmann::json::array(), rows = nlohmann::json::array();
  for (int i = 0; i < tree.size(); ++i) {
    const std::string& name = names[static_cast<std::size_t>(i)];
    if (tree.body(i).joint != multibody::JointKind::free) {
      joints.push_back(name);
    } else {
      for (const char* part : of_free) joints.push_back(name + part);
    }
  }
  multibody::DynamicsWorkspace workspace(tree);
  const Eigen::MatrixXd& matrix = multibody::mass_matrix(tree, q, workspace);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    rows.push_back(nlohmann::json::array());
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) rows.back().push_back(matrix(i, k));
  }
  return {{"joints", joints}, {"rows", rows}};
}

std::vector<std::string> body_names(const multibody::Tree& tree) {
  std::vector<std::string> names;
  for (const multibody::TreeBody& body : tree.bodies()) names.push_back(body.name);
  return names;
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
  std::vector<std::string> names = body_names(tree);
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
         {"drive", drive_modes[static_cast<std::size_t>(arm.drives[static_cast<std::size_t>(k)].mode)]},
         {"servo_limit_Nm", finite_or_null(arm.drives[static_cast<std::size_t>(k)].limit)}});
    // Flexures come behind the joints of the URDF.
    const bool has = static_cast<std::size_t>(k) < arm.joints.size();
    result["joints"].back()["urdf_effort_Nm"] =
        has ? finite_or_null(arm.joints[static_cast<std::size_t>(k)].effort) : nlohmann::json();
    result["joints"].back()["urdf_velocity_rad_s"] =
        has ? finite_or_null(arm.joints[static_cast<std::size_t>(k)].speed) : nlohmann::json();
    names[static_cast<std::size_t>(joint.body)] = joint.name;
  }
  result["mass_matrix"] = mass_matrix_of(tree, q, names);
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

/// What becomes of the <limit> of a URDF's joints: the effort is that of a servo without a limit of its own,
/// no drive limits the speed.
std::string limits_of_urdf(const nlohmann::json& joints) {
  std::string text;
  for (const nlohmann::json& joint : joints) {
    const nlohmann::json &effort = joint["urdf_effort_Nm"], &speed = joint["urdf_velocity_rad_s"];
    if (effort.is_null() && speed.is_null()) continue;
    const bool servo = joint["drive"] == "servo";
    const bool used = servo && joint["servo_limit_Nm"] == effort;
    text += fmt::format("<limit> of {}:", joint["joint"].get<std::string>());
    if (!effort.is_null())
      text += fmt::format(" effort {:.4g} N m {}", effort.get<double>(),
                          used                                ? "is the limit of its servo"
                          : !servo                            ? "not used (no servo)"
                          : joint["servo_limit_Nm"].is_null() ? "is no limit"
                                                              : "not used (limit_Nm of the arm file)");
    if (!speed.is_null())
      text +=
          fmt::format("{} velocity {:.4g} rad/s not used", effort.is_null() ? "" : ",", speed.get<double>());
    text += "\n";
  }
  return text;
}

std::string listed(const nlohmann::json& values) {
  std::string text;
  for (const nlohmann::json& value : values)
    text += (text.empty() ? "" : ", ") + fmt::format("{:.4g}", value.get<double>());
  return text.empty() ? "none" : text;
}

/// At zero of all joints, the root held.
nlohmann::json mass_matrix_of(multibody::RobotDescription robot) {
  const auto other_name = [](std::string& name) {
    if (name == "world") name = "world link";  // the tree has a world already
  };
  for (multibody::RobotLink& link : robot.links) other_name(link.name);
  for (multibody::RobotJoint& joint : robot.joints) {
    other_name(joint.parent);
    other_name(joint.child);
  }
  multibody::Tree tree;
  multibody::add_robot(tree, 0, multibody::RootJoint::fixed, robot);
  std::vector<std::string> names = body_names(tree);
  for (const multibody::RobotJoint& joint : robot.joints) {
    if (joint.kind)
      names[static_cast<std::size_t>(tree.frame(tree.find_frame(joint.child)).body)] = joint.name;
  }
  return mass_matrix_of(tree, multibody::zero_state(tree).q, names);
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
    result["joints"].push_back(
        {{"joint", joint.name},
         {"kind", joint.kind ? joint_kinds[static_cast<std::size_t>(*joint.kind)] : "fixed"},
         {"from", joint.parent},
         {"link", joint.child},
         {"length_m", joint.X_PJ.p.norm()},
         {"link_mass_kg", robot.links[k + 1].inertia.mass},
         {"effort_Nm", finite_or_null(joint.effort)},
         {"velocity_rad_s", finite_or_null(joint.speed)},
         {"damping_Nms_rad", joint.damping},
         {"friction_Nm", joint.friction}});
  }
  result["mass_matrix"] = mass_matrix_of(robot);
  for (const std::string& warning : robot.warnings) console.warn(warning);
  if (options.json) {
    print_result(result);
    return ExitStatus::done;
  }
  std::string text = fmt::format(
      "{}: a robot description of {} links, {:.6g} kg, root {}\n{:<18}{:<12}{:<22}{:<22}{:>11}{:>11}\n",
      robot.name, robot.links.size(), mass, robot.root, "joint", "kind", "from", "link", "length [m]",
      "mass [kg]");
  for (const nlohmann::json& joint : result["joints"]) {
    text += fmt::format("{:<18}{:<12}{:<22}{:<22}{:>11.4g}{:>11.2f}\n", joint["joint"].get<std::string>(),
                        joint["kind"].get<std::string>(), joint["from"].get<std::string>(),
                        joint["link"].get<std::string>(), joint["length_m"].get<double>(),
                        joint["link_mass_kg"].get<double>());
  }
  for (const nlohmann::json& joint : result["joints"]) {
    const double damping = joint["damping_Nms_rad"], friction = joint["friction_Nm"];
    if (damping > 0.0 || friction > 0.0)
      text += fmt::format("<dynamics> of {}: damping {:.4g} N m s/rad, friction {:.4g} N m\n",
                          joint["joint"].get<std::string>(), damping, friction);
  }
  text +=
      "Stiffness, drives and natural frequencies: `snare arm show` of an arm file that names this one, see "
      "docs/arm_files.md\n";
  print(text);
  return ExitStatus::done;
}

}  // namespace

ExitStatus run_arm_show(const std::filesystem::path& file, const std::string& pose,
                        const CommonOptions& options, Console& console) {
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
  std::string text = fmt::format(
      "{}\narm {:.6g} kg, all that moves {:.6g} kg; reach {:.4g} m; tip at {:.4g}, {:.4g}, {:.4g} m\n",
      base::visible(arm.title), result["arm_mass_kg"].get<double>(), result["moving_mass_kg"].get<double>(),
      result["reach_m"].get<double>(), result["tip_m"][0].get<double>(), result["tip_m"][1].get<double>(),
      result["tip_m"][2].get<double>());
  text += fmt::format("{:<18}{:<22}{:>9}{:>11}{:>14}{:>26}  {}\n", "joint", "link", "angle", "mass [kg]",
                      "motor [kg m2]", "stiffness [N m/rad]", "drive");
  for (const nlohmann::json& joint : result["joints"]) {
    const double first = joint["stiffness_first_Nm_rad"], outer = joint["stiffness_outer_Nm_rad"];
    text += fmt::format(
        "{:<18}{:<22}{:>5.1f} deg{:>11.2f}{:>14.4g}{:>26}  {}\n", joint["joint"].get<std::string>(),
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
  text += limits_of_urdf(result["joints"]);
  text +=
      fmt::format("natural frequencies [Hz]\n  motors locked  {}\n", listed(result["frequencies_locked_Hz"]));
  if (result.contains("frequencies_locked_large_deflection_Hz")) {
    text += fmt::format("  the same, large deflections  {}\n",
                        listed(result["frequencies_locked_large_deflection_Hz"]));
  }
  text += fmt::format("  as driven      {}\n  limp           {}\n", listed(result["frequencies_driven_Hz"]),
                      listed(result["frequencies_limp_Hz"]));
  print(text);
  return ExitStatus::done;
}

}  // namespace snare::app
