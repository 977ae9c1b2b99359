#include "scenario/arm_items.hpp"

#include "base/index.hpp"
#include "base/units.hpp"
#include "multibody/inverse_kinematics.hpp"
#include "multibody/kinematics.hpp"
#include "scenario/arm_reader.hpp"
#include "scenario/hold.hpp"
#include "scenario/motion_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace snare::scenario {

using base::at;
using base::Choice;
using base::Range;
using base::TomlTable;
using multibody::Pose;

namespace {

/// Where an arm stands: its base or its tip on a frame.
struct Stand {
  bool by_tip = false;
  Pose X_FA;  ///< of the base, or of the tip, in the frame
};

/// A place on a frame by the keys that begin with a word.
Pose read_place(const TomlTable& table, const std::string& prefix) {
  Pose X;
  X.p = read_vector_or_zero(table, prefix + "_mm", Range::from(-farthest_mm, farthest_mm), base::mm);
  X.R = read_rotation_vector(table, prefix + "_rotation_deg");
  if (table.has(prefix + "_rpy_deg")) X.R = read_roll_pitch_yaw(table, prefix + "_rpy_deg");
  return X;
}

/// Where the tip must be at the start: the joints follow.
struct Aim {
  TomlTable table;
  Pose X_FT;  ///< of the tip in the frame `reach_frame`
  std::vector<multibody::ReachingJoint> joints;
  std::vector<std::string> names;  ///< of these joints
};

Stand read_stand(const TomlTable& table) {
  Stand stand;
  stand.by_tip = table.has("tip_frame");
  if (stand.by_tip && table.has("base_frame")) table.fail("tip_frame", "cannot stand beside base_frame");
  stand.X_FA = read_place(table, stand.by_tip ? "tip" : "base");
  return stand;
}

/// `rates_deg_s`: of links and motors alike at the start; `deflections_deg`: of links before their motors.
/// One a joint, of which there are `count`.
void start_motion(const TomlTable& table, std::size_t count, coupling::MotionArm& arm) {
  const auto read = [&](const char* key, double most) {
    const std::vector<double> none;
    return table.has(key) ? table.numbers(key, count, count, Range::from(-most, most), base::degree) : none;
  };
  const std::vector<double> rates = read("rates_deg_s", 1e5);
  for (std::size_t j = 0; j < rates.size(); ++j) {
    arm.start.motor_rate[static_cast<Eigen::Index>(j)] = rates[j];
    arm.start.v[arm.arm.tree.body(arm.arm.joints[j].body).v_index] = rates[j];
  }
  const std::vector<double> deflections = read("deflections_deg", 90.0);
  for (std::size_t j = 0; j < deflections.size(); ++j) {
    const auto k = static_cast<Eigen::Index>(j);
    arm.start.motor[k] -= deflections[j];
    arm.drives[j].course = multibody::Course::standing(arm.start.motor[k]);
  }
}

/// `reach_frame` with its place: six joints move, those of `held_joints` stay as the posture has them.
std::optional<Aim> read_aim(const TomlTable& table, const multibody::ArmDescription& described) {
  if (!table.has("reach_frame")) {
    if (table.has("held_joints")) table.fail("held_joints", "only beside reach_frame");
    return std::nullopt;
  }
  if (table.has("tip_frame"))
    table.fail("reach_frame", "cannot stand beside tip_frame, by which the base follows");
  Aim aim{table, read_place(table, "reach"), {}, {}};
  const std::vector<std::string> held = table.texts_or_none("held_joints");
  std::string known;
  for (const multibody::RobotJoint& j : described.joints)
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", j.name);
  for (std::size_t k = 0; k < held.size(); ++k) {
    const auto of_name = [&](const multibody::RobotJoint& j) { return j.name == held[k]; };
    if (std::ranges::none_of(described.joints, of_name))
      table.fail_element("held_joints", k, "must be a joint of the arm: " + known);
  }
  const int motors = static_cast<int>(described.joints.size());
  for (int j = 0; j < motors; ++j) {
    const multibody::ElasticJoint& joint = described.arm.joints[at(j)];
    if (std::ranges::find(held, joint.name) != held.end()) continue;
    aim.joints.push_back({joint.body, described.joints[at(j)].lower, described.joints[at(j)].upper});
    aim.names.push_back(joint.name);
  }
  constexpr std::size_t freedoms = 6;
  if (aim.joints.size() == freedoms) return aim;
  table.fail(motors > static_cast<int>(freedoms) ? "held_joints" : "reach_frame",
             motors > static_cast<int>(freedoms)
                 ? fmt::format("must name {} of the {} joints, which stay as the pose has them: {}",
                               motors - static_cast<int>(freedoms), motors, known)
                 : fmt::format("needs six joints that move, there are {}", aim.joints.size()));
  return std::nullopt;
}

/// Turns the joints, and their motors with them, so that the tip is where it must be.
void reach(const Aim& aim, int tip, const Pose& X_WT, coupling::MotionArm& arm) {
  const multibody::Tree& tree = arm.arm.tree;
  const multibody::Reach r = multibody::reach_pose(tree, tip, X_WT, arm.start.q, aim.joints);
  if (!r.found() && r.beyond < 0) {
    aim.table.fail("reach_frame",
                   fmt::format("is out of reach: the tip comes no nearer than {:.6g} mm and {:.6g} deg",
                               r.distance / base::mm, r.angle / base::degree));
    return;
  }
  if (!r.found()) {
    const multibody::ReachingJoint& joint = aim.joints[at(r.beyond)];
    const bool turns = tree.body(joint.body).joint == multibody::JointKind::revolute;
    const double unit = turns ? base::degree : base::mm;
    aim.table.fail(
        "reach_frame",
        fmt::format(
            "is reached only beyond limits: nearest with {} at {:.6g} {}, allowed are {:.6g} to {:.6g}",
            aim.names[at(r.beyond)], r.beyond_at / unit, turns ? "deg" : "mm", joint.lower / unit,
            joint.upper / unit));
    return;
  }
  for (int j = 0; j < arm.arm.motors(); ++j) {
    const int q = tree.body(arm.arm.joints[at(j)].body).q_index;
    const double by = r.q[q] - arm.start.q[q];
    arm.start.motor[j] += by;
    arm.drives[at(j)].course = multibody::Course::standing(arm.drives[at(j)].course.from + by);
  }
  arm.start.q = r.q;
}

/// Moves the tree to where it stands.
void stand_arm(int tip, const Stand& stand, const PlacedFrame& on, coupling::MotionArm& arm) {
  multibody::Tree& tree = arm.arm.tree;
  const Pose X_WA = on.X_WF * stand.X_FA;
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, arm.start.q, kinematics);
  tree.move(stand.by_tip ? X_WA * multibody::frame_pose(tree, kinematics, tip).inverse() : X_WA);
}

/// Adds the frames of an arm that stands in its place.
void add_frames(const std::string& name, int index, int tip, const coupling::MotionArm& arm,
                Placement& placement) {
  const multibody::Tree& tree = arm.arm.tree;
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, arm.start.q, kinematics);
  const auto add = [&](const std::string& frame_name, int frame) {
    placement.add(frame_name, {{coupling::MotionCarrier::Kind::arm, index, frame},
                               multibody::frame_pose(tree, kinematics, frame)});
  };
  for (int frame = 1; frame < static_cast<int>(tree.frames().size()); ++frame)
    add(name + "::" + tree.frame(frame).name, frame);
  add(name + "::tip", tip);
}

}  // namespace

void read_arms(Composition& c) {
  for (const TomlTable& table : c.document.root().tables("arms")) {
    const std::string name = c.arm_names.take(table);
    const std::string file = table.text("file");
    const Hold how =
        table.has("hold") ? table.choice("hold", holds).value_or(Hold::as_described) : Hold::as_described;
    const Stand stand = read_stand(table);
    std::optional<multibody::ArmDescription> described;
    if (!file.empty())
      described = base::read_beside(
          c.document, [&] { return multibody::read_arm(c.folder / file, c.arm_overrides[name]); });
    const int index = static_cast<int>(c.motion.arms.size());
    coupling::MotionArm& arm = c.motion.arms.emplace_back();
    arm.name = name;
    const std::string key = stand.by_tip ? "tip_frame" : "base_frame";
    if (!described) {
      for (const char* k : {"pose", "angles_deg", "rates_deg_s", "deflections_deg", "reach_frame", "reach_mm",
                            "reach_rotation_deg", "reach_rpy_deg", "held_joints"})
        static_cast<void>(table.has(k));
      c.placement.excuse(name);
      static_cast<void>(table.has(key));
      continue;
    }
    const Eigen::VectorXd angles = read_pose(table, "pose", "angles_deg", *described);
    c.input += described->input;
    for (const std::string& warning : described->warnings)
      c.warnings.push_back(fmt::format("arm {}: {}", name, warning));
    arm.arm = described->arm;
    arm.drives = described->drives;
    hold(how, angles, arm.arm, arm.drives);
    arm.start = multibody::resting(arm.arm, described->coordinates(angles));
    start_motion(table, described->joints.size(), arm);
    const std::optional<Aim> aim = read_aim(table, *described);
    for (int j = 0; j < arm.arm.motors(); ++j) {
      const multibody::ElasticJoint& joint = arm.arm.joints[at(j)];
      if (joint.flexure) continue;  // nothing drives it
      c.joints[name + "::" + joint.name] = {
          index, j, arm.arm.tree.body(joint.body).joint == multibody::JointKind::prismatic};
    }
    c.placement.stand(table, key, name,
                      [&c, table, key, name, index, stand, aim, tip = described->tip](const PlacedFrame& on,
                                                                                      Placement& placement) {
                        if (!stand.by_tip && on.carrier.kind != coupling::MotionCarrier::Kind::world)
                          table.fail(key,
                                     "must stand still: \"world\" or a frame on it; tip_frame places an arm "
                                     "whose file has a free base");
                        stand_arm(tip, stand, on, c.motion.arms[at(index)]);
                        if (!aim) {
                          add_frames(name, index, tip, c.motion.arms[at(index)], placement);
                          return;
                        }
                        placement.stand(table, "reach_frame", name,
                                        [&c, name, index, aim, tip](const PlacedFrame& at_tip, Placement& p) {
                                          const TomlTable& asked = aim->table;
                                          if (p.find(asked.text_or("reach_frame", "world")) &&
                                              p.find(asked.text_or("base_frame", "world")))
                                            reach(*aim, tip, at_tip.X_WF * aim->X_FT,
                                                  c.motion.arms[at(index)]);
                                          add_frames(name, index, tip, c.motion.arms[at(index)], p);
                                        });
                      });
  }
}

}  // namespace snare::scenario
