#include "scenario/sensors.hpp"

#include "base/index.hpp"
#include "base/units.hpp"
#include "scenario/frame_track.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

namespace snare::scenario {

using base::at;
using coupling::MotionSample;
using Eigen::Vector3d;

namespace {

/// Column suffix and SI units in one unit of the column.
struct Unit {
  const char* suffix;
  double size;
};

Unit unit_of(const Sensor& sensor) {
  switch (sensor.kind) {
    case Sensor::Kind::position:
      return {"mm", base::mm};
    case Sensor::Kind::attitude:
      return {"deg", base::degree};
    case Sensor::Kind::joint_angle:
    case Sensor::Kind::motor_angle:
      return sensor.slides ? Unit{"mm", base::mm} : Unit{"deg", base::degree};
    case Sensor::Kind::velocity:
      return {"m_s", 1.0};
    case Sensor::Kind::rate:
      return {"deg_s", base::degree};
    case Sensor::Kind::motor_rate:
      return sensor.slides ? Unit{"mm_s", base::mm} : Unit{"deg_s", base::degree};
    case Sensor::Kind::joint_torque:
    case Sensor::Kind::drive_torque:
      return {sensor.slides ? "N" : "Nm", 1.0};
    case Sensor::Kind::contact_force:
    case Sensor::Kind::tension:
    case Sensor::Kind::mount_force:
      break;
  }
  return {"N", 1.0};
}

/// What a sensor sees of a sample [SI].
class Sight {
 public:
  Sight(const Sensor& sensor, const coupling::Motion& motion)
      : sensor_(sensor), motion_(motion), frame_(motion, sensor.frame), other_(motion, sensor.relative_to) {}

  [[nodiscard]] Vector3d of(const MotionSample& s) const {
    const auto one = [](double value) { return Vector3d(value, 0.0, 0.0); };
    const auto arm = [&]() -> const MotionSample::Arm& { return s.arms[at(sensor_.index)]; };
    const std::size_t wire = at(sensor_.index);
    switch (sensor_.kind) {
      case Sensor::Kind::position:
      case Sensor::Kind::attitude:
      case Sensor::Kind::velocity:
      case Sensor::Kind::rate:
        return of_frames(frame_.at(s), other_.at(s));
      case Sensor::Kind::joint_angle: {
        const multibody::ElasticArm& model = motion_.arms[at(sensor_.index)].arm;
        return one(arm().state.q[model.tree.body(model.joints[at(sensor_.joint)].body).q_index]);
      }
      case Sensor::Kind::motor_angle:
        return one(arm().state.motor[sensor_.joint]);
      case Sensor::Kind::motor_rate:
        return one(arm().state.motor_rate[sensor_.joint]);
      case Sensor::Kind::joint_torque:
        return one(arm().joint_torque[sensor_.joint]);
      case Sensor::Kind::drive_torque:
        return one(arm().drive_torque[sensor_.joint]);
      case Sensor::Kind::contact_force:
        return one(s.contacts[at(sensor_.index)].normal_force);
      case Sensor::Kind::tension:
        return one(coupling::end_tension(s, wire));
      case Sensor::Kind::mount_force:
        return one(s.mount_forces[2 * wire].norm());
    }
    return one(0.0);
  }

 private:
  [[nodiscard]] Vector3d of_frames(const FrameTrack::State& f, const FrameTrack::State& other) const {
    const Eigen::Matrix3d to_other = other.X_WF.R.transpose();
    const Vector3d apart = f.X_WF.p - other.X_WF.p;
    switch (sensor_.kind) {
      case Sensor::Kind::attitude: {
        const Eigen::AngleAxisd turn(Eigen::Matrix3d(to_other * f.X_WF.R));
        return turn.angle() * turn.axis();
      }
      case Sensor::Kind::velocity:
        return to_other * (f.linear - other.linear - other.angular.cross(apart));
      case Sensor::Kind::rate:
        return f.X_WF.R.transpose() * (f.angular - other.angular);
      default:
        return to_other * apart;
    }
  }

  const Sensor& sensor_;
  const coupling::Motion& motion_;
  FrameTrack frame_, other_;
};

/// Noise of the readings of a sensor, one after the other: one stream a sensor, so that what others there are
/// makes no difference to it.
class NoiseStream {
 public:
  explicit NoiseStream(const Sensor& sensor)
      : components_(sensor.components()), size_(sensor.noise), engine_(sensor.seed) {}

  [[nodiscard]] Vector3d of(long reading) {
    while (static_cast<long>(drawn_.size()) <= reading) {
      Vector3d& noise = drawn_.emplace_back(Vector3d::Zero());
      for (int a = 0; a < components_; ++a) noise[a] = size_ * normal_(engine_);
    }
    return drawn_[static_cast<std::size_t>(reading)];
  }

 private:
  int components_;
  double size_;
  boost::random::mt19937_64 engine_;
  boost::random::normal_distribution<double> normal_{0.0, 1.0};
  std::vector<Vector3d> drawn_;
};

}  // namespace

coupling::SensedSignal sensed_by(const Sensor& sensor) {
  coupling::SensedSignal signal;
  signal.interval = sensor.interval;
  signal.delay = sensor.delay;
  const auto kept = std::make_shared<const Sensor>(sensor);
  signal.make = [kept](const coupling::Motion& motion) -> coupling::SensedSignal::Sight {
    const auto sight = std::make_shared<const Sight>(*kept, motion);
    return [kept, sight](const MotionSample& s) -> Vector3d { return sight->of(s) / unit_of(*kept).size; };
  };
  if (sensor.noise > 0.0)
    signal.noise = [stream = std::make_shared<NoiseStream>(sensor)](long reading) {
      return stream->of(reading);
    };
  return signal;
}

std::string Sensor::unit_name() const {
  return unit_of(*this).suffix;
}

int Sensor::components() const {
  return kind <= Kind::rate ? 3 : 1;
}

double Sensor::unit() const {
  return unit_of(*this).size;
}

std::vector<std::string> Sensor::columns() const {
  const Unit unit = unit_of(*this);
  if (components() == 1) return {fmt::format("{}_{}", name, unit.suffix)};
  std::vector<std::string> names;
  for (const char axis : {'x', 'y', 'z'}) names.push_back(fmt::format("{}_{}_{}", name, axis, unit.suffix));
  return names;
}

Readings read_off(const Sensor& sensor, const coupling::Motion& motion,
                  const std::vector<MotionSample>& samples) {
  Readings readings;
  readings.values.resize(at(sensor.components()));
  if (samples.empty()) return readings;
  const Sight sight(sensor, motion);
  const Unit unit = unit_of(sensor);
  NoiseStream noise(sensor);
  std::size_t k = 0;
  const double last = samples.back().time;
  for (long i = 0;; ++i) {
    const double time = static_cast<double>(i) * sensor.interval;
    if (time > last + 1e-9 * sensor.interval) break;
    const double seen = std::max(samples.front().time, time - sensor.delay);
    while (k + 1 < samples.size() && samples[k + 1].time <= seen + 1e-9 * sensor.interval) ++k;
    Vector3d value = sight.of(samples[k]);
    const double beyond = seen - samples[k].time;
    if (k + 1 < samples.size() && beyond > 1e-9 * sensor.interval)
      value += beyond / (samples[k + 1].time - samples[k].time) * (sight.of(samples[k + 1]) - value);
    readings.times.push_back(time);
    const Vector3d error = sensor.noise > 0.0 ? noise.of(i) : Vector3d::Zero();
    for (int a = 0; a < sensor.components(); ++a)
      readings.values[at(a)].push_back(value[a] / unit.size + error[a]);
  }
  return readings;
}

}  // namespace snare::scenario
