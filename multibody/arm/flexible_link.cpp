#include "multibody/arm/flexible_link.hpp"

#include <cassert>

namespace snare::multibody {

namespace {

/// Of the link's inertia: without any, a joint and a hinge about one axis would move nothing between them.
constexpr double inboard_share = 0.1;

/// Where a link goes, in its own frame, a unit vector; zero where it has no length.
Eigen::Vector3d direction_of(const RobotDescription& robot, const RobotLink& link) {
  constexpr double nowhere = 1e-6;  // [m]
  for (const RobotJoint& joint : robot.joints)
    if (joint.parent == link.name && joint.X_PJ.p.norm() > nowhere) return joint.X_PJ.p.normalized();
  const Eigen::Vector3d com = link.inertia.centre();
  return com.norm() > nowhere ? Eigen::Vector3d(com.normalized()) : Eigen::Vector3d::Zero();
}

SpatialInertia share_of(const SpatialInertia& whole, double share) {
  return SpatialInertia::about_centre(share * whole.mass, whole.centre(), share * whole.about_own_centre());
}

}  // namespace

bool can_bend(const RobotDescription& robot, std::size_t link) {
  if (link == 0 || !(robot.links[link].inertia.mass > 0.0)) return false;
  const RobotJoint& joint = robot.joints[link - 1];
  return joint.kind && *joint.kind != JointKind::free && !direction_of(robot, robot.links[link]).isZero();
}

Flexure bend_link(RobotDescription& robot, std::size_t link, double stiffness, double damping) {
  assert(can_bend(robot, link));
  RobotLink& outboard = robot.links[link];
  const Eigen::Vector3d along = direction_of(robot, outboard), first = along.unitOrthogonal();
  const std::string name = outboard.name, root = name + " root", between = name + " hinge";
  Flexure flexure{name, root, {name + " bending 1", name + " bending 2"}, stiffness, damping};
  const SpatialInertia whole = outboard.inertia;
  outboard.inertia = share_of(whole, 1.0 - inboard_share);

  // Joint i carries link i + 1.
  const auto at = static_cast<std::ptrdiff_t>(link);
  robot.joints[link - 1].child = root;
  const auto hinge = [](const std::string& own, const std::string& parent, const std::string& child,
                        const Eigen::Vector3d& axis) {
    RobotJoint joint;
    joint.name = own;
    joint.parent = parent;
    joint.child = child;
    joint.kind = JointKind::revolute;
    joint.axis = axis;
    return joint;
  };
  robot.joints.insert(robot.joints.begin() + at,
                      {hinge(flexure.hinges[0], root, between, first),
                       hinge(flexure.hinges[1], between, name, along.cross(first))});
  robot.links.insert(robot.links.begin() + at,
                     {RobotLink{root, share_of(whole, inboard_share)}, RobotLink{between, {}}});
  return flexure;
}

}  // namespace snare::multibody
