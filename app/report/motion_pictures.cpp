#include "app/report/motion_pictures.hpp"

#include "base/index.hpp"
#include "multibody/kinematics.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>

namespace snare::app {

using base::at;
using coupling::MotionCarrier;
using coupling::MotionSample;
using Eigen::Vector3d;
using multibody::Pose;

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

/// From the base to the outermost body of every chain, and on to its frames.
std::vector<Eigen::Matrix3Xd> skeleton(const multibody::Tree& tree, const multibody::Kinematics& kinematics) {
  const auto pose = [&](int body) { return kinematics.X_WB[at(body)]; };
  std::set<int> inner;
  for (const multibody::TreeBody& b : tree.bodies()) inner.insert(b.parent);
  std::vector<Eigen::Matrix3Xd> lines;
  for (int end = 0; end < tree.size(); ++end) {
    if (inner.contains(end)) continue;
    std::vector<Vector3d> chain;
    for (int i = end; i >= 0; i = tree.body(i).parent) chain.push_back(pose(i).p);
    std::reverse(chain.begin(), chain.end());
    lines.emplace_back(
        Eigen::Map<const Eigen::Matrix3Xd>(chain.front().data(), 3, static_cast<Eigen::Index>(chain.size())));
    for (const multibody::TreeFrame& f : tree.frames()) {
      if (f.body != end) continue;
      Eigen::Matrix3Xd line(3, 2);
      line << pose(end).p, (pose(end) * f.X_BF).p;
      lines.push_back(line);
    }
  }
  return lines;
}

Eigen::Matrix3Xd placed(const Pose& X, const Eigen::Matrix3Xd& line) {
  return (X.R * line).colwise() + X.p;
}

std::vector<double> coordinates_mm(const Eigen::Matrix3Xd& line) {
  const Eigen::Matrix3Xd mm = mm_per_m * line;
  return {mm.data(), mm.data() + mm.size()};
}

/// The shapes of the contacts, on their bodies, each once: one may meet several wires.
std::vector<scenario::DrawnLines> shapes_of(const coupling::Motion& motion) {
  std::vector<scenario::DrawnLines> drawn;
  std::set<std::pair<int, const coupling::ContactShape*>> known;
  for (const coupling::MotionContact& c : motion.contacts) {
    if (!known.emplace(c.body, c.shape.get()).second) continue;
    drawn.push_back({motion.bodies[at(c.body)].name,
                     {MotionCarrier::Kind::body, c.body, 0},
                     scenario::pose_of(motion.bodies[at(c.body)].start) * c.X_BS,
                     c.shape->drawing()});
  }
  return drawn;
}

/// Shares a force out to the two points of the edge that is nearest to where it acts.
void share_out(ParaviewLine& line, const Vector3d& where, const Vector3d& force) {
  double least = std::numeric_limits<double>::infinity(), share = 0.0;
  Eigen::Index edge = 0;
  for (Eigen::Index i = 0; i + 1 < line.points.cols(); ++i) {
    const Vector3d along = line.points.col(i + 1) - line.points.col(i);
    const double length = std::max(along.squaredNorm(), std::numeric_limits<double>::min());
    const double t = std::clamp(along.dot(where - line.points.col(i)) / length, 0.0, 1.0);
    const double distance = (line.points.col(i) + t * along - where).norm();
    if (distance >= least) continue;
    least = distance;
    edge = i;
    share = t;
  }
  if (line.points.cols() < 2) return;
  line.contact_forces.col(edge) += (1.0 - share) * force;
  line.contact_forces.col(edge + 1) += share * force;
}

/// Of points that are fixed to a body.
Eigen::Matrix3Xd velocities_of(const multibody::RigidBodyState& body, const Eigen::Matrix3Xd& points) {
  const Vector3d spin = body.orientation * body.spin;
  Eigen::Matrix3Xd v(3, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    v.col(i) = body.velocity + spin.cross(Vector3d(points.col(i)) - body.position);
  return v;
}

/// Velocities of lines that have none, from the frames before and after.
void difference(std::vector<ParaviewFrame>& frames) {
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const ParaviewFrame& before = frames[k > 0 ? k - 1 : k];
    const ParaviewFrame& after = frames[std::min(k + 1, frames.size() - 1)];
    const double time = after.time - before.time;
    for (std::size_t i = 0; i < frames[k].lines.size(); ++i) {
      ParaviewLine& line = frames[k].lines[i];
      if (line.velocities.cols() == line.points.cols()) continue;
      line.velocities = Eigen::Matrix3Xd::Zero(3, line.points.cols());
      if (i >= before.lines.size() || i >= after.lines.size() || !(time > 0.0)) continue;
      const Eigen::Matrix3Xd &first = before.lines[i].points, &last = after.lines[i].points;
      if (first.cols() == last.cols() && last.cols() == line.points.cols())
        line.velocities = (last - first) / time;
    }
  }
}

}  // namespace

/// Where carriers are at one time.
class MotionPictures::Moment {
 public:
  Moment(const coupling::Motion& motion, const std::vector<multibody::RigidBodyState>& bodies,
         const std::vector<const Eigen::VectorXd*>& arms)
      : bodies_(bodies) {
    for (std::size_t a = 0; a < arms.size(); ++a) {
      trees_.push_back(&motion.arms[a].arm.tree);
      kinematics_.emplace_back(*trees_.back());
      multibody::place(*trees_.back(), *arms[a], kinematics_.back());
    }
  }

  static Moment at_start(const coupling::Motion& motion, std::vector<multibody::RigidBodyState>& bodies) {
    for (const coupling::MotionBody& b : motion.bodies) bodies.push_back(b.start);
    std::vector<const Eigen::VectorXd*> arms;
    for (const coupling::MotionArm& a : motion.arms) arms.push_back(&a.start.q);
    return {motion, bodies, arms};
  }

  static Moment of(const coupling::Motion& motion, const MotionSample& sample) {
    std::vector<const Eigen::VectorXd*> arms;
    for (const MotionSample::Arm& a : sample.arms) arms.push_back(&a.state.q);
    return {motion, sample.bodies, arms};
  }

  [[nodiscard]] Pose pose(const MotionCarrier& carrier) const {
    switch (carrier.kind) {
      case MotionCarrier::Kind::body:
        return scenario::pose_of(bodies_[at(carrier.index)]);
      case MotionCarrier::Kind::arm:
        return multibody::frame_pose(*trees_[at(carrier.index)], kinematics_[at(carrier.index)],
                                     carrier.frame);
      case MotionCarrier::Kind::world:
        break;
    }
    return {};
  }

  [[nodiscard]] std::vector<Eigen::Matrix3Xd> arm(std::size_t a) const {
    return skeleton(*trees_[a], kinematics_[a]);
  }

 private:
  const std::vector<multibody::RigidBodyState>& bodies_;
  std::vector<const multibody::Tree*> trees_;
  std::vector<multibody::Kinematics> kinematics_;
};

MotionPictures::MotionPictures(const coupling::Motion& motion, const std::vector<MotionSample>& samples,
                               std::vector<scenario::DrawnLines> drawn)
    : motion_(motion), samples_(samples) {
  std::vector<multibody::RigidBodyState> bodies;
  const Moment start = Moment::at_start(motion, bodies);
  if (drawn.empty()) drawn = shapes_of(motion);
  for (scenario::DrawnLines& d : drawn) {
    const Pose X_CS = start.pose(d.carrier).inverse() * d.X_WS;
    for (Eigen::Matrix3Xd& line : d.lines) line = placed(X_CS, line);
    carried_.push_back({std::move(d.name), d.carrier, std::move(d.lines)});
  }
}

SceneSpecification MotionPictures::scene(std::vector<SceneMark> marks) const {
  SceneSpecification scene;
  scene.title = "The motion";
  scene.marks = std::move(marks);
  for (const coupling::WireFacts& w : motion_.wire_facts())
    scene.moving.push_back({w.name, SceneItem::Kind::wire});
  for (const coupling::MotionArm& a : motion_.arms) scene.moving.push_back({a.name, SceneItem::Kind::arm});
  for (const Carried& c : carried_) {
    SceneItem item{c.name, SceneItem::Kind::solid};
    for (const Eigen::Matrix3Xd& line : c.lines) item.lines.push_back(coordinates_mm(line));
    scene.carried.push_back(std::move(item));
  }
  for (std::size_t k = 0; k < samples_.size(); k += stride(samples_)) {
    const MotionSample& s = samples_[k];
    const Moment moment = Moment::of(motion_, s);
    SceneFrame frame{s.time, label_of(s)};
    for (const Eigen::Matrix3Xd& w : s.wires) frame.moving.push_back({coordinates_mm(w)});
    for (std::size_t a = 0; a < s.arms.size(); ++a) {
      std::vector<std::vector<double>>& lines = frame.moving.emplace_back();
      for (const Eigen::Matrix3Xd& line : moment.arm(a)) lines.push_back(coordinates_mm(line));
    }
    for (const Carried& c : carried_) {
      const Pose X = moment.pose(c.carrier);
      const Eigen::Quaterniond q(X.R);
      const Vector3d p = mm_per_m * X.p;
      frame.poses.push_back({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
    }
    scene.frames.push_back(std::move(frame));
  }
  return scene;
}

std::vector<ParaviewLine> MotionPictures::wire_lines(const MotionSample& s) const {
  const std::vector<coupling::WireFacts> facts = motion_.wire_facts();
  const std::size_t rods = s.wires.size() - s.law_tensions.size();
  std::vector<ParaviewLine> lines;
  for (std::size_t w = 0; w < s.wires.size(); ++w) {
    ParaviewLine line{
        ParaviewLine::Kind::wire, static_cast<int>(w), facts[w].name, s.wires[w], {}, {}, {}, {}};
    line.contact_forces = Eigen::Matrix3Xd::Zero(3, line.points.cols());
    if (w < s.wire_loads.size()) {
      line.velocities = s.wire_loads[w].velocities;
      line.tensions = s.wire_loads[w].tensions;
      line.curvatures = s.wire_loads[w].curvatures;
    } else if (w >= rods) {
      line.tensions = Eigen::VectorXd::Constant(line.points.cols(), s.law_tensions[w - rods]);
    }
    lines.push_back(std::move(line));
  }
  add_contact_forces(s, lines);
  return lines;
}

void MotionPictures::add_contact_forces(const MotionSample& s, std::vector<ParaviewLine>& lines) const {
  const std::size_t rods = s.wires.size() - s.law_tensions.size();
  const auto add = [&lines](std::size_t wire, const coupling::ContactSample& c, double sign) {
    if (wire >= lines.size()) return;
    if (c.points.empty() && c.closed) share_out(lines[wire], c.point, sign * c.force);
    for (const coupling::ContactSample& p : c.points) share_out(lines[wire], p.point, sign * p.force);
  };
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    const auto [kind, index] = motion_.contact_place(k);
    if (kind == coupling::ContactKind::shape) {
      add(at(motion_.contacts[index].wire), s.contacts[k], 1.0);
    } else if (kind == coupling::ContactKind::wire_pair) {
      const coupling::WirePair& pair = motion_.wire_pairs[index];
      add(at(pair.wires[0]), s.contacts[k], 1.0);
      add(at(pair.wires[1]), s.contacts[k], -1.0);
    } else if (kind == coupling::ContactKind::law_wire) {
      add(rods + index, s.contacts[k], 1.0);
    }
  }
}

std::vector<ParaviewFrame> MotionPictures::paraview() const {
  std::vector<ParaviewFrame> frames;
  for (const MotionSample& s : samples_) {
    const Moment moment = Moment::of(motion_, s);
    frames.push_back({s.time, wire_lines(s)});
    std::vector<ParaviewLine>& lines = frames.back().lines;
    for (std::size_t k = 0; k < carried_.size(); ++k) {
      const Carried& c = carried_[k];
      const Pose X = moment.pose(c.carrier);
      for (const Eigen::Matrix3Xd& line : c.lines) {
        lines.push_back(
            {ParaviewLine::Kind::body, static_cast<int>(k), c.name, placed(X, line), {}, {}, {}, {}});
        if (c.carrier.kind == MotionCarrier::Kind::body)
          lines.back().velocities = velocities_of(s.bodies[at(c.carrier.index)], lines.back().points);
        if (c.carrier.kind == MotionCarrier::Kind::world)
          lines.back().velocities = Eigen::Matrix3Xd::Zero(3, line.cols());
      }
    }
    for (std::size_t a = 0; a < s.arms.size(); ++a) {
      for (Eigen::Matrix3Xd& line : moment.arm(a))
        lines.push_back({ParaviewLine::Kind::arm,
                         static_cast<int>(a),
                         motion_.arms[a].name,
                         std::move(line),
                         {},
                         {},
                         {},
                         {}});
    }
  }
  difference(frames);
  return frames;
}

}  // namespace snare::app
