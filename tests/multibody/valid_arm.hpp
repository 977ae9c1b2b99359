#pragma once

#include <string>

namespace snare::test {

/// A description that is right; the tests of messages break one passage at a time.
inline const std::string valid_urdf = R"(<?xml version="1.0"?>
<robot name="two_links">
  <link name="base"/>
  <link name="upper">
    <inertial>
      <origin xyz="0.5 0 0" rpy="0 0 0"/>
      <mass value="10"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.9" iyz="0" izz="0.9"/>
    </inertial>
  </link>
  <link name="lower">
    <inertial>
      <mass value="5"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.3"/>
    </inertial>
  </link>
  <link name="tip"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/>
    <child link="upper"/>
    <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="100" velocity="1"/>
  </joint>
  <joint name="elbow" type="continuous">
    <parent link="upper"/>
    <child link="lower"/>
    <origin xyz="1 0 0" rpy="0 0 0"/>
    <axis xyz="0 1 0"/>
  </joint>
  <joint name="tool" type="fixed">
    <parent link="lower"/>
    <child link="tip"/>
    <origin xyz="0.7 0 0"/>
  </joint>
</robot>
)";

inline const std::string valid_arm = R"(schema = "snare-arm/1"
title  = "two links"
source = "made up"
urdf   = "two_links.urdf"
tip    = "tip"

[every_joint]
rotor_inertia_kg_m2 = 1e-3
gear_ratio          = 100.0
law                 = "linear"
stiffness_Nm_rad    = 1000.0
damping_Nms_rad     = 1.0
drive               = "servo"
proportional_Nm_rad = 500.0
derivative_Nms_rad  = 50.0

[joint.elbow]
law              = "piecewise"
from_deg         = [0.0, 0.04]
stiffness_Nm_deg = [12.5, 475.0]
damping_Nms_deg  = [48.9, 87.3]

[[pose]]
name = "bent"
angles_deg = [30.0, -60.0]
)";

/// `text` with one passage in place of another; the passage must be there.
inline std::string edited(const std::string& text, const std::string& from, const std::string& to) {
  std::string copy = text;
  const std::size_t at = copy.find(from);
  if (at == std::string::npos) return "no such passage: " + from;
  return copy.replace(at, from.size(), to);
}

}  // namespace snare::test
