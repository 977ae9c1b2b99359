// Wrong descriptions and arm files, each with its whole message.

#include "base/errors.hpp"
#include "multibody/arm/arm_file.hpp"
#include "tests/multibody/valid_arm.hpp"
#include "tests/support/refusal.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace snare {

namespace {

struct WrongFile {
  const char* from;  // passage of the valid file
  const char* to;    // what stands in its place
  const char* message;
};

std::string message_of(const auto& read) {
  return test::refusal(read);
}

class WrongUrdf : public testing::TestWithParam<WrongFile> {};
class WrongArm : public testing::TestWithParam<WrongFile> {};

TEST_P(WrongUrdf, HasItsMessage) {
  const std::string text = test::edited(test::valid_urdf, GetParam().from, GetParam().to);
  EXPECT_EQ(message_of([&] { static_cast<void>(multibody::parse_urdf("x.urdf", text)); }),
            GetParam().message);
}

TEST_P(WrongArm, HasItsMessage) {
  // Other files are looked for beside the file; messages name it as it was given.
  const auto before = std::filesystem::current_path();
  const auto folder =
      std::filesystem::temp_directory_path() / ("snare_wrong_arm_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::filesystem::current_path(folder);
  std::ofstream("two_links.urdf") << test::valid_urdf;
  const std::string text = test::edited(test::valid_arm, GetParam().from, GetParam().to);
  EXPECT_EQ(message_of([&] { static_cast<void>(multibody::parse_arm("x.toml", text)); }), GetParam().message);
  std::filesystem::current_path(before);
  std::filesystem::remove_all(folder);
}

// What would exhaust the stack of a reader that calls itself is refused before.
TEST(EndlessUrdf, IsRefused) {
  const auto message = [](const std::string& text) {
    return message_of([&] { static_cast<void>(multibody::parse_urdf("x.urdf", text)); });
  };
  constexpr int many = 40000;
  std::string nested = "<robot name='r'>\n";
  std::string hidden = nested;
  for (int i = 0; i < many; ++i) nested += "<link name='a'>";
  for (int i = 0; i < many; ++i) hidden += "<a b='></a>'>";  // what stands in a value ends nothing
  EXPECT_EQ(message(nested), "x.urdf:2: must not nest elements more than 64 deep");
  EXPECT_EQ(message(hidden), "x.urdf:2: must not nest elements more than 64 deep");
  std::string chain = "<robot name='r'><link name='l0'/>";
  for (int i = 1; i < many; ++i) {
    chain += fmt::format(
        "<link name='l{0}'/><joint name='j{0}' type='fixed'><parent link='l{1}'/><child "
        "link='l{0}'/></joint>",
        i, i - 1);
  }
  EXPECT_EQ(message(chain + "</robot>"), "x.urdf:1: robot = 40000 links, must have at most 2000");
  EXPECT_EQ(message("<!DOCTYPE robot [<!ENTITY a 'a'>]>\n<robot name='r'><link name='a'/></robot>"),
            "x.urdf:1: <!DOCTYPE, must not be there: a robot description has no document type");
  EXPECT_EQ(message("<!-- <a> <![CDATA[ -->\n<?xml version='1.0'?><robot name='r'><link name='a'/></robot>"),
            "accepted");
}

const WrongFile wrong_urdfs[] = {
    {"<link name=\"tip\"/>", "<link name=\"tip\"/>\n  <xacro:property name=\"mass\" value=\"2.0\"/>",
     "x.urdf:18: is raw xacro: run `xacro FILE.xacro > FILE.urdf` and name that file"},
    {"<mass value=\"10\"/>", "<mass value=\"${mass}\"/>",
     "x.urdf:7: is raw xacro: run `xacro FILE.xacro > FILE.urdf` and name that file"},
    {"velocity=\"1\"/>", "velocity=\"1\"/><dynamics damping=\"-1\" friction=\"much\"/>",
     "x.urdf:22: joint[shoulder].dynamics.damping = -1, must be >= 0\n"
     "x.urdf:22: joint[shoulder].dynamics.friction = \"much\", must be a number"},
    {"<?xml version=\"1.0\"?>\n<robot name=\"two_links\">", "<robot name=\"two_links\"",
     "x.urdf:2: is no XML: Error reading Attributes"},
    {"</robot>", "", "x.urdf:36: is no XML: Error reading end tag"},
    {"<robot name=\"two_links\">", "<machine name=\"two_links\">",
     "x.urdf:35: is no XML: Error reading end tag"},
    {"<robot name=\"two_links\">", "<robot>", "x.urdf:2: robot.name, must be given"},
    {"  <link name=\"base\"/>\n", "  <link/>\n",
     "x.urdf:3: link.name, must be given\nx.urdf:19: joint[shoulder].parent = \"base\", must be a link of "
     "this file"},
    {"<link name=\"tip\"/>", "<link name=\"upper\"/>",
     "x.urdf:17: link[upper], must not be given twice; the first is in line 4\nx.urdf:32: joint[tool].child "
     "= \"tip\", must be a link of this file"},
    {"<mass value=\"10\"/>", "", "x.urdf:5: link[upper].inertial, must have a <mass>"},
    {"<mass value=\"10\"/>", "<mass value=\"-10\"/>",
     "x.urdf:7: link[upper].inertial.mass = -10, must be > 0 kg"},
    {"<mass value=\"10\"/>", "<mass value=\"ten\"/>",
     "x.urdf:7: link[upper].inertial.mass = \"ten\", must be a number"},
    {"<mass value=\"10\"/>", "<mass value=\"1e9\"/>",
     "x.urdf:8: link[upper].inertial.inertia = radius of gyration 3e-05 m, must be 0.0001 to 1000 m; URDF is "
     "in kg and m"},
    {"<inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.9\" iyz=\"0\" izz=\"0.9\"/>", "",
     "x.urdf:5: link[upper].inertial, must have an <inertia>"},
    {"iyy=\"0.9\" iyz=\"0\" izz=\"0.9\"", "iyy=\"0.9\" izz=\"0.9\"",
     "x.urdf:8: link[upper].inertial.inertia.iyz, must be a number"},
    {"ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.9\"", "ixx=\"0.1\" ixy=\"2\" ixz=\"0\" iyy=\"0.9\"",
     "x.urdf:8: link[upper].inertial.inertia = principal moments -1.54, 0.9, 2.54, must be positive "
     "definite"},
    {"ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.9\"", "ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\"",
     "x.urdf:8: link[upper].inertial.inertia = principal moments 0.1, 0.1, 0.9, must satisfy the triangle "
     "inequality: none larger than the sum of the others"},
    {"ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.9\"", "ixx=\"0.1\" ixy=\"nan\" ixz=\"0\" iyy=\"0.9\"",
     "x.urdf:8: link[upper].inertial.inertia.ixy = \"nan\", must be a number"},
    {"xyz=\"0.5 0 0\"", "xyz=\"0.5 0\"",
     "x.urdf:6: link[upper].inertial.origin.xyz = \"0.5 0\", must be 3 numbers"},
    {"xyz=\"0.5 0 0\"", "xyz=\"0.5 0 0mm\"",
     "x.urdf:6: link[upper].inertial.origin.xyz = \"0.5 0 0mm\", must be 3 numbers"},
    {"<origin xyz=\"1 0 0\" rpy=\"0 0 0\"/>", "<origin xyz=\"1000.5 0 0\" rpy=\"0 0 0\"/>",
     "x.urdf:27: joint[elbow].origin.xyz = \"1000.5 0 0\", must be within 1000 m; URDF is in metres"},
    {"<origin xyz=\"1 0 0\" rpy=\"0 0 0\"/>", "<origin xyz=\"1 0 0\" rpy=\"0 0 90\"/>",
     "x.urdf:27: joint[elbow].origin.rpy = \"0 0 90\", must be within +-2 pi; URDF is in radians"},
    {"<joint name=\"elbow\" type=\"continuous\">", "<joint type=\"continuous\">",
     "x.urdf:24: joint.name, must be given"},
    {"<joint name=\"elbow\"", "<joint name=\"shoulder\"",
     "x.urdf:24: joint[shoulder], must not be given twice; the first is in line 18"},
    {"type=\"continuous\"", "type=\"hinge\"",
     "x.urdf:24: joint[elbow].type = \"hinge\", must be revolute, continuous, prismatic, fixed or floating"},
    {"type=\"continuous\"", "",
     "x.urdf:24: joint[elbow].type, must be revolute, continuous, prismatic, fixed or floating"},
    {"<parent link=\"upper\"/>", "<parent link=\"uper\"/>",
     "x.urdf:25: joint[elbow].parent = \"uper\", must be a link of this file; did you mean \"upper\"?"},
    {"<child link=\"lower\"/>", "", "x.urdf:24: joint[elbow].child, must name a link"},
    {"<child link=\"lower\"/>", "<child link=\"upper\"/>",
     "x.urdf:24: joint[elbow].child = \"upper\", must not be the parent"},
    {"<child link=\"tip\"/>", "<child link=\"upper\"/>",
     "x.urdf:30: joint[tool].child = \"upper\", must not have a second parent: joint \"shoulder\" carries it "
     "already"},
    {"<parent link=\"base\"/>", "<parent link=\"tip\"/>",
     "x.urdf:11: link[lower], must not be in a closed loop of joints"},
    {"<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 0 0\"/>",
     "x.urdf:28: joint[elbow].axis = \"0 0 0\", must not be zero"},
    {"<limit lower=\"-3\" upper=\"3\" effort=\"100\" velocity=\"1\"/>", "",
     "x.urdf:18: joint[shoulder], must have a <limit>; a continuous joint needs none"},
    {"lower=\"-3\" upper=\"3\"", "lower=\"3\" upper=\"-3\"",
     "x.urdf:22: joint[shoulder].limit.lower = 3, must not exceed upper = -3"},
    {"effort=\"100\" ", "", "x.urdf:22: joint[shoulder].limit.effort, must be a number"},
    {"effort=\"100\"", "effort=\"-100\"", "x.urdf:22: joint[shoulder].limit.effort = -100, must be >= 0"},
    {"<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"shoulder\"/>",
     "x.urdf:28: joint[elbow].mimic, is not supported: every joint moves by itself"},
    {"<inertial>\n      <mass value=\"5\"/>\n      <inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.3\" "
     "iyz=\"0\" izz=\"0.3\"/>\n    </inertial>",
     "",
     "x.urdf: joint[elbow].child = \"lower\", must carry mass: neither this link nor any behind it has an "
     "<inertial>"},
    {"  <joint name=\"tool\" type=\"fixed\">\n    <parent link=\"lower\"/>\n    <child link=\"tip\"/>\n    "
     "<origin xyz=\"0.7 0 0\"/>\n  </joint>\n",
     "", "x.urdf: robot = \"base\", \"tip\", must have one root link; these are carried by no joint"},
};
const WrongFile wrong_arms[] = {
    {"schema = \"snare-arm/1\"", "schema = \"snare-arm/2\"",
     "x.toml:1: schema = \"snare-arm/2\", must be \"snare-arm/1\""},
    {"urdf   = \"two_links.urdf\"", "urdf   = \"three_links.urdf\"", "three_links.urdf: no such file"},
    {"urdf   = \"two_links.urdf\"\n", "", "x.toml: urdf, missing, must name a URDF file"},
    {"tip    = \"tip\"", "tip    = \"tipp\"",
     "x.toml:5: tip = \"tipp\", must be a link; did you mean \"tip\"?"},
    {"[joint.elbow]", "[joint.elbwo]", "x.toml:17: joint.elbwo, unknown key; did you mean elbow?"},
    {"rotor_inertia_kg_m2 = 1e-3", "rotor_inertia_kg_m2 = 0.0",
     "x.toml:8: every_joint.rotor_inertia_kg_m2 = 0.0, must be > 0 and <= 1e+15"},
    {"gear_ratio          = 100.0\n", "",
     "x.toml:7: every_joint.gear_ratio, missing, must be a number >= 1 and <= 1000000"},
    {"gear_ratio          = 100.0", "gear_ratio          = 0.01",
     "x.toml:9: every_joint.gear_ratio = 0.01, must be >= 1 and <= 1000000"},
    {"rotor_inertia_kg_m2 = 1e-3\n", "rotor_inertia_kg_m2 = 1e-3\nmotor_inertia_kg_m2 = 10.0\n",
     "x.toml:9: every_joint.motor_inertia_kg_m2 = 10.0, must not stand beside rotor_inertia_kg_m2"},
    {"stiffness_Nm_rad    = 1000.0", "stiffness_Nm_deg    = 1000.0",
     "x.toml:7: every_joint.stiffness_Nm_rad, missing, must be a number > 0 and <= 1e+15"},
    {"law                 = \"linear\"", "law                 = \"springy\"",
     "x.toml:10: every_joint.law = \"springy\", must be \"linear\", \"piecewise\" or \"backlash\""},
    {"damping_Nms_rad     = 1.0", "damping_Nms_rad     = -1.0",
     "x.toml:12: every_joint.damping_Nms_rad = -1.0, must be >= 0 and <= 1e+15"},
    {"from_deg         = [0.0, 0.04]", "from_deg         = [0.01, 0.04]",
     "x.toml:19: joint.elbow.from_deg[1] = 0.01, must be 0"},
    {"from_deg         = [0.0, 0.04]", "from_deg         = [0.0, 0.0]",
     "x.toml:19: joint.elbow.from_deg[2] = 0.0, must be larger than the number before"},
    {"stiffness_Nm_deg = [12.5, 475.0]", "stiffness_Nm_deg = [12.5, 475.0, 475.0]",
     "x.toml:20: joint.elbow.stiffness_Nm_deg = [12.5, 475.0, 475.0], must have 2 numbers, as from_deg has"},
    {"damping_Nms_deg  = [48.9, 87.3]", "damping_Nms_deg  = [48.9, \"87.3\"]",
     "x.toml:21: joint.elbow.damping_Nms_deg[2] = \"87.3\", must be a number >= 0 and <= 1e+15"},
    {"damping_Nms_deg  = [48.9, 87.3]", "damping_Nms_deg  = [48.9, 87.3]\nreading = \"loose\"",
     "x.toml:22: joint.elbow.reading = \"loose\", must be \"continuous\" or \"literal\""},
    {"damping_Nms_deg  = [48.9, 87.3]", "damping_Nms_deg  = [48.9, 87.3]\ndamping_on = \"link\"",
     "x.toml:22: joint.elbow.damping_on = \"link\", must be \"deflection\" or \"motor\""},
    {"damping_Nms_deg  = [48.9, 87.3]", "damping_Nms_deg  = [48.9, 87.3]\njump_width_deg = 0.05",
     "x.toml:22: joint.elbow.jump_width_deg = 0.05, must be less than the narrowest piece, 0.04 deg here"},
    {"damping_Nms_deg  = [48.9, 87.3]", "damping_Nms_deg  = [48.9, 87.3]\njump_width_deg = -1.0",
     "x.toml:22: joint.elbow.jump_width_deg = -1.0, must be >= 0 and <= 180"},
    {"derivative_Nms_rad  = 50.0", "derivative_Nms_rad  = 50.0\ncoulomb_Nm = 5.0\nbreakaway_Nm = 3.0",
     "x.toml:17: every_joint.breakaway_Nm = 3.0, must not be smaller than coulomb_Nm"},
    {"drive               = \"servo\"", "drive               = \"held\"",
     "x.toml:13: every_joint.drive = \"held\", must be \"locked\", \"servo\" or \"limp\""},
    {"proportional_Nm_rad = 500.0\n", "",
     "x.toml:7: every_joint.proportional_Nm_rad, missing, must be a number > 0 and <= 1e+15"},
    {"angles_deg = [30.0, -60.0]", "angles_deg = [30.0]",
     "x.toml:25: pose[bent].angles_deg = [30.0], must be an array of 2 numbers"},
    {"angles_deg = [30.0, -60.0]", "angles_deg = [300.0, -60.0]",
     "x.toml:25: pose[bent].angles_deg[1] = 300.0, must be -171.9 to 171.9, the limits of shoulder"},
    {"source = \"made up\"\n", "source = \"made up\"\ngravity_m_s2 = [0.0, -9.81]\n",
     "x.toml:4: gravity_m_s2 = [0.0, -9.81], must be an array of 3 numbers"},
    {"tip    = \"tip\"", "tip    = \"tip\"\nbase = { kind = \"floating\" }",
     "x.toml:6: base.kind = \"floating\", must be \"fixed\" or \"free\""},
    {"[[pose]]", "[[payload]]\nurdf = \"two_links.urdf\"\non = \"tip\"\n\n[[pose]]",
     "x.toml:24: payload[1].urdf = \"two_links.urdf\", must not have a link \"base\": another file has it "
     "already"},
};

INSTANTIATE_TEST_SUITE_P(Table, WrongUrdf, testing::ValuesIn(wrong_urdfs));
INSTANTIATE_TEST_SUITE_P(Table, WrongArm, testing::ValuesIn(wrong_arms));

}  // namespace

TEST(ArmErrors, TheFilesThatAreBrokenAreRightBefore) {
  EXPECT_EQ(message_of([] { static_cast<void>(multibody::parse_urdf("x.urdf", test::valid_urdf)); }),
            "accepted");
}

}  // namespace snare
