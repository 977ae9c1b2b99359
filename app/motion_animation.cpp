#include "app/motion_animation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>

namespace snare::app {

using coupling::MotionSample;
using Eigen::Vector3d;

namespace {

constexpr double mm = 1e3;  // [mm/m]

/// Every so many samples give a frame.
std::size_t stride(const std::vector<MotionSample>& samples) {
  constexpr std::size_t most_frames = 200;
  return std::max<std::size_t>(1, samples.size() / most_frames);
}

std::string label_of(const MotionSample& s) {
  double force = 0.0;
  for (const coupling::ContactSample& c : s.contacts) force += c.normal_force;
  return fmt::format("t = {:.4f} s, {:.3g} N", s.time, force);
}

std::vector<double> polyline(const Eigen::Matrix3Xd& points, Eigen::Index across) {
  std::vector<double> line;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    line.insert(line.end(), {mm * points(across, i), mm * points(1, i)});
  return line;
}

/// From the base through the bodies that lead to the outermost one of every chain, and back.
std::vector<double> skeleton(const multibody::Tree& tree, const Eigen::VectorXd& q, Eigen::Index across) {
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, q, kinematics);
  std::set<int> inner;
  for (const multibody::TreeBody& b : tree.bodies()) inner.insert(b.parent);
  std::vector<double> line;
  const auto add = [&](int body) {
    const Vector3d& p = kinematics.X_WB[static_cast<std::size_t>(body)].p;
    line.insert(line.end(), {mm * p[across], mm * p.y()});
  };
  for (int end = 0; end < tree.size(); ++end) {
    if (inner.contains(end)) continue;
    std::vector<int> chain;
    for (int i = end; i >= 0; i = tree.body(i).parent) chain.push_back(i);
    std::for_each(chain.rbegin(), chain.rend(), add);
    for (const multibody::TreeFrame& f : tree.frames()) {
      if (f.body != end) continue;
      const Vector3d p = (kinematics.X_WB[static_cast<std::size_t>(end)] * f.X_BF).p;
      line.insert(line.end(), {mm * p[across], mm * p.y()});
      add(end);
    }
    std::for_each(chain.begin(), chain.end(), add);
  }
  return line;
}

}  // namespace

AnimationSpecification animation_of(const coupling::ContactScenario& scenario, const std::string& model,
                                    const std::vector<MotionSample>& samples) {
  AnimationSpecification animation{
      "Wire and probe: " + model,
      {"wire", "probe", "arm to the centre of mass"},
      {},
      "To scale; the probe is the circle, the line from it leads to the body's centre of mass."};
  constexpr int corners = 36;
  const double radius = scenario.push.pusher.radius;
  for (std::size_t k = 0; k < samples.size(); k += stride(samples)) {
    const MotionSample& s = samples[k];
    AnimationFrame frame{label_of(s), {{}, {}, {}}};
    for (const Eigen::Matrix3Xd& w : s.wires) frame.outlines[0] = polyline(w, 0);
    const multibody::RigidBodyState& b = s.bodies.front();
    const Vector3d probe = b.position + b.orientation * scenario.probe;
    for (int i = 0; i <= corners; ++i) {
      const double a = 2.0 * std::numbers::pi * i / corners;
      frame.outlines[1].insert(frame.outlines[1].end(),
                               {mm * (probe.x() + radius * std::cos(a)), mm * (probe.y() + radius * std::sin(a))});
    }
    frame.outlines[2] = {mm * probe.x(), mm * probe.y(), mm * b.position.x(), mm * b.position.y()};
    animation.frames.push_back(std::move(frame));
  }
  return animation;
}

AnimationSpecification animation_of(const coupling::Motion& motion, const std::vector<MotionSample>& samples, View view) {
  const bool along_z = view == View::along_z;
  const Eigen::Index across = along_z ? 0 : 2;
  AnimationSpecification animation{
      along_z ? "Seen along z: x to the right, y up" : "Seen along x: z to the right, y up",
      {},
      {},
      motion.arms.empty() ? "To scale; the bodies' centres of mass are the small crosses."
                          : "To scale; the bodies' centres of mass are the small crosses, the arm a line from joint to joint."};
  const double cross = motion.arms.empty() ? 2.0 : 100.0;  // half its size, that it may be seen beside an arm [mm]
  for (std::size_t k = 0; k < samples.size(); k += stride(samples)) {
    const MotionSample& s = samples[k];
    AnimationFrame frame{label_of(s), {}};
    for (const Eigen::Matrix3Xd& w : s.wires) frame.outlines.push_back(polyline(w, across));
    for (const multibody::RigidBodyState& b : s.bodies) {
      const double x = mm * b.position[across];
      const double y = mm * b.position.y();
      frame.outlines.push_back({x - cross, y, x + cross, y, x, y, x, y - cross, x, y + cross});
    }
    for (std::size_t a = 0; a < s.arms.size(); ++a)
      frame.outlines.push_back(skeleton(motion.arms[a].arm.tree, s.arms[a].state.q, across));
    animation.frames.push_back(std::move(frame));
  }
  for (const auto& w : motion.wires) animation.names.push_back(w.name);
  for (const auto& b : motion.bodies) animation.names.push_back(b.name);
  for (const auto& a : motion.arms) animation.names.push_back(a.name);
  return animation;
}

}  // namespace snare::app
