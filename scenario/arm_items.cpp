#include "scenario/arm_items.hpp"

#include "base/index.hpp"
#include "base/units.hpp"
#include "multibody/kinematics.hpp"
#include "scenario/arm_reader.hpp"
#include "scenario/hold.hpp"
#include "scenario/motion_reader.hpp"

#include <fmt/format.h>

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

Stand read_stand(const TomlTable& table) {
  Stand stand;
  stand.by_tip = table.has("tip_frame");
  if (stand.by_tip && table.has("base_frame")) table.fail("tip_frame", "cannot stand beside base_frame");
  const std::string prefix = stand.by_tip ? "tip" : "base";
  stand.X_FA.p = read_vector_or_zero(table, prefix + "_mm", Range::from(-farthest_mm, farthest_mm), base::mm);
  stand.X_FA.R = read_rotation_vector(table, prefix + "_rotation_deg");
  if (table.has(prefix + "_rpy_deg")) stand.X_FA.R = read_roll_pitch_yaw(table, prefix + "_rpy_deg");
  return stand;
}

/// `rates_deg_s`: of links and motors alike at the start; `deflections_deg`: of links before their motors. One a joint.
void start_motion(const TomlTable& table, coupling::MotionArm& arm) {
  const auto count = static_cast<std::size_t>(arm.arm.motors());
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

/// Moves the tree to where it stands, and adds its frames.
void place_arm(const std::string& name, int index, int tip, const Stand& stand, const PlacedFrame& on,
               coupling::MotionArm& arm, Placement& placement) {
  multibody::Tree& tree = arm.arm.tree;
  const Pose X_WA = on.X_WF * stand.X_FA;
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, arm.start.q, kinematics);
  tree.move(stand.by_tip ? X_WA * multibody::frame_pose(tree, kinematics, tip).inverse() : X_WA);
  multibody::place(tree, arm.start.q, kinematics);
  const auto add = [&](const std::string& frame_name, int frame) {
    placement.add(frame_name,
                  {{coupling::MotionCarrier::Kind::arm, index, frame}, multibody::frame_pose(tree, kinematics, frame)});
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
    const Hold how = table.has("hold") ? table.choice("hold", holds).value_or(Hold::as_described) : Hold::as_described;
    const Stand stand = read_stand(table);
    std::optional<multibody::ArmDescription> described;
    if (!file.empty())
      described =
          base::read_beside(c.document, [&] { return multibody::read_arm(c.folder / file, c.arm_overrides[name]); });
    const int index = static_cast<int>(c.motion.arms.size());
    coupling::MotionArm& arm = c.motion.arms.emplace_back();
    arm.name = name;
    const std::string key = stand.by_tip ? "tip_frame" : "base_frame";
    if (!described) {
      for (const char* k : {"pose", "angles_deg", "rates_deg_s", "deflections_deg"}) static_cast<void>(table.has(k));
      c.placement.excuse(name);
      static_cast<void>(table.has(key));
      continue;
    }
    const Eigen::VectorXd angles = read_pose(table, "pose", "angles_deg", *described);
    c.input += described->input;
    arm.arm = described->arm;
    arm.drives = described->drives;
    hold(how, angles, arm.drives);
    arm.start = multibody::resting(arm.arm, described->coordinates(angles));
    start_motion(table, arm);
    for (int j = 0; j < arm.arm.motors(); ++j) {
      const multibody::ElasticJoint& joint = arm.arm.joints[at(j)];
      c.joints[name + "::" + joint.name] = {index, j,
                                            arm.arm.tree.body(joint.body).joint == multibody::JointKind::prismatic};
    }
    c.placement.stand(
        table, key, name,
        [&c, table, key, name, index, stand, tip = described->tip](const PlacedFrame& on, Placement& placement) {
          if (!stand.by_tip && on.carrier.kind != coupling::MotionCarrier::Kind::world)
            table.fail(
                key,
                "must stand still: \"world\" or a frame on it; tip_frame places an arm whose file has a free base");
          place_arm(name, index, tip, stand, on, c.motion.arms[at(index)], placement);
        });
  }
}

}  // namespace snare::scenario
