#include "scenario/outcome.hpp"

#include "base/index.hpp"
#include "scenario/frame_track.hpp"

#include <cmath>

namespace snare::scenario {

using base::at;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

/// Where the shaft's axis passes through the plane z = height of the snare's frame, and how fast that point
/// of the shaft moves there; none where it runs along the plane.
struct Crossing {
  Vector3d place, velocity;
};

std::optional<Crossing> crossing(const FrameTrack::State& shaft, const FrameTrack::State& snare,
                                 double height) {
  const multibody::Pose X_SF = snare.X_WF.inverse() * shaft.X_WF;
  const Vector3d axis = X_SF.R.col(2);
  if (std::abs(axis.z()) < 0.1) return std::nullopt;
  Crossing c;
  c.place = X_SF.p + (height - X_SF.p.z()) / axis.z() * axis;
  const Vector3d in_world = snare.X_WF.p + snare.X_WF.R * c.place;
  const Vector3d of_shaft = shaft.linear + shaft.angular.cross(in_world - shaft.X_WF.p);
  const Vector3d of_snare = snare.linear + snare.angular.cross(in_world - snare.X_WF.p);
  c.velocity = snare.X_WF.R.transpose() * (of_shaft - of_snare);
  return c;
}

/// Angle by which the sight from a point along a wire turns about z: that of the ring on the inner side, less
/// a turn beyond.
double swept(const Matrix3Xd& wire, const multibody::Pose& X_WS, const Vector3d& point) {
  double sum = 0.0;
  const multibody::Pose X_SW = X_WS.inverse();
  Eigen::Vector2d before;
  for (Eigen::Index i = 0; i < wire.cols(); ++i) {
    const Vector3d p = X_SW.p + X_SW.R * wire.col(i);
    const Eigen::Vector2d now = (p - point).head<2>();
    if (i > 0) sum += std::atan2(before.x() * now.y() - before.y() * now.x(), before.dot(now));
    before = now;
  }
  return sum;
}

}  // namespace

CaptureOutcome outcome_of(const CaptureTest& test, const coupling::Motion& motion,
                          const std::vector<coupling::MotionSample>& samples) {
  const FrameTrack shaft_track(motion, test.shaft), snare_track(motion, test.snare);
  CaptureOutcome outcome;
  for (const coupling::MotionSample& s : samples) {
    const FrameTrack::State shaft = shaft_track.at(s), snare = snare_track.at(s);
    outcome.enclosed = true;
    outcome.speed = 0.0;
    for (const int w : test.wires) {
      const Matrix3Xd& wire = s.wires[at(w)];
      const double height = (snare.X_WF.inverse().R * wire.rowwise().mean() + snare.X_WF.inverse().p).z();
      const std::optional<Crossing> c = crossing(shaft, snare, height);
      outcome.enclosed = outcome.enclosed && c && test.sense * swept(wire, snare.X_WF, c->place) > 0.0;
      if (!c) continue;
      outcome.place = c->place;
      outcome.speed = std::max(outcome.speed, c->velocity.norm());
    }
    if (!outcome.enclosed || outcome.speed > test.speed)
      outcome.caught_since.reset();
    else if (!outcome.caught_since)
      outcome.caught_since = s.time;
  }
  outcome.caught = outcome.caught_since && samples.back().time - *outcome.caught_since >= test.hold;
  if (!outcome.caught) outcome.caught_since.reset();
  return outcome;
}

}  // namespace snare::scenario
