#include "scenario/arm_reader.hpp"

#include "base/index.hpp"
#include "base/units.hpp"
#include "scenario/arm_scenarios.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace snare::scenario {

using base::Choice;
using base::degree;
using base::Range;
using base::TomlDocument;
using base::TomlTable;

namespace {

enum class Kind { joint_step, tip_impulse, joint_motion };

int read_joint(const TomlTable& root, const multibody::ArmDescription& arm) {
  const std::string name = root.text("joint");
  std::string known;
  for (int j = 0; j < arm.arm.motors(); ++j) {
    const std::string& one = arm.arm.joints[base::at(j)].name;
    if (one == name) return j;
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", one);
  }
  root.fail("joint", "must be an elastic joint of the arm: " + known);
  return 0;
}

// Each of these finishes the document before it composes the motion of what was read.

ArmMotion read_joint_step(TomlDocument& document, const multibody::ArmDescription& arm, const Eigen::VectorXd& angles,
                          double duration) {
  const TomlTable root = document.root();
  static constexpr Choice<bool> ways[] = {{"held", false}, {"commanded", true}};
  const bool commanded = root.has("way") && root.choice("way", ways).value_or(false);
  const int joint = read_joint(root, arm);
  const double step = root.number("step_deg", Range::from(-90.0, 90.0), degree);
  document.finish();
  return {
      commanded ? commanded_step(arm, angles, joint, step, duration) : joint_step(arm, angles, joint, step, duration),
      joint};
}

ArmMotion read_tip_impulse(TomlDocument& document, const multibody::ArmDescription& arm, const Eigen::VectorXd& angles,
                           double duration) {
  const TomlTable root = document.root();
  static constexpr Choice<Hold> answers[] = {{"as_described", Hold::as_described}, {"limp", Hold::limp}};
  const Hold how = root.choice("hold", answers).value_or(Hold::as_described);
  const auto impulse = read_vector(root, "impulse_Ns", Range::from(-1e9, 1e9), 1.0);
  const double pulse = root.number("pulse_s", Range::above(0.0, 1e5));
  document.finish();
  return {tip_impulse(arm, angles, how, impulse.value(), pulse, duration)};
}

ArmMotion read_joint_motion(TomlDocument& document, const multibody::ArmDescription& arm, const Eigen::VectorXd& angles,
                            double duration) {
  const TomlTable root = document.root();
  const Eigen::VectorXd to = read_pose(root, "to_pose", "to_angles_deg", arm);
  const double course = root.number_or("course_s", duration, Range::above(0.0, 1e6));
  document.finish();
  return {joint_motion(arm, angles, to, course, duration)};
}

}  // namespace

std::optional<multibody::ArmDescription> read_arm_beside(TomlDocument& document, const std::filesystem::path& folder) {
  const std::string name = document.root().text("arm");
  if (name.empty()) return std::nullopt;
  return base::read_beside(document, [&] { return multibody::read_arm(folder / name); });
}

Eigen::VectorXd read_pose(const TomlTable& root, std::string_view name_key, std::string_view angles_key,
                          const multibody::ArmDescription& arm) {
  const Eigen::Index n = arm.arm.motors();
  Eigen::VectorXd angles = Eigen::VectorXd::Zero(n);
  if (root.has(angles_key)) {
    if (root.has(name_key)) root.fail(angles_key, fmt::format("cannot stand beside {}", name_key));
    const auto count = static_cast<std::size_t>(n);
    const std::vector<double> given = root.numbers(angles_key, count, count, Range::from(-3600.0, 3600.0), degree);
    if (given.size() == count) angles = Eigen::Map<const Eigen::VectorXd>(given.data(), n);
    return angles;
  }
  const std::string name = root.text(name_key);
  const auto at =
      std::find_if(arm.poses.begin(), arm.poses.end(), [&](const multibody::ArmPose& p) { return p.name == name; });
  if (at != arm.poses.end()) return at->angles;
  std::string known;
  for (const multibody::ArmPose& p : arm.poses) known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", p.name);
  root.fail(name_key, "must be a pose of the arm: " + known);
  return angles;
}

ArmMotion read_arm_motion(TomlDocument& document, const std::filesystem::path& folder) {
  const TomlTable root = document.root();
  static constexpr Choice<Kind> kinds[] = {
      {"joint_step", Kind::joint_step}, {"tip_impulse", Kind::tip_impulse}, {"joint_motion", Kind::joint_motion}};
  const Kind kind = root.choice("kind", kinds).value_or(Kind::joint_motion);
  const double duration = root.number("duration_s", durations);
  const double interval = root.number_or("output_interval_s", 0.01, durations);
  check_output_interval(root, duration, interval);
  const TomlTable solver = root.table("solver");
  const double tolerance = solver.number_or("relative_tolerance", 1e-6, Range::from(1e-12, 1e-2));
  const double motion_tolerance = solver.number_or("motion_tolerance", 1e-8, Range::above(0.0, 1e-3));
  const double least = read_least_advance(solver);
  const std::optional<multibody::ArmDescription> arm = read_arm_beside(document, folder);
  if (!arm) finish_without(document, "arm");  // the other keys depend on it
  const Eigen::VectorXd angles = read_pose(root, "pose", "angles_deg", *arm);
  const auto read = kind == Kind::joint_step    ? read_joint_step
                    : kind == Kind::tip_impulse ? read_tip_impulse
                                                : read_joint_motion;
  ArmMotion motion = read(document, *arm, angles, duration);
  motion.scenario.sample = interval;
  motion.scenario.least_advance = least;
  motion.scenario.ida.relative_tolerance = tolerance;
  motion.scenario.tolerances.coordinate = motion.scenario.tolerances.rate = motion_tolerance;
  return motion;
}

}  // namespace snare::scenario
