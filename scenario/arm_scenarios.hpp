#pragma once

#include "multibody/arm/arm_file.hpp"
#include "multibody/arm/arm_run.hpp"
#include "scenario/hold.hpp"
#include "scenario/swings.hpp"

#include <vector>

namespace snare::scenario {

/// The step test of one joint (Abiko et al., sec. 3.1): its motor jumps by `step` at the start and is then
/// held by its brake, the other motors are locked; the link, at rest, finds its spring wound up by -step and
/// swings.                                                                                   theory.md (A.17)
/// joint: index; step [rad].
[[nodiscard]] multibody::ArmScenario joint_step(const multibody::ArmDescription& description,
                                                const Eigen::VectorXd& angles, int joint, double step,
                                                double end);

/// The same with the motor driven by its servo to the new angle, as a command would. angles and step [rad],
/// end [s].
[[nodiscard]] multibody::ArmScenario commanded_step(const multibody::ArmDescription& description,
                                                    const Eigen::VectorXd& angles, int joint, double step,
                                                    double end);

/// An arm at rest, pushed at its tip by half a sine of force, in the world's axes.
/// impulse: of the force [N s]; duration > 0 [s], from t = 0.
[[nodiscard]] multibody::ArmScenario tip_impulse(const multibody::ArmDescription& description,
                                                 const Eigen::VectorXd& angles, Hold how,
                                                 const Eigen::Vector3d& impulse, double duration, double end);

/// The joints go from one pose to another under their servos; a free base answers.
/// angles from and to [rad]; duration and end [s]. Throws std::invalid_argument when a joint has no servo.
[[nodiscard]] multibody::ArmScenario joint_motion(const multibody::ArmDescription& description,
                                                  const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                                  double duration, double end);

/// The swings of a joint in a history.
[[nodiscard]] std::vector<Swing> swings(const multibody::ArmHistory& history,
                                        const multibody::ElasticArm& arm, int joint);

}  // namespace snare::scenario
