// Every law stores or dissipates the power that it takes from bodies and wires; the dissipation is never
// negative, in any state.

#include "coupling/contact/revolved_solids.hpp"
#include "coupling/dynamics/contact/body_contact_part.hpp"
#include "coupling/dynamics/contact/contact_part.hpp"
#include "coupling/dynamics/contact/wire_pair_part.hpp"
#include "coupling/dynamics/joints/body_part.hpp"
#include "coupling/dynamics/joints/bushing_part.hpp"
#include "coupling/dynamics/laws/law_part.hpp"
#include "coupling/dynamics/laws/law_wire_part.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "tests/support/crossed_wires.hpp"
#include "tests/support/motion_bodies.hpp"
#include "tests/support/soft_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace snare::coupling {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A number in [-1, 1] from a stored seed, vectors of such, and numbers of a random order of magnitude.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(-1.0, 1.0)(engine_); }
  /// In braces, whose order of evaluation no compiler chooses.
  Vector3d vector() { return {unit(), unit(), unit()}; }
  Vector2d vector_2() { return {unit(), unit()}; }
  Eigen::Vector4d vector_4() { return {unit(), unit(), unit(), unit()}; }
  double between(double low, double high) { return low * std::pow(high / low, 0.5 * (1.0 + unit())); }

 private:
  std::mt19937 engine_;
};

/// Rods and bodies, whose rates follow from their velocities, with one law between them.
struct Scene {
  std::vector<const wire::RodPart*> rods;
  std::vector<const BodyPart*> bodies;
  numerics::DaePart* law = nullptr;
  std::function<double(const VectorXd&)> energy, lost;
  /// Rates of the law's own unknowns.
  std::function<void(const VectorXd&, VectorXd&)> inner_rates = [](const VectorXd&, VectorXd&) {};

  /// Power that the law takes from all of them, by its rows [W].
  [[nodiscard]] double taken(const VectorXd& y, const VectorXd& rate) const {
    VectorXd rows = VectorXd::Zero(y.size());
    law->residual({0.0, y, rate}, rows);
    double sum = 0.0;
    for (const wire::RodPart* r : rods) {
      for (int i = 0; i < r->vertices(); ++i)
        sum += rows.segment<3>(r->velocity_of(i)).dot(y.segment<3>(r->velocity_of(i)));
    }
    for (const BodyPart* b : bodies) {
      sum += rows.segment<3>(b->velocity()).dot(y.segment<3>(b->velocity()));
      sum += rows.segment<3>(b->spin()).dot(y.segment<3>(b->spin()));
    }
    return sum;
  }
  [[nodiscard]] VectorXd rate(const VectorXd& y) const {
    VectorXd rate = VectorXd::Zero(y.size());
    for (const wire::RodPart* r : rods) {
      for (int i = 0; i < r->vertices(); ++i)
        rate.segment<3>(r->position_of(i)) = y.segment<3>(r->velocity_of(i));
    }
    for (const BodyPart* b : bodies) {
      rate.segment<3>(b->position()) = y.segment<3>(b->velocity());
      rate.segment<4>(b->quaternion()) =
          multibody::quaternion_rates(y.segment<4>(b->quaternion())) * y.segment<3>(b->spin());
    }
    inner_rates(y, rate);
    return rate;
  }
  /// accuracy [-]: of the sum of all powers. Returns whether anything was lost.
  bool expect_balanced(const VectorXd& y, double accuracy, double step = 1e-7) const {
    const VectorXd rate = this->rate(y);
    const double stored = (energy(y + step * rate) - energy(y - step * rate)) / (2.0 * step);
    const double power = taken(y, rate), heat = lost(y);
    const double scale = std::abs(stored) + std::abs(power) + std::abs(heat);
    const double round_off =
        3e-14 * std::abs(energy(y)) / step;  // of a length of which a hundredth is stretch
    EXPECT_GE(heat, -1e-12 * scale);
    EXPECT_NEAR(power - stored, heat, accuracy * scale + round_off);
    return heat > 1e-6 * scale + round_off;
  }
};

MotionFriction friction(ContactFriction law) {
  MotionFriction f{0.5, 0.3, 0.01, 1.0, law};
  f.bristle_displacement = 1e-5;
  return f;
}

void move(const BodyPart& body, double speed, Random& random, VectorXd& y) {
  body.place(y);
  y.segment<4>(body.quaternion()) =
      (Eigen::Vector4d(1.0, 0.0, 0.0, 0.0) + 0.2 * random.vector_4()).normalized();
  y.segment<3>(body.velocity()) = speed * random.vector();
  y.segment<3>(body.spin()) = 10.0 * speed * random.vector();
}

void move(const wire::RodPart& rod, double speed, Random& random, VectorXd& y) {
  for (int i = 1; i + 1 < rod.vertices(); ++i) y.segment<3>(rod.velocity_of(i)) = speed * random.vector();
}

TEST(Dissipation, OfAWireOnABody) {
  Random random(11);
  const std::vector<std::shared_ptr<const ContactShape>> shapes{
      std::make_shared<Ball>(0.01), std::make_shared<Capsule>(0.0, 0.03), finite_cylinder(5e-3, 0.02)};
  int losing = 0;
  for (int trial = 0; trial < 240; ++trial) {
    SCOPED_TRACE(trial);
    const double speed = random.between(1e-4, 10.0);
    MotionContact contact;
    contact.shape = shapes[static_cast<std::size_t>(trial % 3)];
    contact.X_BS.R = Eigen::AngleAxisd{random.unit(), random.vector().normalized()}.toRotationMatrix();
    contact.wire_radius = 1e-3;
    contact.foundation = {3e8, random.between(1.0, 1e3)};
    if (trial % 4 > 0)
      contact.friction = friction(trial % 4 == 1 ? ContactFriction::smooth : ContactFriction::stick_slip);
    wire::RodPart rod("wire", test::soft_wire(8), {});
    MotionBody ball = test::block("body", 0.05, {2e-5, 3e-5, 4e-5});
    ball.start.position = {0.08 + 0.02 * random.unit(), -0.015, 0.004 * random.unit()};
    BodyPart body(ball, Vector3d::Zero(), {});
    ContactPart part(contact, contact.shape, rod, body);
    const numerics::DaeSystem system({&rod, &body, &part});
    VectorXd y = VectorXd::Zero(system.size());
    Matrix3Xd positions = straight_wire(test::soft_wire(8), Vector3d::Zero(), {0.2, 0.0, 0.0});
    for (int i = 1; i < 8; ++i) positions.col(i) += 3e-3 * random.vector();
    rod.place(positions, Matrix3Xd::Zero(3, 9), y);
    move(rod, speed, random, y);
    move(body, speed, random, y);
    part.update_candidates(y);
    y[body.position() + 1] += part.search().nearest(y).gap + random.between(1e-7, 3e-5);
    part.update_candidates(y);
    for (int i = 0; part.has_bristle() && i < rod.vertices(); ++i)
      y.segment<2>(part.bristle_of(i)) = 1e-5 * random.vector_2();
    Scene scene{{&rod},
                {&body},
                &part,
                [&](const VectorXd& at) { return part.sums(at).energy; },
                [&](const VectorXd& at) { return part.sums(at).lost_power; },
                [&](const VectorXd& at, VectorXd& rate) { part.set_bristle_rates(at, rate); }};
    // Gauss's rule on a stretch that moves is not the derivative of the rule: to some 1e-3 where edges are
    // sharp.
    losing += scene.expect_balanced(y, 5e-3, 1e-10) ? 1 : 0;
  }
  EXPECT_GT(losing, 100);  // of 240 states; in the others nothing touches between the mounts, or all lets go
}

TEST(Dissipation, OfTwoWires) {
  Random random(12);
  int losing = 0;
  for (int trial = 0; trial < 120; ++trial) {
    SCOPED_TRACE(trial);
    const double speed = random.between(1e-4, 10.0);
    Motion motion = test::crossed_wires(0.3 + 0.6 * (1.0 + random.unit()), 5e-3, 8);
    WirePair& pair = motion.wire_pairs[0];
    pair.radii = {1e-3, 0.7e-3};
    pair.foundation = {3e8, random.between(1.0, 1e3)};
    if (trial % 4 > 0)
      pair.friction = friction(trial % 4 == 1 ? ContactFriction::smooth : ContactFriction::stick_slip);
    wire::RodPart first("first", motion.wires[0].rod, {}), second("second", motion.wires[1].rod, {});
    WirePairPart part(pair, first, second);
    const numerics::DaeSystem system({&first, &second, &part});
    VectorXd y = VectorXd::Zero(system.size());
    for (MotionWire& w : motion.wires) {
      for (int i = 1; i < 8; ++i) w.positions.col(i) += 1e-3 * random.vector();
    }
    first.place(motion.wires[0].positions, Matrix3Xd::Zero(3, 9), y);
    second.place(motion.wires[1].positions, Matrix3Xd::Zero(3, 9), y);
    part.update_candidates(y);
    const double up = part.search().nearest(y).gap + random.between(1e-7, 3e-5);
    for (int i = 0; i <= 8; ++i) y[second.position_of(i) + 1] += up;
    move(first, speed, random, y);
    move(second, speed, random, y);
    part.update_candidates(y);
    for (std::size_t w = 0; part.has_bristle() && w < 2; ++w) {
      for (int i = 0; i <= 8; ++i) y.segment<2>(part.bristle_of(w, i)) = 1e-5 * random.vector_2();
    }
    Scene scene{{&first, &second},
                {},
                &part,
                [&](const VectorXd& at) { return part.sums(at).energy; },
                [&](const VectorXd& at) { return part.sums(at).lost_power; },
                [&](const VectorXd& at, VectorXd& rate) { part.set_bristle_rates(at, rate); }};
    losing += scene.expect_balanced(y, 5e-3, 1e-10) ? 1 : 0;
  }
  EXPECT_GT(losing, 80);
}

/// Two bodies that move at random, with a law between their frames.
struct TwoBodies {
  BodyPart a{test::block("a", 3.0, {0.3, 0.4, 0.5}), Vector3d::Zero(), {}};
  BodyPart b{test::block("b", 2.0, {0.2, 0.3, 0.4}), Vector3d::Zero(), {}};

  /// Returns the unknowns; those of the law are zero.
  VectorXd place(const numerics::DaeSystem& system, double apart, double speed, Random& random) const {
    VectorXd y = VectorXd::Zero(system.size());
    move(a, speed, random, y);
    move(b, speed, random, y);
    y.segment<3>(b.position()) = apart * random.vector();
    return y;
  }
  Scene scene(FrameForces& law) const {
    return {{},
            {&a, &b},
            &law,
            [&law](const VectorXd& y) { return law.work(y).power.energy; },
            [&law](const VectorXd& y) { return law.work(y).power.lost; }};
  }
};

TEST(Dissipation, OfTwoBodies) {
  Random random(13);
  int losing = 0;
  for (const ContactLaw& law : {spring_dashpot(1e4, 30.0), power_law(1e5, 1.5, 3e4, 1.0),
                                power_law(1e4, 1.0, 20.0, 1.5, 0.0), step_damped_law(1e5, 1.5, 30.0, 5e-3)}) {
    for (int trial = 0; trial < 90; ++trial) {
      SCOPED_TRACE(trial);
      TwoBodies bodies;
      BodyContact contact;
      contact.shape = std::make_shared<Capsule>(0.2, 0.5);
      contact.points = {{0.1, 0.05, -0.02}, {-0.05, 0.1, 0.1}, {0.4, 0.5, 0.6}};
      contact.radius = 0.1;
      contact.law = law;
      if (trial % 3 > 0)
        contact.friction = friction(trial % 3 == 1 ? ContactFriction::smooth : ContactFriction::stick_slip);
      BodyContactPart part(contact, {bodies.a, {}}, {bodies.b, {}});
      const numerics::DaeSystem system({&bodies.a, &bodies.b, &part});
      VectorXd y = bodies.place(system, 0.2, random.between(1e-4, 10.0), random);
      for (std::size_t k = 0; part.has_bristle() && k < 3; ++k)
        y.segment<3>(part.bristle_of(k)) = 2e-5 * random.vector();
      Scene scene = bodies.scene(part);
      scene.inner_rates = [&](const VectorXd& at, VectorXd& rate) { part.set_bristle_rates(at, rate); };
      losing += scene.expect_balanced(y, 1e-4) ? 1 : 0;
    }
  }
  EXPECT_GT(losing, 200);
}

TEST(Dissipation, OfABushing) {
  Random random(14);
  for (int trial = 0; trial < 50; ++trial) {
    SCOPED_TRACE(trial);
    TwoBodies bodies;
    MotionBushing bushing;
    bushing.translational_stiffness = {1e3, 2e3, 3e3};
    bushing.rotational_stiffness = {10.0, 20.0, 30.0};
    bushing.translational_damping = {1.0, 5.0, 20.0};
    bushing.rotational_damping = {0.1, 0.2, 0.3};
    BushingPart part(bushing, {bodies.a, {}}, {bodies.b, {}});
    const numerics::DaeSystem system({&bodies.a, &bodies.b, &part});
    bodies.scene(part).expect_balanced(bodies.place(system, 0.1, random.between(1e-3, 10.0), random), 1e-5);
  }
}

TEST(Dissipation, OfALawInPlaceOfAWire) {
  Random random(15);
  for (int trial = 0; trial < 50; ++trial) {
    SCOPED_TRACE(trial);
    MotionBody made = test::block("body", 1.0, {0.2, 0.3, 0.4});
    BodyPart body(made, Vector3d::Zero(), {});
    PointContactLaw spring;
    spring.point = {0.05, 0.1, -0.02};
    spring.direction = Vector3d(0.2, 0.9, 0.1).normalized();
    spring.law = trial % 2 == 0 ? power_law(3e3, 1.5, 200.0, 1.0) : quadratic_law(890183.0, -1297.6, 0.3457);
    LawPart part(spring, body);
    const numerics::DaeSystem system({&body, &part});
    VectorXd y = VectorXd::Zero(system.size());
    move(body, random.between(1e-3, 10.0), random, y);
    const VectorXd none = y;
    Scene scene{{},
                {&body},
                &part,
                [&](const VectorXd& at) {
                  return part.power({0.0, at, none}).energy;
                },
                [&](const VectorXd& at) {
                  return part.power({0.0, at, none}).lost;
                }};
    scene.expect_balanced(y, 1e-5);
  }
}

TEST(Dissipation, OfAWireThatALawStandsFor) {
  Random random(16);
  for (const LawWire::Kind kind : {LawWire::Kind::stretched, LawWire::Kind::rod}) {
    int losing = 0;
    for (int trial = 0; trial < 120; ++trial) {
      SCOPED_TRACE(trial);
      TwoBodies bodies;
      LawWire w;
      w.kind = kind;
      w.p_from = {0.1, 0.0, 0.0};
      w.p_to = {-0.1, 0.004, 0.0};
      w.length = 0.198;
      w.axial_stiffness = 5e4;
      w.axial_time = 1e-3;
      w.radius = 0.75e-3;
      w.shaft.radius = 6e-3;
      w.shaft.half_length = 10.0;
      w.law = power_law(3e5, 1.2, 3e4, 1.0);
      if (trial % 2 == 0) w.friction = friction(ContactFriction::smooth);
      LawWirePart part(w, {bodies.a, {Eigen::Matrix3d::Identity(), w.p_from}},
                       {bodies.a, {Eigen::Matrix3d::Identity(), w.p_to}}, {bodies.b, {}});
      const numerics::DaeSystem system({&bodies.a, &bodies.b, &part});
      VectorXd y = bodies.place(system, 0.02, random.between(1e-3, 3.0), random);
      if (trial % 5 == 0) y[bodies.b.position()] += trial % 2 == 0 ? 0.098 : -0.098;
      const std::vector<double> held{1.0, 1.0, M_PI, 0.0};
      std::span<const double> memory = held;
      part.restore_state(y, memory);
      losing += bodies.scene(part).expect_balanced(y, 1e-5) ? 1 : 0;
    }
    EXPECT_GT(losing, 30);
  }
}

// Dashpots, strands and drag of a wire by itself, whatever moves.
TEST(Dissipation, OfAWireAlone) {
  Random random(17);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    wire::RodInMotion made = test::soft_wire(8);
    made.damping.mass_rate = trial % 3;
    if (trial % 2 == 0) {
      made.strands.extra_stiffness = 2e-3;
      made.strands.slip_curvature = 1.0;
    }
    wire::RodPart rod("wire", made, {});
    const numerics::DaeSystem system({&rod});
    VectorXd y = VectorXd::Zero(system.size());
    Matrix3Xd positions = straight_wire(made, Vector3d::Zero(), {0.2, 0.0, 0.0});
    for (int i = 1; i < 8; ++i) positions.col(i) += 3e-3 * random.vector();
    rod.place(positions, Matrix3Xd::Zero(3, 9), y);
    move(rod, random.between(1e-3, 10.0), random, y);
    if (made.strands.act()) {
      for (int i = 0; i < 9; ++i) y.segment<2>(rod.strand_of(i)) = random.vector_2();
    }
    VectorXd rate = VectorXd::Zero(y.size());
    for (int i = 0; i < 9; ++i) rate.segment<3>(rod.position_of(i)) = y.segment<3>(rod.velocity_of(i));
    EXPECT_GT(rod.energies({0.0, y, rate}).dissipation, 0.0);
  }
}

}  // namespace
}  // namespace snare::coupling
