#include "scenario/arm_contact_scenario.hpp"

#include "base/index.hpp"
#include "base/units.hpp"
#include "numerics/dense_solvers.hpp"
#include "scenario/arm_reader.hpp"
#include "scenario/contact_scenario.hpp"
#include "scenario/hold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace snare::scenario {

using base::at;
using base::Choice;
using base::Range;
using base::TomlDocument;
using base::TomlTable;
using Eigen::Vector3d;
using Eigen::VectorXd;
using multibody::Pose;

namespace {

enum class Carries { wire, body };

/// An arm with what its tip carries.
struct CarryingArm {
  multibody::ArmDescription arm;
  VectorXd angles;  ///< of the arm's joints at the start [rad]
  Carries carries = Carries::wire;
  Hold hold = Hold::as_described;
  /// Of the arm's tip: in the wire's frame (left mount, x along the chord, y with the bulge), or in the body's.
  Pose X_CT;
};

/// Duration and interval given beside the contact scenario hold in place of its own.
void override_times(const TomlTable& root, std::optional<double> duration, std::optional<double> interval,
                    coupling::MotionOptions& options) {
  if (duration) {
    options.duration = *duration;
    options.checkpoint_interval = std::max(options.checkpoint_interval, default_checkpoint_interval(*duration));
  }
  if (interval) options.output_interval = *interval;
  check_output_interval(root, options.duration, options.output_interval);
}

void require_standing_wires(const TomlTable& root, const std::vector<WireModel>& models) {
  for (const WireModel& model : models) {
    if (!model.law) continue;
    root.fail("carries", fmt::format("must be \"body\" with the model {}: a law acts against a plane that stands still",
                                     model.name));
  }
}

/// What is carried fixes the tip, the tip the base: X_WBase = X_WC X_CT X_BaseT^-1.
void place_base(const CarryingArm& asked, const coupling::MotionBody& body, multibody::Tree& tree, const VectorXd& q) {
  Pose X_WC;  // the wire's frame is the world
  if (asked.carries == Carries::body) X_WC = {body.start.orientation.toRotationMatrix(), body.start.position};
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, q, kinematics);
  tree.move(X_WC * asked.X_CT * multibody::frame_pose(tree, kinematics, asked.arm.tip).inverse());
}

/// Rates of the joints with motors [rad/s] that give the tip the body's motion: J rates = (w, v + w x p_BT), least squares.
/// A free base stands.
VectorXd rates_with(const multibody::ElasticArm& arm, int tip, const VectorXd& q, const coupling::MotionBody& body) {
  multibody::Kinematics kinematics(arm.tree);
  multibody::place(arm.tree, q, kinematics);
  const Vector3d spin = body.start.orientation * body.start.spin;
  const Vector3d p_BT = multibody::frame_pose(arm.tree, kinematics, tip).p - body.start.position;
  multibody::Vector6 wanted;
  wanted << spin, body.start.velocity + spin.cross(p_BT);
  const multibody::Matrix6X J = multibody::frame_jacobian(arm.tree, kinematics, tip);
  Eigen::MatrixXd of_joints(6, arm.motors());
  for (int k = 0; k < arm.motors(); ++k) of_joints.col(k) = J.col(arm.tree.body(arm.joints[at(k)].body).v_index);
  return numerics::least_squares(of_joints, wanted);
}

/// The arm with its base in place, at rest or with the body's motion.
coupling::MotionArm arm_of(const CarryingArm& asked, const coupling::MotionBody& body) {
  coupling::MotionArm arm;
  arm.arm = asked.arm.arm;
  arm.drives = asked.arm.drives;
  const VectorXd q = asked.arm.coordinates(asked.angles);
  place_base(asked, body, arm.arm.tree, q);
  arm.start = multibody::resting(arm.arm, q);
  hold(asked.hold, asked.angles, arm.drives);
  if (asked.carries != Carries::body) return arm;
  const VectorXd rates = rates_with(arm.arm, asked.arm.tip, q, body);
  for (int k = 0; k < arm.arm.motors(); ++k) {
    arm.start.v[arm.arm.tree.body(arm.arm.joints[at(k)].body).v_index] = rates[k];
    if (asked.hold != Hold::locked) arm.start.motor_rate[k] = rates[k];
  }
  return arm;
}

/// The motion's first body, or both ends of all its wires, on the arm's tip.
void add_arm(const CarryingArm& asked, coupling::Motion& motion) {
  motion.arms.push_back(arm_of(asked, motion.bodies.front()));
  const coupling::MotionCarrier tip{coupling::MotionCarrier::Kind::arm, 0, asked.arm.tip};
  if (asked.carries == Carries::body) {
    coupling::MotionWeld weld;
    weld.name = "grasp";
    weld.carrier = tip;
    motion.welds.push_back(weld);
    return;
  }
  for (std::size_t w = 0; w < motion.wires.size(); ++w) {
    for (const wire::End end : wire::ends) {
      coupling::MotionMount mount;
      mount.name = motion.wires[w].name + (end == wire::End::left ? " left mount" : " right mount");
      mount.wire = static_cast<int>(w);
      mount.end = end;
      mount.carrier = tip;
      motion.mounts.push_back(mount);
    }
  }
}

}  // namespace

WireMotions read_arm_contact(TomlDocument& document, const std::filesystem::path& folder,
                             const std::vector<base::Override>& contact_overrides) {
  const TomlTable root = document.root();
  CarryingArm asked;
  static constexpr Choice<Carries> carried[] = {{"wire", Carries::wire}, {"body", Carries::body}};
  asked.carries = root.choice("carries", carried).value_or(Carries::wire);
  asked.hold = root.choice("hold", holds).value_or(Hold::as_described);
  asked.X_CT.p = read_vector_or_zero(root, "tip_mm", Range::from(-farthest_mm, farthest_mm), base::mm);
  asked.X_CT.R = read_roll_pitch_yaw(root, "tip_rpy_deg");
  const std::optional<double> duration = root.optional_number("duration_s", Range::above(0.0, 1e6));
  const std::optional<double> interval = root.optional_number("output_interval_s", Range::above(0.0, 1e6));
  static_cast<void>(root.text("arm"));  // reported before `contact`
  const std::string contact_name = root.text("contact");
  std::optional<ContactScenario> contact;
  if (!contact_name.empty()) {
    contact =
        base::read_beside(document, [&] { return read_contact_scenario(folder / contact_name, contact_overrides); });
  }
  std::optional<multibody::ArmDescription> arm = read_arm_beside(document, folder);
  if (arm) {
    asked.angles = read_pose(root, "pose", "angles_deg", *arm);
    asked.arm = std::move(*arm);
  } else {
    static_cast<void>(root.has("pose"));
    static_cast<void>(root.has("angles_deg"));
  }
  if (contact) {
    override_times(root, duration, interval, contact->options);
    if (asked.carries == Carries::wire) {
      require_standing_wires(root, contact->models);
      if (contact->damping.mass_rate > 0.0)
        root.fail("contact", "has damping.mass_rate_1_s: that drags against the world, which the arm's wire leaves");
    }
  }
  if (!arm || !contact) finish_without(document, arm ? "contact" : "arm");
  document.finish();
  WireMotions motions = motions_of(*contact);
  motions.input = document.canonical(least_advance_key) + asked.arm.input + contact->input;
  for (NamedMotion& run : motions.runs) add_arm(asked, run.motion);
  return motions;
}

}  // namespace snare::scenario
