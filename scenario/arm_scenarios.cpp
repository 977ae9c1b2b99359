#include "scenario/arm_scenarios.hpp"

#include "base/index.hpp"

#include <numbers>
#include <stdexcept>

namespace snare::scenario {

namespace {

using base::at;

multibody::ArmScenario standing(const multibody::ArmDescription& description, const Eigen::VectorXd& angles,
                                double end) {
  multibody::ArmScenario scenario;
  scenario.arm = description.arm;
  scenario.initial = resting(description.arm, description.coordinates(angles));
  scenario.drives = description.drives;
  for (int k = 0; k < description.arm.motors(); ++k) {
    multibody::Course& course = scenario.drives[at(k)].course;
    course = {};
    course.from = course.to = angles[k];
  }
  scenario.end = end;
  scenario.ida.relative_tolerance = 1e-7;
  scenario.tolerances = {1e-10, 1e-9};  // of deflections of some 1e-4 rad
  return scenario;
}

}  // namespace

multibody::ArmScenario joint_step(const multibody::ArmDescription& description, const Eigen::VectorXd& angles,
                                  int joint, double step, double end) {
  multibody::ArmScenario scenario = standing(description, angles, end);
  scenario.initial.motor[joint] += step;
  for (multibody::Drive& drive : scenario.drives) drive = multibody::Drive::locked();
  return scenario;
}

multibody::ArmScenario commanded_step(const multibody::ArmDescription& description,
                                      const Eigen::VectorXd& angles, int joint, double step, double end) {
  multibody::ArmScenario scenario = standing(description, angles, end);
  for (int k = 0; k < description.arm.motors(); ++k) {
    if (k != joint) scenario.drives[at(k)] = multibody::Drive::locked();
  }
  multibody::Drive& drive = scenario.drives[at(joint)];
  if (drive.mode != multibody::DriveMode::servo)
    throw std::invalid_argument("the joint of a commanded step needs a servo");
  drive.course.to = drive.course.from + step;
  return scenario;
}

multibody::ArmScenario tip_impulse(const multibody::ArmDescription& description,
                                   const Eigen::VectorXd& angles, Hold how, const Eigen::Vector3d& impulse,
                                   double duration, double end) {
  multibody::ArmScenario scenario = standing(description, angles, end);
  hold(how, angles, description.arm, scenario.drives);
  // The area of half a sine is 2/pi of its peak times its duration.
  multibody::TimedLoad load;
  load.frame = description.tip;
  load.peak.force = impulse * std::numbers::pi / (2.0 * duration);
  load.duration = duration;
  scenario.loads.push_back(load);
  return scenario;
}

multibody::ArmScenario joint_motion(const multibody::ArmDescription& description, const Eigen::VectorXd& from,
                                    const Eigen::VectorXd& to, double duration, double end) {
  multibody::ArmScenario scenario = standing(description, from, end);
  for (int k = 0; k < description.arm.motors(); ++k) {
    if (description.arm.joints[at(k)].flexure) continue;
    multibody::Drive& drive = scenario.drives[at(k)];
    if (drive.mode != multibody::DriveMode::servo)
      throw std::invalid_argument("a joint that moves needs a servo");
    drive.course = {from[k], to[k], 0.0, duration};
  }
  return scenario;
}

std::vector<Swing> swings(const multibody::ArmHistory& history, const multibody::ElasticArm& arm, int joint) {
  const int velocity = arm.tree.body(arm.joints[at(joint)].body).v_index;
  std::vector<SwingSample> samples;
  samples.reserve(history.samples.size());
  for (const multibody::ArmSample& s : history.samples)
    samples.push_back({s.time, s.deflection[joint], s.state.v[velocity] - s.state.motor_rate[joint]});
  return swings(samples);
}

}  // namespace snare::scenario
