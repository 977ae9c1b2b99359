#include "scenario/arm_scenario_file.hpp"

#include "base/units.hpp"
#include "base/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace snare::scenario {

using base::Choice;
using base::Range;
using base::TomlDocument;
using base::TomlTable;

namespace {

using base::degree;

enum class Kind { joint_step, tip_impulse, joint_motion };

int read_joint(const TomlTable& root, const multibody::ArmDescription& arm) {
  const std::string name = root.text("joint");
  std::string known;
  for (int j = 0; j < arm.arm.motors(); ++j) {
    const std::string& one = arm.arm.joints[static_cast<std::size_t>(j)].name;
    if (one == name) return j;
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", one);
  }
  root.fail("joint", "must be an elastic joint of the arm: " + known);
  return 0;
}

}  // namespace

Eigen::VectorXd read_pose(const TomlTable& root, std::string_view name_key, std::string_view angles_key,
                          const multibody::ArmDescription& arm) {
  const Eigen::Index n = arm.arm.motors();
  Eigen::VectorXd angles = Eigen::VectorXd::Zero(n);
  if (root.has(angles_key)) {
    if (root.has(name_key)) root.fail(angles_key, fmt::format("cannot stand beside {}", name_key));
    const auto count = static_cast<std::size_t>(n);
    const std::vector<double> given =
        root.numbers(angles_key, count, count, Range::from(-3600.0, 3600.0), degree);
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

ArmScenarioFile read_arm_scenario(const std::filesystem::path& file,
                                  const std::vector<base::Override>& overrides) {
  TomlDocument document(file, overrides);
  const TomlTable root = document.root();
  ArmScenarioFile result;
  static constexpr Choice<bool> schemas[] = {{"snare-scenario/1", true}};
  static_cast<void>(root.choice("schema", schemas));
  static constexpr Choice<Kind> kinds[] = {{"joint_step", Kind::joint_step},
                                           {"tip_impulse", Kind::tip_impulse},
                                           {"joint_motion", Kind::joint_motion}};
  const std::optional<Kind> kind = root.choice("kind", kinds);
  result.kind = root.text_or("kind", "");
  result.title = root.text("title");
  result.source = root.text_or("source", "");
  const double duration = root.number("duration_s", Range::above(0.0, 1e6));
  const double interval = root.number_or("output_interval_s", 0.01, Range::above(0.0, 1e5));
  constexpr double most_outputs = 1e6;
  if (duration / interval > most_outputs)
    root.fail("output_interval_s", fmt::format("gives more than {:g} lines", most_outputs));
  const std::string arm_name = root.text("arm");
  const double tolerance =
      root.table("solver").number_or("relative_tolerance", 1e-6, Range::from(1e-12, 1e-2));
  const double motion = root.table("solver").number_or("motion_tolerance", 1e-8, Range::above(0.0, 1e-3));
  if (arm_name.empty()) document.finish();
  try {
    result.description = multibody::read_arm(file.parent_path() / arm_name);
  } catch (const base::InputError& error) {
    for (const base::InputProblem& problem : error.problems()) document.add(problem);
    document.finish();
  }
  const multibody::ArmDescription& arm = result.description;
  const Eigen::VectorXd angles = read_pose(root, "pose", "angles_deg", arm);
  if (kind == Kind::joint_step) {
    static constexpr Choice<bool> ways[] = {{"held", false}, {"commanded", true}};
    const bool commanded = root.has("way") && root.choice("way", ways).value_or(false);
    result.joint = read_joint(root, arm);
    const double step = root.number("step_deg", Range::from(-90.0, 90.0), degree);
    document.finish();
    result.scenario = commanded ? commanded_step(arm, angles, result.joint, step, duration)
                                : joint_step(arm, angles, result.joint, step, duration);
  } else if (kind == Kind::tip_impulse) {
    static constexpr Choice<Hold> holds[] = {{"as_described", Hold::as_described}, {"limp", Hold::limp}};
    const Hold hold = root.choice("hold", holds).value_or(Hold::as_described);
    const std::vector<double> impulse = root.numbers("impulse_Ns", 3, 3, Range::from(-1e9, 1e9));
    const double pulse = root.number("pulse_s", Range::above(0.0, 1e5));
    document.finish();
    result.scenario = tip_impulse(arm, angles, hold, {impulse[0], impulse[1], impulse[2]}, pulse, duration);
  } else {
    const Eigen::VectorXd to = read_pose(root, "to_pose", "to_angles_deg", arm);
    const double course = root.number_or("course_s", duration, Range::above(0.0, 1e6));
    document.finish();
    result.scenario = joint_motion(arm, angles, to, course, duration);
  }
  result.scenario.sample = interval;
  result.scenario.ida.relative_tolerance = tolerance;
  result.scenario.tolerances.motion = motion;
  return result;
}

}  // namespace snare::scenario
