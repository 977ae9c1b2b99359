#include "multibody/arm/arm_file.hpp"

#include "base/decimal.hpp"
#include "base/index.hpp"
#include "base/toml_reader.hpp"
#include "base/units.hpp"
#include "multibody/arm/flexible_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace snare::multibody {

namespace {

using base::Choice;
using base::InputError;
using base::Range;
using base::TomlDocument;
using base::TomlTable;

using base::at;
using base::degree;

constexpr Choice<StiffnessReading> readings[] = {{"continuous", StiffnessReading::continuous},
                                                 {"literal", StiffnessReading::literal}};
constexpr Choice<DampingRate> damping_rates[] = {{"deflection", DampingRate::deflection},
                                                 {"motor", DampingRate::motor}};
constexpr Choice<DriveMode> drive_modes[] = {
    {"locked", DriveMode::locked}, {"servo", DriveMode::servo}, {"limp", DriveMode::limp}};
enum class Law { linear, piecewise, backlash };
/// Stiffnesses, torques, inertias, rates: the bound keeps every product of them finite.
constexpr Range positive{0.0, 1e15, false};
constexpr Range not_negative{0.0, 1e15, true};
constexpr Range any_torque{-1e15, 1e15, true};

constexpr Choice<Law> laws[] = {
    {"linear", Law::linear}, {"piecewise", Law::piecewise}, {"backlash", Law::backlash}};
enum class BaseKind { fixed, free };
constexpr Choice<BaseKind> base_kinds[] = {{"fixed", BaseKind::fixed}, {"free", BaseKind::free}};

/// After a problem that hides what the other keys mean, none of them is called unknown.
void know(const TomlTable& table, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) static_cast<void>(table.has(key));
}

void take_warnings(const RobotDescription& robot, const std::string& file, ArmDescription& description) {
  for (const std::string& warning : robot.warnings) description.warnings.push_back(file + ": " + warning);
}

/// A URDF file named by a key; nothing after a problem, which goes to the document.
std::optional<RobotDescription> robot_of(TomlDocument& document, const TomlTable& table,
                                         const std::filesystem::path& folder, ArmDescription& description) {
  const std::string name = table.text("urdf");
  if (name.empty()) return std::nullopt;
  try {
    const RobotDescription robot = read_urdf(folder / name);
    description.input += robot.text;
    take_warnings(robot, name, description);
    return robot;
  } catch (const InputError& error) {
    for (const base::InputProblem& problem : error.problems()) document.add(problem);
    return std::nullopt;
  }
}

/// Puts a robot on a frame; false when a name of its links is taken.
bool put(const TomlTable& table, Tree& tree, int frame, RootJoint root, const RobotDescription& robot) {
  for (const RobotLink& link : robot.links) {
    if (tree.find_frame(link.name) < 0) continue;
    table.fail("urdf", fmt::format("must not have a link \"{}\": another file has it already", link.name));
    return false;
  }
  add_robot(tree, frame, root, robot);
  return true;
}

/// A frame of the tree named by a key; -1 after a problem.
int frame_of(const TomlTable& table, std::string_view key, const Tree& tree) {
  const std::string name = table.text(key);
  if (name.empty()) return -1;
  const int frame = tree.find_frame(name);
  if (frame < 0) {
    std::vector<std::string> names;
    for (const TreeFrame& f : tree.frames()) names.push_back(f.name);
    const std::string nearest = base::nearest_word(name, names);
    table.fail(key, "must be a link" + (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
  }
  return frame;
}

std::optional<DeflectionLaw> law_of(const TomlTable& table) {
  const auto law = table.choice("law", laws);
  const auto rate =
      table.has("damping_on") ? table.choice("damping_on", damping_rates) : DampingRate::deflection;
  if (!law || !rate) {
    know(table, {"from_deg", "stiffness_Nm_deg", "damping_Nms_deg", "reading", "jump_width_deg",
                 "stiffness_Nm_rad", "damping_Nms_rad", "half_gap_deg"});
    return std::nullopt;
  }
  std::vector<DeflectionPiece> pieces;
  auto reading = std::optional(StiffnessReading::continuous);
  double width = 0.0;
  if (*law == Law::piecewise) {
    const auto from = table.numbers("from_deg", 2, 20, Range::from(0.0, 180.0), degree);
    const auto stiffness = table.numbers("stiffness_Nm_deg", 2, 20, not_negative, 1.0 / degree);
    const auto damping = table.numbers("damping_Nms_deg", 2, 20, not_negative, 1.0 / degree);
    if (table.has("reading")) reading = table.choice("reading", readings);
    // A fiftieth of the narrowest range of Abiko et al., Table 2.
    constexpr double usual_width = 4e-4 * degree;
    width = table.number_or("jump_width_deg", reading == StiffnessReading::literal ? usual_width : 0.0,
                            Range::from(0.0, 180.0), degree);
    if (from.empty() || stiffness.empty() || damping.empty() || !reading || !(width >= 0.0))
      return std::nullopt;
    if (stiffness.size() != from.size())
      table.fail("stiffness_Nm_deg", fmt::format("must have {} numbers, as from_deg has", from.size()));
    if (damping.size() != from.size())
      table.fail("damping_Nms_deg", fmt::format("must have {} numbers, as from_deg has", from.size()));
    if (stiffness.size() != from.size() || damping.size() != from.size()) return std::nullopt;
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (i == 0 ? from[0] != 0.0 : !(from[i] > from[i - 1])) {
        table.fail_element("from_deg", i, i == 0 ? "must be 0" : "must be larger than the number before");
        return std::nullopt;
      }
      if (i > 0 && width >= from[i] - from[i - 1]) {
        table.fail("jump_width_deg", fmt::format("must be less than the narrowest piece, {:.4g} deg here",
                                                 (from[i] - from[i - 1]) / degree));
        return std::nullopt;
      }
      pieces.push_back({from[i], stiffness[i], damping[i], 0.0});
    }
  } else {
    const double stiffness = table.number("stiffness_Nm_rad", positive);
    const double damping = table.number("damping_Nms_rad", not_negative);
    const double gap =
        *law == Law::backlash ? table.number("half_gap_deg", Range::above(0.0, 180.0), degree) : 0.0;
    if (!(stiffness > 0.0) || !(damping >= 0.0) || !(gap >= 0.0)) return std::nullopt;
    if (*law == Law::backlash) pieces.push_back({0.0, 0.0, 0.0, 0.0});
    pieces.push_back({gap, stiffness, damping, 0.0});
  }
  return DeflectionLaw(std::move(pieces), *reading, *rate, width);
}

double motor_inertia_of(const TomlTable& table) {
  if (!table.has("rotor_inertia_kg_m2")) return table.number("motor_inertia_kg_m2", positive);
  if (table.has("motor_inertia_kg_m2")) {
    table.fail("motor_inertia_kg_m2", "must not stand beside rotor_inertia_kg_m2");
    know(table, {"gear_ratio"});
    return 0.0;
  }
  const double ratio = table.number("gear_ratio", Range::from(1.0, 1e6));
  return ratio * ratio * table.number("rotor_inertia_kg_m2", positive);
}

/// Friction of a motor; what the table does not give is that of the URDF's <dynamics>.
JointFriction friction_of(const TomlTable& table, const RobotJoint& joint) {
  JointFriction law;
  law.coulomb = table.number_or("coulomb_Nm", joint.friction, not_negative);
  law.breakaway = table.number_or("breakaway_Nm", law.coulomb, not_negative);
  law.stribeck_velocity = table.number_or("stribeck_velocity_rad_s", 1e-3, positive);
  law.viscous = table.number_or("viscous_Nms_rad", joint.damping, not_negative);
  law.quadratic = table.number_or("quadratic_Nms2_rad2", 0.0, not_negative);
  law.viscous_asymmetry = table.number_or("viscous_asymmetry_Nms_rad", 0.0, any_torque);
  if (std::abs(law.viscous_asymmetry) > law.viscous)
    table.fail("viscous_asymmetry_Nms_rad", "must not be larger than viscous_Nms_rad");
  law.offset = table.number_or("offset_Nm", 0.0, any_torque);
  if (law.breakaway < law.coulomb) table.fail("breakaway_Nm", "must not be smaller than coulomb_Nm");
  return law;
}

/// Mass, centre of mass and moments of links that the file gives in place of the URDF's: `[link.NAME]`.
void change_links(const TomlTable& links, RobotDescription& robot) {
  for (RobotLink& link : robot.links) {
    const TomlTable own = links.table(link.name);
    for (const char* key : {"mass_kg", "com_mm", "inertia_kg_m2"}) {
      if (own.has(key) && !(link.inertia.mass > 0.0))
        own.fail(key, "only of a link that has a mass in the URDF");
    }
    if (!(link.inertia.mass > 0.0)) continue;
    const double was = link.inertia.mass;
    const double mass = own.number_or("mass_kg", was, Range::above(0.0, 1e9));
    Eigen::Vector3d com = link.inertia.centre();
    Eigen::Matrix3d inertia = link.inertia.about_own_centre() * (mass / was);
    if (own.has("com_mm")) {
      const auto c = own.numbers("com_mm", 3, 3, Range::from(-1e6, 1e6), base::mm);
      if (c.size() == 3) com = {c[0], c[1], c[2]};
    }
    if (own.has("inertia_kg_m2")) {
      const auto i = own.numbers("inertia_kg_m2", 3, 3, positive);
      if (i.size() == 3) {
        const double largest = std::max({i[0], i[1], i[2]});
        if (base::exceeds(largest, i[0] + i[1] + i[2] - largest))
          own.fail("inertia_kg_m2", "must not have a moment larger than the two others together");
        inertia = Eigen::Vector3d(i[0], i[1], i[2]).asDiagonal();
      }
    }
    link.inertia = SpatialInertia::about_centre(mass, com, inertia);
  }
}

/// Cuts the links for which `[link.NAME]` has a bending compliance.
std::vector<Flexure> bend_links(const TomlTable& links, RobotDescription& robot) {
  constexpr double least_compliance = 1e-15,
                   most_compliance = 1e3;      // [rad/(N m)], of a link that is not rigid
  constexpr double usual_damping_time = 1e-3;  // [s]
  std::vector<Flexure> flexures;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const TomlTable own = links.table(robot.links[i].name);
    const double compliance =
        own.number_or("bending_compliance_rad_Nm", 0.0, Range::from(0.0, most_compliance));
    const double time = own.number_or("bending_damping_time_s", usual_damping_time, Range::from(0.0, 10.0));
    if (compliance > 0.0 && compliance < least_compliance)
      own.fail("bending_compliance_rad_Nm",
               fmt::format("must be 0, or {:g} to {:g}", least_compliance, most_compliance));
    if (!(compliance >= least_compliance)) continue;
    if (!can_bend(robot, i)) {
      own.fail("bending_compliance_rad_Nm", "only of a link on a moving joint that has a mass and a length");
      continue;
    }
    flexures.push_back(bend_link(robot, i, 1.0 / compliance, time / compliance));
    i += flexures.back().hinges.size();  // which stand before the link now
  }
  return flexures;
}

/// The drive of a joint; a servo without a limit of its own has the effort of the URDF's <limit>, where that
/// is > 0.
Drive drive_of(const TomlTable& table, const RobotJoint& joint) {
  Drive drive;
  if (positive.contains(joint.effort)) drive.limit = joint.effort;
  const auto mode = table.choice("drive", drive_modes);
  drive.mode = mode.value_or(DriveMode::limp);
  if (!mode) know(table, {"proportional_Nm_rad", "derivative_Nms_rad", "limit_Nm"});
  if (drive.mode != DriveMode::servo) {
    drive.limit = Drive().limit;
    return drive;
  }
  drive.proportional = table.number("proportional_Nm_rad", positive);
  drive.derivative = table.number("derivative_Nms_rad", not_negative);
  drive.limit = table.number_or("limit_Nm", drive.limit, positive);
  return drive;
}

/// Reads an arm file. Without the arm's bodies nothing else in it has a meaning: their problems are reported
/// alone.
class ArmReader {
 public:
  ArmReader(TomlDocument& document, const std::filesystem::path& file)
      : document_(document), folder_(file.parent_path()), root_(document.root()) {
    arm_.file = file;
  }

  ArmDescription read() {
    base::require_schema(root_, "snare-arm/1");
    arm_.title = root_.text("title");
    arm_.source = root_.text_or("source", "");
    if (root_.has("gravity_m_s2")) {
      const auto g = root_.numbers("gravity_m_s2", 3, 3, Range::from(-1e6, 1e6));
      if (g.size() == 3) tree().gravity = {g[0], g[1], g[2]};
    }
    read_bodies();
    const TomlTable joints = root_.table("joint"), common = root_.table("every_joint");
    if (whole_) {
      add_motors(joints, common);
      add_hinges();
      if (arm_.joints.empty())
        root_.fail("urdf", "must have at least one revolute, continuous or prismatic joint");
    }
    for (const TomlTable& pose : root_.tables("pose")) arm_.poses.push_back(pose_of(pose));
    document_.finish();
    return std::move(arm_);
  }

 private:
  Tree& tree() { return arm_.arm.tree; }

  /// The base, the arm on it, and what the arm carries.
  void read_bodies() {
    int mount = 0;
    RootJoint arm_root = RootJoint::fixed;
    if (root_.has("base")) {
      const TomlTable base = root_.table("base");
      const auto kind = base.choice("kind", base_kinds);
      const RootJoint joint = kind == BaseKind::free ? RootJoint::free : RootJoint::fixed;
      if (base.has("urdf")) {
        const auto robot = robot_of(document_, base, folder_, arm_);
        if (robot && put(base, tree(), 0, joint, *robot)) mount = frame_of(base, "frame", tree());
        if (!robot) static_cast<void>(base.text("frame"));
      } else {
        arm_root = joint;
      }
    }
    const std::string urdf = root_.text("urdf");
    if (urdf.empty()) throw InputError({arm_.file.string(), 0, "urdf", "", "missing, must name a URDF file"});
    robot_ = read_urdf(folder_ / urdf);
    take_warnings(robot_, urdf, arm_);
    change_links(root_.table("link"), robot_);
    flexures_ = bend_links(root_.table("link"), robot_);
    arm_.input += robot_.text + document_.canonical();
    whole_ = mount >= 0 && put(root_, tree(), mount, arm_root, robot_);
    if (whole_) {
      for (const RobotLink& link : robot_.links) arm_.arm_mass += link.inertia.mass;
    }
    for (const TomlTable& load : root_.tables("payload")) {
      const auto carried = robot_of(document_, load, folder_, arm_);
      const int frame = whole_ ? frame_of(load, "on", tree()) : (static_cast<void>(load.text("on")), -1);
      if (carried && frame >= 0) static_cast<void>(put(load, tree(), frame, RootJoint::fixed, *carried));
    }
    // The tip may be a link of what the arm carries.
    if (whole_) {
      arm_.tip = frame_of(root_, "tip", tree());
    } else {
      static_cast<void>(root_.text("tip"));
    }
  }

  /// Motors, in the order of the arm's moving joints.
  void add_motors(const TomlTable& joints, const TomlTable& common) {
    for (const RobotJoint& joint : robot_.joints) {
      const bool hinge = std::ranges::any_of(flexures_, [&](const Flexure& flexure) {
        return std::ranges::count(flexure.hinges, joint.name) > 0;
      });
      if (!joint.kind || *joint.kind == JointKind::free || hinge) continue;
      const TomlTable own = joints.table(joint.name).over(common);
      ElasticJoint elastic;
      elastic.name = joint.name;
      const auto bent = std::ranges::find(flexures_, joint.child, &Flexure::root);
      elastic.link = bent == flexures_.end() ? joint.child : bent->link;
      elastic.body = tree().frame(tree().find_frame(joint.child)).body;
      elastic.motor_inertia = motor_inertia_of(own);
      if (const auto law = law_of(own)) elastic.spring = *law;
      elastic.friction = friction_of(own, joint);
      elastic.back_drive = own.number_or("back_drive_Nm", 0.0, not_negative);
      arm_.drives.push_back(drive_of(own, joint));
      arm_.arm.joints.push_back(elastic);
      arm_.joints.push_back(joint);
    }
  }

  /// Hinges of links that bend: joints whose motors never move.
  void add_hinges() {
    for (const Flexure& flexure : flexures_) {
      for (const std::string& name : flexure.hinges) {
        const auto hinge = std::ranges::find(robot_.joints, name, &RobotJoint::name);
        ElasticJoint elastic;
        elastic.name = name;
        elastic.link = flexure.link;
        elastic.body = tree().frame(tree().find_frame(hinge->child)).body;
        elastic.motor_inertia = 1.0;
        elastic.spring = DeflectionLaw::linear(flexure.stiffness, flexure.damping);
        elastic.flexure = true;
        arm_.arm.joints.push_back(elastic);
        arm_.drives.push_back(Drive::locked());
      }
    }
  }

  ArmPose pose_of(const TomlTable& pose) {
    ArmPose one;
    one.name = pose.text("name");
    if (!whole_) {
      static_cast<void>(pose.has("angles_deg"));
      return one;
    }
    const std::size_t count = arm_.joints.size();
    const auto angles = pose.numbers("angles_deg", count, count, Range::from(-720.0, 720.0), degree);
    one.angles = arm_.with_flexures(
        Eigen::Map<const Eigen::VectorXd>(angles.data(), static_cast<Eigen::Index>(angles.size())));
    for (std::size_t k = 0; k < angles.size(); ++k) {
      const RobotJoint& joint = arm_.joints[k];
      if (angles[k] >= joint.lower - 1e-9 && angles[k] <= joint.upper + 1e-9) continue;
      pose.fail_element("angles_deg", k,
                        fmt::format("must be {:.4g} to {:.4g}, the limits of {}", joint.lower / degree,
                                    joint.upper / degree, joint.name));
    }
    return one;
  }

  TomlDocument& document_;
  std::filesystem::path folder_;
  TomlTable root_;
  ArmDescription arm_;
  RobotDescription robot_;
  std::vector<Flexure> flexures_;
  bool whole_ = false;  // the arm's bodies are there
};

}  // namespace

ArmDescription read_arm(const std::filesystem::path& file, const std::vector<base::Override>& overrides) {
  TomlDocument document(file, overrides);
  return ArmReader(document, file).read();
}

ArmDescription parse_arm(const std::filesystem::path& file, const std::string& text,
                         const std::vector<base::Override>& overrides) {
  TomlDocument document(file.string(), text, overrides);
  return ArmReader(document, file).read();
}

Eigen::VectorXd ArmDescription::with_flexures(const Eigen::VectorXd& angles) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(arm.motors());
  all.head(angles.size()) = angles;
  return all;
}

Eigen::VectorXd ArmDescription::coordinates(const Eigen::VectorXd& angles) const {
  Eigen::VectorXd q = zero_state(arm.tree).q;
  for (int k = 0; k < arm.motors(); ++k) q[arm.tree.body(arm.joints[at(k)].body).q_index] = angles[k];
  return q;
}

double reach(const ArmDescription& description) {
  const Tree& tree = description.arm.tree;
  const TreeFrame& tip = tree.frame(description.tip);
  double sum = tip.X_BF.p.norm();
  const int first = description.arm.joints.front().body;
  for (int i = tip.body; i >= 0 && i != first; i = tree.body(i).parent) sum += tree.body(i).X_PJ.p.norm();
  return sum;
}

}  // namespace snare::multibody
