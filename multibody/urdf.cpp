#include "multibody/urdf.hpp"

#include "base/files.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

namespace snare::multibody {

namespace {

using base::InputError;
using base::InputProblem;

/// Keeps what urdfdom would print.
class Listener : public console_bridge::OutputHandler {
 public:
  Listener() { console_bridge::useOutputHandler(this); }
  ~Listener() override { console_bridge::restorePreviousOutputHandler(); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && heard_.empty()) heard_ = text;
  }
  [[nodiscard]] const std::string& heard() const { return heard_; }

 private:
  std::string heard_;
};

Pose to_pose(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix(),
          {pose.position.x, pose.position.y, pose.position.z}};
}

SpatialInertia to_inertia(const urdf::Link& link) {
  if (!link.inertial) return {};
  const urdf::Inertial& i = *link.inertial;
  const Pose X = to_pose(i.origin);
  Eigen::Matrix3d moments;
  moments << i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz;
  return SpatialInertia::about_centre(i.mass, X.p, X.R * moments * X.R.transpose());
}

std::optional<JointKind> to_kind(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
    case urdf::Joint::CONTINUOUS:
      return JointKind::revolute;
    case urdf::Joint::PRISMATIC:
      return JointKind::prismatic;
    case urdf::Joint::FLOATING:
      return JointKind::free;
    default:
      return std::nullopt;
  }
}

RobotJoint to_joint(const urdf::Joint* from) {
  RobotJoint joint;
  joint.name = from->name;
  joint.parent = from->parent_link_name;
  joint.child = from->child_link_name;
  joint.kind = to_kind(*from);
  joint.axis = {from->axis.x, from->axis.y, from->axis.z};
  joint.X_PJ = to_pose(from->parent_to_joint_origin_transform);
  if (from->limits) {
    if (from->type != urdf::Joint::CONTINUOUS) {
      joint.lower = from->limits->lower;
      joint.upper = from->limits->upper;
    }
    joint.effort = from->limits->effort;
    joint.speed = from->limits->velocity;
  }
  if (from->dynamics) {
    joint.damping = from->dynamics->damping;
    joint.friction = from->dynamics->friction;
  }
  return joint;
}

/// Appends all links, depth first, children in the order of the joints' names as urdfdom keeps them. Chains
/// may be long: what is still to come is on a stack of its own.
void append(const urdf::ModelInterface& model, const urdf::Link& root, RobotDescription& robot) {
  robot.links.push_back({root.name, to_inertia(root)});
  std::vector<const urdf::Joint*> open;
  const auto push = [&open](const urdf::Link& link) {
    for (auto j = link.child_joints.rbegin(); j != link.child_joints.rend(); ++j) open.push_back(j->get());
  };
  push(root);
  while (!open.empty()) {
    robot.joints.push_back(to_joint(open.back()));
    open.pop_back();
    const urdf::Link& child = *model.getLink(robot.joints.back().child);
    robot.links.push_back({child.name, to_inertia(child)});
    push(child);
  }
}

/// A body on a moving joint with nothing massive behind it has no inertia to accelerate.
std::vector<InputProblem> massless_ends(const std::string& file, const RobotDescription& robot) {
  std::map<std::string, double> carried;  // mass that hangs rigidly or otherwise on a link
  for (std::size_t i = robot.links.size(); i-- > 0;) {
    carried[robot.links[i].name] += robot.links[i].inertia.mass;
    if (i > 0) carried[robot.joints[i - 1].parent] += carried[robot.links[i].name];
  }
  std::vector<InputProblem> problems;
  for (const RobotJoint& joint : robot.joints) {
    if (joint.kind && !(carried[joint.child] > 0.0)) {
      problems.push_back({file, 0, "joint[" + joint.name + "].child", "\"" + joint.child + "\"",
                          "must carry mass: neither this link nor any behind it has an <inertial>"});
    }
  }
  return problems;
}

/// The farthest that a centre of mass can be from the root: offsets along the branches, and of the masses in
/// their links [m].
double largest_reach(const RobotDescription& robot) {
  std::map<std::string, double> at{{robot.root, 0.0}};
  double reach = 0.0;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (i > 0) at[robot.links[i].name] = at[robot.joints[i - 1].parent] + robot.joints[i - 1].X_PJ.p.norm();
    const SpatialInertia& inertia = robot.links[i].inertia;
    reach = std::max(reach, at[robot.links[i].name] + (inertia.mass > 0.0 ? inertia.centre().norm() : 0.0));
  }
  return reach;
}

/// Numbers that are legal and more likely in another unit.
std::vector<std::string> doubts(const RobotDescription& robot) {
  std::vector<std::string> found;
  const bool moves = std::ranges::any_of(
      robot.joints, [](const RobotJoint& joint) { return joint.kind && *joint.kind != JointKind::free; });
  const double reach = moves ? largest_reach(robot) : 0.0;  // a body alone has none
  for (std::size_t i = 1; i < robot.links.size() && reach > 0.0; ++i) {
    const RobotLink& link = robot.links[i];
    if (!(link.inertia.mass > 0.0)) continue;
    const Eigen::Vector3d moments =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(link.inertia.about_own_centre()).eigenvalues();
    const double gyration = std::sqrt(moments[2] / link.inertia.mass);
    if (gyration <= reach) continue;
    found.push_back(fmt::format(
        "link {}: its radius of gyration of {:.4g} m is larger than the robot's reach of {:.4g} m: is the "
        "inertia in kg mm2? URDF is in kg m2",
        link.name, gyration, reach));
  }
  constexpr double turn = 2.0 * EIGEN_PI;
  for (const RobotJoint& joint : robot.joints) {
    if (joint.kind != JointKind::revolute) continue;
    const double lowest = std::isfinite(joint.lower) ? joint.lower : 0.0;
    const double highest = std::isfinite(joint.upper) ? joint.upper : 0.0;
    if (lowest >= -turn - 1e-3 && highest <= turn + 1e-3) continue;  // 1e-3: 6.283 is written as 6.2832
    found.push_back(
        fmt::format("joint {}: its limits of {:.6g} to {:.6g} rad are more than a turn: are they in degrees? "
                    "URDF is in radians",
                    joint.name, joint.lower, joint.upper));
  }
  return found;
}

}  // namespace

RobotDescription parse_urdf(const std::string& file, const std::string& text) {
  std::vector<InputProblem> problems = check_urdf(file, text);
  if (!problems.empty()) throw InputError(std::move(problems));
  const Listener listener;
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
  if (!model) throw InputError({file, 0, "", "", "is refused by urdfdom: " + listener.heard()});
  RobotDescription robot;
  robot.text = text;
  robot.name = model->getName();
  robot.root = model->getRoot()->name;
  append(*model, *model->getRoot(), robot);
  problems = massless_ends(file, robot);
  if (!problems.empty()) throw InputError(std::move(problems));
  robot.warnings = doubts(robot);
  return robot;
}

RobotDescription read_urdf(const std::filesystem::path& file) {
  constexpr std::size_t size_limit = 4u << 20u;  // of a description without meshes [byte]
  return parse_urdf(file.string(), base::read_text(file, size_limit));
}

void add_robot(Tree& tree, int frame, RootJoint root, const RobotDescription& robot) {
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const RobotLink& link = robot.links[i];
    if (i == 0) {
      if (root == RootJoint::free) {
        tree.add_moving(frame, link.name, JointKind::free, Eigen::Vector3d::UnitZ(), {}, link.inertia);
      } else {
        tree.add_fixed(frame, link.name, {}, link.inertia);
      }
      continue;
    }
    const RobotJoint& joint = robot.joints[i - 1];
    const int parent = tree.find_frame(joint.parent);
    if (joint.kind) {
      tree.add_moving(parent, link.name, *joint.kind, joint.axis, joint.X_PJ, link.inertia);
    } else {
      tree.add_fixed(parent, link.name, joint.X_PJ, link.inertia);
    }
  }
}

}  // namespace snare::multibody
