// Random elastic arms with drives, and the shipped arms in random poses, against DART, which shares no code
// with ours. Random trees of rigid
// bodies: tests/multibody/dart_test.cpp.

#include "multibody/arm/arm_file.hpp"
#include "multibody/arm/arm_run.hpp"
#include "multibody/dynamics.hpp"
#include "multibody/kinematics.hpp"
#include "tests/multibody/dart_reference.hpp"
#include "tests/slow/referee_draws.hpp"

#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace snare::referee {
namespace {

using multibody::Drive;
using multibody::DriveMode;

/// A joint's gear, written down independently (A.9) to (A.11): a spring of two slopes with a damper, friction
/// that does not stick, a drive.
struct Gear {
  int velocity = 0, coordinate = 0;  ///< of the joint in the tree
  double first = 0.0, second = 0.0, bend = 0.0, damping = 0.0;
  double inertia = 0.0, viscous = 0.0, asymmetry = 0.0, quadratic = 0.0, offset = 0.0;
  DriveMode mode = DriveMode::limp;
  double from = 0.0, to = 0.0, begin = 0.0, duration = 0.0;  ///< of a course
  double proportional = 0.0, derivative = 0.0, limit = 0.0, share = 0.0;
  std::array<double, 3> times{}, torques{};

  [[nodiscard]] double torque(double deflection, double rate) const {
    const double size = std::abs(deflection);
    const double spring = size < bend ? first * size : first * bend + second * (size - bend);
    return std::copysign(spring, deflection) + damping * rate;
  }
  [[nodiscard]] double friction(double w) const {
    return viscous * w + asymmetry * std::abs(w) + quadratic * std::abs(w) * w + offset;
  }
  /// Place and rate of the course.
  [[nodiscard]] std::array<double, 2> course(double time) const {
    const double s = std::clamp((time - begin) / duration, 0.0, 1.0), way = to - from;
    return {from + way * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s),
            way / duration * 30.0 * s * s * (1.0 - s) * (1.0 - s)};
  }
  [[nodiscard]] double drive(double time, double angle, double rate) const {
    if (mode == DriveMode::servo) {
      const auto [at, speed] = course(time);
      return std::clamp(proportional * (at - angle) + derivative * (share * speed - rate), -limit, limit);
    }
    if (mode != DriveMode::torque) return 0.0;
    const double t = time - begin;
    if (t < 0.0) return 0.0;
    for (std::size_t k = 0; k + 1 < times.size(); ++k) {
      if (t < times[k + 1])
        return torques[k] + (torques[k + 1] - torques[k]) * (t - times[k]) / (times[k + 1] - times[k]);
    }
    return torques.back();
  }
  [[nodiscard]] bool rules() const { return mode == DriveMode::locked || mode == DriveMode::course; }
};

/// An arm twice, with its start.
struct ArmProblem {
  test::PlainTree plain;
  std::vector<Gear> gears;
  multibody::ArmScenario run;
};

/// What a step of our integration may err by.
constexpr double arm_step_tolerance = 1e-9;

ArmProblem random_arm(Draws& draw) {
  ArmProblem p;
  p.plain =
      test::random_tree(draw.generator(), draw.chance(0.4) ? test::Base::floating : test::Base::on_the_world);
  p.plain.gravity *= 0.3;
  multibody::ElasticArm& arm = p.run.arm;
  arm.tree = test::make_tree(p.plain);
  multibody::TreeState state = test::random_state(draw.generator(), arm.tree);
  state.v *= 0.3;
  p.run.begin = 0.0;
  p.run.end = draw.between(0.3, 0.8);
  p.run.sample = p.run.end / 20;
  for (int i = 0; i < arm.tree.size(); ++i) {
    const multibody::TreeBody& body = arm.tree.body(i);
    if (body.joint == multibody::JointKind::free || draw.chance(0.3)) continue;
    Gear g;
    g.velocity = body.v_index;
    g.coordinate = body.q_index;
    g.first = draw.of_any_size(10.0, 1000.0);
    g.second = g.first * draw.of_any_size(0.3, 5.0);
    g.bend = draw.of_any_size(1e-3, 0.1);
    g.damping = draw.between(0.0, 0.02) * g.first;
    g.inertia = draw.of_any_size(0.3, 10.0);
    g.viscous = draw.between(0.0, 3.0);
    g.asymmetry = g.viscous * draw.between(-0.9, 0.9);
    g.quadratic = draw.between(0.0, 1.0);
    g.offset = draw.between(-1.0, 1.0);
    g.mode = draw.one_of<DriveMode>(
        {DriveMode::locked, DriveMode::servo, DriveMode::limp, DriveMode::torque, DriveMode::course});
    g.from = state.q[g.coordinate] + draw.between(-0.05, 0.05);
    g.to = g.from + draw.between(-0.5, 0.5);
    g.begin = draw.between(0.0, 0.2);
    g.duration = draw.between(0.1, 0.5);
    g.proportional = draw.of_any_size(10.0, 1000.0);
    g.derivative = draw.of_any_size(1.0, 30.0);
    g.limit = draw.of_any_size(3.0, 100.0);
    g.share = draw.between(0.0, 1.0);
    g.times = {0.0, draw.between(0.05, 0.15), draw.between(0.2, 0.4)};
    for (double& t : g.torques) t = draw.between(-20.0, 20.0);
    p.gears.push_back(g);

    multibody::ElasticJoint joint;
    joint.name = "joint" + std::to_string(i);
    joint.body = i;
    joint.motor_inertia = g.inertia;
    joint.spring = multibody::DeflectionLaw({{0.0, g.first, g.damping}, {g.bend, g.second, g.damping}});
    joint.friction.viscous = g.viscous;
    joint.friction.viscous_asymmetry = g.asymmetry;
    joint.friction.quadratic = g.quadratic;
    joint.friction.offset = g.offset;
    arm.joints.push_back(joint);
    Drive drive;
    drive.mode = g.mode;
    if (g.mode == DriveMode::servo) {
      drive.proportional = g.proportional;
      drive.derivative = g.derivative;
      drive.limit = g.limit;
      drive.rate_share = g.share;
    }
    if (g.mode == DriveMode::servo || g.mode == DriveMode::course)
      drive.course = multibody::Course(g.from, g.to, g.begin, g.duration);
    if (g.mode == DriveMode::torque)
      drive =
          Drive::with_torque(g.begin, {g.times.begin(), g.times.end()}, {g.torques.begin(), g.torques.end()});
    p.run.drives.push_back(drive);
  }
  const auto motors = static_cast<Eigen::Index>(p.gears.size());
  p.run.initial = {state.q, state.v, Eigen::VectorXd::Zero(motors), Eigen::VectorXd::Zero(motors)};
  for (Eigen::Index j = 0; j < motors; ++j) {
    const Gear& g = p.gears[static_cast<std::size_t>(j)];
    p.run.initial.motor[j] = g.from;
    p.run.initial.motor_rate[j] = g.rules() ? 0.0 : 0.3 * draw.between(-1.0, 1.0);
  }
  p.run.ida.relative_tolerance = arm_step_tolerance;
  p.run.tolerances.coordinate = p.run.tolerances.rate = arm_step_tolerance;
  return p;
}

/// q, v, motors, their rates.
using ArmVector = std::vector<double>;

ArmVector joined(const multibody::ArmState& s) {
  ArmVector all;
  for (const Eigen::VectorXd* part : {&s.q, &s.v, &s.motor, &s.motor_rate})
    all.insert(all.end(), part->begin(), part->end());
  return all;
}

class DartArm {
 public:
  explicit DartArm(const ArmProblem& p) : problem_(p), dart_(p.plain) {}

  void operator()(const ArmVector& state, ArmVector& rates, double time) {
    const multibody::Tree& tree = problem_.run.arm.tree;
    const auto motors = static_cast<Eigen::Index>(problem_.gears.size());
    const Eigen::Index nq = tree.coordinates(), nv = tree.velocities();
    Eigen::Map<const Eigen::VectorXd> all(state.data(), static_cast<Eigen::Index>(state.size()));
    const Eigen::VectorXd q = all.head(nq), v = all.segment(nq, nv);
    Eigen::VectorXd motor = all.segment(nq + nv, motors), motor_rate = all.tail(motors), motor_rates(motors);
    Eigen::VectorXd torque = Eigen::VectorXd::Zero(nv);
    for (Eigen::Index j = 0; j < motors; ++j) {
      const Gear& g = problem_.gears[static_cast<std::size_t>(j)];
      if (g.mode == DriveMode::course) {
        const auto [at, speed] = g.course(time);
        motor[j] = at;
        motor_rate[j] = speed;
      }
      const double spring = g.torque(q[g.coordinate] - motor[j], v[g.velocity] - motor_rate[j]);
      torque[g.velocity] = -spring;
      motor_rates[j] =
          g.rules()
              ? 0.0
              : (g.drive(time, motor[j], motor_rate[j]) + spring - g.friction(motor_rate[j])) / g.inertia;
      if (g.mode == DriveMode::course) motor_rate[j] = 0.0;  // known, not integrated
    }
    dart_.set(tree, {q, v});
    const Eigen::VectorXd acceleration = dart_.forward_dynamics(torque),
                          rate = test::coordinate_rate(tree, q, v);
    rates.clear();
    for (const auto& part : {rate, acceleration, Eigen::VectorXd(motor_rate), Eigen::VectorXd(motor_rates)})
      rates.insert(rates.end(), part.begin(), part.end());
  }

 private:
  const ArmProblem& problem_;
  test::DartTree dart_;
};

/// Times at which the right sides have corners.
std::vector<double> corners(const ArmProblem& p) {
  std::vector<double> times{p.run.end};
  for (const Gear& g : p.gears) {
    if (g.mode == DriveMode::servo || g.mode == DriveMode::course)
      times.insert(times.end(), {g.begin, g.begin + g.duration});
    if (g.mode == DriveMode::torque) {
      for (const double t : g.times) times.push_back(g.begin + t);
    }
  }
  std::ranges::sort(times);
  while (times.back() > p.run.end) times.pop_back();
  std::erase_if(times, [](double t) { return t <= 0.0; });
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

ArmVector integrated_by_dart(const ArmProblem& p, ArmVector state, double tolerance) {
  namespace odeint = boost::numeric::odeint;
  DartArm arm(p);
  double from = 0.0;
  for (const double to : corners(p)) {
    // Between two corners the drives are smooth, their ends included.
    const double least = from + 1e-13, most = to - 1e-13;
    const auto rate = [&](const ArmVector& at, ArmVector& rates, double time) {
      arm(at, rates, std::clamp(time, least, std::max(least, most)));
    };
    odeint::integrate_adaptive(
        odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_dopri5<ArmVector>()), rate, state,
        from, to, std::min(1e-4, to - from));
    from = to;
  }
  const std::size_t first = state.size() - 2 * p.gears.size();
  for (std::size_t j = 0; j < p.gears.size(); ++j) {
    if (p.gears[j].mode != DriveMode::course) continue;
    const auto [at, speed] = p.gears[j].course(p.run.end);
    state[first + j] = at;
    state[first + p.gears.size() + j] = speed;
  }
  return state;
}

double largest_difference(const ArmVector& a, const ArmVector& b) {
  double d = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    d = std::max(d, std::abs(a[i] - b[i]) / std::max(1.0, std::abs(b[i])));
  return d;
}

std::string described(const ArmProblem& p) {
  std::string text = fmt::format("{} bodies, {:.9g} s;", p.plain.bodies.size(), p.run.end);
  for (const Gear& g : p.gears)
    text +=
        fmt::format(" [v {} spring {:.6g} {:.6g} from {:.6g}, damper {:.6g}, inertia {:.6g}, drive {}]",
                    g.velocity, g.first, g.second, g.bend, g.damping, g.inertia, static_cast<int>(g.mode));
  return text;
}

TEST(SlowReferees, RandomElasticArmsMoveAsDartSays) {
  const Problems problems(60);
  double worst = 0.0;
  std::string worst_text;
  for (int k = problems.first; k < problems.end; ++k) {
    Draws draw(problems.seed, k);
    const ArmProblem p = random_arm(draw);
    const ArmVector start = joined(p.run.initial);
    const ArmVector reference = integrated_by_dart(p, start, 1e-11);
    // How a small change of the start's velocities grows.
    constexpr double change = 1e-6;
    ArmVector beside = start;
    for (int i = 0; i < p.run.arm.tree.velocities(); ++i)
      beside[static_cast<std::size_t>(p.run.arm.tree.coordinates() + i)] += i % 2 == 0 ? change : -change;
    const double growth =
        std::max(1.0, largest_difference(integrated_by_dart(p, beside, 1e-10), reference) / change);
    const multibody::ArmHistory history = multibody::simulate(p.run);
    const double difference = largest_difference(joined(history.samples.back().state), reference);
    // Each step may err by its tolerance.
    const double limit = static_cast<double>(history.statistics.steps) * arm_step_tolerance * growth;
    const std::string text = fmt::format(
        "problem {}: differs by {:.2e}, {:.2e} of the limit; {} steps, {} events, growth {:.3g}, {} {}", k,
        difference, difference / limit, history.statistics.steps, history.events.size(), growth,
        history.report.message, described(p));
    EXPECT_TRUE(history.report.usable()) << text;
    EXPECT_LE(difference, limit) << text;
    if (difference <= worst * limit) continue;
    worst = difference / limit;
    worst_text = text;
  }
  RecordProperty("worst share of the limit", std::to_string(worst));
  if (HasFailure()) ADD_FAILURE() << "worst: " << worst_text;
}

/// Our tree in DART, from the tree that the reader of arms has made.
class DartOfTree {
 public:
  explicit DartOfTree(const multibody::Tree& tree)
      : tree_(tree), skeleton_(dart::dynamics::Skeleton::create("arm")) {
    using namespace dart::dynamics;
    for (const multibody::TreeBody& b : tree.bodies()) {
      BodyNode* parent = b.parent < 0 ? nullptr : skeleton_->getBodyNode(static_cast<std::size_t>(b.parent));
      BodyNode::Properties body;
      body.mName = b.name;
      const double m = b.inertia.mass;
      const Eigen::Vector3d c = b.inertia.first_moment / m;
      const Eigen::Matrix3d about_centre =
          b.inertia.rotational - m * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
      body.mInertia = Inertia(m, c, about_centre);
      Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
      X.linear() = b.X_PJ.R;
      X.translation() = b.X_PJ.p;
      if (b.joint == multibody::JointKind::free) {
        FreeJoint::Properties joint;
        joint.mName = "to " + b.name;
        joint.mT_ParentBodyToJoint = X;
        skeleton_->createJointAndBodyNodePair<FreeJoint>(parent, joint, body);
      } else if (b.joint == multibody::JointKind::revolute) {
        RevoluteJoint::Properties joint;
        joint.mAxis = b.axis;
        joint.mName = "to " + b.name;
        joint.mT_ParentBodyToJoint = X;
        skeleton_->createJointAndBodyNodePair<RevoluteJoint>(parent, joint, body);
      } else {
        PrismaticJoint::Properties joint;
        joint.mAxis = b.axis;
        joint.mName = "to " + b.name;
        joint.mT_ParentBodyToJoint = X;
        skeleton_->createJointAndBodyNodePair<PrismaticJoint>(parent, joint, body);
      }
    }
    skeleton_->setGravity(tree.gravity);
  }

  void set(const multibody::TreeState& state) {
    Eigen::VectorXd positions(tree_.velocities());
    for (const multibody::TreeBody& b : tree_.bodies()) {
      if (b.joint != multibody::JointKind::free) {
        positions[b.v_index] = state.q[b.q_index];
        continue;
      }
      const multibody::Pose X = multibody::joint_pose(b, state.q);
      Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
      T.linear() = X.R;
      T.translation() = X.p;
      positions.segment<6>(b.v_index) = dart::dynamics::FreeJoint::convertToPositions(T);
    }
    skeleton_->setPositions(positions);
    skeleton_->setVelocities(state.v);
  }
  [[nodiscard]] dart::dynamics::Skeleton& skeleton() { return *skeleton_; }

 private:
  const multibody::Tree& tree_;
  dart::dynamics::SkeletonPtr skeleton_;
};

TEST(SlowReferees, ShippedArmsInRandomPosesAgreeWithDart) {
  const Problems problems(200);  // poses an arm
  int arms = 0;
  for (const auto& file : std::filesystem::directory_iterator(SNARE_SOURCE_DIR "/data/arms")) {
    if (file.path().extension() != ".toml") continue;
    SCOPED_TRACE(file.path().filename().string());
    ++arms;
    multibody::Tree tree = multibody::read_arm(file.path()).arm.tree;
    // A link of a ton moves one of a gram: entries of the mass matrix are held against the roots of their
    // diagonals.
    double worst = 0.0;
    for (int k = problems.first; k < problems.end; ++k) {
      Draws draw(problems.seed, k);
      tree.gravity = test::random_vector(draw.generator(), 10.0);
      const multibody::TreeState state = test::random_state(draw.generator(), tree);
      DartOfTree dart(tree);
      dart.set(state);
      multibody::DynamicsWorkspace workspace(tree);
      const Eigen::MatrixXd mass = multibody::mass_matrix(tree, state.q, workspace);
      const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt();
      const double of_mass =
          ((mass - dart.skeleton().getMassMatrix()).array() / (scale * scale.transpose()).array())
              .abs()
              .maxCoeff();
      const Eigen::VectorXd none = Eigen::VectorXd::Zero(tree.velocities());
      const Eigen::VectorXd bias = multibody::inverse_dynamics(tree, state.q, state.v, none, {}, workspace);
      const Eigen::VectorXd torque =
          bias + scale.cwiseProduct(test::random_values(draw.generator(), tree.velocities(), 10.0));
      const double of_bias = test::relative_difference(bias, dart.skeleton().getCoriolisAndGravityForces());
      const Eigen::VectorXd acceleration =
          multibody::forward_dynamics(tree, state.q, state.v, torque, {}, workspace);
      dart.skeleton().setForces(torque);
      dart.skeleton().computeForwardDynamics();
      const Eigen::VectorXd difference = acceleration - dart.skeleton().getAccelerations();
      // What torque the difference stands for.
      const double of_acceleration = ((mass * difference).array() / scale.array()).abs().maxCoeff() /
                                     (torque.array() / scale.array()).abs().maxCoeff();
      multibody::Kinematics kinematics(tree);
      multibody::place(tree, state.q, kinematics);
      multibody::set_moving(tree, state.v, kinematics);
      const double of_energy = std::abs(
          multibody::kinetic_energy(tree, kinematics) / dart.skeleton().computeKineticEnergy() - 1.0);
      const Eigen::Vector3d centre = multibody::centre_of_mass(tree, kinematics) - dart.skeleton().getCOM();
      const Eigen::Vector3d momentum =
          multibody::momentum(tree, kinematics).force - tree.mass() * dart.skeleton().getCOMLinearVelocity();
      const double of_centre = centre.norm(), of_momentum = momentum.norm() / tree.mass();
      const double largest = std::max({of_mass, of_bias, of_acceleration, of_energy, of_centre, of_momentum});
      worst = std::max(worst, largest);
      // Rounding of products of some dozen factors; see tests/multibody/dart_test.cpp.
      EXPECT_LT(largest, 1e-9) << "pose " << k << ": mass matrix " << of_mass << ", bias " << of_bias
                               << ", acceleration " << of_acceleration << ", energy " << of_energy
                               << ", centre of mass " << of_centre << " m, momentum " << of_momentum
                               << " m/s; q " << state.q.transpose() << "; v " << state.v.transpose();
    }
    RecordProperty("worst of " + file.path().stem().string(), fmt::format("{:.2e}", worst));
  }
  EXPECT_GE(arms, 9);
}

}  // namespace
}  // namespace snare::referee
