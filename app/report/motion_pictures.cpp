#include "app/report/motion_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

namespace snare::app {

using coupling::MotionSample;
using Eigen::Vector3d;

namespace {

constexpr double mm_per_m = 1e3;

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

AnimationFrame::Line polyline(const Eigen::Matrix3Xd& points, Eigen::Index across) {
  AnimationFrame::Line line;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    line.insert(line.end(), {mm_per_m * points(across, i), mm_per_m * points(1, i)});
  return line;
}

/// From the base to the outermost body of every chain, and on to its frames.
std::vector<AnimationFrame::Line> skeleton(const multibody::Tree& tree, const Eigen::VectorXd& q, Eigen::Index across) {
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, q, kinematics);
  const auto pose = [&](int body) { return kinematics.X_WB[static_cast<std::size_t>(body)]; };
  std::set<int> inner;
  for (const multibody::TreeBody& b : tree.bodies()) inner.insert(b.parent);
  std::vector<AnimationFrame::Line> lines;
  for (int end = 0; end < tree.size(); ++end) {
    if (inner.contains(end)) continue;
    std::vector<Vector3d> chain;
    for (int i = end; i >= 0; i = tree.body(i).parent) chain.push_back(pose(i).p);
    std::reverse(chain.begin(), chain.end());
    lines.push_back(polyline(
        Eigen::Map<const Eigen::Matrix3Xd>(chain.front().data(), 3, static_cast<Eigen::Index>(chain.size())), across));
    for (const multibody::TreeFrame& f : tree.frames()) {
      if (f.body != end) continue;
      Eigen::Matrix3Xd line(3, 2);
      line << pose(end).p, (pose(end) * f.X_BF).p;
      lines.push_back(polyline(line, across));
    }
  }
  return lines;
}

/// Lines of the shapes of every body, in the body's frame.
std::vector<std::vector<Eigen::Matrix3Xd>> shapes_of(const coupling::Motion& motion) {
  std::vector<std::vector<Eigen::Matrix3Xd>> lines(motion.bodies.size());
  std::set<std::pair<int, const coupling::ContactShape*>> drawn;  // one shape may meet several wires
  for (const coupling::MotionContact& c : motion.contacts) {
    if (!drawn.emplace(c.body, c.shape.get()).second) continue;
    for (const Eigen::Matrix3Xd& line : c.shape->drawing())
      lines[static_cast<std::size_t>(c.body)].emplace_back((c.X_BS.R * line).colwise() + c.X_BS.p);
  }
  return lines;
}

Eigen::Matrix3Xd in_world(const multibody::RigidBodyState& body, const Eigen::Matrix3Xd& line) {
  return (body.orientation.toRotationMatrix() * line).colwise() + body.position;
}

}  // namespace

AnimationSpecification animation_of(const scenario::Probe& probe, const std::string& model,
                                    const std::vector<MotionSample>& samples) {
  AnimationSpecification animation{
      "Wire and probe: " + model,
      {"wire", "probe", "arm to the centre of mass"},
      {},
      "To scale; the probe is the circle, the line from it leads to the body's centre of mass."};
  constexpr int corners = 36;
  const Eigen::Matrix3Xd circle = coupling::circle_drawing(probe.radius, 0.0, corners);
  for (std::size_t k = 0; k < samples.size(); k += stride(samples)) {
    const MotionSample& s = samples[k];
    AnimationFrame frame{label_of(s), {{}, {}, {}}};
    for (const Eigen::Matrix3Xd& w : s.wires) frame.outlines[0].push_back(polyline(w, 0));
    const multibody::RigidBodyState& b = s.bodies.front();
    const Vector3d axis = b.position + b.orientation * probe.place;
    frame.outlines[1].push_back(polyline(circle.colwise() + axis, 0));
    Eigen::Matrix3Xd way(3, 2);
    way << axis, b.position;
    frame.outlines[2] = {polyline(way, 0)};
    animation.frames.push_back(std::move(frame));
  }
  return animation;
}

AnimationSpecification animation_of(const coupling::Motion& motion, const std::vector<MotionSample>& samples,
                                    View view) {
  const bool along_z = view == View::along_z;
  const Eigen::Index across = along_z ? 0 : 2;
  AnimationSpecification animation{
      along_z ? "Seen along z: x to the right, y up" : "Seen along x: z to the right, y up",
      {},
      {},
      motion.arms.empty() ? "To scale; of the bodies their shapes, and their centres of mass as small crosses."
                          : "To scale; of the bodies their shapes, and their centres of mass as small crosses; the arm "
                            "from joint to joint."};
  const std::vector<std::vector<Eigen::Matrix3Xd>> shapes = shapes_of(motion);
  const double cross = motion.arms.empty() ? 2.0 : 100.0;  // half its size, that it may be seen beside an arm [mm]
  for (std::size_t k = 0; k < samples.size(); k += stride(samples)) {
    const MotionSample& s = samples[k];
    AnimationFrame frame{label_of(s), {}};
    for (const Eigen::Matrix3Xd& w : s.wires) frame.outlines.push_back({polyline(w, across)});
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
      const double x = mm_per_m * s.bodies[b].position[across];
      const double y = mm_per_m * s.bodies[b].position.y();
      std::vector<AnimationFrame::Line> lines{{x - cross, y, x + cross, y}, {x, y - cross, x, y + cross}};
      for (const Eigen::Matrix3Xd& line : shapes[b]) lines.push_back(polyline(in_world(s.bodies[b], line), across));
      frame.outlines.push_back(std::move(lines));
    }
    for (std::size_t a = 0; a < s.arms.size(); ++a)
      frame.outlines.push_back(skeleton(motion.arms[a].arm.tree, s.arms[a].state.q, across));
    animation.frames.push_back(std::move(frame));
  }
  for (const auto& w : motion.wire_facts()) animation.names.push_back(w.name);
  for (const auto& b : motion.bodies) animation.names.push_back(b.name);
  for (const auto& a : motion.arms) animation.names.push_back(a.name);
  return animation;
}

std::vector<ParaviewFrame> paraview_frames(const coupling::Motion& motion, const std::vector<MotionSample>& samples) {
  const std::vector<std::vector<Eigen::Matrix3Xd>> shapes = shapes_of(motion);
  std::vector<ParaviewFrame> frames;
  for (const MotionSample& s : samples) {
    frames.push_back({s.time, s.wires});
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
      for (const Eigen::Matrix3Xd& line : shapes[b]) frames.back().polylines.push_back(in_world(s.bodies[b], line));
    }
  }
  return frames;
}

}  // namespace snare::app
