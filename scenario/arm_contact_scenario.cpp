#include "scenario/arm_contact_scenario.hpp"

#include "base/units.hpp"
#include "scenario/motion_reader.hpp"
#include "scenario/arm_scenario_file.hpp"
#include "base/toml_reader.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <numbers>
#include <optional>

namespace snare::scenario {

using Eigen::Vector3d;
using Eigen::VectorXd;
using multibody::Pose;
using base::Choice;
using base::Range;
using base::TomlDocument;
using base::TomlTable;

namespace {

using base::mm;
using base::degree;
constexpr std::string_view prefix = "contact.";

/// Runs a reader of another file; its problems go to the document.
template <class Read>
auto read_beside(TomlDocument& document, const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const base::InputError& error) {
    for (const base::InputProblem& problem : error.problems()) document.add(problem);
    return std::nullopt;
  }
}

}  // namespace

ArmContactScenario read_arm_contact_scenario(const std::filesystem::path& file,
                                             const std::vector<base::Override>& overrides) {
  std::vector<base::Override> own, inner;
  for (const base::Override& one : overrides) {
    if (!one.key.starts_with(prefix)) {
      own.push_back(one);
      continue;
    }
    base::Override passed = one;
    passed.key = one.key.substr(prefix.size());
    inner.push_back(passed);
  }
  TomlDocument document(file, own);
  const TomlTable root = document.root();
  ArmContactScenario scenario;
  scenario.file = file;
  static constexpr Choice<bool> schemas[] = {{"snare-scenario/1", true}};
  static_cast<void>(root.choice("schema", schemas));
  static constexpr Choice<bool> kinds[] = {{"arm_contact", true}};
  static_cast<void>(root.choice("kind", kinds));
  scenario.title = root.text("title");
  scenario.source = root.text_or("source", "");
  using Carries = ArmContactScenario::Carries;
  using Hold = ArmContactScenario::Hold;
  static constexpr Choice<Carries> carried[] = {{"wire", Carries::wire}, {"body", Carries::body}};
  scenario.carries = root.choice("carries", carried).value_or(Carries::wire);
  static constexpr Choice<Hold> holds[] = {
      {"as_described", Hold::as_described}, {"limp", Hold::limp}, {"locked", Hold::locked}};
  scenario.hold = root.choice("hold", holds).value_or(Hold::as_described);
  scenario.X_CT.p = read_vector_or_zero(root, "tip_mm", Range::from(-1e5, 1e5), mm);
  const Vector3d turn = read_vector_or_zero(root, "tip_rpy_deg", Range::from(-360.0, 360.0), degree);
  scenario.X_CT.R =
      (Eigen::AngleAxisd(turn.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(turn.y(), Vector3d::UnitY()) *
       Eigen::AngleAxisd(turn.x(), Vector3d::UnitX()))
          .toRotationMatrix();
  const std::optional<double> duration = root.optional_number("duration_s", Range::above(0.0, 1e6));
  const std::optional<double> interval = root.optional_number("output_interval_s", Range::above(0.0, 1e6));
  const std::string arm_name = root.text("arm"), contact_name = root.text("contact");
  std::optional<ContactScenario> contact;
  if (!contact_name.empty())
    contact = read_beside(document,
                          [&] { return read_contact_scenario(file.parent_path() / contact_name, inner); });
  std::optional<multibody::ArmDescription> arm;
  if (!arm_name.empty())
    arm = read_beside(document, [&] { return multibody::read_arm(file.parent_path() / arm_name); });
  if (arm) {
    scenario.angles = scenario::read_pose(root, "pose", "angles_deg", *arm);
    scenario.arm = std::move(*arm);
  } else {
    static_cast<void>(root.has("pose"));
    static_cast<void>(root.has("angles_deg"));
  }
  if (contact) {
    scenario.contact = std::move(*contact);
    coupling::MotionOptions& options = scenario.contact.options;
    if (duration) {
      options.duration = *duration;
      options.checkpoint_interval = std::max(options.checkpoint_interval, default_checkpoint_interval(*duration));
    }
    if (interval) options.output_interval = *interval;
    constexpr double most_outputs = 1e6;
    if (options.duration / options.output_interval > most_outputs)
      root.fail("output_interval_s", fmt::format("gives more than {:g} lines", most_outputs));
    if (scenario.carries == Carries::wire) {
      for (const WireModel& model : scenario.contact.models) {
        if (model.law) {
          root.fail(
              "carries",
              fmt::format("must be \"body\" with the model {}: a law acts against a plane that stands still",
                          model.name));
        }
      }
    }
  }
  scenario.input = document.canonical() + scenario.arm.input + scenario.contact.input;
  document.finish();
  return scenario;
}

coupling::Motion motion_of(const ArmContactScenario& scenario, const WireModel& model) {
  coupling::Motion motion = motion_of(scenario.contact, model);
  coupling::MotionArm arm;
  arm.arm = scenario.arm.arm;
  arm.drives = scenario.arm.drives;
  multibody::Tree& tree = arm.arm.tree;
  const int tip = scenario.arm.tip;

  // Where what is carried stands fixes the tip, and the tip the base.
  const coupling::MotionBody& body = motion.bodies.front();
  multibody::Pose X_WC;
  if (scenario.carries == ArmContactScenario::Carries::body)
    X_WC = {body.start.orientation.toRotationMatrix(), body.start.position};
  const VectorXd q = scenario.arm.coordinates(scenario.angles);
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, q, kinematics);
  tree.move(X_WC * scenario.X_CT * multibody::frame_pose(tree, kinematics, tip).inverse());
  arm.start = multibody::resting(arm.arm, q);
  for (int k = 0; k < arm.arm.motors(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (scenario.hold == ArmContactScenario::Hold::limp) arm.drives[i] = multibody::Drive::limp();
    if (scenario.hold == ArmContactScenario::Hold::locked) arm.drives[i] = multibody::Drive::locked();
    arm.drives[i].course = {scenario.angles[k], scenario.angles[k], 0.0, 0.0};
  }
  if (scenario.carries == ArmContactScenario::Carries::body) {
    multibody::place(tree, q, kinematics);
    const Vector3d spin = body.start.orientation * body.start.spin;
    const Vector3d arm_to_tip = multibody::frame_pose(tree, kinematics, tip).p - body.start.position;
    multibody::Vector6 wanted;
    wanted << spin, body.start.velocity + spin.cross(arm_to_tip);
    const multibody::Matrix6X J = multibody::frame_jacobian(tree, kinematics, tip);
    // Only the joints with motors move; a free base stands.
    Eigen::MatrixXd of_joints(6, arm.arm.motors());
    for (int k = 0; k < arm.arm.motors(); ++k)
      of_joints.col(k) = J.col(tree.body(arm.arm.joints[static_cast<std::size_t>(k)].body).v_index);
    const VectorXd rates = of_joints.completeOrthogonalDecomposition().solve(wanted);
    for (int k = 0; k < arm.arm.motors(); ++k) {
      arm.start.v[tree.body(arm.arm.joints[static_cast<std::size_t>(k)].body).v_index] = rates[k];
      if (scenario.hold != ArmContactScenario::Hold::locked) arm.start.motor_rate[k] = rates[k];
    }
    coupling::MotionWeld weld;
    weld.name = "grasp";
    weld.carrier = {coupling::MotionCarrier::Kind::arm, 0, tip};
    motion.welds.push_back(weld);
  } else {
    for (std::size_t w = 0; w < motion.wires.size(); ++w) {
      for (const bool right : {false, true}) {
        coupling::MotionMount mount;
        mount.name = motion.wires[w].name + (right ? " right mount" : " left mount");
        mount.wire = static_cast<int>(w);
        mount.right = right;
        mount.carrier = {coupling::MotionCarrier::Kind::arm, 0, tip};
        motion.mounts.push_back(mount);
      }
    }
  }
  motion.arms.push_back(std::move(arm));
  return motion;
}

}  // namespace snare::scenario
