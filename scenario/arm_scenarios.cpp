#include "scenario/arm_scenarios.hpp"

#include "base/index.hpp"

#include <cmath>
#include <numbers>
#include <optional>
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

multibody::ArmScenario commanded_step(const multibody::ArmDescription& description, const Eigen::VectorXd& angles,
                                      int joint, double step, double end) {
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

multibody::ArmScenario tip_impulse(const multibody::ArmDescription& description, const Eigen::VectorXd& angles,
                                   Hold how, const Eigen::Vector3d& impulse, double duration, double end) {
  multibody::ArmScenario scenario = standing(description, angles, end);
  hold(how, angles, scenario.drives);
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
    multibody::Drive& drive = scenario.drives[at(k)];
    if (drive.mode != multibody::DriveMode::servo) throw std::invalid_argument("a joint that moves needs a servo");
    drive.course = {from[k], to[k], 0.0, duration};
  }
  return scenario;
}

std::vector<Swing> swings(const multibody::ArmHistory& history, const multibody::ElasticArm& arm, int joint) {
  const int velocity = arm.tree.body(arm.joints[at(joint)].body).v_index;
  std::vector<Swing> found;
  std::optional<double> last_zero;
  double peak = 0.0;
  for (std::size_t i = 0; i + 1 < history.samples.size(); ++i) {
    const multibody::ArmSample& a = history.samples[i];
    const multibody::ArmSample& b = history.samples[i + 1];
    const double h = b.time - a.time;
    const double da = a.deflection[joint], db = b.deflection[joint];
    const double va = h * (a.state.v[velocity] - a.state.motor_rate[joint]);
    const double vb = h * (b.state.v[velocity] - b.state.motor_rate[joint]);
    const auto cubic = [&](double s) {
      return (1 + 2 * s) * (1 - s) * (1 - s) * da + s * (1 - s) * (1 - s) * va + s * s * (3 - 2 * s) * db -
             s * s * (1 - s) * vb;
    };
    if (std::abs(da) > std::abs(peak)) peak = da;
    if (va * vb < 0.0 && da * va > 0.0) {  // an extreme between the samples
      double s = va / (va - vb);
      if (std::abs(cubic(s)) > std::abs(peak)) peak = cubic(s);
    }
    if (!((da < 0.0) != (db < 0.0))) continue;
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (low + high);
      ((cubic(middle) < 0.0) == (da < 0.0) ? low : high) = middle;
    }
    const double zero = a.time + h * low;
    if (last_zero) found.push_back({*last_zero, zero, peak});
    last_zero = zero;
    peak = 0.0;
  }
  return found;
}

}  // namespace snare::scenario
