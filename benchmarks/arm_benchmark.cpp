// Rigid dynamics of the seven-joint arm by us, orocos-KDL and DART in one run, and the elastic arm against
// the clock.

#include "multibody/arm/arm_file.hpp"
#include "multibody/dynamics.hpp"
#include "multibody/dynamics_derivatives.hpp"
#include "scenario/arm_scenarios.hpp"

#include <benchmark/benchmark.h>

#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfdsolver_recursive_newton_euler.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>

#include <filesystem>
#include <random>

namespace snare {

namespace {

std::filesystem::path arms() {
  return std::filesystem::path(SNARE_BENCHMARK_DATA) / "arms";
}

/// The arm with a hundred states that are run through in turn, so that no branch predictor learns one of
/// them.
struct Case {
  multibody::ArmDescription arm = multibody::read_arm(arms() / "ssrms_like.toml");
  std::vector<Eigen::VectorXd> q, v, a;

  Case() {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto values = [&](double size) {
      return Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(7, [&] { return size * uniform(random); }));
    };
    for (int i = 0; i < 100; ++i) {
      q.push_back(values(3.0));
      v.push_back(values(1.0));
      a.push_back(values(1.0));
    }
  }
};

KDL::Chain kdl_chain(const multibody::Tree& tree) {
  KDL::Chain chain;
  for (const multibody::TreeBody& body : tree.bodies()) {
    const Eigen::Matrix3d& R = body.X_PJ.R;
    const Eigen::Vector3d& p = body.X_PJ.p;
    const Eigen::Vector3d axis = R * body.axis, c = body.inertia.centre();
    const Eigen::Matrix3d I = body.inertia.about_own_centre();
    const KDL::Frame X(
        KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
        KDL::Vector(p.x(), p.y(), p.z()));
    chain.addSegment(KDL::Segment(
        body.name, KDL::Joint(body.name, X.p, KDL::Vector(axis.x(), axis.y(), axis.z()), KDL::Joint::RotAxis),
        X,
        KDL::RigidBodyInertia(body.inertia.mass, KDL::Vector(c.x(), c.y(), c.z()),
                              KDL::RotationalInertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)))));
  }
  return chain;
}

dart::dynamics::SkeletonPtr dart_skeleton(const multibody::Tree& tree) {
  using namespace dart::dynamics;
  SkeletonPtr skeleton = Skeleton::create("arm");
  BodyNode* parent = nullptr;
  for (const multibody::TreeBody& body : tree.bodies()) {
    RevoluteJoint::Properties joint;
    joint.mAxis = body.axis;
    joint.mName = body.name + " joint";
    joint.mT_ParentBodyToJoint.linear() = body.X_PJ.R;
    joint.mT_ParentBodyToJoint.translation() = body.X_PJ.p;
    BodyNode::Properties node;
    node.mName = body.name;
    node.mInertia = Inertia(body.inertia.mass, body.inertia.centre(), body.inertia.about_own_centre());
    parent = skeleton->createJointAndBodyNodePair<RevoluteJoint>(parent, joint, node).second;
  }
  skeleton->setGravity(Eigen::Vector3d::Zero());
  return skeleton;
}

KDL::JntArray to_kdl(const Eigen::VectorXd& v) {
  KDL::JntArray a(static_cast<unsigned>(v.size()));
  a.data = v;
  return a;
}

struct KdlCase : Case {
  KDL::Chain chain = kdl_chain(arm.arm.tree);
  std::vector<KDL::JntArray> kdl_q, kdl_v, kdl_a;
  KDL::Wrenches none{chain.getNrOfSegments()};

  KdlCase() {
    for (std::size_t i = 0; i < q.size(); ++i) {
      kdl_q.push_back(to_kdl(q[i]));
      kdl_v.push_back(to_kdl(v[i]));
      kdl_a.push_back(to_kdl(a[i]));
    }
  }
};

template <class Work>
void run(benchmark::State& state, const Work& work) {
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    work(i);
    i = (i + 1) % 100;
  }
}

void InverseDynamicsOwn(benchmark::State& state) {
  const Case c;
  multibody::DynamicsWorkspace workspace(c.arm.arm.tree);
  run(state, [&](std::size_t i) {
    benchmark::DoNotOptimize(
        multibody::inverse_dynamics(c.arm.arm.tree, c.q[i], c.v[i], c.a[i], {}, workspace).data());
  });
}
void InverseDynamicsKdl(benchmark::State& state) {
  const KdlCase c;
  KDL::ChainIdSolver_RNE solver(c.chain, KDL::Vector::Zero());
  KDL::JntArray torque(7);
  run(state, [&](std::size_t i) {
    benchmark::DoNotOptimize(solver.CartToJnt(c.kdl_q[i], c.kdl_v[i], c.kdl_a[i], c.none, torque));
  });
}
void InverseDynamicsDart(benchmark::State& state) {
  const Case c;
  const auto skeleton = dart_skeleton(c.arm.arm.tree);
  run(state, [&](std::size_t i) {
    skeleton->setPositions(c.q[i]);
    skeleton->setVelocities(c.v[i]);
    skeleton->setAccelerations(c.a[i]);
    skeleton->computeInverseDynamics();
    benchmark::DoNotOptimize(skeleton->getForce(0));
  });
}

void MassMatrixOwn(benchmark::State& state) {
  const Case c;
  multibody::DynamicsWorkspace workspace(c.arm.arm.tree);
  run(state, [&](std::size_t i) {
    benchmark::DoNotOptimize(multibody::mass_matrix(c.arm.arm.tree, c.q[i], workspace).data());
  });
}
void MassMatrixKdl(benchmark::State& state) {
  const KdlCase c;
  KDL::ChainDynParam solver(c.chain, KDL::Vector::Zero());
  KDL::JntSpaceInertiaMatrix matrix(7);
  run(state, [&](std::size_t i) { benchmark::DoNotOptimize(solver.JntToMass(c.kdl_q[i], matrix)); });
}
void MassMatrixDart(benchmark::State& state) {
  const Case c;
  const auto skeleton = dart_skeleton(c.arm.arm.tree);
  run(state, [&](std::size_t i) {
    skeleton->setPositions(c.q[i]);
    benchmark::DoNotOptimize(skeleton->getMassMatrix().data());
  });
}

void ForwardDynamicsOwn(benchmark::State& state) {
  const Case c;
  multibody::DynamicsWorkspace workspace(c.arm.arm.tree);
  run(state, [&](std::size_t i) {
    benchmark::DoNotOptimize(
        multibody::forward_dynamics(c.arm.arm.tree, c.q[i], c.v[i], c.a[i], {}, workspace).data());
  });
}
void ForwardDynamicsKdl(benchmark::State& state) {
  const KdlCase c;
  KDL::ChainFdSolver_RNE solver(c.chain, KDL::Vector::Zero());
  KDL::JntArray acceleration(7);
  run(state, [&](std::size_t i) {
    benchmark::DoNotOptimize(solver.CartToJnt(c.kdl_q[i], c.kdl_v[i], c.kdl_a[i], c.none, acceleration));
  });
}
void ForwardDynamicsDart(benchmark::State& state) {
  const Case c;
  const auto skeleton = dart_skeleton(c.arm.arm.tree);
  run(state, [&](std::size_t i) {
    skeleton->setPositions(c.q[i]);
    skeleton->setVelocities(c.v[i]);
    skeleton->setForces(c.a[i]);
    skeleton->computeForwardDynamics();
    benchmark::DoNotOptimize(skeleton->getAcceleration(0));
  });
}

void InverseDynamicsDerivativesOwn(benchmark::State& state) {
  const Case c;
  multibody::InverseDynamicsDerivatives derivatives(c.arm.arm.tree);
  run(state, [&](std::size_t i) {
    benchmark::DoNotOptimize(
        multibody::differentiate_inverse_dynamics(c.arm.arm.tree, c.q[i], c.v[i], c.a[i], {}, derivatives)
            .position.data());
  });
}

/// The seven-joint elastic arm pushed at its tip, and 60 s of its swinging.
void ElasticArmAgainstTheClock(benchmark::State& state) {
  const multibody::ArmDescription arm = multibody::read_arm(arms() / "ssrms_like.toml");
  multibody::ArmScenario run = scenario::tip_impulse(arm, arm.poses[1].angles, scenario::Hold::as_described,
                                                     {0.0, 200.0, 0.0}, 0.5, 60.0);
  run.sample = 0.5;
  run.ida.relative_tolerance = 1e-4;
  run.tolerances = {1e-6, 1e-3};  // the tip moves a few centimetres, 1e-6 rad are 17 micrometres there
  long steps = 0;
  double energy_error = 0.0;
  for ([[maybe_unused]] auto _ : state) {
    const multibody::ArmHistory history = multibody::simulate(run);
    if (!history.report.usable()) state.SkipWithError(history.report.message.c_str());
    steps = history.statistics.steps;
    energy_error = history.energy_error;
  }
  state.counters["times_real_time"] =
      benchmark::Counter(60.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["steps"] = static_cast<double>(steps);
  state.counters["energy_error"] = energy_error;
}

BENCHMARK(InverseDynamicsOwn);
BENCHMARK(InverseDynamicsKdl);
BENCHMARK(InverseDynamicsDart);
BENCHMARK(MassMatrixOwn);
BENCHMARK(MassMatrixKdl);
BENCHMARK(MassMatrixDart);
BENCHMARK(ForwardDynamicsOwn);
BENCHMARK(ForwardDynamicsKdl);
BENCHMARK(ForwardDynamicsDart);
BENCHMARK(InverseDynamicsDerivativesOwn);
BENCHMARK(ElasticArmAgainstTheClock)->Unit(benchmark::kMillisecond);

}  // namespace

}  // namespace snare

BENCHMARK_MAIN();
